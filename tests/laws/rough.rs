//! Rough and polished surfaces: reference numbers.

use crate::reference::{case, close, number, values};
use glam::DVec3;
use num_complex::Complex64;
use straylight::bsdf::polish::smooth_tis;
use straylight::bsdf::{Bsdf, Compensation, Distribution, Facets, KCorrelation, Microfacet, Polish, Side};
use straylight::optics::Incidence;

#[test]
fn sca_06_total_scatter_of_a_smooth_surface() {
    for v in values(&case("SCA-06")).into_iter().chain(values(&case("SCA-06x"))) {
        let dn = 2.0 * number(&v, "theta_deg").to_radians().cos();
        let tis = smooth_tis(1e-9 * number(&v, "sigma_nm"), dn, 1e-9 * number(&v, "lambda_nm"));
        let [smooth, exponential] = ["TIS_smooth", "TIS_exponential"].map(|name| number(&v, name));
        close(tis, smooth, 1e-12 * smooth, "smooth");
        close(-(-tis).exp_m1(), exponential, 1e-12 * exponential, "exponential");
    }
}

#[test]
fn sca_07_k_correlation_by_rayleigh_rice() {
    for v in values(&case("SCA-07")) {
        let (rms, wavelength) = (1e-6 * number(&v, "sigma_um"), 1e-6 * number(&v, "lambda_um"));
        let b = 1e-6 * number(&v, "corr_1_over_f0_um");
        let psd = KCorrelation::new(rms, [0.0, f64::INFINITY], b, number(&v, "s"));
        let theta = number(&v, "theta_deg").to_radians();
        let tis = Polish::new(psd, Side::Reflect).albedo(&Incidence::in_air(theta, wavelength));
        let wanted = number(&v, "TIS");
        close(tis, wanted, 1e-4 * wanted, "TIS");
        let smooth = smooth_tis(rms, 2.0 * theta.cos(), wavelength);
        close(tis / smooth, number(&v, "band_limit_ratio"), 1e-4, "band limit");
    }
}

#[test]
fn sca_08_white_furnace_of_ggx() {
    for v in values(&case("SCA-08")) {
        let alpha = number(&v, "alpha");
        let lobe = Microfacet::new(Distribution::Ggx, alpha, Facets::Perfect, Side::Reflect);
        let at = Incidence::in_air(number(&v, "theta_deg").to_radians(), 550e-9);
        close(lobe.albedo(&at), number(&v, "E"), 1e-4, "E");
        let rest = Compensation::new(Distribution::Ggx, alpha, Facets::Perfect);
        close(lobe.albedo(&at) + rest.albedo(&at), 1.0, 2e-4, "with what is lost");
    }
}

#[test]
fn refraction_by_facets_is_reciprocal_between_media() {
    let (n1, n2) = (Complex64::new(1.0, 0.0), Complex64::new(1.5168, 0.0));
    for distribution in [Distribution::Ggx, Distribution::Beckmann] {
        let lobe = Microfacet::new(distribution, 0.4, Facets::Interface, Side::Transmit);
        for (ti, ts, phi) in [(0.0f64, 10.0f64, 0.0f64), (30.0, 25.0, 170.0), (70.0, 40.0, 150.0), (50.0, 30.0, 200.0)]
        {
            let [ti, ts, phi] = [ti, ts, phi].map(f64::to_radians);
            let above = DVec3::new(ti.sin(), 0.0, ti.cos());
            let below = DVec3::new(ts.sin() * phi.cos(), ts.sin() * phi.sin(), -ts.cos());
            let turned = |w: DVec3| DVec3::new(w.x, w.y, -w.z);
            let at = |wi: DVec3, index| Incidence { wi, index, ..Incidence::in_air(0.0, 550e-9) };
            let go = lobe.eval(&at(above, [n1, n2]), below);
            let back = lobe.eval(&at(turned(below), [n2, n1]), turned(above));
            assert!(go > 0.0);
            close(go / back, n2.re * n2.re, 1e-9, "f_it / n_t^2 = f_ti / n_i^2");
        }
    }
}

/// Glass so smooth that facets hardly shadow: what is reflected and what is refracted is Fresnel's, from either side, and all of it.
#[test]
fn a_nearly_smooth_interface_shares_light_as_fresnel_does() {
    for [a, b] in [[1.0, 1.5168], [1.5168, 1.0]] {
        let index = [a, b].map(|n| Complex64::new(n, 0.0));
        for theta in [0.0, 0.4, 1.0f64] {
            let at = Incidence { index, ..Incidence::in_air(theta, 550e-9) };
            let split = straylight::optics::fresnel::interface(index[0], index[1], at.cos());
            // Gaussian slopes have no tails that reach the critical angle.
            let lobe = |side| Microfacet::new(Distribution::Beckmann, 0.03, Facets::Interface, side).albedo(&at);
            close(lobe(Side::Reflect), split.reflected.unpolarised(), 2e-3, "R");
            close(lobe(Side::Transmit), split.transmitted.unpolarised(), 2e-3, "T");
        }
    }
}

//! Scatter models: reference numbers, albedo, reciprocity.

use crate::family::{Member, family};
use crate::measured::EXACT;
use crate::polar::{KINKED, SMOOTH, integral, small_cells};
use crate::reference::{case, close, number, values};
use glam::DVec3;
use num_complex::Complex64;
use std::f64::consts::{FRAC_1_PI, PI};
use straylight::bsdf::{Abg, Bsdf, Gaussian, Harvey, Lambertian, Side, Tabulated, speos};
use straylight::optics::Incidence;

fn direction(theta: f64, phi: f64) -> DVec3 {
    let (t, p) = (theta.to_radians(), phi.to_radians());
    DVec3::new(t.sin() * p.cos(), t.sin() * p.sin(), t.cos())
}

#[test]
fn sca_01_total_scatter_of_abg_falls_as_the_horizon_cuts_the_lobe() {
    for v in values(&case("SCA-01")) {
        let lobe = Abg::new(number(&v, "A"), number(&v, "B"), number(&v, "g"), Side::Reflect);
        let at = Incidence::in_air(number(&v, "theta_i_deg").to_radians(), 550e-9);
        let wanted = number(&v, "TIS");
        close(lobe.albedo(&at), wanted, 1e-7 * wanted, "TIS");
        close(lobe.eval(&at, DVec3::new(-at.wi.x, 0.0, at.wi.z)), number(&v, "BSDF_peak"), 1e-12, "peak");
    }
}

#[test]
fn sca_02_total_scatter_of_harvey_shack() {
    for v in values(&case("SCA-02")).into_iter().chain(values(&case("SCA-02x"))) {
        let lobe = Harvey::new(number(&v, "b0"), number(&v, "l"), number(&v, "s"), Side::Reflect);
        let at = Incidence::in_air(number(&v, "theta_i_deg").to_radians(), 550e-9);
        let wanted = number(&v, "TIS");
        close(lobe.albedo(&at), wanted, 2e-6 * wanted, "TIS");
    }
}

#[test]
fn sca_09_a_gaussian_is_clipped_by_the_horizon() {
    for v in values(&case("SCA-09")).into_iter().chain(values(&case("SCA-09x"))) {
        let sigma = number(&v, "sigma");
        let lobe = Gaussian::new(1.0 / (PI * sigma * sigma), sigma, Side::Reflect);
        let at = |theta: f64| Incidence::in_air(theta.to_radians(), 550e-9);
        let [part, whole] = [number(&v, "theta_deg"), 0.0].map(|theta| lobe.albedo(&at(theta)));
        close(part, number(&v, "fraction_inside_unit_disk_of_2D_gaussian"), 2e-6, "fraction");
        close(part / whole, number(&v, "TIS_if_BSDF_is_A_exp_with_A_for_TIS1_at_0deg"), 2e-6, "TIS");
    }
}

#[test]
fn sca_04_lambertian() {
    for v in values(&case("SCA-04")) {
        if let Some(r) = v["R"].as_f64() {
            let white = Lambertian { reflectance: r, transmittance: 0.0 };
            for theta in [0.0f64, 40.0, 80.0] {
                let at = Incidence::in_air(theta.to_radians(), 550e-9);
                close(white.eval(&at, direction(30.0, 70.0)), number(&v, "BRDF"), 1e-15, "BRDF");
                close(white.albedo(&at), number(&v, "TIS"), 1e-15, "TIS");
            }
        }
    }
}

#[test]
fn sca_05_points_and_their_swap() {
    let abg = Abg::new(0.01, 0.02, 1.5, Side::Reflect);
    let harvey = Harvey::new(0.1, 0.01, -1.5, Side::Reflect);
    for v in values(&case("SCA-05")).into_iter().chain(values(&case("SCA-05x"))) {
        let at = Incidence::in_air(number(&v, "theta_i").to_radians(), 550e-9);
        // Specular side: wi lies at azimuth 0, so the specular ray at 180 deg.
        let wo = direction(number(&v, "theta_s"), 180.0 - number(&v, "phi_from_specular_plane_deg"));
        let wanted = number(&v, "ABg_0p01_0p02_1p5");
        close(abg.eval(&at, wo), wanted, 1e-12 * wanted, "ABg");
        let wanted = number(&v, "Harvey_0p1_0p01_m1p5");
        close(harvey.eval(&at, wo), wanted, 1e-12 * wanted, "Harvey-Shack");
    }
}

/// Albedo against the integral of f |cos|, and the density's integral against 1: what is missing is the chance of no direction.
#[test]
fn the_albedo_is_the_integral_of_the_bsdf_and_densities_are_at_most_one() {
    // Tables have theirs below, exactly.
    for member in family().iter().filter(|member| member.slack != EXACT) {
        let Member { name, model, pole, slack, kinks, .. } = member;
        let fineness = if *kinks < 1e-3 { SMOOTH } else { KINKED };
        for at in member.incidences() {
            let (theta, wanted) = (at.cos().acos().to_degrees(), model.albedo(&at));
            let got = integral(&at, *pole, fineness, &|wo| model.eval(&at, wo) * wo.z.abs());
            assert!(wanted <= 1.0, "{name} at {theta:.1} deg: {wanted}");
            // Of facets that hardly pass anything the albedo is known to 1e-4 of the light.
            let allowed = slack.max(*kinks).max(1e-6) * wanted + 0.1 * kinks;
            close(got, wanted, allowed, &format!("{name} at {theta:.1} deg from n = {}", at.index[0].re));
            let density = integral(&at, *pole, fineness, &|wo| model.pdf(&at, wo));
            assert!(density > 0.0 && density < 1.0 + kinks.max(1e-6), "{name} at {theta:.1} deg: {density}");
        }
    }
}

/// Integral of `g` dw of a table, exact.
fn over_cells(g: impl Fn(DVec3) -> f64) -> f64 {
    let mut total = 0.0;
    small_cells([180, 288], &g, |_, part| total += part);
    total
}

#[test]
fn a_tables_albedo_is_its_integral_at_every_incidence() {
    let model = crate::measured::anodize();
    for k in 0..=60 {
        // Nodes, the table's own incidences, and everything between, to the horizon.
        let theta = (1.5 * f64::from(k)).min(89.99) + 0.37 * f64::from(k % 4 / 3);
        let at = Incidence::in_air(theta.min(89.99).to_radians(), 550e-9);
        let flux = over_cells(|wo| model.eval(&at, wo) * wo.z);
        close(flux / model.albedo(&at), 1.0, 1e-11, "flux / albedo");
    }
}

#[test]
fn what_is_reflected_is_reciprocal() {
    let glass = Complex64::new(1.5168, 0.0);
    // Measured tables are not; particles scatter what arrives, whatever leaves.
    let reciprocal = |m: &&Member| m.slack != EXACT && !m.name.starts_with("particles") && !m.model.transmits();
    for Member { name, model, .. } in family().iter().filter(reciprocal) {
        for (ti, ts, phi) in
            [(0.0, 40.0, 0.0), (30.0, 70.0, 120.0), (85.0, 5.0, 30.0), (60.0, 59.0, 179.0), (30.0, 31.0, 3.0)]
        {
            let (a, b) = (direction(ti, 0.0), direction(ts, phi));
            let at = |wi: DVec3| Incidence { wi, index: [glass, Complex64::ONE], ..Incidence::in_air(0.0, 550e-9) };
            let (go, back) = (model.eval(&at(a), b), model.eval(&at(b), a));
            close(go, back, 1e-9 * go, name);
        }
    }
}

#[test]
fn abg_is_reciprocal_in_reflection_and_between_media() {
    let (n1, n2) = (Complex64::new(1.0, 0.0), Complex64::new(1.5168, 0.0));
    let at = |wi: DVec3, index| Incidence {
        wi: DVec3::new(wi.x, wi.y, wi.z.abs()),
        index,
        ..Incidence::in_air(0.0, 550e-9)
    };
    let reflect = Abg::new(0.01, 1e-4, 1.7, Side::Reflect);
    let transmit = Abg::new(0.01, 1e-4, 1.7, Side::Transmit);
    for (ti, ts, phi) in [(0.0, 40.0, 0.0), (30.0, 70.0, 120.0), (85.0, 5.0, 30.0), (60.0, 60.0, 179.0)] {
        let (a, b) = (direction(ti, 0.0), direction(ts, phi));
        for n in [n1, n2] {
            let (go, back) = (reflect.eval(&at(a, [n, n1]), b), reflect.eval(&at(b, [n, n1]), a));
            close(go / back, 1.0, 1e-12, "reflection");
        }
        let below = DVec3::new(b.x, b.y, -b.z);
        let go = transmit.eval(&at(a, [n1, n2]), below);
        // From below the normal points the other way: z changes sign for both directions.
        let back = transmit.eval(&at(below, [n2, n1]), DVec3::new(a.x, a.y, -a.z));
        close(go / back, (n2.re / n1.re).powi(2), 1e-12, "f_it / n_t^2 = f_ti / n_i^2");
    }
}

#[test]
fn a_transmitted_lobe_peaks_at_the_refracted_ray() {
    let lobe = Abg::new(1e-3, 1e-8, 2.0, Side::Transmit);
    let at =
        Incidence { index: [Complex64::new(1.0, 0.0), Complex64::new(1.5, 0.0)], ..Incidence::in_air(0.7, 550e-9) };
    let t = straylight::optics::refraction::refract(at.wi, 1.0, 1.5).expect("into the glass");
    close(lobe.eval(&at, t) / (1.5 * 1.5 * 1e5), 1.0, 1e-12, "peak n^2 A / B");
}

fn anodize(name: &str) -> Tabulated {
    let path = format!("{}/systems/triplet/black-anodize-{name}.anisotropicbsdf", env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(path).expect("the table ships with the project");
    Tabulated::new(speos::parse(&text).expect("a good table").remove(0), 1.0).expect("below 100 %")
}

#[test]
fn black_anodize_has_the_total_scatter_it_was_written_with() {
    let at = |theta: f64| Incidence::in_air(theta.to_radians(), 550e-9);
    for (name, factor) in [("low", 0.5), ("plausible", 1.0), ("high", 2.0)] {
        let black = anodize(name);
        for (theta, percent) in [(0.0, 4.5), (15.0, 4.8), (30.0, 5.8), (45.0, 8.0), (60.0, 13.0), (75.0, 25.0)] {
            close(black.albedo(&at(theta)) * 100.0, percent * factor, 1e-9, name);
        }
        close(black.albedo(&at(37.5)) * 100.0, 6.9 * factor, 1e-9, "linear between");
        close(black.albedo(&at(89.0)) * 100.0, 36.2 * factor, 1e-9, "as steep beyond");
    }
}

#[test]
fn a_tables_entries_are_met_and_its_peak_moves_with_the_ray() {
    let black = anodize("plausible");
    // Row 60 deg, column 0 of the table at 60 deg: 3.3443488 = pi BRDF. The integral of the table between its entries differs by
    // 5e-4 from the sum that defines its TIS.
    let at = Incidence::in_air(60f64.to_radians(), 550e-9);
    close(black.eval(&at, direction(60.0, 180.0)) / (3.3443488303418274 * FRAC_1_PI), 1.0, 5e-4, "entry");
    for theta in [10.0f64, 22.5, 37.0, 52.5, 66.0, 80.0] {
        let at = Incidence::in_air(theta.to_radians(), 550e-9);
        let peak = (0..900).max_by(|a, b| {
            let f = |k: &i32| black.eval(&at, direction(0.1 * f64::from(*k), 180.0));
            f(a).total_cmp(&f(b))
        });
        close(0.1 * f64::from(peak.expect("900 angles")), theta, 0.6, "peak");
    }
}

#[test]
fn a_table_brighter_than_the_light_is_refused() {
    let path = format!("{}/systems/triplet/black-anodize-high.anisotropicbsdf", env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(path).expect("the table ships with the project");
    let error = Tabulated::new(speos::parse(&text).expect("a good table").remove(0), 3.0).expect_err("150 % at 75 deg");
    assert_eq!(
        error.to_string(),
        "the table scatters 150.0 % of the light at 75.0 deg incidence; expected at most 100 %"
    );
}

#[test]
fn abg_of_zero_b_limit_scatters_by_the_logarithm() {
    // STR-06 in closed form through the albedo: pi A ln(1 + 1/B).
    for v in [(1e-3, 1e-4), (3e-4, 1e-7), (1e-4, 1e-9)] {
        let lobe = Abg::new(v.0, v.1, 2.0, Side::Reflect);
        let closed = PI * v.0 * (1.0f64 / v.1).ln_1p();
        close(lobe.albedo(&Incidence::in_air(0.0, 550e-9)), closed, 1e-8 * closed, "TIS");
    }
}

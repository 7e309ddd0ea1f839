//! The founding note's equations (0)-(21), by number, each held against the program's own code.

use glam::DVec3;
use num_complex::Complex64;
use std::f64::consts::{FRAC_PI_2, PI, TAU};
use std::sync::Arc;
use straylight::bsdf::{Abg, Bsdf, Lambertian, Side};
use straylight::coating::{Bare, Coating, Ideal, Metal, Mirror};
use straylight::detector::Grid;
use straylight::detector::directions::{Directions, Rings};
use straylight::geometry::Frame;
use straylight::math::Rng;
use straylight::math::quadrature::GaussLegendre;
use straylight::optics::refraction::{reflect, refract};
use straylight::optics::{Incidence, fresnel};
use straylight::surface::{Order, Scattering, Surface};

fn direction(theta: f64, phi: f64) -> DVec3 {
    DVec3::new(theta.sin() * phi.cos(), theta.sin() * phi.sin(), theta.cos())
}

fn at(theta: f64, n1: f64, n2: f64) -> Incidence {
    Incidence { index: [Complex64::new(n1, 0.0), Complex64::new(n2, 0.0)], ..Incidence::in_air(theta, 550e-9) }
}

/// Solid angle of a small triangle of directions about (theta, phi), and its image under `f`; sr.
fn bundle(theta: f64, f: impl Fn(DVec3) -> DVec3) -> (f64, f64) {
    let h = 1e-4;
    let corners = [(theta, 0.3), (theta + h, 0.3), (theta, 0.3 + h)].map(|(t, p)| direction(t, p));
    let area = |c: [DVec3; 3]| 0.5 * (c[1] - c[0]).cross(c[2] - c[0]).length();
    (area(corners), area(corners.map(f)))
}

/// A surface that is nothing but specular.
fn polished(coating: impl Coating + 'static) -> Surface {
    Surface::new("polished".into(), Some(Arc::new(coating)), Vec::new(), Order::ScatterFirst, Scattering::On)
}

#[test]
fn eq_00_brdf_is_radiance_over_irradiance() {
    // Unit flux on unit area: E = 1. What is drawn into a narrow cone about wr, over cos(theta_r) and the cone, is dL_r.
    let lobe = Abg::new(0.02, 0.1, 1.5, Side::Reflect);
    let (at, half) = (at(0.5, 1.0, 1.0), 0.15f64);
    let wr = direction(0.9, 2.0);
    let cone = TAU * (1.0 - half.cos());
    let (mut rng, draws) = (Rng::new(1, 0, 0), 1_000_000);
    let (mut sum, mut squares) = (0.0, 0.0);
    for _ in 0..draws {
        let Some(wo) = lobe.sample(&at, &mut rng) else { continue };
        if wo.dot(wr) > half.cos() {
            let flux = lobe.eval(&at, wo) * wo.z / lobe.pdf(&at, wo);
            let radiance = flux / (wo.z * cone);
            (sum, squares) = (sum + radiance, squares + radiance * radiance);
        }
    }
    let mean = sum / draws as f64;
    let error = ((squares / draws as f64 - mean * mean) / draws as f64).sqrt();
    // The mean of the BRDF over the cone: a disc of directions, second order in its half angle.
    let frame = Frame::from_z(wr);
    let rule = GaussLegendre::new(16);
    let ring = |t: f64| rule.integrate(0.0, TAU, |p| lobe.eval(&at, frame.to_world(direction(t, p)))) * t.sin();
    let brdf = rule.integrate(0.0, half, ring) / cone;
    assert!(error < 0.02 * brdf && (mean - brdf).abs() < 4.0 * error, "{mean} ± {error}, {brdf}");
}

#[test]
fn eq_01_radiance_is_the_integral_of_brdf_times_irradiance() {
    // Uniform L_i = 1 over the hemisphere: L_r = rho(wr) by reciprocity.
    let lobe = Abg::new(0.02, 0.1, 1.5, Side::Reflect);
    let rule = GaussLegendre::new(64);
    let wr = direction(0.6, 0.0);
    let radiance = rule.integrate(0.0, FRAC_PI_2, |t| {
        let brdf = |p: f64| lobe.eval(&Incidence { wi: direction(t, p), ..at(0.0, 1.0, 1.0) }, wr);
        2.0 * rule.integrate(0.0, PI, brdf) * t.cos() * t.sin()
    });
    let albedo = lobe.albedo(&at(0.6, 1.0, 1.0));
    // The lobe has a cusp x^1.5 inside the polar grid: 64 points reach 2e-6.
    assert!((radiance / albedo - 1.0).abs() < 1e-5, "{radiance} {albedo}");
}

#[test]
fn eq_02_reflectance_is_reflected_over_incident_flux() {
    // A ratio of fluxes, whatever the draws: the mean weight of the sampler is the directional-hemispherical reflectance.
    let lobe = Abg::new(0.0025, 0.001, 1.8, Side::Reflect);
    for theta in [0.0, 1.0, 1.45] {
        let at = at(theta, 1.0, 1.0);
        let (mut rng, draws) = (Rng::new(2, 0, 0), 100_000);
        let (mut sum, mut squares) = (0.0, 0.0);
        for _ in 0..draws {
            let weight = |wo: DVec3| lobe.eval(&at, wo) * wo.z / lobe.pdf(&at, wo);
            let flux = lobe.sample(&at, &mut rng).map_or(0.0, weight);
            (sum, squares) = (sum + flux, squares + flux * flux);
        }
        let mean = sum / draws as f64;
        let error = ((squares / draws as f64 - mean * mean) / draws as f64).sqrt();
        assert!(
            (mean - lobe.albedo(&at)).abs() < 4.0 * error + 1e-12,
            "{theta}: {mean} ± {error}, {}",
            lobe.albedo(&at)
        );
    }
}

#[test]
fn eq_03_reflectance_is_the_flux_weighted_mean_of_the_directional_one() {
    // Uniform radiance: the double integral of the BRDF over both projected hemispheres, over pi.
    let lobe = Abg::new(0.02, 0.1, 1.5, Side::Reflect);
    let rule = GaussLegendre::new(48);
    let brdf = |ti: f64, tr: f64, p: f64| lobe.eval(&at(ti, 1.0, 1.0), direction(tr, p));
    let over = |f: &dyn Fn(f64) -> f64| rule.integrate(0.0, FRAC_PI_2, |t| f(t) * t.cos() * t.sin());
    let double = over(&|ti| over(&|tr| 2.0 * rule.integrate(0.0, PI, |p| brdf(ti, tr, p)))) * 2.0;
    let mean = rule.integrate(0.0, 1.0, |u| 2.0 * u * lobe.albedo(&at(u.acos(), 1.0, 1.0)));
    // The cusp x^1.5 of the lobe limits the polar rule.
    assert!((double / mean - 1.0).abs() < 1e-4, "{double} {mean}");
}

#[test]
fn eq_04_05_specular_reflection_keeps_the_angle_turns_the_azimuth_by_pi_and_keeps_radiance() {
    let wi = direction(0.8, 0.3);
    let wr = reflect(wi);
    assert!((wr - direction(0.8, 0.3 + PI)).length() < 1e-15);
    let (before, after) = bundle(0.8, reflect);
    assert!((before / after - 1.0).abs() < 1e-10);
}

#[test]
fn eq_06_the_polar_angle_ends_at_a_right_angle() {
    let lobe = Abg::new(0.02, 0.1, 1.5, Side::Reflect);
    let rule = GaussLegendre::new(64);
    let at = at(0.6, 1.0, 1.0);
    let within = |a: f64, b: f64| {
        let ring = |t: f64| 2.0 * rule.integrate(0.0, PI, |p| lobe.eval(&at, direction(t, p))) * t.cos() * t.sin();
        rule.integrate(a, b, ring)
    };
    assert!((within(0.0, FRAC_PI_2) / lobe.albedo(&at) - 1.0).abs() < 1e-4);
    assert_eq!(within(FRAC_PI_2, PI), 0.0);
}

#[test]
fn eq_07_the_specular_lobe_is_discrete_and_keeps_radiance() {
    // A delta over cos sin: nothing at any finite distance from the specular direction, all the flux in it; as many
    // steradians leave as arrive, at the same cosine, so L_r = L_i.
    let mirror = polished(Mirror { reflectance: 1.0 });
    for theta in [0.1, 0.7, 1.5] {
        let at = at(theta, 1.0, 1.0);
        let shares = mirror.shares(&at);
        assert_eq!((shares.scattered, mirror.weigh(&at, &shares, direction(0.7, PI)).value), (0.0, 0.0));
        let flux = shares.split.expect("a mirror").reflected.unpolarised() * shares.specular[0];
        let (before, after) = bundle(theta, reflect);
        assert!((flux * before / after - 1.0).abs() < 1e-10);
    }
}

#[test]
fn eq_08_the_specular_lobe_carries_fresnels_reflectance() {
    // The textbook's sines and tangents, not the program's form of them.
    let glass = polished(Bare);
    for theta in [0.2f64, 0.7, 1.2, 1.5] {
        let inside = (theta.sin() / 1.5).asin();
        let s = ((theta - inside).sin() / (theta + inside).sin()).powi(2);
        let p = ((theta - inside).tan() / (theta + inside).tan()).powi(2);
        let split = glass.shares(&at(theta, 1.0, 1.5)).split.expect("an interface");
        assert!((split.reflected.s.norm_sqr() - s).abs() < 1e-14);
        assert!((split.reflected.p.norm_sqr() - p).abs() < 1e-14);
    }
}

#[test]
fn eq_09_the_specular_lobe_carries_the_coatings_reflectance_at_its_angle() {
    let r = |coating: &dyn Coating, theta: f64| coating.split(&at(theta, 1.0, 1.5)).reflected.unpolarised();
    let splitter = Ideal { reflectance: 0.3, transmittance: 0.6 };
    let aluminium = Metal { index: Complex64::new(1.152_794, 6.689_827) };
    assert!((r(&splitter, 0.0) - 0.3).abs() < 1e-15 && (r(&splitter, 1.2) - 0.3).abs() < 1e-15);
    assert!((r(&aluminium, 0.0) - 0.906_634_3).abs() < 1e-7);
    // A metal's R_p dips at its pseudo-Brewster angle, some 82 degrees: a constant would not.
    assert!(r(&aluminium, 1.43) < r(&aluminium, 0.0) - 0.02);
}

#[test]
fn eq_10_lambertian_radiance_is_the_same_in_every_direction() {
    let white = Lambertian { reflectance: 0.6, transmittance: 0.0 };
    let first = white.eval(&at(0.0, 1.0, 1.0), DVec3::Z);
    for (incident, leaving) in [(0.0, 1.5), (1.4, 0.2), (0.8, 0.8)] {
        assert_eq!(white.eval(&at(incident, 1.0, 1.0), direction(leaving, 2.5)), first);
    }
}

#[test]
fn eq_11_lambertian_reflectance_is_pi_times_the_brdf() {
    let white = Lambertian { reflectance: 0.6, transmittance: 0.0 };
    let rule = GaussLegendre::new(16);
    let brdf = |t: f64| white.eval(&at(0.4, 1.0, 1.0), direction(t, 1.0));
    let flux = TAU * rule.integrate(0.0, FRAC_PI_2, |t| brdf(t) * t.cos() * t.sin());
    assert!((flux - white.albedo(&at(0.4, 1.0, 1.0))).abs() < 1e-14 && (flux - PI * brdf(0.3)).abs() < 1e-14);
}

#[test]
fn eq_12_lambertian_brdf_is_r_over_pi() {
    let white = Lambertian { reflectance: 0.6, transmittance: 0.0 };
    assert_eq!(white.eval(&at(0.4, 1.0, 1.0), direction(1.0, 2.0)), 0.6 * std::f64::consts::FRAC_1_PI);
}

#[test]
fn eq_13_etendue_is_conserved_across_an_interface() {
    for (n1, n2) in [(1.0, 1.5168), (1.5168, 1.0), (1.78, 1.46)] {
        for theta in [0.1, 0.3, 0.55] {
            let through = |w: DVec3| refract(w, n1, n2).expect("below the critical angle");
            let (before, after) = bundle(theta, through);
            let (c1, c2) = (theta.cos(), -through(direction(theta, 0.3)).z);
            // Finite bundle of 1e-4 rad: cosines vary by 1e-4 across it.
            assert!((n2 * n2 * c2 * after / (n1 * n1 * c1 * before) - 1.0).abs() < 5e-4);
        }
    }
}

#[test]
fn eq_14_15_basic_radiance_is_invariant_through_any_stack() {
    // L / n^2 of a lossless bundle through four media: flux 1 spread over cos dw of each.
    let indices = [1.0, 1.5168, 1.78, 1.46, 1.0];
    let onward =
        |w: DVec3, step: usize| refract(w, indices[step], indices[step + 1]).map(|t| -t).expect("no total reflection");
    let through = |w: DVec3, steps: usize| (0..steps).fold(w, onward);
    let basic = |steps: usize| {
        let (_, after) = bundle(0.7, |w| through(w, steps));
        1.0 / (indices[steps] * indices[steps] * through(direction(0.7, 0.3), steps).z * after)
    };
    for steps in 1..indices.len() {
        assert!((basic(steps) / basic(0) - 1.0).abs() < 5e-4, "after {steps} interfaces");
    }
}

#[test]
fn eq_16_transmitted_radiance_is_t_n_squared() {
    let (n1, n2, theta) = (1.0, 1.5168, 0.7);
    let through = |w: DVec3| refract(w, n1, n2).expect("into glass");
    let (before, after) = bundle(theta, through);
    let t = Bare.split(&at(theta, n1, n2)).transmitted.unpolarised();
    // Unit radiance: flux per area c1 dw1, of which T arrives in c2 dw2.
    let radiance = t * theta.cos() * before / (-through(direction(theta, 0.3)).z * after);
    assert!((radiance / (t * (n2 / n1) * (n2 / n1)) - 1.0).abs() < 5e-4);
    let glass = Complex64::new(n2, 0.0);
    let r = fresnel::interface(Complex64::new(n1, 0.0), glass, theta.cos()).reflected.unpolarised();
    assert!((t - (1.0 - r)).abs() < 1e-15, "T is the power transmittance");
}

#[test]
fn eq_17_18_19_20_solid_angle_in_the_polar_angle_and_in_its_sine() {
    // sin t dt dphi, and tan t d(sin t) dphi, of every bin of the program's grids of directions.
    let rule = GaussLegendre::new(32);
    for (rings, limit) in [(Rings::Polar, 1.3f64), (Rings::Projected, 1.2)] {
        let grid = Directions { frame: Frame::WORLD, rings, limit, rows: 6, columns: 5 };
        let edge = |row: usize| match rings {
            Rings::Polar => limit * row as f64 / 6.0,
            Rings::Projected => (limit.sin() * (row as f64 / 6.0).sqrt()).asin(),
        };
        for row in 0..6 {
            let (a, b) = (edge(row), edge(row + 1));
            let polar = rule.integrate(a, b, f64::sin) * TAU / 5.0;
            let sine = rule.integrate(a.sin(), b.sin(), |s| s / (1.0 - s * s).sqrt()) * TAU / 5.0;
            let extent = grid.extent(row * 5 + 2);
            assert!(
                (extent / polar - 1.0).abs() < 1e-12 && (extent / sine - 1.0).abs() < 1e-9,
                "{row}: {extent} {polar} {sine}"
            );
        }
    }
}

#[test]
fn eq_21_transmitted_flux_is_t_without_n_squared_and_nothing_beyond_the_critical_angle() {
    // Lambertian light in glass against a plane face: the flux that leaves is the mean of T over the cosine law, (1 - R_int),
    // and equals (1 - R_ext) / n^2: no factor n^2 is applied to flux.
    let n: f64 = 1.5;
    let rule = GaussLegendre::new(64);
    let t = |n1: f64, n2: f64, u: f64| Bare.split(&at(u.acos(), n1, n2)).transmitted.unpolarised();
    let out = rule.integrate(0.0, 1.0, |u| 2.0 * u * t(1.0, n, u)) / (n * n);
    let critical = (1.0 - 1.0 / (n * n)).sqrt();
    let inside = rule.integrate(0.0, (1.0 - critical).sqrt(), |w| {
        let u = critical + w * w;
        4.0 * w * u * t(n, 1.0, u)
    });
    assert!((out - inside).abs() < 1e-7, "{out} {inside}");
    assert_eq!(t(n, 1.0, critical - 1e-9), 0.0);
}

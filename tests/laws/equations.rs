//! The founding note's equations that concern one surface, by number.

use glam::DVec3;
use num_complex::Complex64;
use std::f64::consts::{FRAC_PI_2, PI, TAU};
use straylight::bsdf::{Abg, Bsdf, Lambertian, Side};
use straylight::coating::{Bare, Coating, Mirror};
use straylight::math::quadrature::GaussLegendre;
use straylight::optics::refraction::{reflect, refract};
use straylight::optics::{Incidence, fresnel};

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
fn eq_03_reflectance_is_the_flux_weighted_mean_of_the_directional_one() {
    let white = Lambertian { reflectance: 0.7, transmittance: 0.0 };
    let r = GaussLegendre::new(8).integrate(0.0, 1.0, |u| 2.0 * u * white.albedo(&at(u.acos(), 1.0, 1.0)));
    assert!((r - 0.7).abs() < 1e-14);
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
    let rule = GaussLegendre::new(16);
    assert!((TAU * rule.integrate(0.0, FRAC_PI_2, |t| t.cos() * t.sin()) - PI).abs() < 1e-14);
}

#[test]
fn eq_09_the_specular_lobe_carries_the_reflectance_as_a_factor() {
    assert!((Mirror { reflectance: 0.9 }.split(&at(1.2, 1.0, 1.5)).reflected.unpolarised() - 0.9).abs() < 1e-15);
    let glass = Bare.split(&at(0.0, 1.0, 1.5)).reflected.unpolarised();
    assert!((glass - 0.04).abs() < 1e-15);
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
fn eq_15_16_basic_radiance_is_invariant_and_transmitted_radiance_is_t_n_squared() {
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
fn eq_17_20_solid_angle_in_the_sine() {
    let rule = GaussLegendre::new(32);
    let (a, b) = (0.2f64, 1.1f64);
    let polar = rule.integrate(a, b, f64::sin);
    let sine = rule.integrate(a.sin(), b.sin(), |s| s / (1.0 - s * s).sqrt());
    assert!((polar - sine).abs() < 1e-12);
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

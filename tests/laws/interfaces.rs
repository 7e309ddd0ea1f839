//! Interfaces: Fresnel's numbers, energy, reciprocity, physical polarisation.

use crate::reference::{case, close, number, values};
use glam::DVec3;
use num_complex::Complex64;
use proptest::prelude::*;
use straylight::coating::{Bare, Coating, Ideal, Metal, Mirror};
use straylight::geometry::Frame;
use straylight::math::quadrature::GaussLegendre;
use straylight::optics::refraction::{self, refract};
use straylight::optics::{Incidence, Split, Stokes, fresnel};

fn real(n: f64) -> Complex64 {
    Complex64::new(n, 0.0)
}

fn at(degrees: f64, n1: Complex64, n2: Complex64) -> Split {
    fresnel::interface(n1, n2, degrees.to_radians().cos())
}

fn check(id: &str) {
    let case = case(id);
    let index = |name: &str| real(number(&case["setup"], name));
    for v in values(&case) {
        let split = at(number(&v, "theta_deg"), index("n1"), index("n2"));
        let (r, t) = (split.reflected, split.transmitted);
        close(r.s.norm_sqr(), number(&v, "Rs"), 1e-12, "R_s");
        close(r.p.norm_sqr(), number(&v, "Rp"), 1e-12, "R_p");
        close(r.unpolarised(), number(&v, "R_unpol"), 1e-12, "R");
        close(t.unpolarised(), number(&v, "T_flux_unpol"), 1e-12, "T");
    }
}

#[test]
fn fre_01_from_air_into_glass() {
    check("FRE-01");
}

#[test]
fn fre_02_from_glass_into_air_up_to_total_reflection() {
    check("FRE-02");
    check("FRE-02x");
}

#[test]
fn fre_04_p_light_is_not_reflected_at_brewsters_angle() {
    for id in ["FRE-04", "FRE-04x"] {
        let case = case(id);
        for v in values(&case) {
            let n = |name: &str| real(number(&case["setup"], name));
            let r = at(number(&v, "theta_B_deg"), n("n1"), n("n2")).reflected;
            close(r.p.norm_sqr(), 0.0, 1e-12, "R_p");
            close(r.s.norm_sqr(), number(&v, "Rs"), 1e-12, "R_s");
            let reflected = r.apply(Stokes::unpolarised(1.0));
            close(reflected.degree(), 1.0, 1e-12, "degree of polarisation");
        }
    }
}

#[test]
fn fre_06_metals() {
    for v in values(&case("FRE-06")) {
        let metal = Metal { index: Complex64::new(number(&v, "n"), number(&v, "k")) };
        let r = metal.split(&Incidence::in_air(number(&v, "theta_deg").to_radians(), 632.8e-9)).reflected;
        close(r.s.norm_sqr(), number(&v, "Rs"), 1e-12, "R_s");
        close(r.p.norm_sqr(), number(&v, "Rp"), 1e-12, "R_p");
    }
}

#[test]
fn fre_08_what_enters_an_absorbing_medium_is_what_is_not_reflected() {
    for v in values(&case("FRE-08")) {
        let n2 = Complex64::new(number(&v, "n2_re"), number(&v, "n2_im"));
        let split = at(number(&v, "theta_deg"), real(1.0), n2);
        for (r, t, rn, tn) in
            [(split.reflected.s, split.transmitted.s, "Rs", "Ts"), (split.reflected.p, split.transmitted.p, "Rp", "Tp")]
        {
            close(r.norm_sqr(), number(&v, rn), 1e-12, rn);
            close(t.norm_sqr(), number(&v, tn), 1e-12, tn);
            close(r.norm_sqr() + t.norm_sqr(), 1.0, 1e-14, "R + T");
        }
    }
}

#[test]
fn rob_01_the_transmittance_keeps_its_digits_at_grazing_incidence() {
    let case = case("ROB-01");
    let n = number(&case["setup"], "n");
    for v in values(&case) {
        let t = at(number(&v, "theta_deg"), real(1.0), real(n)).transmitted;
        for (got, name) in [(t.s.norm_sqr(), "one_minus_Rs"), (t.p.norm_sqr(), "one_minus_Rp")] {
            let wanted = number(&v, name);
            close(got, wanted, 1e-9 * wanted, name);
        }
    }
}

#[test]
fn rad_08_diffuse_fresnel_reflectance() {
    let rule = GaussLegendre::new(64);
    // In u = cos theta; inside the glass the square root at the critical angle is met by integrating outside it only.
    let diffuse = |n1: f64, n2: f64, from: f64| {
        rule.integrate(0.0, (1.0 - from).sqrt(), |w| {
            let u = from + w * w;
            4.0 * w * u * (1.0 - fresnel::interface(real(n1), real(n2), u).reflected.unpolarised())
        })
    };
    for id in ["RAD-08", "RAD-08x"] {
        for v in values(&case(id)) {
            let n = number(&v, "n");
            close(diffuse(1.0, n, 0.0), number(&v, "E_over_piL"), 1e-8, "E / (pi L)");
            let critical = (1.0 - 1.0 / (n * n)).sqrt();
            close(1.0 - diffuse(n, 1.0, critical), number(&v, "R_int"), 1e-8, "R_int");
        }
    }
}

/// Every kind of interface, with the media on its two sides.
fn family() -> Vec<(Box<dyn Coating>, Complex64, Complex64)> {
    let (air, glass, black) = (real(1.0), real(1.5168), Complex64::new(1.7, 0.4));
    vec![
        (Box::new(Bare), air, glass),
        (Box::new(Bare), glass, air),
        (Box::new(Bare), real(1.7847), real(1.4585)),
        (Box::new(Bare), air, black),
        (Box::new(Bare), glass, Complex64::new(1.2, 6.7)),
        (Box::new(Bare), glass, Complex64::new(0.05, 3.5)),
        (Box::new(Ideal { reflectance: 0.01, transmittance: 0.98 }), air, glass),
        (Box::new(Ideal { reflectance: 0.01, transmittance: 0.98 }), glass, air),
        (Box::new(Mirror { reflectance: 0.95 }), air, glass),
        (Box::new(Metal { index: Complex64::new(1.152794, 6.689827) }), glass, air),
    ]
}

fn incidence(cos: f64, index: [Complex64; 2]) -> Incidence {
    Incidence { wi: DVec3::new((1.0 - cos * cos).sqrt(), 0.0, cos), index, ..Incidence::in_air(0.0, 550e-9) }
}

proptest! {
    #[test]
    fn no_interface_makes_light_and_none_makes_it_unphysical(
        cos in prop_oneof![1e-9..1e-3, 1e-3..1.0f64], q in -1.0..1.0f64, u in -1.0..1.0f64, v in -1.0..1.0f64,
    ) {
        let norm = (q * q + u * u + v * v).sqrt().max(1.0);
        let light = Stokes { i: 1.0, q: q / norm, u: u / norm, v: v / norm };
        for (coating, n1, n2) in family() {
            let split = coating.split(&incidence(cos, [n1, n2]));
            let (r, t) = (split.reflected.apply(light), split.transmitted.apply(light));
            prop_assert!(r.i >= 0.0 && t.i >= 0.0 && r.i + t.i <= 1.0 + 1e-14, "{coating:?}: {} + {}", r.i, t.i);
            prop_assert!(r.polarised() <= r.i * (1.0 + 1e-14) && t.polarised() <= t.i * (1.0 + 1e-14), "{coating:?}");
            prop_assert!(split.reflected.s.norm_sqr() <= 1.0 && split.reflected.p.norm_sqr() <= 1.0, "{coating:?}");
            prop_assert!(!coating.opaque() || t.i == 0.0);
        }
    }

    #[test]
    fn a_transparent_interface_loses_nothing(cos in 1e-9..1.0f64, n1 in 1.0..4.0f64, n2 in 1.0..4.0f64) {
        let split = fresnel::interface(real(n1), real(n2), cos);
        prop_assert!((split.reflected.s.norm_sqr() + split.transmitted.s.norm_sqr() - 1.0).abs() < 2e-15);
        prop_assert!((split.reflected.p.norm_sqr() + split.transmitted.p.norm_sqr() - 1.0).abs() < 2e-15);
    }

    #[test]
    fn transmittance_is_the_same_both_ways(cos in 0.01..1.0f64, n1 in 1.0..4.0f64, n2 in 1.0..4.0f64) {
        let wi = DVec3::new((1.0 - cos * cos).sqrt(), 0.0, cos);
        if let Some(t) = refract(wi, n1, n2) {
            prop_assume!(-t.z > 1e-3);
            let (go, back) = (fresnel::interface(real(n1), real(n2), cos), fresnel::interface(real(n2), real(n1), -t.z));
            prop_assert!((go.transmitted.s.norm_sqr() - back.transmitted.s.norm_sqr()).abs() < 1e-11);
            prop_assert!((go.transmitted.p.norm_sqr() - back.transmitted.p.norm_sqr()).abs() < 1e-11);
        }
    }

    #[test]
    fn where_light_is_transmitted_there_is_a_refracted_ray(cos in 1e-6..1.0f64) {
        for (coating, n1, n2) in family() {
            let at = incidence(cos, [n1, n2]);
            if coating.split(&at).transmitted.unpolarised() > 0.0 {
                let t = refract(at.wi, n1.re, n2.re).expect("a way on");
                // |t|^2 is a sum of terms up to (n1 / n2)^2: their roundings come to some 1e-15 of that.
                let bound = 1e-14 * (n1.re / n2.re).powi(2).max(1.0);
                prop_assert!((t.length() - 1.0).abs() < bound);
            }
        }
    }
}

#[test]
fn total_reflection_reflects_all_and_turns_linear_light_elliptic() {
    let split = fresnel::interface(real(1.5168), real(1.0), 50f64.to_radians().cos());
    let light = split.reflected.apply(Stokes::linear(1.0, std::f64::consts::FRAC_PI_4));
    close(light.i, 1.0, 5e-16, "R");
    assert!(light.i <= 1.0);
    assert!(light.v.abs() > 0.1);
    // Born & Wolf 1.5.4 (61): tan(delta/2) = cos sqrt(sin^2 - n^2) / sin^2, n = n2/n1.
    let (sin, cos) = 50f64.to_radians().sin_cos();
    let half = (cos * (sin * sin - 1.0 / (1.5168f64 * 1.5168)).sqrt() / (sin * sin)).atan();
    close((split.reflected.s / split.reflected.p).arg().abs(), 2.0 * half, 1e-12, "phase between s and p");
}

/// What a normal that is not the surface's own would do: the rays it sends off do not keep their etendue. Here every normal is the surface's
/// own, of a facet or of an exact shape, and the factor is 1 (RAD-05).
#[test]
fn adj_02_a_tilted_normal_breaks_etendue() {
    for value in values(&case("ADJ-02")) {
        let [angle, tilt] = ["theta_i_deg", "tilt_deg"].map(|name| number(&value, name).to_radians());
        let wi = DVec3::new(-angle.sin(), 0.0, angle.cos());
        let normal = DVec3::new(tilt.sin(), 0.0, tilt.cos());
        let frame = Frame::from_z_x(normal, wi);
        let wo = frame.to_world(refraction::reflect(frame.to_local(wi)));
        let wanted = value["wo"].as_array().expect("a direction");
        for (found, wanted) in wo.to_array().into_iter().zip(wanted) {
            close(found, wanted.as_f64().expect("a number"), 1e-12, "ADJ-02 direction");
        }
        let adjoint = wi.dot(normal) * wo.z / (wi.z * wo.dot(normal));
        for (found, name) in [(wo.z / wi.z, "etendue_factor_cos_o_g_over_cos_i_g"), (adjoint, "veach_adjoint_factor")] {
            close(found / number(&value, name), 1.0, 1e-12, &format!("ADJ-02 {name}"));
        }
    }
}

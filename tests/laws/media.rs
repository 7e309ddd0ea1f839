//! Media: dispersion and absorption.

use crate::reference::{case, close, number, values};
use glam::DVec3;
use straylight::medium::catalog::Shelf;
use straylight::medium::{Catalogued, Constant, Loss, Medium, Sellmeier, absorption};
use straylight::optics::fresnel;
use straylight::optics::refraction::refract;

fn n_bk7() -> Sellmeier {
    let terms = [(1.03961212, 0.00600069867), (0.231792344, 0.0200179144), (1.01046945, 103.560653)];
    Sellmeier { terms: terms.iter().map(|(b, c)| (*b, c * 1e-12)).collect(), range: None }
}

fn catalogued(shelf: Shelf, name: &str) -> Catalogued {
    shelf.medium(name).unwrap_or_else(|problem| panic!("{problem}"))
}

/// The formula typed in, and the built-in catalogue at its own wavelengths.
#[test]
fn dis_01_n_bk7() {
    let (typed, built_in) = (n_bk7(), catalogued(Shelf::Glass, "N-BK7"));
    indices_of_n_bk7(&|nm| typed.index(nm * 1e-9).re);
    indices_of_n_bk7(&|nm| built_in.printed(nm * 1e-9).re);
}

fn indices_of_n_bk7(n: &dyn Fn(f64) -> f64) {
    let reference = &values(&case("DIS-01"))[0];
    for (name, nm) in [
        ("n_F", 486.1327),
        ("n_d", 587.5618),
        ("n_C", 656.2725),
        ("n_e", 546.074),
        ("n_HeNe", 632.8),
        ("n_g", 435.8343),
    ] {
        close(n(nm), number(reference, name), 1e-9, name);
    }
    let abbe = (n(587.5618) - 1.0) / (n(486.1327) - n(656.2725));
    close(abbe, number(reference, "V_d"), 1e-7, "V_d");
}

/// Deviation (rad) of a prism of apex angle `apex` by two refractions of a ray.
fn deviation(n: f64, apex: f64, incidence: f64) -> f64 {
    let first = refract(DVec3::new(incidence.sin(), 0.0, incidence.cos()), 1.0, n).expect("into the glass");
    let inside = apex - (-first.x).atan2(-first.z).abs();
    let second = refract(DVec3::new(inside.sin(), 0.0, inside.cos()), n, 1.0).expect("out of the glass");
    let out = second.x.abs().atan2(-second.z) * inside.signum();
    incidence + out - apex
}

#[test]
fn dis_02_prisms() {
    for id in ["DIS-02", "DIS-02x"] {
        let case = case(id);
        let apex = number(&case["setup"], "apex_deg").to_radians();
        let values = values(&case);
        let glass = catalogued(Shelf::Glass, case["setup"]["glass"].as_str().expect("a name"));
        for v in values.iter().filter(|v| v["n"].is_number()) {
            let nm = match v["line"].as_str() {
                Some("F") => 486.1327,
                Some("d") => 587.5618,
                _ => 656.2725,
            };
            close(glass.printed(nm * 1e-9).re, number(v, "n"), 1e-9, "index of the catalogue");
        }
        let n_d = number(values.iter().find(|v| v["line"] == "d").expect("d"), "n");
        for v in &values {
            if let Some(minimum) = v["delta_min_deg"].as_f64() {
                let at = number(v, "incidence_at_min_deg").to_radians();
                close(deviation(number(v, "n"), apex, at).to_degrees(), minimum, 1e-9, "minimum deviation");
            } else if let Some(wanted) = v["deviation_deg"].as_f64() {
                let at = number(v, "incidence_deg").to_radians();
                close(deviation(n_d, apex, at).to_degrees(), wanted, 1e-9, "deviation");
            }
        }
    }
}

#[test]
fn vol_05_beer_lambert_on_oblique_paths() {
    for id in ["VOL-05", "VOL-05x"] {
        for v in values(&case(id)) {
            let alpha = number(&v, "alpha_per_mm") * 1e3;
            let medium = Constant { n: number(&v, "n"), loss: Loss::Absorption(alpha) };
            let theta = number(&v, "theta_deg").to_radians();
            let outside = Constant::transparent(1.0).index(550e-9);
            let index = medium.index(550e-9);
            let inside = refract(DVec3::new(theta.sin(), 0.0, theta.cos()), 1.0, index.re).expect("into the slab");
            let path = number(&v, "d_mm") * 1e-3 / -inside.z;
            close(path * 1e3, number(&v, "path_mm"), 1e-11, "path");
            let internal = (-absorption(index, 550e-9) * path).exp();
            close(internal, number(&v, "internal_transmittance"), 1e-12, "internal transmittance");
            // Surfaces as of transparent glass: entrance, path, exit, s and p apart.
            let glass = num_complex::Complex64::new(index.re, 0.0);
            let (a, b) =
                (fresnel::interface(outside, glass, theta.cos()), fresnel::interface(glass, outside, -inside.z));
            let s = a.transmitted.s.norm_sqr() * b.transmitted.s.norm_sqr();
            let p = a.transmitted.p.norm_sqr() * b.transmitted.p.norm_sqr();
            close(0.5 * (s + p) * internal, number(&v, "first_pass_T_unpol"), 1e-12, "first pass");
        }
    }
}

/// The reference took its indices from the same pages, interpolated linearly at 632.8 nm; the catalogue keeps six digits.
#[test]
fn fre_06_metals_of_the_catalogue() {
    for (name, page) in [("Al 632.8nm", "Al:McPeak"), ("Au 632.8nm", "Au:Johnson")] {
        let index = catalogued(Shelf::Metal, page).index(632.8e-9);
        let values = values(&case("FRE-06"));
        let reference = values.iter().find(|v| v["metal"] == name).expect("the metal");
        close(index.re, number(reference, "n"), 5e-6, name);
        close(index.im, number(reference, "k"), 5e-6, name);
    }
}

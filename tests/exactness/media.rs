//! Dispersion and absorption through the whole chain.

use crate::lab::*;
use crate::support::case::number;
use crate::support::shapes::cuboid;
use crate::support::{Case, Model};
use glam::{DVec2, DVec3};

/// Fraunhofer lines, nm in vacuum as the catalogue takes them: F, d, C, e, HeNe, g.
const LINES: [(&str, f64); 6] =
    [("F", 486.1327), ("d", 587.5618), ("C", 656.2725), ("e", 546.0740), ("HeNe", 632.8), ("g", 435.8343)];

/// RON text of the glass of DIS-01.
fn n_bk7() -> String {
    let case = Case::load("DIS-01");
    let numbers = case.list("/glass/0/B1_C1_B2_C2_B3_C3");
    let [b, c] = [0, 1].map(|k| numbers.iter().skip(k).step_by(2).copied().collect::<Vec<f64>>());
    let c: Vec<String> = c.iter().map(|c| format!("\"{c:?} um2\"")).collect();
    format!("Sellmeier(b: {b:?}, c: [{}])", c.join(", "))
}

fn line(name: &str) -> f64 {
    LINES.iter().find(|line| line.0 == name).expect("a Fraunhofer line").1
}

/// Deviation (deg) of a ray by a prism, in air; `incidence` and `apex` in rad.
fn deviation(medium: &str, wavelength: f64, apex: f64, incidence: f64) -> f64 {
    // The outline has half an apex of arctan 1/2; the node's scale makes it what it should be, in f64.
    let outline = [DVec2::new(-10.0, -10.0), DVec2::new(10.0, -10.0), DVec2::new(0.0, 10.0)];
    let gltf = Model::new().add("prism", wedge(outline, 10.0)).gltf();
    let widen = 2.0 * (0.5 * apex).tan();
    let turn = incidence - 0.5 * apex;
    let direction = DVec3::new(turn.cos(), turn.sin(), 0.0);
    let sections = format!(
        "media: {{ \"glass\": {medium} }},
        surfaces: [(on: Node(\"prism\"), medium: \"glass\", specular: Fresnel)],
        {} {SINGLE}",
        pencil(DVec3::new(-5.0 * widen, 0.0, 0.0), direction, "Unpolarized", &format!("{wavelength} nm"))
    );
    let compiled = system(&sections, &scaled_node(&gltf, "prism", DVec3::new(widen, 1.0, 1.0)));
    let trace = watched(&compiled, 0);
    close(trace.seen.sights[0].angle, incidence, 1e-12, "angle of incidence");
    between(direction, trace.brightest().direction).to_degrees()
}

#[test]
fn dis_01_a_glass_written_in_text_has_its_catalogue_indices() {
    let case = Case::load("DIS-01");
    let beam = pencil(DVec3::ZERO, DVec3::Z, "Unpolarized", "550 nm");
    let sections =
        format!("media: {{ \"glass\": {} }}, surfaces: [(on: Node(\"b\"), medium: \"glass\")], {beam}", n_bk7());
    let compiled = system(&sections, &Model::new().add("b", cuboid(DVec3::ONE, DVec3::splat(2.0))).gltf());
    let glass = compiled.scene.media.iter().position(|m| m.label == "glass").expect("glass") as u16;
    let value = &case.values()[0];
    for (name, wavelength) in LINES {
        let n = compiled.scene.index(glass, wavelength * 1e-9).re;
        close(n, number(value, &format!("n_{name}")), case.tolerance("abs"), &format!("DIS-01 n_{name}"));
    }
}

fn prism(id: &str, medium: impl Fn(f64) -> String) {
    let case = Case::load(id);
    let (apex, tolerance) = (case.given("/apex_deg").to_radians(), case.tolerance("abs"));
    let mut least = f64::NAN;
    let mut indices = [f64::NAN; 3];
    for value in case.values() {
        let named = |key: &str| value[key].as_f64();
        let Some(name) = value["line"].as_str() else {
            // Angular dispersion F - C at the least deviation of d.
            let [f, c] = [("F", 0), ("C", 2)].map(|(l, k)| deviation(&medium(indices[k]), line(l), apex, least));
            close(f - c, number(&value, "value"), 2.0 * tolerance, &format!("{id} dispersion"));
            continue;
        };
        let n = value["n"].as_f64().unwrap_or(indices[1]);
        let (incidence, expected) = match named("delta_min_deg") {
            Some(delta) => (number(&value, "incidence_at_min_deg"), delta),
            None => (number(&value, "incidence_deg"), number(&value, "deviation_deg")),
        };
        let found = deviation(&medium(n), line(name), apex, incidence.to_radians());
        close(found, expected, tolerance, &format!("{id} {name} at {incidence} deg"));
        if named("delta_min_deg").is_some() {
            indices[["F", "d", "C"].iter().position(|l| *l == name).expect("F, d or C")] = n;
            if name == "d" {
                least = incidence.to_radians();
            }
            for aside in [-0.5f64, 0.5] {
                let more = deviation(&medium(n), line(name), apex, incidence.to_radians() + aside.to_radians());
                assert!(more > expected, "{id}: {more} deg beside the least deviation {expected} deg");
            }
        }
    }
}

#[test]
fn dis_02_prisms() {
    prism("DIS-02", |_| n_bk7());
    // The other glass is given by its indices.
    prism("DIS-02x", |n| format!("Constant(n: {n:?})"));
}

#[test]
fn vol_05_beer_lambert_on_oblique_paths() {
    for id in ["VOL-05", "VOL-05x"] {
        let case = Case::load(id);
        for value in case.values() {
            let (n, alpha) = (number(&value, "n"), number(&value, "alpha_per_mm"));
            let (thickness, theta) = (number(&value, "d_mm"), number(&value, "theta_deg").to_radians());
            // Of 1 nm, so that k = alpha lambda / 4 pi is too small to be seen in the reflectance.
            let sections = format!(
                "media: {{ \"glass\": Constant(n: {n:?}, absorption: \"{alpha:?} /mm\") }},
                surfaces: [(on: Node(\"slab\"), medium: \"glass\", specular: Fresnel)],
                detectors: {{ \"behind\": (on: FarField(axis: \"(0, 0, 1)\"), quantity: Intensity, pixels: (4, 4)) }},
                {} {CERTAIN}",
                pencil(DVec3::ZERO, downward(theta), "Unpolarized", "1 nm")
            );
            let half = 1500.0;
            let slab = cuboid(DVec3::new(-half, -half, -1.0), DVec3::new(half, half, 0.0));
            let gltf = scaled_node(&Model::new().add("slab", slab).gltf(), "slab", DVec3::new(1.0, 1.0, thickness));
            let compiled = system(&sections, &gltf);
            let (relative, what) = (case.tolerance("rel"), format!("{id} {n} {theta:.2} rad"));
            let sights = watched(&compiled, 0).seen.sights;
            let exit = sights.iter().find(|s| s.depth == 1).expect("the rear face");
            let flown = number(&value, "path_mm");
            close(exit.distance * 1e3, flown, relative * flown, &format!("{what} path"));
            let internal = exit.flux / (sights[0].flux * sights[0].fractions[1]);
            let expected = number(&value, "internal_transmittance");
            close(internal, expected, 8.0 * relative * expected, &format!("{what} internal"));
            let first = traced(&compiled).detectors["behind"].classes["signal"].mean;
            let expected = number(&value, "first_pass_T_unpol");
            close(first, expected, 8.0 * relative * expected, &format!("{what} first pass"));
        }
    }
}

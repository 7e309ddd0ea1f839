//! Beside Optiland: a mirror with haze, ring by ring of the sky, and glass under a quarter wave, from its face and as a slab.
//! `tests/data/optiland/reference.py` made the numbers and says how its models are ours.

use crate::lab::{CERTAIN, pencil, results, system, watched};
use crate::support::Model;
use crate::support::case::number;
use glam::DVec3;
use serde_json::Value;

/// What the script printed.
fn reference() -> Value {
    serde_json::from_str(include_str!("../data/optiland/reference.json")).expect("the script prints JSON")
}

fn list(value: &Value, name: &str) -> Vec<f64> {
    let list = value[name].as_array().unwrap_or_else(|| panic!("no {name}"));
    list.iter().map(|value| value.as_f64().expect("a number")).collect()
}

/// Source section: a pencil of 1 W that meets the origin in the plane y = 0 at an angle (rad) to +z.
fn beam(theta: f64, polarization: &str) -> String {
    pencil(DVec3::ZERO, DVec3::new(theta.sin(), 0.0, theta.cos()), polarization, "550 nm")
}

/// Flux and error of every ring about the specular ray, that ray left out, W; and what one scattered ray carries.
fn rings(mirror: &Value, count: usize) -> (Vec<[f64; 2]>, f64) {
    let [b0, l0, s, reflectance] = ["b0", "l0", "s", "reflectance"].map(|name| number(mirror, name));
    let theta = number(mirror, "degrees").to_radians();
    let knee = l0.powf(s);
    // What Optiland calls Harvey-Shack is ours where s = 2, and an ABg always.
    let haze = if s == 2.0 {
        format!("HarveyShack(b0: {b0:?}, l: {l0:?}, s: -2)")
    } else {
        format!("ABg(a: {:?}, b: {knee:?}, g: {s:?})", b0 * knee)
    };
    let text = format!(
        "geometry: [],
        elements: {{ \"mirror\": (body: Mirror(form: Plane, diameter: \"1 m\")) }},
        scatter: {{ \"haze\": {haze} }},
        surfaces: [(on: Tag(\"*front\"), specular: Mirror(reflectance: {reflectance:?}), scatter: \"haze\", order: Scaled)],
        detectors: {{ \"sky\": (on: FarField(axis: \"({:?}, 0, {:?})\"), quantity: Intensity, pixels: (1, {count})) }},
        {} run: (rays: 1000000, paths: 0),",
        theta.sin(),
        -theta.cos(),
        beam(theta, "Unpolarized")
    );
    let results = results(&text, &Model::new());
    let map = results.maps.iter().find(|map| map.detector == "sky").expect("a map");
    let specular = results.detectors["sky"].classes["signal"].mean;
    let ring = |i: usize| {
        let light = if i == 0 { specular } else { 0.0 };
        [map.mean[i] * map.extent[i] - light, map.error[i] * map.extent[i]]
    };
    let rings: Vec<[f64; 2]> = (0..count).map(ring).collect();
    let scattered: f64 = rings.iter().map(|ring| ring[0]).sum();
    (rings, scattered / results.rays as f64)
}

#[test]
fn haze_on_a_mirror_lies_where_optiland_has_it() {
    let reference = reference();
    for mirror in reference["mirrors"].as_array().expect("mirrors") {
        let [flux, error] = ["flux", "error"].map(|name| list(mirror, name));
        let (rings, ray) = rings(mirror, flux.len());
        // Where few rays arrive their error bar is itself a guess: twelve of either program.
        let rare = 12.0 * (ray + number(mirror, "reflectance") / number(&reference, "rays"));
        for (ring, [found, own]) in rings.into_iter().enumerate() {
            let (wanted, both) = (flux[ring], own.hypot(error[ring]));
            println!(
                "{} deg, ring {ring:2}: {found:.5e} +- {own:.1e}, Optiland {wanted:.5e} +- {:.1e}: {:+.2}",
                mirror["degrees"],
                error[ring],
                (found - wanted) / both
            );
            assert!((found - wanted).abs() <= 4.0 * both + rare, "ring {ring}: {found} {wanted} +- {both}");
        }
    }
}

/// A slab (mm) of the reference's glass under its film.
fn slab(reference: &Value, thickness: f64, source: &str) -> String {
    let [glass, film] = ["glass", "film"].map(|name| number(reference, name));
    format!(
        "geometry: [],
        media: {{ \"glass\": Constant(n: {glass:?}), \"film\": Constant(n: {film:?}) }},
        elements: {{ \"slab\": (body: Lens(surfaces: [(form: Plane), (form: Plane)], thickness: [\"{thickness:?} mm\"],
            media: [\"glass\"], diameter: \"1 m\")) }},
        coatings: {{ \"ar\": Stack(design: \"550 nm\", layers: [(\"film\", \"1/4 wave\")]) }},
        surfaces: [(on: Tag(\"*front\"), coating: \"ar\"), (on: Tag(\"*back\"), coating: \"ar\")],
        detectors: {{ \"sky\": (on: FarField(axis: \"(0, 0, 1)\"), quantity: Intensity, pixels: (1, 2)) }},
        {source} {CERTAIN}"
    )
}

#[test]
fn a_quarter_wave_on_glass_reflects_and_passes_what_optiland_says() {
    let reference = reference();
    for row in reference["face"].as_array().expect("rows") {
        let theta = number(row, "degrees").to_radians();
        let state = if row["polarization"] == "s" { "Linear(angle: \"0 deg\")" } else { "Linear(angle: \"90 deg\")" };
        let compiled = system(&slab(&reference, 5.0, &beam(theta, state)), &Model::new().gltf());
        let [r, t, ..] = watched(&compiled, 0).at(&compiled, "slab.front")[0].fractions;
        for (found, name) in [(r, "R"), (t, "T")] {
            let wanted = number(row, name);
            assert!((found - wanted).abs() < 1e-12, "{name} {row}: {found}");
        }
    }
    let wanted = &reference["slab"];
    let text = slab(&reference, number(wanted, "thickness_mm"), &beam(0.0, "Unpolarized"));
    let found = results(&text, &Model::new());
    let map = found.maps.iter().find(|map| map.detector == "sky").expect("a map");
    for (row, name) in ["passed", "returned"].into_iter().enumerate() {
        let (found, wanted, error) =
            (map.mean[row] * map.extent[row], number(wanted, name), number(wanted, &format!("{name}_error")));
        println!("{name}: {found:.6e}, Optiland {wanted:.6e} +- {error:.1e}");
        assert!((found - wanted).abs() < 4.0 * error, "{name}: {found} {wanted} +- {error}");
    }
}

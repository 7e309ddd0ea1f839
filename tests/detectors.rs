//! Rows and columns of maps: a spot off the axes must light the pixel that the documentation says.

use glam::DVec3;
use std::collections::BTreeMap;
use std::path::Path;
use std::sync::atomic::AtomicBool;
use straylight::system::compile::compile;
use straylight::system::document::Document;
use straylight::tally::results::{MapResult, Results};
use straylight::transport::{run, summary};

/// A slab of glass lit by a thin beam at (31, 11) mm along +z; `detectors` is RON.
fn slab(detectors: &str) -> Results {
    lit_slab(r#"Line("550 nm")"#, detectors, 1000)
}

/// The same by light of a spectrum.
fn lit_slab(spectrum: &str, detectors: &str, rays: u64) -> Results {
    let text = format!(
        r#"System(
            geometry: [(file: "slab.glb")],
            media: {{ "glass": Constant(n: 1.5) }},
            surfaces: [
                (on: Node("slab"), medium: "glass", specular: Ideal(reflectance: 0, transmittance: 1)),
                (on: Node("det_*"), specular: Absorb),
            ],
            sources: {{ "beam": (
                flux: "1 W", extent: Disk(radius: "0.1 mm"), at: "(31, 11, -20) mm",
                angular: Collimated(direction: "(0, 0, 1)"), spectrum: {spectrum},
            ) }},
            detectors: {{ {detectors} }},
            run: (rays: {rays}),
        )"#
    );
    let document = Document::parse(Path::new("systems/slab/test.ron"), text.as_bytes()).expect("the text is valid");
    let compiled = compile(&document).expect("the system is valid");
    let counts = run::<1>(&compiled.scene, &compiled.settings, &AtomicBool::new(false), &|_| {});
    summary::results(&compiled.scene, &compiled.settings, &counts, 0, BTreeMap::new(), Vec::new())
}

/// (row, column) of the only lit pixel.
fn lit(map: &MapResult) -> (usize, usize) {
    let lit: Vec<usize> = (0..map.mean.len()).filter(|&bin| map.mean[bin] > 0.0).collect();
    assert_eq!(lit.len(), 1, "{:?}", map.detector);
    (lit[0] / map.shape[1], lit[0] % map.shape[1])
}

fn map<'a>(results: &'a Results, name: &str) -> &'a MapResult {
    results.maps.iter().find(|map| map.detector == name).expect("the detector has a map")
}

#[test]
fn columns_run_along_x_and_rows_along_normal_cross_x() {
    let results = slab(
        r#"
        "towards": (on: Rectangle(at: "(0, 0, 20) mm", normal: "(0, 0, -1)", x: "(1, 0, 0)", width: "100 mm", height: "50 mm"),
                    quantity: Irradiance, pixels: (10, 5)),
        "away": (on: Rectangle(at: "(0, 0, 25) mm", normal: "(0, 0, 1)", x: "(1, 0, 0)", width: "100 mm", height: "50 mm"),
                 quantity: Irradiance, pixels: (10, 5)),
        "turned": (on: Rectangle(at: "(0, 0, 30) mm", normal: "(0, 0, 1)", x: "(0, 1, 0)", width: "50 mm", height: "100 mm"),
                   quantity: Irradiance, pixels: (5, 10)),
        "#,
    );
    // x = 31 of -50..50 in tens: column 8. y = 11 of -25..25 in tens: 3.6, row 3; with the normal turned over, y runs the other
    // way: 1.4, row 1. Turned by 90 degrees: column along y: 3; row along normal x y = -x: -31 of -50..50: row 1.
    assert_eq!(lit(map(&results, "away")), (3, 8));
    assert_eq!(lit(map(&results, "towards")), (1, 8));
    assert_eq!(lit(map(&results, "turned")), (1, 3));
}

#[test]
fn a_node_has_the_axes_that_its_map_states() {
    let results = slab(r#""det": (on: Node("det_t"), quantity: Irradiance, pixels: (80, 40))"#);
    let map = map(&results, "det");
    let (row, column) = lit(map);
    let axes = map.axes.as_ref().expect("a flat node has axes");
    let corner = DVec3::from_array(map.origin);
    let step = |axis: usize, index: usize| (index as f64 + 0.5) * axes[axis].step;
    let centre = corner
        + step(0, column) * DVec3::from_array(map.column_direction)
        + step(1, row) * DVec3::from_array(map.row_direction);
    let off = centre - DVec3::new(0.031, 0.011, 0.050);
    assert!(off.x.abs() <= 0.5 * axes[0].step + 1e-9 && off.y.abs() <= 0.5 * axes[1].step + 1e-9, "{off}");
    assert!(off.z.abs() < 1e-6, "the map lies in the plane of the node: {off}");
    assert!((DVec3::from_array(map.column_direction) - DVec3::X).length() < 1e-6, "columns run along world x");
}

#[test]
fn a_side_sees_only_its_own_light() {
    let window = |side: &str| {
        format!(
            r#""{side}": (on: Disk(at: "(31, 11, 20) mm", normal: "(0, 0, 1)", radius: "5 mm"), quantity: Irradiance, side: {side})"#
        )
    };
    let results = slab(&["Front", "Back", "Both"].map(window).join(","));
    let flux = |name: &str| results.detectors[name].flux_w.mean;
    assert_eq!(flux("Front"), 0.0);
    assert!((flux("Back") - 1.0).abs() < 1e-12 && (flux("Both") - 1.0).abs() < 1e-12);
    assert!(results.detectors["Front"].upper_limit_w.is_some_and(|limit| limit > 0.0));
}

/// Planck constant x speed of light, J m.
const HC: f64 = 1.986_445_857e-25;

const PLANE: &str = r#"on: Rectangle(at: "(31, 11, 20) mm", normal: "(0, 0, -1)", width: "1 mm", height: "1 mm"),
    quantity: Irradiance, pixels: (8, 8)"#;

/// One watt of 550 nm, by every measure; the map adds up to the whole.
#[test]
fn a_watt_is_so_many_photons_electrons_and_lumens() {
    let results = slab(&format!(
        r#""w": ({PLANE}), "ph": ({PLANE}, counts: Photons), "e": ({PLANE}, counts: Electrons(qe: [("500 nm", 0.2), ("600 nm", 0.6)])),
        "lm": ({PLANE}, counts: Lumens), "f": ({PLANE}, filter: [("500 nm", 0), ("600 nm", 0.5)]),
        "blind": ({PLANE}, counts: Electrons(qe: [("600 nm", 0.5), ("700 nm", 0.5)])),"#
    ));
    let photons = 550e-9 / HC;
    let known = [
        ("ph", "ph/s", "ph/s/px", photons),
        ("e", "e-/s", "e-/s/px", 0.4 * photons),
        ("lm", "lm", "lx", 683.002 * 0.99495),
        ("f", "W", "W/m2", 0.25),
        ("blind", "e-/s", "e-/s/px", 0.0),
    ];
    assert!(results.detectors["w"].counted.is_none());
    for (name, unit, of_bins, expected) in known {
        let found = &results.detectors[name];
        let counted = found.counted.as_ref().expect("it does not count watts");
        assert!((found.flux_w.mean - 1.0).abs() < 1e-9, "{name}: {:?}", found.flux_w);
        assert_eq!((counted.unit.as_str(), found.unit.as_str()), (unit, of_bins));
        assert!((counted.total.mean - expected).abs() <= 1e-8 * expected, "{name}: {counted:?}, expected {expected}");
        let map = map(&results, name);
        let sum: f64 = map.mean.iter().zip(&map.extent).map(|(mean, extent)| mean * extent).sum();
        assert!((sum - expected).abs() <= 1e-8 * expected, "{name}: the map adds up to {sum}, expected {expected}");
    }
}

/// A band and an efficiency that rises evenly over it: photons are weighed by the wavelength of each ray.
#[test]
fn electrons_of_a_band_are_an_integral() {
    let detectors = format!(r#""e": ({PLANE}, counts: Electrons(qe: [("400 nm", 0), ("700 nm", 0.6)])),"#);
    let results = lit_slab(r#"Band(from: "400 nm", to: "700 nm")"#, &detectors, 100_000);
    // Uniform per wavelength: the mean of lambda QE(lambda), with lambda = 400 nm + 300 nm u and QE = 0.6 u.
    let expected = 1e-9 * 0.6 * (400.0 / 2.0 + 300.0 / 3.0) / HC;
    let total = results.detectors["e"].counted.as_ref().expect("electrons").total;
    println!("{total:?}, expected {expected:e}");
    assert!((total.mean - expected).abs() < 4.0 * total.error + 1e-4 * expected, "{total:?}, expected {expected}");
    assert!(total.error < 1e-3 * expected);
}

/// A uniform disc of 0.1 mm: shares of its area.
#[test]
fn regions_hold_their_share() {
    let detectors = format!(
        r#""w": ({PLANE}, regions: [("core", Disk(at: ("0 mm", "0 mm"), radius: "0.05 mm")),
            ("ring", Annulus(at: ("0 mm", "0 mm"), inner: "0.05 mm", outer: "0.2 mm")),
            ("half", Rectangle(at: ("0.25 mm", "0 mm"), width: "0.5 mm", height: "1 mm"))]),"#
    );
    let results = lit_slab(r#"Line("550 nm")"#, &detectors, 200_000);
    let regions = &results.detectors["w"].regions;
    for (name, expected) in [("core", 0.25), ("ring", 0.75), ("half", 0.5)] {
        let found = regions[name];
        println!("{name}: {found:?}, expected {expected}");
        assert!((found.mean - expected).abs() < 4.0 * found.error + 1e-9, "{name}: {found:?}");
        assert!(found.error < 2e-3, "{name}: {found:?}");
    }
}

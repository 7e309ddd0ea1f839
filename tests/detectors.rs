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
                angular: Collimated(direction: "(0, 0, 1)"), spectrum: Line("550 nm"),
            ) }},
            detectors: {{ {detectors} }},
            run: (rays: 1000),
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

//! Optical contact and an air gap between glass and what lies on it.

mod bricks;

use std::sync::atomic::AtomicBool;
use straylight::system::compile::compile;
use straylight::system::document::Document;
use straylight::tally::results::Results;
use straylight::transport::{self, summary};

/// A glass slab that lies on a plate of the same size; both branches are followed up to `splits` reflections.
fn traced(plate: &str, gap: &str, direction: &str, splits: u32) -> Results {
    let folder = tempfile::tempdir().expect("folder");
    // 5 mm and 10 mm are not binary: the faces agree within the rounding of the file only.
    let slab = ("slab", [-0.1, -0.1, 0.0], [0.1, 0.1, 0.005]);
    let below = ("plate", [-0.1, -0.1, 0.005], [0.1, 0.1, 0.010]);
    std::fs::write(folder.path().join("bricks.gltf"), bricks::gltf(&[slab, below])).expect("geometry");
    let text = format!(
        r#"System(
            geometry: [(file: "bricks.gltf")],
            media: {{"glass": Constant(n: 1.5)}},
            scatter: {{"white": Lambertian(reflectance: 0.8)}},
            surfaces: [
                (on: Node("slab"), medium: "glass"),
                (on: Node("plate"), {plate}, gap: {gap}),
            ],
            sources: {{"beam": (flux: "1 W", extent: Disk(radius: "1 mm"), at: "(0, 0, -9) mm", axis: "(0, 0, 1)",
                angular: Collimated(direction: "{direction}"), spectrum: Line("550 nm"))}},
            detectors: {{"far": (on: FarField(axis: "(0, 0, -1)"), quantity: Intensity, pixels: (8, 8))}},
            run: (rays: 4096, splits: {splits}, max_events: 10000),
        )"#
    );
    let document = Document::parse(&folder.path().join("system.ron"), text.as_bytes()).expect("document");
    let compiled = compile(&document).expect("system");
    let counts = transport::run::<1>(&compiled.scene, &compiled.settings, &AtomicBool::new(false), &|_| {});
    let results = summary::results(&compiled.scene, &compiled.settings, &counts, 0, compiled.inputs, Vec::new());
    assert!(results.trusted, "{:?}", results.warnings);
    assert_eq!(results.ledger_w.lost.mean, 0.0);
    results
}

fn back(results: &Results) -> f64 {
    results.detectors["far"].flux_w.mean
}

const STRAIGHT: &str = "(0, 0, 1)";
/// Fresnel at normal incidence, n = 1.5.
const R: f64 = 0.04;

#[test]
fn glass_in_contact_with_black_reflects_at_its_front_only() {
    let reflected = back(&traced("specular: Absorb", "Contact", STRAIGHT, 20));
    assert!((reflected - R).abs() < 1e-12, "{reflected}");
}

/// All internal orders: R + (1-R)^2 R / (1 - R^2) = 2R / (1 + R).
#[test]
fn an_air_gap_before_black_reflects_as_a_free_slab_does() {
    let results = traced("specular: Absorb", "Air", STRAIGHT, 20);
    let (reflected, wanted) = (back(&results), 2.0 * R / (1.0 + R));
    // Roulette below 1e-12 of a ray is what a deterministic splitting run may miss.
    assert!((reflected - wanted).abs() < 1e-11, "{reflected} {wanted}");
    assert!((results.absorbed_w["plate"].mean - (1.0 - wanted)).abs() < 1e-11, "{:?}", results.absorbed_w);
}

/// Nothing absorbs: what goes to and fro in the gap comes back in the end.
#[test]
fn a_perfect_mirror_behind_an_air_gap_returns_everything() {
    for direction in [STRAIGHT, "(0, 0.6, 0.8)"] {
        let reflected = back(&traced("specular: Mirror(reflectance: 1)", "Air", direction, 1));
        assert!((reflected - 1.0).abs() < 1e-9, "{direction}: {reflected}");
    }
}

/// White paint in contact fills the glass up to total reflection; behind air it shines into the cone of refraction only,
/// so that more comes out. Both close their ledgers.
#[test]
fn paint_behind_air_is_brighter_than_paint_in_contact() {
    let [contact, air] = ["Contact", "Air"].map(|gap| traced("specular: Absorb, scatter: \"white\"", gap, STRAIGHT, 1));
    let error = contact.detectors["far"].flux_w.error.hypot(air.detectors["far"].flux_w.error);
    assert!(back(&air) - back(&contact) > 5.0 * error, "{} {}", back(&air), back(&contact));
    for results in [contact, air] {
        let residual = results.ledger_w.residual;
        assert!(residual.mean.abs() <= 5.0 * residual.error + 1e-12, "{residual:?}");
    }
}

//! Every watt is accounted for.

use crate::lab::*;
use crate::mixed;
use crate::support::shapes::{cuboid, facing, rectangle};
use crate::support::{self, Model};
use glam::DVec3;

#[test]
fn the_ledger_of_a_mixed_system_closes_within_its_error() {
    let run = "splits: 2, scatter_splits: 1, roulette: (below: 1e-3, survive: 0.3)";
    let found = support::run(&mixed::sections(run), &mixed::model(), 100_000, 3);
    let ledger = &found.ledger_w;
    println!("{ledger:#?}\n{:#?}\n{:#?}", found.absorbed_w, found.terminated_w);
    assert!(found.trusted, "{:?}", found.warnings);
    assert!((ledger.emitted.mean - 3.0).abs() < 1e-12 && ledger.lost.mean == 0.0);
    assert!(ledger.residual.error > 0.0 && ledger.residual.error < 1e-3 * ledger.emitted.mean);
    assert!(ledger.residual.mean.abs() < 4.0 * ledger.residual.error, "{:?}", ledger.residual);
    // Roulette plays often here, and neither makes light nor takes any.
    assert!(ledger.terminated.error > 1e-7 && ledger.terminated.mean.abs() < 4.0 * ledger.terminated.error);
    for part in ["slab", "mirror", "metal", "wall", "chip", "medium grey"] {
        assert!(found.absorbed_w[part].mean > 10.0 * found.absorbed_w[part].error, "{part}");
    }
    // Bare glass takes nothing at its face.
    assert!(found.absorbed_w.get("ball").is_none_or(|e| e.mean.abs() < 1e-12));
    let parts: f64 = found.absorbed_w.values().map(|e| e.mean).sum();
    close(parts, ledger.absorbed.mean, 1e-12 * parts, "absorbed, by part");
}

#[test]
fn what_limits_cut_is_booked_under_their_names() {
    let run = "max_scatters: 1, max_reflections: 2";
    let found = support::run(&mixed::sections(run), &mixed::model(), 20_000, 3);
    for name in ["max_scatters", "max_reflections"] {
        assert!(found.terminated_w[name].mean > 10.0 * found.terminated_w[name].error, "{:?}", found.terminated_w);
    }
    assert!(found.trusted && found.ledger_w.residual.mean.abs() < 4.0 * found.ledger_w.residual.error);
}

/// Where no direction is drawn, nothing is left to chance: glass, coatings, mirrors and metals, all branches followed.
#[test]
fn the_ledger_of_a_deterministic_run_closes_to_rounding() {
    let sections = format!(
        "media: {{ \"grey\": Constant(n: 1.5, absorption: \"0.02 /mm\") }},
        coatings: {{ \"lossy\": Ideal(reflectance: 0.1, transmittance: 0.85) }},
        surfaces: [
            (on: Node(\"block\"), medium: \"grey\", specular: Fresnel),
            (on: Node(\"plate\"), medium: \"grey\", coating: \"lossy\"),
            (on: Node(\"mirror\"), specular: Mirror(reflectance: 0.9)),
            (on: Node(\"metal\"), specular: Metal(n: 1.2, k: 6.5)),
        ],
        {} run: (rays: 64, batch: 1, splits: 64, roulette: (below: 1e-13, survive: 0.5), paths: 0),",
        pencil(DVec3::new(0.3, 0.2, 0.0), DVec3::new(0.1, 0.2, 1.0).normalize(), "Circular(Right)", "550 nm")
    );
    let at = |mesh: Vec<[DVec3; 3]>, z: f64| crate::support::shapes::moved(mesh, z * DVec3::Z);
    let model = Model::new()
        .add("block", cuboid(DVec3::new(-30.0, -30.0, 0.0), DVec3::new(30.0, 30.0, 4.0)))
        .add("plate", cuboid(DVec3::new(-30.0, -30.0, 9.0), DVec3::new(30.0, 30.0, 10.0)))
        .add("mirror", at(facing(rectangle(60.0, 60.0), DVec3::new(0.05, 0.0, -1.0)), 20.0))
        .add("metal", at(rectangle(10.0, 10.0), -20.0));
    let ledger = results(&sections, &model).ledger_w;
    println!("{ledger:#?}");
    assert!(ledger.residual.mean.abs() < 1e-12 * ledger.emitted.mean, "{:?}", ledger.residual);
    assert!(ledger.absorbed.mean > 0.1 && ledger.escaped.mean > 0.1 && ledger.lost.mean == 0.0);
    assert!(ledger.absorbed.error < 1e-9, "chance in a deterministic run: {:?}", ledger.absorbed);
}

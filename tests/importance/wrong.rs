//! A map that was learned for something else is as right as any: it costs variance.

use crate::ways::system;
use glam::DVec3;
use std::sync::atomic::AtomicBool;
use straylight::geometry::Frame;
use straylight::scene::Scene;
use straylight::settings::Settings;
use straylight::tally::results::Estimate;
use straylight::tally::{Fold, Live};
use straylight::transport::book::Book;
use straylight::transport::importance::{Importance, learn};
use straylight::transport::paths::Rows;
use straylight::transport::walk::{Walk, quotas};
use straylight::transport::watch::Unwatched;

/// Flux on the first detector, drawn by a map.
fn traced(scene: &Scene, settings: &Settings, importance: &Importance, seed: u64) -> Estimate {
    let quotas = quotas(scene, settings.batch_rays());
    let (layout, rows) = (scene.layout(0), Rows::default());
    let mut fold = Fold::default();
    for batch in 0..settings.batches() {
        let book = Book::<1>::new(&layout, Live::new(layout.len()), Some(&rows));
        let mut walk = Walk::new(scene, settings, importance, book, Unwatched);
        walk.seed = seed;
        walk.batch(batch, &quotas);
        fold.push(walk.book.finish());
    }
    fold.total().estimate(layout.detector(0), 0)
}

#[test]
fn a_map_of_another_source_and_detector_changes_nothing() {
    let right = system("triplet");
    let mut settings = right.settings.clone();
    settings.rays = 30_000;
    // Learned for light from the other side that comes to the front lens instead of the sensor.
    let mut other = system("triplet");
    other.scene.sources[0].angular.axis = Some(Frame::from_z(DVec3::new(0.0, 0.28, 0.96)));
    let front = other.scene.parts.iter().position(|part| part.label == "Lens_1.front").expect("a front lens");
    other.scene.parts.iter_mut().for_each(|part| part.detectors.clear());
    other.scene.parts[front].detectors.push(0);
    let quotas = quotas(&other.scene, settings.batch_rays());
    let wrong = learn(&other.scene, &settings, &quotas, settings.batch_rays(), &AtomicBool::new(false)).importance;
    assert!(wrong.map.is_some());
    let plain = traced(&right.scene, &settings, &Importance::declared(&right.scene), 1);
    let found = traced(&right.scene, &settings, &wrong, 2);
    println!("plain {plain:?}, by the wrong map {found:?}");
    assert!((plain.mean - found.mean).abs() < 4.0 * plain.error.hypot(found.error), "{plain:?}, {found:?}");
    assert!(found.error < 0.1 * found.mean && found.error != plain.error, "{plain:?}, {found:?}");
}

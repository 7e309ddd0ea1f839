//! What is drawn of a run, what is stray of it, and what is required of it: on a telescope with an image and stray light.

use glam::DVec3;
use std::collections::BTreeMap;
use std::path::Path;
use std::sync::LazyLock;
use std::sync::atomic::AtomicBool;
use straylight::settings::Settings;
use straylight::study::drawing::{draw, followed, sketch};
use straylight::study::requirement::judge;
use straylight::system::compile::{Compiled, Requirement, compile};
use straylight::system::document::{Document, Limit};
use straylight::tally::drawing::Way;
use straylight::tally::required::Verdict;
use straylight::tally::results::Results;
use straylight::transport::{run, summary};

struct Run {
    compiled: Compiled,
    results: Results,
    ways: Vec<Way>,
}

static RUN: LazyLock<Run> = LazyLock::new(|| {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("systems/questar/system.ron");
    let compiled = compile(&Document::read(&file).expect("a system")).expect("a sound system");
    let settings = Settings { rays: 1 << 15, ways: true, ..compiled.settings.clone() };
    let counts = run::<1>(&compiled.scene, &settings, &AtomicBool::new(false), &|_| ());
    let results = summary::results(&compiled.scene, &settings, &counts, 0, BTreeMap::new(), Vec::new());
    let ways = followed(&compiled.scene, &counts);
    Run { compiled, results, ways }
});

#[test]
fn the_map_of_stray_light_holds_the_stray_light_and_no_more() {
    for map in &RUN.results.maps {
        let found = &RUN.results.detectors[&map.detector];
        let [stray, _] = map.stray.as_ref().expect("a telescope has optics");
        let flux = |values: &[f64]| values.iter().zip(&map.extent).map(|(value, extent)| value * extent).sum::<f64>();
        let near = |a: f64, b: f64| (a - b).abs() <= 1e-12 * found.flux_w.mean; // sums in another order
        assert!(near(flux(&map.mean), found.flux_w.mean));
        assert!(near(flux(stray), found.stray.flux_w.mean));
        let signal = found.stray.signal_w.expect("an image").mean;
        assert!(signal > 0.0 && found.stray.flux_w.mean > 0.0);
        assert!(near(signal + found.stray.flux_w.mean, found.flux_w.mean));
        assert!(stray.iter().zip(&map.mean).all(|(stray, all)| *stray <= all * (1.0 + 1e-12)));
    }
}

#[test]
fn a_way_has_a_corner_for_every_step_and_ends_on_its_detector() {
    assert!(RUN.ways.len() > 20, "{}", RUN.ways.len());
    assert!(RUN.ways.iter().any(|way| way.class == "signal") && RUN.ways.iter().any(|way| way.class != "signal"));
    for way in &RUN.ways {
        let [detector, sequence] = way.path.as_ref().expect("a path");
        let steps = sequence.split(" > ").count();
        // The source and every step, and the end on the detector; films have no flights of their own.
        assert!(way.points.len() > steps / 2 && way.points.len() <= steps + 1, "{} {sequence}", way.points.len());
        let map = RUN.results.maps.iter().find(|map| map.detector == *detector).expect("a map");
        let [column, row] = [map.column_direction, map.row_direction].map(DVec3::from_array);
        let end = way.points[way.points.len() - 1] + RUN.compiled.scene.shift - DVec3::from_array(map.origin);
        assert!(end.dot(column.cross(row)).abs() < 1e-9, "{end} m from the corner of {detector}");
        let [axis, _] = map.axes.as_ref().expect("pixels");
        assert!((-1e-9..axis.step * map.shape[1] as f64 + 1e-9).contains(&end.dot(column)), "{end}");
    }
}

#[test]
fn what_was_kept_of_the_ways_changes_no_number() {
    let scene = &RUN.compiled.scene;
    let settings = Settings { rays: 1 << 12, ..RUN.compiled.settings.clone() };
    let flux = |ways: bool| {
        let counts = run::<1>(scene, &Settings { ways, ..settings.clone() }, &AtomicBool::new(false), &|_| ());
        (counts.sums.estimate(counts.layout.detector(0), 0), counts.ways.is_empty())
    };
    let (plain, watched) = (flux(false), flux(true));
    assert_eq!(plain.0, watched.0);
    assert_eq!((plain.1, watched.1), (true, false));
}

#[test]
fn a_drawing_holds_every_part_and_every_source() {
    let scene = &RUN.compiled.scene;
    let drawing = draw(scene);
    let drawn: usize = drawing.parts.iter().map(|part| part.triangles).sum();
    assert_eq!((drawing.parts.len(), drawn), (scene.parts.len(), drawing.triangles.len()));
    assert_eq!((drawing.moved, drawing.all_triangles), (0.0, drawing.triangles.len()));
    assert!(drawing.parts.iter().any(|part| part.solid && part.media[0] != part.media[1]), "no lens");
    let ways = sketch(scene, &RUN.compiled.settings, 50);
    for source in &scene.sources {
        assert!(ways.iter().any(|way| way.source == source.label), "{}", source.label);
    }
    assert!(ways.iter().all(|way| way.points.len() > 1));
}

#[test]
fn a_verdict_turns_where_the_limit_passes_the_value() {
    let stray = &RUN.results.detectors[&RUN.compiled.scene.detectors[0].label].stray;
    let ratio = stray.to_signal.expect("an image");
    let of = |limit: Limit| {
        let one = Requirement { label: "veil".into(), detector: 0, limit, confidence: 0.95 };
        judge(&[one], &RUN.compiled.scene, &RUN.results).remove(0).required
    };
    assert_eq!(of(Limit::StrayToSignal(ratio.mean + 4.0 * ratio.error)).verdict, Verdict::Pass);
    assert_eq!(of(Limit::StrayToSignal(ratio.mean)).verdict, Verdict::NotResolved);
    assert_eq!(of(Limit::StrayToSignal(ratio.mean - 4.0 * ratio.error)).verdict, Verdict::Fail);
    let twice = straylight::system::units::Flux(2.0 * stray.flux_w.mean);
    assert!((of(Limit::StrayFlux(twice)).margin - 2.0).abs() < 1e-12);
}

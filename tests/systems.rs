//! Every shipped system, traced and held to the numbers in its `expected.ron`, its ledger and its path table.

use serde::Deserialize;
use std::collections::BTreeMap;
use std::path::Path;
use std::sync::atomic::AtomicBool;
use straylight::error::Error;
use straylight::system::compile::{Compiled, compile};
use straylight::system::document::Document;
use straylight::tally::results::Results;
use straylight::transport::{self, summary};

/// `systems/NAME/expected.ron`: what each system file of a folder must give.
type Expected = BTreeMap<String, Case>;

/// One system file.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Case {
    /// Source rays of the test.
    rays: u64,
    detectors: BTreeMap<String, Flux>,
    /// Surfaces that the path table must name as the last that scattered, by detector.
    #[serde(default)]
    walls: BTreeMap<String, Vec<String>>,
    /// What the path of most flux must be, by detector.
    #[serde(default)]
    strongest: BTreeMap<String, String>,
}

/// A reference value: |flux - flux_w| <= 4 sqrt(error_w^2 + error of the run^2) + within x flux_w.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Flux {
    /// W.
    flux_w: f64,
    /// Standard error of the reference, W.
    error_w: f64,
    /// What the models may differ by, as a fraction of `flux_w`.
    #[serde(default)]
    within: f64,
    /// Who says so.
    source: String,
}

/// Standard errors of run and reference together that a difference may come to.
const SIGMAS: f64 = 4.0;

fn folder() -> std::path::PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("systems")
}

fn trace(system: &Path, rays: u64) -> Result<Results, Error> {
    let document = Document::read(system)?;
    let Compiled { scene, mut settings, inputs, warnings, .. } = compile(&document)?;
    settings.rays = rays;
    let counts = transport::run::<1>(&scene, &settings, &AtomicBool::new(false), &|_| ());
    let warnings = warnings.iter().map(ToString::to_string).collect();
    Ok(summary::results(&scene, &settings, &counts, 0, inputs, warnings))
}

fn expected(name: &str) -> Expected {
    let file = folder().join(name).join("expected.ron");
    let text = std::fs::read_to_string(&file).unwrap_or_else(|error| panic!("{}: {error}", file.display()));
    ron::from_str(&text).unwrap_or_else(|error| panic!("{}: {error}", file.display()))
}

/// Traces every system file of `systems/NAME`.
fn hold(name: &str) -> BTreeMap<String, Results> {
    let run = |(file, case): (String, Case)| {
        let place = format!("systems/{name}/{file}");
        let results =
            trace(&folder().join(name).join(&file), case.rays).unwrap_or_else(|error| panic!("{place}: {error}"));
        fluxes(&place, &case, &results);
        ledger(&place, &results);
        paths(&place, &case, &results);
        (file, results)
    };
    expected(name).into_iter().map(run).collect()
}

fn fluxes(place: &str, case: &Case, results: &Results) {
    let named: Vec<&String> = case.detectors.keys().collect();
    assert_eq!(named, results.detectors.keys().collect::<Vec<_>>(), "{place}: detectors");
    for (detector, reference) in &case.detectors {
        let flux = results.detectors[detector].flux_w;
        let allowed = SIGMAS * flux.error.hypot(reference.error_w) + reference.within * reference.flux_w;
        let off = flux.mean - reference.flux_w;
        assert!(
            off.abs() <= allowed && flux.error > 0.0,
            "{place}: {detector}: {} ± {} W, expected {} ± {} W ({})",
            flux.mean,
            flux.error,
            reference.flux_w,
            reference.error_w,
            reference.source
        );
        let classes: f64 = results.detectors[detector].classes.values().map(|class| class.mean).sum();
        assert!((classes / flux.mean - 1.0).abs() < 1e-9, "{place}: {detector}: classes add up to {classes} W");
    }
}

fn ledger(place: &str, results: &Results) {
    let (mean, error) = (results.ledger_w.residual.mean, results.ledger_w.residual.error);
    let emitted = results.ledger_w.emitted.mean;
    assert!(results.trusted, "{place}: {:?}", results.warnings);
    assert!(mean.abs() <= SIGMAS * error + 1e-12 * emitted, "{place}: residual {mean} ± {error} W");
    assert!(error < 2e-3 * emitted, "{place}: the ledger is open by ± {error} W");
    assert_eq!(results.ledger_w.lost.mean, 0.0, "{place}: lost to geometry faults: {:?}", results.lost_w);
}

fn paths(place: &str, case: &Case, results: &Results) {
    for path in results.paths.iter().filter(|path| path.scatter_order > 0) {
        let wall = &path.last_scatter;
        assert!(path.sequence.contains(&format!("> {wall}:S")), "{place}: {}: last {wall:?}", path.sequence);
        assert!(results.absorbed_w.contains_key(wall), "{place}: {wall:?} scatters, but absorbs nothing");
    }
    for (detector, walls) in &case.walls {
        for wall in walls {
            let mut paths = results.paths.iter().filter(|path| path.detector == *detector);
            assert!(paths.any(|path| path.last_scatter == *wall), "{place}: no path by {wall:?} to {detector:?}");
        }
    }
    for (detector, sequence) in &case.strongest {
        let first = results.paths.iter().find(|path| path.detector == *detector);
        assert_eq!(first.map(|path| &path.sequence), Some(sequence), "{place}: strongest path to {detector:?}");
    }
    for (detector, result) in &results.detectors {
        let rows = results.paths.iter().filter(|path| path.detector == *detector);
        let sum: f64 = rows.map(|path| path.flux_w.mean).sum();
        assert!((sum / result.flux_w.mean - 1.0).abs() < 1e-9, "{place}: {detector}: paths add up to {sum} W");
    }
}

#[test]
fn the_slab_reflects_and_transmits_every_order() {
    hold("slab");
}

#[test]
fn the_integrating_sphere_fills_its_port() {
    hold("integrating_sphere");
}

#[test]
fn the_baffled_tube_lets_ten_millionths_of_a_per_cent_through() {
    hold("baffled_tube");
}

#[test]
fn the_triplet_agrees_with_the_published_flux() {
    hold("triplet");
}

#[test]
fn the_fast_lens_agrees_with_the_published_flux() {
    hold("fast_lens");
}

#[test]
fn the_questar_passes_what_paraxial_optics_says() {
    hold("questar");
}

#[test]
fn the_double_gauss_keeps_its_stray_light() {
    hold("double_gauss");
}

#[test]
fn the_star_tracker_shows_its_curve_over_ten_decades() {
    let results = hold("star_tracker");
    let sources = &results["system.ron"].detectors["sensor"].sources;
    let flux = |angle: &str| sources[format!("sky {angle}").as_str()];
    for angle in ["10 deg", "21 deg", "30 deg", "40 deg", "50 deg"] {
        let (near, far) = (flux("1 deg"), flux(angle));
        assert!(far.mean > 0.0 && far.mean + 4.0 * far.error < 1e-8 * near.mean, "{angle}: {far:?}, 1 deg: {near:?}");
    }
    assert!(flux("6 deg").mean > 1e-6 * flux("1 deg").mean, "{:?}", flux("6 deg"));
}

/// Nine decades from the image to the last angle, and the sky beside the secondary mirror: at 12 degrees the sun shines into the baffle.
#[test]
fn the_small_telescope_sees_the_sky_beside_its_secondary_mirror() {
    let results = hold("small_telescope");
    let sources = &results["system.ron"].detectors["sensor"].sources;
    let flux = |angle: &str| sources[format!("sky {angle}").as_str()];
    let (image, beside, far) = (flux("0 deg"), flux("12 deg"), flux("80 deg"));
    assert!(far.mean > 0.0 && far.mean + 4.0 * far.error < 1e-8 * image.mean, "{far:?}, image {image:?}");
    let dark = flux("20 deg");
    assert!(beside.mean > 10.0 * dark.mean, "{beside:?}, {dark:?}");
}

#[test]
fn every_shipped_system_is_held_to_its_numbers() {
    let mut shipped = Vec::new();
    for entry in std::fs::read_dir(folder()).expect("systems/ can be listed") {
        let path = entry.expect("an entry of it").path();
        for file in std::fs::read_dir(&path).expect("a system's folder can be listed") {
            let file = file.expect("an entry of it").path();
            if file.extension().is_some_and(|e| e == "ron") && !file.ends_with("expected.ron") {
                let name = |path: &Path| path.file_name().map(|n| n.to_string_lossy().into_owned()).unwrap_or_default();
                shipped.push((name(&path), name(&file)));
            }
        }
        assert!(path.join("README.md").exists(), "{}: no README.md", path.display());
    }
    for (folder, file) in &shipped {
        assert!(expected(folder).contains_key(file), "systems/{folder}/{file}: nothing is expected of it");
    }
    let mut folders: Vec<&str> = shipped.iter().map(|(folder, _)| folder.as_str()).collect();
    folders.sort_unstable();
    folders.dedup();
    assert_eq!(
        folders,
        [
            "baffled_tube",
            "double_gauss",
            "fast_lens",
            "integrating_sphere",
            "questar",
            "slab",
            "small_telescope",
            "star_tracker",
            "triplet"
        ],
        "is there a test for each?"
    );
}

/// The example of the README is a function of this file, so that it compiles.
#[test]
fn the_example_of_the_readme_is_compiled() {
    let readme = include_str!("../README.md");
    let example = readme.split("```rust\n").nth(1).and_then(|rest| rest.split("```").next()).expect("an example");
    let here = include_str!("systems.rs");
    let body = example.split("fn trace").nth(1).expect("a function `trace`");
    assert!(here.contains(body.trim_end()), "the function `trace` of the README is not the one of this file");
    for line in example.lines().filter(|line| line.starts_with("use ")) {
        assert!(here.contains(line), "the README says `{line}`");
    }
}

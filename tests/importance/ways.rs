//! Ways to draw, and whether two runs agree in every class and pixel.

use glam::DVec3;
use std::path::Path;
use std::sync::atomic::AtomicBool;
use straylight::aim::Target;
use straylight::geometry::Frame;
use straylight::math::statistics::chi_squared_tail;
use straylight::settings::{Guidance, Trace};
use straylight::system::compile::{Compiled, compile};
use straylight::system::document::Document;
use straylight::tally::results::{Estimate, MapResult, Results};
use straylight::transport::{self, summary};

/// How a run draws.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Way {
    Plain,
    /// Every surface aims at this box: centre (world, m) and half sides (m).
    Aimed([f64; 3], [f64; 3]),
    Learned,
    /// From the detectors.
    Backward,
    /// The same after learning where light is.
    LearnedBackward,
}

pub fn system(name: &str) -> Compiled {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("systems").join(name).join("system.ron");
    let document = Document::read(&path).unwrap_or_else(|e| panic!("{:#?}", e.problems()));
    compile(&document).unwrap_or_else(|e| panic!("{:#?}", e.problems()))
}

pub fn trace(mut compiled: Compiled, way: Way, rays: u64, seed: u64, threads: usize) -> Results {
    (compiled.settings.rays, compiled.settings.seed) = (rays, seed);
    match way {
        Way::Plain => compiled.settings.importance = Guidance::Off,
        Way::Learned => compiled.settings.importance = Guidance::On,
        Way::Backward => {
            (compiled.settings.importance, compiled.settings.trace) = (Guidance::Off, Trace::Backward);
        }
        Way::LearnedBackward => {
            (compiled.settings.importance, compiled.settings.trace) = (Guidance::On, Trace::Backward);
        }
        Way::Aimed(centre, half) => {
            compiled.settings.importance = Guidance::Off;
            let scene = &mut compiled.scene;
            let centre = DVec3::from(centre) - scene.shift;
            let target = Target { label: "box".into(), frame: Frame::WORLD, centre, half: half.into() };
            scene.targets.push(target);
            scene.parts.iter_mut().for_each(|part| part.aims = [vec![0], vec![0]]);
        }
    }
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
    let (scene, settings) = (&compiled.scene, &compiled.settings);
    let counts = pool.install(|| transport::run::<1>(scene, settings, &AtomicBool::new(false), &|_| ()));
    summary::results(scene, settings, &counts, 0, compiled.inputs.clone(), Vec::new())
}

/// Chance of differences like these, squared and in their own errors, and how many there are. What few source rays fed has no
/// error bar worth the name.
pub fn agreement(a: &Results, b: &Results) -> (f64, usize) {
    let mut pulls = Vec::new();
    let mut compare = |a: Estimate, b: Estimate| {
        let error = a.error.hypot(b.error);
        if error > 0.0 {
            pulls.push((a.mean - b.mean) / error);
        }
    };
    for (name, one) in &a.detectors {
        let other = &b.detectors[name];
        for (class, flux) in &one.classes {
            let found = other.classes.get(class).copied().unwrap_or_default();
            if flux.error < 0.1 * flux.mean && found.error < 0.1 * found.mean {
                compare(*flux, found);
            }
        }
    }
    for (one, other) in a.maps.iter().zip(&b.maps) {
        for bin in 0..one.mean.len() {
            if one.rays[bin].min(other.rays[bin]) >= 200 {
                let of = |map: &MapResult| Estimate { mean: map.mean[bin], error: map.error[bin] };
                compare(of(one), of(other));
            }
        }
    }
    let chi: f64 = pulls.iter().map(|pull| pull * pull).sum();
    (chi_squared_tail(chi, pulls.len() as f64), pulls.len())
}

/// Least chance of a difference as large as one that is found, where nothing else is said.
const LEAST: f64 = 1e-3;

/// Runs a system in several ways and holds them to each other.
pub fn agree(name: &str, make: impl Fn() -> Compiled, rays: u64, ways: &[Way]) {
    agree_within(LEAST, name, make, rays, ways);
}

/// The same; differences as large may have the chance `least`.
pub fn agree_within(least: f64, name: &str, make: impl Fn() -> Compiled, rays: u64, ways: &[Way]) {
    let plain = trace(make(), Way::Plain, rays, 1, 2);
    for (i, &way) in ways.iter().enumerate() {
        let other = trace(make(), way, rays, 2 + i as u64, 2);
        let (p, count) = agreement(&plain, &other);
        println!("{name}, {way:?}: {count} numbers agree with p = {p:.3}");
        for (detector, found) in &other.detectors {
            println!("    {detector}: {:?}, plain {:?}", found.flux_w, plain.detectors[detector].flux_w);
        }
        assert!(count > 1 && p > least, "{name}, {way:?}: {count} numbers differ with p = {p}");
        let residual = other.ledger_w.residual;
        assert!(residual.mean.abs() < 4.5 * residual.error + 1e-12, "{name}, {way:?}: residual {residual:?}");
        assert!(other.trusted, "{name}, {way:?}: {:?}", other.warnings);
    }
}

//! Variants side by side: packets that carry one flux per finish of the wall, so that the comparison is paired.

use std::path::Path;
use std::sync::atomic::AtomicBool;
use straylight::packet::Class;
use straylight::scene::Scene;
use straylight::settings::Settings;
use straylight::system::compile::{Compiled, compile};
use straylight::system::document::Document;
use straylight::tally::results::Estimate;
use straylight::transport::run;

fn load(file: &str) -> Compiled {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("systems/triplet").join(file);
    let document = Document::read(&path).expect("the system ships with the project");
    compile(&document).expect("the system compiles")
}

/// One scene whose lanes are the finishes of several files that differ in nothing else.
fn side_by_side(files: [&str; 3]) -> Scene {
    let [mut scene, others @ ..] = files.map(|file| load(file).scene);
    for other in others {
        let offset = scene.surfaces.len() as u32;
        scene.surfaces.extend(other.surfaces);
        for (part, variant) in scene.parts.iter_mut().zip(other.parts) {
            assert_eq!(part.label, variant.label);
            part.surface.push(variant.surface[0].map(|surface| surface + offset));
        }
    }
    scene
}

fn mean_and_error(values: &[f64]) -> Estimate {
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    let variance = values.iter().map(|v| (v - mean) * (v - mean)).sum::<f64>() / (n - 1.0);
    Estimate { mean, error: (variance / n).sqrt() }
}

/// Ratios of the low and the high wall to the plausible one, from `seeds` runs of `rays` rays each.
fn ratios(seeds: u64, rays: u64) -> [Estimate; 2] {
    let scene = side_by_side(["low.ron", "system.ron", "high.ron"]);
    let stop = AtomicBool::new(false);
    let runs: Vec<[f64; 3]> = (0..seeds)
        .map(|seed| {
            let settings = Settings { rays, seed, paths: 0, ..load("system.ron").settings };
            let counts = run::<3>(&scene, &settings, &stop, &|_| ());
            [0, 1, 2].map(|lane| counts.sums.estimate(counts.layout.detector(0), lane).mean)
        })
        .collect();
    [0, 2].map(|lane| mean_and_error(&runs.iter().map(|flux| flux[lane] / flux[1]).collect::<Vec<_>>()))
}

/// Each lane has the flux of a run of its own.
#[test]
fn a_lane_has_the_flux_of_a_run_of_its_own() {
    let files = ["low.ron", "system.ron", "high.ron"];
    let scene = side_by_side(files);
    let settings = |seed| Settings { rays: 4096, seed, paths: 0, ..load("system.ron").settings };
    let stop = AtomicBool::new(false);
    let together = run::<3>(&scene, &settings(1), &stop, &|_| ());
    for (lane, file) in files.into_iter().enumerate() {
        let alone = run::<1>(&load(file).scene, &settings(2), &stop, &|_| ());
        let slot = alone.layout.detector(0);
        let (a, b) = (together.sums.estimate(slot, lane), alone.sums.estimate(slot, 0));
        assert!((a.mean - b.mean).abs() < 4.0 * a.error.hypot(b.error), "{file}: {a:?} {b:?}");
    }
}

/// The tables of the three walls are one table times 0.5, 1 and 2, to six digits. So light scattered n times is 0.5^n : 1 : 2^n in
/// one trace, and ghosts are the same in all lanes.
#[test]
fn light_scattered_n_times_goes_with_the_nth_power_of_the_wall() {
    let scene = side_by_side(["low.ron", "system.ron", "high.ron"]);
    let settings = Settings { rays: 8192, paths: 0, ..load("system.ron").settings };
    let counts = run::<3>(&scene, &settings, &AtomicBool::new(false), &|_| ());
    let flux =
        |class: Class| [0, 1, 2].map(|lane| counts.sums.estimate(counts.layout.class(0, class.index()), lane).mean);
    for n in 1..=3 {
        let [low, plausible, high] = flux(Class::Scatter(n));
        let power = 2f64.powi(n.into());
        println!("scatter {n}: {:.7} : 1 : {:.7}", low / plausible, high / plausible);
        assert!(plausible > 0.0 && (low / plausible * power - 1.0).abs() < 1e-5, "{low} {plausible}");
        assert!((high / plausible / power - 1.0).abs() < 1e-5, "{high} {plausible}");
    }
    let [low, plausible, high] = flux(Class::Ghost(2));
    assert!(plausible > 0.0 && low == plausible && high == plausible, "{low} {plausible} {high}");
}

/// Published: 0.5 : 1 : 2. The ghosts, 2.5 % of the plausible flux, do not scale with the wall.
#[test]
fn walls_scale_the_stray_light_of_the_triplet() {
    let [low, high] = ratios(6, 1024);
    println!("low {:.4} ± {:.4}, high {:.4} ± {:.4}", low.mean, low.error, high.mean, high.error);
    assert!(low.error < 0.005 * low.mean && high.error < 0.005 * high.mean, "{low:?} {high:?}");
    assert!((low.mean - 0.5).abs() < 4.0 * low.error + 0.015, "{low:?}");
    assert!((high.mean - 2.0).abs() < 4.0 * high.error + 0.06, "{high:?}");
}

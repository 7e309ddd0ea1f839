//! What learned importance gains: figures of merit 1 / (R^2 x thread seconds), learning and trial included, of runs that draw light as
//! it scatters and of runs that learn, side by side. Prints the table of the README: medians of seeds, on all cores.

use std::path::Path;
use std::sync::atomic::AtomicBool;
use std::time::Instant;
use straylight::settings::{Guidance, Settings, Trace};
use straylight::system::compile::compile;
use straylight::system::document::Document;
use straylight::transport::run;

/// System file, detector, and source rays plain and learned: about as long a run each.
const SCENES: [(&str, usize, [u64; 2]); 6] = [
    ("baffled_tube/system.ron", 0, [4_000_000, 200_000]),
    ("baffled_tube/lens.ron", 0, [3_000_000, 400_000]),
    ("triplet/system.ron", 0, [100_000, 100_000]),
    ("double_gauss/system.ron", 0, [100_000, 100_000]),
    ("questar/system.ron", 0, [100_000, 100_000]),
    ("integrating_sphere/system.ron", 0, [100_000, 100_000]),
];

const SEEDS: u64 = 5;

/// Ways to run, by what the table calls them.
const WAYS: [(&str, Guidance, Trace); 3] = [
    ("plain", Guidance::Off, Trace::Forward),
    ("learned", Guidance::Auto, Trace::Forward),
    ("learned, backward", Guidance::Auto, Trace::Backward),
];

/// Figure of merit of one run, 1/s.
fn merit(path: &Path, detector: usize, way: usize, rays: u64, seed: u64) -> f64 {
    let document = Document::read(path).expect("the system ships with the project");
    let compiled = compile(&document).expect("the system compiles");
    let (_, importance, trace) = WAYS[way];
    let settings = Settings { rays, seed, importance, trace, until: None, ..compiled.settings };
    let start = Instant::now();
    let counts = run::<1>(&compiled.scene, &settings, &AtomicBool::new(false), &|_| ());
    let seconds = start.elapsed().as_secs_f64() * rayon::current_num_threads() as f64;
    let flux = counts.sums.estimate(counts.layout.detector(detector), 0);
    (flux.mean / flux.error).powi(2) / seconds
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

fn main() {
    // Seeds of all ways take turns, so that a slow minute of the machine is everyone's. A part of a file's name chooses scenes.
    let wanted = std::env::args().skip(1).find(|argument| !argument.starts_with('-')).unwrap_or_default();
    println!("| system | rays | {} | learned / plain |", WAYS.map(|way| way.0).join(" | "));
    println!("|---|---|{}---|", "---|".repeat(WAYS.len()));
    for (file, detector, rays) in SCENES.into_iter().filter(|scene| scene.0.contains(&wanted)) {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("systems").join(file);
        let mut merits = vec![Vec::new(); WAYS.len()];
        for (seed, way) in (1..=SEEDS).flat_map(|seed| (0..WAYS.len()).map(move |way| (seed, way))) {
            merits[way].push(merit(&path, detector, way, rays[(way > 0) as usize], seed));
        }
        let medians: Vec<f64> = merits.into_iter().map(median).collect();
        let shown: Vec<String> = medians.iter().map(|merit| format!("{merit:.3e}")).collect();
        println!("| {file} | {rays:?} | {} | {:.3} |", shown.join(" | "), medians[1] / medians[0]);
    }
}

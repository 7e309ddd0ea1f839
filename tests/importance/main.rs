//! Importance changes what is drawn and never the answer: plain, aimed, aimed at the wrong place and learned agree in every
//! class and pixel, on any number of threads, with a ledger that closes.

#[allow(unused_imports, reason = "one harness, several test targets")]
#[path = "../support/mod.rs"]
mod support;
mod ten;
mod ways;
mod wrong;

use glam::DVec3;
use straylight::settings::{Guidance, Trace};
use straylight::tally::results::Results;
use support::shapes::{disk, flipped, moved, rectangle};
use support::{Case, Model, compiled};
use ways::{Way, agree, system, trace};

#[test]
fn a_sphere_of_many_bounces() {
    // The box is the detector, then a place of no use inside the sphere.
    let ways = [
        Way::Learned,
        Way::Aimed([0.0, 0.0, -0.0994], [0.01, 0.01, 0.0]),
        Way::Aimed([0.05, 0.0, 0.0], [0.01; 3]),
        Way::Backward,
        Way::LearnedBackward,
    ];
    agree("sphere", || system("integrating_sphere"), 50_000, &ways);
}

#[test]
fn a_lens_in_a_measured_black_housing() {
    let ways =
        [Way::Learned, Way::Aimed([0.0, 0.0, 0.06], [0.0125, 0.0125, 0.0]), Way::Aimed([0.0, 0.3, 0.0], [0.02; 3])];
    agree("triplet", || system("triplet"), 80_000, &ways);
    // The wall is glossy at grazing angles: from the detector, "scatter 2" has rare large contributions that make its own error too
    // small in one run of three, so only the sum is held to the others.
    let [plain, other] = [Way::Learned, Way::LearnedBackward]
        .map(|way| trace(system("triplet"), way, 80_000, 7, 2).detectors["fpa"].flux_w);
    println!("learned {plain:?}, backwards {other:?}");
    assert!((plain.mean - other.mean).abs() < 4.0 * plain.error.hypot(other.error), "{plain:?}, {other:?}");
}

#[test]
fn a_telescope_of_two_mirrors() {
    agree("questar", || system("questar"), 80_000, &[Way::Learned, Way::LearnedBackward]);
}

/// Where plain tracing sees next to nothing: against the published-code reference of `systems/baffled_tube/expected.ron`.
#[test]
fn a_baffled_tube_at_thirty_degrees() {
    let results = trace(system("baffled_tube"), Way::Learned, 60_000, 5, 2);
    let flux = results.detectors["fpa"].flux_w;
    let (reference, error) = (2.656e-7, 0.010e-7);
    println!("{flux:?}, reference {reference:e} ± {error:e}");
    assert!(flux.error < 0.03 * flux.mean, "{flux:?}");
    assert!((flux.mean - reference).abs() < 4.0 * flux.error.hypot(error), "{flux:?}");
    let plain = trace(system("baffled_tube"), Way::Plain, 60_000, 5, 2).detectors["fpa"].flux_w;
    assert!(flux.error < 0.1 * plain.error, "learned {flux:?}, plain {plain:?}");
}

/// The same from the detector, plain and guided by where light is.
#[test]
fn a_baffled_tube_from_its_detector() {
    let (reference, error) = (2.656e-7, 0.010e-7);
    for (way, most) in [(Way::Backward, 0.12), (Way::LearnedBackward, 0.04)] {
        let flux = trace(system("baffled_tube"), way, 200_000, 5, 2).detectors["fpa"].flux_w;
        println!("{way:?}: {flux:?}, reference {reference:e} ± {error:e}");
        assert!(flux.error < most * flux.mean, "{way:?}: {flux:?}");
        assert!((flux.mean - reference).abs() < 4.0 * flux.error.hypot(error), "{way:?}: {flux:?}");
    }
}

/// Light polarised in the source goes through a quarter-wave plate, off a metal, through glass and a polariser: rows of weights go back.
#[test]
fn polarised_light_backwards() {
    let mut fluxes = Vec::new();
    for angle in [20.0, 65.0, 110.0, 155.0] {
        let make = || ten::polarised(angle);
        agree(&format!("polarised at {angle}"), make, 100_000, &[Way::Backward]);
        fluxes.push(trace(make(), Way::Plain, 20_000, 1, 2).detectors["fpa"].flux_w.mean);
    }
    // The answer depends on the polarisation, along and across the axes as well as between them.
    assert!(fluxes[2] / fluxes[0] > 1.1, "{fluxes:?}");
    assert!(fluxes[1] / fluxes[3] > 1.5, "{fluxes:?}");
}

/// STA-07: a pencil on a diffuse plate and a small far detector; aimed and plain agree with each other and the closed form,
/// and what leaves the plate is all of its albedo.
#[test]
fn sta_07_aiming_is_unbiased() {
    let case = Case::load("STA-07");
    assert_eq!(case.values()[0]["ratio"], 1.0);
    let plate = Case::load("STR-01");
    let given = |path: &str| plate.given(path);
    let [radius, height] = ["/detector/radius", "/detector/height"].map(given);
    let model = Model::new()
        .add("plate", rectangle(10.0, 10.0))
        .add("target", moved(flipped(disk(radius, 512)), DVec3::new(0.0, 0.0, height)));
    let rho = given("/plate/rho");
    let text = format!(
        "scatter: {{ \"white\": Lambertian(reflectance: {rho}) }},
        surfaces: [(on: Node(\"plate\"), specular: Absorb, scatter: \"white\", side: Front),
            (on: Node(\"target\"), specular: Absorb)],
        sources: {{ \"pencil\": (flux: \"1 W\", extent: Point, at: \"(0, 0, 50) mm\",
            angular: Collimated(direction: \"(0, 0, -1)\"), spectrum: Line(\"550 nm\")) }},
        detectors: {{ \"target\": (on: Node(\"target\"), quantity: Irradiance),
            \"sky\": (on: FarField(axis: \"(0, 0, 1)\"), quantity: Intensity) }},"
    );
    let exact = plate.values()[0]["flux"].as_f64().expect("a number");
    let z = 1e-3 * height;
    let wide = 1e-3 * radius;
    let ways = [
        Way::Plain,
        Way::Aimed([0.0, 0.0, z], [wide, wide, 0.0]),
        Way::Aimed([0.0, 0.02, z], [0.03, 0.001, 0.01]),
        Way::Learned,
    ];
    let mut errors = Vec::new();
    for way in ways {
        let results = trace(compiled(&text, &model), way, 200_000, 3, 2);
        let [target, sky] = ["target", "sky"].map(|name| results.detectors[name].flux_w);
        println!("{way:?}: {target:?}, exact {exact:e}; sky {sky:?}");
        assert!((target.mean - exact).abs() < 4.0 * target.error, "{way:?}: {target:?}, exact {exact}");
        assert!((target.mean + sky.mean - rho).abs() < 4.0 * target.error.hypot(sky.error) + 1e-12, "{way:?}: {sky:?}");
        errors.push(target.error / target.mean);
    }
    // The polygon fills 79 % of the box that is aimed at.
    assert!(errors[1] < 0.1 * errors[0] && errors[3] < 0.2 * errors[0], "{errors:?}");
}

/// STA-07 on STR-04: a rough paraboloid off axis, where the lobe of the mirror is far narrower than any target.
#[test]
fn sta_07_aiming_from_a_rough_mirror_is_unbiased() {
    let case = Case::load("STR-04");
    let (diameter, f) = (case.given("/mirror/D"), case.given("/mirror/focal_length"));
    let [a, b, g] = ["A", "B", "g"].map(|p| case.given(&format!("/mirror/ABg/{p}")));
    let (sin, cos) = 2f64.to_radians().sin_cos();
    let text = format!(
        "geometry: [], elements: {{
            \"mirror\": (body: Mirror(form: Conic(radius: \"{:?} mm\", conic: -1), diameter: \"{diameter:?} mm\")),
        }},
        scatter: {{ \"rough\": ABg(a: {a:?}, b: {b:?}, g: {g:?}) }},
        surfaces: [(on: Node(\"mirror\"), specular: Mirror(reflectance: 1), scatter: \"rough\")],
        sources: {{ \"star\": (flux: \"1 W\", extent: Disk(radius: \"{:?} mm\"), at: \"({:?}, 0, {:?}) mm\",
            axis: \"({sin:?}, 0, {cos:?})\", angular: Collimated(direction: \"({sin:?}, 0, {cos:?})\"), spectrum: Line(\"550 nm\")) }},
        detectors: {{ \"focus\": (on: Disk(at: \"(0, 0, {:?}) mm\", normal: \"(0, 0, 1)\", radius: \"5 mm\"),
            quantity: Irradiance, side: Front) }},",
        -2.0 * f,
        0.6 * diameter,
        -500.0 * sin,
        -500.0 * cos,
        -f
    );
    let at = [0.0, 0.0, -1e-3 * f];
    let aimed = [Way::Aimed(at, [0.005, 0.005, 0.0]), Way::Aimed([0.3, 0.0, at[2]], [0.05; 3]), Way::Learned];
    let run = |way| trace(compiled(&text, &Model::new()), way, 300_000, 4, 2).detectors["focus"].classes["scatter 1"];
    let plain = run(Way::Plain);
    for way in aimed {
        let found = run(way);
        println!("{way:?}: {found:?}, plain {plain:?}");
        assert!(
            (found.mean - plain.mean).abs() < 4.0 * found.error.hypot(plain.error),
            "{way:?}: {found:?}, {plain:?}"
        );
    }
}

/// Scouts are scattered by surfaces that aim, too.
#[test]
fn learning_where_surfaces_aim() {
    let mut both = system("baffled_tube");
    both.settings.importance = Guidance::On;
    let flux = trace(both, Way::Aimed([0.0, 0.0, 0.2], [0.01, 0.01, 0.0]), 30_000, 5, 2).detectors["fpa"].flux_w;
    assert!((flux.mean - 2.656e-7).abs() < 4.0 * flux.error.hypot(0.010e-7), "{flux:?}");
}

/// From the detector nothing is aimed: rays that go backwards know no targets of the system.
#[test]
fn backwards_where_surfaces_aim() {
    let mut both = system("baffled_tube");
    both.settings.trace = Trace::Backward;
    let flux = trace(both, Way::Aimed([0.0, 0.0, 0.2], [0.01, 0.01, 0.0]), 50_000, 5, 2).detectors["fpa"].flux_w;
    assert!((flux.mean - 2.656e-7).abs() < 4.0 * flux.error.hypot(0.010e-7), "{flux:?}");
}

#[test]
fn the_same_bits_on_any_number_of_threads() {
    let once = |threads| trace(system("triplet"), Way::Learned, 3000, 9, threads);
    let (a, b) = (once(1), once(3));
    assert_eq!(a.detectors["fpa"].flux_w, b.detectors["fpa"].flux_w);
    assert_eq!(a.maps[0].mean, b.maps[0].mean);
    assert_eq!(a.ledger_w, b.ledger_w);
    assert_ne!(a.detectors["fpa"].flux_w, trace(system("triplet"), Way::Plain, 3000, 9, 2).detectors["fpa"].flux_w);
}

/// The 95 % interval of a flux holds what all runs together say in 95 % of them, within 2 %: learned, divided and drawn for.
#[test]
#[ignore = "500 runs of each of two systems, some twenty minutes: cargo test --release --test importance -- --ignored"]
fn intervals_hold_the_truth_with_everything_on() {
    for (name, rays) in [("baffled_tube", 16_384), ("triplet", 4096)] {
        let runs: Vec<Results> = (1..=500).map(|seed| trace(system(name), Way::Learned, rays, seed, 2)).collect();
        let fluxes = || runs.iter().flat_map(|results| results.detectors.values());
        let truth = fluxes().map(|detector| detector.flux_w.mean).sum::<f64>() / runs.len() as f64;
        let held = fluxes().filter(|d| (d.flux_w.mean - truth).abs() <= d.interval95_w).count();
        let share = held as f64 / runs.len() as f64;
        println!("{name}: {:.1} % of 500 intervals hold {truth:.5e} W", 100.0 * share);
        assert!((share - 0.95).abs() <= 0.02, "{name}: {share}");
    }
}

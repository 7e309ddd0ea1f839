//! Importance changes what is drawn and never the answer: plain, aimed, aimed at the wrong place and learned agree in every
//! class and pixel, on any number of threads, with a ledger that closes.

#[allow(unused_imports, reason = "one harness, several test targets")]
#[path = "support/mod.rs"]
mod support;

use glam::DVec3;
use std::path::Path;
use std::sync::atomic::AtomicBool;
use straylight::aim::Target;
use straylight::geometry::Frame;
use straylight::math::statistics::chi_squared_tail;
use straylight::settings::{Guidance, Trace};
use straylight::system::compile::{Compiled, compile};
use straylight::system::document::Document;
use straylight::tally::results::{Estimate, Results};
use straylight::transport::{self, summary};
use support::shapes::{cuboid, disk, facing, flipped, moved, rectangle};
use support::{Case, Model, compiled};

/// How a run draws.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Way {
    Plain,
    /// Every surface aims at this box: centre (world, m) and half sides (m).
    Aimed([f64; 3], [f64; 3]),
    Learned,
    /// From the detectors.
    Backward,
    /// The same after learning where light is.
    LearnedBackward,
}

fn system(name: &str) -> Compiled {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("systems").join(name).join("system.ron");
    let document = Document::read(&path).unwrap_or_else(|e| panic!("{:#?}", e.problems()));
    compile(&document).unwrap_or_else(|e| panic!("{:#?}", e.problems()))
}

fn trace(mut compiled: Compiled, way: Way, rays: u64, seed: u64, threads: usize) -> Results {
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
fn agreement(a: &Results, b: &Results) -> (f64, usize) {
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
                let of = |map: &straylight::tally::results::MapResult| Estimate {
                    mean: map.mean[bin],
                    error: map.error[bin],
                };
                compare(of(one), of(other));
            }
        }
    }
    let chi: f64 = pulls.iter().map(|pull| pull * pull).sum();
    (chi_squared_tail(chi, pulls.len() as f64), pulls.len())
}

/// Runs a system in several ways and holds them to each other.
fn agree(name: &str, make: impl Fn() -> Compiled, rays: u64, ways: &[Way]) {
    let plain = trace(make(), Way::Plain, rays, 1, 2);
    for (i, &way) in ways.iter().enumerate() {
        let other = trace(make(), way, rays, 2 + i as u64, 2);
        let (p, count) = agreement(&plain, &other);
        println!("{name}, {way:?}: {count} numbers agree with p = {p:.3}");
        for (detector, found) in &other.detectors {
            println!("    {detector}: {:?}, plain {:?}", found.flux_w, plain.detectors[detector].flux_w);
        }
        assert!(count > 1 && p > 1e-3, "{name}, {way:?}: {count} numbers differ with p = {p}");
        let residual = other.ledger_w.residual;
        assert!(residual.mean.abs() < 4.5 * residual.error + 1e-12, "{name}, {way:?}: residual {residual:?}");
        assert!(other.trusted, "{name}, {way:?}: {:?}", other.warnings);
    }
}

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
    let upright = |x: f64| moved(facing(rectangle(60.0, 60.0), DVec3::X), DVec3::new(x, 0.0, 20.0));
    let model = Model::new()
        .add("plate", moved(rectangle(60.0, 60.0), DVec3::new(0.0, 0.0, 5.0)))
        .add("mirror", moved(facing(rectangle(60.0, 80.0), DVec3::new(1.0, 0.0, -1.0)), DVec3::new(0.0, 0.0, 20.0)))
        .add("window", cuboid(DVec3::new(40.0, -40.0, -20.0), DVec3::new(43.0, 40.0, 60.0)))
        .add("polarizer", upright(48.0));
    let text = |angle: f64| {
        format!(
            r#"media: {{ "glass": Constant(n: 1.8) }},
            coatings: {{ "quarter": Retarder(axis: "(1, 0.3, 0)", retardance: "90 deg"),
                "metal": Metal(n: 0.3, k: 1.5), "sheet": Polarizer(axis: "(0, 1, 0.6)") }},
            surfaces: [(on: Node("plate"), coating: "quarter"), (on: Node("mirror"), coating: "metal"),
                (on: Node("window"), medium: "glass", specular: Fresnel), (on: Node("polarizer"), coating: "sheet")],
            sources: {{ "lamp": (flux: "1 W", extent: Disk(radius: "6 mm"), at: "(0, 0, 0) mm",
                angular: Cone(half_angle: "15 deg"), spectrum: Line("550 nm"), polarization: Linear(angle: "{angle} deg")) }},
            detectors: {{ "fpa": (on: Disk(at: "(50, 0, 20) mm", normal: "(-1, 0, 0)", radius: "6 mm"),
                quantity: Irradiance, pixels: (4, 4), side: Front) }},"#
        )
    };
    let mut fluxes = Vec::new();
    for angle in [20.0, 65.0, 110.0, 155.0] {
        let make = || compiled(&text(angle), &model);
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

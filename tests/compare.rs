//! Variants traced together: each is what it would be alone, and their differences are known far better than they are.

use std::path::Path;
use std::sync::atomic::AtomicBool;
use straylight::error::{Error, Problem};
use straylight::math::statistics::chi_squared_tail;
use straylight::settings::Settings;
use straylight::study::compare::{Comparison, DetectorChange, compare};
use straylight::study::sensitivity::{Lever, Quantity, sensitivity};
use straylight::system::compile::compile;
use straylight::system::compile::variants::{Lineup, lineup};
use straylight::system::document::{Choice, Document};
use straylight::tally::results::Estimate;
use tempfile::TempDir;

/// A coated lens in a grey tube, lit by a wide cone: signal, ghosts and scatter on its image plane.
const CAMERA: &str = r#"System(
    name: "camera",
    parameters: { "length": "60 mm" },
    elements: {
        "lens": (body: Lens(surfaces: [(form: Sphere(radius: "40 mm")), (form: Sphere(radius: "-40 mm"))],
            thickness: ["5 mm"], media: ["glass"], diameter: "20 mm")),
        "tube": (body: Tube(inner: "22 mm", outer: "24 mm", length: "= length"), at: "(0, 0, -10) mm"),
        "image": (body: Aperture(diameter: "0 mm", outer: "12 mm"), at: "(0, 0, 39) mm"),
    },
    media: { "glass": Constant(n: 1.5) },
    coatings: { "face": Ideal(reflectance: 0.04, transmittance: 0.96) },
    scatter: { "wall": Lambertian(reflectance: 0.2) },
    surfaces: [
        (on: Any([Tag("lens.front"), Tag("lens.back")]), coating: "face"),
        (on: Any([Node("tube"), Tag("lens.edge")]), specular: Absorb, scatter: "wall"),
        (on: Node("image"), specular: Absorb),
    ],
    sources: {
        "lamp": (flux: "1 W", extent: Disk(radius: "10.5 mm"), at: "(0, 0, -30) mm", angular: Cone(half_angle: "8 deg"), spectrum: Line("550 nm")),
    },
    detectors: { "image": (on: Node("image"), quantity: Irradiance, pixels: (8, 8), side: Front) },
    run: (rays: 16_384, seed: 1),
    variants: { VARIANTS },
)"#;

/// The camera with these variants.
fn camera(folder: &Path, variants: &str) -> Result<Vec<Document>, Error> {
    let path = folder.join("system.ron");
    std::fs::write(&path, CAMERA.replace("VARIANTS", variants)).expect("written");
    Document::lineup(&path, &Choice::default())
}

fn documents(variants: &str) -> Vec<Document> {
    let folder = TempDir::new().expect("a folder");
    camera(folder.path(), variants).unwrap_or_else(|error| panic!("{error}\n{:#?}", error.problems()))
}

fn traced(lineup: Lineup, names: &[String], seed: u64) -> Comparison {
    let settings = Settings { seed, ..lineup.traces[0].compiled.settings.clone() };
    compare(lineup, names, &settings, &AtomicBool::new(false), &|_| ()).expect("enough batches")
}

fn compared(documents: &[Document], seed: u64) -> Comparison {
    let names: Vec<String> =
        std::iter::once("baseline".to_owned()).chain(documents[0].variants.iter().cloned()).collect();
    let lineup = lineup(documents).unwrap_or_else(|error| panic!("{error}\n{:#?}", error.problems()));
    traced(lineup, &names, seed)
}

/// A variant in a trace of its own.
fn alone(document: &Document, seed: u64) -> Comparison {
    let lineup = lineup(std::slice::from_ref(document)).expect("the variant compiles");
    traced(lineup, &["alone".into()], seed)
}

fn image(comparison: &Comparison, variant: usize) -> &DetectorChange {
    &comparison.variants[variant].detectors["image"]
}

/// Two glasses in contact, straight before a detector.
const CONTACT: &str = r#"System(
    name: "contact",
    elements: {
        "A": (body: Lens(surfaces: [(form: Plane), (form: Plane)], thickness: ["2 mm"], media: ["crown"], diameter: "20 mm")),
        "B": (body: Lens(surfaces: [(form: Plane), (form: Plane)], thickness: ["2 mm"], media: ["flint"], diameter: "20 mm"), at: "(0, 0, 2) mm"),
        "image": (body: Aperture(diameter: "0 mm", outer: "20 mm"), at: "(0, 0, 9) mm"),
    },
    media: { "crown": Constant(n: 1.5), "flint": Constant(n: 1.6) },
    coatings: { "half": Ideal(reflectance: 0.5, transmittance: 0.5) },
    surfaces: [(on: Node("image"), specular: Absorb)],
    sources: {
        "lamp": (flux: "1 W", extent: Disk(radius: "5 mm"), at: "(0, 0, -9) mm", angular: Collimated(direction: "(0, 0, 1)"), spectrum: Line("550 nm")),
    },
    detectors: { "image": (on: Node("image"), quantity: Irradiance, pixels: (2, 2), side: Front) },
    run: (rays: 2048, seed: 1),
    variants: {
        "back of A": (surfaces: [(on: Tag("A.back"), coating: "half")]),
        "front of B": (surfaces: [(on: Tag("B.front"), coating: "half")]),
    },
)"#;

/// One face acts where two lie on each other: variants that coat the one and the other are not lanes of one trace.
#[test]
fn variants_coat_either_of_two_faces_in_contact() {
    let folder = TempDir::new().expect("a folder");
    let path = folder.path().join("system.ron");
    std::fs::write(&path, CONTACT).expect("written");
    let documents =
        Document::lineup(&path, &Choice::default()).unwrap_or_else(|error| panic!("{error}\n{:#?}", error.problems()));
    let together = compared(&documents, 1);
    for variant in [1, 2] {
        let (lane, own) = (image(&together, variant).flux.flux_w, alone(&documents[variant], 2));
        let own = own.variants[0].detectors["image"].flux.flux_w;
        let apart = (lane.mean - own.mean).abs();
        assert!(apart <= 4.0 * lane.error.hypot(own.error) + 1e-9 && own.mean < 0.6, "{variant}: {lane:?} {own:?}");
    }
    assert!(together.variants.iter().any(|variant| !variant.together), "they cannot all be lanes of one scene");
}

const FINISHES: &str = r#"
    "better coating": (coatings: { "face": Ideal(reflectance: 0.01, transmittance: 0.99) }),
    "one side bare": (surfaces: [(on: Tag("lens.back"), specular: Fresnel)]),
    "black wall": (scatter: { "wall": Lambertian(reflectance: 0.05) }),
    "level": Bracket(low: 0.25, high: 3),
    "shorter": (parameters: { "length": "50 mm" }),
    "flint": (media: { "glass": Constant(n: 1.6) }),
"#;

/// Total, stray light and signal of a lane against those of a run of its own by other random numbers.
#[test]
fn a_variant_has_the_flux_of_a_run_of_its_own() {
    let documents = documents(FINISHES);
    let together = compared(&documents, 1);
    let apart: Vec<bool> = together.variants.iter().map(|variant| !variant.together).collect();
    assert_eq!(apart, [false, false, false, false, false, false, true, true]);
    assert_eq!(together.traces, 3);
    let (mut chi, mut pairs) = (0.0, 0.0);
    for (number, document) in documents.iter().enumerate() {
        let own = alone(document, 100 + number as u64);
        let [lane, own] = [image(&together, number), image(&own, 0)];
        let signal = |change: &DetectorChange| change.signal.as_ref().expect("an image").flux_w;
        for (a, b) in [(lane.stray.flux_w, own.stray.flux_w), (signal(lane), signal(own))] {
            let pull = (a.mean - b.mean) / a.error.hypot(b.error);
            println!("{}: {a:?} {b:?} {pull:+.2}", together.variants[number].name);
            assert!(pull.abs() < 4.0, "{}: {a:?} {b:?}", together.variants[number].name);
            (chi, pairs) = (chi + pull * pull, pairs + 1.0);
        }
    }
    // Lanes share their random numbers, so their pulls are not independent: a limit beyond chance all the same.
    let chance = chi_squared_tail(chi / 2.0, pairs / 2.0);
    assert!(chance > 1e-3, "chi squared {chi} over {pairs} pairs: {chance}");
}

/// Of two independent runs, the error of the difference would be that of both together.
fn independent(comparison: &Comparison, variant: usize) -> f64 {
    image(comparison, 0).stray.flux_w.error.hypot(image(comparison, variant).stray.flux_w.error)
}

#[test]
fn a_small_change_is_known_thirty_times_better_than_from_two_runs() {
    let documents =
        documents(r#""1 % more": (coatings: { "face": Ideal(reflectance: 0.0404, transmittance: 0.9596) })"#);
    let comparison = compared(&documents, 3);
    let (paired, apart) = (image(&comparison, 1).stray.difference_w, independent(&comparison, 1));
    println!("paired {:e}, two runs {apart:e}: {:.0} times", paired.error, apart / paired.error);
    assert!(paired.mean > 0.0 && paired.error > 0.0 && apart > 30.0 * paired.error, "{paired:?} {apart:e}");
}

#[test]
fn a_great_change_is_known_no_worse_than_from_two_runs() {
    let documents = documents(
        r#""dark": (scatter: { "wall": Lambertian(reflectance: 0.05) }), "bright": (scatter: { "wall": Lambertian(reflectance: 0.7) })"#,
    );
    let comparison = compared(&documents, 4);
    let apart = [1, 2].map(|variant| image(&alone(&documents[variant], 5), 0).stray.flux_w.error);
    let bright = image(&comparison, 2);
    let [dark_alone, bright_alone] = apart;
    // From 5 % to 70 %, with either in the place of the baseline.
    let swapped: Vec<Document> = vec![documents[1].clone(), documents[2].clone()];
    let pair = traced(lineup(&swapped).expect("compiles"), &["dark".into(), "bright".into()], 4);
    let paired = image(&pair, 1).stray.difference_w;
    println!("paired {:e}, two runs {:e}", paired.error, dark_alone.hypot(bright_alone));
    assert!(bright.stray.difference_w.mean > 0.0 && bright.stray.sigma > 5.0);
    assert!(paired.error <= 1.1 * dark_alone.hypot(bright_alone), "{paired:?} {apart:?}");
}

/// d ln F / d ln q by the difference of two variants, q being 2 % more and less.
fn slope(comparison: &Comparison, variants: [usize; 2], step: f64) -> Estimate {
    let ratio = |variant: usize| image(comparison, variant).stray.ratio.expect("stray light");
    let [less, more] = variants.map(ratio);
    let span = ((1.0 + step) / (1.0 - step)).ln();
    Estimate {
        mean: (more.mean / less.mean).ln() / span,
        error: (more.error / more.mean).hypot(less.error / less.mean) / span,
    }
}

/// Derivatives from the events of one run against differences between variants.
#[test]
fn events_on_the_way_are_the_derivatives_of_stray_light() {
    let step = 0.02;
    let ideal = |r: f64, t: f64| format!("(coatings: {{ \"face\": Ideal(reflectance: {r:?}, transmittance: {t:?}) }})");
    let wall = |rho: f64| format!("(scatter: {{ \"wall\": Lambertian(reflectance: {rho:?}) }})");
    let (less, more) = (1.0 - step, 1.0 + step);
    let variants = [
        format!("\"R less\": {}", ideal(0.04 * less, 0.96)),
        format!("\"R more\": {}", ideal(0.04 * more, 0.96)),
        format!("\"T less\": {}", ideal(0.04, 0.94 * less)),
        format!("\"T more\": {}", ideal(0.04, 0.94 * more)),
        format!("\"wall less\": {}", wall(0.2 * less)),
        format!("\"wall more\": {}", wall(0.2 * more)),
    ];
    let baseline = "\"face\": Ideal(reflectance: 0.04, transmittance: 0.94)";
    let folder = TempDir::new().expect("a folder");
    let path = folder.path().join("system.ron");
    let text = CAMERA.replace("\"face\": Ideal(reflectance: 0.04, transmittance: 0.96)", baseline);
    // Without refraction nothing is totally reflected, which no coating makes.
    let text = text.replace("Constant(n: 1.5)", "Constant(n: 1)");
    std::fs::write(&path, text.replace("VARIANTS", &variants.join(", ").replace("0.96)", "0.94)"))).expect("written");
    let documents = Document::lineup(&path, &Choice::default()).expect("a system");
    let comparison = compared(&documents, 8);
    let compiled = compile(&Document::read(&path).expect("a system")).expect("compiles");
    let settings = Settings { seed: 9, ..compiled.settings };
    let found = sensitivity(&compiled.scene, &settings, &AtomicBool::new(false), &|_| ()).expect("batches");
    let levers = &found.detectors["image"];
    assert!(levers.uncounted < 1e-3, "{levers:?}");
    let lever = |subject: &str, quantity: Quantity| -> &Lever {
        let same = |lever: &&Lever| lever.subject == subject && lever.quantity == quantity;
        levers.finishes.iter().find(same).unwrap_or_else(|| panic!("no {subject} in {levers:#?}"))
    };
    let cases = [
        ("coating face", Quantity::Reflectance, [1, 2]),
        ("coating face", Quantity::Transmittance, [3, 4]),
        ("Absorb + scatter wall", Quantity::Scatter, [5, 6]),
    ];
    for (subject, quantity, variants) in cases {
        let (counted, slope) = (lever(subject, quantity).derivative, slope(&comparison, variants, step));
        println!("{subject} {}: {counted:?} {slope:?}", quantity.label());
        let allowed = 4.0 * counted.error.hypot(slope.error) + 2e-3 * counted.mean;
        assert!((counted.mean - slope.mean).abs() < allowed, "{subject}: {counted:?} {slope:?}");
        assert!(counted.error < 0.2 * counted.mean, "{counted:?}");
    }
    // A finish is the sum of its parts.
    let sum: f64 = ["lens.front", "lens.back"]
        .iter()
        .filter_map(|name| levers.parts.iter().find(|l| l.subject == *name && l.quantity == Quantity::Reflectance))
        .map(|lever| lever.derivative.mean)
        .sum();
    assert!((sum / lever("coating face", Quantity::Reflectance).derivative.mean - 1.0).abs() < 1e-9, "{sum}");
}

#[test]
fn the_same_bits_on_one_and_two_threads() {
    let documents = documents(FINISHES);
    let bits = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        serde_json::to_string(&pool.install(|| compared(&documents, 6))).expect("JSON")
    };
    assert_eq!(bits(1), bits(2));
}

/// More variants than lanes: every trace has the baseline again, which is what it was.
#[test]
fn more_variants_than_lanes_are_more_traces() {
    let one =
        |i: usize| format!("\"v{i}\": (scatter: {{ \"wall\": Lambertian(reflectance: {:?}) }})", 0.2 + 0.01 * i as f64);
    let all: Vec<String> = (0..17).map(one).collect();
    let text = all.join(", ");
    let mut lineup = lineup(&documents(&text)).expect("compiles");
    lineup.traces[0].compiled.settings.rays = 1024;
    let lanes: Vec<usize> = lineup.traces.iter().map(|trace| trace.variants.len()).collect();
    assert_eq!(lanes, [16, 3]);
    let names: Vec<String> = (0..18).map(|i| format!("{i}")).collect();
    let comparison = traced(lineup, &names, 1);
    assert_eq!(comparison.variants.len(), 18);
    assert_eq!(image(&comparison, 1).stray.difference_w, Estimate::default(), "the first variant says what is there");
    let rising = (2..18).all(|number| image(&comparison, number).stray.difference_w.mean > 0.0);
    assert!(rising, "more is scattered by walls that scatter more");
}

/// What is wrong with these variants.
fn refused(variants: &str) -> Vec<Problem> {
    let folder = TempDir::new().expect("a folder");
    let found = camera(folder.path(), variants).and_then(|documents| lineup(&documents).map(drop));
    found.expect_err("refused").problems().to_vec()
}

#[test]
fn what_is_wrong_with_a_variant_is_said_where_it_stands() {
    let cases = [
        (r#""a": (coating: {})"#, "a variant has no section `coating`", "coatings"),
        (r#""a": (parameters: { "lenght": "1 mm" })"#, "no parameter `lenght`", ""),
        (r#""a": (surfaces: [(on: Tag("lens.fornt"), coating: "face")])"#, "no tag matches `lens.fornt`", ""),
        (r#""a": (surfaces: [(on: Node("tube"), coating: "ar")])"#, "no coating \"ar\"", ""),
        (r#""a": (scatter: { "wall": Lambertian(reflectance: 1.5) })"#, "1.5 is out of range", ""),
        (r#""a": Bracket(of: ["wal"])"#, "no scatter model \"wal\"", "wall"),
        (r#""a": Bracket(high: 6)"#, "6 times this scatters 120 %", ""),
        (r#""a": 3"#, "this is no variant", ""),
        (r#""a": (), "a": ()"#, "the name \"a\" is given twice", ""),
        (r#""baseline": ()"#, "the name \"baseline\" is the system as it stands", ""),
    ];
    let line = CAMERA.lines().position(|line| line.contains("VARIANTS")).expect("a line") as u32 + 1;
    for (variants, message, hint) in cases {
        let problems = refused(variants);
        let told = problems.iter().find(|problem| problem.message.contains(message));
        let told = told.unwrap_or_else(|| panic!("{variants}: {problems:#?}"));
        assert!(told.hint.as_deref().unwrap_or_default().contains(hint), "{told:#?}");
        // A model of the system that a bracket scales too far is told where the model stands.
        let here = told.span.is_some_and(|span| span.line == line);
        assert!(here || message.starts_with('6'), "{variants}: {told:#?}");
    }
}

#[test]
fn a_system_with_variants_is_also_a_system() {
    let folder = TempDir::new().expect("a folder");
    let path = folder.path().join("system.ron");
    std::fs::write(&path, CAMERA.replace("VARIANTS", FINISHES)).expect("written");
    let document = Document::read(&path).expect("a system");
    assert_eq!(document.warnings, []);
    assert_eq!(document.variants.len(), 7);
    let unknown = Choice { variant: Some("blak wall".into()), ..Choice::default() };
    let error = Document::choose(&path, &unknown).expect_err("no such variant").to_string();
    assert!(error.contains("did you mean \"black wall\"?"), "{error}");
}

/// What a study that ships with the project says of a variant: stray light over that of the baseline.
fn shipped(file: &str, name: &str, rays: u64) -> Estimate {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("systems").join(file);
    let documents = Document::lineup(&path, &Choice::default()).expect("ships with the project");
    let mut lineup = lineup(&documents).expect("compiles");
    lineup.traces[0].compiled.settings.rays = rays;
    let names: Vec<String> =
        std::iter::once("baseline".to_owned()).chain(documents[0].variants.iter().cloned()).collect();
    let comparison = traced(lineup, &names, 1);
    assert_eq!(comparison.traces, 1, "{file}");
    let variant = comparison.variants.iter().find(|variant| variant.name == name).expect("a variant");
    let found = &variant.detectors["image"];
    println!("{file} {name}: {:?}; {}", found.stray.ratio, found.verdict);
    found.stray.ratio.expect("stray light")
}

#[test]
fn three_layers_leave_little_of_the_ghosts_of_the_double_gauss() {
    let ratio = shipped("double_gauss/coatings.ron", "three layers on all", 8192);
    assert!(ratio.mean < 0.3 && ratio.error < 0.1, "{ratio:?}");
}

/// Light that is scattered once at 3 % and at 5 %, and some that is scattered more often.
#[test]
#[ignore = "minutes; cargo test --release --test compare -- --ignored"]
fn black_anodize_scatters_as_its_reflectance_says_in_the_questar() {
    let ratio = shipped("questar/finishes.ron", "diffuse black anodize", 40_000);
    assert!((1.6..2.0).contains(&ratio.mean) && ratio.error < 0.05, "{ratio:?}");
}

/// Seconds of eight lanes over those of one: `cargo test --release --test compare -- --ignored --nocapture cost`.
#[test]
#[ignore = "a measurement of time"]
fn cost_of_eight_coatings_and_of_eight_finishes() {
    let coating = |i: usize| {
        let r = 0.04 - 0.004 * (i + 1) as f64;
        format!("\"c{i}\": (coatings: {{ \"face\": Ideal(reflectance: {r:?}, transmittance: {:?}) }})", 1.0 - r)
    };
    let finish = |i: usize| {
        format!("\"f{i}\": (scatter: {{ \"wall\": ABg(a: {:?}, b: 0.01, g: 1.5) }})", 0.002 * (i + 1) as f64)
    };
    let many = |one: &dyn Fn(usize) -> String| (0..7).map(one).collect::<Vec<_>>().join(", ");
    for (what, variants) in [("coatings", many(&coating)), ("finishes", many(&finish))] {
        let documents = documents(&variants);
        let seconds = |lineup: Lineup, names: &[String]| {
            let mut lineup = lineup;
            lineup.traces[0].compiled.settings.rays = 1 << 16;
            let start = std::time::Instant::now();
            let comparison = traced(lineup, names, 1);
            (start.elapsed().as_secs_f64(), comparison.segments)
        };
        let names: Vec<String> = (0..8).map(|i| format!("{i}")).collect();
        let [one, eight] =
            [&documents[..1], &documents[..]].map(|documents| seconds(lineup(documents).expect("compiles"), &names));
        println!(
            "8 {what}: {:.2} s against {:.2} s: {:.2} times; flights {:.2} times",
            eight.0,
            one.0,
            eight.0 / one.0,
            eight.1 as f64 / one.1 as f64
        );
    }
}

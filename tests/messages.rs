//! What the program says about a wrong system file, word by word.

use std::path::Path;
use straylight::error::Error;
use straylight::report::problems::render;
use straylight::system::document::Document;
use straylight::system::schema::SCHEMA;

/// A system without fault, in which the tests make faults.
const GOOD: &str = r#"System(
    media: {"glass": Constant(n: 1.5)},
    coatings: {"ar": Ideal(reflectance: 0.005, transmittance: 0.995)},
    scatter: {"black": Lambertian(reflectance: 0.05)},
    surfaces: [
        (on: Tag("glass_*"), medium: "glass", coating: "ar"),
        (on: Node("Barrel*"), specular: Absorb, scatter: "black"),
    ],
    sources: {
        "sun": (flux: "1 W", extent: Disk(radius: "12.7 mm"), angular: Collimated(direction: "(0, 0, 1)"), spectrum: Line("550 nm")),
    },
    detectors: {
        "fpa": (on: Node("Detector"), quantity: Irradiance, pixels: (256, 256)),
    },
    run: (rays: 1_000),
)
"#;

/// One line per problem of a text, warnings included.
fn lines(text: &str) -> Vec<String> {
    match Document::parse(Path::new("a.ron"), text.as_bytes()) {
        Ok(document) => document.warnings.iter().map(ToString::to_string).collect(),
        Err(error) => error.problems().iter().map(ToString::to_string).collect(),
    }
}

/// The problems after a replacement in the good system.
fn after(old: &str, new: &str) -> Vec<String> {
    assert!(GOOD.contains(old), "{old} is not in the good system");
    lines(&GOOD.replace(old, new))
}

/// The one message after a replacement, without the name of the file.
fn message(old: &str, new: &str) -> String {
    let all = after(old, new);
    assert_eq!(all.len(), 1, "{all:#?}");
    all[0].strip_prefix("a.ron:").unwrap_or(&all[0]).to_owned()
}

/// Compares messages word by word: what is replaced, by what, what is said.
fn said(cases: &[(&str, &str, &str)]) {
    let got: Vec<String> = cases.iter().map(|(old, new, _)| message(old, new)).collect();
    let wanted: Vec<&str> = cases.iter().map(|(_, _, wanted)| *wanted).collect();
    assert_eq!(got, wanted);
}

#[test]
fn a_good_system_has_nothing_to_say() {
    assert_eq!(lines(GOOD), Vec::<String>::new());
    assert_eq!(lines(&format!("\u{feff}{}", GOOD.replace('\n', "\r\n"))), Vec::<String>::new());
    assert_eq!(lines(&format!("#![enable(implicit_some)]\n{}", GOOD.replacen("System", "", 1))), Vec::<String>::new());
}

#[test]
fn a_quantity_without_unit_is_told_what_to_write() {
    said(&[
        (
            r#""12.7 mm""#,
            "12.7",
            r#"10:51: sources["sun"].extent.radius: `12.7` is a bare number; expected a length with its unit, such as "12.7 mm""#,
        ),
        (
            "12.7 mm",
            "12.7",
            r#"10:51: sources["sun"].extent.radius: "12.7" has no unit; expected a length with its unit, such as "12.7 mm""#,
        ),
        (
            "12.7 mm",
            "12.7 W",
            r#"10:51: sources["sun"].extent.radius: "12.7 W": no such unit here: "W"; one of mm, m, cm, um, nm, km, in, inch; expected a length with its unit, such as "12.7 mm""#,
        ),
        (
            r#""(0, 0, 1)""#,
            "(0, 0, 1)",
            r#"10:94: sources["sun"].angular.direction: `(0, 0, 1)` is not a direction without unit, such as "(0, 0, 1)""#,
        ),
        (
            r#""(0, 0, 1)""#,
            r#""(0, 0, 0)""#,
            r#"10:94: sources["sun"].angular.direction: "(0, 0, 0)" has no length, so it points nowhere; expected a direction without unit, such as "(0, 0, 1)""#,
        ),
        ("0.05", r#""5 %""#, r#"4:48: scatter["black"].reflectance: `"5 %"` is not a number"#),
        ("1_000", "1e3", "15:17: run.rays: `1e3` is not a whole number"),
    ]);
}

#[test]
fn a_slip_of_the_pen_is_answered_with_what_was_meant() {
    said(&[
        (
            "radius",
            "radus",
            r#"10:43: sources["sun"].extent.radus: Disk has no field `radus`; expected one of `radius`; did you mean `radius`?"#,
        ),
        (
            "Collimated",
            "Colimated",
            r#"10:72: sources["sun"].angular: there is no `Colimated` here; expected one of `Collimated`, `Cone`, `AngularDiameter`, `Ring`, `Lambertian`, `Gaussian`, `Isotropic`; did you mean `Collimated`?"#,
        ),
        (
            r#"Node("Detector")"#,
            r#""Detector""#,
            r#"13:21: detectors["fpa"].on: there is no `"Detector"` here; expected one of `Node`, `Rectangle`, `Disk`, `FarField`"#,
        ),
        (
            r#"scatter: "black""#,
            r#"scatter: "blak""#,
            r#"7:58: surfaces[1].scatter: no scatter model "blak"; did you mean "black"?"#,
        ),
        (
            r#"scatter: "black""#,
            r#"scatter: "ar""#,
            r#"7:58: surfaces[1].scatter: no scatter model "ar"; "ar" is defined in `coatings`"#,
        ),
        ("surfaces:", "surface:", "5:5: surface: a system has no section `surface`; did you mean `surfaces`?"),
        ("1_000", r#"1_000, until: "1 % on fpb""#, r#"15:31: run.until: no detector "fpb"; did you mean "fpa"?"#),
        ("quantity: Irradiance, ", "", r#"13:16: detectors["fpa"]: field `quantity` of Detector is missing"#),
        (
            "(256, 256)",
            "256",
            r#"13:69: detectors["fpa"].pixels: `256` lacks its parentheses; expected values in parentheses, `(..)`"#,
        ),
        ("(256, 256)", "(256, 256, 1)", r#"13:69: detectors["fpa"].pixels: `(256, 256, 1)` holds too many values"#),
    ]);
}

#[test]
fn what_physics_forbids_is_refused() {
    said(&[
        (
            "12.7 mm",
            "-12.7 mm",
            r#"10:51: sources["sun"].extent.radius: "-12.7 mm" is out of range; expected a value above 0"#,
        ),
        (
            "0.995",
            "0.996",
            r#"3:16: coatings["ar"]: reflectance + transmittance is 1.001: more light leaves than arrives; expected a sum of at most 1"#,
        ),
        (
            "0.05",
            "1.05",
            r#"4:48: scatter["black"].reflectance: 1.05 is out of range; expected a number between 0 and 1"#,
        ),
        (
            "0.05",
            "NaN",
            r#"4:48: scatter["black"].reflectance: NaN is out of range; expected a number between 0 and 1"#,
        ),
        ("n: 1.5", "n: 0", r#"2:34: media["glass"].n: 0 is out of range; expected a value above 0"#),
        ("n: 1.5", "n: 1.5, k: -1", r#"2:42: media["glass"].k: -1 is out of range; expected 0 or more"#),
        (
            "n: 1.5",
            r#"n: 1.5, k: 1, absorption: "1 /m""#,
            r#"2:13: media["glass"]: both `k` and `absorption` are given; expected one of the two"#,
        ),
        (
            "Constant(n: 1.5)",
            r#"Sellmeier(b: [1, 2], c: ["1 um2"])"#,
            r#"2:46: media["glass"].c: `b` holds 2 values and `c` 1; expected lists of one length"#,
        ),
        (
            "Lambertian(reflectance: 0.05)",
            "ABg(a: -1, b: 1, g: 1)",
            r#"4:31: scatter["black"].a: -1 is out of range; expected 0 or more"#,
        ),
        (
            "Lambertian(reflectance: 0.05)",
            "ABg(a: 1, b: 0, g: 1)",
            r#"4:37: scatter["black"].b: 0 is out of range; expected a value above 0"#,
        ),
        (
            "Lambertian(reflectance: 0.05)",
            "Sum([Lambertian(reflectance: 0.6), Lambertian(reflectance: 0.6)])",
            r#"4:15: scatter["black"]: the Lambertian parts add up to 1.2: more light leaves than arrives; expected a sum of at most 1"#,
        ),
        (
            "specular: Absorb",
            r#"specular: Absorb, coating: "ar""#,
            "7:58: surfaces[1].coating: both `specular` and `coating` are given; expected one of the two",
        ),
        (
            r#"medium: "glass""#,
            r#"medium: "glass", between: ("glass", "vacuum")"#,
            "6:56: surfaces[0].between: both `medium` and `between` are given; expected `medium` for a closed solid, or `between` for an open sheet",
        ),
        (
            r#"flux: "1 W""#,
            r#"flux: "1 W", irradiance: "1 W/m2""#,
            r#"10:42: sources["sun"].irradiance: both `flux` and `irradiance` are given; expected one of the two"#,
        ),
        (
            r#"flux: "1 W", "#,
            "",
            r#"10:9: sources["sun"]: neither `flux` nor `irradiance` is given; expected `flux: "1 W"` or `irradiance: "1361 W/m2"`"#,
        ),
        (
            r#"direction: "(0, 0, 1)""#,
            "",
            r#"10:72: sources["sun"].angular: no direction is given; expected one of `direction`, `aim_at` and `field`"#,
        ),
        (
            "550 nm",
            "550 m",
            r#"10:118: warning: sources["sun"].spectrum: a wavelength of 5.5e2 m; expected 10 nm to 1 mm"#,
        ),
        (
            "quantity: Irradiance",
            "quantity: Irradiance, bins: Polar",
            r#"13:67: detectors["fpa"].bins: `bins` sorts directions, and this detector maps positions; expected `quantity: Intensity`"#,
        ),
        (
            "(256, 256)",
            "(256, 0)",
            r#"13:69: detectors["fpa"].pixels: (256, 0) is out of range; expected at least (1, 1), at most 2^26 pixels"#,
        ),
        ("1_000", "0", "15:17: run.rays: 0 is out of range; expected 1 to 2^48 rays"),
        ("1_000", "1_000, batch: 1000", "15:31: run.batch: 1000 is out of range; expected a power of two up to 2^24"),
        ("1_000", "1_000, splits: 65", "15:32: run.splits: 65 is out of range; expected 0 to 64"),
        (
            "1_000",
            "1_000, roulette: (survive: 0)",
            "15:44: run.roulette.survive: 0 is out of range; expected a probability above 0, up to 1",
        ),
    ]);
}

#[test]
fn a_name_can_be_given_once() {
    said(&[
        (
            r#"{"glass": Constant(n: 1.5)}"#,
            r#"{"glass": Constant(n: 1.5), "glass": Constant(n: 1.6)}"#,
            r#"2:40: media: the name "glass" is given twice"#,
        ),
        (r#"flux: "1 W""#, r#"flux: "1 W", flux: "2 W""#, r#"10:30: sources["sun"].flux: field `flux` is given twice"#),
        ("run:", "media: {}, run:", "15:5: media: section `media` is given twice"),
        (
            r#"{"glass":"#,
            r#"{"vacuum": Constant(n: 1), "glass":"#,
            r#"2:13: media["vacuum"]: "vacuum" is always there and cannot be defined; expected another name"#,
        ),
    ]);
}

#[test]
fn what_is_defined_and_never_used_is_a_warning() {
    said(&[(r#", scatter: "black""#, "", r#"4:15: warning: scatter["black"]: scatter model "black" is never used"#)]);
}

#[test]
fn broken_syntax_is_placed() {
    said(&[
        (r#"medium: "glass""#, r#"medium "glass""#, "6:37: found `\"` after `medium`; expected `:` and a value"),
        (
            r#"Node("Barrel*")"#,
            r#"Node("Barrel*""#,
            "7:38: found `:` after a value; expected `,` or `)`; inside the `(` of line 7, column 18",
        ),
        ("1_000),\n)", "1_000),\n", "1:7: this `(` is never closed"),
        ("System(", "System(\n/* so", "2:1: this comment is never closed"),
    ]);
}

#[test]
fn all_problems_of_a_file_are_reported_at_once_each_with_its_place() {
    let text = GOOD.replace("12.7 mm", "12.7").replace("550 nm", "550").replace("quantity", "quanity");
    let text = text.replace("0.05", "5").replace("\"black\")", "\"blck\")");
    let text = text.replace("n: 1.5", "n: -1.5, q: 3").replace("1 W", "1 Wt");
    let error = Document::parse(Path::new("a.ron"), text.as_bytes()).err();
    let problems = error.as_ref().map_or(&[][..], Error::problems);
    let places: Vec<_> = problems.iter().filter_map(|p| p.span.map(|s| (s.line, s.column))).collect();
    assert_eq!(places, [(2, 34), (2, 40), (4, 48), (7, 58), (10, 23), (10, 52), (10, 121), (13, 39)]);
    let shown = render(problems, &|_| Some(text.clone()));
    let first =
        "a.ron:2:34: media[\"glass\"].n: -1.5 is out of range; expected a value above 0 (and 7 more)\n\nerror: ";
    assert!(shown.starts_with(first), "{shown}");
    assert!(shown.contains("13 |         \"fpa\": (on: Node(\"Detector\"), quanity: Irradiance"), "{shown}");
}

#[test]
fn a_file_that_is_not_there_is_missing_input() -> std::io::Result<()> {
    let directory = tempfile::tempdir()?;
    let path = directory.path().join("system.ron");
    let code = |path: &Path| Document::read(path).err().map(|e| (e.exit_code(), e.problems().len()));
    assert_eq!(code(&path), Some((66, 1)));
    assert_eq!(code(directory.path()), Some((66, 1)));
    let with_file = GOOD.replace("media:", "geometry: [(file: \"no.glb\")],\n    media:");
    std::fs::write(&path, &with_file)?;
    assert_eq!(code(&path), Some((66, 1)));
    let said = Document::read(&path).err().map(|e| e.to_string()).unwrap_or_default();
    let wanted = ":2:23: geometry[0].file: \"no.glb\" does not exist; files are relative to the system file";
    assert!(said.ends_with(wanted), "{said}");
    std::fs::write(&path, with_file.replace("1.5", "-1"))?;
    assert_eq!(code(&path), Some((65, 2)));
    Ok(())
}

#[test]
fn a_path_of_the_document_has_a_place_in_its_text() {
    let document = Document::parse(Path::new("a.ron"), GOOD.as_bytes()).unwrap_or_else(|e| panic!("{e}"));
    let place = |path: &str| document.span(path).map(|s| (s.line, s.column, s.len));
    assert_eq!(document.sha256.len(), 64);
    assert_eq!(place("surfaces[1].scatter"), Some((7, 58, 7)));
    assert_eq!(place("sources[\"sun\"].extent.radius"), Some((10, 51, 9)));
    assert_eq!(place("sources[\"sun\"]"), Some((10, 9, 5)));
    assert_eq!(place("surfaces[1].nothing").map(|(line, column, _)| (line, column)), Some((7, 9)));
    assert_eq!(place("nothing"), None);
}

#[test]
fn a_requirement_names_a_detector_and_a_limit_that_can_be_kept() {
    let with = |requirement: &str| {
        let run = "    run: (rays: 1_000),";
        after(run, &format!("    requirements: {{\"veil\": ({requirement})}},\n{run}"))
    };
    assert_eq!(with("limit: StrayToSignal(0.01)"), Vec::<String>::new());
    let wrong = with("detector: \"fpb\", limit: StrayToSignal(0), confidence: 1.0");
    let tails = [
        "requirements[\"veil\"].detector: no detector \"fpb\"; did you mean \"fpa\"?",
        "requirements[\"veil\"].limit: StrayToSignal(0) is out of range; expected a value above 0",
        "requirements[\"veil\"].confidence: 1.0 is out of range; expected 0.5 or more, below 1",
    ];
    assert_eq!(wrong.len(), tails.len(), "{wrong:#?}");
    assert!(tails.iter().all(|tail| wrong.iter().any(|line| line.ends_with(tail))), "{wrong:#?}");
    assert!(with("limit: StrayFlux(1)")[0].contains("is a bare number"), "{:#?}", with("limit: StrayFlux(1)"));
}

#[test]
fn bytes_that_are_no_text_are_refused() {
    let error = Document::parse(Path::new("a.ron"), b"System(\n  \xff)").err().map(|e| e.to_string());
    assert_eq!(error.as_deref(), Some("a.ron:2:3: this is not UTF-8 text; expected a system written in RON"));
}

#[test]
fn a_long_table_of_faults_is_refused_in_bounded_time() {
    let start = std::time::Instant::now();
    let table = format!("Tabulated(wavelength: [{}], n: [{}])", "400,".repeat(100_000), "-1,".repeat(100_000));
    assert!(!lines(&GOOD.replace("Constant(n: 1.5)", &table)).is_empty());
    let table = table.replace("400,", "\"400 nm\",");
    assert!(lines(&GOOD.replace("Constant(n: 1.5)", &table)).len() <= 1000);
    assert!(start.elapsed().as_secs() < 20, "{:?}", start.elapsed());
}

proptest::proptest! {
    #![proptest_config(proptest::prelude::ProptestConfig { cases: 300, failure_persistence: None, ..Default::default() })]

    /// Whatever is cut out of a system or written into it: a document, or problems with places inside the text.
    #[test]
    fn no_damage_to_a_system_makes_the_reader_panic(
        at in 0..SCHEMA.len(), cut in 0..40_usize, with in r#"[(){}:,"a-c0-9 .µ/*#'\\-]{0,6}"#
    ) {
        let floor = |at: usize| (0..=at.min(SCHEMA.len())).rev().find(|at| SCHEMA.is_char_boundary(*at)).unwrap_or(0);
        let text = format!("{}{with}{}", &SCHEMA[..floor(at)], &SCHEMA[floor(at + cut)..]);
        if let Err(error) = Document::parse(Path::new("a.ron"), text.as_bytes()) {
            let problems = error.problems();
            proptest::prop_assert!(!problems.is_empty());
            proptest::prop_assert!(problems.iter().all(|p| p.span.is_some() || p.path == "sources"), "{problems:?}");
            proptest::prop_assert!(!render(problems, &|_| Some(text.clone())).is_empty());
        }
    }
}

#[test]
fn what_a_detector_counts_and_where() {
    let with = |more: &str| after("pixels: (256, 256)", &format!("pixels: (256, 256), {more}"));
    let one = |more: &str| {
        let found = with(more);
        assert_eq!(found.len(), 1, "{found:?}");
        found[0].clone()
    };
    let qe = one(r#"counts: Electrons(qe: [("600 nm", 0.2), ("500 nm", 0.6)])"#);
    assert!(qe.contains("counts.qe") && qe.contains("do not rise"), "{qe}");
    let filter = one("filter: 1.5");
    assert!(filter.contains(".filter") && filter.contains("from 0 to 1"), "{filter}");
    let ring = one(r#"regions: [("ring", Annulus(at: ("0 mm", "0 mm"), inner: "2 mm", outer: "1 mm"))]"#);
    assert!(ring.contains("no area"), "{ring}");
    let disc = r#"("a", Disk(at: ("0 mm", "0 mm"), radius: "2 mm"))"#;
    let twice = one(&format!("regions: [{disc}, {disc}]"));
    assert!(twice.contains("\"a\" is there already"), "{twice}");
}

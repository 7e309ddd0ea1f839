//! Sections in other files.

use super::*;

const FINISHES: &str = r#"System(
    parameters: { "albedo": "0.05" },
    media: { "glass": Constant(n: 1.5) },
    scatter: { "black": Lambertian(reflectance: "= albedo") },
    surfaces: [(on: Node("screen"), specular: Absorb, scatter: "black")],
    run: (rays: 64),
)"#;

const SYSTEM: &str = r#"System(
    include: ["lib/finishes.ron"],
    elements: { "screen": (body: Aperture(diameter: "0 mm", outer: "60 mm")) },
    surfaces: [(on: Node("screen"), name: "white")],
    ambient: "glass",
    sources: { "sun": (flux: "1 W", extent: Point, at: "(0, 0, -9) mm", angular: Isotropic, spectrum: Line("550 nm")) },
    detectors: { "screen": (on: Node("screen"), quantity: Irradiance) },
)"#;

fn files(system: &str, finishes: &str) -> Vec<String> {
    said(&[("system.ron", system), ("lib/finishes.ron", finishes)])
}

#[test]
fn what_is_included_lies_under_the_system() {
    let folder = folder(&[("system.ron", SYSTEM), ("lib/finishes.ron", FINISHES)]);
    let compiled = compiled(folder.path());
    assert_eq!(compiled.warnings, []);
    assert_eq!(compiled.settings.rays, 64);
    assert_eq!(compiled.scene.parts[0].label, "screen.white", "the later entry is the system's");
    let names: Vec<&String> = compiled.inputs.keys().collect();
    assert_eq!(names, ["lib/finishes.ron", "system.ron"]);
    let longer = FINISHES.replace("0.05", "0.06");
    let other = super::folder(&[("system.ron", SYSTEM), ("lib/finishes.ron", &longer)]);
    let other = super::compiled(other.path());
    assert_eq!(other.inputs["system.ron"], compiled.inputs["system.ron"]);
    assert_ne!(other.inputs["lib/finishes.ron"], compiled.inputs["lib/finishes.ron"]);
}

/// A variant of a system is a file of its own: what it includes, and what is different.
#[test]
fn a_parameter_may_be_given_again_by_the_file_that_includes_it() {
    let variant = "System(include: [\"base/hood.ron\"], parameters: { \"hood.length\": \"120 mm\" }, run: (rays: 128))";
    let folder = folder(&[("system.ron", variant), ("base/hood.ron", HOOD)]);
    let compiled = compiled(folder.path());
    assert_eq!(compiled.parameters["gap"], "0.03 m");
    assert_eq!(compiled.settings.rays, 128);
}

#[test]
fn files_that_an_included_file_names_are_beside_it() {
    let table =
        FINISHES.replace("Lambertian(reflectance: \"= albedo\")", "Table(file: \"wall.txt\", scale: \"= albedo\")");
    assert_eq!(
        files(SYSTEM, &table),
        [
            r#"lib/finishes.ron:4:37: scatter["black"].file: "lib/wall.txt" does not exist; files are relative to the system file"#
        ]
    );
}

#[test]
fn every_problem_is_told_in_its_file() {
    let cases = [
        (
            SYSTEM.to_owned(),
            FINISHES.replace("n: 1.5", "n: -1.5"),
            r#"lib/finishes.ron:3:35: media["glass"].n: -1.5 is out of range; expected a value above 0"#,
        ),
        (
            SYSTEM.to_owned(),
            FINISHES.replace("= albedo", "= albdo"),
            r#"lib/finishes.ron:4:52: scatter["black"].reflectance: no parameter `albdo`; did you mean `albedo`?"#,
        ),
        (
            SYSTEM.replace("ambient: \"glass\"", "media: { \"glass\": Constant(n: 1.6) }"),
            FINISHES.to_owned(),
            r#"system.ron:5:14: media: the name "glass" is given twice; the other is in lib/finishes.ron:3:14"#,
        ),
        (
            SYSTEM.replace("lib/finishes.ron\"", "lib/finishes.ron\", \"no.ron\""),
            FINISHES.to_owned(),
            r#"system.ron:2:35: include: "no.ron" cannot be included: cannot be opened: No such file or directory (os error 2); included files are relative to the file that includes them"#,
        ),
        (
            SYSTEM.to_owned(),
            FINISHES.replace("System(", "System(include: [\"../system.ron\"],"),
            r#"lib/finishes.ron:1:18: include: "../system.ron" includes itself: system.ron > finishes.ron"#,
        ),
        (
            SYSTEM.to_owned(),
            FINISHES.replace("run: (", "run: "),
            "lib/finishes.ron:6:14: found `:` after a value; expected `,` or `)`; inside the `(` of line 1, column 7",
        ),
        (SYSTEM.to_owned(), "[1, 2]".to_owned(), "lib/finishes.ron:1:1: this is not a system; expected `System(..)`"),
        (
            SYSTEM.to_owned(),
            FINISHES.replace("media:", "medium:"),
            "lib/finishes.ron:3:5: medium: a system has no section `medium`; did you mean `media`?",
        ),
        (
            SYSTEM.replace("[\"lib/finishes.ron\"]", "\"lib/finishes.ron\""),
            FINISHES.to_owned(),
            "system.ron:2:14: include: section `include` has the wrong form; expected a list in brackets, `[(..), ..]`",
        ),
    ];
    for (system, finishes, wanted) in &cases {
        let told = files(system, finishes);
        assert!(told.iter().any(|problem| problem == wanted), "{wanted}: {told:#?}");
    }
}

#[test]
fn what_two_files_include_is_there_once() {
    let both = SYSTEM.replace("lib/finishes.ron\"", "lib/finishes.ron\", \"lib/more.ron\"");
    let more = "System(include: [\"finishes.ron\"], coatings: { \"ar\": Fresnel })";
    let said = said(&[("system.ron", &both), ("lib/finishes.ron", FINISHES), ("lib/more.ron", more)]);
    assert_eq!(said, [r#"lib/more.ron:1:47: warning: coatings["ar"]: coating "ar" is never used"#]);
}

//! `straylight bsdf`, and what is said of scatter models that cannot be.

mod bricks;

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

/// A table with a scatter model, lit from above.
fn system(scatter: &str, finish: &str) -> String {
    format!(
        r#"System(
    geometry: [(file: "bricks.gltf")],
    media: {{"glass": Constant(n: 1.5)}},
    scatter: {{"black": {scatter}}},
    surfaces: [(on: Node("table"), scatter: "black", {finish})],
    sources: {{
        "beam": (flux: "1 W", extent: Disk(radius: "2 mm"), at: "(0, 0, 90) mm", angular: Collimated(direction: "(0, 0, -1)"), spectrum: Line("550 nm")),
    }},
    detectors: {{
        "above": (on: Disk(at: "(0, 0, 80) mm", normal: "(0, 0, -1)", radius: "50 mm"), quantity: Irradiance),
    }},
)
"#
    )
}

fn run(system: &str, arguments: &[&str]) -> (tempfile::TempDir, Output) {
    let folder = tempfile::tempdir().expect("folder");
    let table = [("table", [-0.1, -0.1, -0.01], [0.1, 0.1, 0.0])];
    fs::write(folder.path().join("bricks.gltf"), bricks::gltf(&table)).expect("geometry");
    fs::write(folder.path().join("system.ron"), system).expect("system");
    let mut command = Command::new(env!("CARGO_BIN_EXE_straylight"));
    let output = command.current_dir(folder.path()).args(arguments).output().expect("the program runs");
    (folder, output)
}

/// The error of a system, compiled.
fn refused(scatter: &str, finish: &str) -> String {
    let (_folder, output) = run(&system(scatter, finish), &["check", "system.ron"]);
    assert_eq!(output.status.code(), Some(65), "{scatter}");
    String::from_utf8_lossy(&output.stderr).into_owned()
}

const ABSORB: &str = "specular: Absorb";

/// Numbers of one column of a table.
fn column(folder: &Path, file: &str, column: usize) -> Vec<f64> {
    let text = fs::read_to_string(folder.join(file)).expect(file);
    text.lines().skip(1).map(|row| row.split(',').nth(column).and_then(|n| n.parse().ok()).expect("a number")).collect()
}

#[test]
fn a_model_is_printed_and_drawn() {
    let text = system("HarveyShack(b0: 0.1, l: 0.01, s: -1.5)", ABSORB);
    let (folder, output) = run(&text, &["bsdf", "system.ron", "black", "-o", "out", "--incidence", "30 deg"]);
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    let out = folder.path().join("out");
    for picture in ["bsdf_beta.png", "bsdf_angle.png", "bsdf_polar.png", "tis.png"] {
        assert!(fs::read(out.join(picture)).expect(picture).starts_with(b"\x89PNG"), "{picture}");
    }
    // 2 pi b0 l^2/2 (101^(1/4)... of the closed form at normal incidence: l^2/2 ((1 + 1/l^2)^d - 1)/d, d = 1/4.
    let closed = std::f64::consts::PI * 0.1 * 1e-4 * ((1.0f64 + 1e4).powf(0.25) - 1.0) / 0.25;
    let tis = column(&out, "tis.csv", 1);
    assert!((tis[0] / closed - 1.0).abs() < 1e-5, "{} {closed}", tis[0]);
    assert!(tis.windows(2).all(|pair| pair[1] <= pair[0] * (1.0 + 1e-6)), "the horizon takes more and more");
    let bsdf = column(&out, "bsdf.csv", 4);
    let peak = bsdf.iter().copied().fold(0.0, f64::max);
    assert!((peak / 0.1 - 1.0).abs() < 1e-6, "{peak}");
    assert!(column(&out, "bsdf.csv", 0).iter().all(|angle| (angle - 30.0).abs() < 1e-9));
}

#[test]
fn a_polished_surface_tells_the_roughness_that_scatters() {
    let text = system(
        "KCorrelation(rms: Total(\"2 nm\"), b: \"1 mm\", s: 4)",
        "specular: Mirror(reflectance: 0.9), order: Scaled",
    );
    let (_folder, output) = run(&text, &["bsdf", "system.ron", "black", "--wavelength", "633 nm"]);
    let said = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(said.contains("rms height   2 nm over 0 .. 1/wavelength"), "{said}");
}

#[test]
fn names_that_do_not_exist_are_answered() {
    let text = system("Lambertian(reflectance: 0.05)", ABSORB);
    for (arguments, wanted) in [
        (["bsdf", "system.ron", "blak"].as_slice(), "no scatter model \"blak\"; did you mean \"black\"?"),
        (&["bsdf", "system.ron", "black", "--beyond", "glas"], "no medium \"glas\"; did you mean \"glass\"?"),
        (&["bsdf", "system.ron", "black", "--incidence", "90 deg"], "\"90 deg\" is not from 0 to below 90 deg"),
    ] {
        let (_folder, output) = run(&text, arguments);
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(64), "{said}");
        assert!(said.contains(wanted), "{said}");
    }
}

#[test]
fn models_that_cannot_be_are_refused() {
    for (scatter, wanted) in [
        (
            "HarveyShack(b0: 1, l: 0.1, s: 1.5)",
            "black\"].s: 1.5 is out of range; expected a slope of at most 0: scatter falls off",
        ),
        ("Gaussian(a: 1, sigma: 0)", "black\"].sigma: 0 is out of range; expected a value above 0"),
        ("CosinePower(a: 1, n: -1)", "black\"].n: -1 is out of range; expected 0 or more"),
        (
            "OrenNayar(reflectance: 1.2, sigma: \"20 deg\")",
            "black\"].reflectance: 1.2 is out of range; expected a number between 0 and 1",
        ),
        (
            "KCorrelation(rms: Total(\"1 nm\"), b: \"1 um\", s: 1.5)",
            "the rms height over all frequencies is infinite; expected s above 2, or `Band(rms:, from:, to:)`",
        ),
        (
            "KCorrelation(rms: Band(rms: \"1 nm\", from: \"2 /mm\", to: \"1 /mm\"), b: \"1 um\", s: 1.5)",
            "this band is empty; expected `from` below `to`",
        ),
        (
            "Psd(frequency: [\"2 /mm\", \"1 /mm\"], density: [\"1 um4\", \"1 um4\"])",
            "the frequencies do not increase here",
        ),
        (
            "Psd(frequency: [\"2 /mm\"], density: [\"1 um4\"])",
            "a spectrum of one frequency has no slope; expected two or more",
        ),
        ("Microfacet(distribution: GGX, alpha: 2)", "alpha: 2 is out of range; expected a roughness from 0.001 to 1"),
        (
            "Microfacet(distribution: Beckmann, alpha: 0.2, side: Transmit, energy: Compensated)",
            "what passes several facets is not modelled",
        ),
    ] {
        let said = refused(scatter, ABSORB);
        assert!(said.contains(wanted), "{scatter}: {said}");
    }
}

#[test]
fn a_polish_wants_the_reflectance_of_its_surface() {
    let polish = "KCorrelation(rms: Total(\"2 nm\"), b: \"1 mm\", s: 4)";
    let said = refused(polish, "specular: Mirror(reflectance: 0.9)");
    assert!(said.contains("expected `order: Scaled` on every surface that has it"), "{said}");
}

#[test]
fn a_surface_that_sends_off_too_much_names_the_angle_and_the_excess() {
    let said = refused("CosinePower(a: 1, n: 1)", ABSORB);
    assert!(said.contains("of the light that arrives at 0 deg, 1.09") && said.contains("too much"), "{said}");
}

#[test]
fn its_help_ends_with_an_example() {
    let (_folder, output) = run("", &["bsdf", "--help"]);
    let said = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(said.contains("Example:\n  straylight "), "{said}");
    assert!(said.lines().all(|line| line.chars().count() <= 125), "{said}");
}

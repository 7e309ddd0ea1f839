//! One system in several states: parameters, includes, nodes that are hidden, moved or replaced, and a CAD file that changed.

mod against;
#[path = "../bricks/mod.rs"]
mod bricks;
mod configure;
mod includes;
mod parameters;

use std::path::Path;
use std::process::{Command, Output};
use straylight::error::{Error, Problem};
use straylight::system::compile::{Compiled, compile};
use straylight::system::document::{Choice, Document};

/// A hood before a lens before a screen, all sized by parameters.
const HOOD: &str = r#"System(
    parameters: {
        "hood.length": "80 mm",
        "n": 1.5,
        "gap": "hood.length / 4",
        "power": "1 W",
    },
    elements: {
        "hood": (body: Tube(inner: "30 mm", outer: "32 mm", length: "= hood.length"), at: "= (0, 0, -hood.length - gap)"),
        "lens": (body: Lens(surfaces: [(form: Sphere(radius: "60 mm")), (form: Plane)], thickness: ["5 mm"], media: ["glass"],
            diameter: "28 mm")),
        "screen": (body: Aperture(diameter: "0 mm", outer: "60 mm"), at: "(0, 0, 100) mm"),
    },
    media: { "glass": Constant(n: "= n") },
    default: (specular: Absorb),
    sources: { "sun": (flux: "= power", extent: Disk(radius: "15 mm"), at: "(0, 0, -200) mm",
        angular: Collimated(field: ("4 deg", "0 deg")), spectrum: Line("550 nm")) },
    detectors: { "screen": (on: Node("screen"), quantity: Irradiance, pixels: (4, 4)) },
    run: (rays: 4096),
)"#;

/// A folder with these files.
fn folder(files: &[(&str, &str)]) -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    for (name, text) in files {
        let path = folder.path().join(name);
        std::fs::create_dir_all(path.parent().expect("a folder")).expect("made");
        std::fs::write(path, text).expect("written");
    }
    folder
}

/// The system `system.ron` of a folder, with parameters so set.
fn read(folder: &Path, set: &[(&str, &str)]) -> Result<Document, Error> {
    let set = set.iter().map(|(name, value)| (name.to_string(), value.to_string())).collect();
    Document::choose(&folder.join("system.ron"), &Choice { set, ..Choice::default() })
}

fn compiled(folder: &Path) -> Compiled {
    read(folder, &[]).and_then(|document| compile(&document)).unwrap_or_else(|error| panic!("{:#?}", error.problems()))
}

/// What is wrong with a system of these files, warnings included, a line each; the folder is left out.
fn said(files: &[(&str, &str)]) -> Vec<String> {
    let folder = folder(files);
    let problems: Vec<Problem> = match read(folder.path(), &[]) {
        Err(error) => error.problems().to_vec(),
        Ok(document) => match compile(&document) {
            Err(error) => error.problems().to_vec(),
            Ok(compiled) => compiled.warnings,
        },
    };
    let place = format!("{}/", folder.path().display());
    problems.iter().map(|problem| problem.to_string().replace(&place, "")).collect()
}

/// What is wrong after a replacement in a system.
fn after(system: &str, old: &str, new: &str) -> Vec<String> {
    assert!(system.contains(old), "{old} is not in the system");
    said(&[("system.ron", &system.replace(old, new))])
}

/// Exit code and output of the program in a folder.
fn program(folder: &Path, arguments: &[&str]) -> (i32, Output) {
    let output = Command::new(env!("CARGO_BIN_EXE_straylight")).current_dir(folder).args(arguments).output();
    let output = output.expect("the program runs");
    (output.status.code().unwrap_or(-1), output)
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

/// `results` of a run with these arguments, without the hashes of the inputs.
fn results(folder: &Path, arguments: &[&str]) -> serde_json::Value {
    let (code, output) = program(folder, &[&["run", "system.ron", "-o", "out"], arguments].concat());
    assert_eq!(code, 0, "{}", text(&output.stderr));
    let summary = std::fs::read_to_string(folder.join("out/summary.json")).expect("a summary");
    serde_json::from_str::<serde_json::Value>(&summary).expect("JSON")["results"].take()
}

//! Damaged and unusual tables: each is read or refused by the program as its manifest says.

use serde_json::Value;
use std::fs;
use std::path::Path;
use std::process::Command;

const FOLDER: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/data/malformed");

/// Exit code and first line of `straylight check` on a mirror whose coating or scatter is this table.
fn checked(table: &Path, folder: &Path) -> (Option<i32>, String) {
    let text = fs::read_to_string(table).expect("a table");
    let (section, use_of_it) = match text.lines().next().is_some_and(|line| line.contains("bsdf")) {
        true => ("scatter", "scatter"),
        false => ("coatings", "coating"),
    };
    let system = format!(
        "System(geometry: [], elements: {{ \"m\": (body: Mirror(form: Plane, diameter: \"20 mm\")) }},
         {section}: {{ \"t\": Table(file: {:?}) }}, surfaces: [(on: Node(\"m\"), {use_of_it}: \"t\")],
         sources: {{ \"lamp\": (flux: \"1 W\", extent: Point, at: \"(0, 0, -50) mm\",
            angular: Collimated(direction: \"(0, 0, 1)\"), spectrum: Line(\"550 nm\")) }},
         detectors: {{ \"sky\": (on: FarField(axis: \"(0, 0, 1)\"), quantity: Intensity) }})",
        table.display().to_string()
    );
    let path = folder.join("system.ron");
    fs::write(&path, system).expect("written");
    let output = Command::new(env!("CARGO_BIN_EXE_straylight")).arg("check").arg(&path).output().expect("it runs");
    let said = String::from_utf8_lossy(&output.stderr).lines().next().unwrap_or_default().to_owned();
    (output.status.code(), said)
}

#[test]
fn every_table_has_its_outcome() {
    let text = fs::read_to_string(format!("{FOLDER}/tables/manifest.json")).expect("manifest");
    let manifest: Value = serde_json::from_str(&text).expect("manifest is JSON");
    let folder = tempfile::tempdir().expect("a folder");
    let mut wrong = Vec::new();
    for case in manifest["cases"].as_array().expect("a list") {
        let (name, expect) = (case["file"].as_str().expect("file"), case["expect"].as_str().expect("expect"));
        let (code, said) = checked(&Path::new(FOLDER).join(name), folder.path());
        println!("{name} | {expect} | {code:?} | {said}");
        let fits = match expect {
            "accept" => code == Some(0),
            "reject" => code == Some(65) && !said.is_empty(),
            _ => code == Some(0) || code == Some(65),
        };
        if !fits {
            wrong.push(format!("{name}: expected {expect}, was {code:?}: {said}"));
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}

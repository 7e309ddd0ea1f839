//! Damaged and unusual glTF files: each is read or refused as its manifest says, quickly, and never with a panic.
//!
//! `tests/data/malformed/gltf` is our own; `khronos-validator` is a part of the test files of the Khronos glTF validator
//! (Apache-2.0, licence beside them).

use serde_json::Value;
use std::fs;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};
use straylight::error::{Problem, Severity};
use straylight::system::gltf::{self, GltfFile};

const FOLDER: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/data/malformed");

fn manifest(list: &str) -> Vec<Value> {
    let text = fs::read_to_string(format!("{FOLDER}/manifest.json")).expect("manifest");
    let manifest: Value = serde_json::from_str(&text).expect("manifest is JSON");
    manifest[list].as_array().expect("a list").clone()
}

/// Reads a file; fails the test if that takes long or the outcome contradicts itself.
fn read(path: &Path) -> Result<GltfFile, Vec<Problem>> {
    let start = Instant::now();
    let outcome = gltf::read(path);
    assert!(start.elapsed() < Duration::from_secs(5), "{} took {:?}", path.display(), start.elapsed());
    let problems = match &outcome {
        Ok(file) => &file.warnings,
        Err(problems) => problems,
    };
    for problem in problems {
        assert_eq!(problem.file.as_deref(), Some(path), "names the file");
        let line = problem.to_string();
        assert!(line.len() < 1000 && !line.contains('\n'), "one bearable line: {line}");
    }
    let errors = problems.iter().filter(|problem| problem.severity == Severity::Error).count();
    assert_eq!(outcome.is_err(), errors > 0, "{}", path.display());
    outcome
}

fn class(outcome: &Result<GltfFile, Vec<Problem>>) -> &'static str {
    match outcome {
        Err(_) => "reject",
        Ok(file) if file.warnings.is_empty() => "accept",
        Ok(_) => "accept-with-warning",
    }
}

/// Files too large or too special to be kept: written into `folder`.
fn generate(name: &str, folder: &Path) -> PathBuf {
    let base = fs::read_to_string(format!("{FOLDER}/gltf/000_ok_triangle_pair.gltf")).expect("control");
    let text = match &name[5..8] {
        "154" => {
            let deep = format!("{}1{}", r#"{"a":"#.repeat(100_000), "}".repeat(100_000));
            format!(r#"{},"extensions":{{"X":{deep}}}}}"#, base.trim_end().strip_suffix('}').expect("object"))
        }
        "162" => {
            let mut document: Value = serde_json::from_str(&base).expect("control");
            document["nodes"][0]["name"] = Value::String("n".repeat(1 << 20));
            document.to_string()
        }
        "164" => {
            let roots: Vec<usize> = (0..100_000).collect();
            let nodes = vec![serde_json::json!({}); roots.len()];
            serde_json::json!({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": roots}], "nodes": nodes})
                .to_string()
        }
        _ => panic!("{name} is not generated"),
    };
    let path = folder.join(&name[5..]);
    fs::write(&path, text).expect("temporary file");
    path
}

/// The FIFO case in `folder`: opening the pipe for reading would block for ever.
fn with_fifo(name: &str, folder: &Path) -> PathBuf {
    let path = folder.join(&name[5..]);
    fs::copy(format!("{FOLDER}/{name}"), &path).expect("copy");
    let status = std::process::Command::new("mkfifo").arg(folder.join("fifo.bin")).status();
    assert!(status.expect("mkfifo runs").success());
    path
}

/// Compares each outcome of a list of the manifest with what is expected; `--nocapture` shows the table.
fn compare(list: &str, path: impl Fn(&str, &Value) -> PathBuf) {
    let mut wrong = Vec::new();
    for case in manifest(list) {
        let (name, expect) = (case["file"].as_str().expect("file"), case["expect"].as_str().expect("expect"));
        let outcome = read(&path(name, &case));
        let class = class(&outcome);
        let said = outcome.map_or_else(|problems| problems, |file| file.warnings).into_iter().next();
        // The table names the file once.
        let said = said.map_or(String::new(), |problem| Problem { file: None, ..problem }.to_string());
        println!("{name} | {expect} | {class} | {said}");
        let fits = match expect {
            "accept" => class != "reject",
            "accept-or-reject" => true,
            other => class == other,
        };
        if !fits {
            wrong.push(format!("{name}: expected {expect}, was {class}: {said}"));
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}

/// Exit code, first line and seconds of `straylight check` on a system whose geometry is this file.
fn checked(path: &Path, folder: &Path) -> (Option<i32>, String, f64) {
    let system = folder.join("system.ron");
    let text = format!(
        r#"System(geometry: [(file: {path:?})], default: (specular: Absorb), sources: {{"lamp": (flux: "1 W", extent: Point,
            angular: Isotropic, spectrum: Line("550 nm"))}})"#
    );
    fs::write(&system, text).expect("system");
    let start = Instant::now();
    let program = std::process::Command::new(env!("CARGO_BIN_EXE_straylight")).arg("check").arg(&system).output();
    let output = program.expect("the program runs");
    let said = String::from_utf8_lossy(&output.stderr).lines().next().unwrap_or_default().to_owned();
    (output.status.code(), said, start.elapsed().as_secs_f64())
}

#[test]
fn the_program_refuses_with_65_and_never_crashes() {
    let folder = tempfile::tempdir().expect("temporary folder");
    let mut wrong = Vec::new();
    for list in ["cases", "khronos_validator"] {
        for case in manifest(list) {
            let (name, expect) = (case["file"].as_str().expect("file"), case["expect"].as_str().expect("expect"));
            let path = match (case.get("generated"), case.get("setup")) {
                (Some(_), _) => generate(name, folder.path()),
                (_, Some(_)) => with_fifo(name, folder.path()),
                _ => PathBuf::from(format!("{FOLDER}/{name}")),
            };
            let (code, said, seconds) = checked(&path, folder.path());
            let fits = match expect {
                "reject" => code == Some(65),
                "accept-or-reject" => matches!(code, Some(0 | 65)),
                _ => code == Some(0),
            };
            if !fits || seconds > 10.0 || said.is_empty() && code == Some(65) {
                wrong.push(format!("{name}: expected {expect}, {code:?} after {seconds:.1} s: {said}"));
            }
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}

#[test]
fn every_damaged_file_is_refused_and_every_sound_one_read() {
    let folder = tempfile::tempdir().expect("temporary folder");
    compare("cases", |name, case| match (case.get("generated"), case.get("setup")) {
        (Some(_), _) => generate(name, folder.path()),
        (_, Some(_)) => with_fifo(name, folder.path()),
        _ => PathBuf::from(format!("{FOLDER}/{name}")),
    });
}

#[test]
fn khronos_validator_files_are_read_or_refused() {
    compare("khronos_validator", |name, _| PathBuf::from(format!("{FOLDER}/{name}")));
}

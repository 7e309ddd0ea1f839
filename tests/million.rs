//! A million triangles: loaded, validated and built in seconds, in bounded memory. Run alone and in release:
//! `cargo test --release --test million -- --ignored --nocapture`.

use serde_json::json;
use std::fs;
use std::path::{Path, PathBuf};
use std::time::Instant;
use straylight::system::compile::compile;
use straylight::system::document::Document;

/// A closed sphere of latitudes and longitudes: 2 SECTORS (RINGS - 1) triangles, 1e6.
const RINGS: u32 = 501;
const SECTORS: u32 = 1000;

fn corners() -> Vec<[f32; 3]> {
    let corner = |ring: u32, sector: u32| {
        let theta = std::f64::consts::PI * f64::from(ring) / f64::from(RINGS);
        let phi = std::f64::consts::TAU * f64::from(sector) / f64::from(SECTORS);
        [theta.sin() * phi.cos(), theta.sin() * phi.sin(), theta.cos()].map(|x| x as f32)
    };
    let rings = (1..RINGS).flat_map(|ring| (0..SECTORS).map(move |sector| corner(ring, sector)));
    [[0.0, 0.0, 1.0]].into_iter().chain(rings).chain([[0.0, 0.0, -1.0]]).collect()
}

fn triangles() -> Vec<[u32; 3]> {
    let last = 1 + (RINGS - 1) * SECTORS;
    let at = |ring: u32, sector: u32| match ring {
        0 => 0,
        RINGS => last,
        _ => 1 + (ring - 1) * SECTORS + sector % SECTORS,
    };
    let quad = |ring: u32, s: u32| {
        let (a, b, c, d) = (at(ring, s), at(ring + 1, s), at(ring + 1, s + 1), at(ring, s + 1));
        [[a, b, c], [a, c, d]].into_iter().filter(|[x, y, z]| x != y && y != z && z != x)
    };
    (0..RINGS).flat_map(|ring| (0..SECTORS).flat_map(move |sector| quad(ring, sector))).collect()
}

/// Writes the sphere and a system around it into `folder`.
fn write(folder: &Path) -> PathBuf {
    let (corners, triangles) = (corners(), triangles());
    assert_eq!(triangles.len(), 1_000_000);
    let mut bytes: Vec<u8> = corners.iter().flatten().flat_map(|x| x.to_le_bytes()).collect();
    let split = bytes.len();
    bytes.extend(triangles.iter().flatten().flat_map(|i| i.to_le_bytes()));
    let document = json!({
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"name": "wall", "mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "type": "VEC3", "count": corners.len(),
             "min": [-1, -1, -1], "max": [1, 1, 1]},
            {"bufferView": 1, "componentType": 5125, "type": "SCALAR", "count": 3 * triangles.len()},
        ],
        "bufferViews": [
            {"buffer": 0, "byteLength": split},
            {"buffer": 0, "byteOffset": split, "byteLength": bytes.len() - split},
        ],
        "buffers": [{"byteLength": bytes.len(), "uri": "sphere.bin"}],
    });
    let system = r#"System(
        geometry: [(file: "sphere.gltf")],
        surfaces: [(on: Node("wall"), specular: Absorb)],
        sources: { "lamp": (flux: "1 W", extent: Point, at: "(0, 0, 0) mm", angular: Isotropic, spectrum: Line("550 nm")) },
        detectors: { "wall": (on: Node("wall"), quantity: Irradiance, pixels: (8, 8)) },
        run: (rays: 1000, seed: 1),
    )"#;
    fs::write(folder.join("sphere.bin"), bytes).expect("temporary file");
    fs::write(folder.join("sphere.gltf"), document.to_string()).expect("temporary file");
    fs::write(folder.join("system.ron"), system).expect("temporary file");
    folder.join("system.ron")
}

/// A line of /proc/self/status, bytes.
fn status(name: &str) -> f64 {
    let text = fs::read_to_string("/proc/self/status").expect("a Linux system");
    let line = text.lines().find_map(|line| line.strip_prefix(name)).expect("the line");
    let number = line.trim_start_matches(':').split_whitespace().next().expect("a number");
    1024.0 * number.parse::<f64>().expect("kilobytes")
}

#[test]
#[ignore = "measures time and memory: release, alone"]
fn a_million_triangles_load_in_twelve_seconds_and_four_hundred_bytes_each() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = write(folder.path());
    // 5: the high-water mark starts anew.
    fs::write("/proc/self/clear_refs", "5").expect("a Linux system");
    let (start, baseline) = (Instant::now(), status("VmRSS"));
    let compiled = Document::read(&path).and_then(|document| compile(&document)).expect("a good system");
    let (seconds, peak) = (start.elapsed().as_secs_f64(), status("VmHWM") - baseline);
    let count = compiled.scene.geometry.len() as f64;
    let each = peak / count;
    eprintln!("{count} triangles: {seconds:.2} s, peak {each:.0} bytes each, {} warnings", compiled.warnings.len());
    assert_eq!(count, 1e6);
    assert!(seconds < 12.0, "{seconds} s");
    assert!(each < 400.0, "{each} bytes per triangle");
}

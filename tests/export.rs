//! What is exported is what was placed: names, tags, triangles, closed bodies, coordinates.

use assert_cmd::Command;
use std::path::Path;
use straylight::system::compile::geometry;
use straylight::system::document::Document;
use straylight::system::gltf;

const SYSTEM: &str = r#"System(
    elements: {
        "doublet": (body: Lens(surfaces: [(form: Sphere(radius: "60 mm")), (form: Sphere(radius: "-45 mm")),
            (form: Sphere(radius: "-130 mm"))], thickness: ["8 mm", "3 mm"], media: ["crown", "flint"], diameter: "30 mm"),
            at: "(1000, 2000, 30000) mm", rotate: "(10, 0, 5) deg"),
        "primary": (body: Mirror(form: Conic(radius: "-400 mm", conic: -1), diameter: "100 mm", hole: "20 mm", thickness: "10 mm")),
        "secondary": (body: Mirror(form: Sphere(radius: "-150 mm"), diameter: "30 mm", thickness: "-5 mm"), at: "(0, 0, -120) mm"),
        "tube": (body: Tube(inner: "110 mm", outer: "114 mm", length: "200 mm"), at: "(0, 0, -200) mm"),
        "vane": (body: Vane(inner: "80 mm", outer: "110 mm", thickness: "2 mm", bevel: "30 deg", edge_radius: "20 um"), at: "(0, 0, -50) mm"),
        "spider": (body: Spider(vanes: 3, width: "1 mm", depth: "4 mm", inner: "30 mm", outer: "110 mm"), at: "(0, 0, -130) mm"),
        "prism": (body: Prism(corners: [("0 mm", "0 mm"), ("0 mm", "10 mm"), ("10 mm", "0 mm")], length: "12 mm", medium: "crown"), at: "(0, 0, 50) mm"),
        "window": (body: Plate(width: "20 mm", height: "30 mm", thickness: "2 mm", medium: "crown"), at: "(0, 0, 80) mm"),
        "hood": (body: Lathe(profile: [("60 mm", "0 mm"), ("70 mm", "50 mm"), ("60 mm", "50 mm")], closed: true), at: "(0, 0, 100) mm"),
        "stop": (body: Aperture(diameter: "8 mm", outer: "40 mm"), at: "(0, 0, 90) mm"),
    },
    media: { "crown": Constant(n: 1.5), "flint": Constant(n: 1.7) },
    default: (specular: Absorb),
    sources: { "s": (flux: "1 W", extent: Point, at: "(0, 0, -500) mm", angular: Isotropic, spectrum: Line("550 nm")) },
)"#;

#[test]
fn an_exported_file_reads_as_the_system_it_came_from() {
    let folder = tempfile::tempdir().expect("a folder");
    let (system, out) = (folder.path().join("system.ron"), folder.path().join("out.glb"));
    std::fs::write(&system, SYSTEM).expect("written");
    let mut straylight = Command::cargo_bin("straylight").expect("the binary");
    straylight.arg("export").args([&system, &out]).assert().success();
    let placed = geometry(&Document::read(&system).expect("read")).expect("compiled");
    let read = gltf::read(Path::new(&out)).expect("a glTF file");
    assert_eq!(read.warnings, []);
    assert_eq!(read.nodes.len(), placed.nodes.len());
    for (was, is) in placed.nodes.iter().zip(&read.nodes) {
        assert_eq!((&was.name, was.mesh.triangles.len()), (&is.name, is.mesh.triangles.len()));
        let open = ["stop"].contains(&was.name.as_str());
        assert_eq!((was.mesh.topology.closed(), is.mesh.topology.closed()), (!open, !open), "{}", was.name);
        assert!(!is.mesh.topology.inverted(), "{} is inside out", was.name);
        let mut tags = [was.tags.clone(), is.tags.clone()];
        tags.iter_mut().for_each(|tags| {
            tags.sort();
            tags.dedup();
        });
        assert_eq!(tags[0], tags[1]);
        let [low, high] = was.mesh.bounds().expect("corners").map(|corner| corner + placed.shift);
        let [a, b] = is.mesh.bounds().expect("corners");
        assert!((a - low).length() < 1e-8 && (b - high).length() < 1e-8, "{}: {a} {low}", was.name);
    }
}

#[test]
fn a_name_that_is_no_glb_is_refused() {
    let mut straylight = Command::cargo_bin("straylight").expect("the binary");
    straylight.args(["export", "systems/slab/system.ron", "out.stl"]).assert().code(64);
}

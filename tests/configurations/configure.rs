//! Nodes that are hidden, moved, turned, scaled, replaced and renamed.

use super::*;
use glam::DVec3;
use straylight::geometry::{Left, Ray};
use straylight::system::compile::{Placed, geometry};

/// Two bricks and a lens; a beam along z.
const SYSTEM: &str = r#"System(
    geometry: [(file: "bricks.gltf")],
    elements: { "lens": (body: Lens(surfaces: [(form: Sphere(radius: "60 mm")), (form: Sphere(radius: "-60 mm"))],
        thickness: ["5 mm"], media: ["glass"], diameter: "28 mm")) },
    configure: [],
    media: { "glass": Constant(n: 1.5) },
    default: (specular: Absorb),
    sources: { "sun": (flux: "1 W", extent: Disk(radius: "1 mm"), at: "(0, 0, -200) mm",
        angular: Collimated(direction: "(0, 0, 1)"), spectrum: Line("550 nm")) },
    detectors: { "table": (on: Node("table"), quantity: Irradiance) },
)"#;

const BRICKS: [bricks::Brick; 2] =
    [("block", [-0.01, -0.02, 0.02], [0.01, 0.02, 0.03]), ("table", [-0.05, -0.05, 0.05], [0.05, 0.05, 0.06])];

/// The files of the system with these changes.
fn with(changes: &str) -> tempfile::TempDir {
    let system = SYSTEM.replace("configure: []", &format!("configure: [{changes}]"));
    let other = bricks::gltf(&[("cube", [0.0, 0.0, 0.0], [0.004, 0.004, 0.004]), ("slab", [0.0; 3], [1.0, 1.0, 0.1])]);
    folder(&[
        ("system.ron", &system),
        ("bricks.gltf", &bricks::gltf(&BRICKS)),
        ("other.gltf", &other),
        ("pivot.gltf", PIVOT),
    ])
}

fn placed(changes: &str) -> Placed {
    let folder = with(changes);
    let placed = read(folder.path(), &[]).and_then(|document| geometry(&document));
    placed.unwrap_or_else(|error| panic!("{changes}: {:#?}", error.problems()))
}

/// Least and greatest corner of a node, mm, rounded to 10 nm.
fn bounds(placed: &Placed, name: &str) -> [[f64; 3]; 2] {
    let node = placed.nodes.iter().find(|node| node.name == name).unwrap_or_else(|| panic!("no {name}"));
    let bounds = node.mesh.bounds().expect("vertices");
    bounds.map(|corner| (1e3 * (corner + placed.shift)).to_array().map(|x| (1e5 * x).round() / 1e5 + 0.0))
}

/// An empty node, turned by 90 deg about z, 100 mm along x.
const PIVOT: &str = r#"{"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes":
    [{"name": "Pivot", "translation": [0.1, 0, 0], "rotation": [0, 0, 0.7071067811865476, 0.7071067811865476]}]}"#;

#[test]
fn nodes_are_moved_in_the_frame_that_is_named() {
    let block = |changes: &str| bounds(&placed(changes), "block");
    assert_eq!(block(""), [[-10.0, -20.0, 20.0], [10.0, 20.0, 30.0]]);
    assert_eq!(block(r#"(node: "block", move: "(1, 2, 3) mm")"#), [[-9.0, -18.0, 23.0], [11.0, 22.0, 33.0]]);
    // About its own origin, which is that of the file.
    assert_eq!(block(r#"(node: "bl*", rotate: "(0, 0, 90) deg")"#), [[-20.0, -10.0, 20.0], [20.0, 10.0, 30.0]]);
    let point = r#"(node: "block", rotate: "(90, 0, 0) deg", about: Point("(0, 20, 20) mm"))"#;
    assert_eq!(block(point), [[-10.0, 10.0, -20.0], [10.0, 20.0, 20.0]]);
    let scaled = r#"(node: "block", scale: (2, 1, 0.5), about: Point("(10, 0, 20) mm"))"#;
    assert_eq!(block(scaled), [[-30.0, -20.0, 20.0], [10.0, 20.0, 25.0]]);
    let twice = r#"(node: "block", move: "(0, 0, 1) mm"), (node: "*", move: "(0, 0, 1) mm")"#;
    assert_eq!(block(twice), [[-10.0, -20.0, 22.0], [10.0, 20.0, 32.0]]);
    // The frame of the element has come along when the block is turned about it.
    let carried =
        r#"(node: "lens", move: "(0, 20, 20) mm"), (node: "block", rotate: "(90, 0, 0) deg", about: Node("lens"))"#;
    assert_eq!(block(carried), [[-10.0, 10.0, -20.0], [10.0, 20.0, 20.0]]);
}

#[test]
fn a_frame_needs_no_mesh() {
    let changes = r#"(node: "block", move: "(1, 0, 0) mm", rotate: "(90, 0, 0) deg", about: Node("Pivot"))"#;
    let folder = with(changes);
    let system = std::fs::read_to_string(folder.path().join("system.ron")).expect("a system");
    let system = system.replace("\"bricks.gltf\")", "\"bricks.gltf\"), (file: \"pivot.gltf\")");
    std::fs::write(folder.path().join("system.ron"), system).expect("written");
    let placed = read(folder.path(), &[]).and_then(|document| geometry(&document)).expect("a good system");
    // Its x is y of the world: a quarter turn about it takes z to x, and the move goes along y.
    assert_eq!(bounds(&placed, "block"), [[120.0, -19.0, 90.0], [130.0, 21.0, 110.0]]);
}

#[test]
fn the_mesh_stays_a_solid() {
    let changes = [
        r#"(node: "block", rotate: "(10, 20, 30) deg", move: "(1, 2, 3) mm")"#,
        r#"(node: "block", scale: (2, 3, 4))"#,
        r#"(node: "block", scale: (-1, 1, 1), rotate: "(0, 0, 45) deg")"#,
    ];
    for (change, factor) in changes.iter().zip([1.0, 24.0, 1.0]) {
        let placed = placed(change);
        let topology = placed.nodes[0].mesh.topology;
        assert!(topology.closed() && !topology.inverted(), "{change}");
        assert!((topology.volume / (8e-6 * factor) - 1.0).abs() < 1e-6, "{change}: {}", topology.volume);
        assert!(factor != 1.0 || (topology.area / 2.8e-3 - 1.0).abs() < 1e-6, "{change}: {}", topology.area);
    }
}

#[test]
fn nodes_are_hidden_and_replaced() {
    let names = |placed: &Placed| placed.nodes.iter().map(|node| node.name.clone()).collect::<Vec<_>>();
    assert_eq!(names(&placed(r#"(node: "block", hide: true)"#)), ["table", "lens"]);
    assert_eq!(names(&placed(r#"(node: "lens", hide: true)"#)), ["block", "table"]);
    let replaced = placed(r#"(node: "block", replace: (file: "other.gltf", node: "cube"), move: "(0, 0, 7) mm")"#);
    assert_eq!(names(&replaced), ["block", "table", "lens"]);
    assert_eq!(bounds(&replaced, "block"), [[0.0, 0.0, 7.0], [4.0, 4.0, 11.0]]);
    assert_eq!(replaced.nodes[0].tags, ["cube"]);
    let small = placed(r#"(node: "block", replace: (file: "other.gltf", node: "cube", unit: "mm"))"#);
    assert_eq!(bounds(&small, "block")[1], [0.004, 0.004, 0.004]);
    // The frame of the new node lies on that of the old one.
    let in_place =
        placed(r#"(node: "lens", move: "(0, 0, 5) mm"), (node: "lens", replace: (file: "other.gltf", node: "cube"))"#);
    assert_eq!(bounds(&in_place, "lens"), [[0.0, 0.0, 5.0], [4.0, 4.0, 9.0]]);
    let folder = with(r#"(node: "block", replace: (file: "other.gltf", node: "cube"))"#);
    assert!(compiled(folder.path()).inputs.contains_key("other.gltf"));
}

/// The first event of a ray along z at a distance from the axis, mm.
fn first(changes: &str, from: [f64; 3]) -> (DVec3, DVec3) {
    let folder = with(changes);
    let scene = compiled(folder.path()).scene;
    let ray = Ray { origin: 1e-3 * DVec3::from_array(from) - scene.shift, direction: DVec3::Z };
    let crossing = scene.geometry.nearest(&ray, &Left::nothing()).expect("something is hit");
    (1e3 * (crossing.point + scene.shift), crossing.hits[0].normal)
}

/// The surface that the light meets is the exact one, where the node now is.
#[test]
fn an_exact_surface_goes_with_its_node() {
    let (at, normal) = first("", [3.0, 4.0, -50.0]);
    let (moved, same) = first(r#"(node: "lens", move: "(3, 4, 10) mm")"#, [6.0, 8.0, -50.0]);
    assert!((moved - at - DVec3::new(3.0, 4.0, 10.0)).length() < 1e-12 && (same - normal).length() < 1e-12);
    // A sphere of 60 mm.
    let sag = 60.0 - (3600.0f64 - 25.0).sqrt();
    assert!((at.z - sag).abs() < 1e-12);
    // Half a turn about its middle shows the back, which has the same form.
    let turned = r#"(node: "lens", rotate: "(0, 180, 0) deg", about: Point("(0, 0, 2.5) mm"))"#;
    let (behind, other) = first(turned, [3.0, 4.0, -50.0]);
    assert!((behind - at).length() < 1e-12 && (other - normal).length() < 1e-12, "{behind}");
    // Tilted about its vertex by an angle, the sphere's centre is where the tilt takes it.
    let (tilted, normal) = first(r#"(node: "lens", rotate: "(0, 10, 0) deg")"#, [3.0, 4.0, -50.0]);
    let (sin, cos) = 10f64.to_radians().sin_cos();
    let centre = 60.0 * DVec3::new(sin, 0.0, cos);
    assert!(((tilted - centre).length() - 60.0).abs() < 1e-11, "{tilted}");
    assert!((normal - (tilted - centre).normalize()).length() < 1e-12);
}

/// What a system declares of a face of a file is declared of where the file has it.
#[test]
fn a_declared_surface_goes_with_its_node() {
    let plane = r#"surfaces: [(on: Faces(of: "block", where: Nearest(point: "(3, 4, 20) mm")), specular: Absorb,
        exact: (form: Plane, vertex: "(0, 0, 20) mm", axis: "(0, 0, -1)"))],
    media:"#;
    let system = |at: &str| {
        let moved = format!(r#"configure: [(node: "block", move: "(0, 0, {at}) mm")]"#);
        SYSTEM.replace("configure: []", &moved).replace("media: {", &format!("{plane} {{"))
    };
    for at in ["0", "-7"] {
        let folder = folder(&[("system.ron", &system(at)), ("bricks.gltf", &bricks::gltf(&BRICKS))]);
        assert_eq!(compiled(folder.path()).warnings, [], "{at}");
    }
    let scaled = system("-7").replace("move: \"(0, 0, -7) mm\"", "scale: (1, 1, 1.5)");
    let said = said(&[("system.ron", &scaled), ("bricks.gltf", &bricks::gltf(&BRICKS))]);
    assert!(said[0].contains("`block`: it is scaled by `configure`, which would change this shape"), "{said:#?}");
}

#[test]
fn names_of_the_system_hold_for_what_the_geometry_calls_otherwise() {
    let aliases = r#"aliases: { "block": "Brick", "table": "Bench" }, configure: [(node: "Brick", move: "(0, 0, 1) mm")],
        surfaces: [(on: Tag("Brick"), specular: Mirror(reflectance: 0.9))]"#;
    let system = SYSTEM.replace("configure: []", aliases).replace("Node(\"table\")", "Node(\"Bench\")");
    let files = [("system.ron", system.as_str()), ("bricks.gltf", &bricks::gltf(&BRICKS))];
    assert_eq!(said(&files), [""; 0]);
    let folder = folder(&files);
    let parts: Vec<String> = compiled(folder.path()).scene.parts.iter().map(|part| part.label.clone()).collect();
    assert_eq!(parts[..2], ["Brick", "Bench"]);
}

#[test]
fn every_slip_is_told_where_it_stands() {
    let cases = [
        (
            r#"(node: "blokc", hide: true)"#,
            r#"system.ron:5:24: configure[0].node: no node matches `blokc`; did you mean `block`?"#,
        ),
        (
            r#"(node: "block", rotate: "(0, 1, 0) deg", about: Node("Pivto"))"#,
            "system.ron:5:17: configure[0]: no node matches `Pivto`; expected one of `block`, `table`, `lens`",
        ),
        (
            r#"(node: "lens", move: "(0, 0, 1) mm"), (node: "lens", rotate: "(0, 1, 0) deg", about: Node("*"))"#,
            "system.ron:5:55: configure[1]: `*` names several frames: `block`, `lens`; expected the name or path of one node",
        ),
        (
            r#"(node: "lens", move: "(0, 0, 1) mm"), (node: "lens", scale: (2, 2, 2))"#,
            "system.ron:5:55: configure[1]: `lens` has exact surfaces, which a scale would change; give its dimensions as expressions of a parameter",
        ),
        (
            r#"(node: "block")"#,
            "system.ron:5:17: configure[0]: this changes nothing; expected `hide: true`, or `replace`, `scale`, `rotate`, `move`",
        ),
        (
            r#"(node: "block", hide: true, move: "(0, 0, 1) mm")"#,
            "system.ron:5:17: configure[0]: a hidden node is not changed; expected `hide: true`, or `replace`, `scale`, `rotate`, `move`",
        ),
        (
            r#"(node: "block", scale: (1, 0, 1))"#,
            "system.ron:5:44: configure[0].scale[1]: 0 is out of range; expected a factor that is not 0",
        ),
        (
            r#"(node: "block", replace: (file: "other.gltf", node: "*"))"#,
            "system.ron:5:69: configure[0].replace.node: several nodes match: `cube` and more; expected one node",
        ),
        (
            r#"(node: "block", replace: (file: "other.gltf", node: "cub"))"#,
            "system.ron:5:69: configure[0].replace.node: no node matches `cub`; did you mean `cube`?",
        ),
        (
            r#"(node: "block", replace: (file: "no.gltf", node: "cube"))"#,
            r#"system.ron:5:49: configure[0].replace.file: "no.gltf" does not exist; files are relative to the system file"#,
        ),
        (
            r#"(node: "*b*", replace: (file: "other.gltf", node: "cube"))"#,
            "system.ron:5:24: configure[0].node: several nodes would be replaced by one: `block`, `table`; expected one node",
        ),
    ];
    let told = |changes: &str| {
        let folder = with(changes);
        let error = read(folder.path(), &[]).and_then(|document| compile(&document)).err();
        let problem = error.as_ref().and_then(|error| error.problems().iter().find(|problem| problem.is_error()));
        problem.map_or(String::new(), |p| p.to_string().replace(&format!("{}/", folder.path().display()), ""))
    };
    let said: Vec<String> = cases.iter().map(|(changes, _)| told(changes)).collect();
    assert_eq!(said, cases.iter().map(|case| case.1).collect::<Vec<_>>());
    for (alias, wanted) in [
        (
            "\"bock\": \"x\"",
            "system.ron:5:16: aliases[\"bock\"]: no node or material is called `bock`; did you mean `block`?",
        ),
        (
            "\"block\": \"table\"",
            "system.ron:5:16: aliases[\"block\"]: the geometry has a `table` of its own; expected a name that the geometry has not",
        ),
    ] {
        let system = SYSTEM.replace("configure: []", &format!("aliases: {{ {alias} }}"));
        assert_eq!(said_of(&system)[0], wanted);
    }
}

fn said_of(system: &str) -> Vec<String> {
    said(&[("system.ron", system), ("bricks.gltf", &bricks::gltf(&BRICKS))])
}

//! A re-export of the geometry against its older state.

use super::*;

/// What the system was written for.
const OLD: [bricks::Brick; 4] = [
    ("hood", [-0.03, -0.03, -0.2], [0.03, 0.03, -0.1]),
    ("block", [-0.01, -0.02, 0.02], [0.01, 0.02, 0.03]),
    ("strut", [0.04, 0.0, 0.0], [0.05, 0.001, 0.02]),
    ("table", [-0.05, -0.05, 0.05], [0.05, 0.05, 0.06]),
];

/// The hood has another name, the block is thicker, the strut is gone, a post is new, the table stands 5 mm farther.
const NEW: [bricks::Brick; 4] = [
    ("hood_v2", [-0.03, -0.03, -0.2], [0.03, 0.03, -0.1]),
    ("block", [-0.01, -0.02, 0.02], [0.01, 0.02, 0.032]),
    ("post", [-0.04, 0.0, 0.0], [-0.037, 0.003, 0.04]),
    ("table", [-0.05, -0.05, 0.055], [0.05, 0.05, 0.065]),
];

const SYSTEM: &str = r#"System(
    geometry: [(file: "parts.gltf")],
    scatter: { "black": Lambertian(reflectance: 0.05) },
    surfaces: [
        (on: Node("*"), specular: Absorb),
        (on: Node("hood"), specular: Absorb, scatter: "black"),
        (on: Faces(of: "block", where: Normal(direction: "(0, 0, -1)", within: "5 deg")), specular: Mirror(reflectance: 0.9)),
        (on: Tag("table"), specular: Absorb),
    ],
    sources: { "sun": (flux: "1 W", extent: Disk(radius: "1 mm"), at: "(0, 0, -300) mm",
        angular: Collimated(direction: "(0, 0, 1)"), spectrum: Line("550 nm")) },
    detectors: { "table": (on: Node("table"), quantity: Irradiance) },
)"#;

fn workplace(system: &str) -> tempfile::TempDir {
    let old_system = SYSTEM.replace("parts.gltf", "old/parts.gltf");
    let (old, new) = (bricks::gltf(&OLD), bricks::gltf(&NEW));
    folder(&[("system.ron", system), ("old.ron", &old_system), ("parts.gltf", &new), ("old/parts.gltf", &old)])
}

/// The lines of the answer, each with single spaces.
fn answer(folder: &Path, older: &str) -> (i32, Vec<String>) {
    let (code, output) = program(folder, &["check", "system.ron", "--against", older]);
    let words = |line: &str| line.split_whitespace().collect::<Vec<_>>().join(" ");
    (code, text(&output.stdout).lines().map(words).collect())
}

#[test]
fn what_is_new_lost_renamed_moved_and_changed_is_told() {
    let folder = workplace(SYSTEM);
    for older in ["old/parts.gltf", "old.ron"] {
        let (code, lines) = answer(folder.path(), older);
        // The hood's entry selects nothing: the check itself fails, after the comparison.
        assert_eq!(code, 65);
        for wanted in [
            "renamed hood_v2 - hood 31200 (0, 0, -150) - surfaces[0]",
            "changed block - - 3040 (0, 0, 26) - surfaces[0], surfaces[2]",
            "new post - - 498 (-38.5, 1.5, 20) - surfaces[0]",
            "moved table - - 24000 (0, 0, 60) (0, 0, 5) surfaces[0], surfaces[3]",
            "lost strut - - 460 (45, 0.5, 10) - surfaces[0]",
            // The block: one face has moved by 2 mm, the sides are other faces.
            "moved block block - 800 (0, 0, 32) (0, 0, 2) surfaces[0]",
            "lost block block - 200 (0, -20, 25) - surfaces[0]",
            "new block block - 240 (0, -20, 26) - surfaces[0]",
            "surfaces[1] 6 12 0 31200 0 selects nothing any more",
            "surfaces[2] 7 2 2 800 800",
            "surfaces[3] 8 12 12 24000 24000",
            "aliases: {",
            "\"hood_v2\": \"hood\",",
        ] {
            assert!(lines.iter().any(|line| line == wanted), "{wanted}: {lines:#?}");
        }
    }
}

#[test]
fn the_lines_to_paste_keep_every_assignment() {
    let aliased = SYSTEM.replace("surfaces:", "aliases: { \"hood_v2\": \"hood\" },\n    surfaces:");
    let folder = workplace(&aliased);
    let (code, lines) = answer(folder.path(), "old/parts.gltf");
    assert_eq!(code, 0, "{lines:#?}");
    assert!(!lines.iter().any(|line| line.starts_with("renamed") || line.contains("aliases")), "{lines:#?}");
    assert!(
        lines.iter().any(|line| line.starts_with("surfaces[1]") && line.ends_with("12 12 31200 31200")),
        "{lines:#?}"
    );
}

#[test]
fn a_geometry_does_not_differ_from_itself() {
    let folder = workplace(&SYSTEM.replace("Node(\"hood\")", "Node(\"hood*\")"));
    let (code, lines) = answer(folder.path(), "parts.gltf");
    assert_eq!(code, 0);
    assert_eq!(lines[..6], ["Against parts.gltf", "Nodes that differ", "none", "", "Faces that differ", "none"]);
}

#[test]
fn an_older_state_must_be_there_and_clear() {
    let folder = workplace(SYSTEM);
    let told = |arguments: &[&str]| {
        let (code, output) = program(folder.path(), &[&["check", "system.ron", "--against"], arguments].concat());
        (code, text(&output.stderr).lines().next().unwrap_or_default().to_owned())
    };
    assert_eq!(told(&["gone.glb"]), (66, "gone.glb: this file does not exist".into()));
    let two = SYSTEM.replace("\"parts.gltf\")", "\"parts.gltf\"), (file: \"other.gltf\", at: \"(1, 0, 0) m\")");
    std::fs::write(folder.path().join("system.ron"), two).expect("written");
    std::fs::write(folder.path().join("other.gltf"), bricks::gltf(&[("far", [0.0; 3], [0.1; 3])])).expect("written");
    std::fs::copy(folder.path().join("old/parts.gltf"), folder.path().join("older.gltf")).expect("copied");
    let (code, said) = told(&["older.gltf"]);
    assert!(code == 64 && said.contains("which file of `geometry` is its newer state?"), "{said}");
}

//! The shape of the source: who may use whom, which file opens which door, and how long a file may be.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// The layers, lowest first. A module may use itself and what stands in the rows above its own; modules that share a row are
/// blind to each other.
const LAYERS: [&[&str]; 12] = [
    &["error", "math", "settings"],
    &["geometry", "optics", "prescription"],
    &["film", "import"],
    &["medium"],
    &["coating", "bsdf", "packet", "source", "detector", "aim"],
    &["surface", "tally", "filter"],
    &["scene"],
    &["system", "transport"],
    &["study"],
    &["report"],
    &["lib", "cli"],
    &["main"],
];

/// Names of the trade: types that every layer may speak of, and derives.
const SPOKEN_EVERYWHERE: [&str; 6] = ["arrayvec", "glam", "num-complex", "rayon", "serde", "thiserror"];

/// Every other library has a door: the one file or folder that imports it. Two doors are two unrelated uses.
const DOORS: [(&str, &[&str]); 24] = [
    ("annotate-snippets", &["report/problems.rs"]),
    ("base64", &["report/html/", "system/gltf/uri.rs"]),
    ("clap", &["cli/", "main.rs"]),
    ("colorous", &["report/picture/scale.rs"]),
    (
        "csv",
        &[
            "coating/tabulated/csv.rs",
            "report/compare/",
            "report/ghosts/",
            "report/objects/",
            "report/paths.rs",
            "report/pst/",
            "report/sensitivity.rs",
        ],
    ),
    ("gltf", &["system/gltf/"]),
    ("indicatif", &["cli/tracing.rs"]),
    ("maud", &["report/html/"]),
    ("noto-sans-mono-bitmap", &["report/picture/canvas.rs"]),
    ("obvhs", &["geometry/tree.rs"]),
    ("png", &["report/picture/plot.rs"]),
    ("rand_philox", &["math/rng.rs"]),
    ("roxmltree", &["bsdf/klems_xml.rs"]),
    ("ron", &["system/document/", "system/schema.rs"]),
    ("serde-saphyr", &["medium/page.rs"]),
    ("serde_json", &["import/rayoptics/", "report/", "study/pst/kept.rs", "system/gltf/", "system/select.rs"]),
    ("serde_path_to_error", &["system/document/entry.rs", "system/gltf/container.rs"]),
    ("sha2", &["system/document/mod.rs", "system/compile/mod.rs"]),
    ("signal-hook", &["cli/stop.rs"]),
    ("smallvec", &["aim/mod.rs", "geometry/crossing.rs", "geometry/nearest.rs", "surface/mod.rs"]),
    ("sobol_burley", &["math/lowdiscrepancy.rs"]),
    ("statrs", &["math/statistics.rs"]),
    ("strsim", &["error.rs"]),
    // The second door tries the folder of a report before a run, the third is a test's.
    ("tempfile", &["report/atomic.rs", "cli/tracing.rs", "system/gltf/uri.rs"]),
];

/// One source file.
struct Source {
    /// Path below `src`, with `/`.
    path: String,
    /// Its lines without comments.
    code: Vec<String>,
    lines: usize,
}

impl Source {
    /// The layer's name: the first part of the path.
    fn module(&self) -> &str {
        self.path.split(['/', '.']).next().unwrap_or_default()
    }

    /// Names on the way from the crate's root to this file: `system/gltf/mod.rs` is two deep.
    fn depth(&self) -> usize {
        self.path.trim_end_matches(".rs").trim_end_matches("/mod").split('/').count()
    }

    /// Modules at the crate's root that a line speaks of.
    fn uses(&self, line: &str) -> Vec<String> {
        let mut found: Vec<String> = after(line, "crate::").iter().map(|rest| word(rest)).collect();
        found.extend(after(line, "straylight::").iter().map(|rest| word(rest)));
        let climb = "super::".repeat(self.depth());
        found.extend(after(line, &climb).iter().map(|rest| word(rest)).filter(|name| height(name).is_some()));
        found
    }
}

/// What follows each stand-alone occurrence of `path` in `line`.
fn after<'a>(line: &'a str, path: &str) -> Vec<&'a str> {
    let alone = |at: &usize| !line[..*at].ends_with(|c: char| c.is_alphanumeric() || c == '_' || c == ':');
    line.match_indices(path).map(|(at, _)| at).filter(alone).map(|at| &line[at + path.len()..]).collect()
}

fn word(text: &str) -> String {
    text.chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect()
}

fn height(module: &str) -> Option<usize> {
    LAYERS.iter().position(|row| row.contains(&module))
}

fn sources() -> Vec<Source> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut files = Vec::new();
    collect(&root, &mut files);
    files.sort();
    let read = |file: &PathBuf| {
        let text = std::fs::read_to_string(file).expect("a source file can be read");
        let path = file.strip_prefix(&root).expect("below src").to_string_lossy().replace('\\', "/");
        let code = text.lines().map(|line| line.split("//").next().unwrap_or_default().to_owned()).collect();
        Source { path, code, lines: text.lines().count() }
    };
    let sources: Vec<Source> = files.iter().map(read).collect();
    assert!(sources.len() > 50, "only {} source files found", sources.len());
    sources
}

fn collect(folder: &Path, files: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).expect("a source folder can be listed") {
        let path = entry.expect("an entry of it").path();
        if path.is_dir() {
            collect(&path, files);
        } else if path.extension().is_some_and(|e| e == "rs") {
            files.push(path);
        }
    }
}

/// True if `user` may speak of `used`.
fn may_use(user: &str, used: &str) -> bool {
    user == used || height(user).zip(height(used)).is_some_and(|(user, used)| used < user)
}

#[test]
fn a_file_uses_only_layers_below_it() {
    let mut wrong = Vec::new();
    let mut edges = 0;
    for source in sources() {
        assert!(height(source.module()).is_some(), "{}: which layer is this?", source.path);
        for (number, line) in source.code.iter().enumerate() {
            for used in source.uses(line).iter().filter(|used| source.module() != used.as_str()) {
                edges += 1;
                // The binary is another crate: `straylight::` and `cli::` are what it is made of.
                let whole = matches!(source.module(), "cli" | "main" | "lib");
                if !whole && !may_use(source.module(), used) {
                    wrong.push(format!("src/{}:{}: uses {used:?}: {}", source.path, number + 1, line.trim()));
                }
            }
        }
    }
    assert!(edges > 100, "only {edges} uses found: is the search broken?");
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// The search itself: it must see each way of pointing upward.
#[test]
fn an_upward_use_is_seen_however_it_is_written() {
    let source = |path: &str| Source { path: path.into(), code: Vec::new(), lines: 0 };
    let deep = source("geometry/mesh/weld.rs");
    assert_eq!(deep.uses("use crate::tally::Layout;"), ["tally"]);
    assert_eq!(deep.uses("    let x: crate::scene::Part = f(crate::report::text);"), ["scene", "report"]);
    assert_eq!(deep.uses("use super::super::super::scene::Part;"), ["scene"]);
    assert_eq!(deep.uses("use super::super::Frame;"), [""; 0]);
    assert_eq!(source("packet.rs").uses("use super::scene::Part;"), ["scene"]);
    assert_eq!(deep.uses("use crate::{scene, tally};"), [""]);
    assert!(!may_use("geometry", "scene") && !may_use("geometry", "") && !may_use("system", "transport"));
    assert!(may_use("transport", "tally") && may_use("geometry", "geometry"));
}

#[test]
fn a_library_is_imported_behind_one_door() {
    let manifest = std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("Cargo.toml")).expect("manifest");
    let section = manifest.split("\n[dependencies]\n").nth(1).and_then(|rest| rest.split("\n[").next());
    let names: Vec<&str> =
        section.unwrap_or_default().lines().filter_map(|line| line.split_once(" = ")).map(|(n, _)| n).collect();
    let doors: BTreeMap<&str, &[&str]> = DOORS.into_iter().collect();
    let mut wrong = Vec::new();
    for name in names.iter().filter(|name| !SPOKEN_EVERYWHERE.contains(name)) {
        let Some(doors) = doors.get(name) else {
            wrong.push(format!("{name}: a dependency without a door: say in tests/layers.rs who imports it"));
            continue;
        };
        let path = format!("{}::", name.replace('-', "_"));
        for source in sources() {
            // `system::gltf` is a module of this program that bears the library's name.
            let own = source.code.iter().any(|line| line.contains(&format!("::{path}{{self")));
            let opened = !own && source.code.iter().any(|line| !after(line, &path).is_empty());
            if opened && !doors.iter().any(|door| source.path.starts_with(door)) {
                wrong.push(format!("src/{}: imports {name}, whose door is {doors:?}", source.path));
            }
        }
    }
    let gone = doors.keys().filter(|name| !names.contains(*name)).map(|name| format!("{name}: no longer a dependency"));
    wrong.extend(gone);
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// Two versions of glam would make two types of vector that do not meet.
#[test]
fn there_is_one_glam() {
    let lock = std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("Cargo.lock")).expect("Cargo.lock");
    assert_eq!(lock.lines().filter(|line| *line == "name = \"glam\"").count(), 1);
}

#[test]
fn no_file_is_longer_than_four_hundred_lines() {
    let long: Vec<String> =
        sources().iter().filter(|s| s.lines > 400).map(|s| format!("src/{}: {} lines", s.path, s.lines)).collect();
    assert!(long.is_empty(), "{}", long.join("\n"));
}

#[test]
fn the_source_is_safe_and_the_library_neither_prints_nor_exits() {
    let mut wrong = Vec::new();
    for source in sources() {
        let outside = matches!(source.module(), "cli" | "main");
        for (number, line) in source.code.iter().enumerate() {
            let loud = ["println!", "eprintln!", "print!(", "dbg!(", "process::exit", "todo!(", "unimplemented!("];
            // The one door to code compiled for newer processors: measured, documented, and asked for by name.
            let kernel = source.path == "geometry/nearest.rs" && line.contains("unsafe { self.search_avx2(");
            let unsafe_code = !kernel && after(line, "unsafe ").len() + after(line, "static mut").len() > 0;
            if unsafe_code || (!outside && loud.iter().any(|call| !after(line, call).is_empty())) {
                wrong.push(format!("src/{}:{}: {}", source.path, number + 1, line.trim()));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

//! The program as a user meets it: exit codes, first lines, signals, closed pipes.

mod bricks;

use std::fs;
use std::path::Path;
use std::process::{Child, Command, Output, Stdio};
use std::time::{Duration, Instant};

/// A glass block on a table, a beam from above, a window that watches.
const GOOD: &str = r#"System(
    geometry: [(file: "bricks.gltf")],
    media: {"glass": Constant(n: 1.5)},
    scatter: {"black": Lambertian(reflectance: 0.05)},
    surfaces: [
        (on: Node("block"), medium: "glass"),
        (on: Node("table"), specular: Absorb, scatter: "black"),
    ],
    sources: {
        "beam": (flux: "1 W", extent: Disk(radius: "2 mm"), at: "(0, 0, 90) mm", angular: Collimated(direction: "(0, 0, -1)"), spectrum: Line("550 nm")),
    },
    detectors: {
        "above": (on: Disk(at: "(0, 0, 80) mm", normal: "(0, 0, -1)", radius: "50 mm"), quantity: Irradiance, pixels: (16, 16)),
    },
    run: (rays: 2_048),
)
"#;

/// What some tests add to the media.
const RESIN: &str =
    r#"media: {"resin": Tabulated(wavelength: ["400 nm", "700 nm"], n: [1.52, 1.49]), "glass": Constant(n: 1.5)}"#;

/// The good system with resin in the block and no glass.
fn resin() -> String {
    let system =
        GOOD.replace(r#"media: {"glass": Constant(n: 1.5)}"#, RESIN).replace(r#", "glass": Constant(n: 1.5)}"#, "}");
    system.replace("medium: \"glass\"", "medium: \"resin\"")
}

/// A folder with `system.ron` and its geometry.
fn folder(system: &str) -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("folder");
    let bricks =
        [("block", [-0.01, -0.01, 0.001], [0.01, 0.01, 0.006]), ("table", [-0.1, -0.1, -0.01], [0.1, 0.1, 0.0])];
    fs::write(folder.path().join("bricks.gltf"), bricks::gltf(&bricks)).expect("geometry");
    fs::write(folder.path().join("system.ron"), system).expect("system");
    folder
}

fn program(folder: &Path, arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_straylight"));
    command.current_dir(folder).args(arguments);
    command
}

fn outcome(folder: &Path, arguments: &[&str]) -> (i32, Output) {
    let output = program(folder, arguments).output().expect("the program runs");
    (output.status.code().unwrap_or(-1), output)
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

/// Exit code and first line on standard error after a replacement in the good system.
fn after(old: &str, new: &str) -> (i32, String) {
    assert!(GOOD.contains(old), "{old} is not in the good system");
    let (code, output) = outcome(folder(&GOOD.replace(old, new)).path(), &["check", "system.ron"]);
    (code, text(&output.stderr).lines().next().unwrap_or_default().to_owned())
}

#[test]
fn every_way_to_end_has_its_code() {
    let folder = folder(GOOD);
    fs::write(folder.path().join("bad.ron"), "System(").expect("file");
    fs::write(folder.path().join("lost.ron"), GOOD.replace("bricks.gltf", "gone.glb")).expect("file");
    fs::write(folder.path().join("cut.ron"), GOOD.replace("rays: 2_048", "rays: 2_048, max_events: 1")).expect("file");
    let levels = GOOD.replace("run: (", "variants: { \"level\": Bracket },\n    run: (");
    fs::write(folder.path().join("levels.ron"), levels).expect("file");
    let ray = ["ray", "system.ron", "--from", "(0, 0, 9) mm", "--direction"];
    let cases: [(&[&str], i32); 26] = [
        (&["check", "system.ron"], 0),
        (&["run", "system.ron", "-o", "out"], 0),
        (&[&ray[..], &["(0, 0, -1)"]].concat(), 0),
        (&["schema"], 0),
        (&["--help"], 0),
        (&["--version"], 0),
        (&["run", "cut.ron", "-o", "cut"], 3),
        (&[], 64),
        (&["trace"], 64),
        (&["check"], 64),
        (&["run", "system.ron"], 64),
        (&["run", "system.ron", "-o", "out", "--threads", "0"], 64),
        (&["compare", "system.ron", "-o", "both"], 64),
        (&["compare", "levels.ron", "-o", "both"], 0),
        (&["run", "levels.ron", "-o", "low", "--variant", "level low"], 0),
        (&["sensitivity", "system.ron", "-o", "levers"], 0),
        (&["run", "system.ron", "-o", "out", "--rays", "1.5"], 64),
        (&["run", "system.ron", "-o", "out", "--until", "soon"], 64),
        (&["run", "system.ron", "-o", "out", "--until", "1 % on below"], 64),
        (&[&ray[..], &["up"]].concat(), 64),
        (&["check", "bad.ron"], 65),
        (&["check", "nothing.ron"], 66),
        (&["check", "."], 66),
        (&["run", "lost.ron", "-o", "out"], 66),
        (&["run", "system.ron", "-o", "system.ron"], 74),
        (&["run", "system.ron", "-o", "system.ron/out"], 74),
    ];
    for (arguments, wanted) in cases {
        let (code, output) = outcome(folder.path(), arguments);
        let said = text(&output.stderr);
        assert_eq!(code, wanted, "{arguments:?}: {said}");
        assert_eq!(said.is_empty(), [0, 3].contains(&wanted), "{arguments:?}: {said}");
        assert_eq!(said.matches("panicked").count(), 0);
    }
    for file in ["summary.json", "report.html", "paths.csv", "above.fits", "above.png", "above.npy"] {
        assert!(folder.path().join("out").join(file).is_file(), "{file}");
    }
    for file in ["compare.html", "compare.json", "compare.csv", "baseline/report.html", "level_high/above.fits"] {
        assert!(folder.path().join("both").join(file).is_file(), "{file}");
    }
    for file in ["sensitivity.json", "sensitivity.csv"] {
        assert!(folder.path().join("levers").join(file).is_file(), "{file}");
    }
}

#[test]
fn help_of_every_verb_ends_with_an_example() {
    let here = Path::new(".");
    for arguments in [
        &["--help"][..],
        &["run", "--help"],
        &["check", "--help"],
        &["ray", "--help"],
        &["schema", "--help"],
        &["compare", "--help"],
        &["sensitivity", "--help"],
    ] {
        let said = text(&outcome(here, arguments).1.stdout);
        assert!(said.contains("Example:\n  straylight "), "{arguments:?}: {said}");
        assert!(said.lines().all(|line| line.chars().count() <= 110), "{said}");
    }
}

#[test]
fn typical_slips_are_answered_in_one_line() {
    let cases = [
        ("\"glass\")", "\"glas\")", r#"system.ron:6:37: surfaces[0].medium: no medium "glas"; did you mean "glass"?"#),
        (
            "\"black\")",
            "\"blak\")",
            r#"system.ron:7:56: surfaces[1].scatter: no scatter model "blak"; did you mean "black"?"#,
        ),
        (
            "Node(\"block\")",
            "Node(\"blokc\")",
            "system.ron:6:14: surfaces[0].on: no node matches `blokc`; did you mean `block`? (and 1 more)",
        ),
        (
            "Node(\"table\")",
            "Tag(\"metal\")",
            "system.ron:7:14: surfaces[1].on: no tag matches `metal`; expected one of the tags `block`, `table` (and 1 more)",
        ),
        (
            "\"2 mm\"",
            "2",
            r#"system.ron:10:52: sources["beam"].extent.radius: `2` is a bare number; expected a length with its unit, such as "12.7 mm""#,
        ),
        (
            "\"1 W\"",
            "\"1 Watt\"",
            r#"system.ron:10:24: sources["beam"].flux: "1 Watt": no such unit here: "Watt"; one of W, mW, uW, nW, pW, kW; expected a flux with its unit, such as "1 W""#,
        ),
        (
            "reflectance: 0.05",
            "reflectance: 5",
            r#"system.ron:4:48: scatter["black"].reflectance: 5 is out of range; expected a number between 0 and 1"#,
        ),
        (
            "bricks.gltf",
            "brick.gltf",
            r#"system.ron:2:23: geometry[0].file: "brick.gltf" does not exist; files are relative to the system file"#,
        ),
        (
            "detectors:",
            "detector:",
            "system.ron:12:5: detector: a system has no section `detector`; did you mean `detectors`?",
        ),
        (
            "(on: Node(\"table\"), specular: Absorb, scatter: \"black\"),",
            "(on: Node(\"table\"), name: \"top\"),",
            r#"system.ron:5:15: surfaces: `table.top` (tag table) has no surface; expected an entry in `surfaces` that says `specular`, `coating` or `scatter` for it, or a `default`"#,
        ),
        (
            "specular: Absorb",
            "specular: Ideal(reflectance: 0.5, transmittance: 0.6)",
            r#"system.ron:7:39: surfaces[1].specular: reflectance + transmittance is 1.1: more light leaves than arrives; expected a sum of at most 1"#,
        ),
        ("run: (rays: 2_048),\n)", "run: (rays: 2_048),\n", "system.ron:1:7: this `(` is never closed"),
        (
            "medium: \"glass\"",
            "medium: \"glass\", gap: Vacuum",
            "system.ron:6:51: surfaces[0].gap: there is no `Vacuum` here; expected one of `Contact`, `Air`",
        ),
        (
            "Irradiance, pixels",
            "Iradiance, pixels",
            r#"system.ron:13:99: detectors["above"].quantity: there is no `Iradiance` here; expected one of `Irradiance`, `Intensity`; did you mean `Irradiance`?"#,
        ),
    ];
    let said: Vec<_> = cases.iter().map(|(old, new, _)| after(old, new).1).collect();
    let wanted: Vec<&str> = cases.iter().map(|case| case.2).collect();
    assert_eq!(said, wanted);
}

#[test]
fn what_contradicts_physics_is_refused() {
    let sum = "Sum([Lambertian(reflectance: 0.9), ABg(a: 0.5, b: 0.1, g: 1.5)])";
    let brighter = after("Lambertian(reflectance: 0.05)", sum);
    assert!(brighter.0 == 65 && brighter.1.contains("too much"), "{brighter:?}");
    let folder = folder(&resin().replace("550 nm", "800 nm"));
    let (code, output) = outcome(folder.path(), &["check", "system.ron"]);
    let said = text(&output.stderr);
    assert_eq!(code, 65);
    assert!(said.contains("the data of `resin` do not cover the light of `beam`: 800 nm to 800 nm"), "{said}");
    assert!(said.contains("wavelengths from 400 nm to 700 nm"), "{said}");
}

#[test]
fn doubts_are_warnings() {
    let cases = [
        ("file: \"bricks.gltf\"", "file: \"bricks.gltf\", unit: \"km\"", "m large: the unit may be wrong"),
        (
            "at: \"(0, 0, 90) mm\"",
            "at: \"(50, 50, -5) mm\"",
            "`beam` starts inside `table`, which is closed and opaque",
        ),
    ];
    for (old, new, wanted) in cases {
        let (code, said) = after(old, new);
        assert!(code == 0 && said.contains("warning: ") && said.contains(wanted), "{code} {said}");
    }
}

/// Two coatings declared on faces that lie on each other: which one acts would be chance.
#[test]
fn two_coatings_on_one_place_are_refused_unless_air_parts_them() {
    let bricks = [("block", [-0.01, -0.01, 0.0], [0.01, 0.01, 0.006]), ("table", [-0.1, -0.1, -0.01], [0.1, 0.1, 0.0])];
    let coated = GOOD
        .replace(r#"media: {"glass": Constant(n: 1.5)}"#, RESIN)
        .replace("medium: \"glass\"", "medium: \"glass\", specular: Ideal(reflectance: 0.01, transmittance: 0.99)")
        .replace(
            "specular: Absorb, scatter",
            "medium: \"resin\", specular: Ideal(reflectance: 0.5, transmittance: 0.5), scatter",
        );
    for (system, wanted) in [(coated.clone(), 65), (coated.replace("0.5)", "0.5), gap: Air"), 0)] {
        let folder = folder(&system);
        fs::write(folder.path().join("bricks.gltf"), bricks::gltf(&bricks)).expect("geometry");
        let (code, output) = outcome(folder.path(), &["check", "system.ron"]);
        let said = text(&output.stderr);
        assert_eq!(code, wanted, "{said}");
        assert_eq!(
            said.contains("`block` and `table` lie on each other with different coatings"),
            wanted == 65,
            "{said}"
        );
    }
}

#[test]
fn check_says_what_was_understood() {
    let (_, output) = outcome(folder(GOOD).path(), &["check", "system.ron"]);
    let said = text(&output.stdout);
    for wanted in [
        "bounding box  (-100, -100, -10) .. (100, 100, 6) mm, that is 200 x 200 x 16 mm",
        "triangles     24 in 2 nodes",
        "closed  glass   block",
        "Absorb + scatter black",
        // Fresnel at 45 deg, n = 1.5: (0.3034^2 + 0.0920^2) / 2.
        "specular R     0.04  0.05024",
        "a disc of radius 2 mm at (0, 0, 90) mm",
        "16 columns x 16 rows of 6250 x 6250 um",
        "no warnings",
    ] {
        assert!(said.contains(wanted), "{wanted}: {said}");
    }
}

/// The law behind the table: at each event the fractions add up, and the watt is accounted for.
#[test]
fn ray_tells_every_event_of_a_watt() {
    let arguments = ["ray", "system.ron", "--from", "(0, 0, 9) mm", "--direction", "(0, 0, -1)", "--splits", "9"];
    let (_, output) = outcome(folder(GOOD).path(), &arguments);
    let said = text(&output.stdout);
    let events: Vec<&str> = said.lines().filter(|line| line.contains(" > ")).collect();
    assert!(events.len() > 3, "{said}");
    let first: Vec<&str> = events[0].split_whitespace().collect();
    assert_eq!(first[..5], ["0", "-", "(0,", "0,", "6)"]);
    assert_eq!(first[5..15], ["block", "front", "vacuum", ">", "glass", "0", "1", "0.04", "0.96", "0"]);
    assert!(events[1].contains("T ") && events[1].contains("(0, 0, 1)") && said.contains("escapes"), "{said}");
}

/// A run that would take for ever.
fn endless(folder: &Path) -> Child {
    let arguments = ["run", "system.ron", "-o", "out", "--rays", "1e13", "--threads", "1"];
    program(folder, &arguments).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().expect("the program runs")
}

#[cfg(unix)]
fn signal(child: &Child, name: &str) {
    let status = Command::new("kill").args([name, &child.id().to_string()]).status();
    assert!(status.expect("kill runs").success());
}

/// Its exit code; fails the test if it does not end soon.
fn ended(child: &mut Child) -> Option<i32> {
    let start = Instant::now();
    while start.elapsed() < Duration::from_secs(40) {
        if let Some(status) = child.try_wait().expect("a child") {
            return status.code();
        }
        std::thread::sleep(Duration::from_millis(20));
    }
    child.kill().expect("a child");
    panic!("it did not end");
}

#[cfg(unix)]
#[test]
fn a_signal_writes_what_is_finished() {
    for (name, code) in [("-INT", 130), ("-TERM", 143)] {
        // Small batches, nothing to learn and no pilot: some are finished soon even on a busy machine.
        let folder = folder(&GOOD.replace("rays: 2_048", "rays: 2_048, batch: 16, paths: 0, importance: Off"));
        let mut child = endless(folder.path());
        std::thread::sleep(Duration::from_millis(2500));
        assert!(child.try_wait().expect("a child").is_none(), "too early");
        signal(&child, name);
        assert_eq!(ended(&mut child), Some(code));
        let summary = fs::read_to_string(folder.path().join("out/summary.json")).expect("summary");
        let summary: serde_json::Value = serde_json::from_str(&summary).expect("JSON");
        assert_eq!(summary["run"]["interrupted"], true);
        assert!(summary["results"]["rays"].as_u64().expect("rays") > 0);
    }
}

/// Light between two perfect mirrors never ends: no batch does, and only the second signal helps.
#[cfg(unix)]
#[test]
fn a_second_signal_ends_at_once() {
    let trap = GOOD
        .replace("medium: \"glass\"", "specular: Mirror(reflectance: 1)")
        .replace("specular: Absorb, scatter: \"black\"", "specular: Mirror(reflectance: 1)")
        .replace("at: \"(0, 0, 90) mm\"", "at: \"(0, 0, 0.5) mm\"")
        .replace("rays: 2_048", "rays: 2_048, max_events: 4_000_000_000");
    let folder = folder(&trap);
    let mut child = endless(folder.path());
    std::thread::sleep(Duration::from_millis(1500));
    signal(&child, "-INT");
    std::thread::sleep(Duration::from_millis(700));
    assert!(child.try_wait().expect("a child").is_none(), "the first signal waits for the batch");
    signal(&child, "-INT");
    let start = Instant::now();
    assert_eq!(ended(&mut child), Some(130));
    assert!(start.elapsed() < Duration::from_secs(5));
    assert!(!folder.path().join("out/summary.json").exists());
}

#[test]
fn a_closed_pipe_is_no_reason_to_panic() {
    let folder = folder(GOOD);
    for (arguments, code) in [
        (&["check", "system.ron"][..], 0),
        (&["schema"], 0),
        (&["--help"], 0),
        (&["run", "system.ron", "-o", "out"], 0),
        (&["check", "nothing.ron"], 66),
        (&["run"], 64),
    ] {
        let mut child =
            program(folder.path(), arguments).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().expect("runs");
        drop((child.stdout.take(), child.stderr.take()));
        assert_eq!(ended(&mut child), Some(code), "{arguments:?}");
    }
}

#[test]
fn messages_stay_bearable_whatever_they_quote() {
    let (code, output) = outcome(
        folder(&GOOD.replace("\"table\"", &format!("{:?}", "x".repeat(1 << 20)))).path(),
        &["check", "system.ron"],
    );
    let first = text(&output.stderr).lines().next().unwrap_or_default().len();
    assert!(code == 65 && first < 1500 && output.stderr.len() < 20_000, "{code} {first} {}", output.stderr.len());
}

/// A buffer beside the glTF is read; the same bytes one folder up are not, whatever leads there.
#[test]
fn nothing_outside_the_folder_is_opened() {
    let outside = folder(GOOD);
    let path = |name: &str| outside.path().join(name);
    let whole: serde_json::Value =
        serde_json::from_str(&fs::read_to_string(path("bricks.gltf")).expect("geometry")).expect("JSON");
    let uri = whole["buffers"][0]["uri"].as_str().expect("data").to_owned();
    let data = uri.split_once(',').expect("data").1;
    let bytes = base64::Engine::decode(&base64::engine::general_purpose::STANDARD, data).expect("base64");
    fs::create_dir(path("inside")).expect("folder");
    fs::write(path("bricks.bin"), &bytes).expect("bytes");
    fs::write(path("inside/bricks.bin"), &bytes).expect("bytes");
    fs::write(path("inside/system.ron"), GOOD).expect("system");
    let absolute = path("bricks.bin").display().to_string();
    for (uri, code) in [("bricks.bin", 0), ("../bricks.bin", 65), ("%2e%2e/bricks.bin", 65), (absolute.as_str(), 65)] {
        let mut document = whole.clone();
        document["buffers"][0]["uri"] = uri.into();
        fs::write(path("inside/bricks.gltf"), document.to_string()).expect("geometry");
        let (got, output) = outcome(&path("inside"), &["check", "system.ron"]);
        assert_eq!(got, code, "{uri}: {}", text(&output.stderr));
    }
}

#[test]
fn ghosts_are_listed_by_their_surfaces() {
    let folder = folder(GOOD);
    let (code, output) = outcome(folder.path(), &["ghosts", "system.ron", "-o", "out", "--order", "1"]);
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    assert_eq!(code, 0, "{text}{}", String::from_utf8_lossy(&output.stderr));
    assert!(text.contains("ghosts of up to 1 unintended reflections") && text.contains("report: out"), "{text}");
    let written = |name: &str| fs::read_to_string(folder.path().join("out").join(name)).expect(name);
    let row =
        written("ghosts.csv").lines().find(|row| row.starts_with("above,beam,1,block,")).expect("a row").to_owned();
    assert!(row.split(',').nth(4).and_then(|flux| flux.parse::<f64>().ok()).is_some_and(|flux| flux > 0.04), "{row}");
    assert!(written("ghosts.html").contains("lit by beam") && written("ghosts.json").contains("\"surfaces\""));
    assert!(folder.path().join("out/above_beam_block.npy").exists());
    assert_eq!(outcome(folder.path(), &["ghosts", "system.ron", "-o", "out", "--order", "7"]).0, 64);
}

#[test]
fn a_filter_of_the_command_line_is_counted_or_refused() {
    let folder = folder(GOOD);
    let (code, output) =
        outcome(folder.path(), &["run", "system.ron", "-o", "out", "--filter", "ghosts == 1 and block:R"]);
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    assert_eq!(code, 0, "{text}");
    assert!(text.contains("filter \"ghosts == 1 and block:R\": "), "{text}");
    let (code, output) = outcome(folder.path(), &["run", "system.ron", "-o", "out", "--filter", "blok:R"]);
    let told = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(code, 65);
    assert!(told.contains("no part is called \"blok\"; did you mean \"block\"?"), "{told}");
}

//! Coatings as a user meets them: files, `straylight coating`, and what is said of wrong ones.

use std::fs;
use std::path::Path;
use std::process::{Command, Output};
use tempfile::TempDir;

/// A window coated with "used" in a beam.
const SYSTEM: &str = r#"System(
    media: {"glass": Constant(n: 1.5168), "film": Constant(n: 1.38)},
    elements: {"window": (body: Plate(width: "20 mm", height: "20 mm", thickness: "3 mm", medium: "glass"))},
    coatings: {
        "used": Stack(design: "550 nm", layers: [("film", "1/4 wave")]),
        OTHERS
    },
    surfaces: [(on: Node("window"), coating: "used")],
    sources: {"beam": (flux: "1 W", extent: Disk(radius: "2 mm"), at: "(0, 0, -10) mm",
                       angular: Collimated(direction: "(0, 0, 1)"), spectrum: Line("550 nm"))},
    detectors: {"sky": (on: FarField(axis: "(0, 0, 1)"), quantity: Intensity)},
)
"#;

fn folder(others: &str) -> TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("system.ron"), SYSTEM.replace("OTHERS", others)).expect("written");
    for name in ["typed.dat", "splitter.csv"] {
        let from = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/films").join(name);
        fs::copy(from, folder.path().join(name)).expect("copied");
    }
    folder
}

fn coating(folder: &TempDir, arguments: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_straylight"));
    command.current_dir(folder.path()).args(["coating", "system.ron"]).args(arguments).output().expect("run")
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

/// The rows of the table that is printed: side, angle, R s, R p, R, T s, T p, T, A s, A p, A.
fn rows(output: &Output) -> Vec<Vec<String>> {
    assert!(output.status.success(), "{}", text(&output.stderr));
    let printed = text(&output.stdout);
    printed.lines().skip(2).map(|line| line.split_whitespace().map(str::to_owned).collect()).collect()
}

const FILES: &str = r#"
        "typed": Zemax(file: "typed.dat", coating: "ar", design: "550 nm"),
        "split": Zemax(file: "typed.dat", coating: "SPLIT"),
        "table": Table(file: "splitter.csv"),
"#;

#[test]
fn a_file_and_a_stack_of_the_same_layers_are_the_same() {
    let folder = folder(FILES);
    let own = rows(&coating(&folder, &["used"]));
    assert_eq!(own, rows(&coating(&folder, &["typed", "--between", "vacuum", "glass"])));
    // R of a quarter wave at normal incidence, from both sides: ((n - f^2) / (n + f^2))^2.
    let wanted = ((1.5168f64 - 1.38 * 1.38) / (1.5168 + 1.38 * 1.38)).powi(2);
    for row in own.iter().filter(|row| row[1] == "0") {
        let found: f64 = row[4].parse().expect("a number");
        assert!((found - wanted).abs() < 1e-6, "{row:?}");
        assert_eq!(row[10], "0");
    }
    assert_eq!(own.len(), 14);
}

#[test]
fn a_table_in_a_csv_file_and_in_a_coating_file_are_the_same() {
    let folder = folder(FILES);
    let found = rows(&coating(&folder, &["table", "--between", "vacuum", "glass"]));
    assert_eq!(found, rows(&coating(&folder, &["split", "--between", "vacuum", "glass"])));
    assert_eq!(found[3][1..5], ["45", "0.7", "0.7", "0.7"]);
}

#[test]
fn curves_and_numbers_are_written() {
    let folder = folder("");
    assert!(coating(&folder, &["used", "-o", "ar.png", "-o", "ar.csv"]).status.success());
    let png = fs::read(folder.path().join("ar.png")).expect("a picture");
    assert!(png.starts_with(b"\x89PNG"));
    let csv = fs::read_to_string(folder.path().join("ar.csv")).expect("numbers");
    let mut lines = csv.lines();
    assert_eq!(lines.next(), Some("side,wavelength_nm,angle_deg,rs,rp,ts,tp,as,ap"));
    for line in lines {
        let numbers: Vec<f64> = line.split(',').skip(1).map(|number| number.parse().expect("a number")).collect();
        assert!((numbers[2] + numbers[4] + numbers[6] - 1.0).abs() < 1e-12, "{line}");
    }
}

#[test]
fn what_is_wrong_is_told_with_its_place() {
    let fails = |others: &str, arguments: &[&str], code: i32, told: &str| {
        let output = coating(&folder(others), arguments);
        let errors = text(&output.stderr);
        assert_eq!(output.status.code(), Some(code), "{errors}");
        assert!(errors.contains(told), "{errors}");
    };
    fails("", &["usde"], 64, "did you mean \"used\"");
    fails("", &["used", "--between", "air", "glass"], 64, "no medium \"air\"");
    fails("", &["used", "-o", "ar.gif"], 64, ".png");
    fails("", &["used", "--angle", "90 deg"], 64, "below 90 deg");
    fails(r#""x": Zemax(file: "typed.dat", coating: "broken"),"#, &["used"], 65, "typed.dat:8:1");
    fails(r#""x": Zemax(file: "typed.dat", coating: "SECRET"),"#, &["used"], 65, "encrypted");
    fails(r#""x": Zemax(file: "typed.dat", coating: "AR"),"#, &["used"], 65, "design");
    fails(r#""x": Table(file: "system.ron"),"#, &["used"], 65, "system.ron:1");
    fails(r#""x": Table(file: "none.csv"),"#, &["used"], 66, "does not exist");
}

//! The library of finishes and the fits of tables, as a user meets them.

mod bricks;

use assert_cmd::Command;
use std::fs;
use std::path::{Path, PathBuf};
use straylight::bsdf::Side;
use straylight::bsdf::finish::{Finish, LIBRARY, find};
use straylight::bsdf::fit::{Law, Point, fit, points};
use straylight::bsdf::reading::{Unmeasured, parse};
use straylight::optics::Incidence;

/// A plate in a beam.
const PLATE: &str = r#"System(
    geometry: [(file: "bricks.gltf")],
    scatter: {"wall": FINISH},
    surfaces: [(on: Node("table"), specular: Absorb, scatter: "wall")],
    sources: {
        "beam": (flux: "1 W", extent: Disk(radius: "2 mm"), at: "(0, 0, 90) mm", angular: Collimated(direction: "(0, 0, -1)"), spectrum: Line("LINE")),
    },
    detectors: {
        "above": (on: Disk(at: "(0, 0, 80) mm", normal: "(0, 0, -1)", radius: "50 mm"), quantity: Irradiance, pixels: (16, 16)),
    },
    run: (rays: 4_096),
)
"#;

/// A folder with the plate of this finish, lit by this line.
fn plate(finish: &str, line: &str) -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("folder");
    let table = [("table", [-0.1, -0.1, -0.01], [0.1, 0.1, 0.0])];
    fs::write(folder.path().join("bricks.gltf"), bricks::gltf(&table)).expect("geometry");
    fs::write(folder.path().join("system.ron"), PLATE.replace("FINISH", finish).replace("LINE", line)).expect("system");
    folder
}

/// Exit code, standard output and standard error.
fn outcome(folder: &Path, arguments: &[&str]) -> (i32, String, String) {
    let mut command = Command::new(env!("CARGO_BIN_EXE_straylight"));
    let output = command.current_dir(folder).args(arguments).output().expect("the program runs");
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    (output.status.code().unwrap_or(-1), text(&output.stdout), text(&output.stderr))
}

fn data(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/bsdf").join(name)
}

#[test]
fn a_finish_is_used_and_what_it_rests_on_is_said() {
    let folder = plate("Finish(\"black anodize EC1\")", "650 nm");
    let (code, said, warned) = outcome(folder.path(), &["check", "system.ron"]);
    assert_eq!((code, warned.as_str()), (0, ""), "{said}");
    for word in ["black anodize EC1: measured at 650 nm", "UA-LOFT", "350 to 685 nm"] {
        assert!(said.contains(word), "{word}: {said}");
    }
    let (code, said, _) = outcome(folder.path(), &["run", "system.ron", "-o", "out"]);
    assert_eq!(code, 0);
    assert!(said.contains("finish: black anodize EC1: measured"), "{said}");
    for file in ["summary.json", "report.html"] {
        let text = fs::read_to_string(folder.path().join("out").join(file)).expect("a file");
        assert!(text.contains("black anodize EC1: measured"), "{file}");
    }
}

/// A black anodize is no longer black in the infrared: the entry made for that says so.
#[test]
fn light_outside_the_range_is_a_warning_with_what_is_known() {
    let folder = plate("Finish(\"black anodize EC1\")", "1064 nm");
    let (code, _, warned) = outcome(folder.path(), &["check", "system.ron"]);
    assert_eq!(code, 0);
    for word in ["warning", "scatter[\"wall\"]", "1064 nm", "350 to 685 nm", "0.686", "diffuse black anodize"] {
        assert!(warned.contains(word), "{word}: {warned}");
    }
    let folder = plate("Finish(\"diffuse black anodize\")", "1064 nm");
    let (_, said, warned) = outcome(folder.path(), &["check", "system.ron"]);
    assert_eq!(warned, "");
    assert!(said.contains("0.6861"), "{said}");
    let (_, _, warned) = outcome(plate("Finish(\"diffuse black anodize\")", "10 um").path(), &["check", "system.ron"]);
    assert!(warned.contains("350 to 2400 nm"), "{warned}");
}

#[test]
fn unknown_finishes_and_polish_without_a_coating_are_errors() {
    let (code, _, said) = outcome(plate("Finish(\"blck anodize EC1\")", "650 nm").path(), &["check", "system.ron"]);
    assert_eq!(code, 65);
    assert!(said.contains("did you mean \"black anodize EC1\"?") && said.contains("system.ron:3:"), "{said}");
    let (code, _, said) = outcome(plate("Finish(\"polished glass 1 nm\")", "650 nm").path(), &["check", "system.ron"]);
    assert_eq!(code, 65);
    assert!(said.contains("order: Scaled"), "{said}");
    let sum = "Sum([Finish(\"generic black paint\"), Finish(\"gold\")])";
    let (code, _, said) = outcome(plate(sum, "650 nm").path(), &["check", "system.ron"]);
    assert_eq!(code, 65);
    assert!(said.contains("scatter[\"wall\"][1]") && said.contains("generic black flock"), "{said}");
}

#[test]
fn the_library_is_listed() {
    let (code, said, _) = outcome(Path::new("."), &["finishes"]);
    assert_eq!(code, 0);
    assert!(LIBRARY.iter().all(|finish| said.contains(finish.name) && said.contains(finish.source)), "{said}");
}

/// The built-in tables are the ones that the tests know.
#[test]
fn the_tables_of_the_library_are_the_measured_ones() {
    let own = Path::new(env!("CARGO_MANIFEST_DIR")).join("src/bsdf/finish/ua-loft");
    for name in ["AnoBlackEC1onAlum", "AnoBlackEC2onAlum", "AnoBlackNiTEonINVAR", "AnoBlackNiTEonSteel"] {
        let file = format!("{name}.bsdf");
        assert_eq!(fs::read(own.join(&file)).expect("a table"), fs::read(data(&file)).expect("a table"), "{name}");
    }
}

fn measured(file: &str) -> Vec<Point> {
    let text = fs::read_to_string(data(file)).expect("a table");
    points(&parse(&text, Unmeasured::Zero).expect("a good table")[0], 1.0)
}

/// Another program's fits to each incidence of the same samples, from their FRED tables: ours must not be worse.
#[test]
fn each_incidence_is_fitted_as_well_as_by_another_program() {
    let rows = fs::read_to_string(data("abg_fits.csv")).expect("fits");
    for row in rows.lines().skip(1) {
        let cells: Vec<&str> = row.split(',').collect();
        let number = |at: usize| cells[at].parse::<f64>().expect("a number");
        let angle = number(1).to_radians();
        let own: Vec<Point> = measured(&format!("{}.txt", cells[0]))
            .into_iter()
            .filter(|point| (point.incidence - angle).abs() < 1e-6)
            .collect();
        let found = fit(&own, Law::Abg).expect("a fit");
        assert!(found.rms < 1.001 * number(7), "{row}: {found:?}");
    }
}

#[test]
fn a_fit_is_printed_drawn_and_can_be_pasted() {
    let folder = plate("FITTED", "650 nm");
    let table = data("AnoBlackEC1onAlum.bsdf").display().to_string();
    let arguments = ["fit-bsdf", &table, "--wavelength", "650 nm", "-o", "fit.png", "-o", "fit.csv"];
    let (code, said, warned) = outcome(folder.path(), &arguments);
    assert_eq!((code, warned.as_str()), (0, ""), "{said}");
    for word in
        ["10, 30, 50, 70 deg", "ABg + Lambertian", "Harvey-Shack", "K-correlation", "TIS stated", "Best: ", "dB"]
    {
        assert!(said.contains(word), "{word}: {said}");
    }
    let picture = fs::read(folder.path().join("fit.png")).expect("a picture");
    assert_eq!(&picture[1..4], b"PNG");
    let rows = fs::read_to_string(folder.path().join("fit.csv")).expect("numbers");
    assert_eq!(rows.lines().count(), 1 + measured("AnoBlackEC1onAlum.bsdf").len());
    let entry = said.lines().find_map(|line| line.trim().strip_prefix("to paste")).expect("an entry");
    let system = PLATE.replace("FINISH", entry.trim()).replace("LINE", "650 nm");
    fs::write(folder.path().join("system.ron"), system).expect("system");
    let (code, _, said) = outcome(folder.path(), &["check", "system.ron"]);
    assert_eq!(code, 0, "{entry}: {said}");
}

#[test]
fn bad_tables_are_refused() {
    let folder = tempfile::tempdir().expect("folder");
    fs::write(folder.path().join("noise.csv"), "a,b\n1,2\n").expect("file");
    fs::write(folder.path().join("few.csv"), "theta_i_deg,theta_s_deg,bsdf_per_sr\n0,0,1\n0,60,1\n").expect("file");
    let cases: [(&[&str], i32, &str); 5] = [
        (&["fit-bsdf", "gone.bsdf"], 66, "gone.bsdf"),
        (&["fit-bsdf", "noise.csv"], 65, "noise.csv:1"),
        (&["fit-bsdf", "few.csv"], 65, "five or more"),
        (&["fit-bsdf", "few.csv", "-o", "fit.txt"], 64, ".png or .csv"),
        (&["fit-bsdf", "few.csv", "--wavelength", "red"], 64, "red"),
    ];
    for (arguments, wanted, word) in cases {
        let (code, _, said) = outcome(folder.path(), arguments);
        assert_eq!(code, wanted, "{arguments:?}: {said}");
        assert!(said.contains(word) && !said.contains("panicked"), "{arguments:?}: {said}");
    }
}

/// The fitted entries of the library are what `fit-bsdf` finds through its tables, and as far from them as they say.
#[test]
fn the_fits_of_the_library_are_those_of_its_tables() {
    let pairs = [
        ("AnoBlackEC1onAlum.bsdf", "black anodize EC1 fit"),
        ("AnoBlackEC2onAlum.bsdf", "black anodize EC2 fit"),
        ("AnoBlackNiTEonINVAR.bsdf", "black NiTE on Invar fit"),
        ("AnoBlackNiTEonSteel.bsdf", "black NiTE on steel fit"),
    ];
    for (file, name) in pairs {
        let found = fit(&measured(file), Law::Abg).expect("a fit");
        let lobes = find(name).and_then(Finish::lobes).expect("an entry");
        for (theta, tis) in [0.2, 0.9, 1.2].into_iter().zip(found.tis(&[0.2, 0.9, 1.2], Side::Reflect)) {
            let own: f64 = lobes.iter().map(|lobe| lobe.albedo(&Incidence::in_air(theta, 650e-9))).sum();
            assert!((own / tis - 1.0).abs() < 1e-3, "{name} at {theta}: {own} for {tis}, {found:?}");
        }
        let decibels = 10.0 / std::f64::consts::LN_10;
        assert!(decibels * found.rms < 3.0 && decibels * found.largest.0 < 12.0, "{name}: {found:?}");
    }
}

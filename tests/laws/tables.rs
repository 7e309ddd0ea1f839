//! Measured tables in files of several formats.

use crate::measured::zemax;
use glam::DVec3;
use straylight::bsdf::reading::{Unmeasured, parse};
use straylight::bsdf::{Bsdf, Tabulated};
use straylight::optics::Incidence;

fn text(name: &str) -> String {
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/bsdf").join(name);
    std::fs::read_to_string(path).expect("it lies in the repository")
}

fn model(name: &str, unmeasured: Unmeasured) -> Tabulated {
    Tabulated::new(parse(&text(name), unmeasured).expect("a good table").remove(0), 1.0).expect("below 100 %")
}

fn at(degrees: f64) -> Incidence {
    Incidence::in_air(f64::to_radians(degrees), 650e-9)
}

/// Published with the tables: TIS in percent at 10, 30, 50 and 70 deg.
#[test]
fn measured_anodizes_scatter_what_their_files_say() {
    for (name, published) in [
        ("AnoBlackEC1onAlum", [3.9, 3.9, 4.8, 10.7]),
        ("AnoBlackEC2onAlum", [4.0, 4.0, 4.7, 7.8]),
        ("AnoBlackNiTEonINVAR", [4.4, 4.6, 5.9, 11.7]),
        ("AnoBlackNiTEonSteel", [4.7, 4.8, 6.4, 13.1]),
    ] {
        let table = model(&format!("{name}.bsdf"), Unmeasured::Zero);
        for (angle, percent) in [10.0, 30.0, 50.0, 70.0].into_iter().zip(published) {
            let found = 100.0 * table.albedo(&at(angle));
            assert!((found / percent - 1.0).abs() < 0.02, "{name} at {angle} deg: {found} %");
        }
    }
}

/// Both formats hold the same measurement, on different grids.
#[test]
fn two_formats_of_one_measurement_agree() {
    let [zemax, fred, full] = ["AnoBlackEC1onAlum.bsdf", "AnoBlackEC1onAlum.txt", "AnoBlackEC1onAlum_fullAz.txt"]
        .map(|name| model(name, Unmeasured::Zero));
    for incidence in [10.0, 30.0, 50.0] {
        let incident = at(incidence);
        // Where both have entries: not beyond 80 deg, not straight back. Zemax's values are scaled to the stated TIS.
        let scale = |model: &Tabulated| model.eval(&incident, specular(incidence));
        for (theta, phi) in [(0.0, 0.0), (20.0, 40.0), (30.0, 90.0), (40.0, 20.0), (40.0, 120.0)] {
            let (t, p) = (f64::to_radians(theta), f64::to_radians(phi));
            // Local axes: the light comes from +x, so the specular side is -x.
            let wo = DVec3::new(-t.sin() * p.cos(), t.sin() * p.sin(), t.cos());
            let [a, b] = [&zemax, &fred].map(|model| model.eval(&incident, wo) / scale(model));
            assert!((a / b - 1.0).abs() < 0.12, "{incidence}: {theta}, {phi}: {a} {b}");
            let c = full.eval(&incident, wo) / scale(&full);
            assert!((c / b - 1.0).abs() < 1e-6, "{incidence}: {theta}, {phi}: {c} {b}");
        }
    }
}

fn specular(degrees: f64) -> DVec3 {
    let (sin, cos) = f64::to_radians(degrees).sin_cos();
    DVec3::new(-sin, 0.0, cos)
}

#[test]
fn what_was_not_measured_is_dark_or_held() {
    let [zero, hold] = [Unmeasured::Zero, Unmeasured::Hold].map(|rule| model("AnoBlackEC1onAlum.bsdf", rule));
    let grazing = DVec3::new(-(85f64.to_radians().sin()), 0.0, 85f64.to_radians().cos());
    let [dark, lit] = [&zero, &hold].map(|model| model.eval(&at(50.0), grazing));
    // Half way from the last measured angle, 80 deg, to the first that was not.
    assert!(dark < 0.6 * lit, "{dark} {lit}");
    assert!(hold.albedo(&at(50.0)) > 1.02 * zero.albedo(&at(50.0)));
}

/// The same table as BTDF: the mirror image, and all of it passes.
#[test]
fn a_transmitted_table_is_the_mirror_image() {
    let reflected = zemax();
    let passed = parse(&text("AnoBlackEC1onAlum.bsdf").replace("BRDF", "BTDF"), Unmeasured::Zero)
        .expect("a good table")
        .remove(0);
    let passed = Tabulated::new(passed, 1.0).expect("below 100 %");
    assert!(passed.transmits() && !reflected.transmits());
    let wo = DVec3::new(0.3, 0.2, (1.0f64 - 0.13).sqrt());
    assert_eq!(passed.eval(&at(30.0), wo), 0.0);
    assert_eq!(passed.eval(&at(30.0), wo * DVec3::new(1.0, 1.0, -1.0)), reflected.eval(&at(30.0), wo));
}

/// What cannot be told apart by its first lines is refused with what would be known.
#[test]
fn unknown_files_are_refused() {
    for bad in ["", "hello\n", "\u{0}\u{1}", "theta,value\n1,2\n", "OPTIS", "type bsdf_data", "ScatterAzimuth 1"] {
        assert!(parse(bad, Unmeasured::Zero).is_err(), "{bad:?}");
    }
}

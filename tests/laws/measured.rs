//! Tables of scatter in every format, isotropic and not.

use crate::family::Member;
use crate::polar::Pole;
use std::f64::consts::PI;
use std::fmt::Write;
use straylight::bsdf::klems::{Face, Matrix, Way};
use straylight::bsdf::reading::{Unmeasured, parse};
use straylight::bsdf::tabulated::Table;
use straylight::bsdf::{Anisotropic, Bsdf, Klems, Tabulated, klems_xml};
use straylight::math::Rng;

const SCREEN: &str = include_str!("../data/bsdf/klems/ec60.xml");

/// The albedo of a table is exact to rounding.
pub const EXACT: f64 = 1e-11;

/// All of them.
pub fn tables() -> Vec<Member> {
    let table = |name, model: Box<dyn Bsdf>| Member {
        name,
        model,
        pole: Pole::Grid,
        slack: EXACT,
        kinks: 0.0,
        media: vec![[1.0, 1.0]],
    };
    let mut all = vec![
        table("table, speos", Box::new(anodize())),
        table("table, zemax", Box::new(zemax())),
        table("table, fred", isotropic(include_str!("../data/bsdf/AnoBlackEC1onAlum.txt"))),
        table("table, csv", isotropic(&csv())),
        table("table, zemax, anisotropic", turning(rotated(&[0.0, 60.0, 110.0], [1.0, 3.0, 0.5]))),
        table("table, speos, anisotropic", turning(read(&brushed()))),
    ];
    all.extend(sheets().into_iter().map(|(name, model)| table(name, model)));
    all
}

/// Klems sheets, with their axes along the lay.
pub fn sheets() -> Vec<(&'static str, Box<dyn Bsdf>)> {
    let [front, back] = [Face::Front, Face::Back]
        .map(|face| screen().into_iter().find(|matrix| matrix.face == face).expect("it has both"));
    vec![
        ("screen, front", Box::new(Klems::new(front, 1.0))),
        ("screen, back", Box::new(Klems::new(back, 0.5))),
        ("motley", Box::new(Klems::new(motley(Way::Reflection), 1.0))),
        ("motley, transmitted", Box::new(Klems::new(motley(Way::Transmission), 1.0))),
    ]
}

pub fn screen() -> Vec<Matrix> {
    klems_xml::parse(SCREEN, "Visible").expect("a good file")
}

/// A sheet whose every entry is another number, for light on the front.
fn motley(way: Way) -> Matrix {
    let Matrix { incident, outgoing, value, .. } = screen().remove(0);
    let mut rng = Rng::new(5, way as u64, 0);
    let value = value.iter().map(|_| 0.9 / PI * rng.uniform().powi(3)).collect();
    Matrix { face: Face::Front, way, incident, outgoing, value }
}

fn read(text: &str) -> Vec<Table> {
    parse(text, Unmeasured::Zero).expect("a good table")
}

fn isotropic(text: &str) -> Box<dyn Bsdf> {
    Box::new(Tabulated::new(read(text).remove(0), 1.0).expect("below 100 %"))
}

fn turning(tables: Vec<Table>) -> Box<dyn Bsdf> {
    Box::new(Anisotropic::new(tables, 1.0).expect("below 100 %"))
}

/// The plausible wall of the triplet.
pub fn anodize() -> Tabulated {
    let text = include_str!("../../systems/triplet/black-anodize-plausible.anisotropicbsdf");
    Tabulated::new(read(text).remove(0), 1.0).expect("below 100 %")
}

/// A measured anodize whose table counts angles from the specular ray.
pub fn zemax() -> Tabulated {
    let text = include_str!("../data/bsdf/AnoBlackEC1onAlum.bsdf");
    Tabulated::new(read(text).remove(0), 1.0).expect("below 100 %")
}

/// A measured table as if it had been measured at these rotations (deg), with these factors.
pub fn rotated<const N: usize>(rotations: &[f64; N], factors: [f64; N]) -> Vec<Table> {
    let text = include_str!("../data/bsdf/AnoBlackEC1onAlum.bsdf");
    let (head, data) = text.split_once("DataBegin").expect("a table");
    let line = head.lines().position(|line| line.starts_with("SampleRotation")).expect("one rotation");
    let list: Vec<String> = rotations.iter().map(f64::to_string).collect();
    let mut lines: Vec<String> = head.lines().map(str::to_owned).collect();
    lines.splice(line..line + 2, [format!("SampleRotation {N}"), list.join(" ")]);
    let data = data.split("DataEnd").next().expect("its end");
    let scaled = |factor: f64| {
        let row = |line: &str| match line.trim().strip_prefix("TIS").and_then(|tis| tis.trim().parse::<f64>().ok()) {
            Some(tis) => format!("TIS {}\n", factor * tis),
            None => format!("{line}\n"),
        };
        data.lines().map(row).collect::<String>()
    };
    let body: String = factors.into_iter().map(scaled).collect();
    read(&format!("{}\nDataBegin\n{body}DataEnd\n", lines.join("\n")))
}

/// A lobe about the specular ray, `along` wide in the plane of incidence and `across` wide out of it, 1/sr; angles in deg.
fn lobe([incidence, theta, phi]: [f64; 3], [along, across]: [f64; 2]) -> f64 {
    let [incidence, theta, phi] = [incidence, theta, phi].map(f64::to_radians);
    let (x, y) = (theta.sin() * phi.cos() - incidence.sin(), theta.sin() * phi.sin());
    0.02 + 0.3 * (-(x / along).powi(2) - (y / across).powi(2)).exp()
}

/// A table of three incidences as CSV.
fn csv() -> String {
    let mut text = String::from("theta_i_deg,theta_s_deg,phi_deg,bsdf_per_sr\n");
    for incidence in [0.0, 40.0, 75.0] {
        // One row for the normal, where all azimuths are one direction.
        let rows = (1..=18).flat_map(|i| (0..=12).map(move |j| (i, j)));
        for (i, j) in [(0, 0)].into_iter().chain(rows) {
            let (theta, phi) = (5.0 * f64::from(i), 15.0 * f64::from(j));
            let value = lobe([incidence, theta, phi], [0.3, 0.2]);
            writeln!(text, "{incidence},{theta},{phi},{value}").expect("text has room");
        }
    }
    text
}

/// A brushed surface as Speos writes it: wide across the grooves, narrow along them.
fn brushed() -> String {
    let widths = [[0.15, 0.6], [0.6, 0.15]];
    let mut text =
        String::from("OPTIS - Anisotropic BSDF surface file v8.0\n0\nComment\n4\nDesc\n0 1 0\n1 0\n1\n2\n0 90\n");
    text += "3\n0 30 60\n3\n0 30 60\n0 0\n\n1\n550 30\n";
    for width in widths {
        for incidence in [0.0, 30.0, 60.0] {
            let phi = |j: u32| 10.0 * f64::from(j);
            let azimuths: Vec<String> = (0..=36).map(|j| phi(j).to_string()).collect();
            writeln!(text, "31 37\n{}", azimuths.join(" ")).expect("text has room");
            for theta in (0..=30).map(|i| 3.0 * f64::from(i)) {
                let row = (0..=36).map(|j| lobe([incidence, theta, phi(j)], width).to_string());
                writeln!(text, "{theta} {}", row.collect::<Vec<_>>().join(" ")).expect("text has room");
            }
        }
    }
    text + "End of file\n"
}

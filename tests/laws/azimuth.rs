//! Scatter that depends on the azimuth of the sample.

use crate::measured::{rotated, screen, sheets};
use crate::polar::small_cells;
use glam::{DVec2, DVec3};
use std::f64::consts::{PI, TAU};
use straylight::bsdf::klems::Face;
use straylight::bsdf::{Anisotropic, Bsdf, Klems, Tabulated};
use straylight::math::Rng;
use straylight::optics::Incidence;

fn family() -> Vec<(&'static str, Box<dyn Bsdf>)> {
    let table = Anisotropic::new(rotated(&[0.0, 60.0, 110.0], [1.0, 3.0, 0.5]), 1.0).expect("below 100 %");
    let mut all = sheets();
    all.push(("table", Box::new(table)));
    all
}

/// Several angles and azimuths; azimuths are multiples of 0.75 deg, so that edges of patches are edges of small cells.
fn incidences() -> Vec<Incidence> {
    let at = |theta: f64, azimuth: f64| Incidence {
        lay: DVec2::from_angle(-azimuth.to_radians()),
        ..Incidence::in_air(theta.to_radians(), 550e-9)
    };
    [2.0, 33.0, 66.5, 86.0].into_iter().flat_map(|theta| [0.0, 33.0, 97.5, 200.25].map(|phi| at(theta, phi))).collect()
}

/// Hands the middles of small cells on the side of the model, and the integrals of `g` dw over them, to `sum`.
fn cells((name, model): (&str, &dyn Bsdf), g: &dyn Fn(DVec3) -> f64, mut sum: impl FnMut(DVec3, f64)) {
    let side = |wo: DVec3| if model.transmits() { DVec3::new(wo.x, wo.y, -wo.z) } else { wo };
    // 0.75 deg are a part of every Klems sector, 1.25 deg of a table's.
    let sectors = if name == "table" { 288 } else { 480 };
    small_cells([180, sectors], &|wo| g(side(wo)), |wo, part| sum(side(wo), part));
}

#[test]
fn the_albedo_is_the_integral_and_every_draw_carries_it() {
    for (name, model) in family() {
        for at in &incidences() {
            let (albedo, mut total) = (model.albedo(at), 0.0);
            cells((name, &*model), &|wo| model.eval(at, wo) * wo.z.abs(), |_, part| total += part);
            assert!((total / albedo - 1.0).abs() < 1e-9, "{name}: {total} {albedo}");
            let mut rng = Rng::new(3, 1, 4);
            for _ in 0..2000 {
                let wo = model.sample(at, &mut rng).expect("it scatters");
                let weight = model.eval(at, wo) * wo.z.abs() / model.pdf(at, wo);
                assert!((weight / albedo - 1.0).abs() < 1e-9 && (wo.length() - 1.0).abs() < 1e-12, "{name}: {weight}");
            }
        }
    }
}

/// Turning the light, the lay and the scattered direction together changes nothing.
#[test]
fn only_the_azimuth_from_the_lay_counts() {
    for (name, model) in family() {
        for at in &incidences() {
            let turn = DVec2::from_angle(1.234);
            let turned = |d: DVec3| turn.rotate(d.truncate()).extend(d.z);
            let other = Incidence { wi: turned(at.wi), lay: turn.rotate(at.lay), ..*at };
            let mut rng = Rng::new(6, 6, 6);
            for _ in 0..100 {
                let wo = model.sample(at, &mut rng).expect("it scatters");
                let [a, b] = [model.eval(at, wo), model.eval(&other, turned(wo))];
                assert!((a / b - 1.0).abs() < 1e-9, "{name}: {a} {b}");
            }
        }
    }
}

/// Rings of the full Klems basis: upper angle, deg, and number of sectors.
const FULL: [(f64, usize); 9] =
    [(5.0, 1), (15.0, 8), (25.0, 16), (35.0, 20), (45.0, 24), (55.0, 24), (65.0, 24), (75.0, 16), (90.0, 12)];

/// Numbers of the first matrix of the file, read without its reader.
fn numbers() -> Vec<f64> {
    let inside = include_str!("../data/bsdf/klems/ec60.xml")
        .split("<ScatteringData>")
        .nth(1)
        .and_then(|rest| rest.split('<').next())
        .expect("a matrix");
    inside.split_whitespace().map(|word| word.parse().expect("a number")).collect()
}

#[test]
fn a_klems_sheet_passes_what_its_matrix_sums_to() {
    let matrix = numbers();
    let front = screen().into_iter().find(|matrix| matrix.face == Face::Front).expect("it has a front");
    let model = Klems::new(front, 1.0);
    let (mut from, mut patch, mut areas) = (0.0f64, 0, Vec::new());
    for (to, sectors) in FULL {
        let square = |angle: f64| angle.to_radians().sin().powi(2);
        areas.extend(vec![PI * (square(to) - square(from)) / sectors as f64; sectors]);
        from = to;
    }
    from = 0.0;
    for (to, sectors) in FULL {
        for k in 0..sectors {
            // Azimuths on the front are seen mirrored; light travels away from where it comes from.
            let travel = -TAU * k as f64 / sectors as f64;
            let theta = (0.5 * (from + to)).to_radians();
            let at = Incidence { lay: DVec2::from_angle(PI - travel), ..Incidence::in_air(theta, 550e-9) };
            let wanted: f64 = areas.iter().enumerate().map(|(o, area)| matrix[o * areas.len() + patch] * area).sum();
            assert!((model.albedo(&at) / wanted - 1.0).abs() < 1e-12, "patch {patch}: {wanted}");
            patch += 1;
        }
        from = to;
    }
}

/// Most of the light that passes a screen goes straight on, from whatever direction and on whatever face it comes.
#[test]
fn a_screen_is_brightest_straight_on() {
    for (name, model) in family().into_iter().filter(|(name, _)| name.starts_with("screen")) {
        for at in &incidences() {
            let on = model.eval(at, -at.wi);
            let mut rng = Rng::new(1, 7, 0);
            for _ in 0..1000 {
                let wo = model.sample(at, &mut rng).expect("it passes light");
                assert!(model.eval(at, wo) <= on, "{name}: {wo} of {}", at.wi);
            }
        }
    }
}

#[test]
fn an_isotropic_table_at_several_azimuths_is_the_isotropic_table() {
    for rotations in [&[0.0, 90.0], &[30.0, 250.0]] {
        let tables = rotated(rotations, [1.0; 2]);
        // Both on the grid of one among two.
        let alone = Tabulated::among(2, tables[0].clone(), 1.0).expect("below 100 %");
        let model = Anisotropic::new(tables, 1.0).expect("below 100 %");
        for at in &incidences() {
            assert!((model.albedo(at) / alone.albedo(at) - 1.0).abs() < 1e-12);
            let mut rng = Rng::new(2, 3, 4);
            for _ in 0..100 {
                let wo = model.sample(at, &mut rng).expect("it scatters");
                assert!((model.eval(at, wo) / alone.eval(at, wo) - 1.0).abs() < 1e-12);
                assert!((model.pdf(at, wo) / alone.pdf(at, wo) - 1.0).abs() < 1e-12);
            }
        }
    }
}

/// Light that travels at an azimuth (deg) from the lay.
fn travelling(azimuth: f64) -> Incidence {
    let lay = DVec2::from_angle(PI - azimuth.to_radians());
    Incidence { lay, ..Incidence::in_air(0.7, 550e-9) }
}

#[test]
fn tables_count_straight_between_azimuths_and_around() {
    let albedo = |rotations: [f64; 3], azimuth: f64| {
        let model = Anisotropic::new(rotated(&rotations, [1.0, 3.0, 0.5]), 1.0).expect("below 100 %");
        model.albedo(&travelling(azimuth)) / rotated_alone()
    };
    // Rotations up to 180 deg: the same again from the other side.
    for (azimuth, wanted) in
        [(0.0, 1.0), (30.0, 2.0), (85.0, 1.75), (145.0, 0.75), (180.0, 1.0), (210.0, 2.0), (-35.0, 0.75)]
    {
        let found = albedo([0.0, 60.0, 110.0], azimuth);
        assert!((found / wanted - 1.0).abs() < 1e-9, "{azimuth}: {found}");
    }
    for (azimuth, wanted) in [(20.0, 1.0), (140.0, 2.0), (280.0, 1.75), (-30.0, 0.6875), (10.0, 0.9375)] {
        let found = albedo([20.0, 260.0, 300.0], azimuth);
        assert!((found / wanted - 1.0).abs() < 1e-9, "{azimuth}: {found}");
    }
}

/// Albedo of the table as it was measured.
fn rotated_alone() -> f64 {
    Anisotropic::new(rotated(&[0.0], [1.0]), 1.0).expect("below 100 %").albedo(&travelling(0.0))
}

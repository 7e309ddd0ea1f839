//! Scatter that depends on the azimuth of the sample.

use crate::samplers::{chi_squared, small_cells};
use glam::{DVec2, DVec3};
use std::f64::consts::{PI, TAU};
use straylight::bsdf::klems::{Face, Matrix, Way};
use straylight::bsdf::{Bsdf, Klems, klems_xml};
use straylight::math::Rng;
use straylight::optics::Incidence;

const SCREEN: &str = include_str!("../data/bsdf/klems/ec60.xml");

fn screen() -> Vec<Matrix> {
    klems_xml::parse(SCREEN, "Visible").expect("a good file")
}

/// A sheet whose every entry is another number, for light on the front.
fn motley(way: Way) -> Matrix {
    let Matrix { incident, outgoing, value, .. } = screen().remove(0);
    let mut rng = Rng::new(5, way as u64, 0);
    let value = value.iter().map(|_| 0.9 / PI * rng.uniform().powi(3)).collect();
    Matrix { face: Face::Front, way, incident, outgoing, value }
}

fn family() -> Vec<(&'static str, Box<dyn Bsdf>)> {
    let [front, back] = [Face::Front, Face::Back]
        .map(|face| screen().into_iter().find(|matrix| matrix.face == face).expect("it has both"));
    vec![
        ("screen, front", Box::new(Klems::new(front, 1.0))),
        ("screen, back", Box::new(Klems::new(back, 0.5))),
        ("motley", Box::new(Klems::new(motley(Way::Reflection), 1.0))),
        ("motley, transmitted", Box::new(Klems::new(motley(Way::Transmission), 1.0))),
    ]
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
fn cells(model: &dyn Bsdf, g: &dyn Fn(DVec3) -> f64, mut sum: impl FnMut(DVec3, f64)) {
    let side = |wo: DVec3| if model.transmits() { DVec3::new(wo.x, wo.y, -wo.z) } else { wo };
    small_cells([180, 1440], &|wo| g(side(wo)), |wo, part| sum(side(wo), part));
}

fn bin(wo: DVec3) -> usize {
    let turn = (wo.y.atan2(wo.x) / TAU).rem_euclid(1.0);
    let ring = (wo.truncate().length().atan2(wo.z.abs()).to_degrees() / 1.5) as usize;
    ring.min(59) * 48 + ((turn * 48.0) as usize).min(47)
}

#[test]
fn every_sampler_draws_its_density_at_every_azimuth() {
    for (name, model) in family() {
        for (k, at) in incidences().iter().enumerate() {
            let mut expected = vec![0.0; 60 * 48];
            cells(&*model, &|wo| model.pdf(at, wo), |wo, p| expected[bin(wo)] += p);
            assert!((expected.iter().sum::<f64>() - 1.0).abs() < 1e-9, "{name}, {k}");
            let mut rng = Rng::new(21, k as u64, 0);
            let p = chi_squared(200_000, &expected, || model.sample(at, &mut rng).map(bin));
            assert!(p > 1e-4 && p < 1.0 - 1e-4, "{name}, incidence {k}: {p}");
        }
    }
}

#[test]
fn the_albedo_is_the_integral_and_every_draw_carries_it() {
    for (name, model) in family() {
        for at in &incidences() {
            let (albedo, mut total) = (model.albedo(at), 0.0);
            cells(&*model, &|wo| model.eval(at, wo) * wo.z.abs(), |_, part| total += part);
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
    let inside = SCREEN.split("<ScatteringData>").nth(1).and_then(|rest| rest.split('<').next()).expect("a matrix");
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

//! STA-02: every source pattern is drawn as it is written. (Scatter models: `tests/laws/samplers.rs`.)
//!
//! Each pattern has two quantities that must be independent and uniform; 10 x 10 cells, chi-squared with 99 degrees of
//! freedom, 20 seeds.

use glam::{DVec2, DVec3};
use std::f64::consts::{FRAC_PI_2, PI, TAU};
use straylight::geometry::Frame;
use straylight::math::Rng;
use straylight::math::statistics::{chi_squared_tail, uniformity};
use straylight::source::angular::Pattern;
use straylight::source::extent::{Mesh, Outline};
use straylight::source::{Angular, Extent, Spectrum};

const CELLS: usize = 10;
const DRAWS: usize = 100_000;
const SEEDS: u64 = 20;

fn turn(x: f64, y: f64) -> f64 {
    (y.atan2(x) / TAU).rem_euclid(1.0)
}

fn p_value(draw: &dyn Fn([f64; 2]) -> [f64; 2], seed: u64) -> f64 {
    let mut counts = [[0u32; CELLS]; CELLS];
    let mut rng = Rng::new(seed, 0, 0);
    for _ in 0..DRAWS {
        let cell = draw(rng.pair()).map(|q| {
            assert!((-1e-9..=1.0 + 1e-9).contains(&q), "{q} outside of 0..1");
            ((q.max(0.0) * CELLS as f64) as usize).min(CELLS - 1)
        });
        counts[cell[0]][cell[1]] += 1;
    }
    let expected = (DRAWS / (CELLS * CELLS)) as f64;
    let chi: f64 = counts.iter().flatten().map(|&n| (n as f64 - expected).powi(2) / expected).sum();
    chi_squared_tail(chi, (CELLS * CELLS - 1) as f64)
}

/// p-values as the case wants them: none below 1e-5, and together uniform.
fn judge(name: &str, draw: &dyn Fn([f64; 2]) -> [f64; 2]) {
    let values: Vec<f64> = (0..SEEDS).map(|seed| p_value(draw, seed + 1)).collect();
    let together = uniformity(&values);
    println!("STA-02 {name}: least p {:.2e}, together {together:.3}", values.iter().copied().fold(1.0, f64::min));
    assert!(values.iter().all(|&p| p > 1e-5), "{name}: {values:?}");
    assert!(together > 1e-3, "{name}: {values:?}");
}

#[test]
fn sta_02_directions_are_drawn_as_their_pattern_says() {
    let draw = |pattern: Pattern, uniform: fn(DVec3, f64) -> f64, half: f64| {
        let angular = Angular { axis: None, pattern };
        move |u: [f64; 2]| {
            let d = angular.direction(u);
            [uniform(d, half), turn(d.x, d.y)]
        }
    };
    let cone = |half_angle: f64| draw(Pattern::Cone { half_angle }, |d, h| (1.0 - d.z) / (1.0 - h.cos()), half_angle);
    judge("isotropic", &cone(PI));
    judge("cone", &cone(0.3));
    let even = |half_angle: f64| {
        let uniform = |d: DVec3, h: f64| (d.x * d.x + d.y * d.y) / h.sin().powi(2);
        draw(Pattern::Radiance { half_angle }, uniform, half_angle)
    };
    judge("Lambertian", &even(FRAC_PI_2));
    judge("sun", &even(0.00465));
    let gauss = |d: DVec3, h: f64| -(-2.0 * (d.x * d.x + d.y * d.y) / (d.z * h.tan()).powi(2)).exp_m1();
    judge("Gaussian beam", &draw(Pattern::Gaussian { half_angle: 0.2 }, gauss, 0.2));
}

#[test]
fn sta_02_places_are_drawn_as_their_outline_says() {
    let draw = |outline: Outline, uniform: fn(DVec2) -> [f64; 2]| {
        let extent = Extent::Flat { frame: Frame::from_z(DVec3::Z), at: DVec3::ZERO, outline };
        move |u: [f64; 2]| {
            let spot = extent.spot(u);
            uniform(DVec2::new(spot.frame.x.dot(spot.point), spot.frame.y.dot(spot.point)))
        }
    };
    judge("disc", &draw(Outline::Disk { radius: 2.0 }, |p| [p.length_squared() / 4.0, turn(p.x, p.y)]));
    let ring = Outline::Annulus { inner: 1.0, outer: 3.0 };
    judge("annulus", &draw(ring, |p| [(p.length_squared() - 1.0) / 8.0, turn(p.x, p.y)]));
    let rectangle = Outline::Rectangle { width: 2.0, height: 0.5 };
    judge("rectangle", &draw(rectangle, |p| [0.5 * p.x + 0.5, 2.0 * p.y + 0.5]));
    let gaussian = |p: DVec2| [-(-2.0 * p.length_squared() / 9.0).exp_m1(), turn(p.x, p.y)];
    judge("Gaussian", &draw(Outline::Gaussian { waist: 3.0 }, gaussian));
    // Scaled so that the chord is at 1: the wedge's own triangle is uniform in depth squared and along the chord.
    let polygon = |p: DVec2| {
        let wedge = turn(p.x, p.y) * 5.0;
        let middle = DVec2::from_angle(TAU * (wedge.floor() + 0.5) / 5.0);
        let (depth, side) = (p.dot(middle) / (PI / 5.0).cos(), p.perp_dot(middle) / p.dot(middle));
        [depth * depth, (wedge.floor() + 0.5 - 0.5 * side / (PI / 5.0).tan()) / 5.0]
    };
    judge("polygon", &draw(Outline::Polygon { radius: 1.0, sides: 5 }, polygon));
}

#[test]
fn sta_02_triangles_are_drawn_evenly() {
    let [a, b, c] = [DVec3::ZERO, DVec3::new(4.0, 0.0, 0.0), DVec3::new(1.0, 2.0, 0.0)];
    // Two triangles, areas 4 and 1: the second begins at 0.8 of the total.
    let small = [0.5, 0.5, 0.5].map(DVec3::splat);
    let other = [small[0], small[0] + 0.5 * (b - a), small[0] + 0.5 * (c - a)];
    let triangles = vec![(0, [a, b, c], true), (1, other, true)];
    let mesh = Extent::Mesh(Mesh { triangles, cumulative: vec![4.0, 5.0] });
    judge("triangles", &|u| {
        let spot = mesh.spot(u);
        let (index, _) = spot.triangle.expect("on a triangle");
        let (origin, scale) = if index == 0 { (a, 1.0) } else { (other[0], 0.5) };
        let at = (spot.point - origin) / scale;
        // Barycentric coordinates of b and c; their sum squared is uniform, and so is the ratio.
        let gamma = at.y / 2.0;
        let beta = (at.x - gamma) / 4.0;
        let depth = (beta + gamma).powi(2);
        [if index == 0 { 0.8 * depth } else { 0.8 + 0.2 * depth }, gamma / (beta + gamma)]
    });
}

#[test]
fn sta_02_wavelengths_are_drawn_as_their_spectrum_says() {
    let table = Spectrum::table(&[(400e-9, 1.0), (500e-9, 1.0), (600e-9, 0.0)]);
    judge("spectra", &|[u, v]| {
        let x = (table.wavelength(u) - 400e-9) / 100e-9;
        let below = if x < 1.0 { x } else { 1.0 + 0.5 - 0.5 * (2.0 - x).powi(2) };
        let lines = Spectrum::lines(&[(486e-9, 1.0), (588e-9, 3.0)]);
        // A line says only which part of 0..1 v is from.
        assert_eq!(lines.wavelength(v) == 486e-9, v < 0.25);
        [below / 1.5, v]
    });
}

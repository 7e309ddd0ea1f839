//! Curves around a point of a surface, seen in the plane of incidence: direction as it is, length by the logarithm of the value.
//!
//! The surface lies across the middle, its normal points up; light that goes on with the specular ray leaves to the right, transmitted
//! light below.

use super::canvas::{Anchor, Canvas, Weight};
use super::chart::{Curve, Division, Reach, colours, legend};
use super::plot::encode;
use std::f64::consts::PI;
use std::io;

/// Radius of the outermost circle; space left, above, right (legend) and below it, pixels.
const RADIUS: i32 = 300;
const MARGIN: [i32; 4] = [84, 100, 300, 70];

/// Angles from the normal that are marked, deg.
const MARKS: [i32; 12] = [0, 30, 60, 90, 120, 150, 180, -30, -60, -90, -120, -150];

const FAINT: [u8; 3] = [0xd0, 0xd4, 0xd9];

/// Curves of (angle from the upper normal, rad, > 0 to the right; value) as a PNG with circles of whole decades, `label` what they count.
pub fn polar(title: &str, label: &str, curves: &[Curve]) -> io::Result<Vec<u8>> {
    let values = curves.iter().flat_map(|curve| curve.points.iter().map(|point| point[1]));
    let reach = Reach::of(Division::Decades, values);
    let side = 2 * RADIUS;
    let mut canvas = Canvas::new(MARGIN[0] + side + MARGIN[2], MARGIN[1] + side + MARGIN[3]);
    canvas.text([16, 30], Anchor::Start, Weight::Bold, title);
    canvas.text([MARGIN[0] + RADIUS, MARGIN[1] + side + 48], Anchor::Middle, Weight::Regular, label);
    web(&mut canvas, &reach);
    for (curve, colour) in curves.iter().zip(colours()) {
        let place = |point: &[f64; 2]| Some(pixel(point[0], reach.place(point[1])?));
        let places: Vec<Option<[f64; 2]>> = curve.points.iter().map(place).collect();
        canvas.curve(&places, colour);
    }
    legend(&mut canvas, [MARGIN[0] + side + 70, MARGIN[1]], curves);
    encode(&canvas)
}

/// Where a direction (rad) ends at a radius 0..1.
fn pixel(angle: f64, radius: f64) -> [f64; 2] {
    let (sin, cos) = angle.sin_cos();
    let length = radius * f64::from(RADIUS);
    [f64::from(MARGIN[0] + RADIUS) + length * sin, f64::from(MARGIN[1] + RADIUS) - length * cos]
}

/// Circles of decades with their values, rays of angles with theirs, and the surface.
fn web(canvas: &mut Canvas, reach: &Reach) {
    let ring = |radius: f64| (0..=180).map(|k| Some(pixel(PI * f64::from(k) / 90.0, radius))).collect::<Vec<_>>();
    let marks = reach.marks(6);
    for (place, _) in &marks {
        canvas.curve(&ring(*place), FAINT);
    }
    for degrees in MARKS {
        let angle = f64::from(degrees).to_radians();
        canvas.curve(&[Some(pixel(angle, 0.0)), Some(pixel(angle, 1.0))], FAINT);
        let [x, y] = pixel(angle, 1.09).map(|at| at.round() as i32);
        canvas.text([x, y], Anchor::Middle, Weight::Regular, &format!("{degrees}"));
    }
    canvas.curve(&[Some(pixel(-0.5 * PI, 1.0)), Some(pixel(0.5 * PI, 1.0))], [0x16, 0x1b, 0x22]);
    for (place, text) in &marks {
        let [x, y] = pixel(0.0, *place).map(|at| at.round() as i32);
        canvas.text([x + 4, y + 10], Anchor::Start, Weight::Regular, text);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn directions_are_as_they_are() {
        let middle = [f64::from(MARGIN[0] + RADIUS), f64::from(MARGIN[1] + RADIUS)];
        let near = |a: [f64; 2], b: [f64; 2]| (a[0] - b[0]).abs() < 1e-9 && (a[1] - b[1]).abs() < 1e-9;
        assert!(near(pixel(0.0, 1.0), [middle[0], middle[1] - f64::from(RADIUS)]));
        assert!(near(pixel(0.5 * PI, 0.5), [middle[0] + 0.5 * f64::from(RADIUS), middle[1]]));
        let curve = Curve { label: "lobe".into(), points: vec![[0.0, 1.0], [0.5, 1e-3], [PI, 0.0]] };
        assert!(polar("title", "BSDF, 1/sr", &[curve]).expect("a picture").len() > 1000);
    }
}

//! Stray light of an extended scene, from the curve of a point.
//!
//!     E = int L PST dw,        dw = sin theta dtheta dphi
//!
//! For a sky of uniform radiance L between the first and the last angle of a sweep, E / L in sr: the solid angle of clear sky that would
//! light the detector as much. PST is that of stray light. Over the angle the integral is taken by trapezoids of PST sin theta, and
//! once more with log(PST) linear in the angle; their difference tells what the spacing of the angles may hide. Over the azimuth
//! each cut stands for what is nearest to it; a single one stands for the whole circle.
//!
//! Source: E. Fest, Stray Light Analysis and Control (SPIE, 2013), sec. 1.4.

use super::Point;
use crate::tally::results::Estimate;
use serde::Serialize;
use std::f64::consts::TAU;

/// A uniform sky.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Sky {
    /// From the boresight, deg.
    pub from_deg: f64,
    pub to_deg: f64,
    /// Azimuths together, deg; 360 is the whole circle.
    pub around_deg: f64,
    /// E / L, sr, by trapezoids; its error is that of the PST alone.
    pub stray_sr: Estimate,
    /// The same with log(PST) linear in the angle, sr.
    pub logarithmic_sr: f64,
}

impl Sky {
    /// Of the cuts of a sweep; `None` if they have a single angle.
    pub fn of(cuts: &[&[Point]]) -> Option<Sky> {
        let first = cuts.first().filter(|cut| cut.len() > 1)?;
        let widths = widths(&cuts.iter().map(|cut| cut[0].azimuth_deg.to_radians()).collect::<Vec<_>>());
        let (mut mean, mut variance, mut logarithmic) = (0.0, 0.0, 0.0);
        for (cut, width) in cuts.iter().zip(&widths) {
            for (point, weight) in cut.iter().zip(weights(cut)) {
                mean += width * weight * point.stray.mean;
                variance += (width * weight * point.stray.error).powi(2);
            }
            logarithmic += width * cut.windows(2).map(|pair| between(&pair[0], &pair[1])).sum::<f64>();
        }
        Some(Sky {
            from_deg: first[0].angle_deg,
            to_deg: first[first.len() - 1].angle_deg,
            around_deg: widths.iter().sum::<f64>().to_degrees(),
            stray_sr: Estimate { mean, error: variance.sqrt() },
            logarithmic_sr: logarithmic,
        })
    }
}

/// Azimuth that each of some rising ones stands for, rad: half the way to its neighbours. The gap between the last and the first
/// is closed if it is no wider than the widest other.
fn widths(azimuths: &[f64]) -> Vec<f64> {
    let count = azimuths.len();
    if count == 1 {
        return vec![TAU];
    }
    let gaps: Vec<f64> = azimuths.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let open = azimuths[0] + TAU - azimuths[count - 1];
    let closed = open <= 1.01 * gaps.iter().copied().fold(0.0, f64::max);
    let gap = |k: usize| if closed { [open, gaps[k % (count - 1)]][usize::from(k < count - 1)] } else { gaps[k] };
    let side = |k: Option<usize>| k.map_or(0.0, |k| 0.5 * gap(k));
    let before = |k: usize| if k > 0 { Some(k - 1) } else { closed.then_some(count - 1) };
    let after = |k: usize| if k < count - 1 { Some(k) } else { closed.then_some(count - 1) };
    (0..count).map(|k| side(before(k)) + side(after(k))).collect()
}

/// Weights of trapezoids over the angle, sin theta included, rad.
fn weights(cut: &[Point]) -> Vec<f64> {
    let theta = |k: usize| cut[k].angle_deg.to_radians();
    let step = |k: usize| if k + 1 < cut.len() { theta(k + 1) - theta(k) } else { 0.0 };
    (0..cut.len()).map(|k| 0.5 * (step(k) + if k > 0 { step(k - 1) } else { 0.0 }) * theta(k).sin()).collect()
}

/// Integral of PST sin theta between two angles with the logarithm of the PST linear; by a trapezoid where one of them is 0.
fn between(a: &Point, b: &Point) -> f64 {
    const STEPS: u32 = 32;
    let (from, to) = (a.angle_deg.to_radians(), b.angle_deg.to_radians());
    let (low, high) = (a.stray.mean, b.stray.mean);
    if low <= 0.0 || high <= 0.0 {
        return 0.5 * (to - from) * (low * from.sin() + high * to.sin());
    }
    // Midpoints: 32 of them leave 1e-3 of a fall over three decades.
    let value = |part: f64| low * (high / low).powf(part) * (from + part * (to - from)).sin();
    let midpoints = (0..STEPS).map(|k| value((f64::from(k) + 0.5) / f64::from(STEPS)));
    midpoints.sum::<f64>() * (to - from) / f64::from(STEPS)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    fn cut(azimuth_deg: f64, pst: &dyn Fn(f64) -> f64) -> Vec<Point> {
        let point = |k: i32| {
            let angle_deg = f64::from(k);
            let stray = Estimate { mean: pst(angle_deg.to_radians()), error: 0.01 };
            Point { angle_deg, azimuth_deg, stray, ..Point::default() }
        };
        (10..=60).map(point).collect()
    }

    #[test]
    fn a_cosine_integrates_to_the_projected_solid_angle() {
        let cosine = cut(0.0, &f64::cos);
        let sky = Sky::of(&[&cosine]).expect("a sky");
        let squared = |degrees: f64| degrees.to_radians().sin().powi(2);
        let wanted = PI * (squared(60.0) - squared(10.0));
        // Steps of 1 deg: (pi / 180)^2 / 3 of it.
        for found in [sky.stray_sr.mean, sky.logarithmic_sr] {
            assert!((found / wanted - 1.0).abs() < 2e-4, "{found} instead of {wanted}");
        }
        // Fifty steps of equal error add up in squares.
        assert!(sky.stray_sr.error < 0.2 * 0.01 * TAU, "{:?}", sky.stray_sr);
    }

    #[test]
    fn cuts_stand_for_what_is_nearest() {
        let degrees = |azimuths: &[f64]| {
            let found = widths(&azimuths.iter().map(|azimuth| azimuth.to_radians()).collect::<Vec<_>>());
            found.into_iter().map(|width| width.to_degrees().round()).collect::<Vec<_>>()
        };
        assert_eq!(degrees(&[30.0]), [360.0]);
        assert_eq!(degrees(&[0.0, 90.0, 180.0, 270.0]), [90.0; 4]);
        assert_eq!(degrees(&[0.0, 180.0]), [180.0; 2]);
        assert_eq!(degrees(&[0.0, 10.0, 30.0]), [5.0, 15.0, 10.0]);
        assert_eq!(degrees(&[0.0, 100.0, 240.0]), [110.0, 120.0, 130.0]);
    }
}

//! The hemisphere as a disc of projected solid angle, cut into rings and sectors.
//!
//! Coordinates are q = sin^2 theta and the azimuth phi: d2beta = cos(theta) dw = dq dphi / 2, so that the integral of a function
//! bilinear in (q, phi) against cos(theta) dw is the mean of its four corners times the area of the cell. Rings are even in
//! theta: they are as narrow near the horizon as elsewhere.

use crate::math::sampling;
use glam::DVec3;
use std::f64::consts::{FRAC_1_SQRT_2, FRAC_PI_2, TAU};

/// Edges of rings and sectors.
#[derive(Clone, Debug)]
pub struct Grid {
    /// Edges of rings in q = sin^2 theta, from 0 to 1, even in theta.
    pub square: Vec<f64>,
    /// Edges of sectors, rad, strictly rising from 0 to 2 pi.
    pub phi: Vec<f64>,
    /// Rings per rad of theta.
    rings_per_rad: f64,
    /// The sector in which each of equal parts of the turn begins.
    guide: Vec<u32>,
}

/// Parts of the turn, several for each sector.
const GUIDE: usize = 1024;

/// A direction on a [`Grid`].
#[derive(Clone, Copy, Debug)]
pub struct Place {
    /// Index of the corner of least q and phi in an array \[edge of ring\]\[edge of sector\].
    pub corner: usize,
    /// Way through the ring in q and through the sector in phi, 0..1.
    pub way: [f64; 2],
}

impl Grid {
    /// `rings` (>= 1) rings and sectors between the azimuths `phi`.
    pub fn new(rings: usize, phi: Vec<f64>) -> Grid {
        let edge = |i: usize| if i == rings { 1.0 } else { (FRAC_PI_2 * i as f64 / rings as f64).sin().powi(2) };
        let start = |k: usize| phi.partition_point(|edge| *edge <= TAU * k as f64 / GUIDE as f64).max(1) as u32 - 1;
        let guide = (0..GUIDE).map(start).collect();
        Grid { square: (0..=rings).map(edge).collect(), phi, rings_per_rad: rings as f64 / FRAC_PI_2, guide }
    }

    /// Number of corners.
    #[cfg(test)]
    pub fn len(&self) -> usize {
        self.square.len() * self.phi.len()
    }

    /// Direction of every corner, in the axes (forward, across, normal), ring after ring.
    pub fn corners(&self) -> impl Iterator<Item = DVec3> + '_ {
        self.square.iter().flat_map(move |&square| self.phi.iter().map(move |&phi| self.direction(square, phi)))
    }

    /// Direction at q = `square` and azimuth `phi` (rad); never exactly on the horizon, where there is no projected area.
    pub fn direction(&self, square: f64, phi: f64) -> DVec3 {
        let (sin, cos) = sampling::sin_cos_of_turn(phi / TAU);
        let radius = square.sqrt();
        DVec3::new(radius * cos, radius * sin, (1.0 - square).max(f64::MIN_POSITIVE).sqrt())
    }

    /// Where a direction lies, z >= 0.
    pub fn place(&self, d: DVec3) -> Place {
        let square = d.x * d.x + d.y * d.y;
        let ring = self.ring(square, d.z);
        let (from, to) = (self.square[ring], self.square[ring + 1]);
        let phi = d.y.atan2(d.x);
        let phi = if phi < 0.0 { phi + TAU } else { phi };
        let sector = self.sector(phi);
        let (start, end) = (self.phi[sector], self.phi[sector + 1]);
        // Rounding may carry q beyond the last edge.
        let way = [((square - from) / (to - from)).clamp(0.0, 1.0), ((phi - start) / (end - start)).clamp(0.0, 1.0)];
        Place { corner: ring * self.phi.len() + sector, way }
    }

    /// The sector that holds `phi` (rad, 0 to 2 pi).
    fn sector(&self, phi: f64) -> usize {
        let last = self.phi.len() - 2;
        let part = ((phi * (GUIDE as f64 / TAU)) as usize).min(GUIDE - 1);
        let mut sector = (self.guide[part] as usize).min(last);
        while sector < last && phi >= self.phi[sector + 1] {
            sector += 1;
        }
        sector
    }

    /// The ring that holds q = `square`, where cos theta = `z`.
    fn ring(&self, square: f64, z: f64) -> usize {
        let last = self.square.len() - 2;
        // A guess; the edges decide.
        let mut ring = ((angle_about(square, z) * self.rings_per_rad) as usize).min(last);
        while ring > 0 && square < self.square[ring] {
            ring -= 1;
        }
        while ring < last && square >= self.square[ring + 1] {
            ring += 1;
        }
        ring
    }
}

/// The polar angle (rad, 0 to pi/2) of a direction by sin^2 and cos, at most 0.2 deg short: theta = 2 asin(s), s = sin(theta / 2) <=
/// 1/sqrt(2), to s^7.
pub fn angle_about(square: f64, cos: f64) -> f64 {
    let s = FRAC_1_SQRT_2 * (square / (1.0 + cos)).sqrt();
    let s2 = s * s;
    2.0 * s * (1.0 + s2 * (1.0 / 6.0 + s2 * (3.0 / 40.0 + s2 * (5.0 / 112.0))))
}

/// Where the linear density from `a` to `b` (>= 0, not both 0) over 0..1 has the part `u` of its mass below it.
///
///     a t + (b - a) t^2 / 2 = u (a + b) / 2
pub fn invert(a: f64, b: f64, u: f64) -> f64 {
    // Away from the ends, where the density may be zero: a draw has a positive density.
    let u = u.clamp(f64::EPSILON, 1.0 - f64::EPSILON);
    // In parts of a + b: squares of small values would vanish.
    let (a, b) = (a / (a + b), b / (a + b));
    u / (a + (a * a + u * (b - a)).max(0.0).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    #[test]
    fn every_direction_lies_in_its_cell() {
        let grid = Grid::new(90, (0..=36).map(|j| f64::from(j) * PI / 18.0).collect());
        for (i, theta) in (0..1800).map(|k| (k, f64::from(k) * 0.05 + 0.01)) {
            let phi = (f64::from(i) * 0.1).rem_euclid(360.0);
            let t = theta.to_radians();
            let d = DVec3::new(t.sin() * phi.to_radians().cos(), t.sin() * phi.to_radians().sin(), t.cos());
            let place = grid.place(d);
            assert_eq!(place.corner / 37, theta as usize, "{theta}");
            let q = grid.square[place.corner / 37..].windows(2).next().map(|w| w[0] + place.way[0] * (w[1] - w[0]));
            assert!((q.expect("a ring") - t.sin().powi(2)).abs() < 1e-14);
            assert!((grid.phi[place.corner % 37].to_degrees() + 10.0 * place.way[1] - phi).abs() < 1e-9);
        }
        assert_eq!(grid.place(DVec3::X).corner / 37, 89);
        assert_eq!(grid.place(DVec3::Z).corner / 37, 0);
    }

    #[test]
    fn a_linear_density_is_inverted() {
        for (a, b) in [(1.0, 1.0), (0.0, 2.0), (3.0, 0.0), (1.0, 4.0), (1e-300, 1e-300)] {
            for u in [0.0, 1e-9, 0.3, 0.999_999, 1.0] {
                let t = invert(a, b, u);
                let below = (a * t + 0.5 * (b - a) * t * t) / (0.5 * (a + b));
                assert!((0.0..=1.0).contains(&t) && (below - u).abs() < 1e-15, "{a} {b} {u}: {t}");
            }
        }
    }
}

//! The hemisphere as a disc of projected solid angle, cut into rings and sectors.
//!
//! Coordinates are q = sin^2 theta and the azimuth phi: d2beta = cos(theta) dw = dq dphi / 2. A function bilinear in them is the sum of
//! its corner values times *hats*, each 1 at its corner and falling to 0 at the neighbours in q and in phi (at an edge of the grid, half
//! a hat):
//!
//!     f = sum of f_ij h_i(q) h_j(phi)        integral of h_i h_j dq dphi / 2 = (q_(i+1) - q_(i-1)) (phi_(j+1) - phi_(j-1)) / 8
//!
//! so that it is drawn from by a ring i, a sector j, and a place under either hat. Rings are even in theta: they are as narrow near the
//! horizon as elsewhere. Functions that are alike on both sides of phi = 0 are known by one of them: the grid is *folded*.
//!
//! A direction is found without its azimuth: a part of the turn by |x| and |y|, then the arc past the middle of a sector by a short
//! series.

use glam::{DVec2, DVec3};
use std::f64::consts::{FRAC_PI_2, TAU};

/// Edges of rings and sectors.
#[derive(Clone, Debug)]
pub struct Grid {
    /// Edges of rings in q = sin^2 theta, from 0 to 1, even in theta.
    square: Vec<f64>,
    /// Edges of sectors, rad, strictly rising from 0 to 2 pi, or to pi if the grid is folded.
    phi: Vec<f64>,
    /// Unit vectors to the middles of the sectors.
    middle: Vec<DVec2>,
    folded: bool,
    /// Integral of the hat of every edge of a ring against dq / 2.
    pub widths: Vec<f64>,
    /// Integral of the hat of every edge of a sector against dphi, on both sides of a folded grid, rad; together 2 pi.
    pub arcs: Vec<f64>,
    /// Rings per rad of theta.
    rings_per_rad: f64,
    /// The sector in which each of the parts of the turn begins.
    guide: Vec<u32>,
}

/// Widest sector, rad: for the series of the arc past its middle.
pub const WIDEST: f64 = TAU / 36.0;

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
    /// `rings` (>= 1) rings and sectors, not wider than [`WIDEST`], between the azimuths `phi` up to 2 pi, or to pi: folded.
    pub fn new(rings: usize, phi: Vec<f64>) -> Grid {
        let edge = |i: usize| if i == rings { 1.0 } else { (FRAC_PI_2 * i as f64 / rings as f64).sin().powi(2) };
        let start = |part: usize| {
            let p = beginning(part);
            let azimuth = p.y.atan2(p.x).rem_euclid(TAU);
            phi.partition_point(|edge| *edge <= azimuth).clamp(1, phi.len() - 1) as u32 - 1
        };
        let guide = (0..GUIDE).map(start).collect();
        let middle = phi.windows(2).map(|w| DVec2::from_angle(0.5 * (w[0] + w[1]))).collect();
        let folded = phi[phi.len() - 1] < 0.75 * TAU;
        let rings_per_rad = rings as f64 / FRAC_PI_2;
        let square: Vec<f64> = (0..=rings).map(edge).collect();
        let (widths, arcs) = (hats(&square, 0.5), hats(&phi, if folded { 2.0 } else { 1.0 }));
        Grid { square, phi, middle, folded, widths, arcs, rings_per_rad, guide }
    }

    /// Number of corners.
    #[cfg(test)]
    pub fn len(&self) -> usize {
        self.square.len() * self.phi.len()
    }

    /// Number of corners on an edge of a ring.
    pub fn columns(&self) -> usize {
        self.phi.len()
    }

    /// Direction of every corner, in the axes (forward, across, normal), ring after ring.
    pub fn corners(&self) -> impl Iterator<Item = DVec3> + '_ {
        let on = |square: f64, phi: f64| direction(square, DVec2::from_angle(phi));
        self.square.iter().flat_map(move |&square| self.phi.iter().map(move |&phi| on(square, phi)))
    }

    /// Which side of a folded grid (-1 or 1) a uniform number is on, and what it leaves: the turn from one end to the other.
    pub fn side(&self, u: f64) -> (f64, f64) {
        let turn = 2.0 * u - 1.0;
        if self.folded { (1f64.copysign(turn), turn.abs()) } else { (1.0, u) }
    }

    /// The direction at which the hats of an edge of a ring and of a sector have the parts `u` (0..1) of their integrals below it.
    pub fn draw(&self, [ring, sector]: [usize; 2], u: [f64; 2]) -> DVec3 {
        let (_, square) = below_hat(&self.square, ring, u[0]);
        let (sector, phi) = below_hat(&self.phi, sector, u[1]);
        let (sin, cos) = small_sin_cos(phi - 0.5 * (self.phi[sector] + self.phi[sector + 1]));
        direction(square, DVec2::new(cos, sin).rotate(self.middle[sector]))
    }

    /// Where a direction lies, z >= 0.
    pub fn place(&self, d: DVec3) -> Place {
        let square = d.x * d.x + d.y * d.y;
        let ring = self.ring(square, d.z);
        let (from, to) = (self.square[ring], self.square[ring + 1]);
        let (sector, v) = self.sector(DVec2::new(d.x, if self.folded { d.y.abs() } else { d.y }));
        // Rounding may carry both beyond the edges.
        let way = [((square - from) / (to - from)).clamp(0.0, 1.0), v.clamp(0.0, 1.0)];
        Place { corner: ring * self.phi.len() + sector, way }
    }

    /// The sector that holds a direction along the surface, and the way through it.
    fn sector(&self, d: DVec2) -> (usize, f64) {
        let mut sector = self.guide[part(d)] as usize;
        loop {
            let middle = self.middle[sector];
            // On the normal, where an azimuth means nothing, it is that of the middle.
            let arc = small_arc_tangent(middle.perp_dot(d) / middle.dot(d).max(f64::MIN_POSITIVE));
            let way = 0.5 + arc / (self.phi[sector + 1] - self.phi[sector]);
            if way < 1.0 || sector + 1 == self.middle.len() {
                return (sector, way);
            }
            sector += 1;
        }
    }

    /// The ring that holds q = `square`, where cos theta = `z`.
    fn ring(&self, square: f64, z: f64) -> usize {
        let last = self.square.len() - 2;
        // A guess; the edges decide.
        let mut ring = ((angle_about(z) * self.rings_per_rad) as usize).min(last);
        while ring > 0 && square < self.square[ring] {
            ring -= 1;
        }
        while ring < last && square >= self.square[ring + 1] {
            ring += 1;
        }
        ring
    }
}

/// Unit vector at q = `square` along `azimuth`; never exactly on the horizon, where there is no projected area.
fn direction(square: f64, azimuth: DVec2) -> DVec3 {
    (azimuth * square.sqrt()).extend((1.0 - square).max(f64::MIN_POSITIVE).sqrt())
}

/// Integral of the hat of every edge times `factor`.
fn hats(edges: &[f64], factor: f64) -> Vec<f64> {
    let hat = |at: usize| 0.5 * factor * (edges[(at + 1).min(edges.len() - 1)] - edges[at.saturating_sub(1)]);
    (0..edges.len()).map(hat).collect()
}

/// Where the hat of an edge - 1 there, falling to 0 at its neighbours - has the part `u` (0..1) of its mass below it: the interval, and
/// the coordinate. With a and b the widths of the intervals before and after the edge e, and c the one of them in which it lies:
///
///     y = u (a + b) - a        e + sign(y) (c - sqrt(c (c - |y|)))
fn below_hat(edges: &[f64], at: usize, u: f64) -> (usize, f64) {
    // Away from the ends, where the hat is zero, by several roundings of y: a draw has a positive density.
    let u = u.clamp(1e-15, 1.0 - 1e-15);
    let (before, after) = (edges[at.saturating_sub(1)], edges[(at + 1).min(edges.len() - 1)]);
    let y = u * (after - before) - (edges[at] - before);
    // Looked up, not branched to: a branch would be guessed wrongly half of the time.
    let interval = at - usize::from(y < 0.0);
    let width = edges[interval + 1] - edges[interval];
    let past = width - (width * (width - y.abs())).sqrt();
    (interval, edges[at] + past.copysign(y))
}

/// The part of the turn that holds a direction along the surface. With s = y / (|x| + |y|), which rises and falls by 1 in every quarter, the turn
/// is s, 2 - s, 4 + s of 4.
fn part(d: DVec2) -> usize {
    let s = d.y / (d.x.abs() + d.y.abs() + f64::MIN_POSITIVE);
    let forth = if d.y < 0.0 { 4.0 + s } else { s };
    let turn = if d.x < 0.0 { 2.0 - s } else { forth };
    ((turn * (GUIDE as f64 / 4.0)) as usize).min(GUIDE - 1)
}

/// A vector to where a part of the turn begins.
fn beginning(part: usize) -> DVec2 {
    let turn = part as f64 * (4.0 / GUIDE as f64);
    DVec2::new((turn - 2.0).abs() - 1.0, if turn < 3.0 { 1.0 - (turn - 1.0).abs() } else { turn - 4.0 })
}

/// Sine and cosine of |x| < 0.1, the next terms are x^11 / 11! and x^10 / 10!: 3e-17.
fn small_sin_cos(x: f64) -> (f64, f64) {
    const SIN: [f64; 4] = [-1.0 / 6.0, 1.0 / 120.0, -1.0 / 5040.0, 1.0 / 362_880.0];
    const COS: [f64; 4] = [-1.0 / 2.0, 1.0 / 24.0, -1.0 / 720.0, 1.0 / 40_320.0];
    let square = x * x;
    (x + x * series(&SIN, square), 1.0 + series(&COS, square))
}

/// The sum of the `terms` times rising powers of `x`, from the first.
fn series(terms: &[f64], x: f64) -> f64 {
    terms.iter().rev().fold(0.0, |sum, term| (sum + term) * x)
}

/// atan(`t`) for |t| < 0.1, rad: the next term is t^15 / 15, 1e-16.
fn small_arc_tangent(t: f64) -> f64 {
    const TERMS: [f64; 6] = [-1.0 / 3.0, 1.0 / 5.0, -1.0 / 7.0, 1.0 / 9.0, -1.0 / 11.0, 1.0 / 13.0];
    t + t * series(&TERMS, t * t)
}

/// The polar angle (rad, 0 to pi/2) of a direction by its cosine, within 7e-5.
/// Source: Abramowitz & Stegun, Handbook of Mathematical Functions (1964), 4.4.45.
pub fn angle_about(cos: f64) -> f64 {
    (1.0 - cos).max(0.0).sqrt() * (1.5707288 - cos * (0.2121144 - cos * (0.0742610 - cos * 0.0187293)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    #[test]
    fn every_direction_lies_in_its_cell() {
        let grid = Grid::new(90, (0..=36).map(|j| f64::from(j) * PI / 18.0).collect());
        for (i, theta) in (0..1800).map(|k| (k, f64::from(k) * 0.05 + 0.01)) {
            let phi = (f64::from(i) * 0.1 + 0.03).rem_euclid(360.0);
            let t = theta.to_radians();
            let d = DVec3::new(t.sin() * phi.to_radians().cos(), t.sin() * phi.to_radians().sin(), t.cos());
            let place = grid.place(d);
            assert_eq!(place.corner / 37, theta as usize, "{theta}");
            let q = grid.square[place.corner / 37..].windows(2).next().map(|w| w[0] + place.way[0] * (w[1] - w[0]));
            assert!((q.expect("a ring") - t.sin().powi(2)).abs() < 1e-14);
            assert!((grid.phi[place.corner % 37].to_degrees() + 10.0 * place.way[1] - phi).abs() < 1e-12 * 360.0);
        }
        assert_eq!(grid.place(DVec3::X).corner / 37, 89);
        assert_eq!(grid.place(DVec3::Z).corner / 37, 0);
    }

    #[test]
    fn sectors_narrower_than_a_part_of_the_turn_are_found() {
        let edges: Vec<f64> = (0..=5000).map(|j| TAU * f64::from(j) / 5000.0).collect();
        let grid = Grid::new(3, edges);
        for k in 0..5000 {
            let phi = TAU * (f64::from(k) + 0.5) / 5000.0;
            let place = grid.place(DVec3::new(0.6 * phi.cos(), 0.6 * phi.sin(), 0.8));
            assert_eq!(place.corner % 5001, k as usize);
            assert!((place.way[1] - 0.5).abs() < 1e-11);
        }
    }

    #[test]
    fn a_hat_is_cut_where_its_mass_says() {
        // Cumulated mass of the hat of edge `at` up to x.
        let below = |edges: [f64; 4], at: usize, x: f64| {
            let (a, b) = (
                if at > 0 { edges[at] - edges[at - 1] } else { 0.0 },
                if at < 3 { edges[at + 1] - edges[at] } else { 0.0 },
            );
            let past = x - edges[at];
            let part = if past < 0.0 {
                0.5 * (past + a).powi(2) / a
            } else {
                0.5 * (a + b) - if b > 0.0 { 0.5 * (b - past).powi(2) / b } else { 0.0 }
            };
            part / (0.5 * (a + b))
        };
        let edges = [0.0, 0.1, 0.5, 1.0];
        for at in 0..4 {
            for u in [1e-9, 0.1, 0.25, 0.7, 0.999] {
                let (interval, x) = below_hat(&edges, at, u);
                assert!(x > edges[interval] && x < edges[interval + 1]);
                assert!((below(edges, at, x) - u).abs() < 1e-14, "{at} {u}");
            }
            for u in [0.0, 1.0] {
                let (interval, x) = below_hat(&edges, at, u);
                assert!((interval == at || interval + 1 == at) && x >= edges[interval] && x <= edges[interval + 1]);
                assert!((x - edges[at]).abs() < edges[interval + 1] - edges[interval], "{at} {u}");
            }
        }
    }

    #[test]
    fn an_angle_is_guessed_to_a_hundredth_of_a_degree() {
        assert!((0..=1000).map(|k| FRAC_PI_2 * f64::from(k) / 1000.0).all(|a| (angle_about(a.cos()) - a).abs() < 7e-5));
    }
}

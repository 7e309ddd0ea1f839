//! Polarised flux: the Stokes vector and its transverse axis.
//!
//! Axes (x, y = k x x, k), k the direction of travel; fields E_x, E_y with time factor exp(-i omega t), scaled to W:
//!
//!     I = |E_x|^2 + |E_y|^2        Q = |E_x|^2 - |E_y|^2        U + i V = 2 E_x conj(E_y)
//!
//! Q > 0 is linear along x, U > 0 linear at +45 deg from x towards y, V > 0 right-handed: clockwise for who looks
//! towards the source. Physical light has I^2 >= Q^2 + U^2 + V^2.
//!
//! With x' turned by alpha from x towards y:   Q' + i U' = exp(-2 i alpha) (Q + i U);   I, V unchanged.
//!
//! Source: Born & Wolf, Principles of Optics, 7th ed., sec. 1.4.2 (hand) and 10.9.3.

use glam::DVec3;
use std::ops::{Add, AddAssign, Mul, MulAssign};

/// Flux with its polarisation, W.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Stokes {
    /// Flux, W.
    pub i: f64,
    /// Linear along x minus along y, W.
    pub q: f64,
    /// Linear at +45 deg minus at -45 deg, W.
    pub u: f64,
    /// Right- minus left-handed circular, W.
    pub v: f64,
}

/// Sense of rotation of circular light as seen looking towards the source.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Hand {
    /// Clockwise.
    Right,
    /// Counter-clockwise.
    Left,
}

impl Stokes {
    pub const ZERO: Stokes = Stokes { i: 0.0, q: 0.0, u: 0.0, v: 0.0 };

    /// Unpolarised light of `flux` W.
    pub fn unpolarised(flux: f64) -> Stokes {
        Stokes { i: flux, ..Stokes::ZERO }
    }

    /// Linearly polarised light of `flux` W whose field is at `angle` rad from x towards y.
    pub fn linear(flux: f64, angle: f64) -> Stokes {
        let (sin, cos) = (2.0 * angle).sin_cos();
        Stokes { i: flux, q: flux * cos, u: flux * sin, v: 0.0 }
    }

    /// Circularly polarised light of `flux` W.
    pub fn circular(flux: f64, hand: Hand) -> Stokes {
        let v = if hand == Hand::Right { flux } else { -flux };
        Stokes { i: flux, v, ..Stokes::ZERO }
    }

    /// The same light described with x turned by `angle` rad from x towards y.
    pub fn rotate(self, angle: f64) -> Stokes {
        let (sin, cos) = (2.0 * angle).sin_cos();
        self.turn(cos, sin)
    }

    /// As [`Stokes::rotate`], given cos and sin of *twice* the angle.
    pub fn turn(self, cos2: f64, sin2: f64) -> Stokes {
        Stokes { q: self.q * cos2 + self.u * sin2, u: self.u * cos2 - self.q * sin2, ..self }
    }

    /// Sum of the products of their elements: the flux, W, that a detector with this row of weights counts of the light.
    pub fn dot(self, light: Stokes) -> f64 {
        self.i * light.i + self.q * light.q + self.u * light.u + self.v * light.v
    }

    /// True if turning the axes changes its description: it has a linear part.
    pub fn is_polarised(&self) -> bool {
        self.q != 0.0 || self.u != 0.0
    }

    /// Polarised flux, sqrt(Q^2 + U^2 + V^2), W; at most I.
    pub fn polarised(&self) -> f64 {
        (self.q * self.q + self.u * self.u + self.v * self.v).sqrt()
    }

    /// Degree of polarisation, 0..1; 0 where there is no light.
    pub fn degree(&self) -> f64 {
        if self.i > 0.0 { self.polarised() / self.i } else { 0.0 }
    }
}

impl Add for Stokes {
    type Output = Stokes;
    fn add(self, o: Stokes) -> Stokes {
        Stokes { i: self.i + o.i, q: self.q + o.q, u: self.u + o.u, v: self.v + o.v }
    }
}

impl AddAssign for Stokes {
    fn add_assign(&mut self, o: Stokes) {
        *self = *self + o;
    }
}

impl Mul<f64> for Stokes {
    type Output = Stokes;
    fn mul(self, k: f64) -> Stokes {
        Stokes { i: self.i * k, q: self.q * k, u: self.u * k, v: self.v * k }
    }
}

impl MulAssign<f64> for Stokes {
    fn mul_assign(&mut self, k: f64) {
        *self = *self * k;
    }
}

/// Turns every lane of `light` from transverse axis `from` to `to` (unit vectors, both perpendicular to the unit `direction`).
pub fn reframe<const V: usize>(light: &mut [Stokes; V], direction: DVec3, from: DVec3, to: DVec3) {
    // cos and sin of the angle from `from` to `to` about k; doubled without an arc function.
    let (cos, sin) = (from.dot(to), direction.cross(from).dot(to));
    let norm = cos * cos + sin * sin;
    let (cos2, sin2) = ((cos * cos - sin * sin) / norm, 2.0 * sin * cos / norm);
    for lane in light {
        *lane = lane.turn(cos2, sin2);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::FRAC_PI_4;

    fn close(a: Stokes, b: Stokes) -> bool {
        let d = a + b * -1.0;
        d.i.abs() + d.q.abs() + d.u.abs() + d.v.abs() < 1e-14
    }

    #[test]
    fn light_along_the_new_axis_is_linear_in_it() {
        assert!(close(Stokes::linear(3.0, 0.3).rotate(0.3), Stokes::linear(3.0, 0.0)));
        assert!(close(Stokes::linear(3.0, FRAC_PI_4).rotate(-0.2), Stokes::linear(3.0, FRAC_PI_4 + 0.2)));
    }

    #[test]
    fn reframing_is_a_rotation_about_the_direction_of_travel() {
        let (k, x) = (DVec3::Z, DVec3::X);
        let to = DVec3::new(0.4f64.cos(), 0.4f64.sin(), 0.0);
        let start = Stokes { i: 1.0, q: 0.3, u: -0.5, v: 0.6 };
        let mut light = [start; 2];
        reframe(&mut light, k, x, to);
        assert!(close(light[1], start.rotate(0.4)));
        reframe(&mut light, k, to, x);
        assert!(close(light[0], start));
    }
}

//! What a coating comes to in power: R, T and A of s and p light at one wavelength and angle.

use super::Coating;
use crate::optics::{Incidence, refraction};
use glam::DVec3;
use num_complex::Complex64;

/// Shares of the arriving power, s and p, 0..1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Response {
    pub reflected: [f64; 2],
    pub transmitted: [f64; 2],
}

impl Response {
    /// Light of vacuum wavelength `wavelength` (m) that arrives at angle `theta` (rad, below pi/2) from the first index towards the second.
    pub fn of(coating: &dyn Coating, index: [Complex64; 2], wavelength: f64, theta: f64) -> Response {
        let wi = DVec3::new(theta.sin(), 0.0, theta.cos());
        let split = coating.split(&Incidence { index, ..Incidence::in_air(theta, wavelength) });
        let [mut reflected, mut transmitted] =
            [split.reflected, split.transmitted].map(|a| [a.s.norm_sqr(), a.p.norm_sqr()]);
        if refraction::refract(wi, index[0].re, index[1].re).is_none() {
            // Where no ray goes on nothing is transmitted.
            for (r, t) in reflected.iter_mut().zip(&mut transmitted) {
                *r += std::mem::take(t);
            }
        }
        Response { reflected, transmitted }
    }

    /// What stays in the coating, s and p.
    pub fn absorbed(&self) -> [f64; 2] {
        [0, 1].map(|k| 1.0 - self.reflected[k] - self.transmitted[k])
    }
}

/// Of unpolarised light.
pub fn mean([s, p]: [f64; 2]) -> f64 {
    0.5 * (s + p)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::coating::{Bare, Ideal};

    #[test]
    fn the_three_shares_are_all_there_is() {
        let index = [1.0, 1.5].map(|n| Complex64::new(n, 0.0));
        let found = Response::of(&Bare, index, 550e-9, 0.0);
        assert!((mean(found.reflected) - 0.04).abs() < 1e-15 && mean(found.absorbed()).abs() < 1e-15);
        let lossy = Ideal { reflectance: 0.2, transmittance: 0.5 };
        let total = Response::of(&lossy, [index[1], index[0]], 550e-9, 1.0);
        assert!((mean(total.reflected) - 0.7).abs() < 1e-15 && (mean(total.absorbed()) - 0.3).abs() < 1e-15);
    }
}

//! Scatter by particles much smaller than the wavelength.
//!
//!     p(cos) = 3 (1 + cos^2) / (16 pi),   1/sr;       c(lambda) = c0 (lambda0 / lambda)^4
//!
//! The cumulated distribution u = (cos^3 + 3 cos + 4) / 8 is inverted by Cardano's formula.
//! Source: Lord Rayleigh, Phil. Mag. 41, 107 (1871). Left out: the index of the particles changing with the wavelength, depolarisation.

use super::Bulk;
use crate::math::Rng;
use std::f64::consts::PI;

/// Scattering coefficient (1/m) at one vacuum wavelength (m).
#[derive(Clone, Copy, Debug)]
pub struct Rayleigh {
    pub coefficient: f64,
    pub at: f64,
}

impl Bulk for Rayleigh {
    fn coefficient(&self, wavelength: f64) -> f64 {
        self.coefficient * (self.at / wavelength).powi(4)
    }

    fn phase(&self, cosine: f64, _wavelength: f64) -> f64 {
        3.0 * (1.0 + cosine * cosine) / (16.0 * PI)
    }

    fn draw(&self, _wavelength: f64, rng: &mut Rng) -> f64 {
        // cos^3 + 3 cos = 2 q has the one real root w - 1 / w, w^3 = q + sqrt(q^2 + 1): odd in q.
        let q = 4.0 * rng.uniform() - 2.0;
        let w = (q.abs() + q.hypot(1.0)).cbrt();
        (w - 1.0 / w).min(1.0).copysign(q)
    }
}

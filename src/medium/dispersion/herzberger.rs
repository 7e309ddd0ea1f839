//! Herzberger's formula for infrared materials.
//!
//!     n = a + b L + c L^2 + d lambda^2 + e lambda^4 + f lambda^6,    L = 1 / (lambda^2 - 0.028)
//!
//! lambda in um, L in um^-2. refractiveindex.info's formula 7, AGF formula 3.
//!
//! Source: Herzberger & Salzberg, J. Opt. Soc. Am. 52, 420 (1962), with 0.028 um^2 as the mean squared resonance of all
//! materials.

use super::{MICROMETRES, powers};
use crate::medium::Medium;
use num_complex::Complex64;

/// Squared resonance wavelength, um^2.
const RESONANCE: f64 = 0.028;

/// A medium by Herzberger's coefficients.
#[derive(Clone, Copy, Debug)]
pub struct Herzberger {
    /// a, b, c, d, e, f; in the powers of um that make n dimensionless.
    pub coefficients: [f64; 6],
}

impl Medium for Herzberger {
    fn index(&self, wavelength: f64) -> Complex64 {
        let [a, b, c, d, e, f] = self.coefficients;
        let square = (wavelength * MICROMETRES).powi(2);
        let l = 1.0 / (square - RESONANCE);
        Complex64::new(a + b * l + c * l * l + powers(&[(d, 1.0), (e, 2.0), (f, 3.0)], square), 0.0)
    }
}

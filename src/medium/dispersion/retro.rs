//! A resonance of the Lorentz-Lorenz quotient ("retro").
//!
//!     (n^2 - 1) / (n^2 + 2) = q = a + b lambda^2 / (lambda^2 - c) + d lambda^2,    n^2 = (1 + 2 q) / (1 - q)
//!
//! lambda in um; a, b dimensionless; c in um^2; d in um^-2. refractiveindex.info's formula 8.
//!
//! Source: Schroter, Z. Phys. 67, 24 (1931), for the silver halides; refractiveindex.info, "Dispersion formulas".

use super::{MICROMETRES, root};
use crate::medium::Medium;
use num_complex::Complex64;

/// A medium by its Lorentz-Lorenz quotient.
#[derive(Clone, Copy, Debug)]
pub struct Retro {
    /// a, b, c, d.
    pub coefficients: [f64; 4],
}

impl Medium for Retro {
    fn index(&self, wavelength: f64) -> Complex64 {
        let [a, b, c, d] = self.coefficients;
        let square = (wavelength * MICROMETRES).powi(2);
        let q = a + b * square / (square - c) + d * square;
        root((1.0 + 2.0 * q) / (1.0 - q))
    }
}

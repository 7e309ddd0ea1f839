//! A power series for the index itself.
//!
//!     n = sum_j c_j lambda^e_j        lambda in um; c_j in um^-e_j; e_j dimensionless
//!
//! Cauchy's exponents are 0, -2, -4, Conrady's 0, -1, -3.5 (AGF formula 5); refractiveindex.info's formula 5.
//!
//! Source: Cauchy, Memoire sur la dispersion (1836); Conrady, Applied Optics and Optical Design II (1960), 659.

use super::{MICROMETRES, powers};
use crate::medium::Medium;
use num_complex::Complex64;

/// A medium by the powers of its index.
#[derive(Clone, Debug)]
pub struct Cauchy {
    /// Pairs (coefficient um^-e, exponent e dimensionless).
    pub terms: Vec<(f64, f64)>,
}

impl Medium for Cauchy {
    fn index(&self, wavelength: f64) -> Complex64 {
        Complex64::new(powers(&self.terms, wavelength * MICROMETRES), 0.0)
    }
}

//! A power series for the square of the index.
//!
//!     n^2 = sum_j c_j lambda^e_j        lambda in um; c_j in um^-e_j; e_j dimensionless
//!
//! The Schott formula of older catalogues is this one with the exponents 0, 2, -2, -4, -6, -8; refractiveindex.info's formula
//! 3; AGF formulas 1, 10, 12, 13.
//!
//! Source: Schott's catalogues before 1992; refractiveindex.info, "Dispersion formulas".

use super::{MICROMETRES, powers, root};
use crate::medium::Medium;
use num_complex::Complex64;

/// A glass by the powers of its squared index.
#[derive(Clone, Debug)]
pub struct Polynomial {
    /// Pairs (coefficient um^-e, exponent e dimensionless).
    pub terms: Vec<(f64, f64)>,
}

impl Medium for Polynomial {
    fn index(&self, wavelength: f64) -> Complex64 {
        root(powers(&self.terms, wavelength * MICROMETRES))
    }
}

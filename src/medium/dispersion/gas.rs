//! Dispersion of gases.
//!
//!     n - 1 = c + sum_j b_j / (p_j - lambda^-2)        lambda in um; b_j, p_j in um^-2; c dimensionless
//!
//! refractiveindex.info's formula 6. Left out: temperature and pressure; a page holds for its own.
//!
//! Source: Edlen, J. Opt. Soc. Am. 43, 339 (1953); refractiveindex.info, "Dispersion formulas".

use super::MICROMETRES;
use crate::medium::Medium;
use num_complex::Complex64;

/// A gas by its resonances.
#[derive(Clone, Debug)]
pub struct Gas {
    /// c, dimensionless.
    pub constant: f64,
    /// Pairs (b, p), um^-2.
    pub terms: Vec<(f64, f64)>,
}

impl Medium for Gas {
    fn index(&self, wavelength: f64) -> Complex64 {
        let square = (wavelength * MICROMETRES).powi(-2);
        let sum: f64 = self.terms.iter().map(|(b, p)| b / (p - square)).sum();
        Complex64::new(1.0 + self.constant + sum, 0.0)
    }
}

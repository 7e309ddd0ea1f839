//! Sellmeier dispersion of transparent glass.
//!
//!     n^2 = 1 + sum_j b_j lambda^2 / (lambda^2 - c_j)
//!
//! lambda wavelength, m; b_j dimensionless; c_j m^2 (catalogues: um^2, 1 um^2 = 1e-12 m^2); a resonance at c = 0 is a
//! constant. Catalogue coefficients mean wavelength and index relative to air; the caller knows whether they are meant so.
//! refractiveindex.info's formulas 1 and 2; AGF formulas 2, 6, 9, 11. Check: N-BK7 n_d = 1.5168000.
//!
//! Left out: absorption; temperature. Nothing in the coefficients says where the fit was made: give `range` to have
//! it checked. Inside a resonance band n^2 < 0 and the index is imaginary: total reflection, as in a reststrahlen band.
//!
//! Source: Sellmeier, Ann. Phys. 219, 272 (1871); Schott, Optical Glass 2023, p. 12.

use super::root;
use crate::medium::Medium;
use num_complex::Complex64;

/// A glass by its Sellmeier coefficients.
#[derive(Clone, Debug)]
pub struct Sellmeier {
    /// Pairs (b dimensionless, c m^2).
    pub terms: Vec<(f64, f64)>,
    /// Vacuum wavelengths (m) of the fit, if known.
    pub range: Option<[f64; 2]>,
}

impl Medium for Sellmeier {
    fn index(&self, wavelength: f64) -> Complex64 {
        let square = wavelength * wavelength;
        let sum: f64 = self.terms.iter().map(|(b, c)| b * square / (square - c)).sum();
        root(1.0 + sum)
    }

    fn range(&self) -> Option<[f64; 2]> {
        self.range
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_resonance_band_reflects() {
        let one = Sellmeier { terms: vec![(1.0, 1e-12)], range: None };
        assert_eq!(one.index(0.9e-6).re, 0.0);
        assert!(one.index(0.9e-6).im > 0.0);
    }
}

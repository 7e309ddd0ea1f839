//! What fills a solid.

use crate::system::units::{Absorption, Wavelength, WavelengthSquared};
use serde::Deserialize;

/// A homogeneous medium: its complex refractive index n + ik over the vacuum wavelength.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum Medium {
    /// The same index at every wavelength.
    Constant {
        /// Refractive index, dimensionless, > 0.
        n: f64,
        /// Extinction coefficient, dimensionless, >= 0; 0 if neither it nor `absorption` is given.
        k: Option<f64>,
        /// Absorption coefficient 4 pi k / lambda, 1/m, instead of `k`.
        absorption: Option<Absorption>,
    },
    /// n^2 = 1 + sum b_i lambda^2 / (lambda^2 - c_i), any number of terms.
    Sellmeier {
        /// Strengths, dimensionless.
        b: Vec<f64>,
        /// Squared resonance wavelengths, m2; as many as `b`.
        c: Vec<WavelengthSquared>,
    },
    /// A table over the wavelength.
    Tabulated {
        /// Vacuum wavelengths, m, increasing.
        wavelength: Vec<Wavelength>,
        /// Refractive indices, dimensionless, > 0; one per wavelength.
        n: Vec<f64>,
        /// Extinction coefficients, dimensionless, >= 0; one per wavelength, or all 0 if not given.
        k: Option<Vec<f64>>,
    },
}

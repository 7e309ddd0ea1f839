//! Resonances with free powers of the wavelength, and a power series.
//!
//!     n^2 = sum_j b_j lambda^p_j / (lambda^2 - c_j)  +  sum_j a_j lambda^e_j
//!
//! lambda in um; c_j in um^2; b_j, a_j in the powers of um that make n^2 dimensionless. refractiveindex.info's formula 4; AGF
//! formulas 4 (Sellmeier 2), 7 and 8 (Handbook of Optics).
//!
//! Source: refractiveindex.info, "Dispersion formulas"; Handbook of Optics II (1995), ch. 33.

use super::{MICROMETRES, powers, root};
use crate::medium::Medium;
use num_complex::Complex64;

/// One resonance.
#[derive(Clone, Copy, Debug)]
pub struct Fraction {
    /// b, um^(2 - p).
    pub strength: f64,
    /// p, dimensionless.
    pub power: f64,
    /// c, um^2.
    pub pole: f64,
}

/// A medium by fractions and powers.
#[derive(Clone, Debug)]
pub struct Fractions {
    pub fractions: Vec<Fraction>,
    /// Pairs (coefficient um^-e, exponent e dimensionless).
    pub terms: Vec<(f64, f64)>,
}

impl Medium for Fractions {
    fn index(&self, wavelength: f64) -> Complex64 {
        let lambda = wavelength * MICROMETRES;
        let resonance = |f: &Fraction| powers(&[(f.strength, f.power)], lambda) / (lambda * lambda - f.pole);
        root(self.fractions.iter().map(resonance).sum::<f64>() + powers(&self.terms, lambda))
    }
}

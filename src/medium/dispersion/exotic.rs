//! A resonance and a damped one ("exotic").
//!
//!     n^2 = a + b / (lambda^2 - c) + d (lambda - e) / ((lambda - e)^2 + f)
//!
//! lambda in um; c, f in um^2; e, d in um; b in um^2; a dimensionless. refractiveindex.info's formula 9.
//!
//! Source: Rosker et al., IEEE J. Quantum Electron. 21, 1600 (1985), for urea; refractiveindex.info, "Dispersion formulas".

use super::{MICROMETRES, root};
use crate::medium::Medium;
use num_complex::Complex64;

/// A medium by its six coefficients.
#[derive(Clone, Copy, Debug)]
pub struct Exotic {
    /// a, b, c, d, e, f.
    pub coefficients: [f64; 6],
}

impl Medium for Exotic {
    fn index(&self, wavelength: f64) -> Complex64 {
        let [a, b, c, d, e, f] = self.coefficients;
        let lambda = wavelength * MICROMETRES;
        let off = lambda - e;
        root(a + b / (lambda * lambda - c) + d * off / (off * off + f))
    }
}

//! A medium of one index at every wavelength.
//!
//!     index = n + ik;   given an absorption coefficient alpha instead:  k = alpha lambda / (4 pi)
//!
//! n, k dimensionless; alpha in 1/m (flux falls as exp(-alpha path)); lambda vacuum wavelength, m.
//! Left out: dispersion.

use super::{Medium, extinction};
use num_complex::Complex64;

/// What a constant medium takes from the light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Loss {
    /// Imaginary index k, dimensionless, >= 0.
    Extinction(f64),
    /// Absorption coefficient alpha, 1/m, >= 0.
    Absorption(f64),
}

/// Index and loss, the same at every wavelength.
#[derive(Clone, Copy, Debug)]
pub struct Constant {
    /// Real index, dimensionless, > 0.
    pub n: f64,
    pub loss: Loss,
}

impl Constant {
    /// A transparent medium of real index `n`.
    pub fn transparent(n: f64) -> Constant {
        Constant { n, loss: Loss::Extinction(0.0) }
    }
}

impl Medium for Constant {
    fn index(&self, wavelength: f64) -> Complex64 {
        let k = match self.loss {
            Loss::Extinction(k) => k,
            Loss::Absorption(alpha) => extinction(alpha, wavelength),
        };
        Complex64::new(self.n, k)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::medium::absorption;

    #[test]
    fn absorption_is_the_same_at_every_wavelength() {
        let glass = Constant { n: 1.5, loss: Loss::Absorption(100.0) };
        for wavelength in [400e-9, 1e-6] {
            assert!((absorption(glass.index(wavelength), wavelength) - 100.0).abs() < 1e-12);
        }
    }
}

//! What fills a volume: complex refractive index against vacuum wavelength. One model, one file.

pub mod constant;
pub mod sellmeier;
pub mod tabulated;

use num_complex::Complex64;

pub use constant::{Constant, Loss};
pub use sellmeier::Sellmeier;
pub use tabulated::Tabulated;

/// A homogeneous isotropic medium.
pub trait Medium: Send + Sync + std::fmt::Debug {
    /// Complex index n + ik at vacuum wavelength `wavelength` (m), k >= 0 absorbs; absolute (relative to vacuum)
    /// unless the system works in air throughout.
    fn index(&self, wavelength: f64) -> Complex64;

    /// Vacuum wavelengths (m) at which the data hold; `None`: everywhere.
    fn range(&self) -> Option<[f64; 2]> {
        None
    }
}

/// Absorption coefficient alpha = 4 pi k / lambda, 1/m (Beer-Lambert: flux falls as exp(-alpha * path)).
pub fn absorption(index: Complex64, wavelength: f64) -> f64 {
    4.0 * std::f64::consts::PI * index.im / wavelength
}

//! What fills a volume: complex refractive index against vacuum wavelength. One model, one file.
//!
//! Models: [`Constant`], [`Tabulated`], [`Air`] and the formulas of [`dispersion`]. A [`Catalogued`] medium puts them together;
//! it is read from a page of refractiveindex.info ([`page`]) or an AGF catalogue ([`agf`]), or built in ([`catalog`]).
//! In a [`Turbid`] one something scatters ([`bulk`]).

// A problem of an input is built once per run.
#![allow(clippy::result_large_err)]

pub mod agf;
pub mod air;
pub mod bulk;
pub mod catalog;
pub mod catalogued;
pub mod constant;
pub mod dispersion;
pub mod page;
pub mod remembered;
pub mod tabulated;
pub mod turbid;

use num_complex::Complex64;

pub use air::Air;
pub use catalogued::Catalogued;
pub use constant::{Constant, Loss};
pub use dispersion::Sellmeier;
pub use remembered::Remembered;
pub use tabulated::Tabulated;
pub use turbid::Turbid;

/// Micrometres, which catalogues count in, per metre; divided by it, 0.55 um is the double nearest to 550e-9.
const MICROMETRES: f64 = 1e6;

/// A homogeneous isotropic medium.
pub trait Medium: Send + Sync + std::fmt::Debug {
    /// Complex index n + ik at vacuum wavelength `wavelength` (m), k >= 0 absorbs; absolute (relative to vacuum)
    /// unless the system works in air throughout.
    fn index(&self, wavelength: f64) -> Complex64;

    /// Vacuum wavelengths (m) at which the data hold; `None`: everywhere.
    fn range(&self) -> Option<[f64; 2]> {
        None
    }

    /// Vacuum wavelengths (m) of a table of the absorption alone, whose end values are held beyond; `None`: there is none.
    fn absorption_range(&self) -> Option<[f64; 2]> {
        None
    }

    /// What scatters in it.
    fn bulk(&self) -> Option<&dyn bulk::Bulk> {
        None
    }

    /// Where the data come from, if from a catalogue.
    fn origin(&self) -> Option<&str> {
        None
    }
}

/// Absorption coefficient alpha = 4 pi k / lambda, 1/m (Beer-Lambert: flux falls as exp(-alpha * path)).
pub fn absorption(index: Complex64, wavelength: f64) -> f64 {
    4.0 * std::f64::consts::PI * index.im / wavelength
}

/// Imaginary index k (dimensionless) of an absorption coefficient `alpha` (1/m) at `wavelength` (m).
pub fn extinction(alpha: f64, wavelength: f64) -> f64 {
    alpha * wavelength / (4.0 * std::f64::consts::PI)
}

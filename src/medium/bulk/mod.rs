//! Scatter inside a medium: how often, and by what angle. One model, one file.
//!
//! Light flies a distance s between two scatters with density c exp(-c s), c the scattering coefficient (1/m); its new direction
//! makes an angle with the old one whose cosine has density 2 pi p(cos), p the phase function (1/sr), and an azimuth that is uniform.
//! The integral of p over the sphere is 1. Scattered light is unpolarised.
//!
//! Source: S. Chandrasekhar, Radiative Transfer, 1950, chapter 1. Left out: polarisation, dependent scatter in dense suspensions.

mod henyey_greenstein;
mod rayleigh;
mod spectrum;
mod spheres;
mod tabulated;

use crate::math::Rng;

pub use henyey_greenstein::HenyeyGreenstein;
pub use rayleigh::Rayleigh;
pub use spectrum::Spectrum;
pub use spheres::Spheres;
pub use tabulated::{Cosines, Tabulated};

/// A scatter model of a medium. Wavelengths are those in vacuum, m.
pub trait Bulk: Send + Sync + std::fmt::Debug {
    /// Scattering coefficient, 1/m.
    fn coefficient(&self, wavelength: f64) -> f64;

    /// Absorption by what scatters, 1/m, beside that of the medium around it.
    fn absorption(&self, _wavelength: f64) -> f64 {
        0.0
    }

    /// Phase function at the cosine of the scattering angle, 1/sr: 1 is straight on.
    fn phase(&self, cosine: f64, wavelength: f64) -> f64;

    /// Draws the cosine of a scattering angle with density 2 pi `phase`.
    fn draw(&self, wavelength: f64, rng: &mut Rng) -> f64;

    /// Vacuum wavelengths (m) at which the data hold; `None`: everywhere.
    fn range(&self) -> Option<[f64; 2]> {
        None
    }
}

//! A lobe whose strength depends on the wavelength.
//!
//!     f(lambda) = F(lambda) f0   [1/sr]
//!
//! f0 the lobe, F dimensionless, linear between the entries of a table over vacuum wavelength and held outside. With a Lambertian f0
//! of reflectance 1, F is a total reflectance.
//!
//! Left out: a shape that changes with the wavelength.

use super::Bsdf;
use crate::math::Rng;
use crate::math::table::linear;
use crate::optics::Incidence;
use glam::DVec3;

/// A lobe times a spectrum.
#[derive(Clone, Debug)]
pub struct Spectral<B> {
    lobe: B,
    /// Vacuum wavelengths, m, rising.
    wavelength: Vec<f64>,
    /// F at each of them, dimensionless.
    factor: Vec<f64>,
}

impl<B: Bsdf> Spectral<B> {
    /// `lobe` times the factors (dimensionless, >= 0) at rising vacuum wavelengths (m; as many, at least one).
    pub fn new(lobe: B, wavelength: Vec<f64>, factor: Vec<f64>) -> Spectral<B> {
        Spectral { lobe, wavelength, factor }
    }

    fn factor(&self, at: &Incidence) -> f64 {
        linear(&self.wavelength, &self.factor, at.wavelength)
    }
}

impl<B: Bsdf> Bsdf for Spectral<B> {
    fn eval(&self, at: &Incidence, wo: DVec3) -> f64 {
        self.factor(at) * self.lobe.eval(at, wo)
    }

    fn pdf(&self, at: &Incidence, wo: DVec3) -> f64 {
        self.lobe.pdf(at, wo)
    }

    fn sample(&self, at: &Incidence, rng: &mut Rng) -> Option<DVec3> {
        self.lobe.sample(at, rng)
    }

    fn albedo(&self, at: &Incidence) -> f64 {
        self.factor(at) * self.lobe.albedo(at)
    }

    fn transmits(&self) -> bool {
        self.lobe.transmits()
    }
}

//! Lambertian scatter: radiance leaves equally in every direction, on the side of the light and beyond.
//!
//!     f = R / pi  reflected,   T / pi  transmitted   [1/sr]      R, T  hemispherical, dimensionless, R + T <= 1
//!
//! R and T are fractions of the incident *flux* and hold between any two media: f_t carries no n^2, the radiance T E / pi
//! fills the hemisphere of the medium it is in.
//!
//! Left out: grazing darkening of real paints (use a table); reciprocity of T between unlike media, which no single T
//! for both directions can have.
//! Source: Nicodemus et al., NBS Monograph 160 (1977), sec. VI; Ushiyama's note, eq. 10-12.

use super::Bsdf;
use crate::math::{Rng, sampling};
use crate::optics::Incidence;
use glam::DVec3;
use std::f64::consts::FRAC_1_PI;

/// Diffuse reflection and transmission.
#[derive(Clone, Copy, Debug)]
pub struct Lambertian {
    /// Hemispherical reflectance R, 0..1.
    pub reflectance: f64,
    /// Hemispherical transmittance T, 0..1-R.
    pub transmittance: f64,
}

impl Lambertian {
    /// Scattered fraction towards the side of `wo`, 0..1.
    fn towards(&self, wo: DVec3) -> f64 {
        if wo.z > 0.0 { self.reflectance } else { self.transmittance }
    }
}

impl Bsdf for Lambertian {
    fn eval(&self, _: &Incidence, wo: DVec3) -> f64 {
        self.towards(wo) * FRAC_1_PI
    }

    fn pdf(&self, _: &Incidence, wo: DVec3) -> f64 {
        let total = self.reflectance + self.transmittance;
        if total > 0.0 { self.towards(wo) / total * wo.z.abs() * FRAC_1_PI } else { 0.0 }
    }

    fn sample(&self, _: &Incidence, rng: &mut Rng) -> Option<DVec3> {
        let total = self.reflectance + self.transmittance;
        if total <= 0.0 {
            return None;
        }
        let up = sampling::cosine_hemisphere(rng.pair());
        let reflect = self.transmittance == 0.0 || rng.uniform() * total < self.reflectance;
        Some(if reflect { up } else { -up })
    }

    fn albedo(&self, _: &Incidence) -> f64 {
        self.reflectance + self.transmittance
    }

    fn transmits(&self) -> bool {
        self.transmittance > 0.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_black_surface_scatters_nothing() {
        let black = Lambertian { reflectance: 0.0, transmittance: 0.0 };
        let at = Incidence::in_air(0.3, 550e-9);
        assert!(black.sample(&at, &mut Rng::new(1, 0, 0)).is_none());
        assert_eq!(black.pdf(&at, DVec3::Z), 0.0);
    }

    #[test]
    fn an_opaque_surface_draws_two_numbers() {
        let white = Lambertian { reflectance: 1.0, transmittance: 0.0 };
        let (mut rng, mut other) = (Rng::new(1, 0, 0), Rng::new(1, 0, 0));
        white.sample(&Incidence::in_air(0.3, 550e-9), &mut rng);
        other.pair();
        assert_eq!(rng.bits(), other.bits());
    }
}

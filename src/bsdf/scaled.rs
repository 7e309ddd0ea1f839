//! A lobe at another level.
//!
//!     f = F f0   [1/sr]        F dimensionless, f0 the lobe
//!
//! Directions are drawn as the lobe draws them.

use super::{Bsdf, Weighed};
use crate::math::Rng;
use crate::optics::Incidence;
use glam::DVec3;

/// A lobe times a number.
#[derive(Debug)]
pub struct Scaled {
    pub lobe: Box<dyn Bsdf>,
    /// F, dimensionless, >= 0; with it no more light may leave than arrives.
    pub factor: f64,
}

impl Bsdf for Scaled {
    fn eval(&self, at: &Incidence, wo: DVec3) -> f64 {
        self.factor * self.lobe.eval(at, wo)
    }

    fn pdf(&self, at: &Incidence, wo: DVec3) -> f64 {
        self.lobe.pdf(at, wo)
    }

    fn weigh(&self, at: &Incidence, wo: DVec3) -> Weighed {
        let Weighed { value, density } = self.lobe.weigh(at, wo);
        Weighed { value: self.factor * value, density }
    }

    fn sample(&self, at: &Incidence, rng: &mut Rng) -> Option<DVec3> {
        self.lobe.sample(at, rng)
    }

    fn albedo(&self, at: &Incidence) -> f64 {
        self.factor * self.lobe.albedo(at)
    }

    fn anisotropic(&self) -> bool {
        self.lobe.anisotropic()
    }

    fn transmits(&self) -> bool {
        self.lobe.transmits()
    }
}

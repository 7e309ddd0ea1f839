//! The phase function of Henyey and Greenstein.
//!
//!     p(cos) = (1 - g^2) / (4 pi (1 + g^2 - 2 g cos)^(3/2)),   1/sr;   mean cosine g, -1 < g < 1
//!
//! Its cumulated distribution is inverted in closed form:  cos = (1 + g^2 - ((1 - g^2) / (1 - g + 2 g u))^2) / (2 g),
//! written so that it holds at g = 0 too. Source: L. G. Henyey, J. L. Greenstein, Astrophys. J. 93, 70 (1941).

use super::{Bulk, Spectrum};
use crate::math::Rng;
use std::f64::consts::PI;

/// Scattering coefficient (1/m) and mean cosine g.
#[derive(Clone, Debug)]
pub struct HenyeyGreenstein {
    pub coefficient: Spectrum,
    pub g: f64,
}

impl HenyeyGreenstein {
    /// The cosine below which a share `u` of the light lies.
    pub fn quantile(&self, u: f64) -> f64 {
        let (g, x) = (self.g, 2.0 * u - 1.0);
        // (1 - g^2) / (1 + g x) = 1 - g (g + x) / (1 + g x): the 1 cancels, and g divides out.
        let step = (g + x) / (1.0 + g * x);
        (step + 0.5 * g * (1.0 - step * step)).clamp(-1.0, 1.0)
    }
}

impl Bulk for HenyeyGreenstein {
    fn coefficient(&self, wavelength: f64) -> f64 {
        self.coefficient.at(wavelength)
    }

    fn phase(&self, cosine: f64, _wavelength: f64) -> f64 {
        let g = self.g;
        // 1 + g^2 - 2 g cos without loss of digits in a narrow lobe.
        let square = (1.0 - g.abs()).powi(2) + 2.0 * g.abs() * (1.0 - g.signum() * cosine);
        (1.0 - g * g) / (4.0 * PI * square * square.sqrt())
    }

    fn draw(&self, _wavelength: f64, rng: &mut Rng) -> f64 {
        self.quantile(rng.uniform())
    }

    fn range(&self) -> Option<[f64; 2]> {
        self.coefficient.range()
    }
}

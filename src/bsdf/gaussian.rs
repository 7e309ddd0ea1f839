//! A Gaussian lobe: what a diffuser of many slopes, or a hologram, makes of a ray.
//!
//!     f = n_s^2 a exp(-x^2 / sigma^2)   [1/sr]        x = |beta - beta_0| in air
//!
//! a BSDF at the specular ray, 1/sr; sigma the distance where it falls to 1/e, dimensionless; x, n_s, the horizon and the TIS as
//! of every radial lobe ([`super::radial`]): clipped, not renormalised, so the TIS falls with incidence.
//!
//!     I(x) = integral_0^x S x dx = sigma^2/2 (1 - exp(-x^2 / sigma^2))
//!
//! Check, air, normal incidence: TIS = pi a sigma^2 (1 - exp(-1 / sigma^2)).
//!
//! Left out: dependence on wavelength; polarisation.
//! Source: rotational symmetry in direction cosines as in Stover, Optical Scattering, 3rd ed. (2012), sec. 4.6.

use super::radial::{Lobe, Profile, Side};
use crate::math::Rng;

/// A Gaussian lobe.
pub type Gaussian = Lobe<Law>;

impl Gaussian {
    /// A lobe of peak `a` (1/sr, >= 0) and 1/e width `sigma` (> 0) on one side. Cost: up to 0.1 s for its table of TIS.
    pub fn new(a: f64, sigma: f64, side: Side) -> Gaussian {
        Lobe::of(a, Law { sigma }, side)
    }
}

/// S(x) = exp(-x^2 / sigma^2).
#[derive(Clone, Copy, Debug)]
pub struct Law {
    /// 1/e width, dimensionless, > 0.
    pub sigma: f64,
}

impl Profile for Law {
    fn value(&self, x: f64) -> f64 {
        (-(x / self.sigma).powi(2)).exp()
    }

    fn integral(&self, x: f64) -> f64 {
        -0.5 * self.sigma * self.sigma * (-(x / self.sigma).powi(2)).exp_m1()
    }

    /// By inversion of the integral: one number.
    fn draw(&self, reach: f64, rng: &mut Rng) -> f64 {
        let all = (-(reach / self.sigma).powi(2)).exp_m1();
        self.sigma * (-(rng.uniform() * all).ln_1p()).sqrt()
    }

    fn width(&self) -> f64 {
        self.sigma
    }

    /// Entire, but e-fold upon e-fold in ln x.
    fn steepness(&self) -> f64 {
        6.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bsdf::Bsdf;
    use crate::optics::Incidence;
    use std::f64::consts::PI;

    #[test]
    fn tis_at_normal_incidence_has_its_closed_form() {
        for sigma in [1e-6, 0.01, 0.5, 3.0f64] {
            let closed = -PI * sigma * sigma * (-1.0 / (sigma * sigma)).exp_m1();
            let tis = Gaussian::new(1.0, sigma, Side::Reflect).albedo(&Incidence::in_air(0.0, 550e-9));
            assert!((tis / closed - 1.0).abs() < 1e-8, "{sigma}");
        }
    }

    #[test]
    fn half_of_a_narrow_lobe_is_left_at_the_horizon() {
        let lobe = Gaussian::new(1.0, 1e-4, Side::Reflect);
        let tis = lobe.albedo(&Incidence::in_air(std::f64::consts::FRAC_PI_2, 550e-9));
        // The horizon's curvature takes sigma / (2 sqrt(pi)) of it.
        assert!((tis / (PI * 1e-8) - 0.5).abs() < 5e-5, "{tis}");
    }
}

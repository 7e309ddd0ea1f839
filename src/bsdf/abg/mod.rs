//! The ABg model: scatter of polished and of many black surfaces as a power law about the specular direction.
//!
//!     f = n_s^2 A / (B + x^g)   [1/sr]        x = |n_s beta_s - n_s beta_0|,   n_s beta_0 = -n_i wi_xy
//!
//! B and g dimensionless, A in 1/sr; x, n_s, the horizon and the TIS as of every radial lobe ([`super::radial`]).
//! From air to air n_s = 1: f = A / (B + |beta - beta_0|^g).
//! A, B and g are taken as they stand on either side: the dependence of A on the index step (as (n_t - n_i)^2) is not put in.
//!
//! Check, air, normal incidence: g = 2: pi A ln(1 + 1/B);  g = 1: 2 pi A (1 - B ln(1 + 1/B)).
//!
//! Left out: scaling with wavelength (right for polish only); the measured range of the fit; polarisation.
//! Source: Stover, Optical Scattering, 3rd ed. (2012), sec. 4.6; Fest, Stray Light Analysis and Control (2013), sec. 4.1.4.

mod law;

use super::radial::{Lobe, Side};

pub use law::Law;

/// An ABg lobe.
pub type Abg = Lobe<Law>;

impl Abg {
    /// A lobe of `a` (1/sr, >= 0), `b` (> 0) and `g` (>= 0) on one side. Cost: up to 0.1 s for its table of TIS.
    pub fn new(a: f64, b: f64, g: f64, side: Side) -> Abg {
        Lobe::of(a, Law::new(b, g), side)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bsdf::Bsdf;
    use crate::optics::Incidence;
    use glam::DVec3;
    use std::f64::consts::TAU;

    fn in_air(a: f64, b: f64, g: f64, theta: f64) -> (Abg, Incidence) {
        (Abg::new(a, b, g, Side::Reflect), Incidence::in_air(theta, 550e-9))
    }

    #[test]
    fn tis_at_normal_incidence_has_its_closed_forms() {
        for b in [1e-9, 1e-4, 0.02, 3.0] {
            let (lobe, at) = in_air(1e-3, b, 2.0, 0.0);
            let closed = std::f64::consts::PI * 1e-3 * (1.0 / b).ln_1p();
            assert!((lobe.albedo(&at) / closed - 1.0).abs() < 1e-8, "g = 2, B = {b}");
            let (lobe, at) = in_air(1e-3, b, 1.0, 0.0);
            let closed = TAU * 1e-3 * (1.0 - b * (1.0 / b).ln_1p());
            assert!((lobe.albedo(&at) / closed - 1.0).abs() < 1e-8, "g = 1, B = {b}");
        }
    }

    #[test]
    fn g_of_zero_is_lambertian() {
        for theta in [0.0, 0.7, 1.4] {
            let (lobe, at) = in_air(0.2, 0.5, 0.0, theta);
            assert!((lobe.eval(&at, DVec3::Z) - 0.2 / 1.5).abs() < 1e-15);
            assert!((lobe.albedo(&at) / (std::f64::consts::PI * 0.2 / 1.5) - 1.0).abs() < 1e-7);
        }
    }

    #[test]
    fn a_lobe_a_microradian_wide_keeps_its_digits() {
        // B = 1e-12, g = 2: half the peak at x = 1e-6.
        let (lobe, at) = in_air(1.0, 1e-12, 2.0, 0.5);
        let wo =
            DVec3::new(-(0.5f64.sin()) + 1e-6, 0.0, (0.5f64.sin() - 1e-6).mul_add(-(0.5f64.sin() - 1e-6), 1.0).sqrt());
        assert!((lobe.eval(&at, wo) / 5e11 - 1.0).abs() < 1e-9);
    }
}

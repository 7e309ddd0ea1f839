//! The ABg model: scatter of polished and of many black surfaces as a power law about the specular direction.
//!
//!     f = n_s^2 A / (B + x^g)   [1/sr]        x = |n_s beta_s - n_s beta_0|,   n_s beta_0 = -n_i wi_xy
//!
//! beta projection of a unit direction on the surface; beta_0 that of the specular ray (reflected; for `side`
//! [`Side::Transmit`] refracted, or what Snell's law says of it beyond the critical angle); n_i, n_s (real) indices of the
//! media light comes from and scatters into. x is the grating equation's transverse wave number per vacuum wavelength; it
//! is dimensionless, as are B and g. A in 1/sr. From air to air n_s = 1: f = A / (B + |beta - beta_0|^g).
//! In glass the same surface spectrum fills a cone narrower by n_s, hence n_s^2: f_it / n_t^2 = f_ti / n_i^2, reciprocal.
//! A, B and g are taken as they stand on either side: the dependence of A on the index step (as (n_t - n_i)^2) is not put in.
//!
//! Scattered / incident flux, clipped by the horizon and never renormalised:
//!
//!     TIS(beta_0) = integral over |q| < n_s of A / (B + |q - n_s beta_0|^g) d^2 q,   q = n_s beta_s
//!
//! Check, air, normal incidence: g = 2: pi A ln(1 + 1/B);  g = 1: 2 pi A (1 - B ln(1 + 1/B)).
//!
//! Left out: scaling with wavelength (right for polish only); the measured range of the fit; polarisation.
//! Source: Stover, Optical Scattering, 3rd ed. (2012), sec. 4.6 and 2.3; Fest, Stray Light Analysis and Control (2013), sec. 4.1.4.

mod radial;
mod tis;

use super::Bsdf;
use crate::math::Rng;
use crate::optics::Incidence;
use glam::{DVec2, DVec3};
use radial::Radial;
use std::f64::consts::TAU;
use tis::Tis;

/// The half space a lobe scatters into.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// Back to where the light comes from.
    Reflect,
    /// Through the surface.
    Transmit,
}

/// An ABg lobe.
#[derive(Clone, Debug)]
pub struct Abg {
    a: f64,
    side: Side,
    radial: Radial,
    tis: Tis,
}

/// What both directions of an event have in common: q0 = n_s beta_0, and n_s.
struct Event {
    specular: DVec2,
    index: f64,
}

impl Event {
    /// Largest x that any direction has.
    fn reach(&self) -> f64 {
        self.index + self.specular.length()
    }
}

impl Abg {
    /// A lobe of `a` (1/sr, >= 0), `b` (> 0) and `g` (>= 0) on one side. Cost: up to 0.1 s for its table of TIS.
    pub fn new(a: f64, b: f64, g: f64, side: Side) -> Abg {
        let radial = Radial::new(b, g);
        let tis = Tis::new(&radial, side);
        Abg { a, side, radial, tis }
    }

    fn event(&self, at: &Incidence) -> Event {
        let beyond = match self.side {
            Side::Reflect => at.index[0],
            Side::Transmit => at.index[1],
        };
        Event { specular: at.wi.truncate() * -at.index[0].re, index: beyond.re }
    }

    /// 1 / (B + x^g) of a direction on this lobe's side, 0 on the other.
    fn shape(&self, event: &Event, wo: DVec3) -> f64 {
        if (wo.z > 0.0) != (self.side == Side::Reflect) {
            return 0.0;
        }
        // Components are subtracted before anything is squared: x keeps its digits next to the specular ray.
        self.radial.value((wo.truncate() * event.index - event.specular).length())
    }
}

impl Bsdf for Abg {
    fn eval(&self, at: &Incidence, wo: DVec3) -> f64 {
        let event = self.event(at);
        event.index * event.index * self.a * self.shape(&event, wo)
    }

    /// Proportional to eval |cos|: n_s^2 |cos| S(x) / (2 pi integral_0^reach S x dx).
    fn pdf(&self, at: &Incidence, wo: DVec3) -> f64 {
        let event = self.event(at);
        let total = TAU * self.radial.integral(event.reach());
        event.index * event.index * wo.z.abs() * self.shape(&event, wo) / total
    }

    /// x from its radial law up to the farthest horizon, azimuth about the specular ray uniform; beyond the horizon: `None`.
    fn sample(&self, at: &Incidence, rng: &mut Rng) -> Option<DVec3> {
        let event = self.event(at);
        let x = self.radial.draw(event.reach(), rng);
        let (sin, cos) = (TAU * rng.uniform()).sin_cos();
        let q = event.specular + DVec2::new(x * cos, x * sin);
        let (n, length) = (event.index, q.length());
        if length >= n {
            return None;
        }
        let z = ((n - length) * (n + length)).sqrt();
        Some(q.extend(if self.side == Side::Reflect { z } else { -z }) / n)
    }

    fn albedo(&self, at: &Incidence) -> f64 {
        let event = self.event(at);
        self.a * self.tis.at(&self.radial, event.specular.length(), event.index)
    }

    fn transmits(&self) -> bool {
        self.side == Side::Transmit
    }
}

#[cfg(test)]
mod tests {
    use super::*;

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

//! Lobes that depend on one distance: that of the scattered from the specular direction, projected on the surface.
//!
//!     f = n_s^2 a S(x)   [1/sr]        x = |n_s beta_s - n_s beta_0|,   n_s beta_0 = -n_i wi_xy
//!
//! beta projection of a unit direction on the surface; beta_0 that of the specular ray (reflected; for [`Side::Transmit`]
//! refracted, or what Snell's law says of it beyond the critical angle); n_i, n_s (real) indices of the media light comes from
//! and scatters into. x is the grating equation's transverse wave number per vacuum wavelength, dimensionless; a in the unit
//! that makes a S 1/sr. In glass the same surface spectrum fills a cone narrower by n_s, hence n_s^2:
//! f_it / n_t^2 = f_ti / n_i^2, reciprocal.
//!
//! Scattered / incident flux, clipped by the horizon and never renormalised:
//!
//!     TIS(beta_0) = a integral over |q| < n_s of S(|q - n_s beta_0|) d^2 q,   q = n_s beta_s
//!
//! Draws follow f |cos| itself: x from S x up to the farthest horizon, azimuth uniform; what falls beyond the horizon is no
//! direction, so that every draw carries the same weight.
//!
//! Left out: scaling with wavelength (right for polish only, see `polish`); polarisation.
//! Source: Stover, Optical Scattering, 3rd ed. (2012), sec. 2.3.

mod tis;

use super::{Bsdf, Weighed};
use crate::math::{Rng, sampling};
use crate::optics::Incidence;
use glam::{DVec2, DVec3};
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

impl Side {
    /// True if `wo` (local, away from the surface) lies in this half space.
    pub fn holds(self, wo: DVec3) -> bool {
        (wo.z > 0.0) == (self == Side::Reflect)
    }
}

/// The shape S(x) of a lobe, x >= 0 dimensionless.
pub trait Profile: Send + Sync + std::fmt::Debug {
    /// S(x), > 0.
    fn value(&self, x: f64) -> f64;

    /// I(x) = integral_0^x S x' dx', relative error below 1e-8.
    fn integral(&self, x: f64) -> f64;

    /// Draws x in [0, `reach`) with density S x / I(reach).
    fn draw(&self, reach: f64, rng: &mut Rng) -> f64;

    /// About where S begins to fall.
    fn width(&self) -> f64;

    /// Panels of 16-point quadrature that S wants per unit of ln x.
    fn steepness(&self) -> f64;
}

/// A lobe of shape `P`.
#[derive(Clone, Debug)]
pub struct Lobe<P> {
    a: f64,
    side: Side,
    profile: P,
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

impl<P: Profile> Lobe<P> {
    /// A lobe a S(x) on one side. Cost: up to 0.1 s for its table of TIS.
    pub(super) fn of(a: f64, profile: P, side: Side) -> Lobe<P> {
        let tis = Tis::new(&profile, side);
        Lobe { a, side, profile, tis }
    }

    fn event(&self, at: &Incidence) -> Event {
        let beyond = match self.side {
            Side::Reflect => at.index[0],
            Side::Transmit => at.index[1],
        };
        Event { specular: at.wi.truncate() * -at.index[0].re, index: beyond.re }
    }

    /// S(x) of a direction on this lobe's side, 0 on the other.
    fn shape(&self, event: &Event, wo: DVec3) -> f64 {
        if !self.side.holds(wo) {
            return 0.0;
        }
        // Components are subtracted before anything is squared: x keeps its digits next to the specular ray.
        self.profile.value((wo.truncate() * event.index - event.specular).length())
    }
}

impl<P: Profile> Bsdf for Lobe<P> {
    fn eval(&self, at: &Incidence, wo: DVec3) -> f64 {
        let event = self.event(at);
        event.index * event.index * self.a * self.shape(&event, wo)
    }

    fn pdf(&self, at: &Incidence, wo: DVec3) -> f64 {
        self.weigh(at, wo).density
    }

    /// The density is proportional to eval |cos|: n_s^2 |cos| S(x) / (2 pi integral_0^reach S x dx).
    fn weigh(&self, at: &Incidence, wo: DVec3) -> Weighed {
        let event = self.event(at);
        let shape = event.index * event.index * self.shape(&event, wo);
        let total = TAU * self.profile.integral(event.reach());
        Weighed { value: self.a * shape, density: wo.z.abs() * shape / total }
    }

    fn sample(&self, at: &Incidence, rng: &mut Rng) -> Option<DVec3> {
        let event = self.event(at);
        let x = self.profile.draw(event.reach(), rng);
        direction(event.specular, event.index, x, self.side, rng.uniform())
    }

    fn albedo(&self, at: &Incidence) -> f64 {
        let event = self.event(at);
        self.a * self.tis.at(&self.profile, event.specular.length(), event.index)
    }

    fn transmits(&self) -> bool {
        self.side == Side::Transmit
    }
}

/// The direction at distance `x` and azimuth `turn` (turns) from `specular` in the plane q = n beta; `None` beyond the horizon.
pub(super) fn direction(specular: DVec2, n: f64, x: f64, side: Side, turn: f64) -> Option<DVec3> {
    let (sin, cos) = sampling::sin_cos_of_turn(turn);
    let q = specular + DVec2::new(x * cos, x * sin);
    let length = q.length();
    if length >= n {
        return None;
    }
    let z = ((n - length) * (n + length)).sqrt();
    Some(q.extend(if side == Side::Reflect { z } else { -z }) / n)
}

//! A power of the cosine about a ray: a glossy lobe about the specular direction, or a retroreflector's about the source.
//!
//!     f = a cos^n(alpha)   [1/sr],   0 for alpha > 90 deg        alpha angle of wo to the axis, rad
//!
//! axis the specularly reflected ray, or the way back to the source; never the normal, about which no n > 0 is reciprocal.
//! a BRDF on the axis, 1/sr; n >= 0, dimensionless. cos(alpha) = axis(wi).wo is symmetric in wi and wo: f is reciprocal.
//!
//! Scattered / incident flux, clipped by the horizon and never renormalised; the same about both axes, which lie at theta_i:
//!
//!     TIS = a integral_0^(pi/2) cos^n(alpha) sin(alpha) c(alpha) dalpha
//!     c = 2 (u phi + w sin(phi)),  u = cos(alpha) cos(theta_i),  w = sin(alpha) sin(theta_i),  phi = arccos(-u/w), pi if u > w
//!
//! Check, normal incidence: TIS = 2 pi a / (n + 2). Draws follow the cosine's power; the weight is in proportion to cos(theta_s),
//! and what falls below the horizon is no direction.
//!
//! Left out: the off-specular peak of rough surfaces at grazing incidence (see `microfacet`); transmission; wavelength.
//! Source: Phong, Comm. ACM 18, 311 (1975), in the form of Lewis, Computer Graphics Forum 13(2), 109 (1994).

use super::Bsdf;
use crate::math::Rng;
use crate::math::quadrature::GaussLegendre;
use crate::math::table::Even;
use crate::optics::{Incidence, refraction};
use glam::DVec3;
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// What the lobe surrounds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Axis {
    /// The specularly reflected ray.
    Specular,
    /// The way back to where the light came from.
    Source,
}

/// A lobe cos^n about an axis.
#[derive(Clone, Debug)]
pub struct CosinePower {
    a: f64,
    n: f64,
    axis: Axis,
    /// TIS / a over theta_i, sr.
    tis: Even,
}

impl CosinePower {
    /// A lobe of peak `a` (1/sr, >= 0) and power `n` (>= 0). Cost: up to 20 ms for its table of TIS.
    pub fn new(a: f64, n: f64, axis: Axis) -> CosinePower {
        let rule = GaussLegendre::new(32);
        // Steps of 1/60 of the lobe's width 1/sqrt(n + 2): the cubics then err by less than 1e-8 of the whole.
        let count = 64.0 + 100.0 * (n + 2.0).sqrt();
        let tis = Even::new(0.0, FRAC_PI_2, count.min(2e4) as usize, |theta| integrate(&rule, n, theta));
        CosinePower { a, n, axis, tis }
    }

    fn axis(&self, wi: DVec3) -> DVec3 {
        match self.axis {
            Axis::Specular => refraction::reflect(wi),
            Axis::Source => wi,
        }
    }

    /// cos^n(alpha); near the axis from the chord, so that narrow lobes keep their digits.
    fn shape(&self, wi: DVec3, wo: DVec3) -> f64 {
        let sine = 0.25 * (wo - self.axis(wi)).length_squared(); // sin^2(alpha/2)
        if wo.z <= 0.0 || sine >= 0.5 { 0.0 } else { (self.n * (-2.0 * sine).ln_1p()).exp() }
    }
}

impl Bsdf for CosinePower {
    fn eval(&self, at: &Incidence, wo: DVec3) -> f64 {
        self.a * self.shape(at.wi, wo)
    }

    fn pdf(&self, at: &Incidence, wo: DVec3) -> f64 {
        (self.n + 1.0) / TAU * self.shape(at.wi, wo)
    }

    fn sample(&self, at: &Incidence, rng: &mut Rng) -> Option<DVec3> {
        // cos^(n+1) is even in 0..1; 1 - cos without a difference.
        let h = -(rng.positive().ln() / (self.n + 1.0)).exp_m1();
        let (sin, cos) = (TAU * rng.uniform()).sin_cos();
        let radius = (h * (2.0 - h)).sqrt();
        let axis = self.axis(at.wi);
        let (x, y) = axis.any_orthonormal_pair();
        let wo = axis * (1.0 - h) + radius * (cos * x + sin * y);
        (wo.z > 0.0).then_some(wo)
    }

    fn albedo(&self, at: &Incidence) -> f64 {
        self.a * self.tis.at(at.wi.truncate().length().atan2(at.cos()))
    }
}

/// TIS / a, sr: Gauss-Legendre on both sides of alpha = 90 deg - theta, where the horizon begins to cut, with the ends drawn out by a cosine.
fn integrate(rule: &GaussLegendre, n: f64, theta: f64) -> f64 {
    let (sin, cos) = theta.sin_cos();
    let ring = |alpha: f64| {
        let (u, w) = (alpha.cos() * cos, alpha.sin() * sin);
        let phi = if u >= w { PI } else { (-u / w).acos() };
        (n * alpha.cos().ln()).exp() * alpha.sin() * 2.0 * (u * phi + w * phi.sin())
    };
    // cos^n is below 1e-16 beyond 8.6 / sqrt(n).
    let end = FRAC_PI_2.min(9.0 / n.max(1e-9).sqrt());
    let cut = (FRAC_PI_2 - theta).clamp(0.0, end);
    let piece = |from: f64, to: f64| {
        let (mid, half) = (0.5 * (from + to), 0.5 * (to - from));
        let value = |t: f64| ring(mid - half * t.cos()) * half * t.sin();
        rule.integrate(0.0, FRAC_PI_2, value) + rule.integrate(FRAC_PI_2, PI, value)
    };
    piece(0.0, cut) + piece(cut, end)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tis_at_normal_incidence_has_its_closed_form() {
        for n in [0.0, 1.0, 7.5, 400.0, 1e6] {
            let tis = CosinePower::new(0.3, n, Axis::Specular).albedo(&Incidence::in_air(0.0, 550e-9));
            assert!((tis / (TAU * 0.3 / (n + 2.0)) - 1.0).abs() < 1e-7, "{n}: {tis}");
        }
    }

    #[test]
    fn the_table_is_the_integral() {
        let rule = GaussLegendre::new(80);
        for n in [0.0, 3.0, 50.0, 2e4] {
            let lobe = CosinePower::new(1.0, n, Axis::Source);
            for theta in [0.001, 0.3, 1.0, 1.5, 1.57] {
                let direct = integrate(&rule, n, theta);
                let tis = lobe.albedo(&Incidence::in_air(theta, 550e-9));
                assert!((tis / direct - 1.0).abs() < 1e-6, "{n} {theta}: {tis} {direct}");
            }
        }
    }
}

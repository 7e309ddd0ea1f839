//! Oren-Nayar: a rough matt surface, made of Lambertian facets of Gaussian slopes. It throws light back towards the source.
//!
//!     f = rho/pi (A + B max(0, cos(phi_i - phi_s)) sin(alpha) tan(beta))   [1/sr]
//!     A = 1 - sigma^2 / (2 (sigma^2 + 0.33)),   B = 0.45 sigma^2 / (sigma^2 + 0.09)
//!
//! rho reflectance of the facets, 0..1; sigma rms slope angle, rad; alpha the larger, beta the smaller of theta_i and theta_s;
//! phi azimuths of directions that point away, so that B is the side of the source. f is reciprocal. sigma = 0 is Lambertian.
//!
//! Energy: the fit of its authors loses light at normal incidence and gains a little at grazing,
//!
//!     TIS / rho = A + 2B/pi (sin_i (theta_i - sin_i cos_i)/2 + tan_i (1 - sin_i^3)/3),   A at 0, A + B/2 at 90 deg
//!
//! at most 1.016 (sigma = 0.19 rad, 90 deg): a rho above 0.98 may send off more than arrives, which is refused where it does.
//!
//! Draws follow f cos itself: the first term from the cosine, the second from its marginals in azimuth and theta.
//!
//! Left out: light that bounces between facets (in 0.33 on the average only); the specular part; transmission.
//! Source: Oren & Nayar, "Generalization of Lambert's reflectance model", SIGGRAPH 1994, eq. 30 (the qualitative model).

use super::Bsdf;
use crate::math::{Rng, sampling};
use crate::optics::Incidence;
use glam::DVec3;
use std::f64::consts::FRAC_1_PI;

/// A rough diffuse reflector.
#[derive(Clone, Copy, Debug)]
pub struct OrenNayar {
    reflectance: f64,
    a: f64,
    b: f64,
}

impl OrenNayar {
    /// Facets of `reflectance` (0..1) and rms slope angle `sigma` (rad, >= 0).
    pub fn new(reflectance: f64, sigma: f64) -> OrenNayar {
        let square = sigma * sigma;
        OrenNayar { reflectance, a: 1.0 - 0.5 * square / (square + 0.33), b: 0.45 * square / (square + 0.09) }
    }

    /// pi f / rho.
    fn shape(&self, wi: DVec3, wo: DVec3) -> f64 {
        let (across, product) = (wi.x * wo.x + wi.y * wo.y, wi.z.max(wo.z));
        // sin(alpha) tan(beta) cos(phi) = sin_i sin_s cos(phi) / cos(beta), and beta has the larger cosine.
        self.a + self.b * across.max(0.0) / product
    }

    /// TIS / rho of the second term, over B.
    fn second(&self, wi: DVec3) -> f64 {
        let (sin, cos) = (wi.truncate().length(), wi.z);
        let theta = sin.atan2(cos);
        // tan (1 - sin^3) with 1 - sin^3 = cos^2 (1 + sin + sin^2) / (1 + sin).
        let beyond = sin * cos * (1.0 + sin + sin * sin) / (1.0 + sin) / 3.0;
        2.0 * FRAC_1_PI * (0.5 * sin * (theta - sin * cos) + beyond)
    }
}

impl Bsdf for OrenNayar {
    fn eval(&self, at: &Incidence, wo: DVec3) -> f64 {
        if wo.z <= 0.0 { 0.0 } else { self.reflectance * FRAC_1_PI * self.shape(at.wi, wo) }
    }

    fn pdf(&self, at: &Incidence, wo: DVec3) -> f64 {
        if wo.z <= 0.0 {
            return 0.0;
        }
        self.shape(at.wi, wo) * wo.z * FRAC_1_PI / (self.a + self.b * self.second(at.wi))
    }

    fn sample(&self, at: &Incidence, rng: &mut Rng) -> Option<DVec3> {
        let second = self.b * self.second(at.wi);
        Some(match rng.uniform() * (self.a + second) < second {
            true => towards_source(at.wi, rng),
            false => sampling::cosine_hemisphere(rng.pair()),
        })
    }

    fn albedo(&self, at: &Incidence) -> f64 {
        self.reflectance * (self.a + self.b * self.second(at.wi))
    }
}

/// Draws with density in proportion to max(0, cos(phi)) sin(alpha) tan(beta) cos(theta_s): sin(phi) is even in -1..1, and theta_s
/// goes as sin^2 below theta_i, as sin^2 cos above.
fn towards_source(wi: DVec3, rng: &mut Rng) -> DVec3 {
    let (sin, cos) = (wi.truncate().length(), wi.z);
    let theta = sin.atan2(cos);
    let below = 0.5 * sin * (theta - sin * cos);
    let beyond = sin * cos * (1.0 + sin + sin * sin) / (1.0 + sin) / 3.0;
    let s = if rng.uniform() * (below + beyond) < below {
        below_incidence(theta, rng).sin()
    } else {
        let cube = sin.powi(3);
        (cube + rng.uniform() * (1.0 - cube)).cbrt()
    };
    let across = 2.0 * rng.uniform() - 1.0;
    let along = ((1.0 - across) * (1.0 + across)).sqrt();
    // The azimuth of the source; there is none at normal incidence, where this term is never drawn.
    let x = wi.truncate() / sin;
    let q = s * (along * x + across * x.perp());
    q.extend(((1.0 - s) * (1.0 + s)).max(f64::MIN_POSITIVE).sqrt())
}

/// An angle in 0..`theta` (at most pi/2) with density in proportion to sin^2: drawn as its square and thinned by (sin x / x)^2 >= 0.4.
fn below_incidence(theta: f64, rng: &mut Rng) -> f64 {
    loop {
        let x = theta * rng.positive().cbrt();
        if rng.uniform() < (x.sin() / x).powi(2) {
            return x;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn without_slopes_it_is_lambertian() {
        let flat = OrenNayar::new(0.7, 0.0);
        let at = Incidence::in_air(1.2, 550e-9);
        assert_eq!(flat.eval(&at, DVec3::new(0.6, 0.0, 0.8)), 0.7 * FRAC_1_PI);
        assert_eq!(flat.albedo(&at), 0.7);
    }

    #[test]
    fn its_energy_is_bounded_as_stated() {
        let mut most: f64 = 0.0;
        for sigma in (0..=150).map(|k| 0.01 * f64::from(k)) {
            let model = OrenNayar::new(1.0, sigma);
            for theta in (0..=90).map(|k| f64::from(k).to_radians()) {
                most = most.max(model.albedo(&Incidence::in_air(theta, 550e-9)));
            }
        }
        assert!((most - 1.016).abs() < 1e-3, "{most}");
    }
}

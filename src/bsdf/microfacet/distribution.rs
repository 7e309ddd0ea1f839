//! Distributions of the normals of a rough surface, with Smith's shadowing and the normals that a direction sees.
//!
//!     GGX        D = alpha^2 / (pi (cos^2 (alpha^2 - 1) + 1)^2),       Lambda = (sqrt(1 + alpha^2 tan^2) - 1) / 2
//!     Beckmann   D = exp(-tan^2 / alpha^2) / (pi alpha^2 cos^4),       Lambda = (exp(-a^2) / (a sqrt(pi)) - erfc(a)) / 2
//!     a = 1 / (alpha tan(theta))
//!
//! D per sr of the angle of the facet's normal m to that of the surface, integral of D cos = 1; alpha the roughness itself (sqrt(2) times
//! the rms slope of Beckmann), not its root. A direction w sees the normals with density
//!
//!     D_w(m) = max(0, w.m) D(m) / (cos_w (1 + Lambda(w)))   [1/sr]
//!
//! Sources: Walter, Marschner, Li & Torrance, EGSR 2007 (D); Heitz, JCGT 3(2), 48 (2014) (Lambda, D_w); Dupuy & Benyoub, CGF 42(8) (2023):
//! the normals that GGX shows are halves between w and a spherical cap. Beckmann's slopes are normal deviates, so those across
//! w are independent of it and those along it have a distribution function in closed form, inverted by Newton's method.

use crate::math::quadrature::GaussLegendre;
use crate::math::statistics::{erfc, inverse_erf};
use glam::DVec3;
use std::f64::consts::{FRAC_1_PI, PI, TAU};

/// The law of the normals.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Distribution {
    /// Long-tailed: ground and etched glass.
    Ggx,
    /// Gaussian slopes.
    Beckmann,
}

/// Gaussian slopes of more than this times alpha/sqrt(2) are left out of quadratures: exp(-4.8^2) = 1e-10.
const STEEPEST: f64 = 4.8;

impl Distribution {
    /// D(m), 1/sr, at `m` with m.z > 0.
    pub fn density(self, alpha: f64, m: DVec3) -> f64 {
        let square = m.z * m.z;
        let tan2 = (m.x * m.x + m.y * m.y) / square;
        let (a2, t) = (alpha * alpha, tan2 / (alpha * alpha));
        match self {
            Distribution::Ggx => FRAC_1_PI / (a2 * square * square * (1.0 + t) * (1.0 + t)),
            Distribution::Beckmann => FRAC_1_PI * (-t).exp() / (a2 * square * square),
        }
    }

    /// Lambda(w), >= 0, of a direction on either side.
    pub fn lambda(self, alpha: f64, w: DVec3) -> f64 {
        let slope = alpha * w.truncate().length() / w.z.abs(); // 1 / a
        match self {
            _ if slope < 1e-12 => 0.0,
            Distribution::Ggx => 0.5 * slope * slope / (1.0 + (1.0 + slope * slope).sqrt()),
            Distribution::Beckmann => {
                let a = 1.0 / slope;
                (0.5 * ((-a * a).exp() * slope / PI.sqrt() - erfc(a))).max(0.0)
            }
        }
    }

    /// A normal drawn from those that `w` (w.z > 0) sees.
    pub fn draw(self, alpha: f64, w: DVec3, [u, v]: [f64; 2]) -> DVec3 {
        match self {
            Distribution::Ggx => {
                let cap = stretched(alpha, w);
                let (sin, cos) = (TAU * v).sin_cos();
                let z = (1.0 - u) * (1.0 + cap.z) - cap.z;
                let r = ((1.0 - z) * (1.0 + z)).max(0.0).sqrt();
                facet(alpha, DVec3::new(r * cos, r * sin, z) + cap)
            }
            Distribution::Beckmann => {
                // Slopes in units of alpha: across, a normal deviate of variance 1/2.
                let across = inverse_erf(2.0 * v - 1.0);
                slopes(alpha, w, along(1.0 / tangent(alpha, w), u), across)
            }
        }
    }

    /// Mean of `f` over the normals that `w` sees, even in the side of the plane of incidence. `f` may have kinks and steps where
    /// `regime` changes.
    pub fn mean(
        self,
        alpha: f64,
        w: DVec3,
        rules: &Rules,
        regime: impl Fn(DVec3) -> u8,
        f: impl Fn(DVec3) -> f64,
    ) -> f64 {
        let line = |from: f64, to: f64, m: &dyn Fn(f64) -> DVec3, density: &dyn Fn(f64) -> f64| {
            rules.pieces(from, to, |x| regime(m(x)), |x| density(x) * f(m(x)))
        };
        match self {
            Distribution::Ggx => {
                let cap = stretched(alpha, w);
                let towards = azimuth(w);
                let end = (-cap.z).acos();
                let ray = |(sin, cos): (f64, f64)| {
                    let across = towards * cos + towards.perp() * sin;
                    line(0.0, end, &|t| facet(alpha, (across * t.sin()).extend(t.cos()) + cap), &f64::sin)
                };
                let all: f64 = rules.turns.iter().copied().map(ray).sum();
                all / rules.turns.len() as f64 / (1.0 + cap.z)
            }
            Distribution::Beckmann => {
                let t = 1.0 / tangent(alpha, w);
                let total = cumulated(t, f64::INFINITY);
                let row = |y: f64| {
                    let density = |x: f64| (t + x) / total * (-x * x).exp();
                    (-y * y).exp() * line((-t).max(-STEEPEST), STEEPEST, &|x| slopes(alpha, w, x, y), &density)
                };
                2.0 / PI.sqrt() * rules.across.integrate(0.0, STEEPEST, row)
            }
        }
    }
}

/// Quadrature over normals: along a line, across it, and over half a turn.
#[derive(Clone, Debug)]
pub struct Rules {
    along: GaussLegendre,
    across: GaussLegendre,
    /// Sines and cosines at the middles of equal steps of half a turn.
    turns: Vec<(f64, f64)>,
}

/// Places between which a regime is looked for.
const PROBES: usize = 16;

impl Rules {
    /// `n` points along, 3 `n` across, where kinks are not looked for, and 2 `n` turns.
    pub fn new(n: usize) -> Rules {
        let turn = |k: usize| (PI * (k as f64 + 0.5) / (2 * n) as f64).sin_cos();
        Rules { along: GaussLegendre::new(n), across: GaussLegendre::new(3 * n), turns: (0..2 * n).map(turn).collect() }
    }

    /// Integral of `f` from `from` to `to`, taken apart where `regime` changes; roots at the ends of a piece are drawn out by a cosine.
    fn pieces(&self, from: f64, to: f64, regime: impl Fn(f64) -> u8, f: impl Fn(f64) -> f64) -> f64 {
        let piece = |a: f64, b: f64| {
            let (mid, half) = (0.5 * (a + b), 0.5 * (b - a));
            self.along.integrate(0.0, PI, |t| f(mid - half * t.cos()) * half * t.sin())
        };
        let place = |k: usize| from + (to - from) * k as f64 / PROBES as f64;
        // Just inside, where the regime is that of the interval.
        let probe = |k: usize| regime(place(k).clamp(from + 1e-9 * (to - from), to - 1e-9 * (to - from)));
        let (mut sum, mut start, mut now) = (0.0, from, probe(0));
        for k in 1..=PROBES {
            let next = probe(k);
            if next != now {
                let (mut low, mut high) = (place(k - 1), place(k));
                for _ in 0..40 {
                    let middle = 0.5 * (low + high);
                    if regime(middle) == now { low = middle } else { high = middle }
                }
                sum += piece(start, low);
                (start, now) = (high, next);
            }
        }
        sum + piece(start, to)
    }
}

/// The direction in the surface that `w` leans to; any for the normal.
fn azimuth(w: DVec3) -> glam::DVec2 {
    w.truncate().try_normalize().unwrap_or(glam::DVec2::X)
}

/// alpha tan(theta), kept above 0.
fn tangent(alpha: f64, w: DVec3) -> f64 {
    (alpha * w.truncate().length() / w.z).max(1e-13)
}

/// `w` seen on the surface stretched to roughness 1.
fn stretched(alpha: f64, w: DVec3) -> DVec3 {
    DVec3::new(alpha * w.x, alpha * w.y, w.z).normalize()
}

/// The facet that a normal on the stretched surface belongs to.
fn facet(alpha: f64, h: DVec3) -> DVec3 {
    DVec3::new(alpha * h.x, alpha * h.y, h.z.max(f64::MIN_POSITIVE)).normalize()
}

/// The normal that leans by `x` towards `w` and by `y` across, in units of alpha.
fn slopes(alpha: f64, w: DVec3, x: f64, y: f64) -> DVec3 {
    let towards = azimuth(w);
    (alpha * (x * towards + y * towards.perp())).extend(1.0).normalize()
}

/// Integral of (t + x) exp(-x^2) from -t to `x`.
fn cumulated(t: f64, x: f64) -> f64 {
    // erf(x) + erf(t) = erfc(-x) - erfc(t) without the loss where both are near 1 in size.
    0.5 * t * PI.sqrt() * (erfc(-x) - erfc(t)) + 0.5 * ((-t * t).exp() - (-x * x).exp())
}

/// The slope along the plane of incidence whose distribution function, density in proportion to max(0, t + x) exp(-x^2), is `u`.
fn along(t: f64, u: f64) -> f64 {
    let wanted = u * cumulated(t, f64::INFINITY);
    let (mut low, mut high) = ((-t).max(-6.5), 6.5f64);
    let mut x = 0.5 * (low + high.min(1.0));
    for _ in 0..80 {
        let excess = cumulated(t, x) - wanted;
        if excess > 0.0 {
            high = x
        } else {
            low = x
        }
        let slope = (t + x) * (-x * x).exp();
        let step = x - excess / slope;
        let next = if step > low && step < high { step } else { 0.5 * (low + high) };
        if (next - x).abs() < 1e-14 * (1.0 + x.abs()) {
            return next;
        }
        x = next;
    }
    x
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Rng;

    #[test]
    fn the_normals_that_are_seen_are_all_of_the_projected_surface() {
        let rules = Rules::new(64);
        for distribution in [Distribution::Ggx, Distribution::Beckmann] {
            for (alpha, theta) in [(0.1, 0.0), (0.1, 1.2), (0.5, 0.6), (1.0, 1.5)] {
                let w = DVec3::new(f64::sin(theta), 0.0, f64::cos(theta));
                let seen = |m: DVec3| w.dot(m).max(0.0) * distribution.density(alpha, m);
                // Over slopes p = alpha tan: dw = alpha^2 dp / (1 + alpha^2 p^2)^(3/2), p drawn out to infinity.
                let disc = GaussLegendre::new(200);
                let all = disc.integrate(0.0, 1.0, |r| {
                    let p = r / (1.0 - r);
                    let ring = |turn: f64| {
                        let m = DVec3::new(-alpha * p * turn.cos(), -alpha * p * turn.sin(), 1.0).normalize();
                        seen(m) * m.z.powi(3) * alpha * alpha
                    };
                    2.0 * p / (1.0 - r).powi(2) * disc.integrate(0.0, PI, ring)
                });
                let wanted = w.z * (1.0 + distribution.lambda(alpha, w));
                assert!((all / wanted - 1.0).abs() < 2e-4, "{distribution:?} {alpha} {theta}: {all} {wanted}");
                assert!((distribution.mean(alpha, w, &rules, |_| 0, |_| 1.0) - 1.0).abs() < 1e-9);
            }
        }
    }

    #[test]
    fn draws_have_the_mean_of_the_quadrature() {
        let rules = Rules::new(64);
        for distribution in [Distribution::Ggx, Distribution::Beckmann] {
            for (alpha, theta) in [(0.05, 0.0), (0.3, 0.9), (1.0, 1.5), (0.5, 1e-5)] {
                let w = DVec3::new(0.6 * f64::sin(theta), 0.8 * f64::sin(theta), f64::cos(theta));
                let f = |m: DVec3| (w.dot(m) - 0.3 * m.z).powi(2);
                let wanted = distribution.mean(alpha, w, &rules, |_| 0, f);
                let mut rng = Rng::new(4, 0, 0);
                let drawn: Vec<f64> = (0..100_000).map(|_| f(distribution.draw(alpha, w, rng.pair()))).collect();
                let mean = drawn.iter().sum::<f64>() / 1e5;
                let sigma = (drawn.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / 1e10).sqrt();
                assert!(
                    (mean - wanted).abs() < 4.0 * sigma,
                    "{distribution:?} {alpha} {theta}: {mean} {wanted} {sigma}"
                );
            }
        }
    }
}

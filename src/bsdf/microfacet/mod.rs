//! Rough reflection and refraction: facets that mirror and refract one by one.
//!
//!     reflected     f = F D(m) G / (4 cos_i cos_s)                                       [1/sr]    m  along wi + wo
//!     transmitted   f = n_t^2 |wi.m| |wo.m| T D(m) G / (cos_i cos_s (n_i wi.m + n_t wo.m)^2)       m  along n_i wi + n_t wo
//!
//! D distribution of the normals and Lambda Smith's function of it ([`Distribution`]); roughness alpha. F and T, unpolarised power
//! fractions at the angle between wi and m, Fresnel's of the two media on either side ([`Facets::Interface`]), total reflection
//! included; or 1 ([`Facets::Perfect`]: put in by `order: Scaled`). n real indices. G is Smith's, correlated in height:
//!
//!     G = 1 / (1 + Lambda(wi) + Lambda(wo)) reflected,    Beta(1 + Lambda(wi), 1 + Lambda(wo)) transmitted
//!
//! f is reciprocal, f_it / n_t^2 = f_ti / n_i^2. Draws follow the normals that wi sees; the weight is F G (1 + Lambda(wi)) <= 1.
//! Single scattering loses what meets a second facet: at normal incidence 1 % at alpha = 0.1, 31 % at 0.5, 69 % at 1 (GGX, F = 1).
//! It is absorbed, unless [`Compensation`] gives it back.
//!
//! Left out: media of equal index, whose interface bends nothing (the transmitted lobe is empty there); polarisation; dependence
//! on the azimuth of the sample. An absorbing medium counts with its real index in directions, its complex one in F and T.
//! Source: Walter, Marschner, Li & Torrance, EGSR 2007, eq. 16-21; Heitz, JCGT 3(2), 48 (2014), sec. 5 and 6; Heitz et al., "Multiple
//! scattering microfacet BSDFs", ACM TOG 35(4), 58 (2016), eq. 8 (the beta function).

mod compensation;
mod distribution;
mod tables;

use super::{Bsdf, Side};
use crate::math::Rng;
use crate::math::statistics::ln_beta;
use crate::optics::{Incidence, fresnel, refraction};
use distribution::Rules;
use glam::DVec3;
use num_complex::Complex64;
use tables::Tables;

pub use compensation::Compensation;
pub use distribution::Distribution;

/// What a facet does to light.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Facets {
    /// What Fresnel says of the two media.
    Interface,
    /// Reflects, or passes, everything.
    Perfect,
}

/// One side's lobe of a rough surface.
#[derive(Debug)]
pub struct Microfacet {
    shape: Shape,
    albedo: Tables,
}

/// What the lobe is, without its tables.
#[derive(Clone, Copy, Debug)]
struct Shape {
    distribution: Distribution,
    alpha: f64,
    facets: Facets,
    side: Side,
}

impl Microfacet {
    /// A lobe of roughness `alpha` (0.001..1). Its tables of albedo are worked out where they are first needed: 0.2 s
    /// each at alpha = 0.3, 2 s at 0.01; two for each pair of indices that light meets.
    pub fn new(distribution: Distribution, alpha: f64, facets: Facets, side: Side) -> Microfacet {
        Microfacet { shape: Shape { distribution, alpha, facets, side }, albedo: Tables::new(alpha) }
    }
}

impl Shape {
    /// Power fraction that a facet sends to this lobe's side, at cosine `cos` > 0 of the angle to its normal.
    fn fraction(&self, index: [Complex64; 2], cos: f64) -> f64 {
        if self.facets == Facets::Perfect {
            return 1.0;
        }
        let split = fresnel::interface(index[0], index[1], cos.min(1.0));
        match self.side {
            Side::Reflect => split.reflected.unpolarised(),
            Side::Transmit => split.transmitted.unpolarised(),
        }
    }

    /// Smith's G of both directions.
    fn shadowing(&self, [first, second]: [f64; 2]) -> f64 {
        match self.side {
            Side::Reflect => 1.0 / (1.0 + first + second),
            Side::Transmit => ln_beta(1.0 + first, 1.0 + second).exp(),
        }
    }

    fn lambda(&self, w: DVec3) -> f64 {
        self.distribution.lambda(self.alpha, w)
    }

    /// The facet that sends `wi` to `wo`, and dw_m / dw_o; `None` if there is none.
    fn facet(&self, at: &Incidence, wo: DVec3) -> Option<(DVec3, f64)> {
        if !self.side.holds(wo) {
            return None;
        }
        match self.side {
            Side::Reflect => {
                let m = (at.wi + wo).try_normalize()?;
                Some((m, 0.25 / at.wi.dot(m)))
            }
            Side::Transmit => {
                let [n1, n2] = at.index.map(|n| n.re);
                if n1 == n2 {
                    return None;
                }
                let m = (n1 * at.wi + n2 * wo).try_normalize()?;
                let m = if m.z < 0.0 { -m } else { m };
                let (a, b) = (at.wi.dot(m), wo.dot(m));
                (a > 0.0 && b < 0.0 && m.z > 0.0).then(|| (m, n2 * n2 * -b / (n1 * a + n2 * b).powi(2)))
            }
        }
    }

    /// Where the facet `m` sends `wi`; `None` if to the other side, or nowhere.
    fn leave(&self, wi: DVec3, index: [Complex64; 2], m: DVec3) -> Option<DVec3> {
        let cos = wi.dot(m);
        if cos <= 0.0 {
            return None;
        }
        let wo = match self.side {
            Side::Reflect => 2.0 * cos * m - wi,
            Side::Transmit => {
                let [n1, n2] = index.map(|n| n.re);
                let square = refraction::normal_component_squared(cos, n1, n2);
                if square <= 0.0 || n1 == n2 {
                    return None;
                }
                let wo = (n1 * cos - square.sqrt()) / n2 * m - n1 / n2 * wi;
                wo.normalize()
            }
        };
        self.side.holds(wo).then_some(wo).filter(|wo| wo.z != 0.0)
    }

    /// f |cos_s| / density of draws: F G (1 + Lambda(wi)).
    fn weight(&self, wi: DVec3, index: [Complex64; 2], m: DVec3, wo: DVec3) -> f64 {
        let lambda = [self.lambda(wi), self.lambda(wo)];
        self.fraction(index, wi.dot(m)) * self.shadowing(lambda) * (1.0 + lambda[0])
    }

    /// The albedo by quadrature over the normals that are seen, at `theta` rad of incidence.
    fn albedo(&self, rules: &Rules, index: [Complex64; 2], theta: f64) -> f64 {
        let wi = DVec3::new(theta.sin(), 0.0, theta.cos().max(1e-7));
        let weight = |m: DVec3| self.leave(wi, index, m).map_or(0.0, |wo| self.weight(wi, index, m, wo));
        // Facets whose light goes to the other side, and those that reflect totally, are apart by a step and by a root.
        let regime = |m: DVec3| {
            let [n1, n2] = index.map(|n| n.re);
            let total = refraction::normal_component_squared(wi.dot(m).max(0.0), n1, n2) <= 0.0;
            u8::from(self.leave(wi, index, m).is_some()) + 2 * u8::from(total)
        };
        self.distribution.mean(self.alpha, wi, rules, regime, weight)
    }
}

impl Bsdf for Microfacet {
    fn eval(&self, at: &Incidence, wo: DVec3) -> f64 {
        let Some((m, _)) = self.shape.facet(at, wo) else { return 0.0 };
        self.pdf(at, wo) * self.shape.weight(at.wi, at.index, m, wo) / wo.z.abs()
    }

    /// D_wi(m) dw_m / dw_o.
    fn pdf(&self, at: &Incidence, wo: DVec3) -> f64 {
        let Some((m, stretch)) = self.shape.facet(at, wo) else { return 0.0 };
        let seen = at.wi.dot(m) * self.shape.distribution.density(self.shape.alpha, m);
        seen * stretch / (at.cos() * (1.0 + self.shape.lambda(at.wi)))
    }

    fn sample(&self, at: &Incidence, rng: &mut Rng) -> Option<DVec3> {
        let m = self.shape.distribution.draw(self.shape.alpha, at.wi, rng.pair());
        self.shape.leave(at.wi, at.index, m)
    }

    fn albedo(&self, at: &Incidence) -> f64 {
        self.albedo.at(&self.shape, at)
    }

    fn transmits(&self) -> bool {
        self.shape.side == Side::Transmit
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_facet_sends_light_to_where_it_is_found_again() {
        let index = [1.0, 1.5].map(|n| Complex64::new(n, 0.0));
        let at = Incidence { index, ..Incidence::in_air(0.7, 550e-9) };
        for side in [Side::Reflect, Side::Transmit] {
            for at in [at, Incidence { index: [index[1], index[0]], ..at }] {
                let shape = Shape { distribution: Distribution::Ggx, alpha: 0.3, facets: Facets::Interface, side };
                let m = DVec3::new(0.2, -0.1, 0.9).normalize();
                let Some(wo) = shape.leave(at.wi, at.index, m) else { continue };
                let (found, _) = shape.facet(&at, wo).expect("a facet");
                assert!((found - m).length() < 1e-12, "{side:?} {found} {m}");
            }
        }
    }

    #[test]
    fn media_of_equal_index_are_an_empty_lobe() {
        let glass = Microfacet::new(Distribution::Beckmann, 0.2, Facets::Interface, Side::Transmit);
        let at = Incidence::in_air(0.3, 550e-9);
        assert_eq!(glass.albedo(&at), 0.0);
        assert_eq!(glass.pdf(&at, DVec3::new(-0.2, 0.1, -0.97).normalize()), 0.0);
    }
}

//! Particles on a surface and what they do to its light.
//!
//! With t, s and p of the layer ([`crate::bsdf::contamination`]), on a surface of specular reflectance R and transmittance T, per unit of
//! solid angle:
//!
//!     reflected     s (p(g) (1 + R^2 t) + p(g0) R (1 + t))     g: angle to the incident ray, g0: to the specular ray
//!     transmitted   s T p(g) dw / dw_t                         before refraction, g: angle to the incident ray
//!     from inside   s T p(g)                                   after refraction, at the exit angle, g: angle to the refracted ray
//!
//! so the forward lobe folds about the specular ray and acts on both passes. Specular light keeps t^2 reflected and t transmitted; from
//! inside, t transmitted. R and T are those of unpolarised light at the angle of incidence.
//!
//! Source: S. D. Spyak, W. L. Wolfe, Opt. Eng. 31, 1746 (1992). Left out: light scattered back into a transparent body (absorbed).

use crate::bsdf::Bsdf;
use crate::bsdf::contamination::Deposit;
use crate::coating::Coating;
use crate::math::Rng;
use crate::optics::{Incidence, refraction};
use glam::DVec3;
use std::sync::Arc;

/// A deposit on a surface.
#[derive(Clone, Debug)]
pub struct Dust {
    pub deposit: Arc<Deposit>,
    /// What is specular under it; `None`: nothing.
    pub coating: Option<Arc<dyn Coating>>,
    /// True if light meets the surface first and the particles behind it: from inside a transparent body.
    pub behind: bool,
}

impl Dust {
    /// Reflectance and transmittance of the surface for unpolarised light.
    fn shares(&self, at: &Incidence) -> [f64; 2] {
        let split = self.coating.as_ref().map(|coating| coating.split(at));
        split.map_or([0.0; 2], |split| [split.reflected.unpolarised(), split.transmitted.unpolarised()])
    }

    /// What is left of the reflected and of the transmitted specular light.
    pub fn keeps(&self, at: &Incidence) -> [f64; 2] {
        if self.behind {
            return [1.0, self.exit(at).map_or(1.0, |exit| self.deposit.passes(-exit.z, at.wavelength))];
        }
        let kept = self.deposit.passes(at.wi.z, at.wavelength);
        [kept * kept, kept]
    }

    /// The refracted ray.
    fn exit(&self, at: &Incidence) -> Option<DVec3> {
        refraction::refract(at.wi, at.index[0].re, at.index[1].re)
    }

    /// The lobes of the particles.
    pub fn lobes(self) -> Vec<Box<dyn Bsdf>> {
        let passes = self.coating.as_ref().is_some_and(|coating| !coating.opaque());
        let mut lobes: Vec<Box<dyn Bsdf>> = Vec::new();
        if !self.behind {
            lobes.push(Box::new(Folded(self.clone())));
        }
        if passes {
            lobes.push(Box::new(Passed(self)));
        }
        lobes
    }
}

/// Light that leaves on the side from which it came.
#[derive(Debug)]
struct Folded(Dust);

impl Folded {
    /// s, and the weights of p about the incident and about the specular ray.
    fn weights(&self, at: &Incidence) -> (f64, [f64; 2]) {
        let deposit = &self.0.deposit;
        let [r, _] = self.0.shares(at);
        let kept = deposit.passes(at.wi.z, at.wavelength);
        (deposit.scatters(at.wi.z, at.wavelength), [1.0 + r * r * kept, r * (1.0 + kept)])
    }

    /// Weighted mean of p at the two angles, and the sum of the weights.
    fn mean(&self, at: &Incidence, wo: DVec3, [incident, specular]: [f64; 2]) -> f64 {
        let phase = |axis: DVec3| self.0.deposit.phase(axis.dot(wo).clamp(-1.0, 1.0), at.wavelength);
        incident * phase(-at.wi) + specular * phase(refraction::reflect(at.wi))
    }
}

impl Bsdf for Folded {
    fn eval(&self, at: &Incidence, wo: DVec3) -> f64 {
        if wo.z <= 0.0 {
            return 0.0;
        }
        let (scattered, weights) = self.weights(at);
        scattered * self.mean(at, wo, weights) / wo.z
    }

    fn pdf(&self, at: &Incidence, wo: DVec3) -> f64 {
        let (_, weights) = self.weights(at);
        if wo.z <= 0.0 { 0.0 } else { self.mean(at, wo, weights) / (weights[0] + weights[1]) }
    }

    fn sample(&self, at: &Incidence, rng: &mut Rng) -> Option<DVec3> {
        let (_, [incident, specular]) = self.weights(at);
        let turns = rng.uniform() * (incident + specular) < incident;
        let axis = if turns { -at.wi } else { refraction::reflect(at.wi) };
        Some(self.0.deposit.draw(axis, at.wavelength, rng)).filter(|wo| wo.z > 0.0)
    }

    fn albedo(&self, at: &Incidence) -> f64 {
        let (scattered, [incident, specular]) = self.weights(at);
        let ahead = self.0.deposit.ahead(at.wi.z, at.wavelength);
        scattered * (incident * (1.0 - ahead) + specular * ahead)
    }
}

/// Light that leaves on the other side.
#[derive(Debug)]
struct Passed(Dust);

impl Passed {
    /// s T, the axis of the lobe, and whether light is refracted after it is scattered.
    fn lobe(&self, at: &Incidence) -> Option<(f64, DVec3)> {
        let deposit = &self.0.deposit;
        let [_, t] = self.0.shares(at);
        if self.0.behind {
            let exit = self.0.exit(at)?;
            return Some((t * deposit.scatters(-exit.z, at.wavelength), exit));
        }
        Some((t * deposit.scatters(at.wi.z, at.wavelength), -at.wi))
    }

    /// Index of the layer's side over that of the other, if light is refracted after it is scattered and always can be.
    fn ratio(&self, at: &Incidence) -> f64 {
        let ratio = at.index[0].re / at.index[1].re;
        if self.0.behind || ratio > 1.0 { 1.0 } else { ratio }
    }

    /// The direction before refraction of one that leaves; `None` if there is none.
    fn before(&self, at: &Incidence, wo: DVec3) -> Option<DVec3> {
        let across = wo.truncate() / self.ratio(at);
        let z = 1.0 - across.length_squared();
        (wo.z < 0.0 && z > 0.0).then(|| across.extend(-z.sqrt()))
    }
}

impl Bsdf for Passed {
    fn eval(&self, at: &Incidence, wo: DVec3) -> f64 {
        let (Some((share, axis)), Some(w)) = (self.lobe(at), self.before(at, wo)) else { return 0.0 };
        let phase = self.0.deposit.phase(axis.dot(w).clamp(-1.0, 1.0), at.wavelength);
        share * phase / (self.ratio(at).powi(2) * w.z.abs())
    }

    fn pdf(&self, at: &Incidence, wo: DVec3) -> f64 {
        let (Some((_, axis)), Some(w)) = (self.lobe(at), self.before(at, wo)) else { return 0.0 };
        let phase = self.0.deposit.phase(axis.dot(w).clamp(-1.0, 1.0), at.wavelength);
        // dw / dw_t = n_t^2 cos_t / (n^2 cos)
        phase * wo.z / (self.ratio(at).powi(2) * w.z)
    }

    fn sample(&self, at: &Incidence, rng: &mut Rng) -> Option<DVec3> {
        let (_, axis) = self.lobe(at)?;
        let w = self.0.deposit.draw(axis, at.wavelength, rng);
        let across = w.truncate() * self.ratio(at);
        (w.z < 0.0).then(|| across.extend(-(1.0 - across.length_squared()).max(f64::MIN_POSITIVE).sqrt()))
    }

    fn albedo(&self, at: &Incidence) -> f64 {
        self.lobe(at).map_or(0.0, |(share, axis)| share * self.0.deposit.ahead(-axis.z, at.wavelength))
    }

    fn transmits(&self) -> bool {
        true
    }
}

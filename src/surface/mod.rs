//! A surface: what is specular, what scatters, and in which order.
//!
//! With incident flux 1, specular reflectance R and transmittance T of the coating, and the lobes' albedos
//! a_r (reflected) and a_t (transmitted) at this incidence, a = a_r + a_t:
//!
//! | order        | scattered        | specular                  |
//! |--------------|------------------|---------------------------|
//! | ScatterFirst | a                | (1 - a) R, (1 - a) T      |
//! | Scaled       | R a_r + T a_t    | (1 - a_r) R, (1 - a_t) T  |
//! | Total        | a                | 0, (1 - a) T              |
//!
//! ScatterFirst: TIS is measured against the incident flux and the coating acts on the rest. Scaled: the BSDF is that of the
//! uncoated shape and the coating scales it. Total: the table already contains the specular reflection.
//! What remains is absorbed. Particles on the surface ([`dust`]) take their share of all of this and add lobes of their own.

pub mod dust;

use crate::bsdf::contamination::Deposit;
use crate::bsdf::{Bsdf, Weighed};
use crate::coating::Coating;
use crate::math::Rng;
use crate::optics::{Incidence, Split};
use dust::Dust;
use glam::DVec3;
use smallvec::SmallVec;
use std::sync::Arc;

/// How scatter and coating share the light (see the module).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Order {
    #[default]
    ScatterFirst,
    Scaled,
    Total,
}

/// Whether scatter is traced or its flux is cut and booked.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Scattering {
    #[default]
    On,
    Off,
}

/// One finish: an interface plus lobes.
#[derive(Debug)]
pub struct Surface {
    pub label: String,
    /// The specular part; `None`: absorbed.
    pub specular: Option<Arc<dyn Coating>>,
    /// Its own, then those of the particles on it.
    pub lobes: Vec<Box<dyn Bsdf>>,
    pub order: Order,
    pub scattering: Scattering,
    opaque: bool,
    /// Particles in front of it all.
    dust: Option<Dust>,
    /// Number of its own lobes.
    own: usize,
    /// See [`Coating::axis`].
    pub axis: Option<DVec3>,
    /// Unit, in the scene: the direction from which lobes that are not isotropic count azimuths, projected on the surface.
    pub lay: Option<DVec3>,
}

/// The bill of one arrival, fractions of the incident flux: what each branch gets, before polarisation.
#[derive(Clone, Debug)]
pub struct Shares {
    /// Coating amplitudes, to be applied to the Stokes vector.
    pub split: Option<Split>,
    /// Factors on the coating's reflected and transmitted flux.
    pub specular: [f64; 2],
    /// Factors on the lobes' BSDF, reflected and transmitted side; polarisation-averaged.
    pub lobes: [f64; 2],
    /// Scattered fraction of the incident flux.
    pub scattered: f64,
    /// The part of it that every lobe has, in their order.
    parts: SmallVec<[f64; 4]>,
}

impl Surface {
    pub fn new(
        label: String,
        specular: Option<Arc<dyn Coating>>,
        lobes: Vec<Box<dyn Bsdf>>,
        order: Order,
        scattering: Scattering,
    ) -> Surface {
        let opaque = specular.as_ref().is_none_or(|c| c.opaque()) && !lobes.iter().any(|l| l.transmits());
        let axis = specular.as_ref().and_then(|coating| coating.axis());
        let own = lobes.len();
        Surface { label, specular, lobes, order, scattering, opaque, dust: None, own, axis, lay: None }
    }

    /// The same surface with a lay.
    pub fn laid(self, lay: Option<DVec3>) -> Surface {
        Surface { lay, ..self }
    }

    /// The same surface with a deposit on it; `behind`: light meets the surface first and the deposit behind it.
    pub fn under(mut self, deposit: Arc<Deposit>, behind: bool) -> Surface {
        let dust = Dust { deposit, coating: self.specular.clone(), behind: behind && !self.opaque };
        self.lobes.extend(dust.clone().lobes());
        self.dust = Some(dust);
        self
    }

    /// True if light never passes: a reflection here is meant, not a ghost.
    pub fn opaque(&self) -> bool {
        self.opaque
    }

    /// True if it mirrors or refracts: an optical element, not a wall.
    pub fn optical(&self) -> bool {
        self.specular.is_some()
    }

    /// True if there are particles on it.
    pub fn is_dusty(&self) -> bool {
        self.dust.is_some()
    }

    /// True for a bare interface without scatter: it yields to a declared finish where faces lie on each other.
    pub fn is_plain(&self) -> bool {
        self.lobes.is_empty() && self.specular.as_ref().is_some_and(|c| c.bare())
    }

    /// How the flux is shared at this incidence.
    pub fn shares(&self, at: &Incidence) -> Shares {
        let split = self.specular.as_ref().map(|coating| coating.split(at));
        if self.lobes.is_empty() {
            let parts = SmallVec::new();
            return Shares { split, specular: [1.0; 2], lobes: [0.0; 2], scattered: 0.0, parts };
        }
        let albedos: SmallVec<[f64; 4]> = self.lobes.iter().map(|lobe| lobe.albedo(at)).collect();
        let [back, through] = both_ways(&self.lobes[..self.own], &albedos);
        let all = back + through;
        let [specular, lobes] = match self.order {
            Order::ScatterFirst => [[1.0 - all; 2], [1.0; 2]],
            Order::Total => [[0.0, 1.0 - all], [1.0; 2]],
            Order::Scaled => {
                let r = split.map_or(1.0, |s| s.reflected.unpolarised());
                let t = split.map_or(1.0, |s| s.transmitted.unpolarised());
                [[1.0 - back, 1.0 - through], [r, t]]
            }
        };
        // What the surface sends on passes the particles; what they scatter comes on top.
        let kept = self.dust.as_ref().map_or([1.0; 2], |dust| dust.keeps(at));
        let by = |factors: [f64; 2]| [kept[0] * factors[0], kept[1] * factors[1]];
        let clean = Shares { split, specular: by(specular), lobes: by(lobes), scattered: 0.0, parts: albedos };
        self.billed(clean)
    }

    /// The same with the parts of the lobes, so far their albedos, times their factors, and the sum.
    fn billed(&self, mut shares: Shares) -> Shares {
        for (at, part) in shares.parts.iter_mut().enumerate() {
            *part *= self.factor(at, shares.lobes);
        }
        shares.scattered = shares.parts.iter().sum();
        shares
    }

    /// Factor on the BSDF of a lobe, by the [`Shares::lobes`].
    fn factor(&self, lobe: usize, lobes: [f64; 2]) -> f64 {
        if lobe < self.own { lobes[self.lobes[lobe].transmits() as usize] } else { 1.0 }
    }

    /// Reflected and transmitted albedo of all lobes together, 0..1 each.
    pub fn albedo(&self, at: &Incidence) -> [f64; 2] {
        let albedos: SmallVec<[f64; 4]> = self.lobes.iter().map(|lobe| lobe.albedo(at)).collect();
        both_ways(&self.lobes, &albedos)
    }

    /// Draws a scattered direction from the one mixture of all lobes. `None`: the draw left the hemispheres that light can
    /// take; it carries nothing, and the mean stays right because the density integrates to the chance of a valid draw.
    pub fn draw(&self, at: &Incidence, shares: &Shares, rng: &mut Rng) -> Option<DVec3> {
        if let [lobe] = self.lobes.as_slice() {
            return lobe.sample(at, rng);
        }
        // A lobe is drawn from in proportion to its part of the scattered flux.
        let mut rest = rng.uniform() * shares.scattered;
        let chosen = self.lobes.iter().zip(&shares.parts).find(|(_, part)| {
            rest -= **part;
            rest < 0.0
        });
        chosen.map(|(lobe, _)| lobe).or(self.lobes.last())?.sample(at, rng)
    }

    /// f |cos theta_s| of all lobes together as the coating lets it through, 1/sr: scattered flux per solid angle and
    /// incident flux; and the density of `draw`'s directions, 1/sr.
    pub fn weigh(&self, at: &Incidence, shares: &Shares, wo: DVec3) -> Weighed {
        if let [lobe] = self.lobes.as_slice() {
            let Weighed { value, density } = lobe.weigh(at, wo);
            return Weighed { value: self.factor(0, shares.lobes) * value * wo.z.abs(), density };
        }
        let mut all = Weighed::default();
        for (k, (lobe, part)) in self.lobes.iter().zip(&shares.parts).enumerate() {
            let Weighed { value, density } = lobe.weigh(at, wo);
            all.value += self.factor(k, shares.lobes) * value;
            all.density += part * density;
        }
        let density = if shares.scattered > 0.0 { all.density / shares.scattered } else { 0.0 };
        Weighed { value: all.value * wo.z.abs(), density }
    }
}

/// Reflected and transmitted albedo of lobes together.
fn both_ways(lobes: &[Box<dyn Bsdf>], albedos: &[f64]) -> [f64; 2] {
    let mut both = [0.0; 2];
    for (lobe, albedo) in lobes.iter().zip(albedos) {
        both[lobe.transmits() as usize] += albedo;
    }
    both
}

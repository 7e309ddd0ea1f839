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

use crate::bsdf::Bsdf;
use crate::bsdf::contamination::Deposit;
use crate::coating::Coating;
use crate::math::Rng;
use crate::optics::{Incidence, Split};
use dust::Dust;
use glam::DVec3;
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
#[derive(Clone, Copy, Debug)]
pub struct Shares {
    /// Coating amplitudes, to be applied to the Stokes vector.
    pub split: Option<Split>,
    /// Factors on the coating's reflected and transmitted flux.
    pub specular: [f64; 2],
    /// Factors on the lobes' BSDF, reflected and transmitted side; polarisation-averaged.
    pub lobes: [f64; 2],
    /// Scattered fraction of the incident flux.
    pub scattered: f64,
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

    /// True for a bare interface without scatter: it yields to a declared finish where faces lie on each other.
    pub fn is_plain(&self) -> bool {
        self.lobes.is_empty() && self.specular.as_ref().is_some_and(|c| c.bare())
    }

    /// How the flux is shared at this incidence.
    pub fn shares(&self, at: &Incidence) -> Shares {
        let split = self.specular.as_ref().map(|coating| coating.split(at));
        if self.lobes.is_empty() {
            return Shares { split, specular: [1.0; 2], lobes: [0.0; 2], scattered: 0.0 };
        }
        let [back, through] = albedo(&self.lobes[..self.own], at);
        let all = back + through;
        let clean = match self.order {
            Order::ScatterFirst => Shares { split, specular: [1.0 - all; 2], lobes: [1.0; 2], scattered: all },
            Order::Total => Shares { split, specular: [0.0, 1.0 - all], lobes: [1.0; 2], scattered: all },
            Order::Scaled => {
                let r = split.map_or(1.0, |s| s.reflected.unpolarised());
                let t = split.map_or(1.0, |s| s.transmitted.unpolarised());
                Shares {
                    split,
                    specular: [1.0 - back, 1.0 - through],
                    lobes: [r, t],
                    scattered: r * back + t * through,
                }
            }
        };
        let Some(dust) = &self.dust else { return clean };
        // What the surface sends on passes the particles; what they scatter comes on top.
        let kept = dust.keeps(at);
        let by = |factors: [f64; 2]| [kept[0] * factors[0], kept[1] * factors[1]];
        let lobes = by(clean.lobes);
        let dusty: f64 = albedo(&self.lobes[self.own..], at).iter().sum();
        let scattered = lobes[0] * back + lobes[1] * through + dusty;
        Shares { split, specular: by(clean.specular), lobes, scattered }
    }

    /// Reflected and transmitted albedo of all lobes together, 0..1 each.
    pub fn albedo(&self, at: &Incidence) -> [f64; 2] {
        albedo(&self.lobes, at)
    }

    /// All lobes, each with the factor on its BSDF.
    fn weighted<'a>(&'a self, shares: &'a Shares) -> impl Iterator<Item = (f64, &'a dyn Bsdf)> + 'a {
        self.lobes.iter().enumerate().map(|(at, lobe)| {
            let factor = if at < self.own { shares.lobes[lobe.transmits() as usize] } else { 1.0 };
            (factor, lobe.as_ref())
        })
    }

    /// Draws a scattered direction from the one mixture of all lobes. `None`: the draw left the hemispheres that light can
    /// take; it carries nothing, and the mean stays right because `density` integrates to the chance of a valid draw.
    pub fn draw(&self, at: &Incidence, shares: &Shares, rng: &mut Rng) -> Option<DVec3> {
        if let [lobe] = self.lobes.as_slice() {
            return lobe.sample(at, rng);
        }
        let mut rest = rng.uniform() * shares.scattered;
        let chosen = self.weighted(shares).find(|(factor, lobe)| {
            rest -= factor * lobe.albedo(at);
            rest < 0.0
        });
        chosen.map(|(_, lobe)| lobe).or(self.lobes.last().map(Box::as_ref))?.sample(at, rng)
    }

    /// Density of `draw`'s directions, 1/sr.
    pub fn density(&self, at: &Incidence, shares: &Shares, wo: DVec3) -> f64 {
        if let [lobe] = self.lobes.as_slice() {
            return lobe.pdf(at, wo);
        }
        // A lobe is drawn from in proportion to its part of the scattered flux.
        let part = |(factor, lobe): (f64, &dyn Bsdf)| factor * lobe.albedo(at) * lobe.pdf(at, wo);
        self.weighted(shares).map(part).sum::<f64>() / shares.scattered
    }

    /// f |cos theta_s| of all lobes together as the coating lets it through, 1/sr: scattered flux per solid angle and
    /// incident flux.
    pub fn value(&self, at: &Incidence, shares: &Shares, wo: DVec3) -> f64 {
        let f: f64 = self.weighted(shares).map(|(factor, lobe)| factor * lobe.eval(at, wo)).sum();
        f * wo.z.abs()
    }
}

/// Reflected and transmitted albedo of lobes together.
fn albedo(lobes: &[Box<dyn Bsdf>], at: &Incidence) -> [f64; 2] {
    let mut albedo = [0.0; 2];
    for lobe in lobes {
        albedo[lobe.transmits() as usize] += lobe.albedo(at);
    }
    albedo
}

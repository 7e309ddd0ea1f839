//! What warm things send to a detector by themselves.
//!
//!     F_k = A integral over the band of L(lambda, T_k) alpha_k(lambda) dlambda      [W]
//!
//! alpha_k (sr) is the part of the detector's projected solid angle that is absorbed in the object k when light goes backwards, by any
//! number of reflections, transmissions and scatters. By Kirchhoff's law that *is* its emission: at every event 1 - R - T - TIS of the
//! direction and wavelength, on every length of absorbing medium 1 - exp(-alpha s). L is Planck's radiance; wavelengths are drawn from
//! Planck's law at the highest temperature and weighed with the object's own.
//!
//! Left out: light that surfaces scatter by laws that are not reciprocal (the residual of the look tells); the ambient and the sky, which
//! are cold.
//! Source: Siegel, Howell, Thermal Radiation Heat Transfer (4th ed., 2002), ch. 3.

use crate::packet::{Ancestry, Solids};
use crate::scene::Scene;
use crate::source::planck;
use crate::system::compile::Thermal;
use crate::tally::{Live, Sums};
use crate::transport::watch::{Sight, Watch};

/// Slots per object: radiance x solid angle in W/m2 and in photons/s/m2.
const UNITS: usize = 2;

/// Slots of everything that may glow: parts, then solids, then all together.
#[derive(Clone, Copy, Debug)]
pub struct Slots {
    parts: usize,
    solids: usize,
}

impl Slots {
    pub fn new(scene: &Scene) -> Slots {
        Slots { parts: scene.parts.len(), solids: scene.solids.len() }
    }

    /// A part, W/m2; the next slot holds photons/s/m2. So for the others.
    pub fn part(&self, part: usize) -> usize {
        UNITS * part
    }

    pub fn solid(&self, solid: usize) -> usize {
        UNITS * (self.parts + solid)
    }

    pub fn all(&self) -> usize {
        UNITS * (self.parts + self.solids)
    }

    /// Number of slots.
    pub fn len(&self) -> usize {
        self.all() + UNITS
    }
}

/// Takes down what is absorbed, as what it is worth in light.
pub struct Glow<'a> {
    scene: &'a Scene,
    thermal: &'a Thermal,
    slots: Slots,
    live: Live<1>,
    history: Option<u64>,
    /// Vacuum wavelength of the ray in hand, m, and its density, 1/m.
    pub wavelength: f64,
    pub density: f64,
}

impl<'a> Glow<'a> {
    pub fn new(scene: &'a Scene, thermal: &'a Thermal) -> Glow<'a> {
        let slots = Slots::new(scene);
        Glow { scene, thermal, slots, live: Live::new(slots.len()), history: None, wavelength: 0.0, density: 1.0 }
    }

    /// The sums of the batch.
    pub fn finish(mut self) -> Sums<1> {
        self.live.finish()
    }

    fn absorbs(&mut self, slot: usize, temperature: f64, solid_angle: f64) {
        if temperature <= 0.0 {
            return;
        }
        let flux = solid_angle * planck::radiance(temperature, self.wavelength) / self.density;
        for (place, worth) in [flux, flux * planck::photons(self.wavelength)].into_iter().enumerate() {
            self.live.add(slot + place, [worth]);
            self.live.add(self.slots.all() + place, [worth]);
        }
    }
}

impl Watch for Glow<'_> {
    fn follows(&mut self, ancestry: &Ancestry, _flux: f64) {
        if self.history.replace(ancestry.history) != Some(ancestry.history) {
            self.live.next_ray();
        }
    }

    fn event(&mut self, sight: impl FnOnce() -> Sight) {
        let sight = sight();
        // A long way through what absorbs may leave nothing.
        if sight.flux <= 0.0 {
            return;
        }
        let part = sight.part as usize;
        self.absorbs(self.slots.part(part), self.thermal.parts[part], sight.flux * sight.fractions[3]);
    }

    fn dims(&mut self, solids: &Solids, flux: f64) {
        if let Some(solid) = self.scene.innermost(solids).map(usize::from) {
            self.absorbs(self.slots.solid(solid), self.thermal.solids[solid], flux);
        }
    }
}

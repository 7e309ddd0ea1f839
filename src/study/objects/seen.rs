//! What a detector sees: rays that go backwards from it, and what they come to.

use super::way::Way;
use crate::geometry::Ray;
use crate::packet::{Ancestry, Solids};
use crate::scene::Scene;
use crate::tally::{Live, Sums};
use crate::transport::watch::{Sight, Watch};

/// Slots of what is seen, all in sr.
#[derive(Clone, Copy, Debug)]
pub struct Slots {
    parts: usize,
    solids: usize,
}

const WAYS: usize = Way::ALL.len();

impl Slots {
    pub fn new(scene: &Scene) -> Slots {
        Slots { parts: scene.parts.len(), solids: scene.solids.len() }
    }

    /// A part by one way.
    pub fn way(&self, part: usize, way: Way) -> usize {
        part * WAYS + way as usize
    }

    /// The front (0) or the back (1) of a part, directly and through the optics.
    pub fn side(&self, part: usize, side: usize) -> usize {
        self.parts * WAYS + 2 * part + side
    }

    /// The open sky by one way.
    pub fn sky(&self, way: Way) -> usize {
        self.parts * (WAYS + 2) + way as usize
    }

    /// What is absorbed in a part, by any way.
    pub fn absorbed(&self, part: usize) -> usize {
        self.parts * (WAYS + 2) + WAYS + part
    }

    /// What is absorbed in a solid, or in the ambient.
    pub fn dimmed(&self, solid: Option<u16>) -> usize {
        self.absorbed(self.parts) + solid.map_or(self.solids, usize::from)
    }

    /// Number of slots.
    pub fn len(&self) -> usize {
        self.dimmed(None) + 1
    }
}

/// Takes down where rays come to.
pub struct Eye<'a> {
    scene: &'a Scene,
    slots: Slots,
    live: Live<1>,
    /// Of the packet in hand.
    way: Option<Way>,
    history: Option<u64>,
}

impl<'a> Eye<'a> {
    pub fn new(scene: &'a Scene) -> Eye<'a> {
        let slots = Slots::new(scene);
        Eye { scene, slots, live: Live::new(slots.len()), way: None, history: None }
    }

    /// The sums of the batch.
    pub fn finish(mut self) -> Sums<1> {
        self.live.finish()
    }
}

impl Watch for Eye<'_> {
    fn follows(&mut self, ancestry: &Ancestry, _flux: f64) {
        self.way = Way::of(ancestry);
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
        self.live.add(self.slots.absorbed(part), [sight.flux * sight.fractions[3]]);
        let Some(way) = self.way else { return };
        self.live.add(self.slots.way(part, way), [sight.flux]);
        if way.is_first() {
            self.live.add(self.slots.side(part, !sight.front as usize), [sight.flux]);
        }
    }

    fn dims(&mut self, solids: &Solids, flux: f64) {
        self.live.add(self.slots.dimmed(self.scene.innermost(solids)), [flux]);
    }

    fn escaped(&mut self, _ray: Ray, flux: f64) {
        if let Some(way) = self.way {
            self.live.add(self.slots.sky(way), [flux]);
        }
    }
}

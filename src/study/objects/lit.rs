//! What the sources light: rays that go forwards from them, up to the first scatter and on to what that lights.

use super::way::Way;
use crate::packet::Ancestry;
use crate::scene::Scene;
use crate::tally::{Live, Sums};
use crate::transport::watch::{Sight, Watch};

/// Slots of what is lit, all in W.
#[derive(Clone, Copy, Debug)]
pub struct Slots {
    parts: usize,
}

const WAYS: usize = Way::ALL.len();

impl Slots {
    pub fn new(scene: &Scene) -> Slots {
        Slots { parts: scene.parts.len() }
    }

    /// Flux on a part by one way.
    pub fn way(&self, part: usize, way: Way) -> usize {
        part * WAYS + way as usize
    }

    /// What the front (0) or the back (1) of a part scatters of the light that comes directly or through the optics.
    pub fn scattered(&self, part: usize, side: usize) -> usize {
        self.parts * WAYS + 2 * part + side
    }

    /// Number of slots.
    pub fn len(&self) -> usize {
        self.parts * (WAYS + 2)
    }
}

/// Takes down where light falls.
pub struct Lamp {
    slots: Slots,
    live: Live<1>,
    /// Of the packet in hand.
    way: Option<Way>,
    history: Option<u64>,
}

impl Lamp {
    pub fn new(scene: &Scene) -> Lamp {
        let slots = Slots::new(scene);
        Lamp { slots, live: Live::new(slots.len()), way: None, history: None }
    }

    /// The sums of the batch.
    pub fn finish(mut self) -> Sums<1> {
        self.live.finish()
    }
}

impl Watch for Lamp {
    fn follows(&mut self, ancestry: &Ancestry, _flux: f64) {
        self.way = Way::of(ancestry);
        if self.history.replace(ancestry.history) != Some(ancestry.history) {
            self.live.next_ray();
        }
    }

    fn event(&mut self, sight: impl FnOnce() -> Sight) {
        let Some(way) = self.way else { return };
        let sight = sight();
        // A long way through what absorbs may leave nothing.
        if sight.flux <= 0.0 {
            return;
        }
        let part = sight.part as usize;
        self.live.add(self.slots.way(part, way), [sight.flux]);
        if way.is_first() {
            self.live.add(self.slots.scattered(part, !sight.front as usize), [sight.flux * sight.fractions[2]]);
        }
    }
}

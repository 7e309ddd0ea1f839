//! The largest single contributions: one arrival that brings a good part of the flux says that more of its kind are rare, and which.

use super::paths::{Row, row};
use super::summary::sequence;
use crate::packet::Ancestry;
use crate::scene::Scene;
use crate::tally::results::LargestResult;

/// The largest arrival on every detector, in every lane.
#[derive(Clone, Debug, Default)]
pub struct Largest<const V: usize> {
    detectors: Vec<[Option<Arrived>; V]>,
}

/// One arrival.
#[derive(Clone, Debug)]
struct Arrived {
    /// W
    flux: f64,
    row: Row,
    /// False if the path is longer than its steps.
    whole: bool,
}

impl<const V: usize> Largest<V> {
    /// Nothing has arrived yet.
    pub fn new(detectors: usize) -> Largest<V> {
        Largest { detectors: vec![[const { None }; V]; detectors] }
    }

    /// Notes an arrival with its flux (W).
    pub fn note(&mut self, detector: usize, ancestry: &Ancestry, flux: [f64; V]) {
        for (known, flux) in self.detectors[detector].iter_mut().zip(flux) {
            if flux > known.as_ref().map_or(0.0, |known| known.flux) {
                let whole = ancestry.events as usize <= ancestry.steps.len();
                *known = Some(Arrived { flux, row: row(detector, ancestry), whole });
            }
        }
    }

    /// With those of a later batch; the earlier of equals stays.
    pub fn merge(&mut self, later: Largest<V>) {
        let lanes = self.detectors.iter_mut().flatten().zip(later.detectors.into_iter().flatten());
        for (mine, other) in lanes {
            let flux = |arrived: &Option<Arrived>| arrived.as_ref().map_or(0.0, |arrived| arrived.flux);
            if flux(&other) > flux(mine) {
                *mine = other;
            }
        }
    }

    /// The largest on a detector in a lane, of all that `sum` (W) is the sum of over all batches.
    pub fn told(&self, scene: &Scene, detector: usize, lane: usize, sum: f64) -> Option<LargestResult> {
        let arrived = self.detectors[detector][lane].as_ref()?;
        let rest = if arrived.whole { "" } else { " > ..." };
        Some(LargestResult { share: arrived.flux / sum, sequence: sequence(scene, &arrived.row) + rest })
    }
}

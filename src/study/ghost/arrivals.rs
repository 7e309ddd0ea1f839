//! Watches a batch and sorts what arrives by its unintended reflections.

use super::bundle::Bundle;
use crate::detector::{Arrival, Place};
use crate::packet::{Ancestry, Event, MOST_REFLECTIONS};
use crate::scene::Scene;
use crate::transport::watch::Watch;
use arrayvec::ArrayVec;
use std::collections::BTreeMap;

/// Which light: its detector and source, and the parts of its unintended reflections in the order in which it met them.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Key {
    pub detector: u16,
    pub source: u16,
    pub parts: ArrayVec<u32, MOST_REFLECTIONS>,
}

/// What a batch caught.
#[derive(Default)]
pub struct Caught {
    /// Of every sequence that was begun, whether it arrives or not.
    pub bundles: BTreeMap<Key, Bundle>,
    /// Parts in the order in which the light that was never turned back meets them, on the longest way that was seen.
    pub train: Vec<u32>,
    /// Flux that arrived with more reflections than are spelled out, W.
    pub unnamed: f64,
    /// Flights from event to event.
    pub segments: u64,
}

pub struct Arrivals<'a> {
    scene: &'a Scene,
    order: usize,
    /// The packet in hand.
    path: Ancestry,
    pub caught: Caught,
}

impl<'a> Arrivals<'a> {
    /// Sequences of up to `order` reflections count.
    pub fn new(scene: &'a Scene, order: u16) -> Arrivals<'a> {
        Arrivals { scene, order: order.into(), path: Ancestry::born(0, 0), caught: Caught::default() }
    }

    /// The path in hand as a detector sees it; `None` if it has too many reflections.
    fn key(&self, detector: usize) -> Option<Key> {
        let path = self.scene.ending(detector, &self.path);
        let ghosts = path.reflected.iter().filter(|step| step.is_ghost());
        let parts: ArrayVec<u32, MOST_REFLECTIONS> = ghosts.map(|step| step.number()).collect();
        let key = Key { detector: detector as u16, source: path.source, parts };
        (path.has_all_reflections() && key.parts.len() <= self.order).then_some(key)
    }

    /// A sequence has just come to its last reflection: from here on it may arrive.
    fn begins(&mut self, detector: usize, flux: f64) {
        let Some(key) = self.key(detector) else { return };
        if self.path.reflected.last().map(|step| step.number()) == key.parts.last().copied() {
            let begun = &mut self.caught.bundles.entry(key).or_default().begun;
            *begun = begun.max(flux);
        }
    }
}

impl Watch for Arrivals<'_> {
    fn follows(&mut self, ancestry: &Ancestry, flux: f64) {
        self.path.clone_from(ancestry);
        self.caught.segments += 1;
        // Past the steps that are spelled out, any flight may be the first after a reflection.
        let reflected = ancestry.steps.last().is_some_and(|step| step.event() == Event::Reflect);
        if reflected || !ancestry.is_spelled() {
            let near = |detector: &usize| !matches!(self.scene.detectors[*detector].place, Place::FarField);
            (0..self.scene.detectors.len()).filter(near).for_each(|detector| self.begins(detector, flux));
        }
        if ancestry.ghosts == 0 && ancestry.steps.len() > self.caught.train.len() {
            self.caught.train = ancestry.steps.iter().map(|step| step.number()).collect();
        }
    }

    fn arrives(&mut self, detector: usize, arrival: &Arrival, flux: f64) {
        let grid = &self.scene.detectors[detector].grid;
        let Some(bin) = grid.bin(arrival) else { return };
        match self.key(detector) {
            Some(key) => self.caught.bundles.entry(key).or_default().add(&**grid, bin, arrival, flux),
            None if !self.path.has_all_reflections() => self.caught.unnamed += flux,
            None => {}
        }
    }
}

//! What a comparison takes down of every batch, so that differences have errors of their own.

use crate::math::statistics::mean_and_error;
use crate::packet::Class;
use crate::scene::Scene;
use crate::tally::results::Estimate;
pub use crate::tally::series::{Series, difference, mean, ratio};
use crate::tally::{Layout, Sums};
use crate::transport::stray_and_image;

/// Difference of a slot between a lane and the reference, summed over batches.
#[derive(Clone, Copy, Debug, Default)]
struct Moments {
    sum: f64,
    squares: f64,
}

/// The books of one trace.
#[derive(Debug)]
pub struct Record<const V: usize> {
    /// For each detector and lane, per batch, W: stray light, and what is meant to arrive.
    totals: Vec<[[Series; 2]; V]>,
    /// Slots that are compared between lanes.
    slots: Vec<usize>,
    moments: Vec<[Moments; V]>,
    batches: u64,
    /// Lane that the others are compared with.
    reference: usize,
    /// Class of what is meant to arrive.
    image: Class,
}

impl<const V: usize> Record<V> {
    /// Books for the detectors of a scene; lanes are compared with the lane `reference`.
    pub fn new(scene: &Scene, reference: usize) -> Record<V> {
        let empty = || std::array::from_fn(|_| [Series::new(), Series::new()]);
        let totals = scene.detectors.iter().map(|_| empty()).collect();
        Record { totals, slots: Vec::new(), moments: Vec::new(), batches: 0, reference, image: scene.image() }
    }

    /// Takes a batch down.
    pub fn take(&mut self, layout: &Layout, rows: usize, absorbers: std::ops::Range<usize>, batch: &Sums<V>) {
        if self.slots.is_empty() {
            self.slots = (0..rows).map(|row| layout.row(row)).chain(absorbers).collect();
            self.moments = vec![[Moments::default(); V]; self.slots.len()];
        }
        for (detector, lanes) in self.totals.iter_mut().enumerate() {
            let [stray, signal] = stray_and_image(layout, detector, self.image, batch);
            for (lane, series) in lanes.iter_mut().enumerate() {
                series[0].push(stray[lane]);
                series[1].push(signal[lane]);
            }
        }
        for (&slot, moments) in self.slots.iter().zip(&mut self.moments) {
            let values = batch.values(slot);
            for (value, moments) in values.iter().zip(moments) {
                let apart = value - values[self.reference];
                moments.sum += apart;
                moments.squares += apart * apart;
            }
        }
        self.batches += 1;
    }

    /// Stray light on a detector in a lane, and what is meant to arrive, W per batch.
    pub fn totals(&self, detector: usize, lane: usize) -> &[Series; 2] {
        &self.totals[detector][lane]
    }

    /// How much more a slot that is compared holds in a lane than in the reference.
    pub fn change(&self, slot: usize, lane: usize) -> Estimate {
        let Some(at) = self.slots.iter().position(|known| *known == slot) else { return Estimate::default() };
        let (Moments { sum, squares }, n) = (self.moments[at][lane], self.batches as f64);
        let (mean, error) = mean_and_error(sum, (squares - sum * sum / n).max(0.0), self.batches);
        Estimate { mean, error }
    }
}

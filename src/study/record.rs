//! What a comparison takes down of every batch, so that differences have errors of their own.
//!
//! Batches of the same number are drawn by the same random numbers in all variants, so the difference of two variants is known far
//! better than either of them. Over n batches with values x (baseline) and y:
//!
//!     D = mean(y) - mean(x)      var D = sum (y - x - D)^2 / (n (n - 1))
//!     R = mean(y) / mean(x)      var R = sum (y - R x)^2 / (n (n - 1)) / mean(x)^2
//!
//! The second by linearisation (Cochran, Sampling Techniques, 3rd ed. 1977, eq. 6.13); its bias is of order R / n times the squared
//! relative spread of x over batches.

use crate::math::statistics::mean_and_error;
use crate::packet::Class;
use crate::scene::Scene;
use crate::tally::results::Estimate;
use crate::tally::{Layout, Sums};

/// A value per batch.
pub type Series = Vec<f64>;

/// Mean of y - x, in their unit, with its error.
pub fn difference(x: &[f64], y: &[f64]) -> Estimate {
    let apart: Series = x.iter().zip(y).map(|(x, y)| y - x).collect();
    mean(&apart)
}

/// Mean of a series with its error.
pub fn mean(values: &[f64]) -> Estimate {
    let n = values.len() as f64;
    let sum: f64 = values.iter().sum();
    let spread = values.iter().map(|value| (value - sum / n).powi(2)).sum();
    let (mean, error) = mean_and_error(sum, spread, values.len() as u64);
    Estimate { mean, error }
}

/// mean y / mean x, dimensionless, with its error; `None` if x is zero.
pub fn ratio(x: &[f64], y: &[f64]) -> Option<Estimate> {
    let n = x.len() as f64;
    let [mx, my] = [x, y].map(|series| series.iter().sum::<f64>() / n);
    if mx <= 0.0 {
        return None;
    }
    let ratio = my / mx;
    let spread: f64 = x.iter().zip(y).map(|(x, y)| (y - ratio * x).powi(2)).sum();
    let (_, error) = mean_and_error(my * n, spread, x.len() as u64);
    Some(Estimate { mean: ratio, error: error / mx })
}

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
            // The sum of its classes: all light less the image would be rounding where stray light is faint.
            let stray = (0..Class::COUNT).filter(|class| *class != self.image.index());
            let stray: Vec<[f64; V]> = stray.map(|class| batch.values(layout.class(detector, class))).collect();
            let signal = batch.values(layout.class(detector, self.image.index()));
            for (lane, series) in lanes.iter_mut().enumerate() {
                series[0].push(stray.iter().map(|values| values[lane]).sum());
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_varies_together_differs_by_little() {
        let x: Series = (0..40).map(|i| 1.0 + f64::from(i * 7 % 40) / 40.0).collect();
        let y: Series = x.iter().map(|x| 0.98 * x).collect();
        let (apart, part) = (difference(&x, &y), ratio(&x, &y).expect("light"));
        assert!((apart.mean + 0.02 * mean(&x).mean).abs() < 1e-14 && apart.error < 0.021 * mean(&x).error);
        assert!((part.mean - 0.98).abs() < 1e-14 && part.error < 1e-14);
        assert_eq!(difference(&x, &x), Estimate::default());
        assert!(ratio(&vec![0.0; 40], &x).is_none());
    }
}

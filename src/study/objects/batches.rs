//! Batches over all cores, folded in a fixed order: the same bits on any number of threads.

use crate::settings::Settings;
use crate::tally::{Fold, Sums};
use rayon::prelude::*;
use std::sync::atomic::{AtomicBool, Ordering};

/// Batches handed to the threads at a time: interruptions are seen in between.
const CHUNK: u64 = 64;

/// The sums and flights of `batch` over all batches of the settings; `None` if it was told to stop before.
pub fn folded<const N: usize>(
    settings: &Settings,
    stop: &AtomicBool,
    batch: impl Fn(u64) -> ([Sums<1>; N], u64) + Sync,
) -> Option<([Sums<1>; N], u64)> {
    let mut segments = 0;
    let mut folds: [Fold<1>; N] = std::array::from_fn(|_| Fold::default());
    for first in (0..settings.batches()).step_by(CHUNK as usize) {
        let last = (first + CHUNK).min(settings.batches());
        let live = |number: u64| (!stop.load(Ordering::Relaxed)).then(|| batch(number));
        let numbers: Vec<u64> = (first..last).collect();
        let chunk: Vec<_> = numbers.into_par_iter().with_max_len(1).map(live).collect();
        for finished in chunk {
            let (sums, flights) = finished?;
            segments += flights;
            folds.iter_mut().zip(sums).for_each(|(fold, sums)| fold.push(sums));
        }
    }
    Some((folds.map(|fold| fold.total()), segments))
}

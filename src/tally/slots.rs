//! The arithmetic of slots: live sums of one batch, and the fixed tree that folds batches.

use super::results::Estimate;
use crate::math::statistics::mean_and_error;

/// Live sums of the batch in hand, one value per lane and slot; one per thread, empty between batches.
pub struct Live<const V: usize> {
    slots: Vec<Slot<V>>,
    touched: Vec<u32>,
    ray: u32,
}

#[derive(Clone, Copy)]
struct Slot<const V: usize> {
    sum: [f64; V],
    /// 1 + the last source ray that fed it.
    last: u32,
    rays: u32,
}

impl<const V: usize> Slot<V> {
    const EMPTY: Slot<V> = Slot { sum: [0.0; V], last: 0, rays: 0 };
}

impl<const V: usize> Live<V> {
    /// Room for `slots` slots: 8 V + 8 bytes each.
    pub fn new(slots: usize) -> Live<V> {
        Live { slots: vec![Slot::EMPTY; slots], touched: Vec::new(), ray: 0 }
    }

    /// A new source ray begins: what follows counts as one contribution per slot.
    pub fn next_ray(&mut self) {
        self.ray += 1;
    }

    /// Adds to a slot, in the slot's unit (W mostly).
    #[inline]
    pub fn add(&mut self, slot: usize, value: [f64; V]) {
        let place = &mut self.slots[slot];
        if place.last != self.ray {
            if place.rays == 0 {
                self.touched.push(slot as u32);
            }
            place.last = self.ray;
            place.rays += 1;
        }
        for (sum, value) in place.sum.iter_mut().zip(value) {
            *sum += value;
        }
    }

    /// The sum in a slot so far.
    pub fn value(&self, slot: usize) -> [f64; V] {
        self.slots[slot].sum
    }

    /// Hands over the batch's sums and empties itself.
    pub fn finish(&mut self) -> Sums<V> {
        self.touched.sort_unstable();
        let mut entries = Vec::with_capacity(self.touched.len());
        for slot in self.touched.drain(..) {
            let Slot { sum, rays, .. } = std::mem::replace(&mut self.slots[slot as usize], Slot::EMPTY);
            entries.push(Entry { slot, rays: rays as u64, sum, spread: [0.0; V], most: sum });
        }
        self.ray = 0;
        Sums { batches: 1, entries }
    }
}

/// One slot of some batches.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Entry<const V: usize> {
    slot: u32,
    rays: u64,
    sum: [f64; V],
    /// Sum of squared deviations of the batches from their mean.
    spread: [f64; V],
    /// Largest sum of a batch.
    most: [f64; V],
}

/// Slots summed over whole batches, sparse, in order of slot.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Sums<const V: usize> {
    pub batches: u64,
    entries: Vec<Entry<V>>,
}

impl<const V: usize> Sums<V> {
    /// Both together. The caller keeps the order of batches: sums of floats depend on it.
    pub fn merge(self, other: Sums<V>) -> Sums<V> {
        let counts = [self.batches, other.batches];
        let mut merged = Vec::with_capacity(self.entries.len() + other.entries.len());
        let (mut left, mut right) = (self.entries.into_iter().peekable(), other.entries.into_iter().peekable());
        while let (Some(a), Some(b)) = (left.peek(), right.peek()) {
            if a.slot < b.slot {
                merged.extend(left.next().map(|a| a.beside(None, counts)));
            } else if b.slot < a.slot {
                merged.extend(right.next().map(|b| b.beside(None, [counts[1], counts[0]])));
            } else {
                merged.push(a.beside(Some(b), counts));
                left.next();
                right.next();
            }
        }
        merged.extend(left.map(|a| a.beside(None, counts)));
        merged.extend(right.map(|b| b.beside(None, [counts[1], counts[0]])));
        Sums { batches: self.batches + other.batches, entries: merged }
    }

    /// Sum in a slot over all batches, in every lane.
    pub fn values(&self, slot: usize) -> [f64; V] {
        self.find(slot).map_or([0.0; V], |entry| entry.sum)
    }

    /// Mean over batches and its error in one lane; zeros if nothing was ever added.
    pub fn estimate(&self, slot: usize, lane: usize) -> Estimate {
        self.find(slot).map_or(Estimate::default(), |entry| {
            let (mean, error) = mean_and_error(entry.sum[lane], entry.spread[lane], self.batches);
            Estimate { mean, error }
        })
    }

    /// Source rays that fed a slot.
    pub fn rays(&self, slot: usize) -> u64 {
        self.find(slot).map_or(0, |entry| entry.rays)
    }

    /// Share that the brightest batch has of the sum in a slot, in one lane; 0 if nothing was added.
    pub fn brightest(&self, slot: usize, lane: usize) -> f64 {
        self.find(slot).filter(|entry| entry.sum[lane] > 0.0).map_or(0.0, |entry| entry.most[lane] / entry.sum[lane])
    }

    fn find(&self, slot: usize) -> Option<&Entry<V>> {
        let found = self.entries.binary_search_by_key(&(slot as u32), |entry| entry.slot);
        found.ok().map(|i| &self.entries[i])
    }
}

impl<const V: usize> Entry<V> {
    /// This one over `batches[0]` batches together with another over `batches[1]`, in which nothing happened if there is
    /// none. Spreads add up with that of the two means (Chan, Golub, LeVeque, Am. Stat. 37, 1983, eq. 2.1b): no difference
    /// of large sums is ever formed.
    fn beside(&self, other: Option<&Entry<V>>, batches: [u64; 2]) -> Entry<V> {
        let [own, others] = batches.map(|n| n as f64);
        let mut both = *self;
        both.rays += other.map_or(0, |other| other.rays);
        for lane in 0..V {
            let (sum, spread) = other.map_or((0.0, 0.0), |other| (other.sum[lane], other.spread[lane]));
            both.most[lane] = both.most[lane].max(other.map_or(0.0, |other| other.most[lane]));
            let apart = self.sum[lane] / own - sum / others;
            both.sum[lane] += sum;
            both.spread[lane] += spread + apart * apart * own * others / (own + others);
        }
        both
    }
}

/// Folds batches, given in order, in a binary tree fixed on the batch index: 0..8 is ((0 1)(2 3))((4 5)(6 7)), whatever the
/// number of threads or of sub-runs that are whole subtrees.
#[derive(Clone, Debug, Default)]
pub struct Fold<const V: usize> {
    /// Complete subtrees, largest first; sizes are the binary digits of the number of batches.
    subtrees: Vec<Sums<V>>,
}

impl<const V: usize> Fold<V> {
    /// Takes the next complete subtree (a single batch, or 2^k batches that start at a multiple of 2^k).
    pub fn push(&mut self, mut sums: Sums<V>) {
        while let Some(last) = self.subtrees.pop_if(|last| last.batches == sums.batches) {
            sums = last.merge(sums);
        }
        self.subtrees.push(sums);
    }

    /// Everything so far.
    pub fn total(&self) -> Sums<V> {
        let folded = self.subtrees.iter().rev().cloned().reduce(|right, left| left.merge(right));
        folded.unwrap_or(Sums { batches: 0, entries: Vec::new() })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn batch(live: &mut Live<1>, seed: u64) -> Sums<1> {
        for k in 0..50u64 {
            live.next_ray();
            let slot = (crate::math::rng::mix(seed * 50 + k) % 7) as usize;
            live.add(slot, [0.1 * k as f64]);
            live.add(slot, [0.3]);
        }
        live.finish()
    }

    #[test]
    fn folding_by_subtrees_gives_the_same_bits_as_folding_by_batches() {
        let mut live = Live::new(8);
        let batches: Vec<_> = (0..13).map(|i| batch(&mut live, i)).collect();
        let mut single = Fold::default();
        batches.iter().cloned().for_each(|b| single.push(b));
        let mut grouped = Fold::default();
        for group in batches.chunks(4) {
            let mut fold = Fold::default();
            group.iter().cloned().for_each(|b| fold.push(b));
            fold.subtrees.into_iter().for_each(|s| grouped.push(s));
        }
        assert_eq!(single.total(), grouped.total());
    }

    #[test]
    fn a_source_ray_counts_once_per_slot() {
        let mut live = Live::<1>::new(2);
        live.next_ray();
        live.add(0, [1.0]);
        live.add(0, [1.0]);
        live.next_ray();
        live.add(0, [1.0]);
        let sums = live.finish();
        assert_eq!(sums.rays(0), 2);
        assert_eq!(sums.estimate(0, 0).mean, 3.0);
        assert_eq!(sums.rays(1), 0);
    }

    /// STA-05: 1e8 hits of 1e-8 W make one watt; an f32 pixel stalls at 0.25.
    #[test]
    fn many_small_hits_add_up() {
        let (mut live, mut fold) = (Live::<1>::new(1), Fold::default());
        for _ in 0..1000 {
            for _ in 0..100_000 {
                live.next_ray();
                live.add(0, [1e-8]);
            }
            fold.push(live.finish());
        }
        let total = fold.total();
        assert_eq!(total.rays(0), 100_000_000);
        assert!((total.estimate(0, 0).mean * 1000.0 - 1.0).abs() < 1e-9);
    }
}

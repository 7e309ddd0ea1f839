//! Low-discrepancy points for emission: Owen-scrambled Sobol blocks.
//!
//! Each batch of source rays is one block of at most 2^16 points under a scramble of its own, so batches stay independent and
//! their scatter is an honest error, while the points of one batch cover position and direction evenly.
//! Source: B. Burley, "Practical hash-based Owen scrambling", JCGT 9(4), 2020.

use crate::math::rng::mix;

/// Longest block: the sequence repeats beyond it.
pub const BLOCK: u64 = 1 << 16;

/// One scrambled block.
#[derive(Clone, Copy, Debug)]
pub struct Block {
    scramble: u32,
}

impl Block {
    /// The block of batch `batch` under `seed`.
    pub fn new(seed: u64, batch: u64) -> Block {
        Block { scramble: (mix(mix(seed) ^ batch.wrapping_mul(0x9e37_79b9_7f4a_7c15)) >> 32) as u32 }
    }

    /// Coordinate `dimension` of point `index` < 2^16, uniform in [0, 1). The sequence has 23 bits; `fine`, a uniform of
    /// [0, 1), fills the rest, so that a beam has no grid.
    pub fn coordinate(&self, index: u32, dimension: u32, fine: f64) -> f64 {
        let coarse = sobol_burley::sample(index, dimension, self.scramble) as f64;
        coarse + fine * (0.5f64).powi(23)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_block_fills_every_stratum_once() {
        let block = Block::new(3, 11);
        let mut seen = vec![false; 4096];
        for i in 0..4096 {
            let x = block.coordinate(i, 0, 0.5);
            assert!((0.0..1.0).contains(&x));
            let cell = (x * 4096.0) as usize;
            assert!(!std::mem::replace(&mut seen[cell], true));
        }
    }

    #[test]
    fn points_keep_inside_the_unit_interval_at_both_ends() {
        let block = Block::new(1, 2);
        for i in 0..BLOCK as u32 {
            let x = block.coordinate(i, 1, 1.0 - f64::EPSILON);
            assert!((0.0..1.0).contains(&x));
        }
    }
}

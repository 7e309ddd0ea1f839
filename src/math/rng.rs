//! Counter-based random numbers: every draw is a pure function of its address.
//!
//! Philox-4x32-10 (Salmon, Moraes, Dror, Shaw, "Parallel random numbers: as easy as 1, 2, 3", SC11, 2011) turns a
//! 128-bit counter and a 64-bit key into 128 random bits. The key is the seed; the counter is the address
//!
//!     (source ray: 48 bits, branch of its event tree: 48 bits, draw: 32 bits),
//!
//! so a history is the same on any thread, in any split of a run, and can be replayed alone.

use rand_philox::philox4x32_10;

/// The random numbers of one branch of one source ray.
#[derive(Clone, Debug)]
pub struct Rng {
    key: [u32; 2],
    counter: [u32; 4],
    spare: Option<u64>,
}

impl Rng {
    /// Numbers of branch `branch` (48 bits used) of source ray `ray` (48 bits used) under `seed`.
    pub fn new(seed: u64, ray: u64, branch: u64) -> Rng {
        let high = (((ray >> 32) & 0xffff) << 16 | ((branch >> 32) & 0xffff)) as u32;
        Rng { key: [seed as u32, (seed >> 32) as u32], counter: [0, ray as u32, high, branch as u32], spare: None }
    }

    /// 64 random bits.
    #[inline]
    pub fn bits(&mut self) -> u64 {
        if let Some(bits) = self.spare.take() {
            return bits;
        }
        let [a, b, c, d] = philox4x32_10(self.counter, self.key);
        self.counter[0] = self.counter[0].wrapping_add(1);
        self.spare = Some((c as u64) << 32 | d as u64);
        (a as u64) << 32 | b as u64
    }

    /// Uniform in [0, 1), 53 bits.
    #[inline]
    pub fn uniform(&mut self) -> f64 {
        (self.bits() >> 11) as f64 * (0.5f64).powi(53)
    }

    /// Uniform in (0, 1], 53 bits: safe under a logarithm or a division.
    pub fn positive(&mut self) -> f64 {
        ((self.bits() >> 11) + 1) as f64 * (0.5f64).powi(53)
    }

    /// Two uniforms in [0, 1).
    #[inline]
    pub fn pair(&mut self) -> [f64; 2] {
        [self.uniform(), self.uniform()]
    }
}

/// Bijective 64-bit mixing (SplitMix64 finaliser; Steele, Lea, Flood, OOPSLA 2014). Makes branch addresses and path keys.
pub fn mix(x: u64) -> u64 {
    let x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    x ^ (x >> 31)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The known-answer vectors published with Random123 (kat_vectors, philox4x32 10 rounds).
    #[test]
    fn philox_reproduces_the_published_vectors() {
        assert_eq!(philox4x32_10([0; 4], [0; 2]), [0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8]);
        assert_eq!(philox4x32_10([u32::MAX; 4], [u32::MAX; 2]), [0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd]);
        assert_eq!(
            philox4x32_10([0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344], [0xa4093822, 0x299f31d0]),
            [0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1]
        );
    }

    #[test]
    fn every_address_has_its_own_stream() {
        let first = |ray, branch| Rng::new(7, ray, branch).bits();
        assert_ne!(first(0, 1), first(1, 0));
        assert_ne!(first(1 << 32, 0), first(0, 1 << 32));
        assert_ne!(first(1, 0), first(1 << 40, 0));
        assert_eq!(first(5, 9), first(5, 9));
    }
}

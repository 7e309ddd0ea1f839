//! Drawing an entry in proportion to its mass in one step: a table that is searched by halves would cost a cache miss per half.
//!
//! Every slot k of n holds two entries: k itself below a threshold, another above, such that the parts of each entry add up to
//! its mass. Source: Walker, ACM Trans. Math. Software 3, 253 (1977); built as by Vose, IEEE Trans. Software Eng. 17, 972 (1991).

/// The slots.
#[derive(Clone, Debug)]
pub struct Alias {
    /// Threshold, 0..1, and the entry above it.
    slots: Vec<(f64, u32)>,
}

impl Alias {
    /// Entries in proportion to `mass` (>= 0; fewer than 2^32). If all are zero, so are the draws without meaning.
    pub fn new(mass: &[f64]) -> Alias {
        let mean = mass.iter().sum::<f64>() / mass.len() as f64;
        let mut rest: Vec<f64> = mass.iter().map(|m| m / mean).collect();
        let mut slots: Vec<(f64, u32)> = (0u32..).zip(mass).map(|(k, _)| (1.0, k)).collect();
        let (mut small, mut large): (Vec<usize>, Vec<usize>) = (0..mass.len()).partition(|&k| rest[k] < 1.0);
        while let (Some(&poor), Some(&rich)) = (small.last(), large.last()) {
            small.pop();
            slots[poor] = (rest[poor], rich as u32);
            rest[rich] -= 1.0 - rest[poor];
            if rest[rich] < 1.0 {
                large.pop();
                small.push(rich);
            }
        }
        // What is left over is full but for rounding; an entry of no mass among it gives way to the greatest.
        let greatest = (0..mass.len()).max_by(|&a, &b| mass[a].total_cmp(&mass[b])).unwrap_or(0);
        small.into_iter().filter(|&k| mass[k] <= 0.0).for_each(|k| slots[k] = (0.0, greatest as u32));
        Alias { slots }
    }

    /// Entry drawn by `u` in [0, 1), and a number uniform in [0, 1) left over in it. Never an entry of zero mass.
    pub fn draw(&self, u: f64) -> (usize, f64) {
        let scaled = u * self.slots.len() as f64;
        let slot = (scaled as usize).min(self.slots.len() - 1);
        let part = (scaled - slot as f64).min(1.0 - f64::EPSILON);
        let (threshold, other) = self.slots[slot];
        // Looked up, not branched to: a branch would be guessed wrongly half of the time.
        let own = usize::from(part < threshold);
        let (from, to) = [(threshold, 1.0), (0.0, threshold)][own];
        ([other as usize, slot][own], (part - from) / (to - from))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Probability of each entry, from the slots.
    fn probabilities(alias: &Alias) -> Vec<f64> {
        let mut p = vec![0.0; alias.slots.len()];
        for (k, &(threshold, other)) in alias.slots.iter().enumerate() {
            p[k] += threshold / alias.slots.len() as f64;
            p[other as usize] += (1.0 - threshold) / alias.slots.len() as f64;
        }
        p
    }

    #[test]
    fn entries_are_drawn_in_proportion_to_their_mass() {
        for mass in [vec![1.0], vec![0.0, 1.0, 0.0, 3.0, 0.0], (0..1000).map(|k| f64::from(k).powi(9)).collect()] {
            let total: f64 = mass.iter().sum();
            let p = probabilities(&Alias::new(&mass));
            assert!(p.iter().zip(&mass).all(|(p, m)| (p - m / total).abs() < 1e-14));
            assert!(p.iter().zip(&mass).all(|(p, m)| *m > 0.0 || *p == 0.0));
        }
    }

    #[test]
    fn the_rest_is_uniform() {
        let alias = Alias::new(&[1.0, 3.0]);
        assert_eq!(alias.draw(0.125), (0, 0.25 / 0.5));
        assert_eq!(alias.draw(0.375), (1, 0.25 / 0.5));
        assert_eq!(alias.draw(0.5), (1, 0.0));
        assert!(alias.draw(1.0 - f64::EPSILON / 2.0).1 < 1.0);
    }
}

//! Rounds of a sweep: every round doubles the rays of the directions that are not yet known well enough.
//!
//! Round k traces its directions together, in one run with random numbers of its own: its bits depend on the system, the seed, k and
//! which directions take part, on nothing else. What was traced before can therefore stand for it. Rounds are weighted by
//! their rays, never by their errors, which would favour those that missed what is rare.

use crate::math::rng::mix;
use crate::packet::Class;
use crate::scene::Scene;
use crate::settings::Settings;
use crate::system::compile::Sweep;
use crate::tally::results::Estimate;
use crate::transport::{self, Counts, summary, walk};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::sync::atomic::AtomicBool;

/// Source rays of a direction in the first round, and in the second.
const FIRST: u64 = 1 << 13;

/// Fewest contributing source rays for which a wanted precision counts as reached.
const FEWEST: u64 = 100;

/// Batches of a round at least.
const BATCHES: u64 = 64;

/// Rays of a direction in a batch at least, and of all in a batch at most.
const SHARE: u64 = 4;
const MOST_IN_BATCH: u64 = 4096;

/// What is asked of a sweep.
#[derive(Clone, Copy)]
pub struct Plan<'a> {
    pub sweep: &'a Sweep,
    pub settings: &'a Settings,
    /// Source rays of a direction at most; rounded up to whole rounds.
    pub most: u64,
    /// Relative standard error of the PST at which a direction is known well enough.
    pub until: f64,
}

/// What one round found.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Round {
    pub seen: Vec<Seen>,
    /// Reasons not to trust it, in words.
    pub warnings: Vec<String>,
}

/// What came from one direction.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Seen {
    /// Index into the directions of the sweep.
    pub direction: usize,
    /// Source rays, and those that contributed.
    pub rays: u64,
    pub contributing: u64,
    /// Those of stray light, at most.
    pub stray: u64,
    /// On the whole detector, W.
    pub flux_w: Estimate,
    /// Share that the brightest batch brought.
    pub brightest: f64,
    /// Flux by index of the class, W.
    pub classes: Vec<(usize, Estimate)>,
}

/// Traces rounds until every direction is known well enough, or has its rays, or `stop` is set: an unfinished round is dropped.
/// Rounds that are `kept` from before are not traced again. `done` is called with all rounds after each that was traced.
pub fn trace(
    scene: &mut Scene,
    plan: &Plan,
    kept: &[Round],
    stop: &AtomicBool,
    done: &mut dyn FnMut(&[Round]),
) -> Vec<Round> {
    let mut rounds: Vec<Round> = Vec::new();
    for number in 0.. {
        let before = if number == 0 { 0 } else { FIRST << (number - 1) };
        let open = plan.open(&rounds);
        if before >= plan.most || open.is_empty() {
            break;
        }
        let same = |round: &&Round| round.seen.iter().map(|seen| seen.direction).eq(open.iter().copied());
        if let Some(round) = kept.get(number).filter(same) {
            rounds.push(round.clone());
            continue;
        }
        let Some(round) = one(scene, plan, number as u64, &open, before.max(FIRST), stop) else { break };
        rounds.push(round);
        done(&rounds);
    }
    rounds
}

impl Plan<'_> {
    /// Directions that are not yet known well enough.
    pub fn open(&self, rounds: &[Round]) -> Vec<usize> {
        let precise = |direction: usize| {
            let seen = Seen::of_all(rounds, direction);
            seen.contributing >= FEWEST && seen.flux_w.error <= self.until * seen.flux_w.mean
        };
        (0..self.sweep.directions()).filter(|&direction| !precise(direction)).collect()
    }
}

/// One round over the directions `open`, with so many rays each; `None` if it was stopped.
fn one(scene: &mut Scene, plan: &Plan, number: u64, open: &[usize], each: u64, stop: &AtomicBool) -> Option<Round> {
    let rays = each * open.len() as u64;
    let share = (SHARE * open.len() as u64).next_power_of_two();
    let batch = (1 << (rays / BATCHES).ilog2()).min(MOST_IN_BATCH).max(share);
    let settings = Settings {
        rays,
        seed: mix(plan.settings.seed ^ mix(0x7073_7421 + number)),
        batch: Some(batch),
        until: None,
        paths: 0,
        ..plan.settings.clone()
    };
    let shining = open.iter().map(|direction| scene.sources[plan.sweep.first + direction].clone()).collect();
    let all = std::mem::replace(&mut scene.sources, shining);
    let counts = transport::run::<1>(scene, &settings, stop, &|_| ());
    let round = (!counts.interrupted && counts.sums.batches == settings.batches())
        .then(|| seen(scene, plan.sweep.detector, &settings, &counts, open));
    scene.sources = all;
    round
}

fn seen(scene: &Scene, detector: usize, settings: &Settings, counts: &Counts<1>, open: &[usize]) -> Round {
    let (layout, sums) = (&counts.layout, &counts.sums);
    let quotas = walk::quotas(scene, counts.batch_rays);
    let seen = open.iter().enumerate().map(|(source, &direction)| {
        let slot = layout.source(detector, source);
        let class = |class: usize| (class, sums.estimate(layout.source_class(detector, source, class), 0));
        let stray = (0..Class::COUNT).filter(|class| *class != scene.image().index());
        let stray: u64 = stray.map(|class| sums.rays(layout.source_class(detector, source, class))).sum();
        Seen {
            direction,
            rays: quotas[source].count * sums.batches,
            contributing: sums.rays(slot),
            stray: stray.min(sums.rays(slot)),
            flux_w: sums.estimate(slot, 0),
            brightest: sums.brightest(slot, 0),
            classes: (0..Class::COUNT).map(class).filter(|(_, flux)| flux.mean > 0.0).collect(),
        }
    });
    let seen = seen.collect();
    let doubts = summary::results(scene, settings, counts, 0, BTreeMap::new(), Vec::new());
    // Where the whole can be trusted, its warnings are about single numbers, of which the curve speaks itself.
    Round { seen, warnings: if doubts.trusted { Vec::new() } else { doubts.warnings } }
}

impl Seen {
    /// Source rays that a verdict on stray light can rest on: those that brought any, but one if a single batch had more of it than `most`.
    pub fn resolved(&self, most: f64) -> u64 {
        if self.brightest > most { self.stray.min(1) } else { self.stray }
    }

    /// One direction over all rounds, weighted by their rays.
    pub fn of_all(rounds: &[Round], direction: usize) -> Seen {
        let parts = rounds.iter().flat_map(|round| round.seen.iter().find(|seen| seen.direction == direction));
        let parts: Vec<&Seen> = parts.collect();
        let rays: u64 = parts.iter().map(|seen| seen.rays).sum();
        let share = |seen: &Seen| seen.rays as f64 / rays as f64;
        let mean = |of: &dyn Fn(&Seen) -> Estimate| {
            let [mean, variance] = parts.iter().fold([0.0; 2], |[mean, variance], seen| {
                let part = of(seen);
                [mean + share(seen) * part.mean, variance + (share(seen) * part.error).powi(2)]
            });
            Estimate { mean, error: variance.sqrt() }
        };
        let flux_w = mean(&|seen| seen.flux_w);
        let class = |class: usize| {
            let of =
                |seen: &Seen| seen.classes.iter().find(|part| part.0 == class).map_or_else(Estimate::default, |p| p.1);
            (class, mean(&of))
        };
        let brightest = |seen: &&Seen| share(seen) * seen.brightest * seen.flux_w.mean / flux_w.mean;
        Seen {
            direction,
            rays,
            contributing: parts.iter().map(|seen| seen.contributing).sum(),
            stray: parts.iter().map(|seen| seen.stray).sum(),
            flux_w,
            brightest: parts.iter().map(brightest).filter(|share| share.is_finite()).fold(0.0, f64::max),
            classes: (0..Class::COUNT).map(class).filter(|(_, flux)| flux.mean > 0.0).collect(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rounds_are_weighted_by_their_rays() {
        let round = |rays: u64, mean: f64, error: f64| Round {
            seen: vec![Seen {
                direction: 3,
                rays,
                contributing: rays,
                stray: rays,
                flux_w: Estimate { mean, error },
                brightest: 0.5,
                classes: vec![(2, Estimate { mean, error })],
            }],
            warnings: Vec::new(),
        };
        let all = Seen::of_all(&[round(100, 1.0, 0.3), round(300, 3.0, 0.1)], 3);
        assert_eq!((all.rays, all.contributing), (400, 400));
        assert!((all.flux_w.mean - 2.5).abs() < 1e-15);
        assert!((all.flux_w.error - 0.075f64.hypot(0.075)).abs() < 1e-15);
        // Half of the 300 rays' light was in one batch.
        assert!((all.brightest - 0.5 * 0.75 * 3.0 / 2.5).abs() < 1e-15);
        assert_eq!(all.classes, [(2, all.flux_w)]);
        assert_eq!(Seen::of_all(&[round(100, 1.0, 0.3)], 1).rays, 0);
    }
}

//! Whether what was learned pays: a short run each way, by random numbers of its own, before the run.
//!
//! The measure is 1 / (R^2 cost), R being the relative error of a number that the run will report, and the cost that of flights and of
//! scatter events drawn by importance. What is taken decides how light is drawn, never what it weighs, and was decided before the run
//! proper began: nothing is biased.

use super::Plan;
use super::book::Book;
use super::importance::Importance;
use super::paths::Rows;
use crate::math::rng::mix;
use crate::packet::Class;
use crate::scene::Scene;
use crate::tally::{Fold, Layout, Live, Sums};
use rayon::prelude::*;
use std::ops::Range;
use std::sync::atomic::{AtomicBool, Ordering};

/// Part of the run's rays that each way is tried with, and the least and the most.
const PART: u64 = 64;
const RAYS: [u64; 2] = [4096, 1 << 17];
/// Batches that the trial is made of, so that it has errors.
const BATCHES: u64 = 32;
/// Classes below this share of the stray light do not count.
const LEAST: f64 = 1e-3;
/// Classes of stray light.
const STRAY: Range<usize> = 2..Class::COUNT;
/// Cost of a scatter event that is drawn by importance, in flights; measured in a sphere and in a baffled tube.
const GUIDED: u64 = 4;
/// Relative error of what a trial has not seen: some source rays that bring it are rare, and some very rare.
const UNSEEN: f64 = 30.0;
/// Smallest relative error that is not rounding.
const KNOWN: f64 = 1e-9;

/// Figure of merit of the plan with `learned` over that without, the geometric mean over all numbers.
pub fn trial<const V: usize>(plan: &Plan, learned: &Importance, stop: &AtomicBool) -> f64 {
    let layout = plan.scene.layout(0);
    let size = (plan.settings.rays / PART).clamp(RAYS[0], RAYS[1]) / BATCHES;
    // Every source has a ray in every batch.
    let size = size.max(plan.scene.sources.len() as u64);
    let quotas = super::walk::quotas(plan.scene, size);
    let run = |importance: &Importance| {
        let plan = Plan { importance, backward: None, quotas: &quotas, batch_rays: size, ..*plan };
        traced::<V>(&plan, &layout, stop)
    };
    let [without, with] = [plan.importance, learned].map(run);
    let cost = without.1 as f64 / with.1.max(1) as f64;
    let logs = numbers(plan.scene, &layout, [&without.0, &with.0]).filter_map(|(weight, whole, slot)| {
        let [a, b] = [&without.0, &with.0].map(|sums| squared(sums, whole, slot));
        // What neither has seen says nothing.
        (a.min(b) < UNSEEN * UNSEEN).then(|| [weight, weight * (cost * a / b).ln()])
    });
    let [weight, sum] = logs.fold([0.0; 2], |[w, s], [weight, log]| [w + weight, s + log]);
    if weight > 0.0 { (sum / weight).exp() } else { 1.0 }
}

/// Square of the relative error of a number, with that of nothing for what is hardly any part of the flux `whole`.
fn squared<const V: usize>(sums: &Sums<V>, whole: usize, slot: usize) -> f64 {
    let (all, own) = (sums.estimate(whole, 0).mean, sums.estimate(slot, 0));
    let seen = own.mean > 1e-6 * all;
    if seen { (own.error / own.mean).clamp(KNOWN, 1.0).powi(2) } else { UNSEEN * UNSEEN }
}

/// Slots of numbers that count, with their weights and the slots of what they are part of: on every detector each source, if there are
/// several, for then it is a sweep; else the classes of stray light by their share of it (the signal where there is no other).
fn numbers<'a, const V: usize>(
    scene: &'a Scene,
    layout: &'a Layout,
    trials: [&'a Sums<V>; 2],
) -> impl Iterator<Item = (f64, usize, usize)> + use<'a, V> {
    let most = move |slot: usize| trials.map(|sums| sums.estimate(slot, 0).mean).into_iter().fold(0.0, f64::max);
    (0..scene.detectors.len()).flat_map(move |detector| {
        let flux = move |class: usize| most(layout.class(detector, class));
        let stray = STRAY.map(flux).sum::<f64>();
        let counting = if stray > 0.0 { STRAY } else { 0..STRAY.start };
        let all: f64 = counting.clone().map(flux).sum();
        let classes =
            counting.map(move |class| (flux(class) / all, layout.detector(detector), layout.class(detector, class)));
        let sweep = scene.sources.len() > 1;
        let apart = (0..scene.sources.len()).filter(move |_| sweep).map(move |source| {
            let slot = layout.source(detector, source);
            ((most(slot) > 0.0) as u8 as f64, slot, slot)
        });
        classes.filter(move |_| !sweep).chain(apart).filter(|(weight, ..)| *weight >= LEAST)
    })
}

/// Sums and cost of a trial, in flights.
fn traced<const V: usize>(plan: &Plan, layout: &Layout, stop: &AtomicBool) -> (Sums<V>, u64) {
    let rows = Rows::default();
    let seed = mix(plan.settings.seed ^ 0x7472_6961_6c21);
    let batch = |batch: u64| {
        (!stop.load(Ordering::Relaxed)).then(|| {
            let mut book = plan.trace::<V>(Book::new(layout, Live::new(layout.len()), Some(&rows)), seed, batch);
            (book.finish(), book.segments + GUIDED * book.guided)
        })
    };
    let batches: Vec<_> = (0..BATCHES).into_par_iter().map(batch).collect();
    let (mut fold, mut all) = (Fold::default(), 0);
    for (sums, cost) in batches.into_iter().flatten() {
        fold.push(sums);
        all += cost;
    }
    (fold.total(), all)
}

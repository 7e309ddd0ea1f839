//! Ways that light took along the paths that brought most stray light: some batches of the run are traced once more, and watched.

use super::paths::Rows;
use super::walk::Walk;
use super::watch::Watch;
use super::{Live, Plan, Sums, book::Book};
use crate::detector::Arrival;
use crate::geometry::{Left, Ray};
use crate::packet::Ancestry;
use crate::tally::Layout;
use glam::DVec3;
use rayon::prelude::*;
use std::collections::BTreeMap;

/// Paths of each detector that are followed, stray light first, and ways of each that are kept.
const PATHS: usize = 12;
const WAYS: usize = 24;
/// Part of the batches that may be traced again, and batches at most.
const PART: u64 = 16;
const MOST: u64 = 64;

/// A way of light along a row of the path table, from its source to its detector.
#[derive(Clone, Debug)]
pub struct Followed {
    pub row: usize,
    /// Scene coordinates, m.
    pub points: Vec<DVec3>,
    /// On arrival, W.
    pub flux: f64,
}

/// Ways along the strongest rows; few or none of a row that is fed by few rays, or backwards only.
pub(super) fn follow<const V: usize>(plan: &Plan, layout: &Layout, rows: &Rows, sums: &Sums<V>) -> Vec<Followed> {
    let wanted = strongest(plan, layout, rows, sums);
    let batches = sums.batches.div_ceil(PART).min(MOST);
    let trace = |batch: u64| {
        let book = Book::<V>::new(layout, Live::new(layout.len()), Some(rows));
        let follower = Follower {
            rows,
            wanted: &wanted,
            branch: (u64::MAX, 0, 0),
            path: None,
            points: Vec::new(),
            known: BTreeMap::new(),
            found: Vec::new(),
        };
        let mut walk = Walk::new(plan.scene, plan.settings, plan.importance, book, follower);
        walk.batch(batch, plan.quotas);
        walk.watch.found
    };
    let all: Vec<Vec<Followed>> = (0..batches).into_par_iter().map(trace).collect();
    let mut counts: BTreeMap<usize, usize> = BTreeMap::new();
    let keep = |way: &Followed| {
        let count = counts.entry(way.row).or_default();
        *count += 1;
        *count <= WAYS
    };
    all.into_iter().flatten().filter(keep).collect()
}

/// The rows that are followed: of each detector those of most flux, with the signal.
fn strongest<const V: usize>(plan: &Plan, layout: &Layout, rows: &Rows, sums: &Sums<V>) -> Vec<usize> {
    let flux = |row: usize| sums.estimate(layout.row(row), 0).mean;
    let of = |detector: usize| {
        let mut own: Vec<usize> = (0..rows.rows.len()).filter(|row| rows.rows[*row].detector == detector).collect();
        own.sort_by(|a, b| flux(*b).total_cmp(&flux(*a)).then(a.cmp(b)));
        own.truncate(PATHS);
        own
    };
    (0..plan.scene.detectors.len()).flat_map(of).collect()
}

/// Keeps the points of the branch in hand. Branches are followed the last one first, so those that a new one has in common with the one
/// before it are still there.
struct Follower<'a> {
    rows: &'a Rows,
    wanted: &'a [usize],
    /// History, events and path of the branch in hand.
    branch: (u64, u32, u64),
    path: Option<u64>,
    /// One for each event, from the source.
    points: Vec<DVec3>,
    /// Ways found of each row, and the history of the last.
    known: BTreeMap<usize, (usize, u64)>,
    found: Vec<Followed>,
}

impl Follower<'_> {
    fn arrived(&mut self, row: usize, flux: f64, end: DVec3) {
        // One way of each source ray: its branches are much alike.
        let history = self.branch.0;
        let known = self.known.entry(row).or_insert((0, u64::MAX));
        if known.0 < WAYS && known.1 != history {
            *known = (known.0 + 1, history);
            let points = self.points.iter().copied().chain([end]).collect();
            self.found.push(Followed { row, points, flux });
        }
    }
}

impl Watch for Follower<'_> {
    fn follows(&mut self, ancestry: &Ancestry, _flux: f64) {
        let branch = (ancestry.history, ancestry.events, ancestry.key);
        if self.branch != branch {
            self.branch = branch;
            self.points.truncate(ancestry.events as usize);
            self.path = (ancestry.events as usize == ancestry.steps.len()).then_some(ancestry.key);
        }
    }

    fn flight(&mut self, ray: &Ray, _left: &Left) {
        // Where nothing acts, light goes straight on: no corner.
        if self.points.len() <= self.branch.1 as usize {
            self.points.push(ray.origin);
        }
    }

    fn arrives(&mut self, detector: usize, arrival: &Arrival, flux: f64) {
        let row = self.path.and_then(|path| self.rows.find(detector, path)).filter(|row| self.wanted.contains(row));
        if let Some(row) = row {
            self.arrived(row, flux, arrival.point);
        }
    }
}

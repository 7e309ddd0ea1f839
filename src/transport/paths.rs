//! The path table: which sequences of surfaces and events get a row.
//!
//! Rows are chosen by a pilot run with random numbers of its own, so that the rows of the run proper are unbiased: a row is
//! not there *because* of the light that it counts. What has no row is summed exactly in "other".

use crate::packet::{Ancestry, Class, Step};
use std::collections::{BTreeMap, HashMap};

/// A row of the path table.
#[derive(Clone, Debug)]
pub struct Row {
    pub detector: usize,
    pub source: usize,
    pub steps: Vec<Step>,
    pub class: Class,
    pub ghosts: u16,
    pub scatters: u16,
    pub last_scatter: Option<Step>,
}

/// The rows, found by detector and path key.
#[derive(Clone, Debug, Default)]
pub struct Rows {
    pub rows: Vec<Row>,
    index: HashMap<(usize, u64), usize>,
}

impl Rows {
    /// Row of a path on a detector, if it has one.
    pub fn find(&self, detector: usize, key: u64) -> Option<usize> {
        self.index.get(&(detector, key)).copied()
    }
}

/// What the pilot saw.
#[derive(Clone, Debug, Default)]
pub struct Candidates {
    /// Flux and description by detector and path key.
    paths: HashMap<(usize, u64), (f64, Row)>,
    /// Sums of flux and of its square over all arrivals, by detector.
    arrivals: BTreeMap<usize, [f64; 2]>,
}

impl Candidates {
    /// Notes an arrival of `flux` (W); a path too long to spell out never gets a row.
    pub fn note(&mut self, detector: usize, ancestry: &Ancestry, flux: f64) {
        let [sum, squares] = self.arrivals.entry(detector).or_default();
        (*sum, *squares) = (*sum + flux, *squares + flux * flux);
        if !ancestry.is_spelled() {
            return;
        }
        let entry = self.paths.entry((detector, ancestry.key)).or_insert_with(|| (0.0, row(detector, ancestry)));
        entry.0 += flux;
    }

    /// Adds another pilot batch; call in order of batches, sums of floats depend on it.
    pub fn merge(mut self, other: Candidates) -> Candidates {
        for (key, (flux, row)) in other.paths {
            self.paths.entry(key).or_insert((0.0, row)).0 += flux;
        }
        for (detector, [sum, squares]) in other.arrivals {
            let all = self.arrivals.entry(detector).or_default();
            *all = [all[0] + sum, all[1] + squares];
        }
        self
    }

    /// Arrivals of equal flux that would know the flux as well as those on the worst-lit of `detectors` detectors:
    /// (sum of flux)^2 / sum of its squares (L. Kish, Survey Sampling, 1965, sec. 11.7).
    pub fn effective(&self, detectors: usize) -> f64 {
        let effective =
            |detector: usize| self.arrivals.get(&detector).map_or(0.0, |[sum, squares]| sum * sum / squares);
        (0..detectors).map(effective).fold(f64::INFINITY, f64::min)
    }

    /// The `most` fullest paths; ties by key, so that the choice is the same everywhere.
    pub fn admit(self, most: usize) -> Rows {
        let mut all: Vec<_> = self.paths.into_iter().collect();
        all.sort_by(|(ka, (fa, _)), (kb, (fb, _))| fb.total_cmp(fa).then(ka.cmp(kb)));
        all.truncate(most);
        let index = all.iter().enumerate().map(|(i, (key, _))| (*key, i)).collect();
        Rows { rows: all.into_iter().map(|(_, (_, row))| row).collect(), index }
    }
}

fn row(detector: usize, ancestry: &Ancestry) -> Row {
    Row {
        detector,
        source: ancestry.source as usize,
        steps: ancestry.steps.to_vec(),
        class: ancestry.class(),
        ghosts: ancestry.ghosts,
        scatters: ancestry.scatters,
        last_scatter: ancestry.last_scatter,
    }
}

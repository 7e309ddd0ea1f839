//! From slots to results: names, units, errors.

use super::Counts;
use super::book::coarse_cell;
use super::paths::Row;
use crate::detector::Detector;
use crate::filter::Filter;
use crate::math::statistics::{student95, variance_of_variance};
use crate::packet::{Class, Event, Step};
use crate::scene::Scene;
use crate::settings::Settings;
use crate::tally::layout::{Cut, Loss, PATH_GRID};
use crate::tally::results::*;
use crate::tally::{Layout, Sums};
use std::collections::BTreeMap;

/// Bins fed by fewer source rays than this are not resolved: their error bar is itself a guess.
const RESOLVED: u64 = 30;

/// Share of a detector's flux in one batch above which its error is a guess; every batch has 3 % of it at most where all are alike.
const BRIGHTEST: f64 = 0.25;

/// Lost flux above this fraction of the emitted makes a run not to be trusted.
const MOST_LOST: f64 = 1e-6;

/// Results of variant `lane`; `inputs` are the files read with their hashes, `warnings` what the compiler said. Parameters of
/// the system are left to who knows them.
pub fn results<const V: usize>(
    scene: &Scene,
    settings: &Settings,
    counts: &Counts<V>,
    lane: usize,
    inputs: BTreeMap<String, String>,
    mut warnings: Vec<String>,
) -> Results {
    let teller = Teller { scene, counts, lane };
    let ledger_w = teller.ledger();
    let doubts = teller.doubts(&ledger_w);
    let trusted = doubts.is_empty();
    warnings.extend(doubts);
    warnings.extend(teller.cautions());
    let named = |labels: Vec<&str>, first: usize| {
        let line = |(i, label): (usize, &&str)| (label.to_string(), teller.estimate(first + i));
        labels.iter().enumerate().map(line).filter(|(_, e)| e.mean != 0.0).collect::<BTreeMap<_, _>>()
    };
    let layout = &counts.layout;
    let mut absorbed_w = named(scene.parts.iter().map(|p| p.label.as_str()).collect(), layout.part(0));
    for (i, filling) in scene.media.iter().enumerate() {
        let estimate = teller.estimate(layout.medium(i));
        if estimate.mean != 0.0 {
            absorbed_w.insert(format!("medium {}", filling.label), estimate);
        }
    }
    Results {
        system: scene.name.clone(),
        rays: counts.sums.batches * counts.batch_rays,
        rays_requested: settings.rays,
        seed: settings.seed,
        batch_rays: counts.batch_rays,
        batches: counts.sums.batches,
        detectors: (0..scene.detectors.len()).map(|d| (scene.detectors[d].label.clone(), teller.detector(d))).collect(),
        ledger_w,
        absorbed_w,
        lost_w: named(Loss::ALL.map(Loss::label).to_vec(), layout.losses().start),
        terminated_w: named(Cut::ALL.map(Cut::label).to_vec(), layout.cuts().start),
        warnings,
        trusted,
        inputs,
        parameters: BTreeMap::new(),
        finishes: Vec::new(),
        importance: counts.guidance.clone(),
        path_grid: PATH_GRID,
        filters: (0..scene.detectors.len()).flat_map(|d| teller.filters(d)).collect(),
        paths: (0..scene.detectors.len()).flat_map(|d| teller.paths(d)).collect(),
        maps: (0..scene.detectors.len()).map(|d| teller.map(d, &|bin| layout.bin(d, bin))).collect(),
    }
}

/// A map of a detector on which there is no light.
pub fn empty_map(scene: &Scene, detector: usize) -> MapResult {
    let detector = &scene.detectors[detector];
    let grid = &detector.grid;
    let bins = grid.shape().iter().product();
    MapResult {
        detector: detector.label.clone(),
        filter: None,
        kind: grid.kind(),
        shape: grid.shape(),
        axes: grid.axes(),
        unit: grid.unit(),
        mean: vec![0.0; bins],
        error: vec![0.0; bins],
        rays: vec![0; bins],
        upper: vec![0.0; bins],
        extent: (0..bins).map(|bin| grid.extent(bin)).collect(),
        origin: (grid.origin() + scene.shift).to_array(),
        column_direction: grid.frame().x.to_array(),
        row_direction: grid.frame().y.to_array(),
        side: detector.side.label(),
    }
}

/// "sun > Lens_1.front:T > Barrel:S": the source, then every part or medium with what it did.
pub fn sequence(scene: &Scene, row: &Row) -> String {
    let step = |s: &Step| format!("{}:{}", label(scene, s), s.event().letter());
    let names = std::iter::once(scene.sources[row.source].label.clone()).chain(row.steps.iter().map(step));
    names.collect::<Vec<_>>().join(" > ")
}

/// Name of the part or medium of a step.
fn label<'a>(scene: &'a Scene, step: &Step) -> &'a str {
    match step.event() {
        Event::Bulk => &scene.media[step.number() as usize].label,
        _ => &scene.parts[step.number() as usize].label,
    }
}

struct Teller<'a, const V: usize> {
    scene: &'a Scene,
    counts: &'a Counts<V>,
    lane: usize,
}

impl<const V: usize> Teller<'_, V> {
    fn sums(&self) -> &Sums<V> {
        &self.counts.sums
    }

    fn estimate(&self, slot: usize) -> Estimate {
        self.sums().estimate(slot, self.lane)
    }

    fn ledger(&self) -> LedgerResult {
        LedgerResult {
            emitted: self.estimate(Layout::EMITTED),
            absorbed: self.estimate(Layout::ABSORBED),
            escaped: self.estimate(Layout::ESCAPED),
            terminated: self.estimate(Layout::TERMINATED),
            lost: self.estimate(Layout::LOST),
            residual: self.estimate(Layout::RESIDUAL),
        }
    }

    /// Reasons not to trust the run, in words.
    fn doubts(&self, ledger: &LedgerResult) -> Vec<String> {
        let mut doubts = Vec::new();
        let (emitted, residual) = (ledger.emitted.mean, ledger.residual);
        if ledger.lost.mean > MOST_LOST * emitted || ledger.lost.mean.is_nan() {
            let share = 100.0 * ledger.lost.mean / emitted;
            doubts.push(format!("{share:.2e} % of the emitted flux was lost to geometry faults"));
        }
        // Five sigma: one run in two million by chance; 1e-12 is the rounding of a sum of many small terms.
        if residual.mean.abs() > 5.0 * residual.error + 1e-12 * emitted || residual.mean.is_nan() {
            doubts
                .push(format!("the ledger does not close: residual {:.3e} ± {:.1e} W", residual.mean, residual.error));
        }
        let backwards = self.estimate(Layout::LOST_BACKWARDS).mean;
        if backwards > MOST_LOST {
            let share = 100.0 * backwards;
            doubts.push(format!(
                "{share:.2e} % of what detectors sent out backwards was cut by max_events or lost to geometry faults"
            ));
        }
        if self.estimate(self.counts.layout.cut(Cut::Events)).mean > 0.0 {
            doubts.push("the limit max_events cut some light: see the ledger".into());
        }
        doubts
    }

    /// Errors that are guesses, in words.
    fn cautions(&self) -> Vec<String> {
        let caution = |label: String, slot: usize| {
            let share = self.sums().brightest(slot, self.lane);
            let (percent, batches) = (100.0 * share, self.sums().batches);
            let doubt =
                format!("one batch of {batches} brought {percent:.0} % of the flux, the error bar cannot be trusted");
            (share > BRIGHTEST).then(|| format!("{label}: {doubt}: more rays are needed"))
        };
        let (layout, sources) = (&self.counts.layout, &self.scene.sources);
        let of = |(d, detector): (usize, &Detector)| {
            let whole = caution(detector.label.clone(), layout.detector(d));
            let apart = sources.iter().enumerate().filter(|_| sources.len() > 1);
            let apart =
                apart.map(|(s, source)| (format!("{} from {}", detector.label, source.label), layout.source(d, s)));
            whole.into_iter().chain(apart.filter_map(|(label, slot)| caution(label, slot))).collect::<Vec<_>>()
        };
        self.scene.detectors.iter().enumerate().flat_map(of).collect()
    }

    fn detector(&self, d: usize) -> DetectorResult {
        let layout = &self.counts.layout;
        let slot = layout.detector(d);
        let flux_w = self.estimate(slot);
        let rays = self.sums().rays(slot);
        let fed: Vec<u64> =
            (0..layout.bins(d)).map(|b| self.sums().rays(layout.bin(d, b))).filter(|&r| r > 0).collect();
        let unresolved = fed.iter().filter(|&&r| r < RESOLVED).count() as f64 / fed.len().max(1) as f64;
        let classes = (0..Class::COUNT)
            .map(|c| (Class::from_index(c).label(self.scene.has_optics), self.estimate(layout.class(d, c))))
            .filter(|(_, e)| e.mean > 0.0)
            .collect();
        let sources = self.scene.sources.iter().enumerate();
        let sources = sources.map(|(s, source)| (source.label.clone(), self.estimate(layout.source(d, s)))).collect();
        DetectorResult {
            flux_w,
            interval95_w: flux_w.error * student95(self.sums().batches),
            rays,
            upper_limit_w: (rays == 0).then(|| self.upper()),
            peak_w_m2: self.peak(d, &|bin| layout.bin(d, bin)),
            unit: self.scene.detectors[d].grid.unit().into(),
            brightest_batch: self.sums().brightest(slot, self.lane),
            variance_of_variance: variance_of_variance(self.counts.fluxes[d].iter().map(|flux| flux[self.lane])),
            classes,
            sources,
            unresolved,
        }
    }

    /// Three times the largest flux that one source ray can carry over N, W: what an empty bin may still hide.
    fn upper(&self) -> f64 {
        let rays = (self.sums().batches * self.counts.batch_rays) as f64;
        3.0 * self.scene.sources.iter().map(|s| s.flux).sum::<f64>() / rays
    }

    /// Brightest bin of a detector whose bins have these slots.
    fn peak(&self, d: usize, slot: &dyn Fn(usize) -> usize) -> Peak {
        let grid = &self.scene.detectors[d].grid;
        let [_, columns] = grid.shape();
        let value = |bin: usize| {
            let extent = grid.extent(bin);
            let estimate = self.estimate(slot(bin));
            if extent > 0.0 { [estimate.mean / extent, estimate.error / extent] } else { [0.0; 2] }
        };
        let bins = 0..self.counts.layout.bins(d);
        let best = bins.max_by(|&a, &b| value(a)[0].total_cmp(&value(b)[0]).then(b.cmp(&a)));
        best.map_or(Peak::default(), |bin| {
            let [mean, error] = value(bin);
            Peak { mean, error, pixel: [bin / columns, bin % columns] }
        })
    }

    /// What every filter means of the light on a detector.
    fn filters(&self, d: usize) -> Vec<FilterResult> {
        let layout = &self.counts.layout;
        let total = self.estimate(layout.detector(d)).mean;
        let result = |(number, filter): (usize, &Filter)| {
            let flux_w = self.estimate(layout.filter(d, number));
            let rays = self.sums().rays(layout.filter(d, number));
            let slot = |bin: usize| layout.filter_bin(d, number, bin);
            FilterResult {
                filter: filter.label.clone(),
                expression: filter.text.clone(),
                detector: self.scene.detectors[d].label.clone(),
                flux_w,
                percent: if total > 0.0 { 100.0 * flux_w.mean / total } else { 0.0 },
                rays,
                upper_limit_w: (rays == 0).then(|| self.upper()),
                open_w: self.estimate(layout.filter_open(d, number)),
                peak_w_m2: self.peak(d, &slot),
                map: MapResult { filter: Some(filter.label.clone()), ..self.map(d, &slot) },
            }
        };
        self.scene.filters.iter().enumerate().map(result).collect()
    }

    /// Map of a detector whose bins have these slots.
    fn map(&self, d: usize, slot: &dyn Fn(usize) -> usize) -> MapResult {
        let upper = self.upper();
        let mut map = empty_map(self.scene, d);
        for bin in 0..map.mean.len() {
            let slot = slot(bin);
            let extent = map.extent[bin];
            map.rays[bin] = self.sums().rays(slot);
            if extent > 0.0 {
                let estimate = self.estimate(slot);
                map.mean[bin] = estimate.mean / extent;
                map.error[bin] = estimate.error / extent;
                map.upper[bin] = if map.rays[bin] == 0 { upper / extent } else { 0.0 };
            }
        }
        map
    }

    /// Rows of one detector, brightest first, and what had no row.
    fn paths(&self, d: usize) -> Vec<PathResult> {
        let total = self.estimate(self.counts.layout.detector(d)).mean;
        let areas = self.cell_areas(d);
        let rows = self.counts.rows.rows.iter().enumerate().filter(|(_, row)| row.detector == d);
        let mut paths: Vec<PathResult> = rows.filter_map(|(index, _)| self.path(index, total, &areas)).collect();
        paths.sort_by(|a, b| b.flux_w.mean.total_cmp(&a.flux_w.mean).then(a.sequence.cmp(&b.sequence)));
        let slot = self.counts.layout.other(d);
        let flux_w = self.estimate(slot);
        if flux_w.mean != 0.0 {
            paths.push(PathResult {
                detector: self.scene.detectors[d].label.clone(),
                source: String::new(),
                sequence: "other".into(),
                class: "mixed".into(),
                rays: self.sums().rays(slot),
                flux_w,
                percent: 100.0 * flux_w.mean / total,
                ghost_order: 0,
                scatter_order: 0,
                last_scatter: String::new(),
                optical_path_m: 0.0,
                peak_w_m2: 0.0,
            });
        }
        paths
    }

    fn path(&self, index: usize, total: f64, areas: &[f64]) -> Option<PathResult> {
        let layout = &self.counts.layout;
        let row = &self.counts.rows.rows[index];
        let flux_w = self.estimate(layout.row(index));
        // Other variants may have light on a path that this one has not.
        if flux_w.mean == 0.0 {
            return None;
        }
        let rays = self.sums().rays(layout.row(index));
        let cells = layout.row_cells(index).zip(areas).filter(|(_, area)| **area > 0.0);
        let peak = cells.map(|(slot, area)| self.estimate(slot).mean / area).fold(0.0, f64::max);
        let source = self.scene.sources[row.source].label.clone();
        Some(PathResult {
            detector: self.scene.detectors[row.detector].label.clone(),
            sequence: sequence(self.scene, row),
            source,
            class: row.class.label(self.scene.has_optics),
            rays,
            flux_w,
            percent: 100.0 * flux_w.mean / total,
            ghost_order: row.ghosts as u32,
            scatter_order: row.scatters as u32,
            last_scatter: row.last_scatter.map_or(String::new(), |step| label(self.scene, &step).into()),
            optical_path_m: self.estimate(layout.row_path(index)).mean / flux_w.mean,
            peak_w_m2: peak,
        })
    }

    /// Size of each cell of the coarse path grid, m2 or sr.
    fn cell_areas(&self, d: usize) -> Vec<f64> {
        let grid = &self.scene.detectors[d].grid;
        let mut areas = vec![0.0; PATH_GRID * PATH_GRID];
        for bin in 0..self.counts.layout.bins(d) {
            areas[coarse_cell(bin, grid.shape())] += grid.extent(bin);
        }
        areas
    }
}

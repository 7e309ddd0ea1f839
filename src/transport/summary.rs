//! From slots to results: names, units, errors.

use super::Counts;
use super::book::coarse_cell;
use super::paths::Row;
use crate::detector::Detector;
use crate::math::statistics::{student95, variance_of_variance};
use crate::packet::{Class, Event, Step};
use crate::scene::Scene;
use crate::settings::Settings;
use crate::tally::layout::{Cut, Loss, PATH_GRID};
use crate::tally::results::*;
use crate::tally::{Layout, Sums, series};
use std::collections::BTreeMap;

/// Bins fed by fewer source rays than this are not resolved: their error bar is itself a guess.
const RESOLVED: u64 = 30;

/// Share of a detector's flux in one batch above which its error is a guess; every batch has 3 % of it at most where all are alike.
const BRIGHTEST: f64 = 0.25;

/// Share of a detector's flux in one arrival above which the same holds.
const LARGEST: f64 = 0.1;

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
        requirements: Vec::new(),
        assumptions: Vec::new(),
        importance: counts.guidance.clone(),
        path_grid: PATH_GRID,
        paths: (0..scene.detectors.len()).flat_map(|d| teller.paths(d)).collect(),
        maps: (0..scene.detectors.len()).map(|d| teller.map(d)).collect(),
        drawing: None,
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
        let rare = (0..self.scene.detectors.len()).filter_map(|d| self.rare(d));
        self.scene.detectors.iter().enumerate().flat_map(of).chain(rare).collect()
    }

    /// One arrival that brings too much, in words.
    fn rare(&self, d: usize) -> Option<String> {
        let largest = self.largest(d).filter(|largest| largest.share > LARGEST)?;
        let (label, percent) = (&self.scene.detectors[d].label, 100.0 * largest.share);
        let doubt = format!("one arrival brought {percent:.0} % of the flux, the error bar cannot be trusted");
        Some(format!("{label}: {doubt}: {}", largest.sequence))
    }

    fn largest(&self, d: usize) -> Option<LargestResult> {
        let sum = self.sums().values(self.counts.layout.detector(d))[self.lane];
        self.counts.largest.told(self.scene, d, self.lane, sum)
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
            peak_w_m2: self.peak(d),
            unit: self.scene.detectors[d].unit().into(),
            counted: self.counted(d),
            regions: self.regions(d),
            brightest_batch: self.sums().brightest(slot, self.lane),
            variance_of_variance: variance_of_variance(self.counts.fluxes[d].iter().map(|flux| flux[self.lane])),
            largest: self.largest(d),
            classes,
            sources,
            stray: self.stray(d, flux_w),
            convergence: self.convergence(d),
            unresolved,
        }
    }

    /// Stray light, with the errors of sum and ratio from the batches.
    fn stray(&self, d: usize, flux_w: Estimate) -> StrayResult {
        let series = |part: usize| self.counts.parted[d].iter().map(|batch| batch[part][self.lane]).collect::<Vec<_>>();
        let [stray, signal] = [series(0), series(1)];
        let meant = self.scene.image().index();
        let classes = (0..Class::COUNT).filter(|class| *class != meant);
        let rays = classes.map(|class| self.sums().rays(self.counts.layout.class(d, class))).max().unwrap_or(0);
        let signal_w = Some(series::mean(&signal)).filter(|signal| signal.mean > 0.0);
        // The same number to the last digit where there is no other light.
        let flux_w = if signal_w.is_none() { flux_w } else { series::mean(&stray) };
        StrayResult { flux_w, signal_w, to_signal: series::ratio(&signal, &stray), rays, upper_limit_w: self.upper() }
    }

    fn convergence(&self, d: usize) -> Convergence {
        let fluxes: Vec<f64> = self.counts.fluxes[d].iter().map(|flux| flux[self.lane]).collect();
        let all = fluxes.len();
        let doublings = (2..).map(|k| 1 << k).take_while(|batches| *batches < all);
        let known = |batches: usize| Stage { batches: batches as u64, flux_w: series::mean(&fluxes[..batches]) };
        Convergence {
            stages: doublings.chain([all]).filter(|batches| *batches > 1).map(known).collect(),
            halves_w: [&fluxes[..all / 2], &fluxes[all / 2..]].map(series::mean),
        }
    }

    /// Three times the largest flux that one source ray can carry over N, W: what an empty bin may still hide.
    fn upper(&self) -> f64 {
        let rays = (self.sums().batches * self.counts.batch_rays) as f64;
        3.0 * self.scene.sources.iter().map(|s| s.flux).sum::<f64>() / rays
    }

    /// What the detector counts where that is not all watts.
    fn counted(&self, d: usize) -> Option<CountedResult> {
        let response = &self.scene.detectors[d].response;
        let total = self.estimate(self.counts.layout.counted(d));
        (!response.is_flux()).then(|| CountedResult { unit: response.unit().into(), total })
    }

    fn regions(&self, d: usize) -> BTreeMap<String, Estimate> {
        let regions = self.scene.detectors[d].regions.iter().enumerate();
        regions.map(|(r, region)| (region.label.clone(), self.estimate(self.counts.layout.region(d, r)))).collect()
    }

    /// Most that a watt of any source may count as.
    fn most(&self, d: usize) -> f64 {
        let steps = (0..=1000).map(|i| f64::from(i) / 1000.0);
        let response = &self.scene.detectors[d].response;
        let lights = self.scene.sources.iter().flat_map(|source| steps.clone().map(|u| source.spectrum.wavelength(u)));
        lights.map(|wavelength| response.of(wavelength)).fold(0.0, f64::max)
    }

    fn peak(&self, d: usize) -> Peak {
        let detector = &self.scene.detectors[d];
        let [_, columns] = detector.grid.shape();
        let value = |bin: usize| {
            let extent = detector.extent(bin);
            let estimate = self.estimate(self.counts.layout.bin(d, bin));
            if extent > 0.0 { [estimate.mean / extent, estimate.error / extent] } else { [0.0; 2] }
        };
        let bins = 0..self.counts.layout.bins(d);
        let best = bins.max_by(|&a, &b| value(a)[0].total_cmp(&value(b)[0]).then(b.cmp(&a)));
        best.map_or(Peak::default(), |bin| {
            let [mean, error] = value(bin);
            Peak { mean, error, pixel: [bin / columns, bin % columns] }
        })
    }

    fn map(&self, d: usize) -> MapResult {
        let detector = &self.scene.detectors[d];
        let grid = &detector.grid;
        let bins = self.counts.layout.bins(d);
        let upper = self.upper() * self.most(d);
        let mut map = MapResult {
            detector: detector.label.clone(),
            kind: grid.kind(),
            shape: grid.shape(),
            axes: grid.axes(),
            unit: detector.unit(),
            mean: vec![0.0; bins],
            error: vec![0.0; bins],
            rays: vec![0; bins],
            upper: vec![0.0; bins],
            extent: (0..bins).map(|bin| detector.extent(bin)).collect(),
            origin: (grid.origin() + self.scene.shift).to_array(),
            column_direction: grid.frame().x.to_array(),
            row_direction: grid.frame().y.to_array(),
            stray: self.stray_map(d),
            side: detector.side.label(),
        };
        for bin in 0..bins {
            let slot = self.counts.layout.bin(d, bin);
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

    /// Mean and error of stray light alone in every bin, where it is counted apart.
    fn stray_map(&self, d: usize) -> Option<[Vec<f64>; 2]> {
        let detector = &self.scene.detectors[d];
        let value = |bin: usize| {
            let estimate = self.estimate(self.counts.layout.stray_bin(d, bin)?);
            let extent = detector.extent(bin);
            Some(if extent > 0.0 { [estimate.mean / extent, estimate.error / extent] } else { [0.0; 2] })
        };
        let bins: Option<Vec<[f64; 2]>> = (0..self.counts.layout.bins(d)).map(value).collect();
        bins.map(|bins| [0, 1].map(|k| bins.iter().map(|bin| bin[k]).collect()))
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
                cells: Vec::new(),
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
        let density = |(slot, area): (usize, &f64)| if *area > 0.0 { self.estimate(slot).mean / area } else { 0.0 };
        let cells: Vec<f64> = layout.row_cells(index).zip(areas).map(density).collect();
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
            peak_w_m2: cells.iter().copied().fold(0.0, f64::max),
            cells,
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

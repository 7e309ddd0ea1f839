//! From slots to results: names, units, errors.

mod maps;
mod rows;

use super::Counts;
use super::paths::Row;
use super::walk::quotas;
use crate::detector::Detector;
use crate::math::statistics::{student95, variance_of_variance};
use crate::packet::{Class, Event, Step};
use crate::scene::Scene;
use crate::settings::Settings;
use crate::tally::layout::{Cut, Loss, PATH_GRID};
use crate::tally::results::*;
use crate::tally::{Layout, Sums, series};
pub use maps::empty_map;
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
        filters: (0..scene.detectors.len()).flat_map(|d| teller.filters(d)).collect(),
        paths: (0..scene.detectors.len()).flat_map(|d| teller.paths(d)).collect(),
        maps: (0..scene.detectors.len()).map(|d| teller.stray_and_all(d)).collect(),
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
        if !ledger.closes() {
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
            peak_w_m2: self.peak(d, &|bin| layout.bin(d, bin)),
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
        let brightest_batch = series::brightest(&stray);
        let to_signal = series::ratio(&signal, &stray);
        StrayResult { flux_w, signal_w, to_signal, rays, brightest_batch, upper_limit_w: self.upper() }
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
        let sources = &self.scene.sources;
        let quotas = quotas(self.scene, self.counts.batch_rays);
        let most =
            sources.iter().zip(&quotas).map(|(source, quota)| source.flux / quota.count as f64).fold(0.0, f64::max);
        3.0 * most / self.sums().batches as f64
    }
}

//! From bundles per batch to ghosts with errors.
//!
//! A flux is a mean over batches. Centroid, radius and focus are functions of sums over all batches; their errors are by the jackknife
//! over batches, var = (n - 1) / n sum (t_i - t)^2 with t_i the value without batch i and t their mean (Efron & Stein, Ann. Stat. 9, 1981).

use super::arrivals::{Caught, Key};
use super::bundle::{Bundle, Moments};
use crate::math::statistics::mean_and_error;
use crate::scene::Scene;
use crate::settings::Settings;
use crate::study::record::{mean, ratio};
use crate::tally::layout::Cut;
use crate::tally::results::{Estimate, MapResult, Peak};
use crate::tally::{Layout, Sums};
use crate::transport::summary::empty_map;
use serde::Serialize;
use std::collections::BTreeMap;

/// Lost flux above this fraction of the emitted makes a study not to be trusted.
const MOST_LOST: f64 = 1e-6;

/// Every ghost of a system.
#[derive(Clone, Debug, Serialize)]
pub struct Ghosts {
    pub system: String,
    /// Most unintended reflections that were followed.
    pub order: u16,
    pub rays: u64,
    pub seed: u64,
    pub batch_rays: u64,
    pub batches: u64,
    /// Flights from event to event.
    pub segments: u64,
    /// Surfaces that reflect what they should not, in the order in which light meets them.
    pub surfaces: Vec<String>,
    /// Light without any unintended reflection, by detector and source.
    pub signals: Vec<Ghost>,
    /// All sequences that the light began, by detector, source and falling flux; those that deliver nothing last.
    pub ghosts: Vec<Ghost>,
    pub warnings: Vec<String>,
    pub trusted: bool,
    /// SHA-256 of every file that was read, by name as written: left to who knows them.
    pub inputs: BTreeMap<String, String>,
}

/// One sequence of unintended reflections on one detector from one source.
#[derive(Clone, Debug, Serialize)]
pub struct Ghost {
    pub detector: String,
    pub source: String,
    /// In the order in which light meets them.
    pub surfaces: Vec<String>,
    pub flux_w: Estimate,
    /// Flux / flux of the signal; `None` if there is no signal.
    pub relative: Option<Estimate>,
    pub rays: u64,
    /// Where nothing arrives: 3 x the largest flux with which one source ray left the last of the surfaces, W.
    pub upper_limit_w: Option<f64>,
    /// Brightest bin of the detector's map, W/m2: the resolution is that of its bins.
    pub peak_w_m2: Peak,
    /// In the axes of the map, m; `None` where bins have no place on a plane, or nothing arrives.
    pub centroid_m: Option<[Estimate; 2]>,
    /// About the centroid, m.
    pub rms_radius_m: Option<Estimate>,
    /// Full width along columns and rows, m.
    pub size_m: Option<[f64; 2]>,
    /// Best focus, along the mean ray from the detector, m: positive beyond it. `None` where the rays are parallel as well.
    pub focus_m: Option<Estimate>,
    pub parallel: bool,
    #[serde(skip)]
    pub map: MapResult,
}

/// Bundles of all batches, as they come.
pub struct Ledger<'a> {
    scene: &'a Scene,
    entries: BTreeMap<Key, Entry>,
    train: Vec<u32>,
    unnamed: f64,
    segments: u64,
}

/// One sequence over all batches.
#[derive(Default)]
struct Entry {
    whole: Bundle,
    /// By batch; batches without light may be missing at the end.
    batches: Vec<Moments>,
    /// Sum of squares of the flux in a bin over batches, W2.
    squares: BTreeMap<u32, f64>,
}

impl Entry {
    fn take(&mut self, batch: usize, bundle: Bundle) {
        self.batches.resize(batch + 1, Moments::default());
        self.batches[batch] = bundle.sums;
        let whole = &mut self.whole;
        whole.begun = whole.begun.max(bundle.begun);
        whole.rays += bundle.rays;
        whole.sums = whole.sums.plus(&bundle.sums, 1.0);
        if let Some(new) = bundle.extremes {
            let old = whole.extremes.unwrap_or(new);
            whole.extremes = Some([0, 1].map(|a| [old[a][0].min(new[a][0]), old[a][1].max(new[a][1])]));
        }
        for (bin, (flux, rays)) in bundle.bins {
            let lit = whole.bins.entry(bin).or_default();
            *lit = (lit.0 + flux, lit.1 + rays);
            *self.squares.entry(bin).or_default() += flux * flux;
        }
    }

    /// A function of the sums with its error over `count` batches.
    fn told(&self, count: u64, value: impl Fn(&Moments) -> f64) -> Estimate {
        let n = count as f64;
        let without: Vec<f64> = self.batches.iter().map(|batch| value(&self.whole.sums.plus(batch, -1.0))).collect();
        let all = value(&self.whole.sums);
        let squares: f64 = without.iter().map(|other| (other - all).powi(2)).sum();
        Estimate { mean: all, error: ((n - 1.0) / n * squares).sqrt() }
    }
}

impl<'a> Ledger<'a> {
    pub fn new(scene: &'a Scene) -> Ledger<'a> {
        Ledger { scene, entries: BTreeMap::new(), train: Vec::new(), unnamed: 0.0, segments: 0 }
    }

    /// Takes a batch; in order.
    pub fn take(&mut self, batch: usize, caught: Caught) {
        for (key, bundle) in caught.bundles {
            self.entries.entry(key).or_default().take(batch, bundle);
        }
        if caught.train.len() > self.train.len() {
            self.train = caught.train;
        }
        self.unnamed += caught.unnamed;
        self.segments += caught.segments;
    }

    pub fn result(self, settings: &Settings, order: u16, batch_rays: u64, sums: &Sums<1>) -> Ghosts {
        let count = settings.batches();
        let all: Vec<Ghost> = self.entries.iter().map(|(key, entry)| self.ghost(key, entry, count)).collect();
        let (signals, mut ghosts): (Vec<_>, Vec<_>) = all.into_iter().partition(|ghost| ghost.surfaces.is_empty());
        let place = |ghost: &Ghost| (self.detector(&ghost.detector), self.source(&ghost.source));
        ghosts.sort_by(|a, b| place(a).cmp(&place(b)).then(b.flux_w.mean.total_cmp(&a.flux_w.mean)));
        let warnings = self.warnings(sums);
        Ghosts {
            system: self.scene.name.clone(),
            order,
            rays: count * batch_rays,
            seed: settings.seed,
            batch_rays,
            batches: count,
            segments: self.segments,
            surfaces: self.surfaces(),
            signals,
            ghosts,
            trusted: warnings.is_empty(),
            warnings,
            inputs: BTreeMap::new(),
        }
    }

    fn detector(&self, label: &str) -> Option<usize> {
        self.scene.detectors.iter().position(|detector| detector.label == label)
    }

    fn source(&self, label: &str) -> Option<usize> {
        self.scene.sources.iter().position(|source| source.label == label)
    }

    /// Labels of all parts that reflect, in the order of the train; those that are not in it follow.
    fn surfaces(&self) -> Vec<String> {
        let mut parts: Vec<u32> = self.entries.keys().flat_map(|key| key.parts.iter().copied()).collect();
        parts.sort_unstable();
        parts.dedup();
        let place = |part: &u32| self.train.iter().position(|met| met == part).unwrap_or(usize::MAX);
        parts.sort_by_key(place);
        parts.iter().map(|&part| self.scene.parts[part as usize].label.clone()).collect()
    }

    fn ghost(&self, key: &Key, entry: &Entry, count: u64) -> Ghost {
        let Key { detector, source, parts } = key;
        let names: Vec<String> = parts.iter().map(|&part| self.scene.parts[part as usize].label.clone()).collect();
        let signal = self.entries.get(&Key { parts: Default::default(), ..key.clone() });
        let fluxes = |entry: &Entry| series(&entry.batches, count);
        let own = fluxes(entry);
        let lit = entry.whole.rays > 0;
        let plane = lit && entry.whole.extremes.is_some();
        let on_plane = |value: &dyn Fn(&Moments) -> f64| plane.then(|| entry.told(count, value));
        // One batch alone has no error.
        let resolved = |value: &dyn Fn(&Moments) -> f64| {
            on_plane(value).filter(|known| known.mean.is_finite() && known.error.is_finite())
        };
        let map = self.map((*detector).into(), entry, count, &names);
        Ghost {
            detector: self.scene.detectors[*detector as usize].label.clone(),
            source: self.scene.sources[*source as usize].label.clone(),
            flux_w: mean(&own),
            relative: signal.and_then(|signal| ratio(&fluxes(signal), &own)),
            rays: entry.whole.rays,
            upper_limit_w: (!lit).then_some(3.0 * entry.whole.begun / count as f64),
            peak_w_m2: peak(&map),
            centroid_m: resolved(&|m| m.centroid(0)).zip(resolved(&|m| m.centroid(1))).map(|(x, y)| [x, y]),
            rms_radius_m: resolved(&Moments::rms_radius),
            size_m: entry.whole.extremes.map(|extremes| extremes.map(|[from, to]| to - from)),
            focus_m: resolved(&Moments::focus),
            parallel: on_plane(&Moments::focus).is_some_and(|focus| focus.mean.is_infinite()),
            surfaces: names,
            map,
        }
    }

    fn map(&self, detector: usize, entry: &Entry, count: u64, names: &[String]) -> MapResult {
        let n = count as f64;
        let mut map = MapResult { filter: Some(names.join(", ")), ..empty_map(self.scene, detector) };
        for (&bin, &(flux, rays)) in &entry.whole.bins {
            let bin = bin as usize;
            let spread = (entry.squares[&(bin as u32)] - flux * flux / n).max(0.0);
            let (mean, error) = mean_and_error(flux, spread, count);
            let extent = map.extent[bin];
            map.rays[bin] = rays;
            if extent > 0.0 {
                (map.mean[bin], map.error[bin]) = (mean / extent, error / extent);
            }
        }
        let upper = 3.0 * entry.whole.begun / n;
        for bin in (0..map.rays.len()).filter(|&bin| map.rays[bin] == 0 && map.extent[bin] > 0.0).collect::<Vec<_>>() {
            map.upper[bin] = upper / map.extent[bin];
        }
        map
    }

    fn warnings(&self, sums: &Sums<1>) -> Vec<String> {
        let flux = |slot: usize| sums.estimate(slot, 0).mean;
        let emitted = flux(Layout::EMITTED);
        let mut warnings = Vec::new();
        if flux(Layout::LOST) > MOST_LOST * emitted {
            let share = 100.0 * flux(Layout::LOST) / emitted;
            warnings.push(format!("{share:.2e} % of the emitted flux was lost to geometry faults"));
        }
        if flux(self.scene.layout(0).cut(Cut::Events)) > 0.0 {
            warnings.push("light that goes round between mirrors without loss was cut".into());
        }
        if self.unnamed > 0.0 {
            let mean = self.unnamed / sums.batches as f64;
            warnings.push(format!(
                "{mean:.3e} W arrived after more reflections than are spelled out: they are in no ghost"
            ));
        }
        warnings
    }
}

/// The flux of every batch, W.
fn series(batches: &[Moments], count: u64) -> Vec<f64> {
    let mut series: Vec<f64> = batches.iter().map(|batch| batch.flux).collect();
    series.resize(count as usize, 0.0);
    series
}

fn peak(map: &MapResult) -> Peak {
    let best = (0..map.mean.len()).max_by(|&a, &b| map.mean[a].total_cmp(&map.mean[b]).then(b.cmp(&a)));
    best.map_or(Peak::default(), |bin| Peak {
        mean: map.mean[bin],
        error: map.error[bin],
        pixel: [bin / map.shape[1], bin % map.shape[1]],
    })
}

//! Variants of a system against its baseline: traced together where shapes are the same, by the same random numbers everywhere.

use super::record::{Record, Series, difference, mean, ratio};
use super::verdict::verdict;
use crate::settings::Settings;
use crate::system::compile::variants::{Lineup, Trace, differences};
use crate::tally::results::{Estimate, Results};
use crate::transport::{Counts, batchwise, summary};
use serde::Serialize;
use std::collections::BTreeMap;
use std::sync::atomic::AtomicBool;

/// Paths and surfaces that are listed of each variant.
const LISTED: usize = 10;

/// A flux against that of the baseline.
#[derive(Clone, Debug, Serialize)]
pub struct Change {
    /// W.
    pub flux_w: Estimate,
    /// Minus the baseline's, W; the error is that of the difference, from paired batches.
    pub difference_w: Estimate,
    /// Over the baseline's, dimensionless; null if that is zero.
    pub ratio: Option<Estimate>,
    /// |difference| / its error; 0 if there is no difference.
    pub sigma: f64,
}

/// What a variant changes on one detector.
#[derive(Clone, Debug, Serialize)]
pub struct DetectorChange {
    /// All light.
    pub flux: Change,
    /// All but what is meant to arrive: the class "signal", or direct light where there are no optics.
    pub stray: Change,
    /// What is meant to arrive; null if neither the baseline nor the variant has any.
    pub signal: Option<Change>,
    /// In words.
    pub verdict: String,
}

/// A path or a surface and what changed there.
#[derive(Clone, Debug, Serialize)]
pub struct Shift {
    /// Detector of a path; empty for surfaces.
    pub detector: String,
    /// A path as the path table writes it, or the name of a part.
    pub label: String,
    pub baseline_w: f64,
    pub variant_w: f64,
    pub difference_w: Estimate,
}

/// One variant.
#[derive(Clone, Debug, Serialize)]
pub struct VariantResult {
    pub name: String,
    /// True if it was a lane of the baseline's trace; else shapes or indices differ, and it was a run of its own.
    pub together: bool,
    /// What it has otherwise: part and finish.
    pub surfaces: Vec<(String, String)>,
    /// Values of the parameters that it has otherwise.
    pub parameters: BTreeMap<String, String>,
    pub detectors: BTreeMap<String, DetectorChange>,
    /// The paths whose flux changed most, the largest change first, of each detector.
    pub paths: Vec<Shift>,
    /// The surfaces that absorb another flux, the largest change first.
    pub absorbed: Vec<Shift>,
    /// Everything about it alone.
    #[serde(skip)]
    pub results: Results,
}

/// What was found; the same bits on any number of threads.
#[derive(Clone, Debug, Serialize)]
pub struct Comparison {
    pub system: String,
    pub rays: u64,
    pub rays_requested: u64,
    pub seed: u64,
    pub batches: u64,
    pub batch_rays: u64,
    /// Traces that it took.
    pub traces: usize,
    /// The baseline, then the variants in the order of the file.
    pub variants: Vec<VariantResult>,
    pub warnings: Vec<String>,
    /// False if some run was not to be trusted.
    pub trusted: bool,
    /// SHA-256 of every file that was read.
    pub inputs: BTreeMap<String, String>,
    /// Flights of all traces.
    #[serde(skip)]
    pub segments: u64,
    #[serde(skip)]
    pub interrupted: bool,
}

/// How far it is: batches of one trace.
pub struct Step {
    pub trace: usize,
    pub traces: usize,
    pub batches: u64,
    pub of: u64,
}

/// A trace that is done.
struct Traced {
    batches: u64,
    batch_rays: u64,
    segments: u64,
    interrupted: bool,
    lanes: Vec<Lane>,
}

/// What one lane of it found.
struct Lane {
    results: Results,
    /// Of each detector: stray light and the signal, W per batch.
    totals: Vec<[Series; 2]>,
    paths: Vec<Shift>,
    absorbed: Vec<Shift>,
    surfaces: Vec<(String, String)>,
}

/// Traces a lineup with its `names`, the baseline's first, and compares. Once `stop` is set, what is finished is compared.
pub fn compare(
    lineup: Lineup,
    names: &[String],
    settings: &Settings,
    stop: &AtomicBool,
    progress: &dyn Fn(&Step),
) -> Option<Comparison> {
    let traces = lineup.traces.len();
    let mut done: Vec<(usize, Trace, Traced)> = Vec::new();
    let mut settings = settings.clone();
    for (number, trace) in lineup.traces.into_iter().enumerate() {
        let step = |batches, of| progress(&Step { trace: number, traces, batches, of });
        let traced = traced(&trace, &settings, stop, &step);
        let first = done.first().map_or(traced.batches, |(_, _, first)| first.batches);
        // Batches are paired: a trace that was cut short has nothing to be paired with.
        if traced.batches < 2 || traced.batches != first {
            break;
        }
        // All others are as long as the first turned out to be.
        settings.until = None;
        settings.rays = traced.batches * traced.batch_rays;
        settings.batch = Some(traced.batch_rays);
        let interrupted = traced.interrupted;
        done.push((number, trace, traced));
        if interrupted {
            break;
        }
    }
    let interrupted = done.len() < traces || done.iter().any(|(_, _, traced)| traced.interrupted);
    let warnings = lineup.warnings.iter().map(ToString::to_string).collect();
    (!done.is_empty()).then(|| told(done, names, warnings, interrupted))
}

/// Runs a trace in the narrowest packet that has its lanes.
fn traced(trace: &Trace, settings: &Settings, stop: &AtomicBool, step: &dyn Fn(u64, u64)) -> Traced {
    match trace.variants.len() {
        1 => lanes::<1>(trace, settings, stop, step),
        2..=4 => lanes::<4>(trace, settings, stop, step),
        5..=8 => lanes::<8>(trace, settings, stop, step),
        _ => lanes::<16>(trace, settings, stop, step),
    }
}

fn lanes<const V: usize>(trace: &Trace, settings: &Settings, stop: &AtomicBool, step: &dyn Fn(u64, u64)) -> Traced {
    let scene = &trace.compiled.scene;
    let mut record = Record::<V>::new(scene, trace.reference());
    let progress = |p: &crate::transport::Progress<V>| step(p.batches, p.of);
    let counts = batchwise::<V>(scene, settings, stop, &progress, &mut |layout, rows, batch| {
        record.take(layout, rows.rows.len(), layout.absorbers(), batch);
    });
    let lane = |lane: usize| Lane {
        results: Results {
            finishes: trace.compiled.finishes.clone(),
            parameters: trace.parameters[lane].clone(),
            ..summary::results(scene, settings, &counts, lane, trace.compiled.inputs.clone(), Vec::new())
        },
        totals: (0..scene.detectors.len()).map(|d| record.totals(d, lane).clone()).collect(),
        paths: paths(trace, &counts, &record, lane),
        absorbed: absorbed(trace, &counts, &record, lane),
        surfaces: differences(trace, lane),
    };
    Traced {
        batches: counts.sums.batches,
        batch_rays: counts.batch_rays,
        segments: counts.segments,
        interrupted: counts.interrupted,
        lanes: (0..trace.variants.len()).map(lane).collect(),
    }
}

/// Paths whose flux is another in a lane than in the reference.
fn paths<const V: usize>(trace: &Trace, counts: &Counts<V>, record: &Record<V>, lane: usize) -> Vec<Shift> {
    let scene = &trace.compiled.scene;
    let shift = |(index, row): (usize, &crate::transport::paths::Row)| {
        let slot = counts.layout.row(index);
        Shift {
            detector: scene.detectors[row.detector].label.clone(),
            label: summary::sequence(scene, row),
            baseline_w: counts.sums.estimate(slot, trace.reference()).mean,
            variant_w: counts.sums.estimate(slot, lane).mean,
            difference_w: record.change(slot, lane),
        }
    };
    let mut all: Vec<Shift> = counts.rows.rows.iter().enumerate().map(shift).collect();
    largest(&mut all);
    let mut listed = Vec::new();
    for detector in &scene.detectors {
        listed.extend(all.iter().filter(|shift| shift.detector == detector.label).take(LISTED).cloned());
    }
    listed
}

/// Parts and media that absorb another flux in a lane than in the reference.
fn absorbed<const V: usize>(trace: &Trace, counts: &Counts<V>, record: &Record<V>, lane: usize) -> Vec<Shift> {
    let scene = &trace.compiled.scene;
    let media = scene.media.iter().map(|filling| format!("medium {}", filling.label));
    let labels = scene.parts.iter().map(|part| part.label.clone()).chain(media);
    let shift = |(slot, label): (usize, String)| Shift {
        detector: String::new(),
        label,
        baseline_w: counts.sums.estimate(slot, trace.reference()).mean,
        variant_w: counts.sums.estimate(slot, lane).mean,
        difference_w: record.change(slot, lane),
    };
    let mut all: Vec<Shift> = counts.layout.absorbers().zip(labels).map(shift).collect();
    largest(&mut all);
    all.truncate(LISTED);
    all
}

/// What changed at all, the largest change first.
fn largest(shifts: &mut Vec<Shift>) {
    shifts.retain(|shift| shift.difference_w.mean != 0.0);
    let size = |shift: &Shift| shift.difference_w.mean.abs();
    shifts.sort_by(|a, b| size(b).total_cmp(&size(a)).then(a.label.cmp(&b.label)));
}

/// Everything against the baseline.
fn told(
    done: Vec<(usize, Trace, Traced)>,
    names: &[String],
    mut warnings: Vec<String>,
    interrupted: bool,
) -> Comparison {
    let traces = done.len();
    let (batches, batch_rays) = (done[0].2.batches, done[0].2.batch_rays);
    let baseline = &done[0].2.lanes[done[0].1.reference()];
    let (base, results) = (baseline.totals.clone(), baseline.results.clone());
    let first = results.parameters.clone();
    let (mut variants, mut inputs, mut segments) = (Vec::new(), BTreeMap::new(), 0);
    for (number, trace, traced) in done {
        segments += traced.segments;
        inputs.extend(trace.compiled.inputs.clone());
        // The baseline is in every trace that shares its shapes; there it is what the other lanes are compared with.
        let shares = trace.variants.contains(&0);
        let own = if shares { traced.lanes[trace.reference()].totals.clone() } else { base.clone() };
        for (lane, variant) in traced.lanes.into_iter().zip(trace.variants) {
            if variant == 0 && number > 0 {
                continue;
            }
            let Lane { results, totals, mut paths, mut absorbed, mut surfaces } = lane;
            if !shares {
                (paths, absorbed, surfaces) = (Vec::new(), Vec::new(), Vec::new());
            }
            let apart = results.parameters.iter().filter(|(name, value)| first.get(*name) != Some(*value));
            let name = names.get(variant).cloned().unwrap_or_default();
            let doubts = results.warnings.iter().map(|warning| format!("{name}: {warning}"));
            warnings.extend(doubts);
            let parameters = apart.map(|(name, value)| (name.clone(), value.clone())).collect();
            let detectors = detectors(&results, &own, &totals, batches);
            variants.push((
                variant,
                VariantResult { name, together: shares, surfaces, parameters, detectors, paths, absorbed, results },
            ));
        }
    }
    variants.sort_by_key(|(variant, _)| *variant);
    let variants: Vec<VariantResult> = variants.into_iter().map(|(_, variant)| variant).collect();
    Comparison {
        system: results.system,
        rays: results.rays,
        rays_requested: results.rays_requested,
        seed: results.seed,
        batches,
        batch_rays,
        traces,
        trusted: variants.iter().all(|variant| variant.results.trusted),
        variants,
        warnings,
        inputs,
        segments,
        interrupted,
    }
}

/// A variant against the baseline, detector by detector.
fn detectors(
    results: &Results,
    base: &[[Series; 2]],
    own: &[[Series; 2]],
    batches: u64,
) -> BTreeMap<String, DetectorChange> {
    let all = |[stray, signal]: &[Series; 2]| -> Series { stray.iter().zip(signal).map(|(a, b)| a + b).collect() };
    let change = |(map, (base, own)): (&crate::tally::results::MapResult, (&[Series; 2], &[Series; 2]))| {
        let lit = base[1].iter().chain(&own[1]).any(|signal| *signal > 0.0);
        let stray = against(&base[0], &own[0]);
        let signal = lit.then(|| against(&base[1], &own[1]));
        let verdict = verdict(&stray, signal.as_ref(), batches);
        (map.detector.clone(), DetectorChange { flux: against(&all(base), &all(own)), stray, signal, verdict })
    };
    // Maps are in the order of the scene's detectors.
    results.maps.iter().zip(base.iter().zip(own)).map(change).collect()
}

/// A series against that of the baseline.
pub fn against(base: &[f64], own: &[f64]) -> Change {
    let difference_w = difference(base, own);
    let sigma = if difference_w.mean == 0.0 { 0.0 } else { difference_w.mean.abs() / difference_w.error };
    Change { flux_w: mean(own), difference_w, ratio: ratio(base, own), sigma }
}

//! Which surface to improve first: by how much stray light changes with what a surface reflects, transmits or scatters.
//!
//! Light on a path is proportional to the reflectance R of a surface as often as it was reflected there, to its transmittance T as often
//! as it passed, and to the level B of its BSDF as often as it was scattered. So for the stray flux F on a detector
//!
//!     d ln F / d ln R = sum F_k r_k / sum F_k       at fixed T, and alike for T at fixed R and for B
//!
//! over all arrivals k of flux F_k (W), with r_k reflections there on the way; dimensionless. 1 per cent less of the quantity is so many
//! per cent less stray light. Errors are those of a ratio of means over batches (Cochran, Sampling Techniques, 1977, eq. 6.13).
//!
//! A total reflection counts as a reflection, though no coating makes it.
//!
//! Left out: what more scatter takes from the specular beam of the same surface (a part of its TIS); scatter inside media; what
//! happened after the steps that a path can spell, whose flux is told.

use crate::math::statistics::mean_and_error;
use crate::packet::Event;
use crate::scene::{Part, Scene};
use crate::settings::{Booking, Settings};
use crate::tally::results::Estimate;
use crate::tally::{Layout, Sums};
use crate::transport::{Progress, batchwise};
use serde::Serialize;
use std::collections::BTreeMap;
use std::sync::atomic::AtomicBool;

/// What of a surface is changed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Quantity {
    Reflectance,
    Transmittance,
    Scatter,
}

impl Quantity {
    const ALL: [(Quantity, Event); 3] = [
        (Quantity::Reflectance, Event::Reflect),
        (Quantity::Transmittance, Event::Transmit),
        (Quantity::Scatter, Event::Scatter),
    ];

    /// As tables write it.
    pub fn label(self) -> &'static str {
        ["reflectance", "transmittance", "scatter"][self as usize]
    }
}

/// One derivative.
#[derive(Clone, Debug, Serialize)]
pub struct Lever {
    /// A part, or a finish: what the file says of it.
    pub subject: String,
    pub quantity: Quantity,
    /// d ln F / d ln quantity, dimensionless.
    pub derivative: Estimate,
}

/// What moves the stray light on one detector.
#[derive(Clone, Debug, Serialize)]
pub struct DetectorLevers {
    /// All light but what is meant to arrive (the class "signal", or direct light where there are no optics), W.
    pub stray_w: Estimate,
    /// Share of it on paths too long to be counted to their end, 0..1.
    pub uncounted: f64,
    /// By part, the greatest derivative first.
    pub parts: Vec<Lever>,
    /// By finish: all parts that have it, together.
    pub finishes: Vec<Lever>,
}

/// What was found; the same bits on any number of threads.
#[derive(Clone, Debug, Serialize)]
pub struct Sensitivity {
    pub system: String,
    pub rays: u64,
    pub rays_requested: u64,
    pub seed: u64,
    pub batches: u64,
    pub detectors: BTreeMap<String, DetectorLevers>,
    #[serde(skip)]
    pub segments: u64,
    #[serde(skip)]
    pub interrupted: bool,
}

/// Sums over batches of a numerator x and of the stray flux y beside it.
#[derive(Clone, Copy, Debug, Default)]
struct Moments {
    x: f64,
    y: f64,
    xx: f64,
    xy: f64,
    yy: f64,
}

impl Moments {
    fn push(&mut self, x: f64, y: f64) {
        let Moments { x: sx, y: sy, xx, xy, yy } = *self;
        *self = Moments { x: sx + x, y: sy + y, xx: xx + x * x, xy: xy + x * y, yy: yy + y * y };
    }

    /// x / y with its error over `n` batches.
    fn ratio(&self, n: u64) -> Estimate {
        let ratio = self.x / self.y;
        let spread = self.xx - 2.0 * ratio * self.xy + ratio * ratio * self.yy;
        let (mean, error) = mean_and_error(self.x, spread.max(0.0), n);
        Estimate { mean: ratio, error: if mean > 0.0 { error * n as f64 / self.y } else { 0.0 } }
    }
}

/// One derivative in the making: the parts whose events are counted.
struct Count {
    detector: usize,
    subject: String,
    quantity: Quantity,
    event: Event,
    parts: Vec<usize>,
    whole: bool,
    moments: Moments,
}

/// Traces and counts; `None` if it was stopped before two batches were done.
pub fn sensitivity(
    scene: &Scene,
    settings: &Settings,
    stop: &AtomicBool,
    progress: &dyn Fn(&Progress<1>),
) -> Option<Sensitivity> {
    // No path has a row: nothing is said of paths.
    let settings = Settings { booking: Booking::Events, paths: 0, ..settings.clone() };
    let mut counts = counts(scene);
    let run = batchwise::<1>(scene, &settings, stop, progress, &mut |layout, _, batch| {
        counts.iter_mut().for_each(|count| count.take(layout, batch));
    });
    let batches = run.sums.batches;
    let levers = |d: usize, detector: &crate::detector::Detector| -> Option<(String, DetectorLevers)> {
        let slot = run.layout.stray(d)?;
        let stray_w = run.sums.estimate(slot, 0);
        let long = run.sums.estimate(slot + 1, 0).mean;
        let uncounted = if stray_w.mean > 0.0 { long / stray_w.mean } else { 0.0 };
        let [parts, finishes] = [false, true].map(|whole| ranked(&counts, d, whole, batches));
        Some((detector.label.clone(), DetectorLevers { stray_w, uncounted, parts, finishes }))
    };
    (batches >= 2).then(|| Sensitivity {
        system: scene.name.clone(),
        rays: batches * run.batch_rays,
        rays_requested: settings.rays,
        seed: settings.seed,
        batches,
        detectors: scene.detectors.iter().enumerate().filter_map(|(d, detector)| levers(d, detector)).collect(),
        segments: run.segments,
        interrupted: run.interrupted,
    })
}

/// Everything that is counted: every part for itself, and every finish.
fn counts(scene: &Scene) -> Vec<Count> {
    let mut finishes: BTreeMap<String, Vec<usize>> = BTreeMap::new();
    for (number, part) in scene.parts.iter().enumerate() {
        finishes.entry(finish(scene, part)).or_default().push(number);
    }
    let parts = scene.parts.iter().enumerate().map(|(number, part)| (part.label.clone(), vec![number], false));
    let subjects: Vec<(String, Vec<usize>, bool)> =
        parts.chain(finishes.into_iter().map(|(label, parts)| (label, parts, true))).collect();
    let of = |detector: usize| {
        subjects.iter().flat_map(move |(subject, parts, whole)| {
            Quantity::ALL.map(|(quantity, event)| Count {
                detector,
                subject: subject.clone(),
                quantity,
                event,
                parts: parts.clone(),
                whole: *whole,
                moments: Moments::default(),
            })
        })
    };
    (0..scene.detectors.len()).flat_map(of).collect()
}

/// What the file says of a part, front and back if they differ.
fn finish(scene: &Scene, part: &Part) -> String {
    let [front, back] = part.surface[0].map(|surface| scene.surfaces[surface as usize].label.as_str());
    if front == back { front.into() } else { format!("{front} | {back}") }
}

impl Count {
    fn take(&mut self, layout: &Layout, batch: &Sums<1>) {
        let Some(stray) = layout.stray(self.detector) else { return };
        let slots = self.parts.iter().filter_map(|&part| layout.event(self.detector, part, self.event));
        let x: f64 = slots.map(|slot| batch.values(slot)[0]).sum();
        self.moments.push(x, batch.values(stray)[0]);
    }
}

/// What moves a detector's stray light at all, the greatest derivative first.
fn ranked(counts: &[Count], detector: usize, whole: bool, batches: u64) -> Vec<Lever> {
    let counted = counts.iter().filter(|c| c.detector == detector && c.whole == whole && c.moments.x > 0.0);
    let mut levers: Vec<Lever> = counted
        .map(|count| Lever {
            subject: count.subject.clone(),
            quantity: count.quantity,
            derivative: count.moments.ratio(batches),
        })
        .collect();
    levers.sort_by(|a, b| b.derivative.mean.total_cmp(&a.derivative.mean).then(a.subject.cmp(&b.subject)));
    levers
}

//! Looks from the detectors: traces, and what they come to.

use super::batches::folded;
use super::glow::{self, Glow};
use super::rank::{Illumination, first_order};
use super::seen::{Eye, Slots};
use super::{Question, Seen, View, Warm, Warmth, Way, Ways, sum};
use crate::math::Rng;
use crate::math::lowdiscrepancy::Block;
use crate::math::rng::mix;
use crate::scene::Scene;
use crate::source::planck;
use crate::system::compile::Thermal;
use crate::tally::layout::Cut;
use crate::tally::results::Estimate;
use crate::tally::{Layout, Live, Sums};
use crate::transport::backward::Backward;
use crate::transport::backward::look::Glance;
use crate::transport::book::Book;
use crate::transport::importance::Importance;
use crate::transport::walk::Walk;
use crate::transport::watch::Watch;
use std::sync::atomic::AtomicBool;

/// Part of the whole that may be lost, or missing in the sum, without a word.
const DOUBTFUL: f64 = 1e-3;
/// Standard errors beyond which a residual is none of chance.
const SIGMAS: f64 = 4.0;

/// Draws the vacuum wavelength (m) of a ray from its coordinates, and tells it to what watches.
type Draw<'f, W> = dyn Fn(&mut W, &mut dyn FnMut(u32) -> f64) -> f64 + 'f;

/// What all looks have in common.
pub struct Looks<'a> {
    question: Question<'a>,
    stop: &'a AtomicBool,
    backward: Backward,
    importance: Importance,
    /// Slots of the ledger.
    pub layout: Layout,
}

/// What a detector sees, in sr.
pub struct Sight {
    /// What became of the rays.
    pub ledger: Sums<1>,
    pub seen: Sums<1>,
    /// Flights from event to event.
    pub segments: u64,
}

impl<'a> Looks<'a> {
    pub fn new(question: Question<'a>, stop: &'a AtomicBool) -> Looks<'a> {
        let scene = question.scene;
        let layout = Layout::new(scene.parts.len(), scene.media.len(), 0, Vec::new(), 0);
        Looks { question, stop, backward: Backward::looking(scene), importance: Importance::default(), layout }
    }

    /// Area with which a detector looks, m2; `None` at infinity.
    pub fn area(&self, detector: usize) -> Option<f64> {
        Some(self.backward.area(detector)).filter(|area| *area > 0.0)
    }

    /// What a detector sees; `None` if stopped.
    pub fn seen(&self, detector: usize) -> Option<Sight> {
        let Question { scene, thermal, settings } = self.question;
        let total: f64 = scene.sources.iter().map(|source| source.flux).sum();
        let wavelength = |_: &mut Eye, u: &mut dyn FnMut(u32) -> f64| {
            let mut rest = u(6) * total;
            let chosen = scene.sources.iter().find(|source| {
                rest -= source.flux;
                rest < 0.0
            });
            match (chosen.or(scene.sources.last()), thermal) {
                (Some(source), _) => source.spectrum.wavelength(u(4)),
                (None, Some(thermal)) => thermal.hottest.quantile(u(4)),
                (None, None) => 0.0,
            }
        };
        let ([ledger, seen], segments) = folded(settings, self.stop, |batch| {
            let (ledger, eye, flights) = self.batch((0x7365_656e, detector, batch), Eye::new(scene), &wavelength);
            ([ledger, eye.finish()], flights)
        })?;
        Some(Sight { ledger, seen, segments })
    }

    /// What warm things send to a detector of an area (m2), and how many flights that took; `None` if stopped, or if nothing is known of temperatures.
    pub fn warmth(&self, detector: usize, area: f64) -> Option<(Warmth, u64)> {
        let Question { scene, thermal, settings } = self.question;
        let thermal = thermal?;
        let wavelength = |glow: &mut Glow, u: &mut dyn FnMut(u32) -> f64| {
            glow.wavelength = thermal.hottest.quantile(u(4));
            glow.density = thermal.hottest.at(glow.wavelength);
            glow.wavelength
        };
        let ([ledger, sums], segments) = folded(settings, self.stop, |batch| {
            let (ledger, glow, flights) =
                self.batch((0x6865_6174, detector, batch), Glow::new(scene, thermal), &wavelength);
            ([ledger, glow.finish()], flights)
        })?;
        let rays = settings.batches() * settings.batch_rays();
        let ray = area * ledger.estimate(Layout::EMITTED, 0).mean / rays as f64;
        Some((warmth(scene, thermal, &sums, area, ray), segments))
    }

    /// One batch of one look, which has a name, from a detector: its ledger, what was watched, its flights.
    fn batch<W: Watch>(
        &self,
        (name, detector, batch): (u64, usize, u64),
        watch: W,
        wavelength: &Draw<'_, W>,
    ) -> (Sums<1>, W, u64) {
        let Question { scene, settings, .. } = self.question;
        let book = Book::new(&self.layout, Live::new(self.layout.len()), None);
        let mut walk = Walk::new(scene, settings, &self.importance, book, watch);
        walk.seed = mix(settings.seed ^ mix(name << 32 | detector as u64));
        let block = Block::new(walk.seed, batch);
        let share = settings.batch_rays();
        for index in 0..share {
            let history = batch * share + index;
            let mut rng = Rng::new(walk.seed, history, 0);
            let mut u = |dimension| block.coordinate(index as u32, dimension, rng.uniform());
            let wavelength = wavelength(&mut walk.watch, &mut u);
            self.backward.look(&mut walk, Glance { detector, history, share, wavelength }, &mut u);
        }
        (walk.book.finish(), walk.watch, walk.book.segments)
    }
}

/// What there is to doubt about a look, and whether it is to be trusted.
pub fn doubts(scene: &Scene, detector: usize, layout: &Layout, ledger: &Sums<1>) -> (Vec<String>, bool) {
    let label = &scene.detectors[detector].label;
    let amount = |slot: usize| ledger.estimate(slot, 0);
    let whole = amount(Layout::EMITTED).mean;
    let share = |amount: f64| format!("{:.2} %", 100.0 * amount / whole);
    let (lost, residual) = (amount(Layout::LOST).mean, amount(Layout::RESIDUAL));
    let limits = Cut::ALL.into_iter().filter(|cut| *cut != Cut::Roulette);
    let cut: f64 = limits.map(|cut| amount(layout.cut(cut)).mean).sum();
    let mut doubts = Vec::new();
    if lost > DOUBTFUL * whole {
        doubts.push(format!("{} of what {label:?} sees was lost to faults of the geometry", share(lost)));
    }
    if cut > DOUBTFUL * whole {
        doubts.push(format!(
            "{} of what {label:?} sees was cut by limits of `run`, and is not emitted either",
            share(cut)
        ));
    }
    let missing = residual.mean.abs();
    if missing > (DOUBTFUL * whole).max(SIGMAS * residual.error) {
        let what = "what surfaces scatter to it is not what they scatter of light that comes the other way";
        doubts.push(format!("{} of what {label:?} sees is missing in the sum: {what}", share(missing)));
    }
    (doubts, lost <= DOUBTFUL * whole)
}

/// What a detector sees, in words and numbers.
pub fn view(
    scene: &Scene,
    (detector, area): (usize, f64),
    Sight { ledger, seen, .. }: &Sight,
    lit: &Option<Illumination>,
    thermal: Option<Warmth>,
) -> View {
    let slots = Slots::new(scene);
    let whole = ledger.estimate(Layout::EMITTED, 0).mean;
    let rays = (ledger.rays(Layout::EMITTED)).max(1) as f64;
    let limit = |unseen: bool| unseen.then_some(3.0 * whole / rays);
    let ways = |slot: &dyn Fn(Way) -> usize| -> Ways {
        Way::ALL.into_iter().map(|way| (way, seen.estimate(slot(way), 0))).collect()
    };
    let parts = scene.parts.iter().enumerate().map(|(part, of)| Seen {
        object: of.label.clone(),
        seen_sr: ways(&|way| slots.way(part, way)),
        absorbed_sr: seen.estimate(slots.absorbed(part), 0),
        upper_limit_sr: limit(seen.rays(slots.absorbed(part)) == 0),
    });
    let solids = (0..scene.solids.len() as u16).map(Some).chain([None]);
    let dimmed = solids.filter(|solid| seen.rays(slots.dimmed(*solid)) > 0).map(|solid| Seen {
        object: inside(solid.map(|solid| scene.solids[solid as usize].label.as_str())),
        seen_sr: Ways::new(),
        absorbed_sr: seen.estimate(slots.dimmed(solid), 0),
        upper_limit_sr: None,
    });
    let mut objects: Vec<Seen> = parts.chain(dimmed).collect();
    objects.sort_by(|a, b| size(b).total_cmp(&size(a)));
    View {
        detector: scene.detectors[detector].label.clone(),
        area_m2: area,
        whole_sr: whole,
        seen: objects,
        sky_sr: ways(&|way| slots.sky(way)),
        absorbed_sr: ledger.estimate(Layout::ABSORBED, 0),
        escaped_sr: ledger.estimate(Layout::ESCAPED, 0),
        residual_sr: residual(ledger),
        first_order: lit.as_ref().map_or(Vec::new(), |lit| first_order(scene, lit, seen, area)),
        thermal,
    }
}

/// What is neither absorbed nor escaped: cut, lost, or missing by chance.
fn residual(ledger: &Sums<1>) -> Estimate {
    sum([Layout::RESIDUAL, Layout::TERMINATED, Layout::LOST].map(|slot| ledger.estimate(slot, 0)))
}

/// By what objects are ordered: all ways in which it is seen, sr.
fn size(seen: &Seen) -> f64 {
    seen.seen_sr.values().map(|amount| amount.mean).sum()
}

/// The name of what fills a solid.
fn inside(solid: Option<&str>) -> String {
    solid.map_or("ambient".into(), |label| format!("inside {label}"))
}

/// Light of everything that is warm; `ray` is the étendue of one ray, m2 sr.
fn warmth(scene: &Scene, thermal: &Thermal, sums: &Sums<1>, area: f64, ray: f64) -> Warmth {
    let slots = glow::Slots::new(scene);
    let flux = |slot: usize| {
        let Estimate { mean, error } = sums.estimate(slot, 0);
        Estimate { mean: area * mean, error: area * error }
    };
    let warm = |object: String, temperature_k: f64, slot: usize| Warm {
        object,
        temperature_k,
        flux_w: flux(slot),
        photons_per_s: flux(slot + 1),
        upper_limit_w: (sums.rays(slot) == 0).then(|| 3.0 * ray * planck::band(temperature_k, thermal.band)),
    };
    let parts = scene.parts.iter().zip(&thermal.parts).enumerate();
    let parts = parts.map(|(part, (of, kelvin))| warm(of.label.clone(), *kelvin, slots.part(part)));
    let solids = scene.solids.iter().zip(&thermal.solids).enumerate();
    // Most glass absorbs nothing.
    let solids = solids.filter(|(solid, _)| sums.rays(slots.solid(*solid)) > 0);
    let solids = solids.map(|(solid, (of, kelvin))| warm(inside(Some(&of.label)), *kelvin, slots.solid(solid)));
    let mut objects: Vec<Warm> = parts.chain(solids).filter(|warm| warm.temperature_k > 0.0).collect();
    objects.sort_by(|a, b| b.flux_w.mean.total_cmp(&a.flux_w.mean));
    Warmth { band_m: thermal.band, objects, flux_w: flux(slots.all()), photons_per_s: flux(slots.all() + 1) }
}

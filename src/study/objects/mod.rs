//! Critical and illuminated objects: what the detectors see, what the sources light, and what is both.
//!
//! An object that a detector sees is *critical*: whatever light it has, the detector gets
//!
//!     F = A L omega     [W]
//!
//! with L the radiance of the object (W/m2/sr, divided by n^2 in a medium of index n), A the area of the detector, and omega the
//! projected solid angle (sr) of `transport::backward::look`: what arrives of the light included, all directions together pi n^2. An
//! object that the sources light and a detector sees, both directly or through the optics, is on a path of first order: one scatter. As
//! if it scattered evenly, what it scatters (W) of the light on a side over its area A_k brings
//!
//!     F_k = A (scattered_k / pi A_k) omega_k     [W]
//!
//! which is a rank, not a result: lobes, and that the lit and the seen places of the object may differ, are in a run only. The first of
//! the list are where a baffle, a stop or a better finish pays.
//!
//! Objects are parts: what paths name.
//! Source: Breault, in Handbook of Optics vol. I (2nd ed., 1995), ch. 38; Fest, Stray Light Analysis and Control (2013), ch. 4.

mod batches;
mod glow;
mod lit;
mod look;
mod rank;
mod seen;
mod way;

pub use way::Way;

use crate::scene::Scene;
use crate::settings::Settings;
use crate::system::compile::Thermal;
use crate::tally::results::Estimate;
use look::Looks;
use serde::Serialize;
use std::collections::BTreeMap;
use std::sync::atomic::AtomicBool;

/// What is asked.
#[derive(Clone, Copy, Debug)]
pub struct Question<'a> {
    pub scene: &'a Scene,
    /// How warm things are, if that is known.
    pub thermal: Option<&'a Thermal>,
    /// `rays` are traced back from every detector, forward from the sources, and back again for what is warm.
    pub settings: &'a Settings,
}

/// An amount for every way, in the unit of its context.
pub type Ways = BTreeMap<Way, Estimate>;

/// Objects and how they are seen and lit.
#[derive(Clone, Debug, Serialize)]
pub struct Objects {
    pub system: String,
    /// Rays of every trace.
    pub rays: u64,
    pub batch_rays: u64,
    pub batches: u64,
    pub seed: u64,
    /// By detector; not those at infinity.
    pub views: Vec<View>,
    /// Objects that are lit, the brightest first; then those that are not.
    pub lit: Vec<Lit>,
    /// Flux of all sources, W.
    pub sources_w: f64,
    pub warnings: Vec<String>,
    pub trusted: bool,
    /// Flights from event to event.
    pub segments: u64,
    /// SHA-256 of every file that was read, by name as written.
    pub inputs: BTreeMap<String, String>,
}

/// What one detector sees.
#[derive(Clone, Debug, Serialize)]
pub struct View {
    pub detector: String,
    /// Area that looks, both sides if both do, m2.
    pub area_m2: f64,
    /// All projected solid angle that there is, pi n^2, sr.
    pub whole_sr: f64,
    /// Objects that are seen, those by the largest solid angle first; then those that are not.
    pub seen: Vec<Seen>,
    /// The open sky, sr.
    pub sky_sr: Ways,
    /// What ends in objects, by any way, and what escapes, sr: together the whole.
    pub absorbed_sr: Estimate,
    pub escaped_sr: Estimate,
    /// What is missing in that sum, sr: cut by limits, lost, or zero within its error.
    pub residual_sr: Estimate,
    /// Seen and lit, those that bring the most first.
    pub first_order: Vec<FirstOrder>,
    /// Light of what is warm, if that is known.
    pub thermal: Option<Warmth>,
}

/// An object that a detector sees.
#[derive(Clone, Debug, Serialize)]
pub struct Seen {
    pub object: String,
    /// Projected solid angle in which it is seen, weighed with what arrives of its light, sr.
    pub seen_sr: Ways,
    /// What ends in it, by any way, sr: what it would emit.
    pub absorbed_sr: Estimate,
    /// If no ray came to it: three rays' solid angle, sr; else null.
    pub upper_limit_sr: Option<f64>,
}

/// An object that the sources light.
#[derive(Clone, Debug, Serialize)]
pub struct Lit {
    pub object: String,
    /// One side's area, m2.
    pub area_m2: f64,
    /// Flux that falls on it, W.
    pub flux_w: Ways,
    /// If no ray came to it: the flux of three rays, W; else null.
    pub upper_limit_w: Option<f64>,
}

/// An object that is lit and seen, both directly or through the optics.
#[derive(Clone, Debug, Serialize)]
pub struct FirstOrder {
    pub object: String,
    /// Flux on it, W.
    pub lit_w: Estimate,
    /// sr
    pub seen_sr: Estimate,
    /// What it would bring if it scattered evenly, W.
    pub flux_w: Estimate,
}

/// What warm things send to a detector by themselves.
#[derive(Clone, Debug, Serialize)]
pub struct Warmth {
    /// Least and greatest vacuum wavelength, m.
    pub band_m: [f64; 2],
    /// The brightest first.
    pub objects: Vec<Warm>,
    pub flux_w: Estimate,
    pub photons_per_s: Estimate,
}

impl Warmth {
    /// The objects that bring more than a millionth of the light; the rest is rounding, but for those that no ray ended in.
    pub fn notable(&self) -> impl Iterator<Item = &Warm> {
        let least = 1e-6 * self.flux_w.mean;
        self.objects.iter().filter(move |warm| warm.upper_limit_w.is_some() || warm.flux_w.mean > least)
    }
}

/// A warm object.
#[derive(Clone, Debug, Serialize)]
pub struct Warm {
    pub object: String,
    pub temperature_k: f64,
    pub flux_w: Estimate,
    pub photons_per_s: Estimate,
    /// If no ray ended in it: three rays' solid angle of a black body, W; else null.
    pub upper_limit_w: Option<f64>,
}

/// Traces, and says what is seen and lit. `None` if it was stopped.
pub fn objects(question: Question, stop: &AtomicBool) -> Option<Objects> {
    let Question { scene, settings, .. } = question;
    let lit = rank::illuminate(scene, settings, stop)?;
    let mut segments = lit.as_ref().map_or(0, |lit| lit.segments);
    let looks = Looks::new(question, stop);
    let (mut views, mut warnings, mut trusted) = (Vec::new(), Vec::new(), true);
    for detector in 0..scene.detectors.len() {
        let Some(area) = looks.area(detector) else { continue };
        let sight = looks.seen(detector)?;
        segments += sight.segments;
        let (doubts, sound) = look::doubts(scene, detector, &looks.layout, &sight.ledger);
        warnings.extend(doubts);
        trusted &= sound;
        let warmth = if question.thermal.is_some() { Some(looks.warmth(detector, area)?) } else { None };
        segments += warmth.as_ref().map_or(0, |(_, flights)| *flights);
        let warmth = warmth.map(|(warmth, _)| warmth);
        views.push(look::view(scene, (detector, area), &sight, &lit, warmth));
    }
    Some(Objects {
        system: scene.name.clone(),
        rays: settings.batches() * settings.batch_rays(),
        batch_rays: settings.batch_rays(),
        batches: settings.batches(),
        seed: settings.seed,
        views,
        lit: lit.map_or(Vec::new(), |lit| lit.objects(scene)),
        sources_w: scene.sources.iter().map(|source| source.flux).sum(),
        warnings,
        trusted,
        segments,
        inputs: BTreeMap::new(),
    })
}

/// Sum of independent amounts.
fn sum(amounts: impl IntoIterator<Item = Estimate>) -> Estimate {
    let add = |a: Estimate, b: Estimate| Estimate { mean: a.mean + b.mean, error: a.error.hypot(b.error) };
    amounts.into_iter().fold(Estimate::default(), add)
}

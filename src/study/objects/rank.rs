//! What the sources light, and what of it a detector sees: paths of first order.

use super::batches::folded;
use super::lit::{Lamp, Slots};
use super::{FirstOrder, Lit, Way, seen, sum};
use crate::math::rng::mix;
use crate::scene::{Part, Scene};
use crate::settings::Settings;
use crate::tally::results::Estimate;
use crate::tally::{Live, Sums};
use crate::transport::book::Book;
use crate::transport::importance::Importance;
use crate::transport::paths::Rows;
use crate::transport::walk::{Walk, quotas};
use std::f64::consts::PI;
use std::sync::atomic::AtomicBool;

/// Where the light of the sources falls.
pub struct Illumination {
    sums: Sums<1>,
    /// One side's area of every part, m2.
    areas: Vec<f64>,
    /// Flux of three rays, W.
    limit: f64,
    /// Flights from event to event.
    pub segments: u64,
}

/// Traces the light of all sources up to what it lights after one scatter; `Some(None)` without sources, `None` if stopped.
pub fn illuminate(scene: &Scene, settings: &Settings, stop: &AtomicBool) -> Option<Option<Illumination>> {
    if scene.sources.is_empty() {
        return Some(None);
    }
    let settings = Settings { max_scatters: Some(1), ..settings.clone() };
    // Every source has a ray in every batch.
    let batch_rays = settings.batch_rays().max((scene.sources.len() as u64).next_power_of_two());
    let quotas = quotas(scene, batch_rays);
    let (layout, rows, importance) = (scene.layout(0), Rows::default(), Importance::default());
    let ([sums], segments) = folded(&settings, stop, |batch| {
        let book = Book::new(&layout, Live::<1>::new(layout.len()), Some(&rows));
        let mut walk = Walk::new(scene, &settings, &importance, book, Lamp::new(scene));
        walk.seed = mix(settings.seed ^ 0x6c69_7421);
        walk.batch(batch, &quotas);
        ([walk.watch.finish()], walk.book.segments)
    })?;
    let mut areas = vec![0.0; scene.parts.len()];
    for triangle in 0..scene.geometry.len() as u32 {
        areas[scene.part_of[triangle as usize] as usize] += scene.geometry.area(triangle);
    }
    let brightest = scene.sources.iter().zip(&quotas).map(|(source, quota)| source.flux / quota.count as f64);
    let limit = 3.0 * brightest.fold(0.0, f64::max) / settings.batches() as f64;
    Some(Some(Illumination { sums, areas, limit, segments }))
}

impl Illumination {
    /// Every part, the brightest first.
    pub fn objects(&self, scene: &Scene) -> Vec<Lit> {
        let slots = Slots::new(scene);
        let one = |(part, of): (usize, &Part)| {
            let dark = Way::ALL.into_iter().all(|way| self.sums.rays(slots.way(part, way)) == 0);
            Lit {
                object: of.label.clone(),
                area_m2: self.areas[part],
                flux_w: Way::ALL.into_iter().map(|way| (way, self.sums.estimate(slots.way(part, way), 0))).collect(),
                upper_limit_w: dark.then_some(self.limit),
            }
        };
        let mut lit: Vec<Lit> = scene.parts.iter().enumerate().map(one).collect();
        let flux = |lit: &Lit| lit.flux_w.values().map(|flux| flux.mean).sum::<f64>();
        lit.sort_by(|a, b| flux(b).total_cmp(&flux(a)));
        lit
    }
}

/// Parts that are lit and seen, both directly or through the optics, those that bring most first. Both sides of what passes light count
/// together, for light may come to one and leave by the other.
pub fn first_order(scene: &Scene, lit: &Illumination, sight: &Sums<1>, area: f64) -> Vec<FirstOrder> {
    let (lamp, eye) = (Slots::new(scene), seen::Slots::new(scene));
    let first = |slot: &dyn Fn(Way) -> usize, sums: &Sums<1>| {
        sum(Way::ALL.into_iter().filter(|way| way.is_first()).map(|way| sums.estimate(slot(way), 0)))
    };
    let one = |(part, of): (usize, &Part)| {
        let scattered = [0, 1].map(|side| lit.sums.estimate(lamp.scattered(part, side), 0));
        let seen = [0, 1].map(|side| sight.estimate(eye.side(part, side), 0));
        let opaque = of.surface.iter().flatten().all(|surface| scene.surfaces[*surface as usize].opaque());
        let pairs = if opaque {
            vec![(scattered[0], seen[0]), (scattered[1], seen[1])]
        } else {
            vec![(sum(scattered), sum(seen))]
        };
        let factor = area / (PI * lit.areas[part].max(f64::MIN_POSITIVE));
        let flux = sum(pairs.into_iter().map(|(a, b)| product(a, b, factor)));
        (flux.mean > 0.0).then(|| FirstOrder {
            object: of.label.clone(),
            lit_w: first(&|way| lamp.way(part, way), &lit.sums),
            seen_sr: first(&|way| eye.way(part, way), sight),
            flux_w: flux,
        })
    };
    let mut ranked: Vec<FirstOrder> = scene.parts.iter().enumerate().filter_map(one).collect();
    ranked.sort_by(|a, b| b.flux_w.mean.total_cmp(&a.flux_w.mean));
    ranked
}

/// factor a b of independent amounts.
fn product(a: Estimate, b: Estimate, factor: f64) -> Estimate {
    Estimate { mean: factor * a.mean * b.mean, error: factor * (a.error * b.mean).hypot(a.mean * b.error) }
}

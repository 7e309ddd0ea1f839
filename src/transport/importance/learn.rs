//! Learning before the run: scouts from every detector, and a first look at where light comes to.

use super::patches::Patches;
use super::scout::{Scout, Sighting, Way, shining, wavelength};
use super::{Importance, Map};
use crate::math::Rng;
use crate::math::rng::mix;
use crate::packet::Ancestry;
use crate::scene::Scene;
use crate::settings::{Roulette, Settings};
use crate::source::Source;
use crate::tally::{Layout, Live};
use crate::transport::book::Book;
use crate::transport::paths::Rows;
use crate::transport::walk::{Quota, Walk};
use crate::transport::watch::{Sight, Watch};
use glam::DVec3;
use rayon::prelude::*;
use std::sync::atomic::{AtomicBool, Ordering};

/// Part of the run's flights that scouts may take, all detectors together; least and most.
const SCOUTED: f64 = 0.1;
const FLIGHTS: [f64; 2] = [65_536.0, 2_097_152.0];
/// Scouts of one task.
const TROOP: u64 = 512;
/// Tasks that tell how far scouts go.
const VANGUARD: u64 = 4;
/// Part of the run's rays that look where light comes to, and their most.
const LOOKS: u64 = 64;
const MOST_LOOKS: u64 = 1 << 14;
/// Branches of a source ray that the map is scaled for.
const BRANCHES: f64 = 8.0;

/// What a run needs to know of importance, by random numbers of its own. Does not depend on the number of threads.
pub fn learn(scene: &Scene, settings: &Settings, quotas: &[Quota], batch_rays: u64, stop: &AtomicBool) -> Importance {
    let declared = Importance::declared(scene);
    let settings = &Settings {
        seed: mix(settings.seed ^ 0x696d_706f_7274),
        roulette: Roulette { below: 1e-6, survive: 0.1 },
        ..settings.clone()
    };
    let teacher = Teacher { scene, settings, declared: &declared, layout: scene.layout(0), stop };
    let (visits, flights) = teacher.visits(quotas, batch_rays);
    let rays = looks(settings, batch_rays) * batch_rays;
    let flights = (SCOUTED * flights as f64 / rays as f64 * settings.rays as f64).clamp(FLIGHTS[0], FLIGHTS[1]);
    let mut sightings = Vec::new();
    for detector in 0..scene.detectors.len() {
        let mut own = teacher.scouts(detector, flights / scene.detectors.len() as f64);
        if scene.detectors.len() > 1 {
            // Every detector is to be known equally well: its sightings count by how much light it will get.
            let alone = Patches::learn(scene, &own, &mut Vec::new());
            let flux: f64 = visits.iter().map(|visit| visit.worth(&alone)).sum();
            own.iter_mut().for_each(|sighting| sighting.weight /= if flux > 0.0 { flux } else { f64::INFINITY });
        }
        sightings.extend(own);
    }
    sightings.retain(|sighting| sighting.weight > 0.0);
    let mut targets = declared.targets.clone();
    let patches = Patches::learn(scene, &sightings, &mut targets);
    let whole: f64 = visits.iter().map(|visit| visit.worth(&patches)).sum();
    let branch = whole / (BRANCHES * rays as f64);
    Importance { targets, map: (branch > 0.0).then_some(Map { patches, branch }) }
}

/// Batches that look where light comes to.
fn looks(settings: &Settings, batch_rays: u64) -> u64 {
    (settings.rays / LOOKS).clamp(256, MOST_LOOKS).div_ceil(batch_rays)
}

struct Teacher<'a> {
    scene: &'a Scene,
    settings: &'a Settings,
    declared: &'a Importance,
    layout: Layout,
    stop: &'a AtomicBool,
}

impl Teacher<'_> {
    /// First scatter events of source rays, and the flights of these.
    fn visits(&self, quotas: &[Quota], batch_rays: u64) -> (Vec<Visit>, u64) {
        let trace = |batch: u64| {
            let watch = Visits { fresh: true, list: Vec::new() };
            let (watch, flights) = self.walk(watch, |walk| walk.batch(batch, quotas));
            (watch.list, flights)
        };
        together((0..looks(self.settings, batch_rays)).into_par_iter().map(trace).collect())
    }

    /// Where scouts of a detector come to, that fly about `flights` times in all. They weigh as if there were one.
    fn scouts(&self, detector: usize, flights: f64) -> Vec<Sighting> {
        let sources = shining(self.scene, detector);
        if sources.is_empty() {
            return Vec::new();
        }
        let troop = |number: u64| self.troop(detector, &sources, number);
        let (mut all, vanguard) = together((0..VANGUARD).into_par_iter().map(troop).collect());
        let troops = (flights * VANGUARD as f64 / vanguard.max(1) as f64) as u64;
        let (others, _) = together((VANGUARD..troops).into_par_iter().map(troop).collect());
        all.extend(others);
        let scouts = (TROOP * troops.max(VANGUARD)) as f64;
        all.iter_mut().for_each(|sighting| sighting.weight /= scouts);
        all
    }

    /// The scouts of one task and their flights.
    fn troop(&self, detector: usize, sources: &[Source], number: u64) -> (Vec<Sighting>, u64) {
        let way = Way::Straight(detector as u16);
        let scout = Scout { scene: self.scene, detector: detector as u16, way, sightings: Vec::new() };
        let (scout, flights) = self.walk(scout, |walk| {
            for scout in TROOP * number..TROOP * (number + 1) {
                let address = (detector as u64) << 32 | scout;
                let mut rng = Rng::new(walk.seed, address, 0);
                let source = &sources[scout as usize % sources.len()];
                let mut birth = source.emit(&mut |_| rng.uniform());
                birth.wavelength = wavelength(walk.scene, &mut rng);
                let mut packet = walk.born(source, (0, address), birth, source.flux * sources.len() as f64, rng);
                walk.history(&mut packet);
            }
        });
        (scout.sightings, flights)
    }

    /// Lets a watched walk happen; returns the watch, and the flights.
    fn walk<W: Watch>(&self, watch: W, trace: impl FnOnce(&mut Walk<1, W>)) -> (W, u64) {
        let rows = Rows::default();
        let book = Book::<1>::new(&self.layout, Live::new(self.layout.len()), Some(&rows));
        let mut walk = Walk::new(self.scene, self.settings, self.declared, book, watch);
        if !self.stop.load(Ordering::Relaxed) {
            trace(&mut walk);
        }
        (walk.watch, walk.book.segments)
    }
}

/// Lists one after the other, and the sum of what is counted beside.
fn together<T>(parts: Vec<(Vec<T>, u64)>) -> (Vec<T>, u64) {
    let count = parts.iter().map(|part| part.1).sum();
    (parts.into_iter().flat_map(|part| part.0).collect(), count)
}

/// Light scattered for the first time.
struct Visit {
    part: u32,
    front: bool,
    point: DVec3,
    /// W
    flux: f64,
}

impl Visit {
    fn worth(&self, patches: &Patches) -> f64 {
        patches.at(self.part, self.front, self.point).map_or(0.0, |patch| self.flux * patch.worth)
    }
}

/// Takes down first scatter events.
struct Visits {
    /// The packet in hand has not been scattered.
    fresh: bool,
    list: Vec<Visit>,
}

impl Watch for Visits {
    fn follows(&mut self, ancestry: &Ancestry) {
        self.fresh = ancestry.scatters == 0;
    }

    fn event(&mut self, sight: impl FnOnce() -> Sight) {
        if self.fresh {
            let Sight { part, front, point, flux, fractions, .. } = sight();
            self.list.push(Visit { part, front, point, flux: flux * fractions[2] });
        }
    }
}

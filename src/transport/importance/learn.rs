//! Learning before the run: scouts from every detector, and a first look at where light comes to.

use super::directions::Directions;
use super::patches::Patches;
use super::scout::{Scout, Sighting, Way, shining, wavelength};
use super::{Importance, Learned, Lit, Map};
use crate::detector::Arrival;
use crate::math::Rng;
use crate::math::rng::mix;
use crate::packet::Ancestry;
use crate::scene::Scene;
use crate::settings::{Roulette, Settings, Trace};
use crate::source::{Birth, Source};
use crate::tally::{Layout, Live};
use crate::transport::book::Book;
use crate::transport::paths::Rows;
use crate::transport::walk::{Quota, Walk};
use crate::transport::watch::{Sight, Watch};
use glam::DVec3;
use rayon::prelude::*;
use std::f64::consts::PI;
use std::sync::atomic::{AtomicBool, Ordering};

/// Part of the run's flights that scouts may take, all detectors together; least and most.
const SCOUTED: f64 = 0.1;
const FLIGHTS: [f64; 2] = [65_536.0, 2_097_152.0];
/// Flights of the light that looks where it comes to in a later round, in shares of those of scouts.
const LIT: f64 = 2.0;
/// Scouts of one task.
const TROOP: u64 = 256;
/// Tasks that tell how far scouts go.
const VANGUARD: u64 = 4;
/// Part of the run's rays that look where light comes to, and their most.
const LOOKS: u64 = 64;
const MOST_LOOKS: u64 = 1 << 14;
/// Part of the run's rays that tell rays from the detectors where light is, and their most.
const LIGHTS: u64 = 8;
const MOST_LIGHTS: u64 = 1 << 17;
/// Share of the scouts that set off evenly.
const EVENLY: f64 = 0.3;
/// Arrivals that tell where light comes from.
const FEWEST_ARRIVALS: usize = 16;
/// Branches of a source ray that the map is scaled for.
const BRANCHES: f64 = 16.0;

/// Shares of the scouts that go in each round; every round but the first is guided by what the one before taught.
const ROUNDS: [f64; 3] = [0.15, 0.25, 0.6];

/// What a run needs to know of importance, by random numbers of its own. Does not depend on the number of threads.
///
/// Light looks where it comes to; scouts then go where it is; light then goes where scouts found worth; and so on.
pub fn learn(scene: &Scene, settings: &Settings, quotas: &[Quota], batch_rays: u64, stop: &AtomicBool) -> Learned {
    let settings = &Settings {
        seed: mix(settings.seed ^ 0x696d_706f_7274),
        roulette: Roulette { below: 1e-6, survive: 0.1 },
        ..settings.clone()
    };
    let teacher = Teacher { scene, settings, quotas, batch_rays, layout: scene.layout(0), stop };
    let declared = Importance::declared(scene);
    let looks = teacher.batches(LOOKS, MOST_LOOKS);
    let (first, flights) = teacher.light(&declared, 0, looks, f64::INFINITY);
    let looked = (looks * batch_rays) as f64;
    let flights = (SCOUTED * flights as f64 / looked * settings.rays as f64).clamp(FLIGHTS[0], FLIGHTS[1]);
    let (mut light, mut importance) = (None, declared);
    for (round, share) in ROUNDS.into_iter().enumerate() {
        let sightings = teacher.scouted(&first, light.as_ref().unwrap_or(&first), share * flights, round as u64);
        let mut targets = scene.targets.clone();
        let patches = Patches::learn(scene, &sightings, &mut targets);
        let branches = teacher.branches(&first, looks, &patches);
        importance = Importance { targets, map: branches.map(|branches| Map { patches, branches }), aims: true };
        if round + 1 < ROUNDS.len() {
            light = Some(teacher.light(&importance, round as u64 + 1, looks, LIT * flights).0);
        }
    }
    let lit = || {
        let batches = teacher.batches(LIGHTS, MOST_LIGHTS);
        teacher.lit(&teacher.light(&importance, ROUNDS.len() as u64, batches, flights).0, false)
    };
    let lit = if settings.trace == Trace::Backward { lit() } else { Lit::default() };
    Learned { importance, lit }
}

struct Teacher<'a> {
    scene: &'a Scene,
    settings: &'a Settings,
    quotas: &'a [Quota],
    batch_rays: u64,
    layout: Layout,
    stop: &'a AtomicBool,
}

impl Teacher<'_> {
    /// Batches of a part of the run's rays, at most so many rays.
    fn batches(&self, part: u64, most: u64) -> u64 {
        (self.settings.rays / part).clamp(256, most).div_ceil(self.batch_rays)
    }

    /// Where light comes to that knows `importance`, and its flights: so many batches, fewer where they would fly more than `most` times.
    fn light(&self, importance: &Importance, round: u64, batches: u64, most: f64) -> (Light, u64) {
        let trace = |batch: u64| {
            let watch = Lantern { scene: self.scene, source: 0, scatters: 0, light: Light::new(self.scene) };
            let (watch, flights) = self.walk(importance, round << 1, watch, |walk| walk.batch(batch, self.quotas));
            (watch.light, flights)
        };
        let (all, first) = trace(0);
        let batches = ((most / first.max(1) as f64) as u64).clamp(1, batches);
        let parts: Vec<(Light, u64)> = (1..batches).into_par_iter().map(trace).collect();
        let flights = first + parts.iter().map(|part| part.1).sum::<u64>();
        (parts.into_iter().fold(all, |all, part| all.and(part.0)), flights)
    }

    /// What scouts of all detectors sight in about `flights` flights, that go where the light is.
    fn scouted(&self, first: &Light, light: &Light, flights: f64, round: u64) -> Vec<Sighting> {
        let mut lit = self.lit(light, true);
        let detectors = self.scene.detectors.len();
        let mut sightings = Vec::new();
        for detector in 0..detectors {
            let (sources, came) = (shining(self.scene, detector), lit.came[detector].take());
            let troops = Troops { detector, sources, lit: &lit.importance, came, round };
            let mut own = self.scouts(&troops, flights / detectors as f64);
            if detectors > 1 {
                // Every detector is to be known equally well: its sightings count by how much light it will get.
                let alone = Patches::learn(self.scene, &own, &mut Vec::new());
                let flux: f64 = first.visits.iter().map(|visit| visit.worth(&alone)).sum();
                own.iter_mut().for_each(|sighting| sighting.weight /= if flux > 0.0 { flux } else { f64::INFINITY });
            }
            sightings.extend(own);
        }
        sightings.retain(|sighting| sighting.weight > 0.0);
        sightings
    }

    /// Worth of a branch of every source's light, such that a ray of each will have [`BRANCHES`]; `None` if nothing is worth anything.
    fn branches(&self, first: &Light, looks: u64, patches: &Patches) -> Option<Vec<f64>> {
        let mut whole = vec![0.0; self.scene.sources.len()];
        first.visits.iter().for_each(|visit| whole[visit.source as usize] += visit.worth(patches));
        let rays = |quota: &Quota| (quota.count * looks) as f64;
        let branches: Vec<f64> =
            whole.iter().zip(self.quotas).map(|(whole, quota)| whole / (BRANCHES * rays(quota))).collect();
        let least = branches.iter().copied().filter(|branch| *branch > 0.0).fold(f64::INFINITY, f64::min);
        // Light of which nothing is known may be as faint as the faintest.
        least
            .is_finite()
            .then(|| branches.into_iter().map(|branch| if branch > 0.0 { branch } else { least }).collect())
    }

    /// What the light tells who goes backwards.
    fn lit(&self, light: &Light, aims: bool) -> Lit {
        let patches = Patches::learn(self.scene, &light.sightings, &mut Vec::new());
        let map = Some(Map { patches, branches: Vec::new() });
        let known = light.arrivals.iter().map(|arrivals| {
            let enough = arrivals.len() >= FEWEST_ARRIVALS;
            Directions::learn(arrivals.iter().copied().filter(|_| enough))
        });
        Lit { importance: Importance { map, aims, ..Importance::declared(self.scene) }, came: known.collect() }
    }

    /// Where scouts of a detector come to, that fly about `flights` times in all. They weigh as if there were one.
    fn scouts(&self, troops: &Troops, flights: f64) -> Vec<Sighting> {
        if troops.sources.is_empty() {
            return Vec::new();
        }
        let troop = |number: u64| self.troop(troops, number);
        let (mut all, vanguard) = together((0..VANGUARD).into_par_iter().map(troop).collect());
        let count = (flights * VANGUARD as f64 / vanguard.max(1) as f64) as u64;
        let (others, _) = together((VANGUARD..count).into_par_iter().map(troop).collect());
        all.extend(others);
        let scouts = (TROOP * count.max(VANGUARD)) as f64;
        all.iter_mut().for_each(|sighting| sighting.weight /= scouts);
        all
    }

    /// The scouts of one task and their flights.
    fn troop(&self, troops: &Troops, number: u64) -> (Vec<Sighting>, u64) {
        let detector = troops.detector as u16;
        let scout = Scout { scene: self.scene, detector, way: Way::Straight(detector), sightings: Vec::new() };
        let (scout, flights) = self.walk(troops.lit, troops.round << 1 | 1, scout, |walk| {
            for scout in TROOP * number..TROOP * (number + 1) {
                let address = (detector as u64) << 32 | scout;
                let mut rng = Rng::new(walk.seed, address, 0);
                let source = &troops.sources[scout as usize % troops.sources.len()];
                let (mut birth, weight) = troops.birth(source, &mut rng);
                birth.wavelength = wavelength(walk.scene, &mut rng);
                let flux = weight * source.flux * troops.sources.len() as f64;
                let mut packet = walk.born(source, (0, address), birth, flux, rng);
                walk.history(&mut packet);
            }
        });
        (scout.sightings, flights)
    }

    /// Lets a watched walk happen, with numbers of its own; returns the watch, and the flights.
    fn walk<W: Watch>(
        &self,
        importance: &Importance,
        stream: u64,
        watch: W,
        trace: impl FnOnce(&mut Walk<1, W>),
    ) -> (W, u64) {
        let rows = Rows::default();
        let book = Book::<1>::new(&self.layout, Live::new(self.layout.len()), Some(&rows));
        let mut walk = Walk::new(self.scene, self.settings, importance, book, watch);
        walk.seed = mix(self.settings.seed ^ mix(stream));
        if !self.stop.load(Ordering::Relaxed) {
            trace(&mut walk);
        }
        (walk.watch, walk.book.segments)
    }
}

/// Scouts of one detector in one round.
struct Troops<'a> {
    detector: usize,
    /// The detector, shining.
    sources: Vec<Source>,
    lit: &'a Importance,
    /// Directions in which light came to the detector.
    came: Option<Directions>,
    round: u64,
}

impl Troops<'_> {
    /// A scout sets off evenly in étendue, or to where light came from; and its weight.
    fn birth(&self, source: &Source, rng: &mut Rng) -> (Birth, f64) {
        let mut birth = source.emit(&mut |_| rng.uniform());
        let Some(came) = &self.came else { return (birth, 1.0) };
        if rng.uniform() >= EVENLY {
            birth.ray.direction = -came.draw(rng.pair());
        }
        let cosine = birth.ray.direction.dot(birth.normal);
        let even = cosine.max(0.0) / PI;
        (birth.clone(), even / (EVENLY * even + (1.0 - EVENLY) * came.density(-birth.ray.direction)))
    }
}

/// Lists one after the other, and the sum of what is counted beside.
fn together<T>(parts: Vec<(Vec<T>, u64)>) -> (Vec<T>, u64) {
    let count = parts.iter().map(|part| part.1).sum();
    (parts.into_iter().flat_map(|part| part.0).collect(), count)
}

/// Where light comes to.
struct Light {
    /// First scatter events.
    visits: Vec<Visit>,
    /// Scattered light at surfaces that scatter, and where it came from.
    sightings: Vec<Sighting>,
    /// Scattered light at every detector: its direction and flux, W.
    arrivals: Vec<Vec<(DVec3, f64)>>,
}

impl Light {
    fn new(scene: &Scene) -> Light {
        Light { visits: Vec::new(), sightings: Vec::new(), arrivals: vec![Vec::new(); scene.detectors.len()] }
    }

    fn and(mut self, other: Light) -> Light {
        self.visits.extend(other.visits);
        self.sightings.extend(other.sightings);
        self.arrivals.iter_mut().zip(other.arrivals).for_each(|(mine, others)| mine.extend(others));
        self
    }
}

/// Light scattered for the first time.
struct Visit {
    source: u16,
    part: u32,
    front: bool,
    normal: DVec3,
    point: DVec3,
    /// W
    flux: f64,
}

impl Visit {
    fn worth(&self, patches: &Patches) -> f64 {
        patches.at(self.part, self.front, self.normal, self.point).map_or(0.0, |patch| self.flux * patch.worth)
    }
}

/// Takes down where light comes to.
struct Lantern<'a> {
    scene: &'a Scene,
    /// Of the packet in hand.
    source: u16,
    scatters: u16,
    light: Light,
}

impl Watch for Lantern<'_> {
    fn follows(&mut self, ancestry: &Ancestry, _flux: f64) {
        (self.source, self.scatters) = (ancestry.source, ancestry.scatters);
    }

    fn event(&mut self, sight: impl FnOnce() -> Sight) {
        let Sight { part, front, normal, point, distance, flux, fractions, direction, .. } = sight();
        if !self.scene.scatters(part, front) {
            return;
        }
        if self.scatters == 0 {
            self.light.visits.push(Visit {
                source: self.source,
                part,
                front,
                normal,
                point,
                flux: flux * fractions[2],
            });
        } else {
            let way = Way::Scattered;
            let towards = -direction;
            self.light.sightings.push(Sighting { part, front, normal, point, towards, distance, weight: flux, way });
        }
    }

    fn arrives(&mut self, detector: usize, arrival: &Arrival, flux: f64) {
        if self.scatters > 0 {
            self.light.arrivals[detector].push((arrival.direction, flux));
        }
    }
}

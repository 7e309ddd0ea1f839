//! Light followed backwards, from the detector to the source.
//!
//! The flux that a detector of area A in a medium of index n gets, with L the radiance of sources along a path, is an integral over the
//! étendue of all rays that reach it:
//!
//!     F = integral of (L / n_s^2) tau dE,      dE = n^2 cos(theta) dw dA,      E = pi n^2 A per side
//!
//! n_s being the index where the light starts and tau what the path lets through. Rays start at the detector evenly in étendue, which
//! no interface changes (L / n^2 and E are invariant), so tau is all that has to be followed: reflectances, transmittances and the
//! Mueller matrices of the light *as it will go*, transposed (`reverse`), and at scatter events
//!
//!     (n'^2 / n^2) f(wi' -> wo') cos(theta') dw'
//!
//! with f for light that arrives from w' in a medium of index n' and leaves as the ray came, in n. No reciprocity is asked of the
//! models (Veach, Robust Monte Carlo Methods for Light Transport Simulation, 1997, ch. 5).
//!
//! Sources are met in two ways (`connect`): a *beam* (collimated, or narrow as the Sun) is asked for its light at every scatter event,
//! all beams of a run at once, so that one run answers for every field angle; a *plane* that shines into wide angles is met by chance. What cannot
//! be met - a beam that goes through a lens or off a mirror before it is first scattered, light of a point - is counted by the
//! rays that go forwards, and they count nothing else ([`Backward::counts`]): every path is counted once.
//!
//! The ledger is that of the forward rays. Light lost on the way backwards is summed apart.

pub(super) mod connect;
pub mod look;
pub(super) mod reverse;

use super::book::Book;
use super::importance::scout::shining;
use super::importance::{Importance, Lit};
use super::walk::Walk;
use super::watch::{Unwatched, Watch};
use crate::detector::Arrival;
use crate::math::Rng;
use crate::math::lowdiscrepancy::Block;
use crate::math::rng::mix;
use crate::packet::{Ancestry, Event, Packet};
use crate::scene::Scene;
use crate::settings::Settings;
use crate::source::{Birth, Reach, Source, Spectrum};
use glam::DVec3;
use std::f64::consts::PI;

/// Share of the rays that set off evenly, when it is known where light comes from.
const EVENLY: f64 = 0.3;

/// What a run that goes backwards knows before it starts.
#[derive(Debug)]
pub struct Backward {
    /// Every detector as a source, by the side it looks to; empty at infinity and on curved exact faces.
    detectors: Vec<Vec<Source>>,
    /// How each source of light is met.
    reaches: Vec<Reach>,
    /// Sources that share a spectrum, and so a ray.
    groups: Vec<Group>,
    /// What was learned of where light is.
    lit: Lit,
}

/// Sources that can be met backwards and have the same spectrum.
#[derive(Debug)]
struct Group {
    spectrum: Spectrum,
    sources: Vec<u16>,
}

/// Whether a detector lies on exact faces that are no plane: its facets are not where light arrives.
fn is_curved(scene: &Scene, detector: usize) -> bool {
    let watched = |part: &u32| scene.parts[*part as usize].detectors.contains(&(detector as u16));
    let exact = scene.part_of.iter().skip(scene.geometry.len()).any(watched);
    exact && scene.detectors[detector].grid.place(DVec3::ZERO).is_none()
}

/// What belongs to the ray that is followed backwards.
pub struct Trail<'a> {
    pub backward: &'a Backward,
    pub detector: usize,
    /// How the light arrives.
    pub arrival: Arrival,
    /// Sources that have its wavelength.
    pub sources: &'a [u16],
}

/// One of `count` things, by a coordinate in 0..1.
fn choose(u: f64, count: usize) -> usize {
    ((u * count as f64) as usize).min(count - 1)
}

impl Backward {
    pub fn new(scene: &Scene, lit: Lit) -> Backward {
        let reaches: Vec<Reach> = scene.sources.iter().map(Source::reach).collect();
        let mut groups: Vec<Group> = Vec::new();
        for (number, source) in scene.sources.iter().enumerate().filter(|(n, _)| reaches[*n] != Reach::Never) {
            match groups.iter_mut().find(|group| group.spectrum == source.spectrum) {
                Some(group) => group.sources.push(number as u16),
                None => groups.push(Group { spectrum: source.spectrum.clone(), sources: vec![number as u16] }),
            }
        }
        let start = |detector| if is_curved(scene, detector) { Vec::new() } else { shining(scene, detector) };
        let detectors = (0..scene.detectors.len()).map(start).collect();
        Backward { detectors, reaches, groups, lit }
    }

    /// Whether the light that arrives at a detector on this path is counted by rays that go backwards.
    pub fn counts(&self, detector: usize, path: &Ancestry) -> bool {
        let first = path.steps.first().map(|step| step.event());
        !self.detectors[detector].is_empty()
            && match self.reaches[path.source as usize] {
                Reach::Beam => first == Some(Event::Scatter),
                Reach::Plane => true,
                Reach::Never => false,
            }
    }

    /// What there is to know for the walk.
    pub fn importance(&self) -> &Importance {
        &self.lit.importance
    }

    /// Follows `rays` rays backwards, shared out evenly among the detectors; `book` counts what they find.
    pub fn batch<'a, const V: usize>(
        &'a self,
        scene: &'a Scene,
        settings: &'a Settings,
        book: Book<'a, V>,
        seed: u64,
        (batch, rays): (u64, u64),
    ) -> Book<'a, V> {
        let mut walk = Walk::new(scene, settings, self.importance(), book, Unwatched);
        walk.seed = mix(seed ^ 0x6261_636b_7761_7264);
        let watching = (0..self.detectors.len()).filter(|&d| !self.detectors[d].is_empty() && !self.groups.is_empty());
        for (place, detector) in watching.enumerate() {
            let block = Block::new(mix(walk.seed ^ place as u64), batch);
            let share = rays.div_ceil(self.detectors.len() as u64);
            for index in 0..share {
                let history = ((detector as u64) << 48) | (batch * share + index);
                let mut rng = Rng::new(walk.seed, history, 0);
                let mut u = |dimension| block.coordinate(index as u32, dimension, rng.uniform());
                self.ray(&mut walk, (detector, history), share, &mut u);
            }
        }
        walk.book.unit = None;
        walk.book
    }

    /// Follows one ray, one of `share`, that has the coordinates `u`.
    fn ray<'a, const V: usize>(
        &'a self,
        walk: &mut Walk<'a, V, Unwatched>,
        (detector, history): (usize, u64),
        share: u64,
        u: &mut dyn FnMut(u32) -> f64,
    ) {
        let sides = &self.detectors[detector];
        let source = &sides[choose(u(5), sides.len())];
        let group = &self.groups[choose(u(6), self.groups.len())];
        let (mut birth, weight) = self.birth(detector, source, u);
        birth.wavelength = group.spectrum.wavelength(u(4));
        let (mut packet, index) = self.sets_off(walk, source, birth, (detector, history), &group.sources);
        let etendue = PI * index * index * source.extent.area() * (sides.len() * self.groups.len()) as f64;
        packet.light = packet.light.map(|light| light * (weight * etendue / share as f64));
        walk.book.unit = Some(1.0 / etendue);
        walk.history(&mut packet);
    }

    /// A ray of unit flux at its start on a side of a detector, and the index there; the walk follows it backwards, and asks `sources`.
    fn sets_off<'a, const V: usize, W: Watch>(
        &'a self,
        walk: &mut Walk<'a, V, W>,
        side: &Source,
        birth: Birth,
        (detector, history): (usize, u64),
        sources: &'a [u16],
    ) -> (Packet<V>, f64) {
        let triangle = birth.from.map(|(triangle, _)| triangle);
        let Birth { ray, wavelength, .. } = &birth;
        let arrival = Arrival { point: ray.origin, direction: -ray.direction, wavelength: *wavelength, triangle };
        let rng = Rng::new(walk.seed, history, 1);
        let packet = walk.born(side, (0, history), birth, 1.0, rng);
        let index = walk.scene.index(walk.scene.medium_in(&packet.solids), packet.wavelength).re;
        walk.trail = Some(Trail { backward: self, detector, arrival, sources });
        (packet, index)
    }

    /// A ray sets off evenly in étendue, or to where light came from; and its weight.
    fn birth(&self, detector: usize, source: &Source, u: &mut dyn FnMut(u32) -> f64) -> (Birth, f64) {
        let mut birth = source.emit(u);
        let Some(came) = self.lit.came.get(detector).and_then(Option::as_ref) else { return (birth, 1.0) };
        if u(7) >= EVENLY {
            birth.ray.direction = -came.draw([u(2), u(3)]);
        }
        let even = birth.ray.direction.dot(birth.normal).max(0.0) / PI;
        let weight = even / (EVENLY * even + (1.0 - EVENLY) * came.density(-birth.ray.direction));
        (birth, weight)
    }
}

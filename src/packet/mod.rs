//! Flux in flight: one packet of light and how it got here.

mod class;

pub use class::Class;

use crate::film::Film;
use crate::geometry::Left;
use crate::geometry::Ray;
use crate::math::Rng;
use crate::math::rng::mix;
use crate::optics::Stokes;
use arrayvec::ArrayVec;
use glam::DVec3;
use std::borrow::Cow;

/// A packet of light. It carries its flux in `V` lanes, one per variant of the system (same geometry, other finish).
#[derive(Clone, Debug)]
pub struct Packet<const V: usize> {
    pub ray: Ray,
    /// Stokes vector of each lane, W, in the frame (transverse, direction x transverse, direction).
    pub light: [Stokes; V],
    /// Unit, perpendicular to the direction: Q > 0 means polarised along it.
    pub transverse: DVec3,
    /// Vacuum wavelength, m.
    pub wavelength: f64,
    /// The solids it is in.
    pub solids: Solids,
    /// What it just left: never hit again at once.
    pub left: Left,
    /// The film between two faces that it is in.
    pub film: Option<Box<Film>>,
    pub rng: Rng,
    /// Flux below which it is drawn for when it is scattered next, W: it was sent where it may not have met what it was aimed at.
    pub level: f64,
    pub ancestry: Ancestry,
}

impl<const V: usize> Packet<V> {
    /// Largest flux of any lane, W.
    pub fn flux(&self) -> f64 {
        self.light.iter().fold(0.0, |most, light| most.max(light.i))
    }

    /// Every lane's flux, W.
    pub fn fluxes(&self) -> [f64; V] {
        self.light.map(|light| light.i)
    }
}

/// Set of solids (indices into `Scene::solids`) that a packet is in, at most eight deep.
#[derive(Clone, Copy, Debug, Default)]
pub struct Solids {
    list: [u16; 8],
    count: u8,
}

impl Solids {
    /// Goes in; false if it was in already or the nesting is too deep.
    pub fn enter(&mut self, solid: u16) -> bool {
        let fits = !self.inside().contains(&solid) && (self.count as usize) < self.list.len();
        if fits {
            self.list[self.count as usize] = solid;
            self.count += 1;
        }
        fits
    }

    /// Goes out; false if it was not in.
    pub fn leave(&mut self, solid: u16) -> bool {
        let found = self.inside().iter().position(|&s| s == solid);
        if let Some(place) = found {
            self.count -= 1;
            self.list[place] = self.list[self.count as usize];
        }
        found.is_some()
    }

    /// True in the ambient.
    pub fn is_empty(&self) -> bool {
        self.count == 0
    }

    pub fn iter(&self) -> impl Iterator<Item = u16> + '_ {
        self.inside().iter().copied()
    }

    fn inside(&self) -> &[u16] {
        &self.list[..self.count as usize]
    }
}

/// What happened to the light.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[repr(u8)]
pub enum Event {
    Reflect = 0,
    Transmit = 1,
    Scatter = 2,
    /// Scattered inside a medium.
    Bulk = 3,
}

impl Event {
    /// One letter, as path tables write it.
    pub fn letter(self) -> char {
        ['R', 'T', 'S', 'V'][self as usize]
    }
}

/// A part, or for [`Event::Bulk`] a medium, what it did and whether it was there to do so, in one word.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Step(u32);

impl Step {
    /// What part or medium `number` (below 2^29) did. `intended`: this surface is there to do just that (a mirror reflects).
    pub fn new(number: u32, event: Event, intended: bool) -> Step {
        Step(number << 3 | (!intended as u32) << 2 | event as u32)
    }

    /// Index of the part or medium.
    pub fn number(self) -> u32 {
        self.0 >> 3
    }

    /// True for a reflection that nobody asked for: it makes a ghost.
    pub fn is_ghost(self) -> bool {
        self.event() == Event::Reflect && self.0 & 4 != 0
    }

    pub fn event(self) -> Event {
        [Event::Reflect, Event::Transmit, Event::Scatter, Event::Bulk][(self.0 & 3) as usize]
    }
}

/// Steps that a path key spells out; longer paths are booked in the row "other".
pub const LONGEST_PATH: usize = 24;

/// Reflections that a path spells out, however long it is.
pub const MOST_REFLECTIONS: usize = 8;

/// How a packet got here.
#[derive(Clone, Debug)]
pub struct Ancestry {
    /// Index of its source.
    pub source: u16,
    /// Number of its source ray.
    pub history: u64,
    /// Address of its branch of the event tree (see `Rng`).
    pub branch: u64,
    /// Events so far.
    pub events: u32,
    /// Hash of (source, steps so far): names the path.
    pub key: u64,
    pub steps: ArrayVec<Step, LONGEST_PATH>,
    /// The first reflections of any kind, also where `steps` are full.
    pub reflected: ArrayVec<Step, MOST_REFLECTIONS>,
    /// Reflections at surfaces that can transmit: the ghost order, and what the splitting budget counts.
    pub ghosts: u16,
    /// Scatter events.
    pub scatters: u16,
    /// Reflections of any kind.
    pub reflections: u32,
    /// True once an optical element (mirror or interface) was met.
    pub optics: bool,
    pub last_scatter: Option<Step>,
    /// Optical path since the source, m.
    pub optical_path: f64,
}

impl Ancestry {
    /// A newborn packet of source ray `history` from source `source`.
    pub fn born(source: u16, history: u64) -> Ancestry {
        Ancestry {
            source,
            history,
            branch: 0,
            events: 0,
            key: mix(source as u64 + 1),
            steps: ArrayVec::new(),
            reflected: ArrayVec::new(),
            ghosts: 0,
            scatters: 0,
            reflections: 0,
            optics: false,
            last_scatter: None,
            optical_path: 0.0,
        }
    }

    /// Takes one more step. `intended`: this surface is there to do just that (a mirror reflects).
    pub fn step(&mut self, number: u32, event: Event, intended: bool) {
        self.events += 1;
        let step = Step::new(number, event, intended);
        self.spell(step);
        match event {
            Event::Reflect => {
                self.reflections += 1;
                let _ = self.reflected.try_push(step);
                // Light trapped by total reflection can go round more often than that.
                self.ghosts = self.ghosts.saturating_add(!intended as u16);
                self.optics = true;
            }
            Event::Transmit => self.optics = true,
            Event::Scatter | Event::Bulk => {
                self.scatters = self.scatters.saturating_add(1);
                self.last_scatter = Some(step);
            }
        }
    }

    /// The same path from the other end, as light from source `source` goes it.
    pub fn reversed(&self, source: u16) -> Ancestry {
        let mut path = Ancestry { source, steps: ArrayVec::new(), key: mix(source as u64 + 1), ..self.clone() };
        self.steps.iter().rev().for_each(|step| path.spell(*step));
        let scatters = |step: &&Step| matches!(step.event(), Event::Scatter | Event::Bulk);
        path.last_scatter = self.steps.iter().find(scatters).copied();
        path.reflected.reverse();
        if !self.has_all_reflections() {
            // Of many reflections the first ones are those of the steps.
            let reflections = path.steps.iter().filter(|step| step.event() == Event::Reflect);
            path.reflected = reflections.take(MOST_REFLECTIONS).copied().collect();
        }
        if !self.is_spelled() {
            // Longer paths have no row: a key that no path from a source has.
            path.key = 0;
        }
        path
    }

    /// Writes a step down.
    fn spell(&mut self, step: Step) {
        self.key = mix(self.key.wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ (step.0 as u64 + 1));
        // A longer path has no row of its own: its key is never admitted, so its tail need not be spelled.
        let _ = self.steps.try_push(step);
    }

    /// The same path to a detector that watches the parts `watched`. Light is meant to end there: what they had reflected
    /// before, like what an interface reflects, comes back as a ghost. Told from the reflections that are spelled out.
    pub fn ending(&self, watched: impl Fn(u32) -> bool) -> Cow<'_, Ancestry> {
        let back = |step: &Step| step.event() == Event::Reflect && !step.is_ghost() && watched(step.number());
        let count = self.reflected.iter().filter(|step| back(step)).count() as u16;
        if count == 0 {
            return Cow::Borrowed(self);
        }
        let mut path = self.clone();
        path.ghosts = path.ghosts.saturating_add(count);
        for step in path.steps.iter_mut().chain(&mut path.reflected).filter(|step| back(step)) {
            *step = Step::new(step.number(), Event::Reflect, false);
        }
        Cow::Owned(path)
    }

    /// True if `reflected` are all reflections.
    pub fn has_all_reflections(&self) -> bool {
        self.reflections as usize <= self.reflected.len()
    }

    /// True if `steps` is the whole path.
    pub fn is_spelled(&self) -> bool {
        self.events as usize <= self.steps.len()
    }

    /// Which events (indexed by [`Event`]) there may be among the steps that are not spelled out.
    pub fn unspelled(&self) -> [bool; 4] {
        if self.is_spelled() {
            return [false; 4];
        }
        let count = |events: &[Event]| self.steps.iter().filter(|step| events.contains(&step.event())).count();
        let reflected = self.reflections as usize > count(&[Event::Reflect]);
        let scattered = self.scatters as usize > count(&[Event::Scatter, Event::Bulk]);
        [reflected, true, scattered, scattered]
    }

    /// Signal, leak, ghost or scatter: see [`Class`].
    pub fn class(&self) -> Class {
        match (self.scatters, self.ghosts) {
            (0, 0) if self.optics => Class::Signal,
            (0, 0) => Class::Direct,
            (0, n) => Class::Ghost(n.min(Class::MOST_GHOSTS)),
            (n, _) => Class::Scatter(n.min(Class::MOST_SCATTERS)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn different_paths_have_different_keys() {
        let mut keys = std::collections::HashSet::new();
        for part in 0..40 {
            for event in [Event::Reflect, Event::Transmit, Event::Scatter] {
                for second in 0..40 {
                    let mut a = Ancestry::born(0, 0);
                    a.step(part, event, false);
                    a.step(second, Event::Reflect, false);
                    assert!(keys.insert(a.key));
                }
            }
        }
    }

    #[test]
    fn a_path_reversed_is_the_path_from_the_other_end() {
        let steps = [(3, Event::Transmit), (5, Event::Scatter), (2, Event::Reflect), (7, Event::Scatter)];
        let go = |source: u16, steps: &mut dyn Iterator<Item = &(u32, Event)>| {
            let mut path = Ancestry::born(source, 9);
            steps.for_each(|&(part, event)| path.step(part, event, false));
            path
        };
        let (there, back) = (go(4, &mut steps.iter()), go(0, &mut steps.iter().rev()).reversed(4));
        assert_eq!((there.key, &there.steps, there.last_scatter), (back.key, &back.steps, back.last_scatter));
        assert_eq!((there.class(), there.ghosts, there.source), (back.class(), back.ghosts, back.source));
        let long: Vec<_> = (0..30).map(|part| (part, Event::Transmit)).collect();
        assert_ne!(go(0, &mut long.iter()).reversed(0).key, go(0, &mut long.iter().rev()).key);
    }

    #[test]
    fn what_a_detector_reflected_comes_back_to_it_as_a_ghost() {
        let mut path = Ancestry::born(0, 0);
        for (part, event, intended) in
            [(1, Event::Transmit, false), (2, Event::Reflect, true), (1, Event::Reflect, false)]
        {
            path.step(part, event, intended);
        }
        assert_eq!((path.class(), path.ending(|part| part == 3).class()), (Class::Ghost(1), Class::Ghost(1)));
        let seen = path.ending(|part| part == 2);
        assert_eq!((seen.class(), seen.key), (Class::Ghost(2), path.key));
        assert_eq!(
            seen.reflected.iter().filter(|step| step.is_ghost()).map(|s| s.number()).collect::<Vec<_>>(),
            [2, 1]
        );
    }

    #[test]
    fn trapped_light_stays_a_ghost_however_often_it_is_reflected() {
        let mut ancestry = Ancestry::born(0, 0);
        for _ in 0..=u16::MAX as u32 + 1 {
            ancestry.step(0, Event::Reflect, false);
        }
        assert_eq!((ancestry.ghosts, ancestry.reflections), (u16::MAX, u16::MAX as u32 + 2));
        assert_eq!(ancestry.class(), Class::Ghost(Class::MOST_GHOSTS));
    }

    #[test]
    fn solids_remember_what_they_are_in() {
        let mut solids = Solids::default();
        assert!(solids.enter(3) && solids.enter(1) && !solids.enter(3));
        assert!(solids.leave(3) && !solids.leave(3));
        assert_eq!(solids.iter().collect::<Vec<_>>(), [1]);
    }
}

//! Importance: where scattered light counts. It decides what is drawn and how often, never what it weighs.
//!
//! At a scatter event the packet is continued by n branches, n with mean k, each with a direction from the one mixture
//!
//!     p = a_0 p_lobes + sum_j a_j p_target,j + a_g p_learned,      weight f |cos| / (k p),
//!
//! so that every direction which any of them can draw is weighed by all of them (balance heuristic; Veach, Guibas, SIGGRAPH
//! 1995). k is the worth of the scattered light over the worth of a whole branch (weight windows; Haghighat, Wagner,
//! Progress in Nuclear Energy 42, 2003): light is divided where it counts and drawn for where it does not.

pub mod directions;
pub mod guide;
mod learn;
pub mod patches;
pub mod scout;
pub mod stones;

use crate::aim::{Target, View};
use crate::math::{Rng, sampling};
use crate::scene::Scene;
use arrayvec::ArrayVec;
use directions::Directions;
use glam::DVec3;
use guide::Guide;
pub use learn::learn;
use patches::{MOST_TARGETS, Patches};
use std::f64::consts::PI;

/// Share of the draws that lobes keep, where they are broad and where they are narrow.
const BROAD: f64 = 0.2;
const NARROW: f64 = 0.5;
/// Their largest share.
const MOST_LOBES: f64 = 0.9;
/// Wish for a target that the system declares, beside all that was found, which is 1.
const DECLARED: f64 = 0.3;
/// Share of the worth of a patch that may lie in any direction, whatever was learned.
const ANYWHERE: f64 = 0.05;
/// Least chance of a branch to live where no scout has been.
const UNSEEN: f64 = 0.1;
/// Share of the draws that go evenly into all directions where light is followed backwards.
const EVENLY: f64 = 0.05;
/// Most branches of one scatter event.
const MOST_BRANCHES: f64 = 64.0;
/// Targets that one mixture can hold: those of the system and those of the map.
const MOST_VIEWS: usize = MOST_TARGETS + 4;

/// What is known before the run.
#[derive(Debug, Default)]
pub struct Importance {
    /// Those of the system, then those that were found.
    pub targets: Vec<Target>,
    pub map: Option<Map>,
    /// Whether what surfaces aim at counts: the first of the targets are those of the system then.
    pub aims: bool,
}

/// The learned map.
#[derive(Debug)]
pub struct Map {
    pub patches: Patches,
    /// Worth of a whole branch that carries all the flux of a ray, of every source; empty: every packet goes on in one, whatever it
    /// is worth.
    pub branches: Vec<f64>,
}

/// What is known of where light is.
#[derive(Debug, Default)]
pub struct Lit {
    /// Towards where scattered light comes from.
    pub importance: Importance,
    /// Directions in which it came to every detector.
    pub came: Vec<Option<Directions>>,
}

/// What was learned before the run.
#[derive(Debug)]
pub struct Learned {
    pub importance: Importance,
    pub lit: Lit,
}

/// A packet about to be scattered.
pub struct Occasion {
    /// Whose light it is.
    pub source: u16,
    pub part: u32,
    pub front: bool,
    /// Of the face.
    pub triangle: u32,
    /// Scene coordinates, m.
    pub point: DVec3,
    /// Scattered flux, W, and that with which its source ray began.
    pub flux: f64,
    pub start: f64,
    /// Flux (W) below which it is drawn for, if it was aimed and there is no map.
    pub level: f64,
    /// True if no direction is much denser than others in the lobes.
    pub broad: bool,
    /// True if no light passes: the map knows what the side that it came to is worth.
    pub opaque: bool,
}

/// How a scattered packet goes on.
pub struct Advice<'a> {
    /// Mean number of branches.
    pub branches: f64,
    /// Shares of the draws.
    pub lobes: f64,
    views: ArrayVec<(f64, View), MOST_VIEWS>,
    learned: Option<(f64, &'a Guide)>,
    /// Where it is scattered, m.
    point: DVec3,
    /// Share that goes evenly into all directions.
    evenly: f64,
    /// What a whole ray that is scattered evenly is worth, in branches; `None`: every branch lives.
    worth: Option<f64>,
}

impl Advice<'_> {
    /// One branch from the lobes.
    const PLAIN: Advice<'static> = Advice {
        branches: 1.0,
        lobes: 1.0,
        views: ArrayVec::new_const(),
        learned: None,
        point: DVec3::ZERO,
        evenly: 0.0,
        worth: None,
    };

    /// True if nothing but the lobes of the surface is to be drawn from, once.
    pub fn is_plain(&self) -> bool {
        self.lobes == 1.0 && self.branches == 1.0 && self.worth.is_none()
    }

    /// A unit direction from what `turn`, in lobes..1, falls to.
    pub fn aim(&self, turn: f64, rng: &mut Rng) -> Option<DVec3> {
        let mut rest = turn - self.lobes - self.evenly;
        if rest < 0.0 {
            return Some(sampling::sphere(rng.pair()));
        }
        for (share, view) in &self.views {
            rest -= share;
            if rest < 0.0 {
                return Some(view.draw(rng));
            }
        }
        match self.learned {
            Some((_, guide)) => guide.draw(self.point, rng),
            None => self.views.last().map(|(_, view)| view.draw(rng)),
        }
    }

    /// Density of the mixture at a unit direction where that of the lobes is `lobes`, 1/sr.
    pub fn density(&self, direction: DVec3, lobes: f64) -> f64 {
        let views: f64 = self.views.iter().map(|(share, view)| share * view.density(direction)).sum();
        let learned = self.learned.map_or(0.0, |(share, guide)| share * guide.density(self.point, direction));
        self.lobes * lobes + views + learned + self.evenly * 0.25 / PI
    }

    /// Gives all directions a share: lobes that scatter one way need not be those that light comes the other way by.
    pub fn spread(&mut self) {
        self.lobes *= 1.0 - EVENLY;
        self.views.iter_mut().for_each(|(share, _)| *share *= 1.0 - EVENLY);
        self.learned = self.learned.map(|(share, guide)| (share * (1.0 - EVENLY), guide));
        self.evenly = EVENLY;
    }

    /// Gives the lobes the share that they are worth: `lobes` is their density at a direction that was aimed, and `aimed` the
    /// density with which.
    pub fn balance(&mut self, lobes: f64, aimed: f64) {
        let share = (lobes / (lobes + aimed)).clamp(self.lobes, MOST_LOBES);
        let others = (1.0 - share) / (1.0 - self.lobes);
        self.lobes = share;
        self.views.iter_mut().for_each(|(share, _)| *share *= others);
        self.learned = self.learned.map(|(share, guide)| (share * others, guide));
    }

    /// The chance of a branch to live, that carries `flux` (W) off at an angle with this cosine to the normal; the mixture has
    /// density `mixed` there and the lobes `lobes` (1/sr). `start`: most that it may carry then, W.
    pub fn survival(&self, flux: f64, cosine: f64, [mixed, lobes]: [f64; 2], start: f64) -> f64 {
        let Some(worth) = self.worth else { return 1.0 };
        // I(w) = W q(w) / cos, where W = pi M and q is the density that was learned.
        let learned = if self.lobes < 1.0 { (mixed - self.lobes * lobes).max(0.0) / (1.0 - self.lobes) } else { 0.0 };
        let towards = PI * (1.0 - ANYWHERE) * learned / cosine + ANYWHERE;
        let least = if worth > 0.0 { 0.0 } else { UNSEEN };
        let share = flux / start;
        (share * worth * towards).max(share).max(least).min(1.0)
    }
}

impl Importance {
    /// Only what the system says.
    pub fn declared(scene: &Scene) -> Importance {
        Importance { targets: scene.targets.clone(), map: None, aims: true }
    }

    /// How to go on.
    pub fn advise(&self, scene: &Scene, occasion: &Occasion) -> Advice<'_> {
        let aims = &scene.parts[occasion.part as usize].aims[!occasion.front as usize];
        let declared = if self.aims { aims } else { &[][..] };
        let whole = (occasion.flux / occasion.start).min(1.0);
        let Some(map) = &self.map else {
            if declared.is_empty() {
                return Advice::PLAIN;
            }
            let advice = self.mixed(occasion.point, 0.5, declared.iter().map(|&target| (1.0, target)), None);
            let both = if advice.lobes < 1.0 { 2.0 } else { 1.0 };
            return Advice { branches: both * (occasion.flux / occasion.level).min(1.0), ..advice };
        };
        let patch = map
            .patches
            .at(occasion.part, occasion.front, occasion.triangle, occasion.point)
            .filter(|_| occasion.opaque);
        let branch = map.branches.get(occasion.source as usize).filter(|_| occasion.opaque);
        let worth = branch.map(|branch| patch.map_or(0.0, |p| p.worth / branch));
        let least = if occasion.broad { 1.0 } else { 1.0 + whole };
        let branches = worth.map_or(1.0, |worth| (occasion.flux / occasion.start * worth).clamp(least, MOST_BRANCHES));
        let lobes = if occasion.broad { BROAD } else { NARROW };
        let found = patch.into_iter().flat_map(|patch| patch.targets.iter().map(|&(target, share)| (share, target)));
        let wishes = declared.iter().map(|&target| (DECLARED, target)).chain(found);
        let learned = patch.and_then(|patch| patch.rest.as_ref()).map(|(share, guide)| (*share, guide));
        let worth = worth.filter(|_| occasion.broad);
        Advice { branches, worth, ..self.mixed(occasion.point, lobes, wishes, learned) }
    }

    /// A mixture of lobes, the targets that are in sight, and what was learned; the lobes have the share `lobes` of the draws.
    fn mixed<'a>(
        &'a self,
        point: DVec3,
        lobes: f64,
        wishes: impl Iterator<Item = (f64, u16)>,
        learned: Option<(f64, &'a Guide)>,
    ) -> Advice<'a> {
        let seen = |(wish, target): (f64, u16)| Some((wish, self.targets[target as usize].seen(point)?));
        let mut views: ArrayVec<(f64, View), MOST_VIEWS> = wishes.filter_map(seen).take(MOST_VIEWS).collect();
        let sum = views.iter().map(|(wish, _)| wish).sum::<f64>() + learned.map_or(0.0, |(wish, _)| wish);
        if sum <= 0.0 {
            return Advice::PLAIN;
        }
        let others = 1.0 - lobes;
        views.iter_mut().for_each(|(share, _)| *share *= others / sum);
        let learned = learned.map(|(wish, guide)| (others * wish / sum, guide));
        Advice { lobes, views, learned, point, ..Advice::PLAIN }
    }
}

//! The map of importance: what a watt that is scattered at a place is worth to the detectors, and towards where.
//!
//! Light that a detector sends out backwards, uniform in étendue, reaches a patch of area A with the étendue E of all its rays
//! together. A watt that the patch scatters evenly is then worth M = E / (pi A), and what it is worth along a direction is in
//! proportion to the étendue that came from there. Sides of parts, each in the six ways that they may face, are divided into
//! patches where samples are many: the edge of a vane may see what its faces do not.

use super::directions::Directions;
use super::guide::Guide;
use super::scout::{Sighting, Way};
use crate::aim::Target;
use crate::geometry::Frame;
use crate::math::sampling;
use crate::scene::Scene;
use arrayvec::ArrayVec;
use glam::DVec3;
use std::collections::{BTreeMap, BTreeSet};
use std::f64::consts::PI;

/// Sightings that a patch should have.
const CROWD: usize = 256;
/// Most targets of a patch.
pub const MOST_TARGETS: usize = 4;
/// Share of the light through a lens that is drawn over the whole of it; the rest as learned.
const APERTURE: f64 = 0.3;
/// Size of what places are told apart by, in radii of the scene: above all roundings.
const SHARP: f64 = 1e-9;
/// Pieces of area into which all parts together are cut to measure patches.
const PIECES: f64 = 65_536.0;
/// Pieces that tell how large a patch is.
const FEW: usize = 8;

/// Patches of every side of every part.
#[derive(Debug, Default)]
pub struct Patches {
    /// The way that every triangle faces.
    ways: Vec<u8>,
    /// First node of every [`side`](Patches::side); `NOWHERE`: never seen.
    roots: Vec<u32>,
    nodes: Vec<Node>,
    patches: Vec<Patch>,
}

const NOWHERE: u32 = u32::MAX;

#[derive(Clone, Copy, Debug)]
enum Node {
    /// Below the plane, and not.
    Plane {
        axis: u8,
        at: f64,
        below: [u32; 2],
    },
    Patch(u32),
}

/// Neighbouring places on one side of a part.
#[derive(Clone, Debug)]
pub struct Patch {
    /// What a watt that it scatters evenly is worth, in the unit of the sightings.
    pub worth: f64,
    /// Targets, and the share of the worth that goes through each.
    pub targets: ArrayVec<(u16, f64), MOST_TARGETS>,
    /// Towards where the rest of the worth lies, and its share.
    pub rest: Option<(f64, Guide)>,
}

/// A piece of area: where, m2.
type Piece = (DVec3, f64);

impl Patches {
    /// The map from sightings; what they came through is appended to `targets`.
    pub fn learn(scene: &Scene, sightings: &[Sighting], targets: &mut Vec<Target>) -> Patches {
        let ways = ways(scene);
        let map = Patches { ways, roots: vec![NOWHERE; 2 * WAYS * scene.parts.len()], ..Patches::default() };
        let mut sides: BTreeMap<usize, Vec<&Sighting>> = BTreeMap::new();
        sightings.iter().for_each(|s| sides.entry(map.side(s.part, s.front, s.triangle)).or_default().push(s));
        let parts: BTreeSet<u32> = sightings.iter().map(|s| s.part).collect();
        let mut pieces = pieces(scene, &parts, &map);
        let mut learner = Learner { scene, targets, known: BTreeMap::new(), map };
        for (side, mut sightings) in sides {
            let own = pieces.entry(side / 2 * 2).or_default();
            let root = learner.divide(&mut sightings, own);
            learner.map.roots[side] = root;
        }
        learner.map
    }

    /// The patch of a place on a side of a part, on one of its triangles.
    pub fn at(&self, part: u32, front: bool, triangle: u32, point: DVec3) -> Option<&Patch> {
        let mut number = *self.roots.get(self.side(part, front, triangle))?;
        if number == NOWHERE {
            return None;
        }
        loop {
            match self.nodes[number as usize] {
                Node::Plane { axis, at, below } => number = below[(point[axis as usize] >= at) as usize],
                Node::Patch(patch) => return self.patches.get(patch as usize),
            }
        }
    }

    /// The number of a side of a part, one for every way that its triangles face: `2 (6 part + way) + (0 front, 1 back)`.
    fn side(&self, part: u32, front: bool, triangle: u32) -> usize {
        2 * (WAYS * part as usize + self.ways[triangle as usize] as usize) + !front as usize
    }

    /// Memory held, bytes.
    pub fn bytes(&self) -> usize {
        let directions: usize = self.patches.iter().filter_map(|p| p.rest.as_ref()).map(|(_, d)| d.bytes()).sum();
        self.ways.len()
            + size_of_val(&self.roots[..])
            + size_of_val(&self.nodes[..])
            + size_of_val(&self.patches[..])
            + directions
    }

    /// Number of patches.
    pub fn len(&self) -> usize {
        self.patches.len()
    }

    pub fn is_empty(&self) -> bool {
        self.patches.is_empty()
    }
}

/// Ways that a face may face.
const WAYS: usize = 6;

/// The axis that the normal of a face is nearest to, and which end of it: `2 axis + (0 along, 1 against)`.
fn way(normal: DVec3) -> u8 {
    let axis = normal.abs().max_position();
    (2 * axis + (normal[axis] < 0.0) as usize) as u8
}

/// The way that every triangle and exact face faces; parts with exact faces, which turn, are not told apart.
fn ways(scene: &Scene) -> Vec<u8> {
    let geometry = &scene.geometry;
    let exact: BTreeSet<u32> = scene.part_of.iter().skip(geometry.len()).copied().collect();
    let flat = |t: usize| t < geometry.len() && !exact.contains(&scene.part_of[t]);
    (0..scene.part_of.len()).map(|t| if flat(t) { way(geometry.triangle(t as u32).normal()) } else { 0 }).collect()
}

/// Triangles of `parts` in pieces of about equal area, by the fronts of the sides that they are on.
fn pieces(scene: &Scene, parts: &BTreeSet<u32>, map: &Patches) -> BTreeMap<usize, Vec<Piece>> {
    let geometry = &scene.geometry;
    let mine = || (0..geometry.len() as u32).filter(|&t| parts.contains(&scene.part_of[t as usize]));
    let whole: f64 = mine().map(|t| geometry.area(t)).sum();
    let mut pieces: BTreeMap<usize, Vec<Piece>> = BTreeMap::new();
    // One sequence for all triangles: where each had its own, strips of a tube would all be left out at the same height.
    let mut next = 0;
    for number in mine() {
        let triangle = geometry.triangle(number);
        let area = triangle.area();
        let count = (PIECES * area / whole).ceil().clamp(1.0, PIECES);
        let list = pieces.entry(map.side(scene.part_of[number as usize], true, number)).or_default();
        for i in next..next + count as u32 {
            // The additive recurrence of the plastic number fills the triangle evenly (Roberts, 2018).
            let u = [0.754_877_666_246_692_8, 0.569_840_290_998_053_3].map(|a| (0.5 + a * f64::from(i)).fract());
            list.push((triangle.at(sampling::triangle(u)), area / count));
        }
        next += count as u32;
    }
    pieces
}

struct Learner<'a> {
    scene: &'a Scene,
    targets: &'a mut Vec<Target>,
    /// Numbers of the targets that are known.
    known: BTreeMap<Way, u16>,
    map: Patches,
}

impl Learner<'_> {
    /// Divides a side; returns the number of its node.
    fn divide(&mut self, sightings: &mut [&Sighting], pieces: &mut [Piece]) -> u32 {
        let number = self.map.nodes.len() as u32;
        self.map.nodes.push(Node::Patch(self.map.patches.len() as u32));
        let Some((axis, at)) = plane(sightings) else {
            let patch = self.patch(sightings, pieces);
            self.map.patches.push(patch);
            return number;
        };
        sightings.sort_by(|a, b| a.point[axis].total_cmp(&b.point[axis]));
        pieces.sort_by(|a, b| a.0[axis].total_cmp(&b.0[axis]));
        let (low, high) = sightings.split_at_mut(sightings.partition_point(|s| s.point[axis] < at));
        let (small, large) = pieces.split_at_mut(pieces.partition_point(|p| p.0[axis] < at));
        let below = [self.divide(low, small), self.divide(high, large)];
        self.map.nodes[number as usize] = Node::Plane { axis: axis as u8, at, below };
        number
    }

    fn patch(&mut self, sightings: &[&Sighting], pieces: &[Piece]) -> Patch {
        let known: f64 = pieces.iter().map(|piece| piece.1).sum();
        // So few pieces may have fallen in by chance; sightings fill the patch.
        let filled = if pieces.len() < FEW { box_area(sightings) } else { 0.0 };
        let least = 0.5 * self.scene.geometry.radius().powi(2) / PIECES;
        let area = known.max(filled).max(least);
        let whole: f64 = sightings.iter().map(|s| s.weight).sum();
        let mut ways: BTreeMap<Way, f64> = BTreeMap::new();
        sightings.iter().for_each(|s| *ways.entry(s.way).or_default() += s.weight);
        let mut ways: Vec<(Way, f64)> = ways.into_iter().filter(|(way, _)| *way != Way::Scattered).collect();
        ways.sort_by(|a, b| b.1.total_cmp(&a.1).then(a.0.cmp(&b.0)));
        ways.truncate(MOST_TARGETS);
        let share = |way: &Way| if matches!(way, Way::Straight(_)) { 1.0 } else { APERTURE };
        let targets: ArrayVec<(u16, f64), MOST_TARGETS> =
            ways.iter().filter_map(|(way, w)| Some((self.target(*way)?, share(way) * w / whole))).collect();
        let rest = || sightings.iter().filter(|s| !matches!(s.way, Way::Straight(_)));
        let others = 1.0 - targets.iter().map(|(_, share)| share).sum::<f64>();
        let directions = Directions::learn(rest().map(|s| (s.towards, s.weight)));
        let places = || rest().map(|s| (s.point + s.distance * s.towards, s.weight)).collect();
        Patch {
            worth: whole / (PI * area),
            targets,
            rest: directions.map(|directions| {
                (others.max(0.0), Guide::learn(directions, places(), SHARP * self.scene.geometry.radius()))
            }),
        }
    }

    /// The number of the target that is seen on a way.
    fn target(&mut self, way: Way) -> Option<u16> {
        if let Some(&known) = self.known.get(&way) {
            return Some(known);
        }
        let target = match way {
            Way::Scattered => return None,
            Way::Straight(detector) => super::scout::target_of(self.scene, detector as usize)?,
            Way::Through(part) => part_target(self.scene, part),
        };
        self.targets.push(target);
        let number = self.targets.len() as u16 - 1;
        self.known.insert(way, number);
        Some(number)
    }
}

/// Largest face of the box around sightings, m2.
fn box_area(sightings: &[&Sighting]) -> f64 {
    let [a, b, c] = spread(sightings).to_array();
    (a * b).max(b * c).max(c * a)
}

/// Sides of the box around sightings, m.
fn spread(sightings: &[&Sighting]) -> DVec3 {
    let ends = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    let (low, high) = sightings.iter().fold(ends, |(l, h), s| (l.min(s.point), h.max(s.point)));
    high - low
}

/// Where to divide: half the sightings on each side, across where they spread most; `None` if they are too few or in one place.
fn plane(sightings: &[&Sighting]) -> Option<(usize, f64)> {
    if sightings.len() < 2 * CROWD {
        return None;
    }
    let spread = spread(sightings);
    let axis = (0..3).max_by(|&a, &b| spread[a].total_cmp(&spread[b]))?;
    let mut places: Vec<f64> = sightings.iter().map(|s| s.point[axis]).collect();
    let middle = places.len() / 2;
    let at = *places.select_nth_unstable_by(middle, f64::total_cmp).1;
    // More than half of them may be in one place.
    (places[..middle].iter().any(|place| *place < at)).then_some((axis, at))
}

/// The box around a part.
fn part_target(scene: &Scene, part: u32) -> Target {
    let mine = (0..scene.geometry.len() as u32).filter(|&t| scene.part_of[t as usize] == part);
    let corners = mine.flat_map(|t| scene.geometry.triangle(t).vertices);
    Target::around(scene.parts[part as usize].label.clone(), Frame::WORLD, corners)
}

//! What touches what, and what lies in what: found by rays from points of the triangles.

use crate::geometry::{Crossing, Hit, Left, Ray};
use crate::scene::Scene;
use crate::system::compile::assembly::Assembly;
use glam::DVec3;
use std::collections::{BTreeMap, BTreeSet};

/// Rays that look for contacts, about.
const LOOKS: usize = 40_000;
/// Points of a node that are tested for what they lie in, at most, and for all nodes together.
const POINTS: usize = 9;
const ALL_POINTS: usize = 20_000;
/// Faces that one such ray crosses at most.
const CROSSINGS: usize = 10_000;

/// Hits on two parts of different nodes that lie on each other, as one ray meets them; one pair for each pair of parts.
pub(in crate::system::compile) type Contacts = BTreeMap<[u32; 2], [Hit; 2]>;

/// Looks at points of the triangles, of every n-th if there are many, from just above.
pub(in crate::system::compile) fn contacts(scene: &Scene) -> Contacts {
    let geometry = &scene.geometry;
    let count = geometry.len();
    let tolerance = (0..count as u32).map(|i| geometry.tolerance(i)).fold(0.0, f64::max);
    // Above all that can coincide with it, and above the rounding of the point itself.
    let height = 4.0 * tolerance + 64.0 * f64::EPSILON * geometry.radius();
    let thirds: &[[f64; 3]] = &[[1.0, 1.0, 1.0], [4.0, 1.0, 1.0], [1.0, 4.0, 1.0], [1.0, 1.0, 4.0]];
    let looks = if count * thirds.len() <= LOOKS { thirds } else { &thirds[..1] };
    let mut contacts = Contacts::new();
    for triangle in (0..count).step_by((count / LOOKS).max(1)).map(|i| i as u32) {
        let (normal, corners) = (geometry.normal(triangle), geometry.triangle(triangle).vertices);
        for weights in looks {
            let place: DVec3 = corners.iter().zip(weights).map(|(corner, weight)| *corner * *weight).sum();
            let place = place / weights.iter().sum::<f64>();
            let ray = Ray { origin: place + height * normal, direction: -normal };
            let Some(crossing) = geometry.nearest(&ray, &Left::nothing()) else { continue };
            let met = |hit: &&Hit| hit.triangle == triangle;
            let crossing = match crossing.hits.iter().find(met) {
                Some(_) => crossing,
                None => match exact(scene, triangle, place, normal) {
                    Some(crossing) => crossing,
                    None => continue,
                },
            };
            let part = scene.part_of[triangle as usize];
            let mine = |hit: &&Hit| met(hit) || scene.part_of[hit.triangle as usize] == part;
            let Some(own) = crossing.hits.iter().find(mine) else { continue };
            for other in crossing.hits.iter().filter(|hit| hit.object != own.object) {
                let [a, b] = [own, other].map(|hit| scene.part_of[hit.triangle as usize]);
                let (key, hits) = if a < b { ([a, b], [*own, *other]) } else { ([b, a], [*other, *own]) };
                contacts.entry(key).or_insert(hits);
            }
        }
    }
    contacts
}

/// Where the exact face that stands for a triangle is met, within the triangle's size of `place`.
fn exact(scene: &Scene, triangle: u32, place: DVec3, normal: DVec3) -> Option<Crossing> {
    let geometry = &scene.geometry;
    let [a, b, c] = geometry.triangle(triangle).vertices;
    let reach = (b - a).length().max((c - b).length()).max((a - c).length());
    let (mut ray, mut left) = (Ray { origin: place + reach * normal, direction: -normal }, Left::nothing());
    let (mut way, part) = (0.0, scene.part_of[triangle as usize]);
    while way <= 2.0 * reach {
        let crossing = geometry.nearest(&ray, &left)?;
        let own = |hit: &Hit| hit.triangle as usize >= geometry.len() && scene.part_of[hit.triangle as usize] == part;
        if crossing.hits.iter().any(own) {
            return Some(crossing);
        }
        way += crossing.distance;
        (ray.origin, left) = (crossing.point, Left::after(&crossing, true, &left));
        // Several things in one place do not bring it on.
        way += 1e-3 * reach;
    }
    None
}

/// Nodes that touch node `node`.
pub(super) fn touching(scene: &Scene, contacts: &Contacts, node: u32) -> Vec<u32> {
    let objects = contacts.values().map(|hits| hits.map(|hit| scene.geometry.object(hit.triangle)));
    let other = objects.filter_map(|[a, b]| if a == node { Some(b) } else { (b == node).then_some(a) });
    other.collect::<BTreeSet<_>>().into_iter().collect()
}

/// Closed nodes around `point` (scene coordinates, m): those whose faces wind about it.
pub(super) fn around(scene: &Scene, closed: &[bool], point: DVec3) -> Vec<u32> {
    let direction = DVec3::new(0.271_938_4, 0.803_517_7, -0.529_550_1).normalize();
    let mut winding = BTreeMap::<u32, i32>::new();
    let (mut ray, mut left) = (Ray { origin: point, direction }, Left::nothing());
    for _ in 0..CROSSINGS {
        let Some(crossing) = scene.geometry.nearest(&ray, &left) else { break };
        for hit in &crossing.hits {
            *winding.entry(hit.object).or_default() += if hit.front { -1 } else { 1 };
        }
        (ray.origin, left) = (crossing.point, Left::after(&crossing, true, &left));
    }
    winding.into_iter().filter(|&(node, turns)| turns != 0 && closed[node as usize]).map(|(node, _)| node).collect()
}

/// Which nodes are closed.
pub(super) fn closed(assembly: &Assembly) -> Vec<bool> {
    assembly.nodes.iter().map(|node| node.mesh.topology.closed()).collect()
}

/// Closed nodes that node `node` lies in, and those it is partly in.
pub(super) fn holders(scene: &Scene, assembly: &Assembly, node: usize, touching: &[u32]) -> [Vec<u32>; 2] {
    let closed = closed(assembly);
    let points = (ALL_POINTS / assembly.nodes.len()).clamp(1, POINTS);
    let count = assembly.nodes[node].mesh.triangles.len();
    let mut held = BTreeMap::<u32, usize>::new();
    let mut tried = 0;
    let first = assembly.first[node];
    let exact: BTreeSet<u32> = assembly.exact[node].replaced.iter().copied().collect();
    for (triangle, corners) in assembly.triangles_of(node).step_by(count.div_ceil(points)) {
        tried += 1;
        let [a, b, c] = corners;
        // The middle of a facet that an exact face stands for is off that face: inwards by more than its sagitta.
        let inwards =
            if exact.contains(&(triangle - first)) { 0.05 * (b - a).length().max((c - b).length()) } else { 0.0 };
        let middle = (a + b + c) / 3.0 - inwards * (b - a).cross(c - a).normalize_or_zero();
        for holder in around(scene, &closed, middle).into_iter().filter(|&holder| holder as usize != node) {
            *held.entry(holder).or_default() += 1;
        }
    }
    let mut found = [Vec::new(), Vec::new()];
    for (holder, inside) in held {
        if inside == tried || (touching.contains(&holder) && 2 * inside > tried) {
            found[0].push(holder);
        } else if !touching.contains(&holder) {
            // Where faces touch, a point on them is on either side.
            found[1].push(holder);
        }
    }
    found
}

//! Round edges: what borders a circular rim must be round as well, or the solid would not be closed.

use super::outline::{directed, outline};
use crate::geometry::exact::Shape;
use crate::system::exact::{Declared, Round};
use crate::system::gltf::Node;
use std::collections::HashSet;

/// How far the corners of an edge may be from a cone, of its radius.
const ROUND: f64 = 1e-3;

/// Declares the edges between circular rims as cones; a rim whose neighbours are not round becomes a polygon again, and the
/// answer is false.
pub fn round(node: &mut Node) -> bool {
    let mut all = true;
    for index in 0..node.exact.len() {
        if !matches!(node.exact[index].rim, Round::Ring { .. }) {
            continue;
        }
        let rings: HashSet<u32> =
            node.exact.iter().filter(|d| d.rim != Round::Polygon).flat_map(|d| d.triangles.clone()).collect();
        let edges = outline(node, &node.exact[index].triangles, &directed(node));
        let beyond = edges.iter().filter_map(|edge| edge.beyond).find(|t| !rings.contains(t));
        let Some(seed) = beyond else { continue };
        let declared = node.exact.iter().position(|d| d.triangles.contains(&seed));
        let wall = match declared {
            Some(other) => node.exact[other].triangles.clone(),
            None => undeclared(node, seed),
        };
        match cone(node, &node.exact[index], &wall) {
            Some(cone) => {
                declared.into_iter().for_each(|other| drop(node.exact.remove(other)));
                node.exact.push(cone);
                // Removal has moved what stands behind: look at all again.
                return round(node) && all;
            }
            None => {
                node.exact[index].rim = Round::Polygon;
                all = false;
            }
        }
    }
    all
}

/// Triangles without a shape that are connected with one.
fn undeclared(node: &Node, seed: u32) -> Vec<u32> {
    let directed = directed(node);
    let mut seen: HashSet<u32> = node.exact.iter().flat_map(|d| d.triangles.clone()).collect();
    let (mut pending, mut found) = (vec![seed], Vec::new());
    seen.insert(seed);
    while let Some(triangle) = pending.pop() {
        found.push(triangle);
        let [a, b, c] = node.mesh.triangles[triangle as usize];
        let next = [[b, a], [c, b], [a, c]].map(|edge| directed.get(&edge).copied());
        pending.extend(next.into_iter().flatten().filter(|t| seen.insert(*t)));
    }
    found.sort_unstable();
    found
}

/// The cone that some triangles lie on, about the axis of a ring, if they lie on one and end in circles.
fn cone(node: &Node, ring: &Declared, wall: &[u32]) -> Option<Declared> {
    let local = |v: u32| {
        let p = ring.frame.to_local(node.mesh.vertices[v as usize] - ring.at);
        [p.truncate().length(), p.z]
    };
    let corners: Vec<[f64; 2]> = wall.iter().flat_map(|&t| node.mesh.triangles[t as usize]).map(local).collect();
    let low = corners.iter().copied().reduce(|a, b| if b[1] < a[1] { b } else { a })?;
    let high = corners.iter().copied().reduce(|a, b| if b[1] > a[1] { b } else { a })?;
    let taper = (high[0] - low[0]) / (high[1] - low[1]);
    let radius = low[0] - taper * low[1];
    let slack = ROUND * low[0].max(high[0]);
    let near = |[r, z]: &[f64; 2]| (r - (radius + taper * z)).abs() <= slack;
    let ends = |edge: &super::outline::Edge| {
        let heights = edge.from.map(|v| local(v)[1]);
        let level = |end: f64| heights.iter().all(|z| (z - end).abs() <= slack);
        level(low[1]) || level(high[1])
    };
    let edges = outline(node, wall, &directed(node));
    let whole = taper.is_finite() && corners.iter().all(near) && edges.iter().all(ends);
    // Both ends must be bordered by circles, or by nothing.
    let circles: HashSet<u32> =
        node.exact.iter().filter(|d| matches!(d.rim, Round::Ring { .. })).flat_map(|d| d.triangles.clone()).collect();
    let bordered = edges.iter().filter_map(|edge| edge.beyond).all(|t| circles.contains(&t));
    (whole && bordered).then(|| Declared {
        triangles: wall.to_vec(),
        shape: Shape::Cone { radius, taper },
        at: ring.at,
        frame: ring.frame,
        rim: Round::Band { low: low[1], high: high[1] },
    })
}

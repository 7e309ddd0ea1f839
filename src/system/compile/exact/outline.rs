//! Where a set of triangles ends.

use crate::system::gltf::Node;
use std::collections::{HashMap, HashSet};

/// An edge of an outline.
pub struct Edge {
    /// Corners in the sense of the face's triangle.
    pub from: [u32; 2],
    /// The triangle beyond.
    pub beyond: Option<u32>,
}

/// The triangle on the left of every directed edge of a node.
pub fn directed(node: &Node) -> HashMap<[u32; 2], u32> {
    let sides = |(t, [a, b, c]): (usize, &[u32; 3])| [[*a, *b], [*b, *c], [*c, *a]].map(|edge| (edge, t as u32));
    node.mesh.triangles.iter().enumerate().flat_map(sides).collect()
}

/// Edges between some triangles and the others.
pub fn outline(node: &Node, triangles: &[u32], directed: &HashMap<[u32; 2], u32>) -> Vec<Edge> {
    let own: HashSet<u32> = triangles.iter().copied().collect();
    let sides = triangles.iter().flat_map(|&t| {
        let [a, b, c] = node.mesh.triangles[t as usize];
        [[a, b], [b, c], [c, a]]
    });
    let edges = sides.map(|from| Edge { from, beyond: directed.get(&[from[1], from[0]]).copied() });
    edges.filter(|edge| edge.beyond.is_none_or(|beyond| !own.contains(&beyond))).collect()
}

//! The one door to obvhs: triangles in, wide nodes and an order of slots out.
//!
//! obvhs builds a binary tree by agglomerative clustering and reinsertion (Meister and Bittner, IEEE TVCG 24(3),
//! 2018); here its nodes are gathered into wide ones (Wald, Benthin, Boulos, "Getting rid of packets", 2008).

use super::shear::LEAF;
use super::wide::{DEEPEST, Node, PAD, WIDTH};
use arrayvec::ArrayVec;
use glam::{DVec3, Vec3A};
use obvhs::BvhBuildParams;
use obvhs::aabb::Aabb;
use obvhs::bvh2::builder::build_bvh2;
use obvhs::bvh2::node::Bvh2Node;
use std::time::Duration;

/// From metres to tree units and back: centred, scaled by a power of two.
#[derive(Clone, Copy, Debug)]
pub(super) struct Units {
    /// m
    pub centre: DVec3,
    /// Tree units per metre.
    pub scale: f64,
}

impl Units {
    /// For a scene between two corners, m.
    pub fn new(bounds: [DVec3; 2]) -> Units {
        let half = 0.5 * (bounds[1] - bounds[0]);
        let size = half.max_element();
        let scale = if size > 0.0 && size.is_finite() { (-size.log2().ceil()).exp2() } else { 1.0 };
        Units { centre: bounds[0] + half, scale }
    }

    pub fn point(&self, v: DVec3) -> DVec3 {
        (v - self.centre) * self.scale
    }
}

/// Stands in a slot where no triangle does.
pub(super) const NOBODY: u32 = u32::MAX;

/// Nodes, the first of them the root, and which triangle stands in which slot: every leaf has `LEAF` slots of its own.
pub(super) struct Tree {
    pub nodes: Vec<Node>,
    pub order: Vec<u32>,
}

/// A tree over the triangles with these corners and indices.
pub(super) fn grow(units: &Units, triangles: impl Iterator<Item = (u32, [DVec3; 3])>) -> Tree {
    let (ids, boxes): (Vec<u32>, Vec<Aabb>) = triangles.map(|(id, vertices)| (id, padded(units, &vertices))).unzip();
    if boxes.is_empty() {
        return Tree { nodes: vec![Node::EMPTY], order: Vec::new() };
    }
    let built = (!concentric(&boxes)).then(|| {
        let binary = build_bvh2(&boxes, effort(boxes.len()), &mut Duration::default());
        collapse(&binary.nodes, &binary.primitive_indices)
    });
    let mut tree = match built {
        Some((tree, depth)) if depth <= DEEPEST => tree,
        _ => {
            let (nodes, order) = halve(&boxes);
            collapse(&nodes, &order).0
        }
    };
    for slot in tree.order.iter_mut().filter(|slot| **slot != NOBODY) {
        *slot = ids[*slot as usize];
    }
    tree
}

/// Whether so many boxes share one centre that clustering, quadratic in their number, would take seconds.
fn concentric(boxes: &[Aabb]) -> bool {
    let mut centres: Vec<_> = boxes.iter().map(|b| b.center().to_array().map(f32::to_bits)).collect();
    centres.sort_unstable();
    centres.chunk_by(|a, b| a == b).any(|same| same.len() > 1000)
}

/// Slower building gives faster tracing; above some hundred thousand triangles the first would take too long.
fn effort(triangles: usize) -> BvhBuildParams {
    let preset = if triangles <= 200_000 { BvhBuildParams::very_slow_build() } else { BvhBuildParams::medium_build() };
    BvhBuildParams { pre_split: false, max_prims_per_leaf: LEAF as u32, collapse_traversal_cost: 8.0, ..preset }
}

fn padded(units: &Units, vertices: &[DVec3; 3]) -> Aabb {
    let [a, b, c] = vertices.map(|v| Vec3A::from(units.point(v).as_vec3()));
    Aabb::new(a.min(b).min(c) - PAD, a.max(b).max(c) + PAD)
}

/// Gathers a binary tree into wide nodes by opening the largest box first; also returns the levels of the result.
fn collapse(binary: &[Bvh2Node], primitives: &[u32]) -> (Tree, usize) {
    let mut tree = Tree { nodes: vec![Node::EMPTY], order: Vec::with_capacity(primitives.len()) };
    let mut pending = vec![(0usize, 0usize, 1usize)];
    let mut depth = 1;
    while let Some((from, to, level)) = pending.pop() {
        depth = depth.max(level);
        for (place, index) in open(binary, from).into_iter().enumerate() {
            let child = &binary[index];
            let (first, count) = if child.is_leaf() {
                let first = tree.order.len() as u32;
                let range = child.first_index as usize..(child.first_index + child.prim_count) as usize;
                tree.order.extend_from_slice(&primitives[range]);
                tree.order.resize(tree.order.len().next_multiple_of(LEAF), NOBODY);
                (first, child.prim_count)
            } else {
                tree.nodes.push(Node::EMPTY);
                pending.push((index, tree.nodes.len() - 1, level + 1));
                (tree.nodes.len() as u32 - 1, 0)
            };
            let node = &mut tree.nodes[to];
            node.set(place, child.aabb.min.to_array(), child.aabb.max.to_array());
            (node.first[place], node.count[place]) = (first, count);
        }
    }
    (tree, depth)
}

/// Up to `WIDTH` descendants that together hold what the binary node holds.
fn open(binary: &[Bvh2Node], index: usize) -> ArrayVec<usize, WIDTH> {
    let mut opened = ArrayVec::from_iter([index]);
    while !opened.is_full() {
        let inner = opened.iter().enumerate().filter(|(_, index)| !binary[**index].is_leaf());
        let area = |index: usize| binary[index].aabb.half_area();
        let Some((place, &largest)) = inner.max_by(|(_, a), (_, b)| area(**a).total_cmp(&area(**b))) else { break };
        let first = binary[largest].first_index as usize;
        opened[place] = first;
        opened.push(first + 1);
    }
    opened
}

/// A binary tree as deep as the logarithm of the count, whatever the boxes: halved along the longest side.
/// Slower to trace; for boxes that obvhs makes a chain of.
fn halve(boxes: &[Aabb]) -> (Vec<Bvh2Node>, Vec<u32>) {
    let mut order: Vec<u32> = (0..boxes.len() as u32).collect();
    let mut nodes = vec![Bvh2Node::default()];
    let mut pending = vec![(0usize, 0..boxes.len())];
    while let Some((index, range)) = pending.pop() {
        let part = &mut order[range.clone()];
        let around = part.iter().fold(Aabb::INVALID, |sum, &i| sum.union(&boxes[i as usize]));
        nodes[index] = Bvh2Node::new(around, part.len() as u32, range.start as u32);
        if part.len() > LEAF {
            let axis = around.largest_axis();
            let along = |i: u32| boxes[i as usize].min[axis] + boxes[i as usize].max[axis];
            let middle = part.len() / 2;
            part.select_nth_unstable_by(middle, |&a, &b| along(a).total_cmp(&along(b)).then(a.cmp(&b)));
            let first = nodes.len();
            nodes[index].make_inner(first as u32);
            pending.push((first, range.start..range.start + middle));
            pending.push((first + 1, range.start + middle..range.end));
            nodes.extend([Bvh2Node::default(); 2]);
        }
    }
    (nodes, order)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn concentric_triangles_make_a_shallow_tree_that_holds_each_once() {
        let corners = [DVec3::X, DVec3::Y, -DVec3::X - DVec3::Y];
        let nested: Vec<_> = (0..8000).map(|i| (i, corners.map(|v| v * (1.0 + i as f64)))).collect();
        let units = Units::new([DVec3::splat(-8000.0), DVec3::splat(8000.0)]);
        let start = std::time::Instant::now();
        let mut order = grow(&units, nested.into_iter()).order;
        assert!(start.elapsed() < Duration::from_secs(2));
        order.sort_unstable();
        assert!(order.into_iter().filter(|&slot| slot != NOBODY).eq(0..8000));
    }

    #[test]
    fn a_tree_of_nothing_and_of_one_triangle_can_be_asked() {
        let units = Units::new([DVec3::ZERO, DVec3::ONE]);
        assert!(grow(&units, std::iter::empty()).order.is_empty());
        assert_eq!(
            grow(&units, [(7, [DVec3::ZERO, DVec3::X, DVec3::Y])].into_iter()).order,
            [7, NOBODY, NOBODY, NOBODY]
        );
    }
}

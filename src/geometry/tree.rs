//! The one door to obvhs: triangles in, wide nodes and the triangles of each leaf out.
//!
//! obvhs builds a binary tree by agglomerative clustering and reinsertion (Meister and Bittner, IEEE TVCG 24(3),
//! 2018); here its nodes are gathered into wide ones (Wald, Benthin, Boulos, "Getting rid of packets", 2008).

use super::leaf::{LEAF, Leaf};
use super::wide::{Child, DEEPEST, Node, PAD, WIDTH};
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
        let centre = bounds[0] + 0.5 * (bounds[1] - bounds[0]);
        // From the rounded centre: a scene of a few roundings of its position must not stick out.
        let size = (bounds[1] - centre).max(centre - bounds[0]).max_element();
        // The least sizes would make the scale infinite.
        let scale = if size > 0.0 && size.is_finite() { (-size.log2().ceil()).min(1000.0).exp2() } else { 1.0 };
        Units { centre, scale }
    }

    pub fn point(&self, v: DVec3) -> DVec3 {
        (v - self.centre) * self.scale
    }
}

/// Nodes, the first of them the root, and leaves.
#[derive(Clone, Debug)]
pub(super) struct Tree<L> {
    pub nodes: Vec<Node>,
    pub leaves: Vec<L>,
}

/// Triangles by number.
pub(super) struct Soup<'a, F: Fn(u32) -> [u32; 3]> {
    /// m
    pub vertices: &'a [DVec3],
    /// The vertices of each.
    pub triangles: &'a F,
}

impl<F: Fn(u32) -> [u32; 3]> Soup<'_, F> {
    /// m
    pub fn corners(&self, triangle: u32) -> [DVec3; 3] {
        (self.triangles)(triangle).map(|v| self.vertices[v as usize])
    }
}

/// A tree over triangles with these numbers.
pub(super) fn grow(units: &Units, triangles: &[u32], soup: &Soup<impl Fn(u32) -> [u32; 3]>) -> Tree<Leaf> {
    let boxes: Vec<Aabb> = triangles.iter().map(|triangle| padded(units, &soup.corners(*triangle))).collect();
    let leaf = |primitives: &[u32]| {
        let held = primitives.iter().map(|primitive| triangles[*primitive as usize]);
        let named = held.map(|triangle| (triangle, (soup.triangles)(triangle)));
        Leaf::new(units, &named.collect::<ArrayVec<_, LEAF>>(), soup.vertices)
    };
    raise(&boxes, LEAF, &leaf)
}

/// A tree over boxes (m), each a leaf of its own.
pub(super) fn grow_boxes(units: &Units, boxes: &[[DVec3; 2]]) -> Tree<u32> {
    let boxes: Vec<Aabb> = boxes.iter().map(|corners| padded(units, corners)).collect();
    raise(&boxes, 1, &|primitives: &[u32]| primitives[0])
}

/// A tree over boxes in tree units with up to `most` of them in a leaf.
fn raise<L>(boxes: &[Aabb], most: usize, leaf: &impl Fn(&[u32]) -> L) -> Tree<L> {
    if boxes.is_empty() {
        return Tree { nodes: vec![Node::new(&[])], leaves: Vec::new() };
    }
    let built = (!concentric(boxes)).then(|| {
        let binary = build_bvh2(boxes, effort(boxes.len(), most), &mut Duration::default());
        collapse(&binary.nodes, &binary.primitive_indices, leaf)
    });
    match built {
        Some((tree, depth)) if depth <= DEEPEST => tree,
        _ => {
            let (nodes, order) = halve(boxes, most);
            collapse(&nodes, &order, leaf).0
        }
    }
}

/// Whether so many boxes share one centre that clustering, quadratic in their number, would take seconds.
fn concentric(boxes: &[Aabb]) -> bool {
    let mut centres: Vec<_> = boxes.iter().map(|b| b.center().to_array().map(f32::to_bits)).collect();
    centres.sort_unstable();
    centres.chunk_by(|a, b| a == b).any(|same| same.len() > 1000)
}

/// Slower building gives faster tracing; above some hundred thousand triangles the first would take too long.
fn effort(count: usize, most: usize) -> BvhBuildParams {
    let preset = if count <= 200_000 { BvhBuildParams::very_slow_build() } else { BvhBuildParams::medium_build() };
    BvhBuildParams { pre_split: false, max_prims_per_leaf: most as u32, collapse_traversal_cost: 8.0, ..preset }
}

/// The box around some points (m), in tree units.
fn padded(units: &Units, points: &[DVec3]) -> Aabb {
    let points = points.iter().map(|v| Vec3A::from(units.point(*v).as_vec3()));
    let (low, high) = points.fold((Vec3A::INFINITY, Vec3A::NEG_INFINITY), |(low, high), p| (low.min(p), high.max(p)));
    Aabb::new(low - PAD, high + PAD)
}

/// Gathers a binary tree into wide nodes by opening the largest box first; also returns the levels of the result.
fn collapse<L>(binary: &[Bvh2Node], primitives: &[u32], leaf: &impl Fn(&[u32]) -> L) -> (Tree<L>, usize) {
    let mut tree = Tree { nodes: vec![Node::new(&[])], leaves: Vec::new() };
    let mut pending = vec![(0usize, 0usize, 1usize)];
    let mut depth = 1;
    while let Some((from, to, level)) = pending.pop() {
        depth = depth.max(level);
        let mut held = ArrayVec::<_, WIDTH>::new();
        for index in open(binary, from) {
            let child = &binary[index];
            let what = if child.is_leaf() {
                let first = child.first_index as usize;
                tree.leaves.push(leaf(&primitives[first..first + child.prim_count as usize]));
                Child::leaf(tree.leaves.len() - 1)
            } else {
                tree.nodes.push(Node::new(&[]));
                pending.push((index, tree.nodes.len() - 1, level + 1));
                Child::node(tree.nodes.len() - 1)
            };
            held.push(([child.aabb.min.to_array(), child.aabb.max.to_array()], what));
        }
        tree.nodes[to] = Node::new(&held);
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
fn halve(boxes: &[Aabb], most: usize) -> (Vec<Bvh2Node>, Vec<u32>) {
    let mut order: Vec<u32> = (0..boxes.len() as u32).collect();
    let mut nodes = vec![Bvh2Node::default()];
    let mut pending = vec![(0usize, 0..boxes.len())];
    while let Some((index, range)) = pending.pop() {
        let part = &mut order[range.clone()];
        let around = part.iter().fold(Aabb::INVALID, |sum, &i| sum.union(&boxes[i as usize]));
        nodes[index] = Bvh2Node::new(around, part.len() as u32, range.start as u32);
        if part.len() > most {
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
        let vertices: Vec<DVec3> = (0..8000).flat_map(|i| corners.map(|v| v * (1.0 + i as f64))).collect();
        let nested = Soup { vertices: &vertices, triangles: &|i| [3 * i, 3 * i + 1, 3 * i + 2] };
        let units = Units::new([DVec3::splat(-8000.0), DVec3::splat(8000.0)]);
        let boxes: Vec<Aabb> = (0..8000).map(|i| padded(&units, &nested.corners(i))).collect();
        assert!(concentric(&boxes), "clustering would take seconds");
        let tree = grow(&units, &(0..8000).collect::<Vec<_>>(), &nested);
        assert!(tree.nodes.len() < 8000 / LEAF, "{} nodes", tree.nodes.len());
        let mut order: Vec<u32> =
            tree.leaves.iter().flat_map(|leaf| (0..leaf.count).map(|i| leaf.triangle(i as usize).0)).collect();
        order.sort_unstable();
        assert!(order.into_iter().eq(0..8000));
    }

    #[test]
    fn no_corner_lies_outside_the_unit_box() {
        let tiny = 1e-310;
        let close = f64::EPSILON;
        for bounds in [
            [DVec3::ZERO, DVec3::splat(tiny)],
            [
                DVec3::new(1.0 + close, -0.5 * close, -0.5 * close),
                DVec3::new(1.0 + 2.0 * close, 0.5 * close, 0.5 * close),
            ],
            [DVec3::splat(-1e150), DVec3::splat(1e150)],
        ] {
            let units = Units::new(bounds);
            assert!(bounds.iter().all(|&corner| units.point(corner).abs().max_element() <= 1.0), "{units:?}");
        }
    }

    #[test]
    fn a_tree_of_nothing_and_of_one_triangle_can_be_asked() {
        let units = Units::new([DVec3::ZERO, DVec3::ONE]);
        let corners = Soup { vertices: &[DVec3::ZERO, DVec3::X, DVec3::Y], triangles: &|_| [0, 1, 2] };
        assert!(grow(&units, &[], &corners).leaves.is_empty());
        let leaf = &grow(&units, &[7], &corners).leaves[0];
        assert_eq!((leaf.count, leaf.triangle(0)), (1, (7, [0, 1, 2])));
    }
}

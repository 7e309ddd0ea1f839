//! All triangles of a scene, and the one question: what does this ray meet next?
//!
//! The tree of boxes proposes in single precision (`wide`), the exact test decides in double (`shear`).

use super::Triangle;
use super::shear::{Corners, LEAF, Leaf};
use super::tree::{NOBODY, Units, grow};
use super::wide::Node;
use glam::DVec3;

/// A triangle of a scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Facet {
    pub triangle: Triangle,
    /// The object it is part of.
    pub object: u32,
    /// How far its corners may be from where they should be, m: the rounding of the file it came from.
    pub tolerance: f64,
}

/// Triangles and a tree of boxes over them. Indices are those of the facets it was built from.
#[derive(Clone, Debug)]
pub struct Bvh {
    pub(super) nodes: Vec<Node>,
    /// `LEAF` slots each.
    pub(super) leaves: Vec<Leaf>,
    /// Triangle of each slot.
    pub(super) triangles: Vec<u32>,
    /// A slot of each triangle.
    slots: Vec<u32>,
    objects: Vec<u32>,
    /// m
    tolerances: Vec<f64>,
    /// m
    bounds: [DVec3; 2],
    /// Greatest tolerance, m.
    pub(super) tolerance: f64,
    pub(super) units: Units,
}

/// Coordinates beyond this (m) would overflow when squared; a triangle that has one, or a NaN, is never met.
const FARTHEST: f64 = 1e150;

impl Bvh {
    /// Some microseconds per facet, in parallel. Facets without area and those whose corners are not finite keep
    /// their index but are never met. At most 2^32 - 1 facets.
    pub fn build(facets: &[Facet]) -> Bvh {
        let sound = |facet: &Facet| facet.triangle.vertices.iter().all(|v| v.abs().max_element() <= FARTHEST);
        let usable: Vec<_> = (0u32..).zip(facets).filter(|(_, facet)| sound(facet)).collect();
        let bounds = around(usable.iter().map(|(_, facet)| &facet.triangle));
        let units = Units::new(bounds);
        let tree = grow(&units, usable.iter().map(|(i, facet)| (*i, facet.triangle.vertices)));
        let (triangles, slots) = number(tree.order, facets.len());
        let corners = |slot: &u32| {
            let triangle = &facets.get(*slot as usize)?.triangle;
            Some(Corners::new(triangle.vertices, triangle.normal()))
        };
        let leaf = |slots: &[u32]| Leaf::new(&slots.iter().map(corners).collect::<Vec<_>>());
        Bvh {
            leaves: triangles.chunks(LEAF).map(leaf).collect(),
            nodes: tree.nodes,
            triangles,
            slots,
            objects: facets.iter().map(|facet| facet.object).collect(),
            tolerances: facets.iter().map(|facet| facet.tolerance).collect(),
            bounds,
            tolerance: facets.iter().fold(0.0, |greatest, facet| facet.tolerance.max(greatest)),
            units,
        }
    }

    /// Number of triangles.
    pub fn len(&self) -> usize {
        self.slots.len()
    }

    pub fn is_empty(&self) -> bool {
        self.slots.is_empty()
    }

    /// Least and greatest corner of the box around all triangles, m; zeros if there are none.
    pub fn bounds(&self) -> [DVec3; 2] {
        self.bounds
    }

    /// Half the diagonal of the bounds, m.
    pub fn radius(&self) -> f64 {
        0.5 * (self.bounds[1] - self.bounds[0]).length()
    }

    /// Triangle `index`; panics if there is none, as a slice would. So do the following.
    pub fn triangle(&self, index: u32) -> Triangle {
        Triangle { vertices: self.corners_of(index).vertices() }
    }

    /// Unit normal on the front; zero for a triangle without area.
    pub fn normal(&self, index: u32) -> DVec3 {
        self.corners_of(index).normal()
    }

    /// m2
    pub fn area(&self, index: u32) -> f64 {
        self.triangle(index).area()
    }

    /// The object it is part of.
    pub fn object(&self, index: u32) -> u32 {
        self.objects[index as usize]
    }

    /// How far its corners may be from where they should be, m.
    pub fn tolerance(&self, index: u32) -> f64 {
        self.tolerances[index as usize]
    }

    /// Memory held, bytes.
    pub fn bytes(&self) -> usize {
        size_of_val(&self.nodes[..])
            + size_of_val(&self.leaves[..])
            + size_of_val(&self.triangles[..])
            + size_of_val(&self.slots[..])
            + size_of_val(&self.objects[..])
            + size_of_val(&self.tolerances[..])
    }

    fn corners_of(&self, index: u32) -> Corners {
        self.corners(self.slots[index as usize])
    }

    /// The triangle that stands in a slot.
    #[inline(always)]
    pub(super) fn corners(&self, slot: u32) -> Corners {
        self.leaves[slot as usize / LEAF].corners(slot as usize % LEAF)
    }
}

/// The box around triangles, m.
fn around<'a>(triangles: impl Iterator<Item = &'a Triangle>) -> [DVec3; 2] {
    let boxes = triangles.map(Triangle::bounds);
    boxes.reduce(|sum, next| [sum[0].min(next[0]), sum[1].max(next[1])]).unwrap_or_default()
}

/// Slot -> triangle, with those that are in no leaf at the end; and triangle -> slot.
fn number(mut order: Vec<u32>, count: usize) -> (Vec<u32>, Vec<u32>) {
    const NOWHERE: u32 = u32::MAX;
    let mut slots = vec![NOWHERE; count];
    for (slot, &triangle) in order.iter().enumerate().filter(|(_, triangle)| **triangle != NOBODY) {
        slots[triangle as usize] = slot as u32;
    }
    for (triangle, slot) in slots.iter_mut().enumerate() {
        if *slot == NOWHERE {
            *slot = order.len() as u32;
            order.push(triangle as u32);
        }
    }
    (order, slots)
}

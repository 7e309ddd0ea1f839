//! All triangles of a scene, and the one question: what does this ray meet next?
//!
//! The tree of boxes (`wide`) and its leaves (`leaf`) propose in single precision, the exact test decides in double (`shear`).

use super::Triangle;
use super::tree::{Soup, Tree, Units, grow};
use glam::DVec3;

/// Triangles that belong together.
#[derive(Clone, Copy, Debug)]
pub struct Body<'a> {
    /// m
    pub vertices: &'a [DVec3],
    /// Indices of `vertices` there are, counter-clockwise seen from the front.
    pub triangles: &'a [[u32; 3]],
    /// How far the vertices may be from where they should be, m: the rounding of the file they came from.
    pub tolerance: f64,
}

/// Triangles and a tree of boxes over them. Triangles are numbered through, body after body; objects are bodies.
#[derive(Clone, Debug)]
pub struct Bvh {
    pub(super) tree: Tree,
    /// m
    vertices: Vec<DVec3>,
    records: Vec<Record>,
    /// Of each object, m.
    tolerances: Vec<f64>,
    /// m
    bounds: [DVec3; 2],
    /// Half the diagonal of the bounds, m.
    radius: f64,
    /// Greatest tolerance, m.
    pub(super) tolerance: f64,
    pub(super) units: Units,
}

/// A triangle.
#[derive(Clone, Copy, Debug)]
struct Record {
    vertices: [u32; 3],
    object: u32,
}

/// Coordinates beyond this (m) would overflow when squared; a triangle that has one, or a NaN, is never met.
const FARTHEST: f64 = 1e150;

impl Bvh {
    /// Some microseconds per triangle, in parallel. Triangles whose corners are not finite keep their number but are never
    /// met, as are those without area. At most 2^31 triangles and as many vertices.
    pub fn build(bodies: &[Body]) -> Bvh {
        let vertices: Vec<DVec3> = bodies.iter().flat_map(|body| body.vertices).copied().collect();
        let mut records = Vec::with_capacity(bodies.iter().map(|body| body.triangles.len()).sum());
        let mut first = 0;
        for (object, body) in (0..).zip(bodies) {
            records.extend(body.triangles.iter().map(|t| Record { vertices: t.map(|v| first + v), object }));
            first += body.vertices.len() as u32;
        }
        let soup = Soup { vertices: &vertices, triangles: &|triangle: u32| records[triangle as usize].vertices };
        let sound = |triangle: &u32| soup.corners(*triangle).iter().all(|v| v.abs().max_element() <= FARTHEST);
        let usable: Vec<u32> = (0..records.len() as u32).filter(sound).collect();
        let bounds = around(usable.iter().flat_map(|triangle| soup.corners(*triangle)));
        let units = Units::new(bounds);
        let tolerances: Vec<f64> = bodies.iter().map(|body| body.tolerance).collect();
        Bvh {
            tree: grow(&units, &usable, &soup),
            tolerance: tolerances.iter().copied().fold(0.0, f64::max),
            vertices,
            records,
            tolerances,
            bounds,
            radius: 0.5 * (bounds[1] - bounds[0]).length(),
            units,
        }
    }

    /// Number of triangles.
    pub fn len(&self) -> usize {
        self.records.len()
    }

    pub fn is_empty(&self) -> bool {
        self.records.is_empty()
    }

    /// Least and greatest corner of the box around all triangles, m; zeros if there are none.
    pub fn bounds(&self) -> [DVec3; 2] {
        self.bounds
    }

    /// Half the diagonal of the bounds, m.
    pub fn radius(&self) -> f64 {
        self.radius
    }

    /// Triangle `index`; panics if there is none, as a slice would. So do the following.
    #[inline]
    pub fn triangle(&self, index: u32) -> Triangle {
        self.between(self.records[index as usize].vertices)
    }

    /// The triangle between three vertices.
    #[inline(always)]
    pub(super) fn between(&self, vertices: [u32; 3]) -> Triangle {
        Triangle { vertices: vertices.map(|v| self.vertices[v as usize]) }
    }

    /// Unit normal on the front; zero for a triangle without area.
    #[inline]
    pub fn normal(&self, index: u32) -> DVec3 {
        self.triangle(index).normal()
    }

    /// m2
    pub fn area(&self, index: u32) -> f64 {
        self.triangle(index).area()
    }

    /// The object it is part of.
    #[inline]
    pub fn object(&self, index: u32) -> u32 {
        self.records[index as usize].object
    }

    /// How far its corners may be from where they should be, m.
    #[inline]
    pub fn tolerance(&self, index: u32) -> f64 {
        self.tolerances[self.object(index) as usize]
    }

    /// Memory held, bytes.
    pub fn bytes(&self) -> usize {
        size_of_val(&self.tree.nodes[..])
            + size_of_val(&self.tree.leaves[..])
            + size_of_val(&self.vertices[..])
            + size_of_val(&self.records[..])
    }
}

/// The box around points, m.
fn around(points: impl Iterator<Item = DVec3>) -> [DVec3; 2] {
    let boxes = points.map(|point| [point, point]);
    boxes.reduce(|sum, next| [sum[0].min(next[0]), sum[1].max(next[1])]).unwrap_or_default()
}

//! All triangles and exact faces of a scene, and the one question: what does this ray meet next?
//!
//! The tree of boxes (`wide`) and its leaves (`leaf`) propose in single precision, the exact test decides in double (`shear`).
//! Exact faces (`exact`) have a tree of their own, of boxes only.

use super::Triangle;
use super::exact::Face;
use super::leaf::Leaf;
use super::tree::{Soup, Tree, Units, grow, grow_boxes};
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
    /// Exact faces, and the triangles of this body that they stand for: those are never met.
    pub faces: &'a [Face],
    pub replaced: &'a [u32],
}

/// Triangles and exact faces with trees of boxes over them. Triangles are numbered through, body after body, then the exact
/// faces; objects are bodies.
#[derive(Clone, Debug)]
pub struct Bvh {
    pub(super) tree: Tree<Leaf>,
    /// Leaves are numbers of faces.
    pub(super) face_tree: Tree<u32>,
    pub(super) faces: Vec<Face>,
    /// Object of each face.
    face_objects: Vec<u32>,
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
        let (mut faces, mut face_objects) = (Vec::new(), Vec::new());
        let mut replaced = vec![false; records.capacity()];
        let mut first = 0;
        for (object, body) in (0..).zip(bodies) {
            body.replaced.iter().for_each(|triangle| replaced[records.len() + *triangle as usize] = true);
            records.extend(body.triangles.iter().map(|t| Record { vertices: t.map(|v| first + v), object }));
            first += body.vertices.len() as u32;
            faces.extend(body.faces.iter().cloned());
            face_objects.resize(faces.len(), object);
        }
        let soup = Soup { vertices: &vertices, triangles: &|triangle: u32| records[triangle as usize].vertices };
        let sound = |triangle: &u32| soup.corners(*triangle).iter().all(|v| v.abs().max_element() <= FARTHEST);
        let usable: Vec<u32> = (0..records.len() as u32).filter(|t| !replaced[*t as usize]).filter(sound).collect();
        let boxes: Vec<[DVec3; 2]> = faces.iter().map(Face::bounds).collect();
        let corners = usable.iter().flat_map(|triangle| soup.corners(*triangle));
        let bounds = around(corners.chain(boxes.iter().flatten().copied()));
        let units = Units::new(bounds);
        let tolerances: Vec<f64> = bodies.iter().map(|body| body.tolerance).collect();
        Bvh {
            tree: grow(&units, &usable, &soup),
            face_tree: grow_boxes(&units, &boxes),
            faces,
            face_objects,
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

    /// The object that a triangle or an exact face is part of.
    #[inline]
    pub fn object(&self, index: u32) -> u32 {
        match self.records.get(index as usize) {
            Some(record) => record.object,
            None => self.face_objects[index as usize - self.records.len()],
        }
    }

    /// The exact face of a number beyond those of the triangles.
    pub(super) fn face(&self, index: u32) -> Option<&Face> {
        self.faces.get((index as usize).checked_sub(self.records.len())?)
    }

    /// How far its corners may be from where they should be, m.
    #[inline]
    pub fn tolerance(&self, index: u32) -> f64 {
        self.tolerances[self.object(index) as usize]
    }

    /// Memory held, bytes.
    pub fn bytes(&self) -> usize {
        size_of_val(&self.face_tree.nodes[..])
            + size_of_val(&self.faces[..])
            + size_of_val(&self.tree.nodes[..])
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

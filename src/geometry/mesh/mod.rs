//! Triangles that share vertices: the shape of one part, with its topology known.
//!
//! A part arrives as a soup of triangles in which neighbours may store the same corner twice, or twice with different
//! rounding. Welding gives every corner one position, bit for bit, which is what a watertight ray test rests on; the
//! edges then say whether the part is closed, which way its faces look, and where its smooth faces end.

mod edges;
mod face;
mod weld;

use glam::{DAffine3, DMat3, DVec3};

pub use edges::Topology;
pub use face::Faces;
pub use weld::Repairs;

/// A welded mesh: no repeated position, no triangle without area, no triangle twice.
#[derive(Clone, Debug, Default)]
pub struct Mesh {
    /// Corner positions, m.
    pub vertices: Vec<DVec3>,
    /// Indices into `vertices`, counter-clockwise seen from outside.
    pub triangles: Vec<[u32; 3]>,
    /// One number per triangle, given by the caller and kept through welding (which material it has).
    pub labels: Vec<u16>,
    /// How far a vertex may be from where it was meant, m: the rounding of the stored coordinates.
    pub tolerance: f64,
    /// Counted over the welded edges.
    pub topology: Topology,
}

impl Mesh {
    /// The corners of triangle `i`, m.
    pub fn corners(&self, i: usize) -> [DVec3; 3] {
        self.triangles[i].map(|v| self.vertices[v as usize])
    }

    /// Twice the area of triangle `i` along its normal, m2.
    pub fn cross(&self, i: usize) -> DVec3 {
        cross(self.corners(i))
    }

    /// Unit normal of triangle `i`, on the side from which it is counter-clockwise.
    pub fn normal(&self, i: usize) -> DVec3 {
        self.cross(i).normalize_or_zero()
    }

    /// Area of triangle `i`, m2.
    pub fn area(&self, i: usize) -> f64 {
        0.5 * self.cross(i).length()
    }

    /// Moves every vertex; a mirror image keeps its front outside.
    pub fn transform(&mut self, map: &DAffine3) {
        let matrix = map.matrix3;
        if matrix == DMat3::IDENTITY {
            return self.vertices.iter_mut().for_each(|vertex| *vertex += map.translation);
        }
        self.vertices.iter_mut().for_each(|vertex| *vertex = map.transform_point3(*vertex));
        if matrix.determinant() < 0.0 {
            self.triangles.iter_mut().for_each(|triangle| triangle.swap(1, 2));
        }
        // The most a length grows, to within sqrt 3.
        self.tolerance *= matrix.x_axis.length().max(matrix.y_axis.length()).max(matrix.z_axis.length());
        (self.topology.area, self.topology.volume) = edges::area_and_volume(self);
    }

    /// Smallest and largest coordinates, m; `None` for a mesh without vertices.
    pub fn bounds(&self) -> Option<[DVec3; 2]> {
        let first = *self.vertices.first()?;
        let grow = |[low, high]: [DVec3; 2], v: &DVec3| [low.min(*v), high.max(*v)];
        Some(self.vertices.iter().fold([first, first], grow))
    }
}

fn cross([a, b, c]: [DVec3; 3]) -> DVec3 {
    (b - a).cross(c - a)
}

/// Height over the longest edge, m: zero when the corners are in line.
fn altitude([a, b, c]: [DVec3; 3]) -> f64 {
    let longest = (b - a).length_squared().max((c - b).length_squared()).max((a - c).length_squared()).sqrt();
    if longest > 0.0 { cross([a, b, c]).length() / longest } else { 0.0 }
}

//! Which triangles of a leaf may the line of a ray pass through? Asked of all of them at once, in single precision, on
//! corners rounded to a byte each way: it takes two cache lines.
//!
//! Lengths are in tree units (`wide`). Corners are v = base + q step, q = 0..255, rounded to the nearest; step is a power of two
//! for each axis and base a multiple of 2^-15, so that both are exact. With u = 2^-24, r = v - o carries 3u of rounding and half a
//! step; the ray is sheared as in `shear`, x' = r_x - s r_z with |s| <= 1, so with the roundings of s, product and sum x' is known to
//!
//!     e_x = 11u + (step_x + step_z) / 2,  here taken as 32u + (step_x + step_z) / 2;  e_y likewise        [tree units]
//!
//! and an edge function P_x Q_y - P_y Q_x, with 8u (|P_x| + |P_y|) for its own roundings (|x'|, |y'| <= 4), to better than
//!
//!     D = e_x (Y + e_y) + e_y (X + e_x),     X, Y  sums of |x'|, |y'| over the three corners
//!
//! A triangle is left out only if one edge function is below -D and another above +D: then the line passes it by, however
//! the corners were rounded. All others go to the exact test.

use super::shear::Shear;
use super::tree::Units;
use super::wide::PAD;
use glam::DVec3;

/// Most triangles in a leaf: as many as are tested side by side.
pub(super) const LEAF: usize = 8;

/// Steps to a tree unit of `base`, which counts from -1.
const BASES: f64 = 32768.0;

/// Rounded corners of up to `LEAF` triangles, and which they are.
#[repr(align(64))]
#[derive(Clone, Debug)]
pub(super) struct Leaf {
    triangles: [u32; LEAF],
    /// `[corner][axis][triangle]`, steps from the base.
    corners: [[[u8; LEAF]; 3]; 3],
    base: [u16; 3],
    /// Binary exponent of the step along each axis, as single precision stores it.
    step: [u8; 3],
    /// How many it holds.
    pub count: u8,
    /// Indices of each triangle's vertices, here so that they arrive with the rest.
    vertices: [[u32; 3]; LEAF],
}

/// The line of a ray in tree units, sheared as in `shear`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Line {
    origin: [f32; 3],
    axes: [usize; 3],
    slope: [f32; 2],
}

impl Line {
    /// Through `entry`, the point (tree units) at which the ray of `shear` enters the box of the scene.
    pub fn new(entry: DVec3, shear: &Shear) -> Line {
        let origin = entry.to_array().map(|x| x as f32);
        Line { origin, axes: shear.axes, slope: shear.slope.map(|s| s as f32) }
    }
}

impl Leaf {
    /// Up to `LEAF` triangles, each with the indices of its vertices in `positions` (m).
    pub fn new(units: &Units, held: &[(u32, [u32; 3])], positions: &[DVec3]) -> Leaf {
        let mut leaf = Leaf {
            triangles: [0; LEAF],
            corners: [[[0; LEAF]; 3]; 3],
            base: [0; 3],
            step: [0; 3],
            count: held.len().min(LEAF) as u8,
            vertices: [[0; 3]; LEAF],
        };
        let position = |vertex: u32| units.point(positions[vertex as usize]);
        let vertices = || held.iter().flat_map(|(_, vertices)| vertices.map(position));
        let least = vertices().fold(DVec3::INFINITY, DVec3::min);
        let greatest = vertices().fold(DVec3::NEG_INFINITY, DVec3::max);
        for axis in 0..3 {
            leaf.base[axis] = ((least[axis] + 1.0) * BASES).floor() as u16;
            let extent = greatest[axis] - leaf.base(axis) as f64;
            leaf.step[axis] = (127.0 + (extent / 255.0).log2().ceil()).max(1.0) as u8;
            for (place, (_, vertices)) in held.iter().enumerate().take(LEAF) {
                for (corner, vertex) in vertices.iter().enumerate() {
                    let steps = (position(*vertex)[axis] - leaf.base(axis) as f64) / leaf.step(axis) as f64;
                    leaf.corners[corner][axis][place] = steps.round() as u8;
                }
            }
        }
        for (place, (triangle, vertices)) in held.iter().enumerate().take(LEAF) {
            (leaf.triangles[place], leaf.vertices[place]) = (*triangle, *vertices);
        }
        leaf
    }

    /// Number and vertices of the triangle in a place below `LEAF`.
    #[inline(always)]
    pub fn triangle(&self, place: usize) -> (u32, [u32; 3]) {
        (self.triangles[place % LEAF], self.vertices[place % LEAF])
    }

    /// A bit for every triangle that the line may pass through.
    #[inline(always)]
    pub fn proposes(&self, line: &Line) -> u32 {
        let [x, y, z] = line.axes.map(|axis| axis.min(2)); // spares the bounds checks
        let step = [x, y, z].map(|axis| self.step(axis));
        let from = [x, y, z].map(|axis| self.base(axis) - line.origin[axis]);
        let (error_x, error_y) = (PAD + 0.5 * (step[0] + step[2]), PAD + 0.5 * (step[1] + step[2]));
        let [a, b, c] = self.corners.each_ref().map(|corner| [&corner[x], &corner[y], &corner[z]]);
        let map = |corner: &[&[u8; LEAF]; 3], i: usize| {
            let r = |k: usize| corner[k][i] as f32 * step[k] + from[k];
            (r(0) - line.slope[0] * r(2), r(1) - line.slope[1] * r(2))
        };
        let mut met = [0; LEAF];
        for (i, met) in met.iter_mut().enumerate() {
            let ((ax, ay), (bx, by), (cx, cy)) = (map(&a, i), map(&b, i), map(&c, i));
            let (along_x, along_y) = (ax.abs() + bx.abs() + cx.abs(), ay.abs() + by.abs() + cy.abs());
            let doubt = error_x * (along_y + error_y) + error_y * (along_x + error_x);
            let edges = [bx * cy - by * cx, cx * ay - cy * ax, ax * by - ay * bx];
            let left = (edges[0] >= -doubt) & (edges[1] >= -doubt) & (edges[2] >= -doubt);
            let right = (edges[0] <= doubt) & (edges[1] <= doubt) & (edges[2] <= doubt);
            *met = ((left | right) as u32) << i;
        }
        met.iter().fold(0, |all, met| all | met) & ((1 << self.count) - 1)
    }

    /// Tree units.
    #[inline(always)]
    fn base(&self, axis: usize) -> f32 {
        self.base[axis] as f32 * (1.0 / BASES as f32) - 1.0
    }

    /// Tree units.
    #[inline(always)]
    fn step(&self, axis: usize) -> f32 {
        f32::from_bits((self.step[axis] as u32) << 23)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Ray;
    use crate::math::Rng;

    /// Every triangle that the exact test meets was proposed, for triangles from 1e-7 of the scene to all of it; of the larger
    /// ones few are proposed in vain.
    #[test]
    fn whatever_the_exact_test_meets_was_proposed() {
        let mut rng = Rng::new(11, 0, 0);
        let mut point = |size: f64| DVec3::from_array(std::array::from_fn(|_| size * (2.0 * rng.uniform() - 1.0)));
        let units = Units::new([DVec3::NEG_ONE, DVec3::ONE]);
        let (mut met, mut proposed) = (0, 0);
        for i in 0..400_000 {
            let size = 10f64.powi(-(i % 8));
            let at = point(1.0 - size);
            let vertices = [0; 3].map(|_| at + point(size));
            let leaf = Leaf::new(&units, &[(0, [0, 1, 2])], &vertices);
            let (origin, towards) = (point(1.0), vertices[0] + point(size));
            let ray = Ray { origin, direction: (towards - origin).normalize() };
            let shear = Shear::new(&ray);
            let proposes = leaf.proposes(&Line::new(origin, &shear)) == 1;
            let meets = shear.meet(&vertices).is_some();
            assert!(proposes || !meets, "{vertices:?} {ray:?}");
            if size > 1e-4 {
                (met, proposed) = (met + meets as u32, proposed + proposes as u32);
            }
        }
        assert!(met > 10_000 && proposed < met + met / 4, "{met} met of {proposed}");
    }
}

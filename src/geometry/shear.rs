//! Where a ray meets a triangle, decided exactly: a closed mesh has no cracks and no edge is hit twice.
//!
//! The ray is turned into the axis of a sheared frame (Woop, Benthin, Wald, "Watertight Ray/Triangle Intersection",
//! JCGT 2(1), 2013): with z the dominant axis of the direction d and r = vertex - origin,
//!
//!     x' = r_x - (d_x / d_z) r_z      y' = r_y - (d_y / d_z) r_z      z' = r_z / d_z    [m]
//!
//! A vertex shared by two triangles gets the same bits in both. The ray stands at (0, 0), and its side of the edge
//! P -> Q is the sign of e = P_x Q_y - P_y Q_x. That sign is computed without error: rounding is monotone, so unequal
//! rounded products are ordered as the exact ones are; equal ones are ordered by their residuals fma(a, b, -fl(ab)),
//! which are exact. If e is exactly zero, the ray is taken to stand at (eps, eps^2) instead (simulation of simplicity:
//! Edelsbrunner and Muecke, ACM TOG 9(1), 1990):
//!
//!     e(eps) = e - eps (Q_y - P_y) + eps^2 (Q_x - P_x)
//!
//! so that an edge belongs to exactly one of its two triangles and a vertex to exactly one of the triangles around it.
//! Reversing an edge reverses its sign, bit for bit. No tolerance enters anywhere.
//!
//! Left out: products below 1e-308 m2 (vertices within 1e-154 m of the ray but not on it) are taken for zero.

use super::Ray;
use glam::DVec3;

/// A ray prepared for triangle tests.
#[derive(Clone, Copy, Debug)]
pub(super) struct Shear {
    origin: [f64; 3],
    /// Which coordinate plays x, y, z; below 3.
    pub axes: [usize; 3],
    /// d_x / d_z and d_y / d_z, dimensionless, -1..1.
    pub slope: [f64; 2],
    /// 1 / d_z, dimensionless.
    stretch: f64,
}

/// The ray's line through a triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Meeting {
    /// Along the ray, m; negative behind the origin.
    pub distance: f64,
    /// Weights of the three corners, each 0..1, sum 1.
    pub weights: [f64; 3],
    /// True if the line runs against the normal: it arrives on the front.
    pub front: bool,
}

impl Shear {
    pub fn new(ray: &Ray) -> Shear {
        let d = ray.direction;
        let size = d.abs();
        let z = if size.x >= size.y && size.x >= size.z {
            0
        } else if size.y >= size.z {
            1
        } else {
            2
        };
        let axes = [(z + 1) % 3, (z + 2) % 3, z];
        let slope = [d[axes[0]] / d[z], d[axes[1]] / d[z]];
        Shear { origin: ray.origin.to_array(), axes, slope, stretch: 1.0 / d[z] }
    }

    /// Sheared x' and y', and r_z, of one corner, m.
    #[inline(always)]
    fn map(&self, corner: DVec3) -> [f64; 3] {
        let corner = corner.to_array();
        let [x, y, z] = self.axes.map(|axis| axis.min(2)); // spares the bounds checks
        let depth = corner[z] - self.origin[z];
        let aside = |axis: usize, slope: f64| (corner[axis] - self.origin[axis]) - slope * depth;
        [aside(x, self.slope[0]), aside(y, self.slope[1]), depth]
    }

    /// Where the line of the ray passes through the triangle, either way; None if it passes by.
    #[inline(always)]
    pub fn meet(&self, vertices: &[DVec3; 3]) -> Option<Meeting> {
        let [a, b, c] = vertices.map(|vertex| self.map(vertex));
        let edges = [
            (b[0] * c[1]) - (b[1] * c[0]), // opposite to a
            (c[0] * a[1]) - (c[1] * a[0]),
            (a[0] * b[1]) - (a[1] * b[0]),
        ];
        let some_left = edges[0] > 0.0 || edges[1] > 0.0 || edges[2] > 0.0;
        let some_right = edges[0] < 0.0 || edges[1] < 0.0 || edges[2] < 0.0;
        if some_left && some_right {
            return None;
        }
        let on_an_edge = edges[0] == 0.0 || edges[1] == 0.0 || edges[2] == 0.0;
        let edges = if on_an_edge { by_simplicity(&a, &b, &c)? } else { edges };
        self.finish(edges, [a[2], b[2], c[2]])
    }

    /// From the three areas (doubled, of one sign) and depths to distance and weights; None if seen edge-on.
    #[inline(always)]
    fn finish(&self, edges: [f64; 3], depth: [f64; 3]) -> Option<Meeting> {
        let sum = edges[0] + edges[1] + edges[2];
        if sum == 0.0 || !sum.is_finite() {
            return None;
        }
        let weights = [edges[0] / sum, edges[1] / sum, edges[2] / sum];
        let z = weights[0] * depth[0] + weights[1] * depth[1] + weights[2] * depth[2];
        // Counter-clockwise in (x', y') means against z'; z' runs along the ray if 1 / d_z > 0, else against it.
        let front = (sum > 0.0) != (self.stretch > 0.0);
        Some(Meeting { distance: z * self.stretch, weights, front })
    }
}

/// The three edge functions, m2, if the ray, moved aside by an infinitesimal, stands on the same side of all edges.
#[cold]
fn by_simplicity(a: &[f64; 3], b: &[f64; 3], c: &[f64; 3]) -> Option<[f64; 3]> {
    let [(u, on_u), (v, on_v), (w, on_w)] = [side(b, c), side(c, a), side(a, b)];
    (on_u != 0 && on_u == on_v && on_v == on_w).then_some([u, v, w])
}

/// The edge function of p -> q, m2, and the side on which the ray stands: +1 left, -1 right, 0 only if p = q.
fn side(p: &[f64; 3], q: &[f64; 3]) -> (f64, i32) {
    let (left, right) = (p[0] * q[1], p[1] * q[0]);
    let edge = if left != right { left - right } else { p[0].mul_add(q[1], -left) - p[1].mul_add(q[0], -right) };
    let side = match (sign(edge), sign(p[1] - q[1])) {
        (0, 0) => sign(q[0] - p[0]),
        (0, by_height) => by_height,
        (exact, _) => exact,
    };
    (edge, side)
}

fn sign(x: f64) -> i32 {
    (x > 0.0) as i32 - (x < 0.0) as i32
}

#[cfg(test)]
mod tests {
    use super::*;

    fn corners(vertices: [[f64; 3]; 3]) -> [DVec3; 3] {
        vertices.map(DVec3::from)
    }

    #[test]
    fn weights_and_distance_give_the_point_and_the_side() {
        let a = corners([[0.0, 0.0, 2.0], [4.0, 0.0, 2.0], [0.0, 4.0, 2.0]]);
        let ray = Ray { origin: DVec3::new(1.0, 2.0, 0.0), direction: DVec3::Z };
        let back = Shear::new(&ray).meet(&a).unwrap();
        assert_eq!((back.distance, back.weights, back.front), (2.0, [0.25, 0.25, 0.5], false));
        let behind = Shear::new(&Ray { direction: -DVec3::Z, ..ray }).meet(&a).unwrap();
        assert_eq!((behind.distance, behind.front), (-2.0, true));
    }

    #[test]
    fn reversing_an_edge_reverses_its_side_even_when_the_ray_passes_through_it() {
        let values = [-3.0, -1.0, -0.1, -0.0, 0.0, 0.1, 0.3, 1.0, 3.0];
        for p in values.iter().flat_map(|&x| values.map(|y| [x, y, 0.0])) {
            for q in values.iter().flat_map(|&x| values.map(|y| [x, y, 0.0])) {
                let ((e, there), (f, back)) = (side(&p, &q), side(&q, &p));
                assert_eq!((e, there), (-f, -back));
                assert_eq!(there == 0, p == q);
            }
        }
    }

    #[test]
    fn the_side_is_exact_where_both_products_round_to_the_same_number() {
        let h = 2f64.powi(-30); // (1 + h)(1 - h) = 1 - h^2 rounds to 1
        let (p, q) = ([1.0 + h, 1.0, 0.0], [1.0, 1.0 - h, 0.0]);
        assert_eq!(p[0] * q[1], p[1] * q[0]);
        assert_eq!(side(&p, &q), (-h * h, -1));
    }

    #[test]
    fn a_triangle_seen_edge_on_is_passed_by() {
        let a = corners([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]);
        for x in [0.0, 0.25, 0.5, 1.0] {
            assert_eq!(Shear::new(&Ray { origin: DVec3::new(x, 0.0, -1.0), direction: DVec3::Z }).meet(&a), None);
        }
    }

    #[test]
    fn a_ray_that_is_not_a_number_meets_nothing() {
        let a = corners([[0.0, 0.0, 2.0], [4.0, 0.0, 2.0], [0.0, 4.0, 2.0]]);
        for direction in [DVec3::NAN, DVec3::ZERO, DVec3::INFINITY] {
            assert_eq!(Shear::new(&Ray { origin: DVec3::ONE, direction }).meet(&a), None);
        }
        assert_eq!(Shear::new(&Ray { origin: DVec3::NAN, direction: DVec3::Z }).meet(&a), None);
    }
}

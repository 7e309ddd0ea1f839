//! A flat facet, in double precision.

use glam::DVec3;

/// Three corners in m, counter-clockwise seen from outside: that side is the front, and the normal points out of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Triangle {
    pub vertices: [DVec3; 3],
}

impl Triangle {
    /// (b - a) x (c - a): along the normal, of length twice the area, m2.
    ///
    /// Taken at the corner between the two shortest edges, where the rounding error is least.
    fn doubled_area(&self) -> DVec3 {
        let [a, b, c] = self.vertices;
        let (ab, bc, ca) = (b - a, c - b, a - c);
        let longest = ab.length_squared().max(bc.length_squared()).max(ca.length_squared());
        if longest == bc.length_squared() {
            ca.cross(ab)
        } else if longest == ca.length_squared() {
            ab.cross(bc)
        } else {
            bc.cross(ca)
        }
    }

    /// Unit normal on the front; the zero vector for a triangle without area.
    pub fn normal(&self) -> DVec3 {
        self.doubled_area().normalize_or_zero()
    }

    /// Area, m2.
    pub fn area(&self) -> f64 {
        0.5 * self.doubled_area().length()
    }

    /// Least and greatest corner of the axis-aligned box around it, m.
    pub fn bounds(&self) -> [DVec3; 2] {
        let [a, b, c] = self.vertices;
        [a.min(b).min(c), a.max(b).max(c)]
    }

    /// Mean of the corners, m.
    pub fn centroid(&self) -> DVec3 {
        let [a, b, c] = self.vertices;
        (a + b + c) / 3.0
    }

    /// The point with these weights of the corners (sum 1), m.
    pub fn at(&self, weights: [f64; 3]) -> DVec3 {
        let [a, b, c] = self.vertices;
        a + weights[1] * (b - a) + weights[2] * (c - a)
    }

    /// False if a coordinate is infinite or not a number.
    pub fn is_finite(&self) -> bool {
        self.vertices.iter().all(|v| v.is_finite())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_normal_is_right_handed_and_turning_the_corners_keeps_it() {
        let [a, b, c] = [DVec3::ZERO, DVec3::X * 2.0, DVec3::Y * 3.0];
        for vertices in [[a, b, c], [b, c, a], [c, a, b]] {
            let triangle = Triangle { vertices };
            assert_eq!(triangle.normal(), DVec3::Z);
            assert_eq!(triangle.area(), 3.0);
            assert_eq!(triangle.bounds(), [DVec3::ZERO, DVec3::new(2.0, 3.0, 0.0)]);
        }
        assert_eq!(Triangle { vertices: [a, c, b] }.normal(), -DVec3::Z);
    }

    #[test]
    fn a_triangle_without_area_has_no_normal() {
        let line = Triangle { vertices: [DVec3::ZERO, DVec3::X, DVec3::X * 2.0] };
        assert_eq!(line.normal(), DVec3::ZERO);
        assert_eq!(line.area(), 0.0);
    }
}

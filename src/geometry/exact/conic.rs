//! Surfaces of revolution of the second degree, and the plane.
//!
//!     F = c (x^2 + y^2 + (1 + k) z^2) - 2 z = 0        c = 1 / R [1/m],  k conic constant [1]
//!     z = c r^2 / (1 + sqrt(1 - (1 + k) c^2 r^2))      the sheet through the vertex
//!
//! R > 0: the centre lies towards +z. k = 0 sphere, -1 paraboloid, below -1 hyperboloid, c = 0 plane.
//! Along a ray F = A t^2 + 2 B t + C; the discriminant B^2 - A C is formed without cancellation (Kahan's difference of
//! products), the roots as q/A and C/q, and each point is moved onto the surface by one Newton step along the gradient.
//!
//! Source: ISO 10110-12; W. Kahan, "On the cost of floating-point computation without extra-precise arithmetic" (2004).

use super::Root;
use glam::DVec3;

/// A conic of revolution about z through the origin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Conic {
    /// 1/m; 0 for a plane.
    pub curvature: f64,
    /// Conic constant, dimensionless.
    pub conic: f64,
}

impl Conic {
    /// Height of the sheet through the vertex at distance `r` (m) from the axis, m; NaN beyond its equator.
    pub fn sag(&self, r: f64) -> f64 {
        let c = self.curvature;
        c * r * r / (1.0 + (1.0 - (1.0 + self.conic) * c * c * r * r).sqrt())
    }

    /// Slope of the sheet through the vertex, dimensionless.
    pub fn slope(&self, r: f64) -> f64 {
        let c = self.curvature;
        c * r / (1.0 - (1.0 + self.conic) * c * c * r * r).sqrt()
    }

    /// Distance from the axis at which the sheet through the vertex turns back, m; infinite if it does not.
    pub fn equator(&self) -> f64 {
        if self.conic > -1.0 { 1.0 / (self.curvature.abs() * (1.0 + self.conic).sqrt()) } else { f64::INFINITY }
    }

    /// -grad F / 2: along the normal, which looks to +z at the vertex; dimensionless.
    fn downhill(&self, p: DVec3) -> DVec3 {
        let c = self.curvature;
        DVec3::new(-c * p.x, -c * p.y, 1.0 - c * (1.0 + self.conic) * p.z)
    }

    /// Unit normal at a point of the surface.
    pub fn normal(&self, p: DVec3) -> DVec3 {
        self.downhill(p).normalize()
    }

    /// True on the sheet through the vertex.
    pub fn near(&self, p: DVec3) -> bool {
        1.0 - self.curvature * (1.0 + self.conic) * p.z >= 0.0
    }

    /// True if the sheet through the vertex is well known by its height at this distance from the axis.
    pub(super) fn level_known(&self, p: DVec3) -> bool {
        self.near(p) && p.x.hypot(p.y) < 0.7 * self.equator()
    }

    /// The nearest point of the surface to one that is beside it by rounding.
    pub fn settle(&self, p: DVec3) -> DVec3 {
        let c = self.curvature;
        let f = c * (p.x * p.x + p.y * p.y + (1.0 + self.conic) * p.z * p.z) - 2.0 * p.z;
        let downhill = self.downhill(p);
        p + 0.5 * f / downhill.length_squared() * downhill
    }

    /// Where the line o + t d meets it.
    pub fn roots(&self, o: DVec3, d: DVec3) -> [Option<Root>; 2] {
        let (c, e) = (self.curvature, 1.0 + self.conic);
        let a = c * (d.x * d.x + d.y * d.y + e * d.z * d.z);
        let b = c * (o.x * d.x + o.y * d.y + e * o.z * d.z) - d.z;
        let f = c * (o.x * o.x + o.y * o.y + e * o.z * o.z) - 2.0 * o.z;
        // F falls where the level z - sag rises.
        quadratic(a, b, f).map(|root| root.map(|(t, falls)| Root { t, rises: falls }))
    }
}

/// The roots of a t^2 + 2 b t + c, and whether the polynomial falls there.
pub(super) fn quadratic(a: f64, b: f64, c: f64) -> [Option<(f64, bool)>; 2] {
    let discriminant = difference(b, b, a, c);
    if discriminant.is_nan() || discriminant < 0.0 {
        return [None; 2];
    }
    let q = -(b + discriminant.sqrt().copysign(b));
    let some = |t: f64, falls: bool| t.is_finite().then_some((t, falls));
    // (-b - s) / a falls, (-b + s) / a rises.
    let minus = b.is_sign_positive();
    [some(q / a, minus), some(c / q, !minus)]
}

/// p q - r s to within 1.5 roundings.
fn difference(p: f64, q: f64, r: f64, s: f64) -> f64 {
    let second = r * s;
    p.mul_add(q, -second) - r.mul_add(s, -second)
}

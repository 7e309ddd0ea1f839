//! Directions from a point through a rectangle, uniform in solid angle.
//!
//! The rectangle seen from the point is a spherical quadrangle of solid angle W = g0 + g1 + g2 + g3 - 2 pi, g being its inner
//! angles; its strips of equal solid angle and the points on them can be inverted in closed form (Urena, Fajardo, King, "An
//! area-preserving parametrization for spherical rectangles", Computer Graphics Forum 32(4), 2013). The sum of the angles loses
//! digits where W is small: a rectangle that looks small is sampled uniformly in area instead, with density d^2 / (A cos theta).

use crate::geometry::Frame;
use glam::{DVec2, DVec3};
use std::f64::consts::TAU;

/// Height over its plane, relative to the distance, from which a rectangle is no longer looked at: the digits of W go.
const GRAZING: f64 = 1e-6;

/// Estimated solid angle (sr) below which a rectangle is sampled in area.
const SMALL: f64 = 1e-3;

/// A rectangle as a point sees it.
#[derive(Clone, Copy, Debug)]
pub struct Rectangle {
    /// z points from the point to the plane of the rectangle.
    frame: Frame,
    /// Least and greatest corner, m, in the frame about the point.
    low: DVec2,
    high: DVec2,
    /// Distance of the plane, m.
    height: f64,
    method: Method,
}

#[derive(Clone, Copy, Debug)]
enum Method {
    Area,
    SolidAngle {
        /// sr
        whole: f64,
        /// 2 pi less the two angles at the far end of the strips.
        offset: f64,
        /// Heights of the normals of the two edges that strips run between.
        edges: [f64; 2],
    },
}

impl Rectangle {
    /// The rectangle with half sides `half` (m) along x and y of `frame` about `centre` (m from the point); `None` if the point
    /// lies in its plane.
    pub fn seen(frame: &Frame, centre: DVec3, half: DVec2) -> Option<Rectangle> {
        let local = frame.to_local(centre);
        // Turned about x so that the rectangle is ahead.
        let ahead = local.z > 0.0;
        let frame = if ahead { *frame } else { Frame { x: frame.x, y: -frame.y, z: -frame.z } };
        let middle = frame.to_local(centre);
        let height = middle.z;
        let distance = middle.length();
        if height <= GRAZING * (distance + half.length()) || half.min_element() <= 0.0 {
            return None;
        }
        let (low, high) = (middle.truncate() - half, middle.truncate() + half);
        let estimate = 4.0 * half.x * half.y * height / distance.powi(3);
        let near = half.length() > 0.5 * distance;
        let method = if estimate < SMALL && !near { Method::Area } else { Method::quadrangle(low, high, height) };
        Some(Rectangle { frame, low, high, height, method })
    }

    /// Solid angle, sr; estimated where it is small.
    pub fn solid_angle(&self) -> f64 {
        match self.method {
            Method::SolidAngle { whole, .. } => whole,
            Method::Area => {
                let middle = (0.5 * (self.low + self.high)).extend(self.height);
                self.area() * self.height / middle.length().powi(3)
            }
        }
    }

    fn area(&self) -> f64 {
        (self.high - self.low).element_product()
    }

    /// A unit direction through the rectangle at two coordinates in [0, 1).
    pub fn draw(&self, [u, v]: [f64; 2]) -> DVec3 {
        let place = match self.method {
            Method::Area => self.low + DVec2::new(u, v) * (self.high - self.low),
            Method::SolidAngle { whole, offset, edges } => self.strip(u * whole + offset, edges, v),
        };
        self.frame.to_world(place.extend(self.height)).normalize()
    }

    /// The point at `v` on the strip edge where the solid angle is `angle`, less the offset.
    fn strip(&self, angle: f64, [first, second]: [f64; 2], v: f64) -> DVec2 {
        let slope = (angle.cos() * first - second) / angle.sin();
        let cosine = (1f64.copysign(slope) / slope.hypot(first)).clamp(-1.0, 1.0);
        let x = cosine * self.height / (1.0 - cosine * cosine).sqrt();
        let x = x.clamp(self.low.x, self.high.x);
        let away = x.hypot(self.height);
        let [start, end] = [self.low.y, self.high.y].map(|y| y / away.hypot(y));
        let sine = start + v * (end - start);
        let y = away * sine / ((1.0 - sine) * (1.0 + sine)).sqrt();
        DVec2::new(x, y.clamp(self.low.y, self.high.y))
    }

    /// Density of `draw` at a unit direction, 1/sr.
    pub fn density(&self, direction: DVec3) -> f64 {
        let local = self.frame.to_local(direction);
        if local.z <= 0.0 {
            return 0.0;
        }
        let place = local.truncate() * (self.height / local.z);
        if place.cmplt(self.low).any() || place.cmpgt(self.high).any() {
            return 0.0;
        }
        match self.method {
            Method::SolidAngle { whole, .. } => 1.0 / whole,
            Method::Area => (self.height / local.z).powi(2) / (self.area() * local.z),
        }
    }
}

impl Method {
    /// The spherical quadrangle over `low..high` at distance `height`.
    fn quadrangle(low: DVec2, high: DVec2, height: f64) -> Method {
        // Normals of the planes through the point and each edge, turning about the rectangle; only two components are not zero.
        let towards = |y: f64| DVec3::new(0.0, height, -y) / height.hypot(y);
        let across = |x: f64| DVec3::new(-height, 0.0, x) / height.hypot(x);
        let [south, north] = [towards(low.y), -towards(high.y)];
        let [east, west] = [across(high.x), -across(low.x)];
        let inner = |a: DVec3, b: DVec3| (-a.dot(b)).clamp(-1.0, 1.0).acos();
        let [g0, g1, g2, g3] = [inner(south, east), inner(east, north), inner(north, west), inner(west, south)];
        let offset = TAU - g2 - g3;
        Method::SolidAngle { whole: g0 + g1 - offset, offset, edges: [south.z, north.z] }
    }
}

//! The strip between a chord and the exact surface above or below it.
//!
//! A point of the plane through the chord A -> B and the direction k of its cut is A + alpha (B - A) + h k. It belongs to the
//! strip if 0 <= alpha <= 1 and it lies between the chord, h = 0, and the surface, level = 0. With the chord in the sense of
//! the face, the front of the strip looks along (B - A) x k where the surface is above the chord (h > 0) and against it where it
//! is below: the boundary of face and strip together is the chord.

use super::Touch;
use super::shape::Shape;
use glam::DVec3;
use std::sync::Arc;

/// A strip in the coordinates of the face whose chord it is on, m.
#[derive(Clone, Debug)]
pub struct Sliver {
    start: DVec3,
    along: DVec3,
    lift: DVec3,
    /// along x lift, m.
    normal: DVec3,
    shape: Arc<Shape>,
    pub(super) bounds: [DVec3; 2],
}

impl Sliver {
    /// Over the chord from a to b (in the sense of the face's triangles); `lift` is a unit vector along which the shape's level rises.
    pub fn new([a, b]: [DVec3; 2], lift: DVec3, shape: Arc<Shape>) -> Sliver {
        let (along, normal) = (b - a, (b - a).cross(lift));
        let points: Vec<DVec3> = (0..=16)
            .flat_map(|i| {
                let chord = a + f64::from(i) / 16.0 * along;
                let height = -shape.level(chord);
                [chord, chord + if height.is_finite() { 1.1 * height } else { 0.0 } * lift]
            })
            .collect();
        let low = points.iter().fold(DVec3::INFINITY, |low, p| low.min(*p));
        let high = points.iter().fold(DVec3::NEG_INFINITY, |high, p| high.max(*p));
        Sliver { start: a, along, lift, normal, shape, bounds: [low, high] }
    }

    /// About two thirds of chord times sagitta, m2.
    pub fn area(&self) -> f64 {
        2.0 / 3.0 * self.along.length() * self.shape.level(self.middle()).abs()
    }

    pub(super) fn meet(&self, o: DVec3, d: DVec3) -> Option<Touch> {
        let t = (self.start - o).dot(self.normal) / d.dot(self.normal);
        if !t.is_finite() {
            return None;
        }
        let p = o + t * d;
        let alpha = (p - self.start).cross(self.lift).dot(self.normal) / self.normal.length_squared();
        if !(0.0..=1.0).contains(&alpha) {
            return None;
        }
        let height = (p - self.start - alpha * self.along).dot(self.lift);
        let level = self.shape.level(p);
        let above = height >= 0.0;
        if if above { level <= 0.0 } else { level >= 0.0 } {
            let normal = if above { self.normal } else { -self.normal }.normalize();
            return Some(Touch { distance: t, point: p, normal, front: d.dot(normal) < 0.0 });
        }
        None
    }

    pub(super) fn middle(&self) -> DVec3 {
        self.start + 0.5 * self.along
    }
}

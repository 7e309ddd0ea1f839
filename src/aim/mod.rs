//! Where scattered light is sent on purpose: targets, and the directions from a point through them.
//!
//! A target is a box. Of the light that a surface scatters, some is drawn through the box instead of from the lobes of the
//! surface; the density of both together weighs it, so that a target that is of no use costs variance and never truth.

pub mod rectangle;

use crate::geometry::Frame;
use crate::math::Rng;
use glam::{DVec2, DVec3};
use rectangle::Rectangle;
use smallvec::SmallVec;

/// A box to aim at; flat if one of its sides is zero.
#[derive(Clone, Debug)]
pub struct Target {
    pub label: String,
    pub frame: Frame,
    /// Scene coordinates, m.
    pub centre: DVec3,
    /// Half sides along x, y, z of the frame, m.
    pub half: DVec3,
}

/// The faces of a target that a point sees.
#[derive(Clone, Debug)]
pub struct View {
    /// With the solid angle of each, sr; estimated where small: the share of draws that it gets.
    faces: SmallVec<[(Rectangle, f64); 1]>,
    whole: f64,
}

impl Target {
    /// The smallest box along the axes of `frame` around points (m).
    pub fn around(label: String, frame: Frame, points: impl Iterator<Item = DVec3>) -> Target {
        let ends = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        let (low, high) = points.map(|p| frame.to_local(p)).fold(ends, |(l, h), p| (l.min(p), h.max(p)));
        let middle = 0.5 * (low + high);
        Target { label, frame, centre: frame.to_world(middle), half: 0.5 * (high - low).max(DVec3::ZERO) }
    }

    /// What `point` sees of it; `None` from inside, from its plane if it is flat, or from too near to its plane.
    pub fn seen(&self, point: DVec3) -> Option<View> {
        let away = self.frame.to_local(point - self.centre);
        let axes = [self.frame.x, self.frame.y, self.frame.z];
        let mut view = View { faces: SmallVec::new(), whole: 0.0 };
        for axis in 0..3 {
            if away[axis].abs() <= self.half[axis] {
                continue;
            }
            let (next, last) = ((axis + 1) % 3, (axis + 2) % 3);
            let frame = Frame { x: axes[next], y: axes[last], z: axes[axis] };
            let centre = self.centre + self.half[axis] * away[axis].signum() * axes[axis];
            let half = DVec2::new(self.half[next], self.half[last]);
            let Some(face) = Rectangle::seen(&frame, centre - point, half) else { continue };
            let share = face.solid_angle();
            view.whole += share;
            view.faces.push((face, share));
        }
        (view.whole > 0.0).then_some(view)
    }
}

impl View {
    /// A unit direction through the target.
    pub fn draw(&self, rng: &mut Rng) -> DVec3 {
        let mut rest = if self.faces.len() == 1 { 0.0 } else { rng.uniform() * self.whole };
        let chosen = self.faces.iter().position(|(_, share)| {
            rest -= share;
            rest < 0.0
        });
        self.faces[chosen.unwrap_or(self.faces.len() - 1)].0.draw(rng.pair())
    }

    /// Density of `draw` at a unit direction, 1/sr.
    pub fn density(&self, direction: DVec3) -> f64 {
        self.faces.iter().map(|(face, share)| share / self.whole * face.density(direction)).sum()
    }

    /// Solid angle, sr; estimated where small.
    pub fn solid_angle(&self) -> f64 {
        self.whole
    }
}

#[cfg(test)]
mod tests;

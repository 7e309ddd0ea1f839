//! Which way light starts, about the local z axis.

use crate::geometry::Frame;
use crate::math::sampling;
use glam::DVec3;
use std::f64::consts::{FRAC_2_PI, PI, TAU};

/// The shape of a beam. `Some(frame)`: its axis is fixed in space; `None`: the normal of the place it starts from.
#[derive(Clone, Copy, Debug)]
pub struct Angular {
    pub axis: Option<Frame>,
    pub pattern: Pattern,
}

/// Patterns; flux per solid angle about z.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Pattern {
    /// All along z.
    Collimated,
    /// Uniform in solid angle within `half_angle` (rad, <= pi): constant intensity.
    Cone { half_angle: f64 },
    /// Uniform radiance within `half_angle` (rad, <= pi/2) of z on a surface perpendicular to z: flux ~ cos theta dw.
    /// pi/2 is a Lambertian source; half of 0.533 deg is the Sun.
    Radiance { half_angle: f64 },
    /// Uniform radiance between two half-angles (rad, <= pi/2), nothing within the inner: a field around a black patch.
    Ring { inner: f64, outer: f64 },
    /// Intensity ~ exp(-2 tan^2 theta / tan^2 half_angle): Gaussian in the direction tangents.
    Gaussian { half_angle: f64 },
}

impl Angular {
    /// The fixed frame, if any.
    pub fn frame(&self) -> Option<Frame> {
        self.axis
    }

    /// Local unit direction at two coordinates in [0, 1).
    pub fn direction(&self, [u, v]: [f64; 2]) -> DVec3 {
        let about = |sine: f64, cosine: f64| DVec3::new(sine * (TAU * v).cos(), sine * (TAU * v).sin(), cosine);
        match self.pattern {
            Pattern::Collimated => DVec3::Z,
            Pattern::Cone { half_angle } => {
                // 1 - cos theta = 2 sin^2(theta / 2), free of cancellation for narrow cones.
                let versine = 2.0 * (0.5 * half_angle).sin().powi(2) * u;
                about((versine * (2.0 - versine)).max(0.0).sqrt(), 1.0 - versine)
            }
            Pattern::Radiance { half_angle } => {
                let place = half_angle.sin() * sampling::disc([u, v]);
                DVec3::new(place.x, place.y, (1.0 - place.length_squared()).max(0.0).sqrt())
            }
            Pattern::Ring { inner, outer } => {
                let squared = inner.sin().powi(2) + u * ring(inner, outer);
                about(squared.sqrt(), (1.0 - squared).max(0.0).sqrt())
            }
            Pattern::Gaussian { half_angle } => {
                let tangent = half_angle.tan() * (-0.5 * (1.0 - u).ln()).sqrt();
                let cosine = 1.0 / (1.0 + tangent * tangent).sqrt();
                about(tangent * cosine, cosine)
            }
        }
    }

    /// Share of the flux per solid angle along a local unit direction, 1/sr; 0 for a collimated beam, which has none.
    pub fn density(&self, direction: DVec3) -> f64 {
        let inside = |half_angle: f64| direction.z >= half_angle.cos();
        match self.pattern {
            Pattern::Collimated => 0.0,
            Pattern::Cone { half_angle } if inside(half_angle) => 0.25 / PI / (0.5 * half_angle).sin().powi(2),
            Pattern::Radiance { half_angle } if inside(half_angle) => direction.z / PI / half_angle.sin().powi(2),
            Pattern::Ring { inner, outer } if inside(outer) && !inside(inner) => direction.z / PI / ring(inner, outer),
            Pattern::Gaussian { half_angle } if direction.z > 0.0 => {
                let (cosine2, wide) = (direction.z * direction.z, half_angle.tan().powi(2));
                let tangent2 = direction.truncate().length_squared() / cosine2;
                FRAC_2_PI / wide * (-2.0 * tangent2 / wide).exp() / (cosine2 * direction.z)
            }
            _ => 0.0,
        }
    }
}

/// sin^2 outer - sin^2 inner, free of cancellation for narrow rings: the projected solid angle of a ring over pi.
pub fn ring(inner: f64, outer: f64) -> f64 {
    (outer - inner).sin() * (outer + inner).sin()
}

//! Spheres.
//!
//! Start: |p|^2 = 2 C.p + (R^2 - C^2) is linear in the centre C and in the bracket.
//! Source: Coope, "Circle fitting by linear and nonlinear least squares", J. Optim. Theory Appl. 76 (1993).

use super::cloud::{Cloud, Pose};
use super::plane::principal;
use super::revolution::{Axis, Revolution};
use super::{Fit, Kind, Line};
use crate::geometry::Frame;
use crate::geometry::exact::Conic;
use crate::math::least_squares::minimise;
use glam::DVec3;

/// With its centre on a given axis, or anywhere; then the axis goes through the centroid of the corners.
pub(super) fn fit(cloud: &Cloud, line: Option<&Line>) -> Option<Fit> {
    let ball = Ball::around(&cloud.points)?;
    match line {
        Some(line) => ball.about(&cloud.pose(line), Axis::Known, Kind::Sphere).fit(cloud),
        None => {
            // From the centre to the centroid; of a whole sphere any direction.
            let axis = super::line::oriented((-ball.centre).try_normalize().unwrap_or(DVec3::Z));
            let fit = ball.about(&Pose::new(ball.centre, axis), Axis::Turning, Kind::Sphere).fit(cloud)?;
            Some(Fit { has_axis: false, ..fit })
        }
    }
}

/// A sphere in the units of a cloud.
pub(super) struct Ball {
    pub centre: DVec3,
    pub radius: f64,
}

impl Ball {
    /// About points that are centred on the origin.
    pub fn around(points: &[DVec3]) -> Option<Ball> {
        // Along the normal of a shallow cap there is least to see: kept apart from the other directions.
        let [(_, z), (_, x), _] = principal(points);
        let frame = Frame { x, y: z.cross(x), z };
        let local: Vec<DVec3> = points.iter().map(|p| frame.to_local(*p)).collect();
        let off = |v: &[f64]| {
            local.iter().map(|p| p.length_squared() - 2.0 * p.dot(DVec3::new(v[0], v[1], v[2])) - v[3]).collect()
        };
        let found = minimise(vec![0.0; 4], &off)?.values;
        let centre = DVec3::new(found[0], found[1], found[2]);
        let radius = (found[3] + centre.length_squared()).sqrt();
        radius.is_finite().then_some(Ball { centre: frame.to_world(centre), radius })
    }

    /// As a surface about the axis of a pose, its vertex on the side of the origin.
    pub fn about(&self, pose: &Pose, axis: Axis, kind: Kind) -> Revolution<'static> {
        let height = pose.local(self.centre).z;
        let origin = pose.local(DVec3::ZERO).z;
        let side = 1f64.copysign(height - origin);
        let pose = pose.shifted(DVec3::new(0.0, 0.0, height - side * self.radius));
        Revolution { pose, base: Conic { curvature: side / self.radius, conic: 0.0 }, axis, kind, powers: &[] }
    }
}

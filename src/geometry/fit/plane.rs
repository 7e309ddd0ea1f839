//! Planes: the normal is the direction in which the corners vary least.

use super::cloud::{Cloud, Pose};
use super::{Fit, Kind, Line};
use crate::geometry::exact::Shape;
use crate::math::eigen;
use glam::{DMat3, DVec3};

/// Across a given axis, or the nearest of all.
pub(super) fn fit(cloud: &Cloud, line: Option<&Line>) -> Option<Fit> {
    let pose = match line {
        Some(line) => {
            let pose = cloud.pose(line);
            let heights: f64 = cloud.points.iter().map(|p| pose.local(*p).z).sum();
            pose.shifted(DVec3::new(0.0, 0.0, heights / cloud.len() as f64))
        }
        None => Pose::new(DVec3::ZERO, super::line::oriented(principal(&cloud.points)[0].1)),
    };
    Some(cloud.found(Kind::Plane, &pose, &Shape::plane(), [0.0; 2]))
}

/// Variances of points about the origin and their directions, the least first.
pub(super) fn principal(points: &[DVec3]) -> [(f64, DVec3); 3] {
    let outer = |p: &DVec3| DMat3::from_cols(p.x * *p, p.y * *p, p.z * *p);
    eigen::symmetric(points.iter().fold(DMat3::ZERO, |sum, p| sum + outer(p)))
}

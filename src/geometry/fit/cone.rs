//! Cylinders and cones.
//!
//!     distance = (rho - (R + t z)) / sqrt(1 + t^2)      rho: from the axis; t = 0: cylinder
//!
//! Start: normals of a cylinder are perpendicular to its axis, those of a cone make one angle with it, so that they vary least along
//! it. The planes of all facets of a cone go through its apex, which is a linear problem.

use super::cloud::{Cloud, Pose};
use super::line::oriented;
use super::plane::principal;
use super::{Fit, Kind, Line};
use crate::geometry::exact::Shape;
use crate::math::least_squares::minimise;
use glam::DVec3;

/// About a given axis, or about its own.
pub(super) fn cylinder(cloud: &Cloud, line: Option<&Line>) -> Option<Fit> {
    let sought = Sought { kind: Kind::Cylinder, free: line.is_none() };
    let pose = match line {
        Some(line) => cloud.pose(line),
        None => {
            let normals: Vec<DVec3> = cloud.facets.iter().map(|[_, normal]| weighted(*normal)).collect();
            let pose = Pose::new(DVec3::ZERO, oriented(principal(&normals)[0].1));
            pose.shifted(circle(cloud, &pose)?)
        }
    };
    let radius = cloud.points.iter().map(|p| rho(pose.local(*p))).sum::<f64>() / cloud.len() as f64;
    sought.fit(cloud, pose, radius, 0.0)
}

/// About a given axis, or about its own.
pub(super) fn cone(cloud: &Cloud, line: Option<&Line>) -> Option<Fit> {
    let sought = Sought { kind: Kind::Cone, free: line.is_none() };
    let pose = match line {
        Some(line) => cloud.pose(line),
        None => {
            let area: f64 = cloud.facets.iter().map(|[_, normal]| normal.length()).sum();
            let mean = cloud.facets.iter().map(|[_, normal]| *normal).sum::<DVec3>() / area;
            let apart = |[_, normal]: &[DVec3; 2]| (normal.normalize_or_zero() - mean) * normal.length().sqrt();
            let axis = principal(&cloud.facets.iter().map(apart).collect::<Vec<_>>())[0].1;
            let apex = apex(cloud)?;
            // The point of the axis beside the centroid.
            Pose::new(apex - apex.dot(axis) * axis, oriented(axis))
        }
    };
    let local: Vec<DVec3> = cloud.points.iter().map(|p| pose.local(*p)).collect();
    let line = |v: &[f64]| local.iter().map(|p| rho(*p) - v[0] - v[1] * p.z).collect();
    let start = minimise(vec![0.0; 2], &line)?.values;
    sought.fit(cloud, pose, start[0], start[1])
}

/// A normal that counts in the covariance by the area of its facet.
fn weighted(normal: DVec3) -> DVec3 {
    normal.normalize_or_zero() * normal.length().sqrt()
}

fn rho(p: DVec3) -> f64 {
    p.x.hypot(p.y)
}

/// Centre, in the coordinates of a pose, of the circle that the corners make seen along its axis: x^2 + y^2 = 2 a x + 2 b y + g.
fn circle(cloud: &Cloud, pose: &Pose) -> Option<DVec3> {
    let local: Vec<DVec3> = cloud.points.iter().map(|p| pose.local(*p)).collect();
    let off = |v: &[f64]| local.iter().map(|p| p.x * (p.x - 2.0 * v[0]) + p.y * (p.y - 2.0 * v[1]) - v[2]).collect();
    let found = minimise(vec![0.0; 3], &off)?.values;
    Some(DVec3::new(found[0], found[1], 0.0))
}

/// The point nearest to the planes of all facets.
fn apex(cloud: &Cloud) -> Option<DVec3> {
    let off = |v: &[f64]| {
        let apex = DVec3::new(v[0], v[1], v[2]);
        cloud.facets.iter().map(|[point, normal]| weighted(*normal).dot(apex - *point)).collect()
    };
    let found = minimise(vec![0.0; 3], &off)?.values;
    Some(DVec3::new(found[0], found[1], found[2]))
}

struct Sought {
    kind: Kind,
    /// The axis, too.
    free: bool,
}

impl Sought {
    fn fit(&self, cloud: &Cloud, pose: Pose, radius: f64, taper: f64) -> Option<Fit> {
        let mut start = vec![radius];
        start.extend((self.kind == Kind::Cone).then_some(taper));
        start.resize(start.len() + if self.free { 4 } else { 0 }, 0.0);
        let residuals = |values: &[f64]| {
            let (pose, radius, taper) = self.unpack(&pose, values);
            let off = |p: DVec3| (rho(p) - radius - taper * p.z) / taper.hypot(1.0);
            cloud.points.iter().map(|p| off(pose.local(*p))).collect()
        };
        let minimum = minimise(start, &residuals)?;
        let (pose, radius, taper) = self.unpack(&pose, &minimum.values);
        let error = if self.kind == Kind::Cone { minimum.errors[1] } else { 0.0 };
        let fit = cloud.found(self.kind, &pose, &Shape::Cone { radius, taper }, [minimum.errors[0], error]);
        // On the far side of its apex a cone is another one.
        let real = radius > 0.0 && cloud.points.iter().all(|p| radius + taper * pose.local(*p).z > -1e-9);
        (real && fit.rms.is_finite()).then_some(fit)
    }

    fn unpack(&self, pose: &Pose, values: &[f64]) -> (Pose, f64, f64) {
        let mut rest = values.iter().copied();
        let mut next = |sought: bool| if sought { rest.next().unwrap_or(0.0) } else { 0.0 };
        let (radius, taper) = (next(true), next(self.kind == Kind::Cone));
        let [x, y, u, v] = [(); 4].map(|()| next(self.free));
        (pose.shifted(DVec3::new(u, v, 0.0)).tilted(x, y), radius, taper)
    }
}

//! The corners of a face, about their centroid and in units of their reach.

use super::line::Line;
use super::{Fit, Kind, line};
use crate::geometry::Frame;
use crate::geometry::exact::{Conic, Sag, Shape};
use crate::geometry::mesh::Mesh;
use glam::DVec3;

/// Each distinct corner of some triangles once, and the facets.
#[derive(Clone, Debug)]
pub struct Cloud {
    /// Centroid of the corners, m.
    centre: DVec3,
    /// Largest distance of a corner from it, m.
    reach: f64,
    /// In units of `reach` about `centre`.
    pub(super) points: Vec<DVec3>,
    /// A point and the normal, as long as twice the area, of every facet, in these units.
    pub(super) facets: Vec<[DVec3; 2]>,
}

/// A place in the units of a cloud.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pose {
    pub at: DVec3,
    /// z: the axis.
    pub frame: Frame,
}

impl Pose {
    pub fn new(at: DVec3, axis: DVec3) -> Pose {
        Pose { at, frame: Frame::from_z(axis) }
    }

    pub fn local(&self, p: DVec3) -> DVec3 {
        self.frame.to_local(p - self.at)
    }

    /// Shifted in its own coordinates.
    pub fn shifted(&self, by: DVec3) -> Pose {
        Pose { at: self.at + self.frame.to_world(by), ..*self }
    }

    /// Leaning by tangents towards its x and y.
    pub fn tilted(&self, x: f64, y: f64) -> Pose {
        Pose::new(self.at, self.frame.to_world(DVec3::new(x, y, 1.0)).normalize())
    }
}

impl Cloud {
    /// The corners of some triangles of a mesh.
    pub fn new(mesh: &Mesh, triangles: &[u32]) -> Cloud {
        let mut corners: Vec<u32> = triangles.iter().flat_map(|&t| mesh.triangles[t as usize]).collect();
        corners.sort_unstable();
        corners.dedup();
        let all = || corners.iter().map(|&v| mesh.vertices[v as usize]);
        // About the first corner: a sum of large numbers would be rounded.
        let first = all().next().unwrap_or_default();
        let centre = first + all().map(|v| v - first).sum::<DVec3>() / corners.len().max(1) as f64;
        let reach = all().map(|v| v.distance(centre)).fold(f64::MIN_POSITIVE, f64::max);
        let facet = |&t: &u32| {
            let [a, b, c] = mesh.corners(t as usize).map(|v| (v - centre) / reach);
            [a, (b - a).cross(c - a)]
        };
        let points = all().map(|v| (v - centre) / reach).collect();
        Cloud { centre, reach, points, facets: triangles.iter().map(facet).collect() }
    }

    /// Number of corners.
    pub fn len(&self) -> usize {
        self.points.len()
    }

    /// True if there is none.
    pub fn is_empty(&self) -> bool {
        self.points.is_empty()
    }

    /// Centroid of the corners, m.
    pub fn centre(&self) -> DVec3 {
        self.centre
    }

    /// Largest distance of a corner from the centroid, m.
    pub fn reach(&self) -> f64 {
        self.reach
    }

    /// True if all corners but one are on its rims: a strip or a fan of triangles, by Euler's formula.
    pub(super) fn is_strip(&self) -> bool {
        self.facets.len() <= self.points.len()
    }

    /// A pose on a line (world, m) beside the centroid.
    pub(super) fn pose(&self, line: &Line) -> Pose {
        Pose::new((line.foot(self.centre) - self.centre) / self.reach, line.direction)
    }

    /// How many rings about a line (world, m) the corners are on, told apart by 1e-4 of the reach.
    pub(super) fn levels(&self, line: &Line) -> usize {
        let pose = self.pose(line);
        let count = |of: fn(DVec3) -> f64| {
            let mut values: Vec<f64> = self.points.iter().map(|p| of(pose.local(*p))).collect();
            values.sort_by(f64::total_cmp);
            1 + values.windows(2).filter(|pair| pair[1] - pair[0] > 1e-4).count()
        };
        // Rings of one radius are told apart by their height.
        count(|p| p.x.hypot(p.y)).max(count(|p| p.z))
    }

    /// A shape in these units as one in the world; the errors are those of independent corners.
    pub(super) fn found(&self, kind: Kind, pose: &Pose, shape: &Shape, errors: [f64; 2]) -> Fit {
        let distances = self.points.iter().map(|p| shape.distance(pose.local(*p)));
        let [squares, most] = distances.fold([0.0, 0.0], |[squares, most], d| {
            let d = if d.is_nan() { f64::INFINITY } else { d };
            [squares + d * d, d.max(most)]
        });
        let at = self.centre + self.reach * pose.at;
        // The corners of a ring are rounded together: there are no more independent ones than rings.
        let rings = self.levels(&Line { through: at, direction: pose.frame.z });
        let alike = (self.points.len() as f64 / rings as f64).sqrt();
        Fit {
            kind,
            shape: enlarged(shape, self.reach),
            at,
            axis: line::oriented(pose.frame.z),
            has_axis: true,
            rms: self.reach * (squares / self.points.len() as f64).sqrt(),
            max: self.reach * most,
            errors: [self.reach * alike * errors[0], alike * errors[1]],
        }
    }
}

/// A shape `by` times as large.
fn enlarged(shape: &Shape, by: f64) -> Shape {
    let conic = |conic: &Conic| Conic { curvature: conic.curvature / by, conic: conic.conic };
    match shape {
        Shape::Conic(base) => Shape::Conic(conic(base)),
        Shape::Cone { radius, taper } => Shape::Cone { radius: by * radius, taper: *taper },
        Shape::Sag { sag: Sag::Asphere { base, terms }, bend } => {
            let terms = terms.iter().map(|&(p, a)| (p, a * by.powi(1 - p as i32))).collect();
            Shape::Sag { sag: Sag::Asphere { base: conic(base), terms }, bend: bend / by }
        }
        Shape::Sag { .. } => shape.clone(),
    }
}

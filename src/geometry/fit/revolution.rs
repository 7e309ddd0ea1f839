//! Heights of revolution - sphere, conic, asphere - fitted to corners, with an axis that is given or sought.
//!
//!     F = c (x^2 + y^2 + (1 + k) z^2) - 2 z      distance = F / |grad F|, to first order
//!     distance = (z - s(r)) / sqrt(1 + s'^2)     with terms
//!
//! Curvature, not radius: it passes smoothly through the plane.

use super::cloud::{Cloud, Pose};
use super::{Fit, Kind};
use crate::geometry::exact::{Conic, Sag, Shape};
use crate::math::least_squares::minimise;
use glam::DVec3;

/// What of the axis is sought.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Axis {
    Known,
    /// Its direction: all that a sphere has.
    Turning,
    Free,
}

/// Largest curvature at a vertex, in 1 / the reach of the face.
const STEEPEST: f64 = 100.0;

/// A start, and what is sought.
pub(super) struct Revolution<'a> {
    pub pose: Pose,
    pub base: Conic,
    pub axis: Axis,
    pub kind: Kind,
    /// Powers of the terms.
    pub powers: &'a [u32],
}

impl Revolution<'_> {
    /// The best of its kind from here on.
    pub fn fit(&self, cloud: &Cloud) -> Option<Fit> {
        let minimum = minimise(self.start(), &|values| self.residuals(cloud, values))?;
        let (pose, base, terms) = self.unpack(&minimum.values);
        // Beyond, it is a cone whose tip is rounded, or two planes that cross.
        let sheet = |p: &DVec3| base.near(pose.local(*p));
        if base.curvature.abs() > STEEPEST || self.kind == Kind::Conic && !cloud.points.iter().all(sheet) {
            return None;
        }
        let shape = match self.kind {
            Kind::Asphere => Shape::Sag { sag: Sag::Asphere { base, terms }, bend: 0.0 },
            _ => Shape::Conic(base),
        };
        let conic = if self.kind == Kind::Sphere { 0.0 } else { minimum.errors[2] };
        let fit = cloud.found(self.kind, &pose, &shape, [minimum.errors[1] / base.curvature.powi(2), conic]);
        fit.rms.is_finite().then_some(fit)
    }

    /// Height and curvature, conic constant, terms, tilt, shift: what is sought of them.
    fn start(&self) -> Vec<f64> {
        let mut start = vec![0.0, self.base.curvature];
        if self.kind != Kind::Sphere {
            start.push(self.base.conic);
        }
        let others = self.powers.len()
            + if self.axis == Axis::Known { 0 } else { 2 }
            + if self.axis == Axis::Free { 2 } else { 0 };
        start.resize(start.len() + others, 0.0);
        start
    }

    fn unpack(&self, values: &[f64]) -> (Pose, Conic, Vec<(u32, f64)>) {
        let mut rest = values.iter().copied();
        let mut next = |sought: bool| if sought { rest.next().unwrap_or(0.0) } else { 0.0 };
        let (height, curvature) = (next(true), next(true));
        let conic = next(self.kind != Kind::Sphere);
        let terms = self.powers.iter().map(|&power| (power, next(true))).collect();
        let tilt = [(); 2].map(|()| next(self.axis != Axis::Known));
        let shift = [(); 2].map(|()| next(self.axis == Axis::Free));
        let pose = self.pose.shifted(DVec3::new(shift[0], shift[1], 0.0)).tilted(tilt[0], tilt[1]);
        (pose.shifted(DVec3::new(0.0, 0.0, height)), Conic { curvature, conic }, terms)
    }

    fn residuals(&self, cloud: &Cloud, values: &[f64]) -> Vec<f64> {
        let (pose, base, terms) = self.unpack(values);
        let local = cloud.points.iter().map(|p| pose.local(*p));
        if self.kind != Kind::Asphere {
            return local.map(|p| distance(&base, p)).collect();
        }
        let sag = Sag::Asphere { base, terms };
        local.map(|p| above(&sag, p)).collect()
    }
}

/// Signed, against the normal, to first order.
fn distance(conic: &Conic, p: DVec3) -> f64 {
    let (c, e) = (conic.curvature, 1.0 + conic.conic);
    let f = c * (p.x * p.x + p.y * p.y + e * p.z * p.z) - 2.0 * p.z;
    0.5 * f / DVec3::new(c * p.x, c * p.y, c * e * p.z - 1.0).length()
}

/// Signed, along the normal, to first order.
fn above(sag: &Sag, p: DVec3) -> f64 {
    let [s, x, y] = sag.at(p.x, p.y);
    (p.z - s) / DVec3::new(x, y, 1.0).length()
}

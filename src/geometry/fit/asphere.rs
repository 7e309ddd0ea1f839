//! Aspheres of given powers: the conic, then all numbers together.
//!
//! A conic constant and a term of the fourth power are nearly the same surface: their standard errors are then large and the
//! surface is well known all the same.

use super::cloud::{Cloud, Pose};
use super::conic::fit_with;
use super::revolution::{Axis, Revolution};
use super::{Fit, Kind, Line};
use crate::geometry::exact::{Conic, Shape};

/// About a given axis, or about its own.
pub(super) fn fit(cloud: &Cloud, line: Option<&Line>, powers: &[u32]) -> Option<Fit> {
    let start = fit_with(cloud, line, 3 + powers.len())?;
    let Shape::Conic(conic) = start.shape else { return None };
    let pose = Pose::new((start.at - cloud.centre()) / cloud.reach(), start.axis);
    let base = Conic { curvature: conic.curvature * cloud.reach(), conic: conic.conic };
    let axis = if line.is_some() { Axis::Known } else { Axis::Free };
    // A conic that bends back before the rim is no start; a sphere hardly ever does.
    let bases = [base, Conic { conic: 0.0, ..base }, Conic { curvature: 0.0, conic: 0.0 }];
    let fits =
        bases.into_iter().filter_map(|base| Revolution { pose, base, axis, kind: Kind::Asphere, powers }.fit(cloud));
    fits.min_by(|a, b| a.rms.total_cmp(&b.rms))
}

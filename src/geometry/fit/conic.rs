//! Conics of revolution.
//!
//! Start: the sphere through the corners, about each axis of the quadric through them. Of p.A p + b.p + d = 0 with two equal
//! eigenvalues of A the third has the axis as its vector (an off-axis paraboloid finds its axis that way).

use super::cloud::{Cloud, Pose};
use super::line::oriented;
use super::plane::principal;
use super::revolution::Axis;
use super::sphere::Ball;
use super::{Fit, Kind, Line};
use crate::geometry::Frame;
use crate::math::eigen;
use crate::math::least_squares::minimise;
use glam::{DMat3, DVec3};

/// Numbers of a meridian: height, curvature, conic constant.
const NUMBERS: usize = 3;

/// About a given axis, or about its own; `None` where the corners are at so few distances from the axis that any meridian would go
/// through them.
pub(super) fn fit(cloud: &Cloud, line: Option<&Line>) -> Option<Fit> {
    fit_with(cloud, line, NUMBERS)
}

/// As `fit`, for a meridian of more numbers.
pub(super) fn fit_with(cloud: &Cloud, line: Option<&Line>, numbers: usize) -> Option<Fit> {
    let ball = Ball::around(&cloud.points)?;
    let fit = match line {
        Some(line) => ball.about(&cloud.pose(line), Axis::Known, Kind::Conic).fit(cloud),
        None => {
            let free =
                |axis: DVec3| ball.about(&Pose::new(ball.centre, oriented(axis)), Axis::Free, Kind::Conic).fit(cloud);
            axes(cloud, &ball).into_iter().filter_map(free).min_by(|a, b| a.rms.total_cmp(&b.rms))
        }
    };
    fit.filter(|fit| cloud.levels(&fit.line()) > numbers)
}

/// Directions that the axis may have.
fn axes(cloud: &Cloud, ball: &Ball) -> Vec<DVec3> {
    let towards = (-ball.centre).try_normalize();
    let quadric = quadric(cloud).map(eigen::symmetric);
    let ends = quadric.into_iter().flat_map(|[(_, least), _, (_, most)]| [least, most]);
    towards.into_iter().chain(ends).collect()
}

/// The symmetric matrix A of the quadric through the corners, with b.n = -2 along the normal n of the plane through them.
fn quadric(cloud: &Cloud) -> Option<DMat3> {
    let [(_, z), (_, x), _] = principal(&cloud.points);
    let frame = Frame { x, y: z.cross(x), z };
    let local: Vec<DVec3> = cloud.points.iter().map(|p| frame.to_local(*p)).collect();
    let off = |v: &[f64]| {
        let f = |p: &DVec3| {
            let square = v[0] * p.x * p.x + v[1] * p.y * p.y + v[2] * p.z * p.z;
            let mixed = v[3] * p.x * p.y + v[4] * p.y * p.z + v[5] * p.z * p.x;
            square + 2.0 * mixed - 2.0 * p.z + v[6] * p.x + v[7] * p.y + v[8]
        };
        local.iter().map(f).collect()
    };
    let v = minimise(vec![0.0; 9], &off)?.values;
    let matrix =
        DMat3::from_cols(DVec3::new(v[0], v[3], v[5]), DVec3::new(v[3], v[1], v[4]), DVec3::new(v[5], v[4], v[2]));
    let turn = DMat3::from_cols(frame.x, frame.y, frame.z);
    Some(turn * matrix * turn.transpose())
}

//! Moved axes of one surface, as CODE V and ray-optics write them.
//!
//! Decentre along x, y and z, then turn by alpha and beta (left-handed) about x and y, then by gamma (right-handed) about z, each
//! about the axes the one before led to.

use crate::prescription::Motion;
use glam::DVec3;

/// What becomes of moved axes behind the surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Axes {
    /// They stay moved.
    Stay,
    /// They return.
    Return,
    /// They turn once more, along the reflected axis.
    Bend,
    /// They move backwards, and only behind the surface.
    Reverse,
}

/// Motions on the way in and out; `shift` in m, `tilt` alpha, beta and gamma in deg. `None` for a bend about several
/// axes: only a turn about one axis in the surface leads, done twice, along the reflected axis.
pub fn motions(axes: Axes, shift: [f64; 3], tilt: [f64; 3]) -> Option<(Motion, Motion)> {
    let [alpha, beta, gamma] = tilt.map(f64::to_radians);
    let turn = Motion::turn(DVec3::new(-alpha, -beta, gamma));
    let motion = Motion::shift(DVec3::from(shift)).then(turn);
    match axes {
        Axes::Stay => Some((motion, Motion::NONE)),
        Axes::Return => Some((motion, motion.inverse())),
        Axes::Bend if gamma == 0.0 && (alpha == 0.0 || beta == 0.0) => Some((motion, turn)),
        Axes::Bend => None,
        Axes::Reverse => Some((Motion::NONE, motion.inverse())),
    }
}

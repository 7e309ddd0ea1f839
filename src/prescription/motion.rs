//! Rigid motion of a surface's axes: decentre, then turn.
//!
//!     p_old = shift + turn p_new
//!
//! The columns of `turn` are the new axes as seen in the old ones.

use glam::{DMat3, DVec3};

/// How new axes lie in old ones.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Motion {
    /// New origin in the old axes, m.
    pub shift: DVec3,
    /// Rotation, orthonormal.
    pub turn: DMat3,
}

impl Motion {
    /// Axes that stay.
    pub const NONE: Motion = Motion { shift: DVec3::ZERO, turn: DMat3::IDENTITY };

    /// Axes that only move, m.
    pub fn shift(shift: DVec3) -> Motion {
        Motion { shift, turn: DMat3::IDENTITY }
    }

    /// Axes that turn about x, then about the new y, then about the newest z; angles in rad, right-handed.
    pub fn turn(angles: DVec3) -> Motion {
        let [x, y, z] = angles.to_array();
        let turn = DMat3::from_rotation_x(x) * DMat3::from_rotation_y(y) * DMat3::from_rotation_z(z);
        Motion { shift: DVec3::ZERO, turn }
    }

    /// This motion, then `next`, which is given in the axes that this one leads to.
    pub fn then(self, next: Motion) -> Motion {
        Motion { shift: self.shift + self.turn * next.shift, turn: self.turn * next.turn }
    }

    /// The motion that leads back.
    pub fn inverse(self) -> Motion {
        let turn = self.turn.transpose();
        Motion { shift: -(turn * self.shift), turn }
    }

    /// A point (m) of the old axes in the new ones.
    pub fn point(&self, old: DVec3) -> DVec3 {
        self.turn.transpose() * (old - self.shift)
    }

    /// A direction of the old axes in the new ones.
    pub fn direction(&self, old: DVec3) -> DVec3 {
        self.turn.transpose() * old
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::FRAC_PI_2;

    #[test]
    fn a_motion_and_its_inverse_lead_home() {
        let motion = Motion::shift(DVec3::new(1.0, 2.0, 3.0)).then(Motion::turn(DVec3::new(0.1, -0.2, 0.3)));
        let home = motion.then(motion.inverse());
        assert!(home.shift.length() < 1e-15 && (home.turn - DMat3::IDENTITY).determinant().abs() < 1e-15);
        let point = DVec3::new(-1.0, 0.5, 2.0);
        assert!((motion.inverse().point(motion.point(point)) - point).length() < 1e-15);
    }

    #[test]
    fn a_right_handed_turn_about_x_leads_z_towards_minus_y() {
        let turned = Motion::turn(DVec3::new(FRAC_PI_2, 0.0, 0.0)).turn * DVec3::Z;
        assert!((turned + DVec3::Y).length() < 1e-15);
    }
}

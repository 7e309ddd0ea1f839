//! An orthonormal right-handed frame: change of coordinates happens here and nowhere else.

use glam::{DMat3, DVec3};

/// The right-handed rotation by these angles (rad) about the fixed axes x, then y, then z. No angle costs no digit.
pub fn rotation(angles: DVec3) -> DMat3 {
    if angles == DVec3::ZERO {
        return DMat3::IDENTITY;
    }
    DMat3::from_rotation_z(angles.z) * DMat3::from_rotation_y(angles.y) * DMat3::from_rotation_x(angles.x)
}

/// Columns x, y, z: unit vectors, right-handed (x cross y = z).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    pub x: DVec3,
    pub y: DVec3,
    pub z: DVec3,
}

impl Frame {
    /// The frame of the world axes.
    pub const WORLD: Frame = Frame { x: DVec3::X, y: DVec3::Y, z: DVec3::Z };

    /// Some frame whose z is the unit vector `z`; x and y continuous except at z = -Z
    /// (Duff et al., "Building an orthonormal basis, revisited", JCGT 6(1), 2017).
    pub fn from_z(z: DVec3) -> Frame {
        let sign = 1f64.copysign(z.z);
        let a = -1.0 / (sign + z.z);
        let b = z.x * z.y * a;
        let x = DVec3::new(1.0 + sign * z.x * z.x * a, sign * b, -sign * z.x);
        let y = DVec3::new(b, sign + z.y * z.y * a, -z.y);
        Frame { x, y, z }
    }

    /// The frame with z along the unit vector `z` and x as near to `towards` as it can be; any x if they are parallel.
    pub fn from_z_x(z: DVec3, towards: DVec3) -> Frame {
        let x = towards - towards.dot(z) * z;
        if x.length_squared() <= 1e-24 * towards.length_squared() {
            return Frame::from_z(z);
        }
        // Where `towards` is nearly along z, x is a difference of rounded numbers: once more, or it would lean towards z.
        let x = x.normalize();
        let x = x - x.dot(z) * z;
        Frame { x, y: z.cross(x), z }
    }

    /// World vector -> coordinates in this frame.
    pub fn to_local(&self, v: DVec3) -> DVec3 {
        DVec3::new(self.x.dot(v), self.y.dot(v), self.z.dot(v))
    }

    /// Coordinates in this frame -> world vector.
    pub fn to_world(&self, v: DVec3) -> DVec3 {
        v.x * self.x + v.y * self.y + v.z * self.z
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_are_orthonormal_and_right_handed_for_every_axis() {
        for i in 0..2000 {
            let cos = -1.0 + 2.0 * (i as f64 / 1999.0);
            let phi = 2.4 * i as f64;
            let sin = (1.0 - cos * cos).max(0.0).sqrt();
            let z = DVec3::new(sin * phi.cos(), sin * phi.sin(), cos);
            for frame in [Frame::from_z(z), Frame::from_z_x(z, DVec3::X), Frame::from_z_x(z, z)] {
                assert!((frame.x.cross(frame.y) - z).length() < 1e-14);
                assert!(frame.x.dot(frame.y).abs() < 1e-14 && (frame.x.length() - 1.0).abs() < 1e-14);
                let v = DVec3::new(0.3, -0.5, 0.8);
                assert!((frame.to_world(frame.to_local(v)) - v).length() < 1e-14);
            }
        }
    }
}

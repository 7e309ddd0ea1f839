//! Directions of the specular rays: the law of reflection and Snell's law.
//!
//! Local frame, z the normal on the side of the light; `wi` points back to the source, results point onwards:
//!
//!     reflected     (-wi.x, -wi.y, wi.z)
//!     transmitted   n2 t_xy = -n1 wi_xy,   t_z = -cos2,   n2^2 cos2^2 = (n2 - n1)(n2 + n1) + n1^2 cos1^2
//!
//! The last form has no difference of near-equal numbers at grazing incidence. Equal indices leave the ray as it is, bit by bit.
//!
//! In absorbing media the direction follows the real parts of the indices; the true, inhomogeneous wave differs by
//! O(k^2 / n^2), below 1e-7 in anything light gets through.
//!
//! Source: Born & Wolf, Principles of Optics, 7th ed., sec. 1.5.1.

use glam::DVec3;
use num_complex::Complex64;

/// Specularly reflected direction: unit, away from the surface, z > 0.
pub fn reflect(wi: DVec3) -> DVec3 {
    DVec3::new(-wi.x, -wi.y, wi.z)
}

/// Refracted direction into index `n2` from `n1` (both real, > 0): unit, away from the surface, z < 0.
/// `None`: total internal reflection.
pub fn refract(wi: DVec3, n1: f64, n2: f64) -> Option<DVec3> {
    if n1 == n2 {
        return Some(-wi);
    }
    let square = normal_component_squared(wi.z, n1, n2);
    if square <= 0.0 {
        return None;
    }
    let k = n1 / n2;
    Some(DVec3::new(-k * wi.x, -k * wi.y, -square.sqrt() / n2))
}

/// (n2 cos2)^2, negative in total internal reflection; dimensionless.
pub fn normal_component_squared(cos1: f64, n1: f64, n2: f64) -> f64 {
    (n2 - n1) * (n2 + n1) + (n1 * cos1) * (n1 * cos1)
}

/// Square root of `z`, Im z >= 0, with both parts >= 0: the wave that goes on and decays. Without the angle of a polar form,
/// so that a transparent medium has a real or an imaginary root.
pub fn root(z: Complex64) -> Complex64 {
    if z.im == 0.0 {
        return if z.re >= 0.0 { Complex64::new(z.re.sqrt(), 0.0) } else { Complex64::new(0.0, (-z.re).sqrt()) };
    }
    let size = z.re.hypot(z.im);
    if z.re >= 0.0 {
        let re = (0.5 * (size + z.re)).sqrt();
        Complex64::new(re, 0.5 * z.im / re)
    } else {
        let im = (0.5 * (size - z.re)).sqrt();
        Complex64::new(0.5 * z.im / im, im)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_indices_leave_the_ray_alone() {
        let wi = DVec3::new(0.6, 0.0, 0.8);
        assert_eq!(refract(wi, 1.5, 1.5), Some(-wi));
    }

    #[test]
    fn a_refracted_ray_comes_back_the_way_it_went() {
        for theta in [0.0, 0.3, 1.2, 1.57, 1.569] {
            let wi = DVec3::new(f64::sin(theta) * 0.6, f64::sin(theta) * 0.8, f64::cos(theta));
            let t = refract(wi, 1.0, 1.5168).expect("no total reflection from the thin side");
            assert!((t.length() - 1.0).abs() < 4e-16, "{theta}: {}", t.length());
            // Seen from the other side the normal is reversed.
            let back = refract(DVec3::new(t.x, t.y, -t.z), 1.5168, 1.0);
            // Near the critical angle the cosine is the root of a small difference: 2e-16 / cos.
            let cos = back.map_or(0.0, |b| -b.z);
            assert!((cos - wi.z).abs() * wi.z < 1e-15, "{theta}: {cos} {}", wi.z);
        }
    }

    #[test]
    fn beyond_the_critical_angle_nothing_is_refracted() {
        let critical = (1.0f64 / 1.5168).asin();
        let at = |theta: f64| refract(DVec3::new(theta.sin(), 0.0, theta.cos()), 1.5168, 1.0);
        assert!(at(critical - 1e-9).is_some());
        assert!(at(critical + 1e-9).is_none());
    }
}

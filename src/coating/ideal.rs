//! A coating that is two numbers: reflectance R and transmittance T at every angle, wavelength and polarisation.
//!
//!     |a_s|^2 = |a_p|^2 = R reflected, T transmitted, 1 - R - T absorbed       R, T  dimensionless, R + T <= 1
//!
//! Where refraction has no ray (total internal reflection between the real indices), T has nowhere to go and is
//! reflected: R + T. No phase between s and p other than a mirror's.
//! Left out: the dependence on angle, by which a real antireflection coating is several times worse at 60 deg.

use super::Coating;
use crate::optics::refraction::normal_component_squared;
use crate::optics::{Amplitudes, Incidence, Split};

/// Fixed reflectance and transmittance.
#[derive(Clone, Copy, Debug)]
pub struct Ideal {
    /// Power reflectance R, 0..1.
    pub reflectance: f64,
    /// Power transmittance T, 0..1-R; 0 makes the surface opaque.
    pub transmittance: f64,
}

impl Coating for Ideal {
    fn split(&self, at: &Incidence) -> Split {
        let (r, t) = (self.reflectance, self.transmittance);
        if normal_component_squared(at.cos(), at.index[0].re, at.index[1].re) <= 0.0 {
            return Split { reflected: Amplitudes::mirror(r + t), transmitted: Amplitudes::ZERO };
        }
        Split { reflected: Amplitudes::mirror(r), transmitted: Amplitudes::ideal(t) }
    }

    fn opaque(&self) -> bool {
        self.transmittance == 0.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;
    use num_complex::Complex64;

    #[test]
    fn what_cannot_be_refracted_is_reflected() {
        let at = Incidence {
            wi: DVec3::new(0.8, 0.0, 0.6),
            index: [Complex64::new(1.5, 0.0), Complex64::new(1.0, 0.0)],
            ..Incidence::in_air(0.0, 550e-9)
        };
        let split = Ideal { reflectance: 0.005, transmittance: 0.99 }.split(&at);
        assert!((split.reflected.unpolarised() - 0.995).abs() < 1e-15);
        assert_eq!(split.transmitted, Amplitudes::ZERO);
    }
}

//! A linear polariser: light along its axis passes, light across it does not.
//!
//!     T_along = transmittance, T_across = leakage     0..1 each, at every angle and wavelength; the rest is absorbed
//!
//! The axis is a direction in space; light sees its projection across the ray. Nothing is reflected.
//! Left out: reflection, the dependence on angle and wavelength.

use super::Coating;
use crate::optics::{Amplitudes, Incidence, Split};
use glam::DVec3;
use num_complex::Complex64;

/// A sheet that passes one linear polarisation.
#[derive(Clone, Copy, Debug)]
pub struct Polarizer {
    /// Unit vector along the field that passes, in the scene.
    pub axis: DVec3,
    /// Power transmittance along the axis, 0..1.
    pub transmittance: f64,
    /// Power transmittance across the axis, 0..1.
    pub leakage: f64,
}

impl Coating for Polarizer {
    fn split(&self, _: &Incidence) -> Split {
        let real = |power: f64| Complex64::new(power.sqrt(), 0.0);
        let transmitted = Amplitudes { s: real(self.transmittance), p: real(self.leakage) };
        Split { reflected: Amplitudes::ZERO, transmitted }
    }

    fn opaque(&self) -> bool {
        false
    }

    fn axis(&self) -> Option<DVec3> {
        Some(self.axis)
    }
}

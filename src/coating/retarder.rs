//! A wave plate: light across its fast axis is delayed.
//!
//!     a_fast = 1, a_slow = exp(+i delta)      delta  retardance, rad: pi/2 is a quarter-wave plate, pi a half-wave plate
//!
//! The fast axis is a direction in space; light sees its projection across the ray. Nothing is lost.
//! Left out: the dependence of delta on angle and wavelength, reflection, the separation of the two rays.

use super::Coating;
use crate::optics::{Amplitudes, Incidence, Split};
use glam::DVec3;
use num_complex::Complex64;

/// A sheet that delays one linear polarisation.
#[derive(Clone, Copy, Debug)]
pub struct Retarder {
    /// Unit vector along the field that is not delayed, in the scene.
    pub axis: DVec3,
    /// Phase by which light across the axis comes later, rad.
    pub retardance: f64,
}

impl Coating for Retarder {
    fn split(&self, _: &Incidence) -> Split {
        // exp(-i omega t): what comes later has the larger phase.
        let transmitted = Amplitudes { s: Complex64::ONE, p: Complex64::cis(self.retardance) };
        Split { reflected: Amplitudes::ZERO, transmitted }
    }

    fn opaque(&self) -> bool {
        false
    }

    fn axis(&self) -> Option<DVec3> {
        Some(self.axis)
    }
}

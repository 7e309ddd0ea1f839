//! A mirror that is one number: reflectance R at every angle, wavelength and polarisation; the rest is absorbed.
//!
//!     a_s = -sqrt(R), a_p = +sqrt(R)       R  power reflectance, dimensionless, 0..1
//!
//! Left out: the angle dependence and phase of a metal ([`super::Metal`]).

use super::Coating;
use crate::optics::{Amplitudes, Incidence, Split};

/// An opaque reflector.
#[derive(Clone, Copy, Debug)]
pub struct Mirror {
    /// Power reflectance R, 0..1.
    pub reflectance: f64,
}

impl Coating for Mirror {
    fn split(&self, _: &Incidence) -> Split {
        Split { reflected: Amplitudes::mirror(self.reflectance), transmitted: Amplitudes::ZERO }
    }

    fn opaque(&self) -> bool {
        true
    }
}

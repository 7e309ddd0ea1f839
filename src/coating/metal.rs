//! A thick metal film: Fresnel's reflection from a complex index; what enters is absorbed.
//!
//!     r_s, r_p of [`crate::optics::fresnel`] with n2 = n + ik; 1 - R is absorbed
//!
//! Check: aluminium at 632.8 nm, 1.152794 + 6.689827i: R = 0.9066343 at normal incidence.
//! Left out: oxide, roughness, films thin against the skin depth lambda / (2 pi k); one index for all wavelengths.

use super::Coating;
use crate::optics::{Amplitudes, Incidence, Split, fresnel};
use num_complex::Complex64;

/// An opaque metal surface, whatever lies beyond it.
#[derive(Clone, Copy, Debug)]
pub struct Metal {
    /// Complex index n + ik, k >= 0, dimensionless.
    pub index: Complex64,
}

impl Coating for Metal {
    fn split(&self, at: &Incidence) -> Split {
        let reflected = fresnel::interface(at.index[0], self.index, at.cos()).reflected;
        Split { reflected, transmitted: Amplitudes::ZERO }
    }

    fn opaque(&self) -> bool {
        true
    }
}

//! A thick layer of an absorbing medium: Fresnel's reflection from its index at each wavelength; what enters is absorbed.
//!
//!     r_s, r_p of [`crate::optics::fresnel`] with n2 = n + ik of the medium; 1 - R is absorbed
//!
//! [`Metal`](super::Metal) is the same with one index for all wavelengths.
//! Left out: oxide, roughness, films thin against the skin depth lambda / (2 pi k).

use super::Coating;
use crate::medium::Medium;
use crate::optics::{Amplitudes, Incidence, Split, fresnel};
use std::sync::Arc;

/// An opaque surface of a medium, whatever lies beyond it.
#[derive(Clone, Debug)]
pub struct Opaque {
    pub medium: Arc<dyn Medium>,
}

impl Coating for Opaque {
    fn split(&self, at: &Incidence) -> Split {
        let index = self.medium.index(at.wavelength);
        let reflected = fresnel::interface(at.index[0], index, at.cos()).reflected;
        Split { reflected, transmitted: Amplitudes::ZERO }
    }

    fn opaque(&self) -> bool {
        true
    }
}

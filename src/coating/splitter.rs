//! A beam splitter that is four numbers: reflectance and transmittance of s and of p at every angle and wavelength.
//!
//!     a_s = -sqrt(R_s), a_p = +sqrt(R_p) reflected;  sqrt(T_s), sqrt(T_p) transmitted;  1 - R - T absorbed, 0..1 each
//!
//! Where refraction has no ray, T is reflected: R + T. Phases are those of a mirror.
//! Left out: the dependence on angle and wavelength ([`super::Stack`], [`super::Tabulated`]).

use super::Coating;
use crate::optics::refraction::normal_component_squared;
use crate::optics::{Amplitudes, Incidence, Split};
use num_complex::Complex64;

/// Fixed reflectances and transmittances of s and p.
#[derive(Clone, Copy, Debug)]
pub struct Splitter {
    /// Power reflectances, 0..1.
    pub reflectance: [f64; 2],
    /// Power transmittances, 0..1-R.
    pub transmittance: [f64; 2],
}

impl Splitter {
    /// The amplitudes of these powers, or of R + T where no ray is refracted.
    pub(super) fn at(&self, at: &Incidence) -> Split {
        let ([rs, rp], [ts, tp]) = (self.reflectance, self.transmittance);
        let real = |power: f64| Complex64::new(power.sqrt(), 0.0);
        if normal_component_squared(at.cos(), at.index[0].re, at.index[1].re) <= 0.0 {
            let reflected = Amplitudes { s: -real(rs + ts), p: real(rp + tp) };
            return Split { reflected, transmitted: Amplitudes::ZERO };
        }
        let reflected = Amplitudes { s: -real(rs), p: real(rp) };
        Split { reflected, transmitted: Amplitudes { s: real(ts), p: real(tp) } }
    }
}

impl Coating for Splitter {
    fn split(&self, at: &Incidence) -> Split {
        self.at(at)
    }

    fn opaque(&self) -> bool {
        self.transmittance == [0.0; 2]
    }
}

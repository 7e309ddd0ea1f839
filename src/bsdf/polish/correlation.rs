//! The K-correlation (ABC) power spectral density of polished surfaces.
//!
//!     PSD(f) = A / (1 + (B f)^2)^(s/2)        two-dimensional, m^4; f spatial frequency, 1/m; B in m; s > 0
//!     sigma^2(f1..f2) = 2 pi integral_f1^f2 PSD f df
//!                     = pi A / B^2 ((1 + (B f)^2)^(1 - s/2) / (1 - s/2)) from f1 to f2       (s = 2: pi A / B^2 ln(1 + (B f)^2))
//!
//! A follows from the rms height sigma over a stated band; over all frequencies it is finite for s > 2 only. B is the inverse of the
//! shoulder's frequency, without a 2 pi. The one-dimensional spectrum of a profilometer falls with the exponent C = s - 1.
//!
//! Source: Dittman, Proc. SPIE 6291, 62910R (2006); Stover, Optical Scattering, 3rd ed. (2012), sec. 2.2.

use crate::bsdf::harvey::Law;
use crate::bsdf::radial::Profile;
use crate::math::Rng;
use std::f64::consts::TAU;

/// PSD over spatial frequency.
#[derive(Clone, Copy, Debug)]
pub struct KCorrelation {
    /// PSD at low frequency, m^4.
    a: f64,
    law: Law,
}

impl KCorrelation {
    /// The spectrum with rms height `rms` (m) over the `band` of spatial frequencies (1/m; the upper end may be infinite if s > 2),
    /// B = `b` (m, > 0) and slope `s` (> 0).
    pub fn new(rms: f64, band: [f64; 2], b: f64, s: f64) -> KCorrelation {
        let law = Law { l: 1.0 / b, s: -s };
        let up_to = |f: f64| match f.is_finite() {
            true => law.integral(f),
            false => law.l * law.l / (s - 2.0),
        };
        KCorrelation { a: rms * rms / (TAU * (up_to(band[1]) - up_to(band[0]))), law }
    }
}

impl Profile for KCorrelation {
    fn value(&self, f: f64) -> f64 {
        self.a * self.law.value(f)
    }

    fn integral(&self, f: f64) -> f64 {
        self.a * self.law.integral(f)
    }

    fn draw(&self, reach: f64, rng: &mut Rng) -> f64 {
        self.law.draw(reach, rng)
    }

    fn width(&self) -> f64 {
        self.law.width()
    }

    fn steepness(&self) -> f64 {
        self.law.steepness()
    }
}

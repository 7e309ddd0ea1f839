//! The laws that are fitted, each with a Lambertian floor.
//!
//!     ABg           f = a / (b + x^g) + R / pi                                     [1/sr]      x = |beta - beta0|
//!     Harvey-Shack  f = b0 (1 + (x / l)^2)^(s/2) + R / pi
//!     K-correlation f = 16 pi^2 cos_i cos_s PSD(x / lambda) / lambda^4 + R / pi
//!
//! The PSD is that of [`KCorrelation`] for light that all is reflected: behind a coating of reflectance Rc its rms height is that of the fit
//! divided by sqrt(Rc).

use super::Point;
use crate::bsdf::harvey::Law as Shape;
use crate::bsdf::radial::Profile;
use crate::bsdf::{Abg, Bsdf, Harvey, KCorrelation, Lambertian, Polish, Side};
use std::f64::consts::{FRAC_1_PI, PI};

/// A law.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Law {
    Abg,
    Harvey,
    /// Of light of this vacuum wavelength (m); the rms height counts over this band of spatial frequencies (1/m).
    KCorrelation {
        wavelength: f64,
        band: [f64; 2],
    },
}

impl Law {
    /// What people call it.
    pub fn name(self) -> &'static str {
        match self {
            Law::Abg => "ABg + Lambertian",
            Law::Harvey => "Harvey-Shack + Lambertian",
            Law::KCorrelation { .. } => "K-correlation + Lambertian",
        }
    }

    /// Names and units of the four coefficients; all are positive, and `-s` is the negative slope.
    pub fn coefficients(self) -> [(&'static str, &'static str); 4] {
        match self {
            Law::Abg => [("a", "1/sr"), ("b", ""), ("g", ""), ("reflectance", "")],
            Law::Harvey => [("b0", "1/sr"), ("l", ""), ("-s", ""), ("reflectance", "")],
            Law::KCorrelation { .. } => [("rms", "m"), ("b", "m"), ("s", ""), ("reflectance", "")],
        }
    }

    /// BSDF with these coefficients as a function of the point, 1/sr.
    pub(super) fn at(self, [p, q, r, reflectance]: [f64; 4]) -> impl Fn(&Point) -> f64 {
        let (height, shape) = match self {
            Law::Abg => (p, Shape { l: q, s: -r }),
            Law::Harvey => (p, Shape { l: q, s: -r }),
            Law::KCorrelation { wavelength, band } => {
                let psd = KCorrelation::new(p, band, q, r);
                let height = 16.0 * PI * PI * psd.value(0.0) / wavelength.powi(4);
                (height, Shape { l: wavelength / q, s: -r })
            }
        };
        move |point| {
            let lobe = match self {
                Law::Abg => height / (q + point.x.powf(r)),
                Law::Harvey => height * shape.value(point.x),
                Law::KCorrelation { .. } => height * shape.value(point.x) * point.cosines[0] * point.cosines[1],
            };
            lobe + reflectance * FRAC_1_PI
        }
    }

    /// Coefficients of a lobe of this `height` (1/sr), `width` (of x) and slope over a floor (1/sr).
    pub(super) fn guess(self, height: f64, width: f64, slope: f64, floor: f64) -> [f64; 4] {
        match self {
            Law::Abg => [height * width.powf(slope), width.powf(slope), slope, PI * floor],
            Law::Harvey => [height, width, slope, PI * floor],
            Law::KCorrelation { wavelength, band } => {
                let b = wavelength / width;
                let unit = KCorrelation::new(1.0, band, b, slope).value(0.0);
                let rms = (height * wavelength.powi(4) / (16.0 * PI * PI * unit)).sqrt();
                [rms, b, slope, PI * floor]
            }
        }
    }

    /// What scatters by this law with these coefficients. Cost: up to 0.1 s.
    pub fn lobes(self, [p, q, r, reflectance]: [f64; 4], side: Side) -> Vec<Box<dyn Bsdf>> {
        let lobe: Box<dyn Bsdf> = match self {
            Law::Abg => Box::new(Abg::new(p, q, r, side)),
            Law::Harvey => Box::new(Harvey::new(p, q, -r, side)),
            Law::KCorrelation { band, .. } => Box::new(Polish::new(KCorrelation::new(p, band, q, r), side)),
        };
        let shares = if side == Side::Reflect { [reflectance, 0.0] } else { [0.0, reflectance] };
        vec![lobe, Box::new(Lambertian { reflectance: shares[0], transmittance: shares[1] })]
    }
}

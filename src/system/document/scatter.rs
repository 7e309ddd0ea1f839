//! How a surface scatters.

use serde::Deserialize;
use std::path::PathBuf;

/// A named scatter model, used by `scatter:` of a surface.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum Scatter {
    /// The same radiance in every direction.
    Lambertian {
        /// Hemispherical reflectance, 0..1.
        reflectance: f64,
        /// Hemispherical transmittance, 0..1.
        #[serde(default)]
        transmittance: f64,
    },
    /// BSDF = a / (b + |beta - beta0|^g), 1/sr.
    ABg {
        /// Numerator, 1/sr, >= 0.
        a: f64,
        /// Roll-off, dimensionless, > 0.
        b: f64,
        /// Slope, dimensionless, >= 0.
        g: f64,
        /// About which specular direction.
        #[serde(default)]
        side: ScatterSide,
    },
    /// A measured table.
    Table {
        /// A Speos `.anisotropicbsdf`, a Zemax `.bsdf`, a FRED table or a CSV, as text, relative to the system file.
        file: PathBuf,
        /// Factor on the scattered flux, dimensionless, >= 0.
        #[serde(default = "one")]
        scale: f64,
        /// What lies where nothing was measured.
        #[serde(default)]
        unmeasured: Unmeasured,
    },
    /// Several models at once: their BSDFs add.
    Sum(Vec<Scatter>),
}

/// What lies where a table says zero, or nothing, because nothing was measured.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum Unmeasured {
    /// No light.
    #[default]
    Zero,
    /// What was measured last on the way there.
    Hold,
}

/// The specular direction that a lobe surrounds.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum ScatterSide {
    /// The reflected ray.
    #[default]
    Reflect,
    /// The refracted ray.
    Transmit,
}

fn one() -> f64 {
    1.0
}

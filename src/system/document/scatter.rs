//! How a surface scatters.

use crate::bsdf::finish;
use crate::system::units::{Angle, Frequency, Length, PowerDensity};
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
    /// BSDF = b0 (1 + (|beta - beta0| / l)^2)^(s/2), 1/sr.
    HarveyShack {
        /// BSDF at the specular ray, 1/sr, >= 0.
        b0: f64,
        /// Shoulder, dimensionless, > 0.
        l: f64,
        /// Slope, dimensionless, <= 0.
        s: f64,
        /// About which specular direction.
        #[serde(default)]
        side: ScatterSide,
    },
    /// BSDF = a exp(-|beta - beta0|^2 / sigma^2), 1/sr.
    Gaussian {
        /// BSDF at the specular ray, 1/sr, >= 0.
        a: f64,
        /// Distance where it falls to 1/e, dimensionless, > 0.
        sigma: f64,
        /// About which specular direction.
        #[serde(default)]
        side: ScatterSide,
    },
    /// BRDF = a cos^n of the angle to an axis, 1/sr.
    CosinePower {
        /// BRDF on the axis, 1/sr, >= 0.
        a: f64,
        /// Power, dimensionless, >= 0.
        n: f64,
        /// The axis.
        #[serde(default)]
        about: ScatterAxis,
    },
    /// A rough matt surface, made of Lambertian facets.
    OrenNayar {
        /// Reflectance of the facets, 0..1.
        reflectance: f64,
        /// Rms slope angle of the facets.
        sigma: Angle,
    },
    /// A polished surface with PSD(f) = A / (1 + (b f)^2)^(s/2), two-dimensional; needs `order: Scaled`.
    KCorrelation {
        /// Which fixes A.
        rms: Roughness,
        /// Inverse of the shoulder's spatial frequency.
        b: Length,
        /// Slope of the two-dimensional spectrum, dimensionless, > 0.
        s: f64,
        /// About which specular direction.
        #[serde(default)]
        side: ScatterSide,
    },
    /// A polished surface with a measured two-dimensional power spectral density; needs `order: Scaled`.
    Psd {
        /// Spatial frequencies, increasing.
        frequency: Vec<Frequency>,
        /// Density at each of them, > 0.
        density: Vec<PowerDensity>,
        /// About which specular direction.
        #[serde(default)]
        side: ScatterSide,
    },
    /// A rough surface of facets that mirror and refract.
    Microfacet {
        /// The law of their normals.
        distribution: FacetLaw,
        /// Roughness, 0.001..1.
        alpha: f64,
        /// What a facet does to light.
        #[serde(default)]
        facets: Facets,
        /// Reflected or refracted.
        #[serde(default)]
        side: ScatterSide,
        /// What becomes of light that meets a second facet.
        #[serde(default)]
        energy: FacetEnergy,
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
    /// A sheet known patch by patch: a Klems matrix, for light on either face.
    Klems {
        /// An XML file of LBNL WINDOW or Radiance, relative to the system file.
        file: PathBuf,
        /// Factor on the scattered flux, dimensionless, >= 0.
        #[serde(default = "one")]
        scale: f64,
        /// Which of the file's bands of wavelengths.
        #[serde(default = "visible")]
        band: String,
    },
    /// Particles on the surface: a dilute layer of spheres (Mie), on the front of a transparent body.
    Contamination {
        /// Cleanliness level of IEST-STD-CC1246, >= 1.
        level: f64,
        /// Slope of the distribution, dimensionless, > 0.
        #[serde(default = "slope")]
        slope: f64,
        /// Least diameter, m.
        #[serde(default = "smallest")]
        smallest: Length,
        /// Greatest diameter, m.
        #[serde(default = "largest")]
        largest: Length,
        /// Diameters (m) and numbers per 0.1 m2 instead of level, slope and limits.
        bins: Option<Vec<(Length, f64)>>,
        /// Refractive index of the particles, > 0.
        #[serde(default = "dust")]
        n: f64,
        /// Extinction coefficient of the particles, >= 0.
        #[serde(default = "soot")]
        k: f64,
    },
    /// A finish of the built-in library, by its name.
    Finish(String),
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

/// The ray that a cosine lobe surrounds.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum ScatterAxis {
    /// The reflected ray.
    #[default]
    Specular,
    /// The way back to the source of the light.
    Source,
}

/// The law of the normals of a rough surface.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum FacetLaw {
    /// Long-tailed: ground and etched glass.
    #[serde(rename = "GGX")]
    Ggx,
    /// Gaussian slopes.
    Beckmann,
}

/// What a facet of a rough surface does to light.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum Facets {
    /// What Fresnel says of the two media.
    #[default]
    Interface,
    /// Reflects, or passes, everything.
    Perfect,
}

/// What becomes of light that meets a second facet.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum FacetEnergy {
    /// It is absorbed.
    #[default]
    SingleScatter,
    /// It is given back, diffusely.
    Compensated,
}

/// The rms height of a polished surface, and over which spatial frequencies it counts.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum Roughness {
    /// Over all frequencies.
    Total(Length),
    /// Over those of a measurement.
    Band {
        /// Rms height.
        rms: Length,
        /// Lowest spatial frequency.
        from: Frequency,
        /// Highest spatial frequency.
        to: Frequency,
    },
}

impl Scatter {
    /// The finishes of the library in this model, those that exist.
    pub fn finishes(&self) -> Vec<&'static finish::Finish> {
        match self {
            Scatter::Finish(name) => finish::find(name).into_iter().collect(),
            Scatter::Sum(parts) => parts.iter().flat_map(Scatter::finishes).collect(),
            _ => Vec::new(),
        }
    }

    /// The particles of this model, if it has some.
    pub fn contamination(&self) -> Option<&Scatter> {
        match self {
            Scatter::Contamination { .. } => Some(self),
            Scatter::Sum(parts) => parts.iter().find_map(Scatter::contamination),
            _ => None,
        }
    }

    /// True if it is not the same from both sides of a surface.
    pub fn is_sided(&self) -> bool {
        match self {
            Scatter::Contamination { .. } | Scatter::Klems { .. } => true,
            Scatter::Sum(parts) => parts.iter().any(Scatter::is_sided),
            _ => false,
        }
    }

    /// True if a part of it mirrors and refracts by facets: it has no level.
    pub fn has_facets(&self) -> bool {
        match self {
            Scatter::Microfacet { .. } => true,
            Scatter::Sum(parts) => parts.iter().any(Scatter::has_facets),
            _ => false,
        }
    }

    /// True if a part of it is the scatter of a shape alone, to be scaled by the reflectance and transmittance of the coating.
    pub fn is_of_shape(&self) -> bool {
        match self {
            Scatter::KCorrelation { .. } | Scatter::Psd { .. } => true,
            Scatter::Finish(name) => finish::find(name).is_ok_and(|finish| finish.polish().is_some()),
            Scatter::Sum(parts) => parts.iter().any(Scatter::is_of_shape),
            _ => false,
        }
    }
}

fn one() -> f64 {
    1.0
}

fn visible() -> String {
    "Visible".to_owned()
}

/// The standard's.
fn slope() -> f64 {
    0.926
}

fn smallest() -> Length {
    Length(1e-6)
}

fn largest() -> Length {
    Length(200e-6)
}

/// Of house dust in the visible.
fn dust() -> f64 {
    1.53
}

/// Of house dust in the visible.
fn soot() -> f64 {
    0.001
}

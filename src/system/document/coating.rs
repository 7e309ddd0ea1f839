//! What is specular at a surface.

use serde::Deserialize;

/// A named coating, used by `coating:` of a surface.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum Coating {
    /// The bare interface of its two media.
    Fresnel,
    /// Fixed shares at every angle and wavelength; what is missing to 1 is absorbed.
    Ideal {
        /// Reflectance, 0..1.
        reflectance: f64,
        /// Transmittance, 0..1.
        transmittance: f64,
    },
    /// An opaque mirror.
    Mirror {
        /// Reflectance, 0..1.
        reflectance: f64,
    },
    /// An opaque metal with index n + ik.
    Metal {
        /// Refractive index, dimensionless, > 0.
        n: f64,
        /// Extinction coefficient, dimensionless, >= 0.
        k: f64,
    },
    /// An opaque layer of a medium: a metal with its dispersion.
    Opaque {
        /// A name in `media`.
        medium: String,
    },
}

/// What `specular:` of a surface may say: a coating without a name, or nothing specular at all.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum Specular {
    /// Nothing is specular: what is not scattered is absorbed.
    Absorb,
    /// See [`Coating::Fresnel`].
    Fresnel,
    /// See [`Coating::Ideal`].
    Ideal {
        /// Reflectance, 0..1.
        reflectance: f64,
        /// Transmittance, 0..1.
        transmittance: f64,
    },
    /// See [`Coating::Mirror`].
    Mirror {
        /// Reflectance, 0..1.
        reflectance: f64,
    },
    /// See [`Coating::Metal`].
    Metal {
        /// Refractive index, dimensionless, > 0.
        n: f64,
        /// Extinction coefficient, dimensionless, >= 0.
        k: f64,
    },
}

impl Specular {
    /// The same as a coating; `None` if it absorbs.
    pub fn coating(self) -> Option<Coating> {
        Some(match self {
            Specular::Absorb => return None,
            Specular::Fresnel => Coating::Fresnel,
            Specular::Ideal { reflectance, transmittance } => Coating::Ideal { reflectance, transmittance },
            Specular::Mirror { reflectance } => Coating::Mirror { reflectance },
            Specular::Metal { n, k } => Coating::Metal { n, k },
        })
    }
}

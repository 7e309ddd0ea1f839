//! What is specular at a surface.

use super::stack::Layer;
use crate::system::units::{Angle, Direction, Wavelength};
use serde::Deserialize;
use std::path::{Path, PathBuf};

/// A row of a coating's table: wavelength, angle, and the shares R_s, R_p, T_s, T_p, 0..1 each.
pub type Row = (Wavelength, Angle, f64, f64, f64, f64);

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
    /// Fixed shares of s and p light.
    Splitter {
        /// Reflectances of s and p, 0..1.
        reflectance: (f64, f64),
        /// Transmittances of s and p, 0..1.
        transmittance: (f64, f64),
    },
    /// An open sheet that passes light whose field is along its axis.
    Polarizer {
        /// In the world; light sees its projection across the ray.
        axis: Direction,
        /// Transmittance along the axis, 0..1; 1 if not given.
        #[serde(default = "all")]
        transmittance: f64,
        /// Transmittance across the axis, 0..1; 0 if not given.
        #[serde(default)]
        leakage: f64,
    },
    /// A wave plate, an open sheet.
    Retarder {
        /// The fast axis in the world; light sees its projection across the ray.
        axis: Direction,
        /// Phase by which light across the axis comes later, rad.
        retardance: Angle,
    },
    /// Thin films between the media of the face.
    Stack {
        /// From the front of the face, the outside of a solid, to its back.
        layers: Vec<Layer>,
        /// Vacuum wavelength at which waves are counted, m.
        design: Option<Wavelength>,
        /// A name in `media`: an opaque medium under the layers, whatever is beyond the face.
        substrate: Option<String>,
    },
    /// Measured or calculated shares over wavelength and angle.
    Table {
        /// CSV file, relative to the system file.
        file: Option<PathBuf>,
        /// The rows themselves, instead of a file.
        rows: Option<Vec<Row>>,
    },
    /// A coating of a Zemax COATING.DAT file.
    Zemax {
        /// The file, relative to the system file.
        file: PathBuf,
        /// Name of the coating in it.
        coating: String,
        /// Vacuum wavelength at which relative thicknesses are counted, m.
        design: Option<Wavelength>,
        /// A name in `media`: an opaque medium under the layers, whatever is beyond the face.
        substrate: Option<String>,
    },
}

impl Coating {
    /// The file that the coating is read from.
    pub fn file(&self) -> Option<&Path> {
        match self {
            Coating::Table { file, .. } => file.as_deref(),
            Coating::Zemax { file, .. } => Some(file),
            _ => None,
        }
    }

    /// Names of the media that it is made of.
    pub fn media(&self) -> Vec<&str> {
        let mut media = Vec::new();
        match self {
            Coating::Opaque { medium } => media.push(medium.as_str()),
            Coating::Stack { layers, substrate, .. } => {
                layers.iter().for_each(|layer| layer.media(&mut media));
                media.extend(substrate.as_deref());
            }
            Coating::Zemax { substrate, .. } => media.extend(substrate.as_deref()),
            _ => {}
        }
        media
    }
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

fn all() -> f64 {
    1.0
}

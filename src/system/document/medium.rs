//! What fills a solid.

use super::Bulk;
use crate::medium::air::{ATMOSPHERE, ROOM};
use crate::system::units::{Absorption, Pressure, Temperature, Wavelength, WavelengthSquared};
use serde::Deserialize;
use std::path::{Path, PathBuf};

/// A homogeneous medium: its complex refractive index n + ik over the vacuum wavelength.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum Medium {
    /// The same index at every wavelength.
    Constant {
        /// Refractive index, dimensionless, > 0.
        n: f64,
        /// Extinction coefficient, dimensionless, >= 0; 0 if neither it nor `absorption` is given.
        k: Option<f64>,
        /// Absorption coefficient 4 pi k / lambda, 1/m, instead of `k`.
        absorption: Option<Absorption>,
    },
    /// n^2 = 1 + sum b_i lambda^2 / (lambda^2 - c_i), any number of terms.
    Sellmeier {
        /// Strengths, dimensionless.
        b: Vec<f64>,
        /// Squared resonance wavelengths, m2; as many as `b`.
        c: Vec<WavelengthSquared>,
    },
    /// A table over the wavelength.
    Tabulated {
        /// Vacuum wavelengths, m, increasing.
        wavelength: Vec<Wavelength>,
        /// Refractive indices, dimensionless, > 0; one per wavelength.
        n: Vec<f64>,
        /// Extinction coefficients, dimensionless, >= 0; one per wavelength, or all 0 if not given.
        k: Option<Vec<f64>>,
        /// Absorption coefficients 4 pi k / lambda, 1/m, instead of `k`.
        absorption: Option<Vec<Absorption>>,
    },
    /// Dry air; catalogue glasses are relative to it.
    Air {
        /// Temperature, K; 293.15 K if not given.
        #[serde(default = "room")]
        temperature: Temperature,
        /// Pressure, Pa; 101325 Pa if not given.
        #[serde(default = "atmosphere")]
        pressure: Pressure,
    },
    /// A glass of the built-in catalogue: "N-BK7", or with its maker "SCHOTT:N-BK7".
    Glass(String),
    /// A metal of the built-in catalogue: "Al", or with its author "Al:Rakic".
    Metal(String),
    /// A crystal or film material of the built-in catalogue: "CaF2", or with its author "TiO2:Siefke".
    Material(String),
    /// A page of refractiveindex.info.
    RefractiveIndexInfo {
        /// YAML file, relative to the system file.
        file: PathBuf,
    },
    /// A glass of an AGF catalogue.
    Agf {
        /// AGF file, relative to the system file.
        file: PathBuf,
        /// Name of the glass in it.
        glass: String,
    },
    /// A medium with something in it that scatters.
    Turbid {
        /// What it would be without.
        host: Box<Medium>,
        /// What scatters.
        scatter: Bulk,
    },
}

impl Medium {
    /// The file that the medium is read from.
    pub fn file(&self) -> Option<&Path> {
        match self {
            Medium::RefractiveIndexInfo { file } | Medium::Agf { file, .. } => Some(file),
            Medium::Turbid { host, scatter } => host.file().or(match scatter {
                Bulk::Spheres { medium, .. } => medium.file(),
                _ => None,
            }),
            _ => None,
        }
    }
}

fn room() -> Temperature {
    Temperature(ROOM)
}

fn atmosphere() -> Pressure {
    Pressure(ATMOSPHERE)
}

//! Coatings of a Zemax COATING.DAT file.
//!
//! | section | content |
//! |---|---|
//! | `MATE name` | rows `wavelength_um n k`, absorption with *negative* k; linear between the rows, the end rows held |
//! | `COAT name` | rows `material thickness is_absolute`: um if 1, waves at the design wavelength (n d) if 0 or missing |
//! | `COAT I.0.95` | no rows: T is the number in the name, R = 1 - T |
//! | `IDEAL name T R` | R = 1 - T if it is missing |
//! | `TABLE name` | `ANGL deg`, then rows `WAVE um Rs Rp Ts Tp` and four phases |
//! | `!` | a comment |
//!
//! Names are the same in upper and lower case. Layers stand from the outermost (air) to the substrate. The phases of a table count
//! in other frames than ours and are not used. Refused with a reason where the wanted coating needs them: `ENCRYPTED` coatings,
//! `IDEAL2` (Jones matrices), loops and tapers of layers; other coatings of the file are not judged.
//!
//! No such file is shipped; built from the format's public description, not from a maker's file.
//! Source: Ansys Zemax OpticStudio Help, "Defining coatings" and "The TABLE data section".

mod read;

use super::tabulated::Row;
use crate::error::Problem;
use crate::medium::Tabulated;

pub use read::parse;

/// A coating of a file.
#[derive(Clone, Debug)]
pub enum Entry {
    /// From the outermost layer to the substrate.
    Films(Vec<Film>),
    /// R and T at every angle.
    Ideal { reflectance: f64, transmittance: f64 },
    /// Rows of a table.
    Table(Vec<Row>),
}

/// One layer.
#[derive(Clone, Debug)]
pub struct Film {
    pub material: Tabulated,
    pub thickness: Thickness,
}

/// How thick a layer is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Thickness {
    /// m
    Length(f64),
    /// n d in wavelengths of the design, dimensionless.
    Waves(f64),
}

/// What was read, and what about it is worth a word.
#[derive(Clone, Debug)]
pub struct Found {
    pub entry: Entry,
    pub warnings: Vec<Problem>,
}

#[cfg(test)]
mod tests;

//! Where light is counted. A detector watches; it never changes the light.

use super::surface::Side;
use crate::system::units::{Direction, Length, Position, Wavelength};
use serde::{Deserialize, Deserializer, de};
use std::fmt;

/// A detector.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Detector {
    /// What light has to meet.
    pub on: Receiver,
    /// What is mapped.
    pub quantity: Quantity,
    /// Columns and rows of the map; one bin if not given (one per triangle on a curved node).
    pub pixels: Option<(u32, u32)>,
    /// Which side counts.
    #[serde(default)]
    pub side: Side,
    /// How directions are binned, for `Intensity`; polar if not given.
    pub bins: Option<Bins>,
    /// What the map counts.
    #[serde(default)]
    pub counts: Counts,
    /// Transmittance of a filter in front of it.
    pub filter: Option<Efficiency>,
    /// Regions of interest with their names, for irradiance on a plane.
    #[serde(default)]
    pub regions: Vec<(String, Region)>,
}

/// What a map counts.
#[derive(Debug, Clone, PartialEq, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum Counts {
    /// W/m2 or W/sr.
    #[default]
    Watts,
    /// ph/s in every pixel.
    Photons,
    /// e-/s in every pixel.
    Electrons {
        /// Electrons per photon.
        qe: Efficiency,
    },
    /// lx or cd: photopic.
    Lumens,
}

/// A region of interest, in the plane of the map, from its middle along columns and rows.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum Region {
    /// A disc.
    Disk {
        /// Middle, m.
        at: (Length, Length),
        /// Radius, m.
        radius: Length,
    },
    /// What lies between two circles.
    Annulus {
        /// Middle, m.
        at: (Length, Length),
        /// Radius, m.
        inner: Length,
        /// Radius, m.
        outer: Length,
    },
    /// A rectangle along columns and rows.
    Rectangle {
        /// Middle, m.
        at: (Length, Length),
        /// Size along columns, m.
        width: Length,
        /// Size along rows, m.
        height: Length,
    },
}

/// A share: `0.6`, or over the wavelength `[("450 nm", 0.3), ("650 nm", 0.8)]`.
#[derive(Debug, Clone, PartialEq)]
pub struct Efficiency(
    /// Vacuum wavelengths, m, and shares; one row alone holds everywhere.
    pub Vec<(f64, f64)>,
);

impl<'de> Deserialize<'de> for Efficiency {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Rows;
        impl<'de> de::Visitor<'de> for Rows {
            type Value = Efficiency;
            fn expecting(&self, out: &mut fmt::Formatter) -> fmt::Result {
                out.write_str("a share such as 0.6, or a list of wavelengths and shares")
            }
            fn visit_f64<E: de::Error>(self, share: f64) -> Result<Efficiency, E> {
                Ok(Efficiency(vec![(0.0, share)]))
            }
            fn visit_u64<E: de::Error>(self, share: u64) -> Result<Efficiency, E> {
                self.visit_f64(share as f64)
            }
            fn visit_i64<E: de::Error>(self, share: i64) -> Result<Efficiency, E> {
                self.visit_f64(share as f64)
            }
            fn visit_seq<A: de::SeqAccess<'de>>(self, mut rows: A) -> Result<Efficiency, A::Error> {
                let mut list = Vec::new();
                while let Some((wavelength, share)) = rows.next_element::<(Wavelength, f64)>()? {
                    list.push((wavelength.0, share));
                }
                Ok(Efficiency(list))
            }
        }
        deserializer.deserialize_any(Rows)
    }
}

/// What light has to meet to be counted.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum Receiver {
    /// Nodes of the geometry: a glob over their names and paths.
    Node(String),
    /// A rectangle in space that light crosses freely.
    Rectangle {
        /// Centre, m.
        at: Position,
        /// Normal: the front side.
        normal: Direction,
        /// Direction of the columns; made perpendicular to the normal.
        x: Option<Direction>,
        /// Size along x, m.
        width: Length,
        /// Size along y, m.
        height: Length,
    },
    /// A disc in space that light crosses freely.
    Disk {
        /// Centre, m.
        at: Position,
        /// Normal: the front side.
        normal: Direction,
        /// Radius, m.
        radius: Length,
    },
    /// Light that leaves the scene, by its direction.
    FarField {
        /// Pole of the map.
        axis: Direction,
    },
}

/// What is mapped.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum Quantity {
    /// Flux per area, W/m2, by position.
    Irradiance,
    /// Flux per solid angle, W/sr, by direction.
    Intensity,
}

/// How directions are binned.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum Bins {
    /// Polar angle x azimuth.
    #[default]
    Polar,
    /// Direction cosines.
    Projected,
}

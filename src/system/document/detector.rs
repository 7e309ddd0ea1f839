//! Where light is counted. A detector watches; it never changes the light.

use super::surface::Side;
use crate::system::units::{Direction, Length, Position};
use serde::Deserialize;

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

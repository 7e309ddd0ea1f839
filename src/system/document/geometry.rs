//! Where the shapes come from.

use crate::system::units::{Angles, LengthUnit, Position};
use glam::DVec3;
use serde::Deserialize;
use std::path::PathBuf;

/// One glTF file, placed in the scene: scaled by `unit`, turned by `up`, then by `rotate`, then moved by `at`.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Geometry {
    /// The file, relative to the system file.
    pub file: PathBuf,
    /// Size of one unit of length of the file, m. glTF says metre.
    #[serde(default = "metre")]
    pub unit: LengthUnit,
    /// Which axis of the file points up.
    #[serde(default)]
    pub up: Up,
    /// Displacement, m.
    #[serde(default = "origin")]
    pub at: Position,
    /// Right-handed rotations about the fixed axes x, then y, then z through the origin, rad.
    #[serde(default = "unturned")]
    pub rotate: Angles,
}

/// Which axis of the file becomes +z.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum Up {
    /// Coordinates are taken as they are stored.
    #[default]
    Stored,
    /// The file is y-up, as glTF says: its +y becomes +z, its +z becomes -y.
    Y,
    /// The file is z-up: the same as stored, said aloud.
    Z,
}

/// What glTF says.
pub(super) fn metre() -> LengthUnit {
    LengthUnit(1.0)
}

/// The origin of coordinates.
pub(super) fn origin() -> Position {
    Position(DVec3::ZERO)
}

/// No rotation.
pub(super) fn unturned() -> Angles {
    Angles(DVec3::ZERO)
}

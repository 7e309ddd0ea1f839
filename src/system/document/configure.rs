//! Changes to the geometry after it is placed: nodes that are hidden, replaced, moved, and what they are called.

use crate::system::units::{Angles, LengthUnit, Position};
use serde::Deserialize;
use std::path::PathBuf;

/// What is done to some nodes: replaced, then scaled, turned and moved in the axes of `about`; or hidden.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Change {
    /// Glob over names and paths of nodes; a node stands for everything below it.
    pub node: String,
    /// Whether they are left out.
    #[serde(default)]
    pub hide: bool,
    /// What takes their place.
    pub replace: Option<Replacement>,
    /// Factors along x, y and z; none 0. One or three below 0 make a mirror image.
    pub scale: Option<(f64, f64, f64)>,
    /// Right-handed rotations about x, then y, then z, rad.
    pub rotate: Option<Angles>,
    /// Displacement, m.
    #[serde(rename = "move")]
    pub shift: Option<Position>,
    /// Which frame `scale`, `rotate` and `move` are given in.
    #[serde(default)]
    pub about: About,
}

/// A frame.
#[derive(Debug, Clone, PartialEq, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum About {
    /// The origin of each node, in the axes of the world.
    #[default]
    Own,
    /// A point of the world, m, in its axes.
    Point(Position),
    /// Origin and axes of a node, with or without a mesh.
    Node(String),
}

/// A node of another file, laid with its frame on the frame of the node that it replaces.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Replacement {
    /// The glTF file, relative to the system file.
    pub file: PathBuf,
    /// Glob that one node of it matches.
    pub node: String,
    /// Size of one unit of length of the file, m. glTF says metre.
    #[serde(default = "super::geometry::metre")]
    pub unit: LengthUnit,
}

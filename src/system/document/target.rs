//! What surfaces may aim at, so that less of the light they scatter is drawn in vain.

use crate::system::units::{Direction, Length, Position};
use serde::Deserialize;

/// A place that scattered light is sent to: more rays go there, each with the less flux. Aiming at the wrong place costs time, never
/// truth. The image of an aperture is given by its place and size.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum Target {
    /// The boxes around nodes of the geometry: a glob over their names and paths.
    Node(String),
    /// A rectangle in space.
    Rectangle {
        /// Centre, m.
        at: Position,
        /// Normal.
        normal: Direction,
        /// Direction of the width; made perpendicular to the normal.
        x: Option<Direction>,
        /// Size along x, m.
        width: Length,
        /// Size along y, m.
        height: Length,
    },
    /// A disc in space.
    Disk {
        /// Centre, m.
        at: Position,
        /// Normal.
        normal: Direction,
        /// Radius, m.
        radius: Length,
    },
}

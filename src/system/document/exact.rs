//! Exact shapes: what a face of a mesh or of an element truly is.
//!
//! Coordinates are those of the vertex: z is the axis. R > 0: the centre of curvature lies towards +z.

use super::geometry::origin;
use crate::system::units::{Coefficient, Direction, Length, Position};
use glam::DVec3;
use serde::Deserialize;

/// The true form of a surface. With r the distance from the axis and c = 1 / radius,
/// z = c r^2 / (1 + sqrt(1 - (1 + conic) c^2 r^2)) + terms.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum Form {
    /// z = 0.
    Plane,
    /// A sphere through the vertex.
    Sphere {
        /// m; not 0.
        radius: Length,
    },
    /// A conic of revolution: -1 a paraboloid, below a hyperboloid, above an ellipsoid.
    Conic {
        /// m; not 0.
        radius: Length,
        /// Conic constant, dimensionless.
        conic: f64,
    },
    /// A conic with powers of r, even or odd.
    Asphere {
        /// m; a plane base if not given.
        radius: Option<Length>,
        /// Conic constant, dimensionless.
        #[serde(default)]
        conic: f64,
        /// Power p of r and coefficient, m^(1 - p).
        terms: Vec<(u32, Coefficient)>,
    },
    /// A conic with powers of x and y.
    Polynomial {
        /// m; a plane base if not given.
        radius: Option<Length>,
        /// Conic constant, dimensionless.
        #[serde(default)]
        conic: f64,
        /// Powers i of x and j of y and coefficient, m^(1 - i - j).
        terms: Vec<((u32, u32), Coefficient)>,
    },
    /// A curve z(x), turned about an axis parallel to x at the height `rotation`.
    Toroid {
        /// Of the curve, m; straight if not given.
        radius: Option<Length>,
        /// Conic constant of the curve, dimensionless.
        #[serde(default)]
        conic: f64,
        /// Even powers of x, m^(1 - p).
        #[serde(default)]
        terms: Vec<(u32, Coefficient)>,
        /// m; not turned, a cylinder lens, if not given.
        rotation: Option<Length>,
    },
    /// A cylinder about the axis.
    Cylinder {
        /// m, > 0.
        radius: Length,
    },
}

/// The exact shape of the triangles that an entry selects.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Exact {
    /// What they are triangles of.
    pub form: Form,
    /// Where its vertex is: in the world, or in the node's own coordinates (metres as the file means them).
    #[serde(default = "origin")]
    pub vertex: Position,
    /// Its axis.
    #[serde(default = "z")]
    pub axis: Direction,
    /// Its x, as near as can be; for polynomials and toroids.
    pub x: Option<Direction>,
    /// What `vertex`, `axis` and `x` are relative to.
    #[serde(default)]
    pub relative: Relative,
    /// Replaces the polygonal rim by a circle about the axis, m.
    pub semi_diameter: Option<Length>,
    /// Only triangles whose corners lie this near to the shape are meant, m. If not given, all of them are, and it is an error
    /// if a corner is farther off than 0.1 % of the part's size.
    pub within: Option<Length>,
}

/// What a place is relative to.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum Relative {
    /// The world of the system.
    #[default]
    World,
    /// The frame of the node.
    Node,
}

fn z() -> Direction {
    Direction(DVec3::Z)
}

//! Elements written without CAD: lenses, mirrors, apertures, tubes. Each is a node with named faces, exact in all of them.

use super::exact::Form;
use super::geometry::{origin, unturned};
use crate::system::units::{Angles, Length, Position};
use serde::Deserialize;

/// An element, placed: turned by `rotate` about its own origin, then moved by `at`.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Element {
    /// What it is.
    pub body: Body,
    /// Where its origin is, m.
    #[serde(default = "origin")]
    pub at: Position,
    /// Right-handed rotations about the fixed axes x, then y, then z through its origin, rad.
    #[serde(default = "unturned")]
    pub rotate: Angles,
}

/// Kinds of elements. Light that runs along +z meets the front first.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum Body {
    /// One or more glasses cemented together. Node `name`, or `name.1`, `name.2` for several glasses; tags `front`, `back`,
    /// `edge`, `shoulder`. The origin is the first vertex.
    Lens {
        /// One more than there are glasses.
        surfaces: Vec<Optical>,
        /// Vertex to vertex, m.
        thickness: Vec<Length>,
        /// Names in `media`.
        media: Vec<String>,
        /// Of the edge, m; that of the largest surface if not given.
        diameter: Option<Length>,
    },
    /// A reflecting front, with a blank behind it if it has a thickness: tags `front`, `back`, `edge`, `hole`. The origin is the vertex.
    Mirror {
        /// Of the front.
        form: Form,
        /// m
        diameter: Length,
        /// Diameter of the hole in the middle, m.
        hole: Option<Length>,
        /// Of the blank at the vertex, m; a sheet if not given. Negative: the blank is towards -z.
        thickness: Option<Length>,
    },
    /// A thin plane screen with a round hole.
    Aperture {
        /// Of the hole, m; 0 for a disc without one.
        diameter: Length,
        /// Outer diameter, m.
        outer: Length,
    },
    /// A tube or ring with walls: tags `inside`, `outside`, `front`, `back`. The origin is on the axis in the front plane.
    Tube {
        /// Inner diameter, m.
        inner: Length,
        /// Outer diameter, m.
        outer: Length,
        /// m
        length: Length,
    },
    /// A baffle ring whose inner edge is bevelled to a knife edge of a finite radius: tags `front`, `bevel`, `edge`, `outside`, `back`.
    Vane {
        /// Inner diameter, m.
        inner: Length,
        /// Outer diameter, m.
        outer: Length,
        /// m
        thickness: Length,
        /// Between the bevel, which looks to +z, and the front, rad.
        bevel: crate::system::units::Angle,
        /// Of the edge, m, > 0.
        edge_radius: Length,
    },
    /// Straight vanes that hold a secondary mirror. The origin is on the axis in the front plane.
    Spider {
        /// How many.
        vanes: u32,
        /// Across the vane, m.
        width: Length,
        /// Along z, m.
        depth: Length,
        /// Diameter at which they begin, m.
        inner: Length,
        /// Diameter at which they end, m.
        outer: Length,
    },
    /// A rectangular plate of a medium; the origin is the middle of its front.
    Plate {
        /// Along x, m.
        width: Length,
        /// Along y, m.
        height: Length,
        /// Along z, m.
        thickness: Length,
        /// A name in `media`; opaque if not given.
        medium: Option<String>,
    },
    /// A polygon of the yz plane, extended along x: tags `side1`, `side2`, .. from the first corner on, `ends`.
    Prism {
        /// Corners (y, z), m, either way round.
        corners: Vec<(Length, Length)>,
        /// Along x, m, half to each side.
        length: Length,
        /// A name in `media`; opaque if not given.
        medium: Option<String>,
    },
    /// A profile turned about z: tags `s1`, `s2`, .. from the first corner on.
    Lathe {
        /// Corners (r, z), m. Seen with z to the right and r upwards, the front is to the right of the way from one to the next.
        profile: Vec<(Length, Length)>,
        /// Whether the last corner joins the first.
        #[serde(default)]
        closed: bool,
    },
}

/// A surface of a lens.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Optical {
    pub form: Form,
    /// m; half the diameter of the lens if not given. A flat shoulder joins a smaller one to the edge.
    pub semi_diameter: Option<Length>,
}

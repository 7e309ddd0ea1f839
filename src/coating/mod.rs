//! Interfaces: what is specular at a surface. One model, one file.

// A problem of an input is built once per run.
#![allow(clippy::result_large_err)]

pub mod bare;
pub mod ideal;
pub mod metal;
pub mod mirror;
pub mod opaque;
pub mod polarizer;
pub mod response;
pub mod retarder;
pub mod splitter;
pub mod stack;
pub mod tabulated;
pub mod zemax;

use crate::optics::{Incidence, Split};
use glam::DVec3;

pub use bare::Bare;
pub use ideal::Ideal;
pub use metal::Metal;
pub use mirror::Mirror;
pub use opaque::Opaque;
pub use polarizer::Polarizer;
pub use response::Response;
pub use retarder::Retarder;
pub use splitter::Splitter;
pub use stack::Stack;
pub use tabulated::Tabulated;

/// Which side of a face light arrives at.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// Where its normal points to: the outside of a solid.
    Front,
    Back,
}

/// What a surface does to the specular part of light.
pub trait Coating: Send + Sync + std::fmt::Debug {
    /// Reflected and transmitted amplitudes at this incidence; 1 - R - T is absorbed in the interface.
    fn split(&self, at: &Incidence) -> Split;

    /// True where nothing is ever transmitted: a reflection there is what the designer meant, not a ghost.
    fn opaque(&self) -> bool;

    /// Direction in the scene, for a coating that acts on light along and across it: its transmitted `s` is for the field along
    /// the projection of this axis across the ray, `p` for the field across both. `None`: s and p of the plane of incidence.
    fn axis(&self) -> Option<DVec3> {
        None
    }

    /// Vacuum wavelengths (m) at which the data hold; `None`: everywhere.
    fn range(&self) -> Option<[f64; 2]> {
        None
    }

    /// True for an uncoated interface: it yields to a declared coating where two faces lie on each other.
    fn bare(&self) -> bool {
        false
    }
}

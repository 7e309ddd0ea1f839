//! Which way light goes between a detector or a source and an object.

use crate::packet::Ancestry;
use serde::Serialize;

/// The kinds of way that are told apart.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Way {
    /// Nothing between.
    Direct,
    /// Through the optics as they are meant: transmissions and designed mirrors only.
    Optics,
    /// Reflected at least once where it is not meant to be, never scattered.
    Specular,
    /// Scattered once, whatever else.
    Scatter,
}

impl Way {
    /// In the order of tables.
    pub const ALL: [Way; 4] = [Way::Direct, Way::Optics, Way::Specular, Way::Scatter];

    /// The way of a packet so far; `None` if it was scattered more than once.
    pub fn of(ancestry: &Ancestry) -> Option<Way> {
        match (ancestry.scatters, ancestry.ghosts) {
            (0, _) if ancestry.events == 0 => Some(Way::Direct),
            (0, 0) => Some(Way::Optics),
            (0, _) => Some(Way::Specular),
            (1, _) => Some(Way::Scatter),
            _ => None,
        }
    }

    /// True for the ways of a first-order path: what is lit and seen so is one scatter event away from the detector.
    pub fn is_first(self) -> bool {
        matches!(self, Way::Direct | Way::Optics)
    }
}

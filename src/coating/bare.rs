//! An uncoated interface between two media: Fresnel's reflectances, s and p kept apart ([`crate::optics::fresnel`]).
//!
//! Left out: roughness and sub-surface scatter (a `scatter` lobe), natural oxide films.

use super::Coating;
use crate::optics::{Incidence, Split, fresnel};

/// No coating at all.
#[derive(Clone, Copy, Debug, Default)]
pub struct Bare;

impl Coating for Bare {
    fn split(&self, at: &Incidence) -> Split {
        fresnel::interface(at.index[0], at.index[1], at.cos())
    }

    fn opaque(&self) -> bool {
        false
    }

    fn bare(&self) -> bool {
        true
    }
}

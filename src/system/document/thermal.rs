//! How warm things are, for what they send to the detectors themselves.

use super::source::Spectrum;
use crate::system::units::Temperature;
use serde::Deserialize;

/// A band of wavelengths, and the temperatures of the nodes.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Thermal {
    /// Wavelengths that the detectors respond to: a `Band`.
    pub band: Spectrum,
    /// Globs over nodes of the geometry, each with a temperature, K, 0 or more; later ones override earlier ones. What none of them
    /// matches is cold: 0 K.
    pub temperatures: Vec<(String, Temperature)>,
}

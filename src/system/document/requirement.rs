//! What is required of a run.

use crate::system::units::{Flux, Irradiance};
use serde::Deserialize;

/// Something that the stray light on a detector must stay below. Stray is all light but what is meant to arrive: the class "signal", or
/// direct light where nothing makes an image.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Requirement {
    /// May be left out where there is one.
    pub detector: Option<String>,
    pub limit: Limit,
    /// One-sided probability with which a verdict holds, 0.5..1.
    #[serde(default = "default_confidence")]
    pub confidence: f64,
}

/// The largest value allowed.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum Limit {
    /// Stray flux over signal flux on the whole detector, dimensionless.
    StrayToSignal(f64),
    /// Stray flux on the whole detector, W.
    StrayFlux(Flux),
    /// Mean of the stray irradiance over the detector, W/m2.
    StrayIrradiance(Irradiance),
}

impl Limit {
    /// In its unit.
    pub fn value(self) -> f64 {
        match self {
            Limit::StrayToSignal(ratio) => ratio,
            Limit::StrayFlux(flux) => flux.0,
            Limit::StrayIrradiance(irradiance) => irradiance.0,
        }
    }
}

fn default_confidence() -> f64 {
    0.95
}

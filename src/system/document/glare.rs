//! A uniform field with a black patch in it, for the veiling glare index.

use super::source::{Angular, Extent, Polarization, Source, Spectrum};
use crate::source::angular::ring;
use crate::system::units::{Angle, Direction, Irradiance, Position};
use glam::DVec3;
use serde::Deserialize;
use std::f64::consts::PI;

/// A field of uniform radiance at infinity, and in its middle a patch that may be black (ISO 9358).
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Glare {
    /// Where rays start: what lets light into the instrument.
    pub extent: Extent,
    /// Centre of the extent, m; the origin if not given.
    pub at: Option<Position>,
    /// Direction of the light from the middle of the patch; +z if not given. It is also the normal of the extent.
    pub axis: Option<Direction>,
    /// Angular diameter of the field, rad.
    pub field: Angle,
    /// Angular diameter of the patch, rad.
    pub patch: Angle,
    /// Wavelengths.
    pub spectrum: Spectrum,
    /// A detector within the image of the patch; may be left out where there is one.
    pub detector: Option<String>,
}

impl Glare {
    /// The field without the patch, and what the patch is without its blackness; both of 1 W/m2/sr, which is E = pi L (sin^2 outer - sin^2
    /// inner) across the axis.
    pub fn sources(&self) -> [Source; 2] {
        let around = Angular::Ring { inner: self.patch, outer: self.field };
        let [field, patch] = [[self.patch.0, self.field.0], [0.0, self.patch.0]];
        [(around, field), (Angular::AngularDiameter(self.patch), patch)].map(|(angular, [inner, outer])| Source {
            flux: None,
            irradiance: Some(Irradiance(PI * ring(0.5 * inner, 0.5 * outer))),
            extent: self.extent.clone(),
            at: self.at,
            axis: Some(self.axis.unwrap_or(Direction(DVec3::Z))),
            x: None,
            angular,
            spectrum: self.spectrum.clone(),
            polarization: Polarization::Unpolarized,
        })
    }
}

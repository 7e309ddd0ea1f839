//! Sources: extent x angular x spectrum. One pattern, one file's section; any extent goes with any angular pattern.
//!
//! A source ray carries flux / (rays of this source in the batch). Its place, direction and wavelength come from five
//! low-discrepancy coordinates: [0, 1] place, [2, 3] direction, \[4\] wavelength.

pub mod angular;
pub mod extent;
pub mod planck;
pub mod seen;
pub mod spectrum;

pub use angular::Angular;
pub use extent::{Extent, Spot};
pub use seen::Reach;
pub use spectrum::{Density, Spectrum};

use crate::geometry::{Frame, Ray};
use crate::optics::Stokes;
use glam::DVec3;

/// Polarisation of emitted light, as a normalised Stokes vector relative to the axis below.
#[derive(Clone, Copy, Debug)]
pub struct Polarization {
    /// Stokes vector of unit flux.
    pub stokes: Stokes,
    /// The direction, projected perpendicular to each ray, from which the polarisation angle is counted; unit.
    pub reference: DVec3,
}

/// Something that shines.
#[derive(Clone, Debug)]
pub struct Source {
    pub label: String,
    /// Total, W.
    pub flux: f64,
    pub extent: Extent,
    pub angular: Angular,
    pub spectrum: Spectrum,
    pub polarization: Polarization,
    /// True if no ray can start inside a solid: no need to ask where each one is.
    pub outside: bool,
}

/// A newborn ray.
#[derive(Clone, Debug)]
pub struct Birth {
    pub ray: Ray,
    /// Unit normal of the place it starts from, on the side that shines.
    pub normal: DVec3,
    /// Triangle and side it starts from, if any.
    pub from: Option<(u32, bool)>,
    /// Vacuum wavelength, m.
    pub wavelength: f64,
    /// Unit, perpendicular to the ray.
    pub transverse: DVec3,
}

impl Source {
    /// The ray at five coordinates in [0, 1), asked for by number and only where they matter.
    pub fn emit(&self, u: &mut dyn FnMut(u32) -> f64) -> Birth {
        let spot = self.extent.spot([u(0), u(1)]);
        let local = match self.angular.pattern {
            angular::Pattern::Collimated => DVec3::Z,
            _ => self.angular.direction([u(2), u(3)]),
        };
        let frame = self.angular.frame().unwrap_or(spot.frame);
        let direction = frame.to_world(local).normalize();
        let transverse = Frame::from_z_x(direction, self.polarization.reference).x;
        Birth {
            ray: Ray { origin: spot.point, direction },
            normal: spot.frame.z,
            from: spot.triangle,
            wavelength: match self.spectrum {
                Spectrum::Line(wavelength) => wavelength,
                _ => self.spectrum.wavelength(u(4)),
            },
            transverse,
        }
    }
}

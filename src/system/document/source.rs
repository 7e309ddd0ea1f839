//! Where light starts: extent x angular x spectrum.

use super::surface::Side;
use crate::system::units::{Angle, Direction, Flux, Irradiance, Length, Position, Temperature, Wavelength};
use serde::Deserialize;

/// A light source.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Source {
    /// Emitted flux, W; either this or `irradiance`.
    pub flux: Option<Flux>,
    /// Irradiance on a plane across the beam, W/m2: the flux is this times the area of the extent seen along the beam.
    pub irradiance: Option<Irradiance>,
    /// Where rays start.
    pub extent: Extent,
    /// Centre of the extent, m; the origin if not given.
    pub at: Option<Position>,
    /// Normal of the extent and axis of emission; the beam's direction if collimated, else +z.
    pub axis: Option<Direction>,
    /// Where width and the angle of linear polarization are counted from; made perpendicular to the axis.
    pub x: Option<Direction>,
    /// Where rays go.
    pub angular: Angular,
    /// Wavelengths.
    pub spectrum: Spectrum,
    /// State of polarization.
    #[serde(default)]
    pub polarization: Polarization,
}

/// Where rays start.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum Extent {
    /// One point.
    Point,
    /// A disc, uniform.
    Disk {
        /// Radius, m.
        radius: Length,
    },
    /// A ring, uniform.
    Annulus {
        /// Inner radius, m.
        inner: Length,
        /// Outer radius, m.
        outer: Length,
    },
    /// A regular polygon, uniform, with its first corner on x.
    Polygon {
        /// Radius of the circle through the corners, m.
        radius: Length,
        /// Number of corners, at least 3.
        sides: u32,
    },
    /// A rectangle, uniform.
    Rectangle {
        /// Size along x, m.
        width: Length,
        /// Size along y, m.
        height: Length,
    },
    /// A Gaussian profile, not truncated.
    Gaussian {
        /// Radius where the irradiance is 1/e2 of its peak, m.
        waist: Length,
    },
    /// The surface of nodes of the geometry, uniform.
    Node {
        /// Glob over node names and paths.
        name: String,
        /// Which side emits; the front if not given.
        #[serde(default = "front")]
        side: Side,
    },
    /// The smallest disc across the beam, ahead of everything, that lights these nodes completely.
    Cover {
        /// Globs over node names and paths.
        nodes: Vec<String>,
        /// Factor on the radius, >= 1.
        #[serde(default = "margin")]
        margin: f64,
    },
}

/// Where rays go, about the axis.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum Angular {
    /// All in one direction: exactly one of the three is given.
    Collimated {
        /// The direction.
        direction: Option<Direction>,
        /// The point that the ray from the centre of the extent meets, m.
        aim_at: Option<Position>,
        /// Field angles, rad: the direction is (tan x, tan y, 1) about the axis.
        field: Option<(Angle, Angle)>,
    },
    /// Uniform in solid angle in a cone.
    Cone {
        /// Half angle, rad.
        half_angle: Angle,
    },
    /// A disc of uniform radiance at infinity, with this angular diameter, rad.
    AngularDiameter(Angle),
    /// Uniform radiance at infinity between two angular diameters: a field around a black patch.
    Ring {
        /// Angular diameter of the patch, rad.
        inner: Angle,
        /// Angular diameter of the field, rad.
        outer: Angle,
    },
    /// Intensity proportional to the cosine.
    Lambertian,
    /// Gaussian in angle.
    Gaussian {
        /// Half angle where the intensity is 1/e2 of its peak, rad.
        half_angle: Angle,
    },
    /// The same intensity in every direction.
    Isotropic,
}

impl Angular {
    /// True if it is at infinity and not a point: an irradiance is that on the plane of the extent.
    pub fn is_sky(&self) -> bool {
        matches!(self, Angular::AngularDiameter(_) | Angular::Ring { .. })
    }
}

/// How flux is shared among vacuum wavelengths.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum Spectrum {
    /// One wavelength, m.
    Line(Wavelength),
    /// Wavelengths, m, and their shares of the flux (any scale).
    Lines(Vec<(Wavelength, f64)>),
    /// Uniform per wavelength between two wavelengths.
    Band {
        /// Least wavelength, m.
        from: Wavelength,
        /// Greatest wavelength, m.
        to: Wavelength,
    },
    /// Flux per wavelength, linear between the points of a table.
    Table {
        /// Wavelengths, m, increasing.
        wavelength: Vec<Wavelength>,
        /// Flux per wavelength (any scale), >= 0.
        weight: Vec<f64>,
    },
    /// Planck's law between two wavelengths; `flux` is what is in the band.
    BlackBody {
        /// Temperature, K.
        temperature: Temperature,
        /// Least wavelength, m.
        from: Wavelength,
        /// Greatest wavelength, m.
        to: Wavelength,
    },
}

/// State of polarization.
#[derive(Debug, Clone, Copy, PartialEq, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum Polarization {
    /// None.
    #[default]
    Unpolarized,
    /// Fully linear.
    Linear {
        /// Angle of the electric field from x, about the axis, rad.
        angle: Angle,
    },
    /// Fully circular.
    Circular(Handedness),
}

/// Sense of circular polarization.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum Handedness {
    /// Clockwise, seen against the light.
    Right,
    /// Counter-clockwise, seen against the light.
    Left,
}

fn front() -> Side {
    Side::Front
}

fn margin() -> f64 {
    1.05
}

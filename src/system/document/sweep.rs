//! A sweep: the same distant source at many angles from the boresight.

use super::source::{Angular, Extent, Polarization, Source, Spectrum};
use crate::system::units::{Angle, Direction, Irradiance, Position};
use glam::DVec3;
use serde::Deserialize;
use std::path::PathBuf;

/// A distant source at many directions, written once; each direction becomes a source of its own.
///
/// With the unit vectors b (boresight) and u (up, made perpendicular to b), the direction *to* the source at the angle theta from
/// the boresight and the azimuth phi is
///
/// ```text
/// s = b cos theta + (u cos phi + (b x u) sin phi) sin theta
/// ```
///
/// so phi counts from `up`, clockwise as who looks along the boresight sees it. Light goes along -s.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Sweep {
    /// Irradiance on a plane across the beam at the entrance, W/m2.
    pub irradiance: Irradiance,
    /// Where rays start.
    pub extent: Extent,
    /// Centre of the extent, m; the origin if not given.
    pub at: Option<Position>,
    /// Normal of the extent; the beam's direction if not given: the extent then turns with the source.
    pub axis: Option<Direction>,
    /// Where width and the angle of linear polarization are counted from; made perpendicular to the axis.
    pub x: Option<Direction>,
    /// Angular diameter of the source in the sky, rad; a point if not given.
    pub diameter: Option<Angle>,
    /// Wavelengths.
    pub spectrum: Spectrum,
    /// State of polarization.
    #[serde(default)]
    pub polarization: Polarization,
    /// Where the instrument looks: from it to a source on its axis; -z if not given, so that light on the axis goes along +z.
    pub boresight: Option<Direction>,
    /// Where azimuths count from; +y if not given.
    pub up: Option<Direction>,
    /// Angles from the boresight, rad, 0..pi, rising.
    pub angles: Angles,
    /// Azimuths, rad; 0 if not given.
    pub azimuths: Option<Vec<Angle>>,
    /// The detector whose mean irradiance is asked for; may be left out where there is one.
    pub detector: Option<String>,
    /// What is required.
    pub mask: Option<Mask>,
}

/// Angles from the boresight.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum Angles {
    /// One by one, rad.
    List(Vec<Angle>),
    /// Equal steps.
    Linear {
        /// The first, rad.
        from: Angle,
        /// The last, rad.
        to: Angle,
        /// How many.
        count: u32,
    },
    /// Equal ratios.
    Log {
        /// The first, rad, > 0.
        from: Angle,
        /// The last, rad.
        to: Angle,
        /// How many.
        count: u32,
    },
}

/// The largest value that is allowed at each angle.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Mask {
    /// CSV with the columns `angle_deg` and `limit`.
    pub file: PathBuf,
}

/// Most angles of a list of equal steps or ratios.
pub const MOST_ANGLES: u32 = 1000;

impl Angles {
    /// The angles, rad; of counts that are refused, none.
    pub fn values(&self) -> Vec<f64> {
        let spaced = |count: u32, at: &dyn Fn(f64) -> f64| match count {
            2..=MOST_ANGLES => (0..count).map(|k| at(f64::from(k) / f64::from(count - 1))).collect(),
            _ => Vec::new(),
        };
        match self {
            Angles::List(list) => list.iter().map(|angle| angle.0).collect(),
            Angles::Linear { from, to, count } => spaced(*count, &|part| from.0 + part * (to.0 - from.0)),
            Angles::Log { from, to, count } => spaced(*count, &|part| from.0 * (to.0 / from.0).powf(part)),
        }
    }
}

impl Sweep {
    /// Azimuths, rad.
    pub fn azimuths(&self) -> Vec<f64> {
        self.azimuths.as_ref().map_or(vec![0.0], |list| list.iter().map(|angle| angle.0).collect())
    }

    /// Where the instrument looks, unit.
    pub fn boresight(&self) -> DVec3 {
        self.boresight.map_or(DVec3::NEG_Z, |direction| direction.0)
    }

    /// Unit direction of the light of the source at an angle from the boresight and an azimuth, rad.
    pub fn direction(&self, theta: f64, phi: f64) -> DVec3 {
        let b = self.boresight();
        let up = self.up.map_or(DVec3::Y, |direction| direction.0);
        let u = up.reject_from_normalized(b).normalize_or_zero();
        -(theta.cos() * b + theta.sin() * (phi.cos() * u + phi.sin() * b.cross(u))).normalize()
    }

    /// The source in one direction, as it would be written.
    pub fn source(&self, theta: f64, phi: f64) -> Source {
        let beam = Direction(self.direction(theta, phi));
        let collimated = Angular::Collimated { direction: Some(beam), aim_at: None, field: None };
        Source {
            flux: None,
            irradiance: Some(self.irradiance),
            extent: self.extent.clone(),
            at: self.at,
            axis: self.axis.or(self.diameter.map(|_| beam)),
            x: self.x,
            angular: self.diameter.map_or(collimated, Angular::AngularDiameter),
            spectrum: self.spectrum.clone(),
            polarization: self.polarization,
        }
    }
}

/// Degrees of an angle in rad, as one would write them: 1e-9 deg is rounding.
pub fn degrees(angle: f64) -> f64 {
    (1e9 * angle.to_degrees()).round() / 1e9
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::FRAC_PI_2;

    fn sweep(frame: &str) -> Sweep {
        let text = format!(
            "(irradiance: \"1 W/m2\", extent: Disk(radius: \"1 mm\"), spectrum: Line(\"550 nm\"), \
             angles: Log(from: \"1 deg\", to: \"100 deg\", count: 3), {frame})"
        );
        ron::from_str(&text).expect("a sweep")
    }

    #[test]
    fn azimuth_counts_from_up_clockwise_as_the_instrument_sees_it() {
        // Looking along -z with +y up, +x is to the right: there is the source at 90 deg.
        let near = |sweep: &Sweep, theta: f64, phi: f64, to: DVec3| (sweep.direction(theta, phi) + to).length() < 1e-15;
        let usual = sweep("");
        assert!(near(&usual, 0.0, 1.0, DVec3::NEG_Z));
        assert!(near(&usual, FRAC_PI_2, 0.0, DVec3::Y));
        assert!(near(&usual, FRAC_PI_2, FRAC_PI_2, DVec3::X));
        // Looking along +x with +z up (and a bit along the boresight), +y is to the left.
        let other = sweep("boresight: Some(\"(1, 0, 0)\"), up: Some(\"(1, 0, 1)\")");
        assert!(near(&other, FRAC_PI_2, 0.0, DVec3::Z));
        assert!(near(&other, FRAC_PI_2, FRAC_PI_2, DVec3::NEG_Y));
    }

    #[test]
    fn ratios_are_equal() {
        let degrees: Vec<f64> = sweep("").angles.values().iter().map(|angle| angle.to_degrees()).collect();
        assert!((degrees[1] - 10.0).abs() < 1e-12 && (degrees[2] - 100.0).abs() < 1e-12, "{degrees:?}");
    }
}

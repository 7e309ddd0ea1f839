//! Sweeps: each direction becomes an ordinary source; what is asked of them is kept beside the scene.

use super::Shop;
use super::assembly::Assembly;
use super::lights;
use super::mask::Mask;
use crate::detector::Detector;
use crate::error::Problem;
use crate::source::Source;
use crate::system::document::{self as written, degrees};

/// Directions from which the same light comes, and what is asked of them.
#[derive(Clone, Debug)]
pub struct Sweep {
    pub label: String,
    /// Index of its first source in the scene; the others follow, angle by angle, azimuth by azimuth.
    pub first: usize,
    /// From the boresight, rad, rising.
    pub angles: Vec<f64>,
    /// From up, clockwise as who looks along the boresight sees it, rad, rising.
    pub azimuths: Vec<f64>,
    /// On a plane across the beam, W/m2.
    pub irradiance: f64,
    /// Index of the detector whose mean irradiance is asked for.
    pub detector: usize,
    pub mask: Option<Mask>,
}

impl Sweep {
    /// Number of directions.
    pub fn directions(&self) -> usize {
        self.angles.len() * self.azimuths.len()
    }

    /// Angle and azimuth of direction number `index`, rad.
    pub fn direction(&self, index: usize) -> [f64; 2] {
        let count = self.angles.len();
        [self.angles[index % count], self.azimuths[index / count]]
    }
}

/// Every sweep of the document; its sources are put after those that are there.
pub fn sweeps(
    shop: &mut Shop,
    assembly: &Assembly,
    detectors: &[(Detector, Vec<usize>)],
    sources: &mut Vec<Source>,
) -> Vec<Sweep> {
    let document = shop.document;
    let mut sweeps = Vec::new();
    for (name, written) in document.system.sweeps.iter() {
        let path = format!("sweeps[{name:?}]");
        let mask = written.mask.as_ref().and_then(|mask| super::mask::read(shop, &path, mask));
        let Some(detector) = watched(shop, &path, written.detector.as_deref(), detectors) else { continue };
        let sweep = Sweep {
            label: name.into(),
            first: sources.len(),
            angles: written.angles.values(),
            azimuths: written.azimuths(),
            irradiance: written.irradiance.0,
            detector,
            mask,
        };
        if emit(shop, assembly, &path, (&sweep, written), sources) {
            sweeps.push(sweep);
        }
    }
    sweeps
}

/// Makes the sources of a sweep; stops at the first that cannot be made, for the others have the same fault.
fn emit(
    shop: &mut Shop,
    assembly: &Assembly,
    path: &str,
    (sweep, written): (&Sweep, &written::Sweep),
    sources: &mut Vec<Source>,
) -> bool {
    (0..sweep.directions()).all(|index| {
        let [theta, phi] = sweep.direction(index);
        let azimuth = if sweep.azimuths.len() > 1 { format!(", {} deg", degrees(phi)) } else { String::new() };
        let label = format!("{} {} deg{azimuth}", sweep.label, degrees(theta));
        if sources.iter().any(|source| source.label == label) {
            let problem = Problem::error(format!("there are two sources {label:?}"));
            shop.fault(path, problem.expecting("another name for one of them"));
            return false;
        }
        let source = lights::source(shop, assembly, (path, &label), &written.source(theta, phi));
        let made = source.is_some();
        sources.extend(source);
        made
    })
}

/// The detector whose mean irradiance is asked for: that of the name, or the only one.
pub fn watched(shop: &mut Shop, path: &str, name: Option<&str>, detectors: &[(Detector, Vec<usize>)]) -> Option<usize> {
    let is_meant = |detector: &Detector| name.is_none_or(|name| name == detector.label);
    let index = detectors.iter().position(|(detector, _)| is_meant(detector))?;
    let detector = &detectors[index].0;
    if detector.grid.unit() != "W/m2" {
        let problem = Problem::error(format!("irradiance is asked for, and {:?} maps directions", detector.label));
        shop.fault(path, problem.expecting("a detector with `quantity: Irradiance`"));
        return None;
    }
    Some(index)
}

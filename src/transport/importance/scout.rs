//! Scouts: light that a detector sends out backwards, and where it comes to surfaces that scatter.
//!
//! Reflectances and transmittances are the same both ways and scatter is reciprocal, so light that starts at the detector,
//! uniform in étendue, travels as importance does. Scouts only teach what to draw; what they leave out (circular polarisation,
//! surfaces that are not reciprocal) costs variance.

use crate::aim::Target;
use crate::detector::{Place, Shape, Side};
use crate::geometry::Frame;
use crate::math::Rng;
use crate::optics::Stokes;
use crate::packet::{Ancestry, Event};
use crate::scene::Scene;
use crate::source::extent::{Mesh, Outline};
use crate::source::{Angular, Extent, Polarization, Source, Spectrum, angular::Pattern};
use crate::transport::watch::{Sight, Watch};
use glam::DVec3;
use std::f64::consts::FRAC_PI_2;

/// How a scout came to a surface; seen from there, what scattered light would have to aim at.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Way {
    /// Straight from this detector.
    Straight(u16),
    /// Without scatter; last through or off this part.
    Through(u32),
    /// Scattered on the way.
    Scattered,
}

/// A scout at a surface that scatters.
#[derive(Clone, Copy, Debug)]
pub struct Sighting {
    pub part: u32,
    pub front: bool,
    /// Of the face, towards where it arrived; unit.
    pub normal: DVec3,
    pub point: DVec3,
    /// Unit, to where it came from.
    pub towards: DVec3,
    /// Flight since its last event, m.
    pub distance: f64,
    /// What it carries: étendue x transmittance, in shares of the detector's.
    pub weight: f64,
    pub way: Way,
}

/// Takes down where scouts of a detector come to.
pub struct Scout<'a> {
    pub scene: &'a Scene,
    pub detector: u16,
    pub way: Way,
    pub sightings: Vec<Sighting>,
}

impl Watch for Scout<'_> {
    fn follows(&mut self, ancestry: &Ancestry, _flux: f64) {
        self.way = match ancestry.steps.last() {
            None => Way::Straight(self.detector),
            Some(_) if ancestry.scatters > 0 || ancestry.steps.is_full() => Way::Scattered,
            Some(step) if step.event() == Event::Bulk => Way::Scattered,
            Some(step) => Way::Through(step.number()),
        };
    }

    fn event(&mut self, sight: impl FnOnce() -> Sight) {
        let sight = sight();
        if self.scene.scatters(sight.part, sight.front) {
            self.sightings.push(Sighting {
                part: sight.part,
                front: sight.front,
                normal: sight.normal,
                point: sight.point,
                towards: -sight.direction,
                distance: sight.distance,
                weight: sight.flux,
                way: self.way,
            });
        }
    }
}

/// The detector as a Lambertian source of 1 W towards where it looks; none if it is at infinity.
pub fn shining(scene: &Scene, detector: usize) -> Vec<Source> {
    let watched = &scene.detectors[detector];
    let sides: &[bool] = match watched.side {
        Side::Front => &[true],
        Side::Back => &[false],
        Side::Both => &[true, false],
    };
    let source = |extent: Extent, share: f64| Source {
        label: watched.label.clone(),
        flux: share,
        extent,
        angular: Angular { axis: None, pattern: Pattern::Radiance { half_angle: FRAC_PI_2 } },
        spectrum: Spectrum::Line(0.0),
        polarization: Polarization { stokes: Stokes::unpolarised(1.0), reference: DVec3::X },
        outside: false,
    };
    match &watched.place {
        Place::FarField => Vec::new(),
        Place::Window(window) => {
            let outline = match window.shape {
                Shape::Rectangle { half } => Outline::Rectangle { width: 2.0 * half[0], height: 2.0 * half[1] },
                Shape::Disk { radius } => Outline::Disk { radius },
            };
            let turned = Frame { x: window.frame.x, y: -window.frame.y, z: -window.frame.z };
            let facing = |front: bool| {
                let frame = if front { window.frame } else { turned };
                // Light that lands within the thickness of the plane has been seen: start beyond it.
                let at = window.centre + 2.0 * window.thickness * frame.z;
                source(Extent::Flat { frame, at, outline }, 1.0 / sides.len() as f64)
            };
            sides.iter().map(|&front| facing(front)).collect()
        }
        Place::Parts => {
            let mine = triangles(scene, detector);
            let (mut triangles, mut cumulative, mut sum) = (Vec::new(), Vec::new(), 0.0);
            for (number, &front) in mine.iter().flat_map(|t| sides.iter().map(move |front| (*t, front))) {
                sum += scene.geometry.area(number);
                triangles.push((number, scene.geometry.triangle(number).vertices, front));
                cumulative.push(sum);
            }
            if sum > 0.0 { vec![source(Extent::Mesh(Mesh { triangles, cumulative }), 1.0)] } else { Vec::new() }
        }
    }
}

/// The box that a detector fills; `None` at infinity.
pub fn target_of(scene: &Scene, detector: usize) -> Option<Target> {
    let watched = &scene.detectors[detector];
    match &watched.place {
        Place::FarField => None,
        Place::Window(window) => {
            let half = match window.shape {
                Shape::Rectangle { half: [x, y] } => DVec3::new(x, y, 0.0),
                Shape::Disk { radius } => DVec3::new(radius, radius, 0.0),
            };
            Some(Target { label: watched.label.clone(), frame: window.frame, centre: window.centre, half })
        }
        Place::Parts => {
            let corners = triangles(scene, detector).into_iter().flat_map(|t| scene.geometry.triangle(t).vertices);
            Some(Target::around(watched.label.clone(), watched.grid.frame(), corners))
        }
    }
}

/// Triangles of the parts that a detector watches.
fn triangles(scene: &Scene, detector: usize) -> Vec<u32> {
    let watched = |t: &u32| scene.parts[scene.part_of[*t as usize] as usize].detectors.contains(&(detector as u16));
    (0..scene.geometry.len() as u32).filter(watched).collect()
}

/// A wavelength of the light in the scene, m.
pub fn wavelength(scene: &Scene, rng: &mut Rng) -> f64 {
    let number = (rng.uniform() * scene.sources.len() as f64) as usize;
    scene.sources[number.min(scene.sources.len() - 1)].spectrum.wavelength(rng.uniform())
}

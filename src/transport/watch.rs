//! A look over the tracer's shoulder: for `straylight ray` and for tests. A run watches nothing, at no cost.

use crate::detector::Arrival;
use crate::geometry::{Left, Ray};
use crate::packet::Ancestry;
use glam::DVec3;

/// One event of a watched packet.
#[derive(Clone, Debug)]
pub struct Sight {
    /// Events before this one on its path.
    pub depth: u32,
    /// Scene coordinates, m.
    pub point: DVec3,
    /// Flight since the last event, m.
    pub distance: f64,
    /// Index of the part that acts.
    pub part: u32,
    /// Whether light arrives at its front.
    pub front: bool,
    /// Of the face, towards where light arrives; unit.
    pub normal: DVec3,
    /// Angle of incidence, rad.
    pub angle: f64,
    /// Indices of the media before and beyond.
    pub media: [u16; 2],
    /// Arriving flux, W.
    pub flux: f64,
    /// Reflected, transmitted, scattered, absorbed fractions of it.
    pub fractions: [f64; 4],
    /// Unit direction of arrival.
    pub direction: DVec3,
    /// Directions of the reflected and the transmitted ray.
    pub leaves: [Option<DVec3>; 2],
}

/// Who watches.
pub trait Watch {
    /// A packet sets off from what it has left.
    fn flight(&mut self, _ray: &Ray, _left: &Left) {}
    /// The packet of this flux (W) that the next event, arrivals or escape are about.
    fn follows(&mut self, _ancestry: &Ancestry, _flux: f64) {}
    /// A surface event. Called before branches are drawn.
    fn event(&mut self, _sight: impl FnOnce() -> Sight) {}
    /// A packet of this flux (W) is scattered at the origin of the ray on which it came, in a medium. Called before its way is drawn.
    fn scattered(&mut self, _ray: &Ray, _medium: u16, _flux: f64) {}
    /// A packet of this flux (W) arrives at a detector. Called before what is there acts on it.
    fn arrives(&mut self, _detector: usize, _arrival: &Arrival, _flux: f64) {}
    /// A packet left the scene.
    fn escaped(&mut self, _ray: Ray, _flux: f64) {}
}

/// Nobody.
pub struct Unwatched;
impl Watch for Unwatched {}

//! Detectors: a place that watches and a grid that sorts what arrives. One grid, one file.
//!
//! A detector only watches: it records light that arrives, before anything happens to it, once per crossing; whatever is
//! there (a surface, or nothing) acts on the light as if nobody looked.

pub mod directions;
pub mod pixels;
pub mod region;
pub mod response;
pub mod triangles;

use crate::geometry::{Frame, Ray};
use glam::{DVec2, DVec3};
pub use region::Region;
pub use response::Response;

/// Light arriving at a detector.
#[derive(Clone, Copy, Debug)]
pub struct Arrival {
    /// Scene coordinates, m.
    pub point: DVec3,
    /// Unit.
    pub direction: DVec3,
    /// In vacuum, m.
    pub wavelength: f64,
    /// Triangle that was hit, for detectors on a part.
    pub triangle: Option<u32>,
}

/// How arrivals are sorted into bins.
pub trait Grid: Send + Sync + std::fmt::Debug {
    /// Bin of an arrival, or `None` outside the grid.
    fn bin(&self, arrival: &Arrival) -> Option<usize>;
    /// [rows, columns]; bin = row * columns + column.
    fn shape(&self) -> [usize; 2];
    /// Size of a bin, m2 or sr (0 if no light can fall there).
    fn extent(&self, bin: usize) -> f64;
    /// Unit of flux / extent.
    fn unit(&self) -> &'static str;
    fn kind(&self) -> MapKind;
    /// Columns, rows; `None` where bins have no axes.
    fn axes(&self) -> Option<[Axis; 2]>;
    /// World frame of the grid: columns run along x, rows along y.
    fn frame(&self) -> Frame;
    /// Where column 0 and row 0 begin, scene coordinates, m.
    fn origin(&self) -> DVec3;
    /// A point (scene coordinates, m) along columns and rows from the middle of the map, m; `None` where there is no plane.
    fn place(&self, _point: DVec3) -> Option<DVec2> {
        None
    }
}

/// How the bins lie.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MapKind {
    /// Pixels on a plane.
    Plane,
    /// Rows: polar angle from the axis; columns: azimuth.
    Polar,
    /// Rows: rings of equal projected solid angle (sin^2 theta); columns: azimuth.
    Projected,
    /// One bin per triangle.
    Triangles,
}

/// One axis of a map.
#[derive(Clone, Debug)]
pub struct Axis {
    pub name: String,
    /// "m" or "rad" or "sin2".
    pub unit: &'static str,
    /// Lower edge of bin 0.
    pub start: f64,
    pub step: f64,
}

/// Which arrivals count.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Side {
    /// Against the normal.
    Front,
    /// Along the normal.
    Back,
    #[default]
    Both,
}

impl Side {
    /// True if light arriving at the front (`true`) or back (`false`) counts.
    pub fn sees(self, front: bool) -> bool {
        match self {
            Side::Front => front,
            Side::Back => !front,
            Side::Both => true,
        }
    }

    /// "front", "back", "both".
    pub fn label(self) -> &'static str {
        ["front", "back", "both"][self as usize]
    }
}

/// Where a detector watches.
#[derive(Clone, Debug)]
pub enum Place {
    /// On parts of the scene (the parts know).
    Parts,
    /// On a plane in free space.
    Window(Window),
    /// At infinity: what leaves the scene.
    FarField,
}

/// A bounded plane that light crosses undisturbed.
#[derive(Clone, Debug)]
pub struct Window {
    /// z is the normal.
    pub frame: Frame,
    /// Centre, scene coordinates, m.
    pub centre: DVec3,
    pub shape: Shape,
    /// Points within this distance of the plane lie on it, m: rounding of a surface point.
    pub thickness: f64,
}

/// Outline of a window, m.
#[derive(Clone, Copy, Debug)]
pub enum Shape {
    Rectangle { half: [f64; 2] },
    Disk { radius: f64 },
}

/// Something that watches.
#[derive(Debug)]
pub struct Detector {
    pub label: String,
    pub place: Place,
    pub side: Side,
    pub grid: Box<dyn Grid>,
    /// What the map counts.
    pub response: Response,
    pub regions: Vec<Region>,
}

impl Detector {
    /// Size of a bin that its value is divided by: m2, sr, or 1 where pixels count one by one.
    pub fn extent(&self, bin: usize) -> f64 {
        let extent = self.grid.extent(bin);
        if self.response.by_the_pixel() && extent > 0.0 { 1.0 } else { extent }
    }

    /// Unit of the map.
    pub fn unit(&self) -> &'static str {
        self.response.of_bins(self.grid.unit())
    }
}

impl Window {
    /// Arrival of light that flies from `ray.origin` to `end` (`None`: to infinity): front side?, and where.
    ///
    /// A point within `thickness` is *on* the plane. Flight counts if it starts off the plane and ends on it or beyond, so
    /// that light which meets a surface in the very plane of the detector is recorded on arrival, and not again when it leaves.
    pub fn crossing(&self, ray: &Ray, end: Option<DVec3>) -> Option<(bool, DVec3)> {
        let normal = self.frame.z;
        let start = (ray.origin - self.centre).dot(normal);
        if start.abs() <= self.thickness {
            return None;
        }
        let towards = ray.direction.dot(normal);
        let front = start > 0.0;
        let reached = match end {
            Some(end) => {
                let height = (end - self.centre).dot(normal);
                if front { height <= self.thickness } else { height >= -self.thickness }
            }
            None => (towards < 0.0) == front && towards != 0.0,
        };
        if !reached || towards == 0.0 {
            return None;
        }
        let point = ray.at(-start / towards);
        let (x, y) = (self.frame.x.dot(point - self.centre), self.frame.y.dot(point - self.centre));
        let inside = match self.shape {
            Shape::Rectangle { half } => x.abs() <= half[0] && y.abs() <= half[1],
            Shape::Disk { radius } => x * x + y * y <= radius * radius,
        };
        inside.then_some((front, point))
    }
}

//! Triangles as bins: irradiance on a curved part.

use super::{Arrival, Axis, Grid, MapKind};
use crate::geometry::Frame;
use glam::DVec3;

/// One bin per triangle, in the order of the scene's triangles.
#[derive(Debug)]
pub struct Triangles {
    /// (scene triangle, area m2), sorted by triangle.
    bins: Vec<(u32, f64)>,
    centre: DVec3,
}

impl Triangles {
    /// Bins for scene triangles with their areas (m2); `centre` (scene coordinates, m) is for captions.
    pub fn new(mut bins: Vec<(u32, f64)>, centre: DVec3) -> Triangles {
        bins.sort_unstable_by_key(|bin| bin.0);
        Triangles { bins, centre }
    }
}

impl Grid for Triangles {
    fn bin(&self, arrival: &Arrival) -> Option<usize> {
        let triangle = arrival.triangle?;
        self.bins.binary_search_by_key(&triangle, |bin| bin.0).ok()
    }

    fn shape(&self) -> [usize; 2] {
        [1, self.bins.len()]
    }

    fn extent(&self, bin: usize) -> f64 {
        self.bins[bin].1
    }

    fn unit(&self) -> &'static str {
        "W/m2"
    }

    fn kind(&self) -> MapKind {
        MapKind::Triangles
    }

    fn axes(&self) -> Option<[Axis; 2]> {
        None
    }

    fn frame(&self) -> Frame {
        Frame::WORLD
    }

    fn origin(&self) -> DVec3 {
        self.centre
    }
}

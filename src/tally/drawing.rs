//! What a system looks like: triangles, names and ways of light, for pictures. Nothing is computed from it.

use glam::DVec3;

/// Triangles in single precision, part by part, and what is drawn with them.
#[derive(Clone, Debug, Default)]
pub struct Drawing {
    /// World coordinates of the origin, m.
    pub centre: DVec3,
    /// Half the diagonal of the box around everything, m.
    pub radius: f64,
    /// Relative to the centre, m.
    pub corners: Vec<[f32; 3]>,
    /// Counter-clockwise seen from the front; in the order of the parts.
    pub triangles: Vec<[u32; 3]>,
    pub parts: Vec<DrawnPart>,
    /// Triangles of the system: more than are drawn where corners were moved together.
    pub all_triangles: usize,
    /// Largest distance by which a corner was moved to make the picture smaller, m.
    pub moved: f64,
    pub ways: Vec<Way>,
}

/// One part and what is on its front and its back.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct DrawnPart {
    pub label: String,
    /// Triangles that are drawn.
    pub triangles: usize,
    /// m2
    pub area: f64,
    /// Whether it is a face of a closed body.
    pub solid: bool,
    /// What is specular: "Fresnel", "coating ar", ...
    pub speculars: [String; 2],
    /// Scatter models; empty: none.
    pub scatters: [String; 2],
    /// Media in front and behind where nothing touches it.
    pub media: [String; 2],
    /// Detectors that watch it.
    pub detectors: Vec<String>,
}

/// A way that light took.
#[derive(Clone, Debug, PartialEq)]
pub struct Way {
    pub source: String,
    /// What it was by then: "signal", "ghost 2", "scatter 1", ...
    pub class: String,
    /// Detector and sequence of the path table that it leads to, if it was looked for.
    pub path: Option<[String; 2]>,
    /// Relative to the centre, m.
    pub points: Vec<DVec3>,
    /// Flux at its end, W.
    pub flux: f64,
}

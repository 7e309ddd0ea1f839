//! Exact surfaces: faces of a mesh whose true shape is known.
//!
//! The mesh says where a face ends, its shape says where it is. A [`Face`] stands for a set of triangles, which are then no longer
//! met: the ray meets the shape, in closed form or by safeguarded Newton steps, and the rim decides whether the point
//! belongs to the face. Position and normal are those of the shape, so etendue is conserved as by the real surface.
//!
//! Where the face borders facets along a chord, the true surface leaves the chord by its sagitta: a gap, or an overlap, of up to
//! c^2 / 8R for a chord c. A [`Sliver`], the plane strip between the chord and the surface, closes it: it belongs to the
//! neighbour, and where it lies on the neighbour's own facets the two cancel. So the boundary of a solid stays closed.

mod conic;
mod outline;
mod sag;
mod shape;
mod sliver;
mod solve;

use super::{Frame, Ray};
use arrayvec::ArrayVec;
use glam::DVec3;
use solve::MOST;

pub use conic::Conic;
pub use outline::{Outline, Sweep, lift};
pub use sag::Sag;
pub use shape::Shape;
pub use sliver::Sliver;

/// A crossing of a line with a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Root {
    /// Along the line, m.
    pub t: f64,
    /// True if the line runs along the normal there: it leaves towards the side to which that looks.
    pub rises: bool,
}

/// Where a face ends.
#[derive(Clone, Debug)]
pub enum Rim {
    /// Nowhere: a closed surface.
    Whole,
    /// Between two distances from the axis, m.
    Ring {
        inner: f64,
        outer: f64,
    },
    /// Between two heights along the axis, m: cones.
    Band {
        low: f64,
        high: f64,
    },
    Outline(Outline),
}

/// An exact surface with its rim, placed.
#[derive(Clone, Debug)]
pub struct Face {
    /// Vertex, scene coordinates, m.
    pub at: DVec3,
    /// z: the axis.
    pub frame: Frame,
    pub what: Patch,
}

/// What is placed.
#[derive(Clone, Debug)]
pub enum Patch {
    Surface(Surface),
    Sliver(Sliver),
}

/// A shape and its rim, in the coordinates of the vertex.
#[derive(Clone, Debug)]
pub struct Surface {
    pub shape: Shape,
    rim: Rim,
    /// True if the front looks along the normal of the shape.
    outward: bool,
    /// Least and greatest coordinates, m.
    bounds: [DVec3; 2],
    /// By how much neighbours overlap at a common rim, m: some roundings, so that no ray passes between them.
    overlap: f64,
}

/// A ray meets a face.
#[derive(Clone, Copy, Debug)]
pub(super) struct Touch {
    /// m, negative behind the origin.
    pub distance: f64,
    /// Scene coordinates, m.
    pub point: DVec3,
    /// Out of the front, unit.
    pub normal: DVec3,
    /// True if the ray arrives on the front.
    pub front: bool,
}

impl Surface {
    /// `size`: greatest extent of the face in the plane across its axis, m, seen from the axis; `heights`: its extent along the
    /// axis if that does not follow from the shape (cones).
    pub fn new(shape: Shape, rim: Rim, outward: bool, size: f64, heights: Option<[f64; 2]>) -> Surface {
        let [low, high] = heights.unwrap_or_else(|| levels(&shape, &rim, size));
        let across = match (&shape, &rim) {
            (Shape::Conic(conic), Rim::Whole) => conic.equator(),

            _ => size,
        };
        let bounds = [DVec3::new(-across, -across, low), DVec3::new(across, across, high)];
        let reach = bounds[0].abs().max(bounds[1].abs()).max_element();
        Surface { shape, rim, outward, bounds, overlap: 4.0 * f64::EPSILON * reach }
    }

    fn holds(&self, p: DVec3) -> bool {
        let sheet = |conic: &Conic| conic.near(p);
        match (&self.rim, &self.shape) {
            (Rim::Whole, _) => true,
            (_, Shape::Conic(conic)) if !sheet(conic) => false,
            (Rim::Ring { inner, outer }, _) => {
                let r = p.x.hypot(p.y);
                r <= outer + self.overlap && (r >= inner - self.overlap || *inner == 0.0)
            }
            (Rim::Band { low, high }, _) => p.z >= low - self.overlap && p.z <= high + self.overlap,
            (Rim::Outline(outline), _) => outline.holds(p),
        }
    }

    /// The part of a line that lies in the bounds, m.
    fn span(&self, o: DVec3, d: DVec3) -> [f64; 2] {
        let slack = DVec3::splat(1e-9 * (self.bounds[1] - self.bounds[0]).max_element());
        let (a, b) = ((self.bounds[0] - slack - o) / d, (self.bounds[1] + slack - o) / d);
        [a.min(b).max_element(), a.max(b).min_element()]
    }
}

/// Least and greatest height of a shape within `size` of its axis, m.
fn levels(shape: &Shape, rim: &Rim, size: f64) -> [f64; 2] {
    if let (Shape::Conic(conic), Rim::Whole) = (shape, rim) {
        let end = 2.0 / (conic.curvature * (1.0 + conic.conic));
        return [end.min(0.0), end.max(0.0)];
    }
    const RINGS: u32 = 64;
    let [mut low, mut high] = [f64::INFINITY, f64::NEG_INFINITY];
    for (ring, spoke) in (0..=RINGS).flat_map(|ring| (0..32).map(move |spoke| (ring, spoke))) {
        let r = size * f64::from(ring) / f64::from(RINGS);
        let (sin, cos) = (std::f64::consts::TAU * f64::from(spoke) / 32.0).sin_cos();
        let height = -shape.level(DVec3::new(r * cos, r * sin, 0.0));
        if height.is_finite() {
            [low, high] = [low.min(height), high.max(height)];
        }
    }
    let between = match shape {
        Shape::Sag { bend, .. } => 0.125 * bend * (size / 8.0).powi(2),
        Shape::Conic(_) | Shape::Cone { .. } => 0.0,
    };
    [low - between, high + between]
}

impl Face {
    /// A point of the scene in the coordinates of the vertex, m.
    pub fn local(&self, p: DVec3) -> DVec3 {
        self.frame.to_local(p - self.at)
    }

    fn world(&self, p: DVec3) -> DVec3 {
        self.at + self.frame.to_world(p)
    }

    /// Least and greatest corner of a box around it, scene coordinates, m.
    pub fn bounds(&self) -> [DVec3; 2] {
        let [low, high] = match &self.what {
            Patch::Surface(surface) => surface.bounds,
            Patch::Sliver(sliver) => sliver.bounds,
        };
        let corner = |i: usize| DVec3::select(glam::BVec3::new(i & 1 == 1, i & 2 == 2, i & 4 == 4), high, low);
        let corners = (0..8).map(|i| self.world(corner(i)));
        let [low, high] = corners.map(|p| [p, p]).reduce(|a, b| [a[0].min(b[0]), a[1].max(b[1])]).unwrap_or_default();
        let pad = DVec3::splat(
            1e-12 * (high - low).max_element() + 8.0 * f64::EPSILON * high.abs().max(low.abs()).max_element(),
        );
        [low - pad, high + pad]
    }

    /// Every place where the line of a ray meets it.
    pub(super) fn meet(&self, ray: &Ray) -> ArrayVec<Touch, MOST> {
        let (o, d) = (self.local(ray.origin), self.frame.to_local(ray.direction));
        match &self.what {
            Patch::Surface(surface) => self.touches(surface, o, d),
            Patch::Sliver(sliver) => sliver.meet(o, d).map(|touch| self.placed(touch)).into_iter().collect(),
        }
    }

    fn touches(&self, surface: &Surface, o: DVec3, d: DVec3) -> ArrayVec<Touch, MOST> {
        // From where the ray is nearest to the face: from afar the roots would be differences of large numbers.
        let ahead = (0.5 * (surface.bounds[0] + surface.bounds[1]) - o).dot(d);
        let from = o + ahead * d;
        let roots = surface.shape.roots(from, d, surface.span(from, d));
        let touch = |root: Root| {
            let p = surface.shape.settle(from + root.t * d);
            surface.holds(p).then(|| {
                let normal = surface.shape.normal(p);
                let outward = if surface.outward { normal } else { -normal };
                let front = root.rises != surface.outward;
                self.placed(Touch { distance: ahead + root.t, point: p, normal: outward, front })
            })
        };
        roots.into_iter().filter_map(touch).collect()
    }

    /// From the coordinates of the vertex to those of the scene.
    fn placed(&self, touch: Touch) -> Touch {
        Touch { point: self.world(touch.point), normal: self.frame.to_world(touch.normal), ..touch }
    }

    /// A point on the shape farther inside the face than `p`: on the way to its middle. Scene coordinates, m.
    pub(super) fn inner(&self, p: DVec3) -> DVec3 {
        match &self.what {
            Patch::Surface(surface) => {
                let middle = 0.5 * (surface.bounds[0] + surface.bounds[1]);
                let local = self.local(p);
                let towards = match surface.shape {
                    Shape::Cone { .. } => DVec3::new(local.x, local.y, middle.z),
                    _ => DVec3::new(0.5 * (local.x + middle.x), 0.5 * (local.y + middle.y), local.z),
                };
                self.world(surface.shape.settle(towards))
            }
            Patch::Sliver(sliver) => self.world(sliver.middle()),
        }
    }
}

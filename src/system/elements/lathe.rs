//! Profiles turned about z: the mesh, and the exact surface of every stretch.
//!
//! A profile runs in the (r, z) plane. With z to the right and r upwards the front lies to the right of the way: a stretch that
//! runs outwards looks to -z, one that runs to +z looks away from the axis.

use super::Draft;
use crate::geometry::Frame;
use crate::geometry::exact::Shape;
use crate::system::exact::{Declared, Round};
use glam::DVec3;
use std::f64::consts::TAU;

/// Corners of the mesh around the axis, and steps along a curved stretch.
const SPOKES: u32 = 96;
const STEPS: u32 = 16;

/// A stretch of a profile.
pub struct Stretch {
    pub tag: String,
    pub curve: Curve,
}

/// How it runs. Distances from the axis r and heights z, m.
pub enum Curve {
    /// From (r, z) to (r, z).
    Straight([f64; 2], [f64; 2]),
    /// Along a surface with its vertex at height `vertex`, between two distances from the axis.
    Surface { shape: Shape, vertex: f64, from: f64, to: f64 },
}

/// Height of a surface of revolution at distance r from its axis, m.
pub fn height(shape: &Shape, vertex: f64, r: f64) -> f64 {
    vertex - shape.level(DVec3::new(r, 0.0, 0.0))
}

impl Curve {
    /// Corners of the mesh along it.
    fn points(&self) -> Vec<[f64; 2]> {
        match self {
            Curve::Straight(a, b) => vec![*a, *b],
            Curve::Surface { shape, vertex, from, to } => {
                let at = |i: u32| match i {
                    0 => *from,
                    STEPS => *to,
                    _ => from + (to - from) * f64::from(i) / f64::from(STEPS),
                };
                (0..=STEPS).map(at).map(|r| [r, height(shape, *vertex, r)]).collect()
            }
        }
    }

    fn exact(&self) -> Declared {
        let (shape, height, rim) = match self {
            Curve::Surface { shape, vertex, from, to } => {
                (shape.clone(), *vertex, Round::Ring { inner: from.min(*to), outer: from.max(*to) })
            }
            Curve::Straight([ra, za], [rb, zb]) if za == zb => {
                (Shape::plane(), *za, Round::Ring { inner: ra.min(*rb), outer: ra.max(*rb) })
            }
            Curve::Straight([ra, za], [rb, zb]) => {
                let taper = (rb - ra) / (zb - za);
                let (low, high) = (0f64.min(zb - za), 0f64.max(zb - za));
                (Shape::Cone { radius: *ra, taper }, *za, Round::Band { low, high })
            }
        };
        Declared { triangles: Vec::new(), shape, at: height * DVec3::Z, frame: Frame::WORLD, rim }
    }
}

/// The turned profile.
pub fn turn(profile: &[Stretch]) -> Draft {
    let mut draft = Draft::default();
    for (label, stretch) in profile.iter().enumerate() {
        // Stretches of one name keep labels of their own: each is a surface of its own.
        draft.tags.push(stretch.tag.clone());
        draft.exact.push((label as u16, stretch.curve.exact()));
        for pair in stretch.curve.points().windows(2) {
            (0..SPOKES).for_each(|spoke| panel(&mut draft, pair[0], pair[1], spoke, label as u16));
        }
    }
    draft
}

/// The triangles between two corners of the profile and two spokes.
fn panel(draft: &mut Draft, a: [f64; 2], b: [f64; 2], spoke: u32, label: u16) {
    let place = |[r, z]: [f64; 2], spoke: u32| {
        let (sin, cos) = (TAU * f64::from(spoke % SPOKES) / f64::from(SPOKES)).sin_cos();
        DVec3::new(r * cos, r * sin, z)
    };
    let corners = [place(a, spoke), place(a, spoke + 1), place(b, spoke + 1), place(b, spoke)];
    let first = draft.vertices.len() as u32;
    draft.vertices.extend(corners);
    for triangle in [[0, 1, 2], [0, 2, 3]] {
        let [p, q, r] = triangle.map(|i: usize| corners[i]);
        if p != q && q != r && r != p {
            draft.triangles.push(triangle.map(|i| first + i as u32));
            draft.labels.push(label);
        }
    }
}

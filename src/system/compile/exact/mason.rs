//! The faces of the scene: where they end, and what closes the gap to their neighbours.

use super::NodeFaces;
use super::outline::{Edge, directed, outline};
use crate::error::Problem;
use crate::geometry::Frame;
use crate::geometry::exact::{Face, Outline, Patch, Rim, Shape, Sliver, Surface, Sweep, lift};
use crate::system::compile::Shop;
use crate::system::compile::assembly::Assembly;
use crate::system::exact::{Declared, Round};
use crate::system::gltf::Node;
use glam::DVec3;
use std::collections::{BTreeMap, HashMap, HashSet};
use std::sync::Arc;

/// Builds the faces of every node once all triangles have a part.
pub fn faces(shop: &mut Shop, assembly: &mut Assembly) {
    let mut all = Vec::new();
    for (index, node) in assembly.nodes.iter().enumerate() {
        let mut built = NodeFaces::default();
        if !node.exact.is_empty() {
            let mason =
                Mason { node, part_of: &assembly.part_of[assembly.first[index] as usize..], directed: directed(node) };
            for declared in &node.exact {
                if let Err(problem) = mason.build(declared, &mut built) {
                    let problem = Problem { message: format!("`{}`: {}", node.name, problem.message), ..problem };
                    shop.fault("surfaces", problem);
                }
            }
        }
        all.push(built);
    }
    assembly.exact = all;
}

/// Builds the faces of a node.
struct Mason<'a> {
    node: &'a Node,
    part_of: &'a [u32],
    directed: HashMap<[u32; 2], u32>,
}

impl Mason<'_> {
    /// One face for each part that the declared triangles belong to.
    fn build(&self, declared: &Declared, built: &mut NodeFaces) -> Result<(), Problem> {
        let mut groups = BTreeMap::<u32, Vec<u32>>::new();
        for &t in &declared.triangles {
            groups.entry(self.part_of[t as usize]).or_default().push(t);
        }
        let whole = groups.len() == 1;
        for (part, triangles) in groups {
            let edges = outline(self.node, &triangles, &self.directed);
            let (at, frame) = self.axis(declared, &triangles, &edges)?;
            let to_local = |v: u32| frame.to_local(self.node.mesh.vertices[v as usize] - at);
            let chords: Vec<[DVec3; 2]> = edges.iter().map(|edge| edge.from.map(to_local)).collect();
            let rim = rim(declared, whole, &chords)?;
            let corners = || triangles.iter().flat_map(|&t| self.node.mesh.triangles[t as usize]).map(to_local);
            let size = match declared.rim {
                Round::Ring { outer, .. } if whole => outer,
                _ => corners().map(|p| p.x.hypot(p.y)).fold(0.0, f64::max),
            };
            let low = corners().map(|p| p.z).fold(f64::INFINITY, f64::min);
            let high = corners().map(|p| p.z).fold(f64::NEG_INFINITY, f64::max);
            let size = match declared.shape {
                Shape::Cone { radius, taper } => (radius + taper * low).max(radius + taper * high),
                _ => size,
            };
            let heights = matches!(declared.shape, Shape::Cone { .. }).then_some([low, high]);
            let outward = self.looks_outward(declared, &triangles, at, &frame);
            let surface = Surface::new(declared.shape.clone(), rim, outward, size, heights);
            built.faces.push(Face { at, frame, what: Patch::Surface(surface) });
            built.parts.push(part);
            built.areas.push(triangles.iter().map(|&t| self.node.mesh.area(t as usize)).sum());
            self.close(declared, whole, &edges, &chords, at, frame, built);
            built.replaced.extend(triangles);
        }
        Ok(())
    }

    /// Vertex and frame; the axis of a sphere goes through the middle of the triangles.
    fn axis(&self, declared: &Declared, triangles: &[u32], edges: &[Edge]) -> Result<(DVec3, Frame), Problem> {
        let Declared { at, frame, .. } = *declared;
        let curvature = match &declared.shape {
            Shape::Conic(conic) if conic.conic == 0.0 && conic.curvature != 0.0 => conic.curvature,
            _ => return Ok((at, frame)),
        };
        if declared.rim != Round::Polygon || edges.is_empty() {
            return Ok((at, frame));
        }
        let centre = at + frame.z / curvature;
        let corners = || triangles.iter().flat_map(|&t| self.node.mesh.corners(t as usize)).map(|v| v - centre);
        let Some(towards) = corners().sum::<DVec3>().try_normalize() else { return Ok((at, frame)) };
        if corners().any(|v| v.dot(towards) < 0.05 * v.length()) {
            return Err(Problem::error("this face reaches round more than a hemisphere")
                .expecting("a whole sphere, or faces of less than a hemisphere: select it in two entries"));
        }
        // The vertex is where the sphere meets the direction to the triangles.
        let z = -curvature.signum() * towards;
        Ok((centre - z / curvature, Frame::from_z(z)))
    }

    /// Whether the front of the triangles looks along the normal of the shape.
    fn looks_outward(&self, declared: &Declared, triangles: &[u32], at: DVec3, frame: &Frame) -> bool {
        let along = |&t: &u32| {
            let [a, b, c] = self.node.mesh.corners(t as usize);
            let p = declared.shape.settle(frame.to_local((a + b + c) / 3.0 - at));
            self.node.mesh.cross(t as usize).dot(frame.to_world(declared.shape.normal(p)))
        };
        triangles.iter().map(along).filter(|x| !x.is_nan()).sum::<f64>() > 0.0
    }

    /// Slivers towards neighbours that are not round about the same rim, or parts of the same surface.
    #[allow(clippy::too_many_arguments)]
    fn close(
        &self,
        declared: &Declared,
        whole: bool,
        edges: &[Edge],
        chords: &[[DVec3; 2]],
        at: DVec3,
        frame: Frame,
        built: &mut NodeFaces,
    ) {
        let own: HashSet<u32> = declared.triangles.iter().copied().collect();
        let exact_of = |t: u32| self.node.exact.iter().find(|other| other.triangles.contains(&t));
        let shape = Arc::new(declared.shape.clone());
        for (edge, chord) in edges.iter().zip(chords) {
            let Some(beyond) = edge.beyond.filter(|beyond| !own.contains(beyond)) else { continue };
            let round = |declared: &Declared| declared.rim != Round::Polygon;
            if whole && round(declared) && exact_of(beyond).is_some_and(round) {
                continue;
            }
            let sliver = match &*shape {
                Shape::Cone { .. } => Sliver::new(*chord, lift(Sweep::Azimuth, *chord), shape.clone()),
                _ => Sliver::new(*chord, DVec3::Z, shape.clone()),
            };
            built.areas.push(sliver.area());
            built.faces.push(Face { at, frame, what: Patch::Sliver(sliver) });
            built.parts.push(self.part_of[beyond as usize]);
        }
    }
}

/// Where a face ends, given its outline in the coordinates of the vertex.
fn rim(declared: &Declared, whole: bool, chords: &[[DVec3; 2]]) -> Result<Rim, Problem> {
    match declared.rim {
        Round::Ring { inner, outer } if whole => return Ok(Rim::Ring { inner, outer }),
        Round::Band { low, high } if whole => return Ok(Rim::Band { low, high }),
        _ => {}
    }
    let sweep = if matches!(declared.shape, Shape::Cone { .. }) { Sweep::Azimuth } else { Sweep::Y };
    if !chords.is_empty() {
        return Ok(Rim::Outline(Outline::new(sweep, chords)));
    }
    match &declared.shape {
        Shape::Conic(conic) if conic.equator().is_finite() && conic.curvature != 0.0 => Ok(Rim::Whole),
        _ => Err(Problem::error("a closed surface cannot be of this shape").expecting("a sphere or an ellipsoid")),
    }
}

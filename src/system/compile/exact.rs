//! Exact faces: which triangles they stand for, where they end, and what closes the gap to their neighbours.

use super::Shop;
use super::assembly::Assembly;
use crate::error::Problem;
use crate::geometry::Frame;
use crate::geometry::exact::{Face, Outline, Patch, Rim, Shape, Sliver, Surface, Sweep, lift};
use crate::system::document as written;
use crate::system::exact::{Declared, Round, shape};
use crate::system::gltf::Node;
use crate::system::select;
use glam::DVec3;
use std::collections::{BTreeMap, HashMap, HashSet};
use std::sync::Arc;

/// Exact faces of a node, the part of each, and the triangles they stand for.
#[derive(Debug, Default)]
pub struct NodeFaces {
    pub faces: Vec<Face>,
    pub parts: Vec<u32>,
    /// Area of the triangles that each stands for, m2 (0 for slivers).
    pub areas: Vec<f64>,
    pub replaced: Vec<u32>,
}

/// How far a corner of a declared face may be from its shape, of the size of the part, if nothing is said.
const NEAR: f64 = 1e-3;

/// How far rim corners may be from a declared circle, of its radius.
const ROUND: f64 = 0.02;

/// Adds what the entries declare to what the elements are; works in scene coordinates.
pub fn declare(shop: &mut Shop, assembly: &mut Assembly) {
    for (entry, surface) in shop.document.system.surfaces.iter().enumerate() {
        let Some(exact) = &surface.exact else { continue };
        let selector = super::assign::selector(&surface.on, assembly);
        for picked in select::select(&selector, &assembly.nodes) {
            let (name, shift) = (assembly.nodes[picked.node].name.clone(), assembly.shift);
            match declared(exact, &mut assembly.nodes[picked.node], picked.triangles, shift) {
                Ok(declared) => assembly.nodes[picked.node].exact.push(declared),
                Err(problem) => {
                    let problem = Problem { message: format!("`{name}`: {}", problem.message), ..problem };
                    shop.fault(&format!("surfaces[{entry}].exact"), problem);
                }
            }
        }
    }
    let twice = |node: &Node| {
        let mut seen = HashSet::new();
        node.exact.iter().flat_map(|d| &d.triangles).any(|t| !seen.insert(*t))
    };
    if let Some(node) = assembly.nodes.iter().find(|node| twice(node)) {
        let problem = Problem::error(format!("some triangles of `{}` have two exact shapes", node.name));
        shop.fault("surfaces", problem.expecting("one `exact` for each face; an element has its own"));
    }
}

/// What an entry declares of some triangles of a node.
fn declared(exact: &written::Exact, node: &mut Node, mut triangles: Vec<u32>, shift: DVec3) -> Result<Declared, Problem> {
    let (at, frame) = placed(exact, node, shift);
    let corners = |node: &Node, t: u32| node.mesh.corners(t as usize).map(|v| frame.to_local(v - at));
    let reach = |triangles: &[u32], node: &Node| {
        let all = triangles.iter().flat_map(|&t| corners(node, t));
        all.map(|p| p.x.hypot(p.y)).fold(0.0, f64::max)
    };
    let size = node.mesh.bounds().map_or(0.0, |[low, high]| (high - low).max_element());
    let rough = exact.within.map_or(NEAR * size, |w| w.0);
    if exact.within.is_some() {
        let form = shape(&exact.form, 0.0)?;
        triangles.retain(|&t| corners(node, t).iter().all(|p| form.distance(*p) <= rough));
        if triangles.is_empty() {
            return Err(Problem::error("no triangle lies that near to the shape").hinting("`straylight fit` finds shapes".to_owned()));
        }
    }
    let form = shape(&exact.form, exact.semi_diameter.map_or(reach(&triangles, node), |s| s.0))?;
    let far = triangles.iter().flat_map(|&t| corners(node, t)).map(|p| form.distance(p));
    let far = far.fold(0.0, |most: f64, d| if d.is_nan() { f64::INFINITY } else { most.max(d) });
    if far > rough {
        let problem = format!("its corners lie up to {:.3e} mm from this shape", 1e3 * far);
        return Err(Problem::error(problem)
            .expecting(format!("at most {:.3e} mm", 1e3 * rough))
            .hinting("`straylight fit` finds shapes; the sign: R > 0 if the centre lies towards +z of `axis`".to_owned()));
    }
    let mut declared = Declared { triangles, shape: form, at, frame, rim: Round::Polygon };
    if let Some(semi) = exact.semi_diameter {
        declared.rim = Round::Ring { inner: rounded(&declared, node, semi.0)?, outer: semi.0 };
    }
    Ok(declared)
}

/// Vertex and axes in scene coordinates.
fn placed(exact: &written::Exact, node: &Node, shift: DVec3) -> (DVec3, Frame) {
    let x = exact.x.map_or(DVec3::X, |x| x.0);
    match exact.relative {
        written::Relative::World => (exact.vertex.0 - shift, Frame::from_z_x(exact.axis.0, x)),
        written::Relative::Node => {
            let turned = |v: DVec3| node.frame.transform_vector3(v).normalize_or(v);
            (node.frame.transform_point3(exact.vertex.0), Frame::from_z_x(turned(exact.axis.0), turned(x)))
        }
    }
}

/// Moves the rim's corners onto the circle of radius `outer` (m); the radius of a hole in the middle, 0 without one.
fn rounded(declared: &Declared, node: &mut Node, outer: f64) -> Result<f64, Problem> {
    let edges = outline(node, &declared.triangles, &directed(node));
    let mut rim: Vec<u32> = edges.iter().map(|edge| edge.from[0]).collect();
    rim.sort_unstable();
    rim.dedup();
    let local = |node: &Node, v: u32| declared.frame.to_local(node.mesh.vertices[v as usize] - declared.at);
    let radius = |node: &Node, v: u32| local(node, v).truncate().length();
    let (near, others): (Vec<u32>, Vec<u32>) =
        rim.iter().partition(|&&v| (radius(node, v) - outer).abs() <= ROUND * outer);
    let inner = others.iter().map(|&v| radius(node, v)).sum::<f64>() / others.len().max(1) as f64;
    let stray = others.iter().map(|&v| radius(node, v)).find(|r| (r - inner).abs() > ROUND * outer);
    if let Some(stray) = stray.or(near.is_empty().then_some(inner)) {
        let problem = format!("its rim has a corner {:.6} mm from the axis", 1e3 * stray);
        return Err(Problem::error(problem).expecting(format!("a rim on the circle of {:.6} mm", 1e3 * outer)));
    }
    for (ring, radius) in [(near, outer), (others, inner)] {
        for v in ring {
            let around = local(node, v).truncate().normalize_or_zero() * radius;
            let p = declared.shape.settle(around.extend(0.0));
            node.mesh.vertices[v as usize] = declared.at + declared.frame.to_world(p);
        }
    }
    Ok(inner)
}

/// An edge of an outline.
struct Edge {
    /// Corners in the sense of the face's triangle.
    from: [u32; 2],
    /// The triangle beyond.
    beyond: Option<u32>,
}

/// The triangle on the left of every directed edge of a node.
fn directed(node: &Node) -> HashMap<[u32; 2], u32> {
    let sides = |(t, [a, b, c]): (usize, &[u32; 3])| [[*a, *b], [*b, *c], [*c, *a]].map(|edge| (edge, t as u32));
    node.mesh.triangles.iter().enumerate().flat_map(sides).collect()
}

/// Edges between some triangles and the others.
fn outline(node: &Node, triangles: &[u32], directed: &HashMap<[u32; 2], u32>) -> Vec<Edge> {
    let own: HashSet<u32> = triangles.iter().copied().collect();
    let sides = triangles.iter().flat_map(|&t| {
        let [a, b, c] = node.mesh.triangles[t as usize];
        [[a, b], [b, c], [c, a]]
    });
    let edges = sides.map(|from| Edge { from, beyond: directed.get(&[from[1], from[0]]).copied() });
    edges.filter(|edge| edge.beyond.is_none_or(|beyond| !own.contains(&beyond))).collect()
}

/// Builds the faces of every node once all triangles have a part.
pub fn faces(shop: &mut Shop, assembly: &mut Assembly) {
    let mut all = Vec::new();
    for (index, node) in assembly.nodes.iter().enumerate() {
        let mut built = NodeFaces::default();
        if !node.exact.is_empty() {
            let mason = Mason { node, part_of: &assembly.part_of[assembly.first[index] as usize..], directed: directed(node) };
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
            let round = whole && declared.rim != Round::Polygon;
            if round && exact_of(beyond).is_some_and(|other| other.rim != Round::Polygon) {
                continue;
            }
            let sliver = match (&*shape, declared.rim) {
                (Shape::Cone { .. }, _) => Sliver::new(*chord, lift(Sweep::Azimuth, *chord), shape.clone()),
                (_, Round::Ring { .. }) if round => {
                    let radius = 0.5 * (chord[0].truncate().length() + chord[1].truncate().length());
                    let circle = Arc::new(Shape::Cone { radius, taper: 0.0 });
                    Sliver::new(*chord, lift(Sweep::Azimuth, *chord), circle)
                }
                _ => Sliver::new(*chord, DVec3::Z, shape.clone()),
            };
            built.faces.push(Face { at, frame, what: Patch::Sliver(sliver) });
            built.parts.push(self.part_of[beyond as usize]);
            built.areas.push(0.0);
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

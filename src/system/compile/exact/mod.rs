//! Exact faces: which triangles they stand for, and what they truly are.

pub mod mason;
mod outline;
mod walls;

use super::Shop;
use super::assembly::Assembly;
use super::configure::is_rigid;
use crate::error::Problem;
use crate::geometry::Frame;
use crate::geometry::exact::{Face, Shape};
use crate::system::document as written;
use crate::system::exact::{Declared, Round, shape};
use crate::system::gltf::Node;
use crate::system::select;
use glam::DVec3;
use outline::{directed, outline};
use std::collections::HashSet;

/// Exact faces of a node, the part of each, and the triangles they stand for.
#[derive(Debug, Default)]
pub struct NodeFaces {
    pub faces: Vec<Face>,
    pub parts: Vec<u32>,
    /// Area of the triangles that each stands for, m2; that of a sliver itself.
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
    for node in assembly.nodes.iter_mut().filter(|node| !node.is_element) {
        if !walls::round(node) {
            let problem =
                format!("the rim of a lens surface of `{}` stays a polygon: what borders it is not round", node.name);
            let hint = "leave out `semi_diameter`, or declare the edge with `exact: (form: Cylinder(..))`".to_owned();
            shop.fault("surfaces", Problem::warning(problem).hinting(hint));
        }
        settle(node);
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

/// Moves the corners of declared triangles onto their shapes, cones first: a corner that is on a cone and on a height ends up on
/// both, so that neighbouring outlines meet in points.
fn settle(node: &mut Node) {
    let is_cone = |declared: &&Declared| matches!(declared.shape, Shape::Cone { .. });
    let (cones, heights): (Vec<&Declared>, Vec<&Declared>) = node.exact.iter().partition(is_cone);
    for declared in cones.into_iter().chain(heights) {
        let mut corners: Vec<u32> = declared.triangles.iter().flat_map(|&t| node.mesh.triangles[t as usize]).collect();
        corners.sort_unstable();
        corners.dedup();
        for corner in corners {
            let vertex = &mut node.mesh.vertices[corner as usize];
            let settled = declared.shape.settle(declared.frame.to_local(*vertex - declared.at));
            *vertex = declared.at + declared.frame.to_world(settled);
        }
    }
}

/// What an entry declares of some triangles of a node.
fn declared(
    exact: &written::Exact,
    node: &mut Node,
    mut triangles: Vec<u32>,
    shift: DVec3,
) -> Result<Declared, Problem> {
    if !is_rigid(&node.moved) {
        let problem = Problem::error("it is scaled by `configure`, which would change this shape");
        return Err(problem.expecting("a node that is only moved and turned"));
    }
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
            return Err(Problem::error("no triangle lies that near to the shape")
                .hinting("`straylight fit` finds shapes".to_owned()));
        }
    }
    // Spheres and conics may go up to their equator and round it: their corners are judged by their distance alone.
    let closed = matches!(exact.form, written::Form::Sphere { .. } | written::Form::Conic { .. });
    let used = if closed { 0.0 } else { reach(&triangles, node) };
    let form = shape(&exact.form, exact.semi_diameter.map_or(used, |s| s.0))?;
    let far = triangles.iter().flat_map(|&t| corners(node, t)).map(|p| form.distance(p));
    let far = far.fold(0.0, |most: f64, d| if d.is_nan() { f64::INFINITY } else { most.max(d) });
    if far > rough {
        let problem = format!("its corners lie up to {:.3e} mm from this shape", 1e3 * far);
        return Err(Problem::error(problem).expecting(format!("at most {:.3e} mm", 1e3 * rough)).hinting(
            "`straylight fit` finds shapes; the sign: R > 0 if the centre lies towards +z of `axis`".to_owned(),
        ));
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
        // What is written of a face is written of where the file has it.
        written::Relative::World => {
            let at = node.moved.transform_point3(exact.vertex.0 - shift);
            let turned = |v: DVec3| node.moved.transform_vector3(v);
            (at, Frame::from_z_x(turned(exact.axis.0), turned(x)))
        }
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

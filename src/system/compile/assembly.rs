//! The geometry of all files, placed, named and numbered.

use super::configure::{self, Landmark};
use super::exact::NodeFaces;
use super::models::Finish;
use super::{Shop, alias};
use crate::error::Problem;
use crate::geometry::{Body, rotation};
use crate::system::document as written;
use crate::system::elements;
use crate::system::gltf::{self, GltfFile, Node};
use crate::system::select;
use glam::{DAffine3, DMat3, DVec3};
use std::collections::BTreeSet;
use std::path::Path;

/// Every node with triangles. Triangles are numbered through, node after node.
#[derive(Debug, Default)]
pub struct Assembly {
    /// Placed in the world, m; names unique.
    pub nodes: Vec<Node>,
    /// Which entry of `geometry` each node is from; `None` for elements.
    pub file_of: Vec<Option<usize>>,
    /// Frames of all nodes of the files and elements, world, m.
    pub landmarks: Vec<Landmark>,
    /// First triangle of each node.
    pub first: Vec<u32>,
    /// Centre of everything, world, m: the origin of scene coordinates.
    pub shift: DVec3,
    /// Largest distance of a vertex from the centre, m.
    pub radius: f64,
    /// Part of each triangle.
    pub part_of: Vec<u32>,
    /// Nodes that are solids of a medium.
    pub solid_nodes: Vec<usize>,
    /// Parts that no entry selects.
    pub unsaid: Vec<u32>,
    /// Exact faces of each node.
    pub exact: Vec<NodeFaces>,
    /// What the document says of each surface of the scene.
    pub finishes: Vec<Finish>,
}

/// Reads and places every geometry file, and does what the system says about its nodes.
pub fn read(shop: &mut Shop) -> Assembly {
    let mut assembly = Assembly::default();
    for (i, placed) in shop.document.system.geometry.iter().enumerate() {
        let Some(file) = shop.gltf(&placed.file, &format!("geometry[{i}].file")) else { continue };
        let solid = file.nodes.into_iter().filter(|node| !node.mesh.triangles.is_empty());
        assembly.nodes.extend(solid.map(|node| place(node, placed)));
        assembly.file_of.resize(assembly.nodes.len(), Some(i));
        let mark = |(path, map)| Landmark { file: Some(i), path, frame: frame(&map, placed) };
        assembly.landmarks.extend(file.frames.into_iter().map(mark));
    }
    for (name, element) in shop.document.system.elements.iter() {
        match elements::nodes(name, element) {
            Ok(nodes) => assembly.nodes.extend(nodes),
            Err(problem) => shop.fault(&format!("elements[{name:?}]"), problem),
        }
        let own = &assembly.nodes[assembly.file_of.len()..];
        let family = own.first().filter(|node| node.path != name).map(|node| (name.to_owned(), node.frame));
        let frames = own.iter().map(|node| (node.path.clone(), node.frame)).chain(family);
        assembly.landmarks.extend(frames.map(|(path, frame)| Landmark { file: None, path, frame }));
        assembly.file_of.resize(assembly.nodes.len(), None);
    }
    alias::rename(shop, &mut assembly);
    make_unique(&mut assembly.nodes);
    configure::configure(shop, &mut assembly);
    assembly.number();
    assembly
}

impl Shop<'_> {
    /// The content of a glTF file that is named at a path of the document; what is wrong with it is noted.
    pub fn gltf(&mut self, written: &Path, path: &str) -> Option<GltfFile> {
        let file = match gltf::read(&self.document.resolve(written)) {
            Ok(file) => file,
            Err(problems) => {
                self.problems.extend(problems);
                return None;
            }
        };
        self.problems.extend_from_slice(&file.warnings);
        for read in &file.files {
            // Buffers lie beside the file, which may be in another folder than one of the same name.
            let name = written.with_file_name(read.file_name().unwrap_or_default()).display().to_string();
            match std::fs::read(read) {
                Ok(bytes) => self.input(&name, &bytes),
                Err(error) => self.fault(path, Problem::error(format!("{name}: {error}"))),
            }
        }
        Some(file)
    }
}

/// Turned by `up`, then by `rotate`.
fn turn(placed: &written::Geometry) -> DMat3 {
    let up = match placed.up {
        written::Up::Y => DMat3::from_cols(DVec3::X, DVec3::Z, -DVec3::Y),
        written::Up::Stored | written::Up::Z => DMat3::IDENTITY,
    };
    // Identity factors are skipped: a rotation by zero must not cost a digit.
    if placed.rotate.0 == DVec3::ZERO { up } else { rotation(placed.rotate.0) * up }
}

/// Scaled by the unit, turned, then moved.
pub(super) fn place(mut node: Node, placed: &written::Geometry) -> Node {
    let turn = turn(placed);
    let unit = placed.unit.0;
    for vertex in &mut node.mesh.vertices {
        *vertex = turn * (unit * *vertex) + placed.at.0;
    }
    node.frame = frame(&node.frame, placed);
    node.mesh.tolerance *= unit;
    node.mesh.topology.area *= unit * unit;
    node.mesh.topology.volume *= unit * unit * unit;
    node
}

/// The frame of a node of a file, placed. The unit scales what is written in the node's coordinates as well, so it is no part of it.
fn frame(frame: &DAffine3, placed: &written::Geometry) -> DAffine3 {
    let turn = turn(placed);
    let origin = turn * (placed.unit.0 * frame.translation) + placed.at.0;
    DAffine3::from_mat3_translation(turn * frame.matrix3, origin)
}

/// Names that occur twice become their paths, and those get numbers if they still do.
pub(super) fn make_unique(nodes: &mut [Node]) {
    let taken = |nodes: &[Node], i: usize, name: &str| nodes.iter().enumerate().any(|(j, n)| j != i && n.name == name);
    let twice: Vec<usize> = (0..nodes.len()).filter(|&i| taken(nodes, i, &nodes[i].name.clone())).collect();
    for i in twice {
        let mut name = nodes[i].path.clone();
        let mut number = 2;
        while taken(nodes, i, &name) {
            name = format!("{}#{number}", nodes[i].path);
            number += 1;
        }
        nodes[i].name = name;
    }
}

impl Assembly {
    fn number(&mut self) {
        let vertices = || self.nodes.iter().flat_map(|node| &node.mesh.vertices);
        let (low, high) = vertices().fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(l, h), v| (l.min(*v), h.max(*v)));
        if low.x <= high.x {
            self.shift = 0.5 * (low + high);
        }
        self.radius = vertices().map(|v| (*v - self.shift).length()).fold(0.0, f64::max);
        let shift = self.shift;
        let mut next = 0;
        for node in &mut self.nodes {
            node.mesh.vertices.iter_mut().for_each(|vertex| *vertex -= shift);
            node.exact.iter_mut().for_each(|declared| declared.at -= shift);
            node.frame.translation -= shift;
            let [there, back] = [shift, -shift].map(DAffine3::from_translation);
            node.moved = if node.moved == DAffine3::IDENTITY { node.moved } else { back * node.moved * there };
            self.first.push(next);
            next += node.mesh.triangles.len() as u32;
        }
        self.part_of = vec![0; next as usize];
    }

    /// Names of all nodes.
    pub fn names(&self) -> Vec<String> {
        self.nodes.iter().map(|node| node.name.clone()).collect()
    }

    /// Nodes whose name or path matches a glob.
    pub fn matching(&self, glob: &str) -> Vec<usize> {
        (0..self.nodes.len()).filter(|&i| select::named(glob, &self.nodes[i])).collect()
    }

    /// Number and corners (scene coordinates, m) of every triangle of a node.
    pub fn triangles_of(&self, node: usize) -> impl Iterator<Item = (u32, [DVec3; 3])> + '_ {
        let mesh = &self.nodes[node].mesh;
        (0..mesh.triangles.len()).map(move |i| (self.first[node] + i as u32, mesh.corners(i)))
    }

    /// Parts that nodes consist of.
    pub fn parts_of(&self, nodes: &[usize]) -> Vec<usize> {
        let ids =
            nodes.iter().flat_map(|&node| self.triangles_of(node)).map(|(id, _)| self.part_of[id as usize] as usize);
        let mut parts: Vec<usize> = ids.collect();
        parts.sort_unstable();
        parts.dedup();
        parts
    }

    /// Whether a ball of radius `reach` (m) about `at` (scene coordinates) keeps out of the boxes of all solids.
    pub fn clear_of_solids(&self, at: DVec3, reach: f64) -> bool {
        self.solid_nodes.iter().filter_map(|&node| self.nodes[node].mesh.bounds()).all(|[low, high]| {
            let nearest = at.clamp(low, high);
            (nearest - at).length() > reach
        })
    }

    /// Number and area (m2) of everything that light can meet on a node: the triangles that are met, then the exact faces.
    pub fn met_on(&self, node: usize) -> Vec<(u32, f64)> {
        let exact = &self.exact[node];
        let replaced: BTreeSet<u32> = exact.replaced.iter().map(|t| self.first[node] + t).collect();
        let mesh = &self.nodes[node].mesh;
        let triangles = (0..mesh.triangles.len()).map(|i| (self.first[node] + i as u32, mesh.area(i)));
        let before: usize = self.exact[..node].iter().map(|exact| exact.faces.len()).sum();
        let faces = exact.areas.iter().enumerate();
        let faces = faces.map(|(i, area)| ((self.part_of.len() + before + i) as u32, *area));
        triangles.filter(|(id, _)| !replaced.contains(id)).chain(faces).collect()
    }

    /// The part of every triangle, then of every exact face, as the scene numbers them.
    pub fn all_parts(&self) -> Vec<u32> {
        let faces = self.exact.iter().flat_map(|exact| &exact.parts);
        self.part_of.iter().chain(faces).copied().collect()
    }

    /// What the tree of boxes is built from.
    pub fn bodies(&self) -> Vec<Body<'_>> {
        let body = self.nodes.iter().zip(&self.exact).map(|(node, exact)| Body {
            vertices: &node.mesh.vertices,
            triangles: &node.mesh.triangles,
            tolerance: node.mesh.tolerance,
            faces: &exact.faces,
            replaced: &exact.replaced,
        });
        body.collect()
    }
}

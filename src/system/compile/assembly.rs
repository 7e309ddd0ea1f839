//! The geometry of all files, placed, named and numbered.

use super::Shop;
use super::exact::NodeFaces;
use crate::error::Problem;
use crate::geometry::Body;
use crate::system::document as written;
use crate::system::elements;
use crate::system::gltf::{self, Node};
use crate::system::select;
use glam::{DAffine3, DMat3, DVec3};

/// Every node with triangles. Triangles are numbered through, node after node.
#[derive(Debug, Default)]
pub struct Assembly {
    /// Placed in the world, m; names unique.
    pub nodes: Vec<Node>,
    /// Which entry of `geometry` each node is from; `None` for elements.
    pub file_of: Vec<Option<usize>>,
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
}

/// Reads and places every geometry file.
pub fn read(shop: &mut Shop) -> Assembly {
    let mut assembly = Assembly::default();
    for (i, placed) in shop.document.system.geometry.iter().enumerate() {
        let path = shop.document.resolve(&placed.file);
        let file = match gltf::read(&path) {
            Ok(file) => file,
            Err(problems) => {
                shop.problems.extend(problems);
                continue;
            }
        };
        shop.problems.extend(file.warnings);
        for read in &file.files {
            let name = read.file_name().map_or(String::new(), |name| name.to_string_lossy().into_owned());
            match std::fs::read(read) {
                Ok(bytes) => shop.input(&name, &bytes),
                Err(error) => shop.fault(&format!("geometry[{i}].file"), Problem::error(format!("{name}: {error}"))),
            }
        }
        let solid = file.nodes.into_iter().filter(|node| !node.mesh.triangles.is_empty());
        assembly.nodes.extend(solid.map(|node| place(node, placed)));
        assembly.file_of.resize(assembly.nodes.len(), Some(i));
    }
    for (name, element) in shop.document.system.elements.iter() {
        match elements::nodes(name, element) {
            Ok(nodes) => assembly.nodes.extend(nodes),
            Err(problem) => shop.fault(&format!("elements[{name:?}]"), problem),
        }
        assembly.file_of.resize(assembly.nodes.len(), None);
    }
    make_unique(&mut assembly.nodes);
    assembly.number();
    assembly
}

/// Scaled by the unit, turned by `up`, then by `rotate`, then moved.
pub(super) fn place(mut node: Node, placed: &written::Geometry) -> Node {
    let up = match placed.up {
        written::Up::Y => DMat3::from_cols(DVec3::X, DVec3::Z, -DVec3::Y),
        written::Up::Stored | written::Up::Z => DMat3::IDENTITY,
    };
    let angles = placed.rotate.0;
    // Identity factors are skipped: a rotation by zero must not cost a digit.
    let turn = if angles == DVec3::ZERO {
        up
    } else {
        DMat3::from_rotation_z(angles.z) * DMat3::from_rotation_y(angles.y) * DMat3::from_rotation_x(angles.x) * up
    };
    for vertex in &mut node.mesh.vertices {
        *vertex = turn * (placed.unit.0 * *vertex) + placed.at.0;
    }
    let unit = placed.unit.0;
    // The unit scales what is written in the node's coordinates as well, so it is no part of the frame.
    let origin = turn * (unit * node.frame.translation) + placed.at.0;
    node.frame = DAffine3::from_mat3_translation(turn * node.frame.matrix3, origin);
    node.mesh.tolerance *= unit;
    node.mesh.topology.area *= unit * unit;
    node.mesh.topology.volume *= unit * unit * unit;
    node
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

//! What was understood: the facts that `straylight check` prints before a ray is traced.

mod beam;
mod budget;
mod contact;
mod doubt;
mod optics;

use super::assembly::Assembly;
use crate::geometry::mesh::Topology;
use crate::scene::{Part, Scene};
use crate::settings::Settings;
use crate::system::document::Document;
use glam::DVec3;

pub use beam::Beam;
pub use budget::{ANGLES, Budget, Share};
pub(super) use contact::contacts;
pub(super) use doubt::doubts;
pub use optics::Optics;

/// Facts about a compiled system, in the order of its nodes, parts and sources.
#[derive(Clone, Debug)]
pub struct Understanding {
    /// Least and greatest corner of everything, world, m.
    pub bounds: [DVec3; 2],
    pub nodes: Vec<NodeFacts>,
    pub parts: Vec<PartFacts>,
    /// Where light goes on every surface, once for each pair of media that it lies between.
    pub budgets: Vec<Budget>,
    pub beams: Vec<Beam>,
    /// First-order data of the elements, or why there are none; `None` without lenses and mirrors among them.
    pub optics: Option<Result<Optics, String>>,
    pub memory: Memory,
}

/// One node with triangles.
#[derive(Clone, Debug)]
pub struct NodeFacts {
    pub name: String,
    /// glTF materials.
    pub tags: Vec<String>,
    pub triangles: usize,
    pub topology: Topology,
    /// What fills it, if it is a solid of a medium.
    pub medium: Option<String>,
    /// Closed nodes that it lies in.
    pub inside: Vec<String>,
    /// Closed nodes that some of it lies in.
    pub partly: Vec<String>,
    /// Nodes whose faces lie on its own.
    pub touches: Vec<String>,
}

/// One part: triangles of a node with the same finish.
#[derive(Clone, Debug)]
pub struct PartFacts {
    pub label: String,
    pub triangles: usize,
    /// m2
    pub area: f64,
    /// Labels of the surfaces that light meets at its front and at its back.
    pub surfaces: [String; 2],
    /// Names of the media in front and behind; a solid is taken to be surrounded by the ambient medium.
    pub media: [String; 2],
    /// True if no entry selects it.
    pub by_default: bool,
}

/// Bytes that a run will hold, estimated.
#[derive(Clone, Copy, Debug)]
pub struct Memory {
    /// Triangles and the tree over them.
    pub geometry: usize,
    /// Live sums of one thread.
    pub thread: usize,
    /// Finished batches that wait to be folded, at most.
    pub batches: usize,
}

/// Collects the facts. Some thousand rays per source and up to 1e5 in all are traced to see what touches and what holds what.
pub(super) fn understand(
    scene: &Scene,
    assembly: &Assembly,
    settings: &Settings,
    document: &Document,
) -> Understanding {
    let [low, high] = scene.geometry.bounds();
    Understanding {
        bounds: [low + scene.shift, high + scene.shift],
        nodes: nodes(scene, assembly),
        parts: parts(scene, assembly),
        budgets: budget::budgets(scene),
        beams: scene.sources.iter().map(|source| beam::beam(scene, source)).collect(),
        optics: optics::optics(scene, document),
        memory: memory(scene, settings),
    }
}

fn nodes(scene: &Scene, assembly: &Assembly) -> Vec<NodeFacts> {
    let contacts = contact::contacts(scene);
    let names = |nodes: Vec<u32>| nodes.into_iter().map(|node| assembly.nodes[node as usize].name.clone()).collect();
    let fact = |(index, node): (usize, &crate::system::gltf::Node)| {
        let touching = contact::touching(scene, &contacts, index as u32);
        let [inside, partly] = contact::holders(scene, assembly, index, &touching);
        let solid = scene.solids.iter().find(|solid| solid.label == node.name);
        NodeFacts {
            name: node.name.clone(),
            tags: node.tags.iter().filter(|tag| !tag.is_empty()).cloned().collect(),
            triangles: node.mesh.triangles.len(),
            topology: node.mesh.topology,
            medium: solid.map(|solid| scene.media[solid.medium as usize].label.clone()),
            inside: names(inside),
            partly: names(partly),
            touches: names(touching),
        }
    };
    assembly.nodes.iter().enumerate().map(fact).collect()
}

fn parts(scene: &Scene, assembly: &Assembly) -> Vec<PartFacts> {
    let mut triangles = vec![0; scene.parts.len()];
    let mut area = vec![0.0; scene.parts.len()];
    for (triangle, &part) in scene.part_of.iter().enumerate().take(scene.geometry.len()) {
        triangles[part as usize] += 1;
        area[part as usize] += scene.geometry.area(triangle as u32);
    }
    let fact = |(index, part): (usize, &Part)| PartFacts {
        label: part.label.clone(),
        triangles: triangles[index],
        area: area[index],
        surfaces: part.surface[0].map(|surface| scene.surfaces[surface as usize].label.clone()),
        media: scene.sides(part).map(|medium| scene.media[medium as usize].label.clone()),
        by_default: assembly.unsaid.contains(&(index as u32)),
    };
    scene.parts.iter().enumerate().map(fact).collect()
}

fn memory(scene: &Scene, settings: &Settings) -> Memory {
    let slots = scene.layout(settings.paths).len();
    // Most rays of a batch feed the same few slots; sixteen of their own each is plenty.
    let touched = slots.min(16 * settings.batch_rays() as usize);
    Memory {
        geometry: scene.geometry.bytes() + 4 * scene.part_of.len(),
        thread: 20 * slots,
        batches: 64 * 32 * touched,
    }
}

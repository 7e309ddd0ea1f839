//! Reading glTF 2.0 (.gltf and .glb): named parts made of world-space triangles in f64 metres.
//!
//! The document is checked as a whole before a vertex is read (`validate`), buffers come from the file itself or from
//! beside it (`uri`), the node tree is flattened in f64 (`scene`, `transform`), and each node with a mesh becomes one
//! welded `Mesh` (`part`). Instances are copied, mirrored nodes keep their front outside.
//!
//! Left out: lines and points, skins, morph targets, animations, compressed geometry; each is said.

mod accessor;
mod container;
mod document;
mod extension;
mod layout;
mod part;
mod scene;
mod transform;
mod uri;
mod validate;
mod write;

use crate::error::{Problem, Severity};
use crate::geometry::mesh::{Mesh, Repairs};
use crate::system::exact::Declared;
use accessor::Store;
use container::Container;
use document::Root;
use glam::{DAffine3, DVec3};
use std::borrow::Cow;
use std::path::{Path, PathBuf};
pub use write::glb;

/// Triangles read from one file at most, all instances counted: 36 bytes each, and ids of 32 bits above.
const MOST_TRIANGLES: usize = 1 << 25;
/// Vertices read from one file at most, all instances counted.
const MOST_VERTICES: usize = 3 * MOST_TRIANGLES;
/// Problems of one kind that are listed one by one.
const MOST_PROBLEMS: usize = 20;

/// What a glTF file holds.
#[derive(Debug)]
pub struct GltfFile {
    /// Nodes that carry a mesh, in document order.
    pub nodes: Vec<Node>,
    /// Path and map to the world (m) of every node of the scene, also of those without a mesh.
    pub frames: Vec<(String, DAffine3)>,
    pub warnings: Vec<Problem>,
    /// Every file that was read: the glTF itself and its buffers.
    pub files: Vec<PathBuf>,
}

/// A part: one node with a mesh.
#[derive(Clone, Debug)]
pub struct Node {
    /// As written; the mesh's name if the node has none, `node7` if neither has.
    pub name: String,
    /// Names from the root, `root/child`; unique in the file by a suffix `#2`. Long names are shortened.
    pub path: String,
    /// Number of the node in the file.
    pub index: u32,
    /// The node's custom properties, over those of its mesh; `Null` without any.
    pub extras: serde_json::Value,
    /// World coordinates, m; labels are indices into `tags`.
    pub mesh: Mesh,
    /// Names of the materials in use; "" for none.
    pub tags: Vec<String>,
    /// Triangles in the file, before welding dropped any.
    pub read: usize,
    pub repairs: Repairs,
    /// From the node's coordinates to the world.
    pub frame: DAffine3,
    /// What some of its triangles truly are.
    pub exact: Vec<Declared>,
    /// A name in `media`, if the node brings one with it.
    pub medium: Option<String>,
    /// True if it was written in the system: its tags name its faces.
    pub is_element: bool,
    /// How it was moved after it was placed, in the coordinates of the mesh: from where the file has it to where it is, m.
    pub moved: DAffine3,
}

impl Node {
    /// Name of the material of triangle `i`, "" for none.
    pub fn tag(&self, i: usize) -> &str {
        &self.tags[self.mesh.labels[i] as usize]
    }

    /// The mesh where the file has it.
    pub fn at_rest(&self) -> Cow<'_, Mesh> {
        if self.moved == DAffine3::IDENTITY {
            return Cow::Borrowed(&self.mesh);
        }
        let mut mesh = self.mesh.clone();
        mesh.transform(&self.moved.inverse());
        Cow::Owned(mesh)
    }

    /// Corners of triangle `i`, m, counter-clockwise seen from outside.
    pub fn triangle(&self, i: usize) -> [DVec3; 3] {
        self.mesh.corners(i)
    }
}

/// Reads a file; on failure every problem that could be found, with at least one error. Never blocks on a pipe, never
/// reads outside the folder of `path`. 1e6 triangles take some 1.2 s and 160 bytes each at the peak.
pub fn read(path: &Path) -> Result<GltfFile, Vec<Problem>> {
    let here = |problems: Vec<Problem>| problems.into_iter().map(|problem| problem.in_file(path)).collect();
    let mut file = open(path).map_err(|problems| here(few(problems)))?;
    file.warnings = here(few(std::mem::take(&mut file.warnings)));
    Ok(file)
}

fn open(path: &Path) -> Result<GltfFile, Vec<Problem>> {
    let mut container = Container::read(path).map_err(|problem| vec![problem])?;
    let root = container.document().map_err(|problem| vec![problem])?;
    let mut warnings = std::mem::take(&mut container.warnings);
    let problems = validate::check(&root);
    if problems.iter().any(|problem| problem.severity == Severity::Error) {
        return Err(problems);
    }
    warnings.extend(problems);
    let scene::Flat { placed, frames } = scene::flatten(&root, &mut warnings)?;
    bearable(&root, &placed)?;
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let bin = container.bin.clone().map(|range| &container.bytes[range]);
    let store = Store::load(&root, bin, folder)?;
    warnings.extend(unmoved(&root, &placed));
    let nodes = parts(&store, &placed, &mut warnings)?;
    warnings.extend(repaired(&nodes));
    if nodes.iter().all(|node| node.mesh.triangles.is_empty()) {
        warnings.push(Problem::warning("contains no triangle with an area"));
    }
    let files = std::iter::once(path.to_owned()).chain(store.files).collect();
    Ok(GltfFile { nodes, frames, warnings, files })
}

fn parts(store: &Store, placed: &[scene::Placed], warnings: &mut Vec<Problem>) -> Result<Vec<Node>, Vec<Problem>> {
    let (mut nodes, mut problems) = (Vec::new(), Vec::new());
    let mut told = vec![false; store.root.meshes.len()];
    for placed in placed {
        let mut said = Vec::new();
        match part::read(store, placed, &mut said) {
            Ok(node) => nodes.push(node),
            Err(problem) => problems.push(on_node(problem, placed.node, scene::name(store.root, placed.node))),
        }
        if !std::mem::replace(&mut told[placed.mesh], true) {
            warnings.append(&mut said); // What is said of a mesh is said once, not per instance.
        }
        if problems.len() > MOST_PROBLEMS {
            break;
        }
    }
    if problems.is_empty() { Ok(nodes) } else { Err(problems) }
}

/// Refuses what would not fit in memory, before anything is allocated.
fn bearable(root: &Root, placed: &[scene::Placed]) -> Result<(), Vec<Problem>> {
    let count = |accessor: u32| root.accessors[accessor as usize].count.0;
    let (mut corners, mut vertices) = (0u64, 0u64);
    for primitive in placed.iter().flat_map(|placed| &root.meshes[placed.mesh].primitives) {
        let positions = primitive.attributes.get("POSITION").map_or(0, |&accessor| count(accessor));
        let uses = primitive.indices.map_or(positions, count);
        // A strip or fan makes one triangle per index, a list one per three.
        let weight = if primitive.mode == gltf::json::mesh::TRIANGLES { 1 } else { 3 };
        corners = corners.saturating_add(uses.saturating_mul(weight));
        let sparse = primitive.attributes.get("POSITION").is_some_and(|&a| root.accessors[a as usize].sparse.is_some());
        // Of a large accessor only the vertices in use are read, unless it is sparse.
        vertices = vertices.saturating_add(if sparse { positions } else { positions.min(uses.saturating_mul(2)) });
    }
    let most = MOST_VERTICES as u64;
    if corners <= most && vertices <= most {
        return Ok(());
    }
    let problem = format!("makes {} triangles of {vertices} vertices, all instances counted", corners / 3);
    Err(vec![Problem::error(problem).expecting(format!("at most {MOST_TRIANGLES} triangles"))])
}

/// Warnings for what would move vertices and is not followed.
fn unmoved(root: &Root, placed: &[scene::Placed]) -> Vec<Problem> {
    let mut warnings = Vec::new();
    if !root.animations.is_empty() {
        warnings.push(Problem::warning("animations are ignored: nodes stay where they are at rest").on("animations"));
    }
    for placed in placed {
        let (node, mesh) = (&root.nodes[placed.node], &root.meshes[placed.mesh]);
        let problem = if node.skin.is_some() {
            "is deformed by a skin, which is ignored: its vertices may be elsewhere"
        } else if mesh.primitives.iter().any(|primitive| !primitive.targets.is_empty()) {
            match node.weights.as_ref().or(mesh.weights.as_ref()) {
                Some(weights) if weights.iter().any(|w| *w != 0.0) => "has morph weights, which are ignored",
                _ => "has morph targets, which are ignored",
            }
        } else {
            continue;
        };
        warnings.push(on_node(Problem::warning(problem), placed.node, scene::name(root, placed.node)));
    }
    warnings
}

/// What welding dropped and moved, summed over the file.
fn repaired(nodes: &[Node]) -> Vec<Problem> {
    let tell = |count: fn(&Node) -> usize, what: &str| {
        let (total, mut where_) = (nodes.iter().map(count).sum::<usize>(), nodes.iter().filter(|n| count(n) > 0));
        let first = where_.next()?;
        let more = where_.count();
        let more = if more > 0 { format!(" and {more} more nodes") } else { String::new() };
        Some(Problem::warning(format!("{what}: {total}, in `{}`{more}", first.path)))
    };
    [
        tell(|n| n.repairs.degenerate, "triangles without area, dropped"),
        tell(|n| n.repairs.duplicate, "triangles that occur twice, dropped once"),
        tell(|n| n.repairs.closed_up, "vertices on open edges, joined within rounding"),
    ]
    .into_iter()
    .flatten()
    .collect()
}

/// Names the node in the path of a problem.
fn on_node(problem: Problem, index: usize, name: Option<&str>) -> Problem {
    let node = match name {
        Some(name) => format!("nodes[{index}] `{}`", shorten(name)),
        None => format!("nodes[{index}]"),
    };
    let path = if problem.path.is_empty() { node } else { format!("{node}: {}", problem.path) };
    problem.on(path)
}

/// The first problems, and how many more there are.
fn few(mut problems: Vec<Problem>) -> Vec<Problem> {
    if problems.len() > MOST_PROBLEMS {
        problems.sort_by_key(|problem| problem.severity != Severity::Error);
        let more = problems.len() - MOST_PROBLEMS;
        problems.truncate(MOST_PROBLEMS);
        problems.push(Problem::warning(format!("{more} more problems are not listed")));
    }
    problems
}

/// Text from a file as it may stand in a message: at most 80 characters, none of which moves the cursor.
fn shorten(text: &str) -> String {
    let plain = |c: char| if c.is_control() { '\u{fffd}' } else { c };
    let short: String = text.chars().take(80).map(plain).collect();
    if short.len() < text.len() { format!("{short}...") } else { short }
}

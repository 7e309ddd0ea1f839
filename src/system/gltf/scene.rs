//! The node graph: strict trees, walked without recursion, flattened to one entry per node that carries a mesh.

use super::document::Root;
use super::validate::within;
use super::{shorten, transform};
use crate::error::Problem;
use glam::DAffine3;
use std::collections::HashMap;

/// Bytes that the paths of all nodes may take together; a real scene needs a thousandth of it.
const MOST_PATH_BYTES: usize = 1 << 26;

/// A node that carries a mesh, placed in the world.
#[derive(Debug)]
pub struct Placed {
    pub node: usize,
    pub mesh: usize,
    /// Names from the root, joined by `/`; made unique by a suffix `#2`, `#3` ...
    pub path: String,
    pub world: DAffine3,
}

/// A scene without its tree.
#[derive(Debug, Default)]
pub struct Flat {
    /// Nodes with meshes, in document order.
    pub placed: Vec<Placed>,
    /// Path and map to the world of all nodes.
    pub frames: Vec<(String, DAffine3)>,
}

/// The scene that is shown.
pub fn flatten(root: &Root, warnings: &mut Vec<Problem>) -> Result<Flat, Vec<Problem>> {
    let parents = parents(root)?;
    let roots = roots(root, &parents, warnings)?;
    let (flat, reached) = walk(root, &roots)?;
    let lost = (0..root.nodes.len()).filter(|&i| !reached[i] && root.nodes[i].mesh.is_some());
    if let Some(first) = lost.clone().next() {
        let problem = format!("{} nodes with meshes are not in the scene and are left out", lost.count());
        warnings.push(Problem::warning(problem).on(format!("nodes[{first}]")));
    }
    Ok(flat)
}

/// The parent of each node; refuses references to nowhere, second parents and cycles.
fn parents(root: &Root) -> Result<Vec<Option<usize>>, Vec<Problem>> {
    let len = root.nodes.len();
    let mut parents = vec![None; len];
    let mut problems = Vec::new();
    for (i, node) in root.nodes.iter().enumerate() {
        for (k, &child) in node.children.iter().enumerate() {
            let path = format!("nodes[{i}].children[{k}]");
            match within(child as usize, len, &path) {
                Err(problem) => problems.push(problem),
                Ok(child) => match parents[child].replace(i) {
                    None => {}
                    Some(other) => problems.push(
                        Problem::error(format!("node {child} is already a child of node {other}"))
                            .on(path)
                            .expecting("one parent per node"),
                    ),
                },
            }
        }
    }
    if problems.is_empty() {
        problems.extend(cycle(&parents));
    }
    if problems.is_empty() { Ok(parents) } else { Err(problems) }
}

/// Follows the parents upwards from every node; each node is passed once.
fn cycle(parents: &[Option<usize>]) -> Option<Problem> {
    const NEW: usize = usize::MAX;
    let mut seen = vec![NEW; parents.len()];
    for start in 0..parents.len() {
        let mut at = Some(start);
        while let Some(node) = at.filter(|&node| seen[node] == NEW) {
            seen[node] = start;
            at = parents[node];
        }
        if let Some(node) = at.filter(|&node| seen[node] == start) {
            return Some(Problem::error("is its own ancestor").on(format!("nodes[{node}]")));
        }
    }
    None
}

/// The roots of the scene to show: the default scene, or the first, or without scenes every node without parent.
fn roots(root: &Root, parents: &[Option<usize>], warnings: &mut Vec<Problem>) -> Result<Vec<usize>, Vec<Problem>> {
    let number = root.scene.map_or(0, |scene| scene as usize);
    if root.scenes.is_empty() && root.scene.is_none() {
        return Ok((0..parents.len()).filter(|&i| parents[i].is_none()).collect());
    }
    let scene = &root.scenes[within(number, root.scenes.len(), "scene").map_err(|problem| vec![problem])?];
    if root.scenes.len() > 1 {
        let problem = format!("only scene {number} of {} is read", root.scenes.len());
        warnings.push(Problem::warning(problem).on("scenes"));
    }
    let mut seen = vec![false; parents.len()];
    let mut problems = Vec::new();
    let mut roots = Vec::new();
    for (k, node) in scene.nodes.iter().enumerate() {
        let path = format!("scenes[{number}].nodes[{k}]");
        let node = match within(node.value(), parents.len(), &path) {
            Ok(node) => node,
            Err(problem) => {
                problems.push(problem);
                continue;
            }
        };
        match parents[node] {
            Some(parent) => {
                let problem = format!("node {node} is also a child of node {parent}");
                problems.push(Problem::error(problem).on(path).expecting("root nodes only"));
            }
            None if seen[node] => problems.push(Problem::error(format!("node {node} is listed twice")).on(path)),
            None => roots.push(node),
        }
        seen[node] = true;
    }
    if problems.is_empty() { Ok(roots) } else { Err(problems) }
}

/// Depth first, children in order; also returns which nodes were reached.
fn walk(root: &Root, roots: &[usize]) -> Result<(Flat, Vec<bool>), Vec<Problem>> {
    let mut names = Names::default();
    let mut reached = vec![false; root.nodes.len()];
    let (mut flat, mut problems) = (Flat::default(), Vec::new());
    // (node, map of its parent, length of the path up to its parent)
    let mut stack: Vec<(usize, DAffine3, usize)> = roots.iter().rev().map(|&i| (i, DAffine3::IDENTITY, 0)).collect();
    let mut path = String::new();
    while let Some((i, parent, keep)) = stack.pop() {
        let node = &root.nodes[i];
        reached[i] = true;
        let own = transform::of(node).unwrap_or_else(|problem| {
            problems.push(super::on_node(problem, i, node.name.as_deref()));
            DAffine3::IDENTITY
        });
        let world = parent * own;
        path.truncate(keep);
        if keep > 0 {
            path.push('/');
        }
        path.push_str(&label(root, i));
        match node.mesh.map(|mesh| within(mesh as usize, root.meshes.len(), "mesh")) {
            None => {
                names.bytes += path.len();
                flat.frames.push((path.clone(), world));
            }
            Some(Ok(mesh)) => {
                let path = names.unique(&path);
                flat.frames.push((path.clone(), world));
                flat.placed.push(Placed { node: i, mesh, path, world });
            }
            Some(Err(problem)) => problems.push(super::on_node(problem, i, node.name.as_deref())),
        }
        if names.bytes > MOST_PATH_BYTES || path.len() > MOST_PATH_BYTES {
            return Err(vec![Problem::error("paths of all nodes add up to more than 64 MB").on("nodes")]);
        }
        let here = path.len();
        stack.extend(node.children.iter().rev().map(|&child| (child as usize, world, here)));
    }
    if problems.is_empty() { Ok((flat, reached)) } else { Err(problems) }
}

/// What a node is called in its path: its name, or its mesh's, or its number.
fn label(root: &Root, i: usize) -> String {
    name(root, i).map_or_else(|| format!("node{i}"), shorten)
}

/// The name of a node, or else of its mesh.
pub fn name(root: &Root, i: usize) -> Option<&str> {
    let node = &root.nodes[i];
    let mesh = || root.meshes.get(node.mesh? as usize)?.name.as_deref();
    node.name.as_deref().filter(|name| !name.is_empty()).or_else(mesh).filter(|name| !name.is_empty())
}

/// Paths given out so far.
#[derive(Default)]
struct Names {
    given: HashMap<String, usize>,
    bytes: usize,
}

impl Names {
    fn unique(&mut self, path: &str) -> String {
        let mut unique = path.to_owned();
        while self.given.contains_key(&unique) {
            // Counts on from the last suffix given, so that a thousand equal names stay cheap.
            let count = self.given.get_mut(path).map_or(2, |count| {
                *count += 1;
                *count
            });
            unique = format!("{path}#{count}");
        }
        self.bytes += unique.len();
        self.given.insert(unique.clone(), 1);
        unique
    }
}

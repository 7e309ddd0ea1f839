//! One placed node: its primitives read, moved to the world, and welded into one mesh.

use super::accessor::{MOST_METRES, Positions, Store};
use super::document::Primitive;
use super::scene::{self, Placed};
use super::{Node, transform};
use crate::error::Problem;
use crate::geometry::mesh::Mesh;
use glam::{DAffine3, DVec3};
use gltf::json;
use gltf::json::mesh::{TRIANGLE_FAN, TRIANGLE_STRIP, TRIANGLES};
use std::collections::BTreeMap;

/// The primitives of a node, not yet welded.
#[derive(Default)]
struct Soup {
    vertices: Vec<DVec3>,
    triangles: Vec<[u32; 3]>,
    labels: Vec<u16>,
    tags: Vec<String>,
    /// Where the vertices of a POSITION accessor start: primitives often share one.
    read: BTreeMap<u32, u32>,
    /// Largest stored coordinate and largest half step of an integer encoding, in the units of the node.
    reach: f64,
    half_step: f64,
}

/// Reads and welds the mesh of a node. Problems carry the place within the file.
pub fn read(store: &Store, placed: &Placed, warnings: &mut Vec<Problem>) -> Result<Node, Problem> {
    let mesh = &store.root.meshes[placed.mesh];
    let node = &store.root.nodes[placed.node];
    let mut soup = Soup::default();
    for (j, primitive) in mesh.primitives.iter().enumerate() {
        let place = format!("meshes[{}].primitives[{j}]", placed.mesh);
        let context = |problem: Problem| {
            let path = if problem.path.is_empty() { place.clone() } else { format!("{place}: {}", problem.path) };
            problem.on(path)
        };
        warnings.extend(soup.add(store, primitive).map_err(context)?.map(context));
    }
    let map = placed.world;
    // Stored coordinates are off by half a unit in the last place of an f32 (2^-24 of the value, 2^-23 for the distance
    // in space) or half a step; the f64 transform adds some 2^-50 of what it makes.
    let stored = (soup.reach * 2f64.powi(-23)).max(soup.half_step) * transform::stretch(&map);
    for vertex in &mut soup.vertices {
        *vertex = map.transform_point3(*vertex);
    }
    let reach = soup.vertices.iter().fold(0f64, |most, v| most.max(v.abs().max_element()));
    // A chain of large scales can overflow, and `max` passes over NaN.
    if reach > MOST_METRES || !stored.is_finite() || !soup.vertices.iter().all(|v| v.is_finite()) {
        let problem = Problem::error(format!("is placed {reach:e} m from the origin"));
        return Err(problem.expecting("coordinates below 4.5e13 m"));
    }
    if map.matrix3.determinant() < 0.0 {
        soup.triangles.iter_mut().for_each(|[_, b, c]| std::mem::swap(b, c));
    }
    let before = soup.triangles.len();
    let tolerance = stored + reach * 2f64.powi(-50);
    let (welded, repairs) = Mesh::weld(soup.vertices, soup.triangles, soup.labels, tolerance);
    Ok(Node {
        name: scene::name(store.root, placed.node).map_or_else(|| format!("node{}", placed.node), str::to_owned),
        path: placed.path.clone(),
        index: placed.node as u32,
        extras: extras(mesh.extras.as_ref(), node.extras.as_ref()),
        mesh: welded,
        tags: soup.tags,
        read: before,
        repairs,
        frame: map,
        exact: Vec::new(),
        medium: None,
        is_element: false,
        moved: DAffine3::IDENTITY,
    })
}

/// The node's own extras over those of its mesh.
fn extras(mesh: Option<&serde_json::Value>, node: Option<&serde_json::Value>) -> serde_json::Value {
    match (mesh, node) {
        (Some(serde_json::Value::Object(below)), Some(serde_json::Value::Object(above))) => {
            let mut merged = below.clone();
            merged.extend(above.iter().map(|(key, value)| (key.clone(), value.clone())));
            serde_json::Value::Object(merged)
        }
        (below, above) => above.or(below).cloned().unwrap_or_default(),
    }
}

impl Soup {
    /// Adds the triangles of a primitive; a warning when it has none by nature.
    fn add(&mut self, store: &Store, primitive: &Primitive) -> Result<Option<Problem>, Problem> {
        if primitive.mode < TRIANGLES {
            return Ok(Some(Problem::warning("consists of points or lines and is left out").on("mode")));
        }
        let Some(&position) = primitive.attributes.get("POSITION") else {
            return Err(Problem::error("has no POSITION"));
        };
        let accessor = &store.root.accessors[position as usize];
        let count = accessor.count.0 as usize;
        let mut indices = match primitive.indices {
            Some(index) => Some(store.indices(index, count)?),
            None => None,
        };
        let label = self.label(store, primitive.material)?;
        let whole = accessor.sparse.is_some() || indices.as_ref().is_none_or(|indices| 2 * indices.len() >= count);
        let start = match &mut indices {
            Some(indices) if !whole => self.some_vertices(store, position, indices)?,
            _ => self.all_vertices(store, position)?,
        };
        let before = self.triangles.len();
        let indices = indices.unwrap_or_else(|| (0..count as u32).collect());
        assemble(primitive.mode, &indices, start, &mut self.triangles)?;
        self.labels.resize(self.labels.len() + self.triangles.len() - before, label);
        let lies = whole && lies(accessor, &self.vertices[start as usize..][..count]);
        let problem = || Problem::warning("min and max differ from the data and are not used");
        Ok(lies.then(|| problem().on(format!("accessors[{position}]"))))
    }

    /// Start of the vertices of an accessor, read once.
    fn all_vertices(&mut self, store: &Store, accessor: u32) -> Result<u32, Problem> {
        if let Some(&start) = self.read.get(&accessor) {
            return Ok(start);
        }
        let start = self.append(store.positions(accessor, None)?);
        self.read.insert(accessor, start);
        Ok(start)
    }

    /// Start of those vertices of a large shared accessor that are used; `indices` then count from there.
    fn some_vertices(&mut self, store: &Store, accessor: u32, indices: &mut [u32]) -> Result<u32, Problem> {
        let mut used = indices.to_vec();
        used.sort_unstable();
        used.dedup();
        for index in indices {
            *index = used.partition_point(|u| u < index) as u32;
        }
        Ok(self.append(store.positions(accessor, Some(&used))?))
    }

    fn append(&mut self, positions: Positions) -> u32 {
        let start = self.vertices.len() as u32;
        self.reach = positions.points.iter().fold(self.reach, |most, p| most.max(p.abs().max_element()));
        self.half_step = self.half_step.max(0.5 * positions.step);
        if self.vertices.is_empty() {
            self.vertices = positions.points;
        } else {
            self.vertices.extend(positions.points);
        }
        start
    }

    /// Number of the material's name among the tags of the node.
    fn label(&mut self, store: &Store, material: Option<u32>) -> Result<u16, Problem> {
        let name = material.and_then(|material| store.root.materials.get(material as usize)?.name.as_deref());
        let name = name.unwrap_or_default();
        let known = self.tags.iter().position(|tag| tag == name).unwrap_or_else(|| {
            self.tags.push(name.to_owned());
            self.tags.len() - 1
        });
        u16::try_from(known).map_err(|_| Problem::error("is one of more than 65536 materials in a node").on("material"))
    }
}

/// Triangles of a list, strip or fan of vertex indices, counter-clockwise.
fn assemble(mode: u32, indices: &[u32], start: u32, out: &mut Vec<[u32; 3]>) -> Result<(), Problem> {
    let at = |i: usize| start + indices[i];
    let len = indices.len();
    match mode {
        TRIANGLES if !len.is_multiple_of(3) => {
            Err(Problem::error(format!("has {len} vertices in triangles")).expecting("a multiple of 3"))
        }
        TRIANGLES => {
            out.extend((0..len / 3).map(|i| [at(3 * i), at(3 * i + 1), at(3 * i + 2)]));
            Ok(())
        }
        _ if len < 3 => Err(Problem::error(format!("has {len} vertices")).expecting("3 at least")),
        TRIANGLE_STRIP => {
            out.extend((0..len - 2).map(|i| [at(i), at(i + 1 + i % 2), at(i + 2 - i % 2)]));
            Ok(())
        }
        TRIANGLE_FAN => {
            out.extend((1..len - 1).map(|i| [at(i), at(i + 1), at(0)]));
            Ok(())
        }
        _ => Err(Problem::error(format!("is {mode}")).on("mode")),
    }
}

/// Whether the stated bounds of an accessor are not those of its points. Bounds of integers are not compared.
fn lies(accessor: &json::Accessor, points: &[DVec3]) -> bool {
    let stated = |value: &Option<serde_json::Value>| -> Option<DVec3> {
        let numbers: Vec<f64> = value.as_ref()?.as_array()?.iter().filter_map(serde_json::Value::as_f64).collect();
        Some(DVec3::from_array(numbers.try_into().ok()?))
    };
    let (Some(low), Some(high), false) = (stated(&accessor.min), stated(&accessor.max), accessor.normalized) else {
        return false;
    };
    let Some(&first) = points.first() else { return false };
    let (least, most) = points.iter().fold((first, first), |(least, most), p| (least.min(*p), most.max(*p)));
    // Bounds are often written with six digits.
    let allowed = 1e-5 * (most - least).max_element().max(most.abs().max_element());
    (low - least).abs().max_element() > allowed || (high - most).abs().max_element() > allowed
}

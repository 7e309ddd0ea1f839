//! Two states of a geometry: what is new, lost, renamed or moved, and what each entry of `surfaces` selects in either.
//!
//! Nodes are told by name, then by shape; faces (regions over which the normal changes by less than 20 deg from triangle to
//! triangle) by shape: area, centroid, mean normal and bounds. Geometry is compared as the files have it, before `configure`.

mod pair;

use super::assembly::{self, Assembly};
use super::{Shop, assign};
use crate::error::{Error, Problem};
use crate::system::document::{Document, Names};
use crate::system::gltf::Node;
use crate::system::select::{self, Picked};
use glam::DVec3;
pub use pair::{Fate, Shape};
use pair::{Pair, Thing, pair};
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

/// Greatest angle between neighbours on a face, rad.
const SMOOTH: f64 = 20.0 / 180.0 * std::f64::consts::PI;

/// What became of a node, or of a face of a node that is still there.
#[derive(Clone, Debug)]
pub struct Difference {
    pub fate: Fate,
    /// Name of the node as it is now, or was.
    pub node: String,
    /// Name before, if it is another; of the material for a face.
    pub was: Option<String>,
    /// The material of the face; `None` for a node.
    pub face: Option<String>,
    /// As it is now, or was; world, m.
    pub shape: Shape,
    /// Entries of `surfaces` that select it: some of it for a node.
    pub entries: Vec<usize>,
}

/// What an entry of `surfaces` selects, then and now.
#[derive(Clone, Debug, PartialEq)]
pub struct Selected {
    pub triangles: [usize; 2],
    /// m2
    pub area: [f64; 2],
}

/// How a geometry differs from an older one.
#[derive(Clone, Debug)]
pub struct Comparison {
    /// Nodes that are not the same.
    pub nodes: Vec<Difference>,
    /// Faces that are not the same, of nodes that are still there.
    pub faces: Vec<Difference>,
    /// By entry of `surfaces`.
    pub selected: Vec<Selected>,
    /// New names and old ones of nodes and materials: what `aliases` would say.
    pub aliases: BTreeMap<String, String>,
}

/// Compares the geometry of a document with that of an older state: a system, or one glTF file in the place of the entry of
/// `geometry` whose file has this name, or of the only one.
///
/// # Errors
/// Files that cannot be read; [`Error::Usage`] if it is not clear which file is the newer state of the glTF file.
pub fn compare(document: &Document, older: &Path) -> Result<Comparison, Error> {
    let is_system = older.extension().is_some_and(|extension| extension == "ron");
    let mut old = if is_system { Document::read(older)? } else { with_file(document, older)? };
    let mut new = document.clone();
    // Written of the new state, or of the system: files are compared as they are.
    old.system.configure.clear();
    new.system.configure.clear();
    let [old, new] = [State::of(&old, document)?, State::of(&new, document)?];
    Ok(compared(&old, &new))
}

/// The system as it was with an older file.
fn with_file(document: &Document, older: &Path) -> Result<Document, Error> {
    if !older.is_file() {
        let problem = Problem::error("this file does not exist").in_file(older);
        return Err(Error::Missing(vec![problem]));
    }
    let mut old = document.clone();
    let named = old.system.geometry.iter().position(|entry| entry.file.file_name() == older.file_name());
    let only = (old.system.geometry.len() == 1).then_some(0);
    let Some(at) = named.or(only) else {
        let names: Vec<String> = old.system.geometry.iter().map(|entry| entry.file.display().to_string()).collect();
        let what = format!("--against {}: which file of `geometry` is its newer state?", older.display());
        return Err(Error::Usage(format!("{what} There are: {}; give the older system instead", names.join(", "))));
    };
    let whole = |source| Error::Io { path: older.into(), source };
    old.system.geometry[at].file = std::path::absolute(older).map_err(whole)?;
    old.system.aliases = Names::default();
    Ok(old)
}

/// A geometry, and what the entries of the newer document select of it.
struct State {
    assembly: Assembly,
    picked: Vec<Vec<Picked>>,
}

impl State {
    fn of(document: &Document, entries: &Document) -> Result<State, Error> {
        let mut shop = Shop::new(document, Vec::new());
        let assembly = assembly::read(&mut shop);
        if shop.problems.iter().any(Problem::is_error) {
            return Err(Error::Input(shop.problems));
        }
        let select = |on| select::select(&assign::selector(on, &assembly), &assembly.nodes);
        let picked = entries.system.surfaces.iter().map(|entry| select(&entry.on)).collect();
        Ok(State { assembly, picked })
    }

    fn nodes(&self) -> Vec<Thing> {
        let thing = |node: &Node| self.thing(node.name.clone(), node, 0..node.mesh.triangles.len());
        self.assembly.nodes.iter().map(thing).collect()
    }

    fn thing(&self, name: String, node: &Node, triangles: impl Iterator<Item = usize>) -> Thing {
        let shape = Shape::of(&node.mesh, triangles);
        let shift = self.assembly.shift;
        let bounds = shape.bounds.map(|corner| corner + shift);
        Thing { name, shape: Shape { centroid: shape.centroid + shift, bounds, ..shape } }
    }

    /// Faces of a node, and the first triangle of each.
    fn faces(&self, index: usize) -> (Vec<Thing>, Vec<usize>) {
        let node = &self.assembly.nodes[index];
        let faces = node.mesh.faces(SMOOTH);
        let mut triangles: Vec<Vec<usize>> = vec![Vec::new(); faces.count];
        faces.of.iter().enumerate().for_each(|(i, &face)| triangles[face as usize].push(i));
        let thing = |all: &Vec<usize>| self.thing(node.tag(all[0]).to_owned(), node, all.iter().copied());
        (triangles.iter().map(thing).collect(), triangles.iter().map(|all| all[0]).collect())
    }

    /// Entries that select a triangle of a node; any triangle if none is given.
    fn entries(&self, node: usize, triangle: Option<usize>) -> Vec<usize> {
        let holds = |picked: &Picked| {
            picked.node == node && triangle.is_none_or(|t| picked.triangles.binary_search(&(t as u32)).is_ok())
        };
        (0..self.picked.len()).filter(|&entry| self.picked[entry].iter().any(holds)).collect()
    }

    /// How many triangles an entry selects, and their area, m2.
    fn selected(&self, entry: usize) -> (usize, f64) {
        let all =
            self.picked[entry].iter().flat_map(|picked| picked.triangles.iter().map(|&t| (picked.node, t as usize)));
        all.fold((0, 0.0), |(count, area), (node, t)| (count + 1, area + self.assembly.nodes[node].mesh.area(t)))
    }

    /// Names of nodes and materials.
    fn names(&self) -> BTreeSet<&str> {
        self.assembly.nodes.iter().flat_map(|node| node.tags.iter().chain([&node.name])).map(String::as_str).collect()
    }
}

fn compared(old: &State, new: &State) -> Comparison {
    let (was, is) = (old.nodes(), new.nodes());
    let (mut nodes, mut faces, mut renamed) = (Vec::new(), Vec::new(), Vec::new());
    for found in pair(&was, &is, DVec3::ZERO, true) {
        let entries = match found.new {
            Some(node) => new.entries(node, None),
            None => found.old.map_or(Vec::new(), |node| old.entries(node, None)),
        };
        if let Some(difference) = difference(&found, [&was, &is], entries) {
            renamed.extend(difference.was.clone().map(|was| (difference.node.clone(), was)));
            nodes.push(difference);
        }
        if let (Some(before), Some(after)) = (found.old, found.new) {
            let by = match found.fate {
                Fate::Moved(by) | Fate::RenamedAndMoved(by) => by,
                _ => DVec3::ZERO,
            };
            for face in faces_of(old, new, [before, after], by) {
                renamed.extend(face.was.clone().zip(face.face.clone()).map(|(was, is)| (is, was)));
                faces.push(face);
            }
        }
    }
    let both = |entry: usize| {
        let [(before, was), (after, is)] = [old.selected(entry), new.selected(entry)];
        Selected { triangles: [before, after], area: [was, is] }
    };
    let selected = (0..new.picked.len()).map(both).collect();
    Comparison { nodes, faces, selected, aliases: aliases(&renamed, old, new) }
}

/// What became of the faces of a node that moved by `by` (m).
fn faces_of(old: &State, new: &State, [before, after]: [usize; 2], by: DVec3) -> Vec<Difference> {
    let ((was, old_first), (is, new_first)) = (old.faces(before), new.faces(after));
    let tell = |found: Pair| {
        let entries = match (found.new, found.old) {
            (Some(face), _) => new.entries(after, Some(new_first[face])),
            (None, Some(face)) => old.entries(before, Some(old_first[face])),
            (None, None) => Vec::new(),
        };
        let told = difference(&found, [&was, &is], entries)?;
        Some(Difference { face: Some(told.node), node: new.assembly.nodes[after].name.clone(), ..told })
    };
    pair(&was, &is, by, false).into_iter().filter_map(tell).collect()
}

/// What there is to say of a pair.
fn difference(found: &Pair, [was, is]: [&[Thing]; 2], entries: Vec<usize>) -> Option<Difference> {
    let before = found.old.map(|at| &was[at]);
    let shown = found.new.map(|at| &is[at]).or(before)?;
    let other = before.filter(|before| before.name != shown.name).map(|before| before.name.clone());
    let told =
        Difference { fate: found.fate, node: shown.name.clone(), was: other, face: None, shape: shown.shape, entries };
    (found.fate != Fate::Same).then_some(told)
}

/// Names that stand for one old name each, which is gone.
fn aliases(renamed: &[(String, String)], old: &State, new: &State) -> BTreeMap<String, String> {
    let (before, after) = (old.names(), new.names());
    let sure = |(is, was): &&(String, String)| {
        let one = renamed.iter().all(|(other, name)| (other == is) == (name == was));
        let plain = |name: &str| !name.is_empty() && !name.contains('/');
        one && plain(is) && plain(was) && !after.contains(was.as_str()) && !before.contains(is.as_str())
    };
    renamed.iter().filter(sure).cloned().collect()
}

//! Which triangle is what: entries are laid over each other in order, and every distinct outcome on a node is a part.

use super::Shop;
use super::assembly::Assembly;
use super::coatings::Coatings;
use super::models::Finish;
use crate::coating::Side;
use crate::error::Problem;
use crate::scene::{Filling, Part, PartKind, Solid};
use crate::surface::Surface;
use crate::system::document as written;
use crate::system::select::{self, Selector};
use std::collections::HashMap;
use std::sync::Arc;

/// Parts, their surfaces, and the solids they bound.
#[derive(Debug, Default)]
pub struct Assigned {
    pub parts: Vec<Part>,
    pub surfaces: Vec<Surface>,
    pub solids: Vec<Solid>,
}

/// What is said of a triangle.
#[derive(Clone, Debug, Default)]
struct State {
    /// Entries that apply, in order.
    entries: Vec<u16>,
    /// Name of the face of an element that it is on.
    face: Option<String>,
}

/// Assigns every triangle to a part.
pub fn assign(shop: &mut Shop, assembly: &mut Assembly, media: &[Filling], coatings: &Coatings) -> Assigned {
    let (layers, states) = lay(shop, assembly);
    let mut assigned = Assigned::default();
    let mut finishes: Vec<Finish> = Vec::new();
    for node in 0..assembly.nodes.len() {
        let first = assembly.first[node] as usize;
        let range = first..first + assembly.nodes[node].mesh.triangles.len();
        let mut found: Vec<u32> = layers[range.clone()].to_vec();
        found.sort_unstable();
        found.dedup();
        let solid = solid(shop, assembly, node, &found, &states, media, &mut assigned.solids);
        let names = names(shop, &assembly.nodes[node].name, &found, &states);
        for (state, label) in found.iter().zip(names) {
            let index = assigned.parts.len() as u32;
            let entries = &states[*state as usize].entries;
            let part = part(
                shop,
                assembly,
                node,
                entries,
                label,
                solid,
                media,
                coatings,
                &mut finishes,
                &mut assigned.surfaces,
            );
            assigned.parts.push(part);
            if entries.is_empty() {
                assembly.unsaid.push(index);
            }
            for triangle in range.clone().filter(|&t| layers[t] == *state) {
                assembly.part_of[triangle] = index;
            }
        }
    }
    assembly.finishes = finishes;
    assigned
}

/// The state of every triangle, and what the states are.
fn lay(shop: &mut Shop, assembly: &Assembly) -> (Vec<u32>, Vec<State>) {
    let mut layers = vec![0u32; assembly.part_of.len()];
    let mut states = vec![State::default()];
    faces_of_elements(assembly, &mut layers, &mut states);
    for (entry, written) in shop.document.system.surfaces.iter().enumerate() {
        let mut next: HashMap<u32, u32> = HashMap::new();
        let selector = selector(&written.on, assembly);
        let picked = select::select(&selector, &assembly.nodes);
        for picked in &picked {
            for triangle in &picked.triangles {
                let slot = &mut layers[(assembly.first[picked.node] + triangle) as usize];
                *slot = *next.entry(*slot).or_insert_with(|| {
                    let mut longer = states[*slot as usize].clone();
                    longer.entries.push(entry as u16);
                    states.push(longer);
                    states.len() as u32 - 1
                });
            }
        }
        if picked.is_empty() {
            nothing(shop, entry, &written.on, assembly);
        }
    }
    (layers, states)
}

/// Every named face of an element is a part of its own.
fn faces_of_elements(assembly: &Assembly, layers: &mut [u32], states: &mut Vec<State>) {
    for (node, &first) in assembly.nodes.iter().zip(&assembly.first).filter(|(node, _)| node.is_element) {
        for i in 0..node.mesh.triangles.len() {
            let face = Some(node.tag(i).to_owned());
            let known = states.iter().position(|state| state.face == face).unwrap_or_else(|| {
                states.push(State { face, ..State::default() });
                states.len() - 1
            });
            layers[first as usize + i] = known as u32;
        }
    }
}

/// An entry that selects nothing is a mistake.
fn nothing(shop: &mut Shop, entry: usize, on: &written::Selector, assembly: &Assembly) {
    let path = format!("surfaces[{entry}].on");
    match on {
        written::Selector::Node(glob) => shop.nothing_matches(&path, glob, &assembly.names()),
        written::Selector::Faces { of, .. } if assembly.matching(of).is_empty() => {
            shop.nothing_matches(&path, of, &assembly.names())
        }
        written::Selector::Tag(glob) => {
            let mut tags: Vec<String> = assembly.nodes.iter().flat_map(|node| node.tags.clone()).collect();
            tags.sort();
            tags.dedup();
            let expected = format!("one of the tags {}", super::listed(&tags));
            shop.fault(&path, Problem::error(format!("no tag matches `{glob}`")).expecting(expected));
        }
        _ => {
            let hint = "`straylight check` lists nodes, tags and faces";
            shop.fault(&path, Problem::error("this selects no triangle").hinting(hint.to_owned()));
        }
    }
}

/// Labels of a node's parts: the node's name with the name of the last named entry, or the name of the face of an element.
fn names(shop: &Shop, node: &str, found: &[u32], states: &[State]) -> Vec<String> {
    let surfaces = &shop.document.system.surfaces;
    let named = |state: &u32| {
        let entries = states[*state as usize].entries.iter().rev();
        entries.filter_map(|&entry| surfaces[entry as usize].name.clone()).next()
    };
    let mut labels: Vec<String> = Vec::new();
    for state in found {
        let base = match named(state) {
            Some(name) => format!("{node}.{name}"),
            None => states[*state as usize].face.clone().unwrap_or_else(|| node.to_string()),
        };
        let mut label = base.clone();
        let mut number = 2;
        while labels.contains(&label) {
            label = format!("{base}.{number}");
            number += 1;
        }
        labels.push(label);
    }
    labels
}

/// The last value that any of the entries gives.
fn last<T>(shop: &Shop, entries: &[u16], field: impl Fn(&written::Surface) -> Option<T>) -> Option<T> {
    entries.iter().rev().find_map(|&entry| field(&shop.document.system.surfaces[entry as usize]))
}

/// The solid that a node is, if its entries give it a medium.
fn solid(
    shop: &mut Shop,
    assembly: &mut Assembly,
    node: usize,
    found: &[u32],
    states: &[State],
    media: &[Filling],
    solids: &mut Vec<Solid>,
) -> Option<u16> {
    let named = |state: &u32| last(shop, &states[*state as usize].entries, |s| s.medium.clone());
    let own = assembly.nodes[node].medium.clone();
    let mut names: Vec<Option<String>> = found.iter().map(|state| named(state).or_else(|| own.clone())).collect();
    names.sort();
    names.dedup();
    let name = names.iter().flatten().next()?.clone();
    let label = assembly.nodes[node].name.clone();
    let entry = found.iter().flat_map(|&s| &states[s as usize].entries).copied().max().unwrap_or(0);
    let path = format!("surfaces[{entry}]");
    if names.len() > 1 {
        let problem = Problem::error(format!("only some faces of `{label}` have the medium `{name}`"));
        shop.fault(
            &path,
            problem.expecting("one medium for the whole node: give it with Node or Tag, the finish with Faces"),
        );
        return None;
    }
    let topology = assembly.nodes[node].mesh.topology;
    if !topology.closed() {
        let problem = Problem::error(format!(
            "`{label}` has a medium but is not closed: {} open and {} twisted edges",
            topology.open_edges, topology.twisted_edges
        ));
        shop.fault(&path, problem.hinting("repair the mesh, or declare the sheet with `between: (..)`".to_owned()));
        return None;
    }
    if topology.inverted() {
        let mesh = &mut assembly.nodes[node].mesh;
        mesh.triangles.iter_mut().for_each(|triangle| triangle.swap(1, 2));
        mesh.topology.volume = -mesh.topology.volume;
        shop.fault(&path, Problem::warning(format!("`{label}` is inside out; its faces were turned over")));
    }
    let medium = media.iter().position(|filling| filling.label == name)? as u16;
    let priority = found.iter().find_map(|&s| last(shop, &states[s as usize].entries, |s| s.priority)).unwrap_or(0);
    assembly.solid_nodes.push(node);
    solids.push(Solid { label, medium, priority, volume: topology.volume.abs() });
    Some(solids.len() as u16 - 1)
}

#[allow(clippy::too_many_arguments)]
fn part(
    shop: &mut Shop,
    assembly: &Assembly,
    node: usize,
    entries: &[u16],
    label: String,
    solid: Option<u16>,
    media: &[Filling],
    coatings: &Coatings,
    finishes: &mut Vec<Finish>,
    surfaces: &mut Vec<Surface>,
) -> Part {
    let between = last(shop, entries, |s| s.between.clone());
    let medium = |name: &str| media.iter().position(|filling| filling.label == name).unwrap_or(0) as u16;
    let kind = match (solid, between) {
        (Some(solid), _) => PartKind::Face(solid),
        (None, Some((front, back))) => PartKind::Between { front: medium(&front), back: medium(&back) },
        (None, None) => PartKind::Sheet,
    };
    let transparent = kind != PartKind::Sheet;
    let mut side = |front: bool| {
        let mut finish = finish(shop, entries, front, transparent);
        let sided = finish.coating.as_ref().and_then(|name| coatings.get(name));
        let scatter = finish.scatter.as_ref().and_then(|name| shop.document.system.scatter.get(name));
        let faced = scatter.is_some_and(written::Scatter::is_sided) || sided.is_some_and(|[a, b]| !Arc::ptr_eq(a, b));
        finish.side = faced.then_some(if front { Side::Front } else { Side::Back });
        if finish.is_unsaid() {
            unassigned(shop, assembly, node, &label);
        }
        let known = finishes.iter().position(|known| *known == finish);
        known.unwrap_or_else(|| {
            surfaces.push(finish.surface(shop, media, coatings));
            finishes.push(finish);
            finishes.len() - 1
        }) as u32
    };
    let surface = vec![[side(true), side(false)]];
    let air_gap = last(shop, entries, |s| s.gap) == Some(written::Gap::Air);
    let aims = [true, false].map(|front| aims(shop, entries, front));
    Part { label, surface, kind, detectors: Vec::new(), aims, air_gap }
}

/// What one side of a part is: its entries over each other, or the default. A side that entries leave out because they
/// are for the other one absorbs. A face of glass about which nothing is said is bare.
fn finish(shop: &Shop, entries: &[u16], front: bool, transparent: bool) -> Finish {
    let mut finish = Finish::default();
    let mut one_sided = false;
    for &entry in entries {
        let written = &shop.document.system.surfaces[entry as usize];
        if !acts(written.side, front) {
            one_sided = true;
            continue;
        }
        if written.specular.is_some() || written.coating.is_some() {
            (finish.specular, finish.coating) = (written.specular, written.coating.clone());
        }
        finish.scatter = written.scatter.clone().or(finish.scatter);
        finish.order = written.order.unwrap_or(finish.order);
        finish.lay = written.lay.or(finish.lay);
        finish.scattering = written.scattering.unwrap_or(finish.scattering);
    }
    if finish.is_unsaid() && !transparent {
        let default = shop.document.system.default.as_ref();
        if one_sided || default.is_some_and(|default| !acts(default.side, front)) {
            finish.specular = Some(written::Specular::Absorb);
        } else if let Some(default) = default {
            finish.specular = default.specular;
            finish.coating = default.coating.clone();
            finish.scatter = default.scatter.clone();
            finish.order = default.order.unwrap_or_default();
            finish.lay = default.lay;
            finish.scattering = default.scattering.unwrap_or_default();
        }
    }
    if transparent && finish.specular.is_none() && finish.coating.is_none() {
        finish.specular = Some(written::Specular::Fresnel);
    }
    finish
}

/// Numbers of the targets that one side of a part aims at.
fn aims(shop: &Shop, entries: &[u16], front: bool) -> Vec<u16> {
    let system = &shop.document.system;
    let said = |entry: &&u16| acts(system.surfaces[**entry as usize].side, front);
    let own = entries.iter().rev().filter(said).find_map(|&entry| system.surfaces[entry as usize].aim.as_ref());
    let default = system.default.as_ref().filter(|default| acts(default.side, front)).and_then(|d| d.aim.as_ref());
    let names = own.or(default).into_iter().flatten();
    names.filter_map(|name| system.targets.position(name)).map(|target| target as u16).collect()
}

/// Whether an entry is about the front (`true`) or the back.
fn acts(side: Option<written::Side>, front: bool) -> bool {
    match side.unwrap_or_default() {
        written::Side::Both => true,
        written::Side::Front => front,
        written::Side::Back => !front,
    }
}

fn unassigned(shop: &mut Shop, assembly: &Assembly, node: usize, label: &str) {
    let tags: Vec<&str> = assembly.nodes[node].tags.iter().map(String::as_str).filter(|tag| !tag.is_empty()).collect();
    let tagged = if tags.is_empty() { String::new() } else { format!(" (tag {})", tags.join(", ")) };
    let problem = Problem::error(format!("`{label}`{tagged} has no surface"))
        .expecting("an entry in `surfaces` that says `specular`, `coating` or `scatter` for it, or a `default`");
    let already = shop.problems.iter().any(|known| known.message == problem.message);
    if !already {
        shop.fault("surfaces", problem);
    }
}

/// The selector in scene coordinates.
pub(super) fn selector(written: &written::Selector, assembly: &Assembly) -> Selector {
    match written {
        written::Selector::Tag(glob) => Selector::Tag(glob.clone()),
        written::Selector::Node(glob) => Selector::Node(glob.clone()),
        written::Selector::Extras { key, value } => Selector::Extras {
            key: key.clone(),
            value: match value {
                written::ExtrasValue::Text(text) => text.clone(),
                written::ExtrasValue::Number(number) => number.to_string(),
                written::ExtrasValue::Flag(flag) => flag.to_string(),
            },
        },
        written::Selector::Faces { of, predicate } => {
            let (predicate, smooth) = predicate_of(predicate, assembly);
            Selector::Faces { of: of.clone(), predicate, smooth }
        }
        written::Selector::Any(all) => Selector::Any(all.iter().map(|one| selector(one, assembly)).collect()),
    }
}

/// A predicate in scene coordinates and the angle (rad) up to which neighbours belong to one face.
fn predicate_of(written: &written::Predicate, assembly: &Assembly) -> (select::Predicate, f64) {
    const SMOOTH: f64 = 20.0 / 180.0 * std::f64::consts::PI;
    match written {
        written::Predicate::Radial { axis, through, within } => {
            let through = Some(through.0 - assembly.shift);
            (select::Predicate::Radial { axis: axis.0, through, within: within.0 }, SMOOTH)
        }
        written::Predicate::Normal { direction, within } => {
            (select::Predicate::Normal { direction: direction.0, within: within.0 }, SMOOTH)
        }
        written::Predicate::Box { min, max } => {
            (select::Predicate::Box { min: min.0 - assembly.shift, max: max.0 - assembly.shift }, SMOOTH)
        }
        written::Predicate::Nearest { point, smooth } => {
            (select::Predicate::Nearest { point: point.0 - assembly.shift }, smooth.0)
        }
        written::Predicate::All(all) => {
            let all: Vec<_> = all.iter().map(|one| predicate_of(one, assembly)).collect();
            let smooth = all.iter().map(|one| one.1).fold(SMOOTH, f64::min);
            (select::Predicate::All(all.into_iter().map(|one| one.0).collect()), smooth)
        }
    }
}

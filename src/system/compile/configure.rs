//! Nodes hidden, replaced, scaled, turned and moved, in the order in which the system says it.
//!
//! ```text
//! p' = o + A (t + R S A^-1 (p - o))       o, A  origin and axes (orthonormal) of the frame, world
//!                                         S scale, R rotation, t displacement, in its axes
//! ```
//!
//! Exact shapes go along with their nodes. A scale would change what they are, so a node that has any is not scaled: elements
//! have dimensions, which may be expressions.

use super::Shop;
use super::assembly::Assembly;
use crate::error::Problem;
use crate::geometry::{Frame, rotation};
use crate::system::document::{About, Change, Replacement};
use crate::system::gltf::Node;
use crate::system::select;
use glam::{DAffine3, DMat3, DVec3};

/// A frame that the geometry names: that of a node, with or without a mesh.
#[derive(Clone, Debug)]
pub struct Landmark {
    /// Entry of `geometry`; `None` for elements.
    pub file: Option<usize>,
    /// Names from the root.
    pub path: String,
    /// To the world, m.
    pub frame: DAffine3,
}

/// Does everything that `configure` says.
pub fn configure(shop: &mut Shop, assembly: &mut Assembly) {
    for (at, change) in shop.document.system.configure.iter().enumerate() {
        let path = format!("configure[{at}]");
        let nodes = assembly.matching(&change.node);
        let landmarks = assembly.landmarks.iter().any(|landmark| is_below(&change.node, &landmark.path));
        if nodes.is_empty() && (change.hide || change.replace.is_some() || !landmarks) {
            shop.nothing_matches(&format!("{path}.node"), &change.node, &assembly.names());
            continue;
        }
        if change.hide {
            hide(assembly, &nodes);
            continue;
        }
        if let Some(replacement) = &change.replace {
            replace(shop, assembly, &nodes, replacement, &path);
        }
        if let Err(problem) = displace(assembly, change, &nodes) {
            shop.fault(&path, problem);
        }
    }
}

/// Whether a pattern means this path or one above it.
fn is_below(pattern: &str, path: &str) -> bool {
    select::owner(pattern, path).is_some()
}

fn hide(assembly: &mut Assembly, nodes: &[usize]) {
    let kept = |index: &usize| !nodes.contains(index);
    let mut index = 0..;
    assembly.nodes.retain(|_| index.next().is_some_and(|i| kept(&i)));
    let mut index = 0..;
    assembly.file_of.retain(|_| index.next().is_some_and(|i| kept(&i)));
}

/// Moves nodes, and frames below what the change names.
fn displace(assembly: &mut Assembly, change: &Change, nodes: &[usize]) -> Result<(), Problem> {
    if change.scale.is_none() && change.rotate.is_none() && change.shift.is_none() {
        return Ok(());
    }
    let before = assembly.landmarks.clone();
    let own = |file: Option<usize>, path: &str, frame: DAffine3| {
        let end = select::owner(&change.node, path)?;
        let known = before.iter().find(|known| known.file == file && known.path == path[..end]);
        Some(known.map_or(frame, |known| known.frame).translation)
    };
    let frame = match &change.about {
        About::Own => None,
        About::Point(point) => Some((point.0, DMat3::IDENTITY)),
        About::Node(pattern) => Some(named(&before, pattern)?),
    };
    for landmark in &mut assembly.landmarks {
        if let Some(origin) = own(landmark.file, &landmark.path, landmark.frame) {
            landmark.frame = motion(change, frame.unwrap_or((origin, DMat3::IDENTITY))) * landmark.frame;
        }
    }
    for &index in nodes {
        let node = &mut assembly.nodes[index];
        // A name that was made unique stands for the node alone.
        let origin = own(assembly.file_of[index], &node.path, node.frame).unwrap_or(node.frame.translation);
        transform(node, &motion(change, frame.unwrap_or((origin, DMat3::IDENTITY))))?;
    }
    Ok(())
}

/// Origin and axes of the one frame that a pattern names.
fn named(landmarks: &[Landmark], pattern: &str) -> Result<(DVec3, DMat3), Problem> {
    let name = |path: &str| path.rsplit('/').next().unwrap_or_default().to_owned();
    let fits = |mark: &&Landmark| select::matches(pattern, &mark.path) || select::matches(pattern, &name(&mark.path));
    let mut found = landmarks.iter().filter(fits);
    let Some(first) = found.next() else {
        let names: Vec<String> = landmarks.iter().map(|mark| name(&mark.path)).collect();
        return Err(super::no_node(pattern, &names));
    };
    if let Some(other) = found.find(|other| other.frame != first.frame) {
        let problem = Problem::error(format!("`{pattern}` names several frames: `{}`, `{}`", first.path, other.path));
        return Err(problem.expecting("the name or path of one node"));
    }
    Ok((first.frame.translation, upright(&first.frame)))
}

/// The axes of a frame without its scale: z, and x as near as can be.
fn upright(frame: &DAffine3) -> DMat3 {
    let z = frame.matrix3.z_axis.normalize_or(DVec3::Z);
    let Frame { x, y, z } = Frame::from_z_x(z, frame.matrix3.x_axis);
    DMat3::from_cols(x, y, z)
}

/// The map of a change in the axes of a frame.
fn motion(change: &Change, (origin, axes): (DVec3, DMat3)) -> DAffine3 {
    let scale = change.scale.map_or(DVec3::ONE, |(x, y, z)| DVec3::new(x, y, z));
    let turn = rotation(change.rotate.map_or(DVec3::ZERO, |angles| angles.0));
    let shift = axes * change.shift.map_or(DVec3::ZERO, |shift| shift.0);
    // What only moves must not cost a digit.
    if scale == DVec3::ONE && turn == DMat3::IDENTITY {
        return DAffine3::from_translation(shift);
    }
    let matrix = axes * turn * DMat3::from_diagonal(scale) * axes.transpose();
    DAffine3::from_mat3_translation(matrix, origin - matrix * origin + shift)
}

/// Whether a map keeps lengths, up to the rounding of its angles.
pub fn is_rigid(map: &DAffine3) -> bool {
    let squares = map.matrix3.transpose() * map.matrix3;
    squares.abs_diff_eq(DMat3::IDENTITY, 1e-12) && map.matrix3.determinant() > 0.0
}

/// Moves a node: its mesh, its frame, what it truly is.
fn transform(node: &mut Node, map: &DAffine3) -> Result<(), Problem> {
    if !is_rigid(map) && !node.exact.is_empty() {
        let problem = Problem::error(format!("`{}` has exact surfaces, which a scale would change", node.name));
        return Err(problem.hinting("give its dimensions as expressions of a parameter".to_owned()));
    }
    node.mesh.transform(map);
    node.frame = *map * node.frame;
    node.moved = *map * node.moved;
    for declared in &mut node.exact {
        let Frame { x, y, z } = declared.frame;
        declared.at = map.transform_point3(declared.at);
        declared.frame = Frame { x: map.matrix3 * x, y: map.matrix3 * y, z: map.matrix3 * z };
    }
    Ok(())
}

/// Puts a node of another file in the place of one.
fn replace(shop: &mut Shop, assembly: &mut Assembly, nodes: &[usize], with: &Replacement, path: &str) {
    let &[index] = nodes else {
        let names: Vec<String> = nodes.iter().map(|&node| assembly.nodes[node].name.clone()).collect();
        let problem = Problem::error(format!("several nodes would be replaced by one: {}", super::listed(&names)));
        return shop.fault(&format!("{path}.node"), problem.expecting("one node"));
    };
    let Some(new) = one(shop, with, &format!("{path}.replace")) else { return };
    let old = &assembly.nodes[index];
    let [from, to] = [&new.frame, &old.frame].map(|frame| (frame.translation, upright(frame)));
    let turn = to.1 * from.1.transpose();
    let mut new = Node { name: old.name.clone(), path: old.path.clone(), ..new };
    // Frames that agree lay a file on its re-export without rounding.
    let map = if turn.abs_diff_eq(DMat3::IDENTITY, 1e-14) {
        DAffine3::from_translation(to.0 - from.0)
    } else {
        DAffine3::from_mat3_translation(turn, to.0 - turn * from.0)
    };
    match transform(&mut new, &map) {
        Ok(()) => assembly.nodes[index] = Node { moved: assembly.nodes[index].moved, ..new },
        Err(problem) => shop.fault(path, problem),
    }
}

/// The node of another file, in metres.
fn one(shop: &mut Shop, with: &Replacement, path: &str) -> Option<Node> {
    let file = shop.gltf(&with.file, &format!("{path}.file"))?;
    let named = |node: &Node| select::named(&with.node, node);
    let (mut fitting, others): (Vec<Node>, Vec<Node>) = file.nodes.into_iter().partition(named);
    let names = |nodes: &[Node]| nodes.iter().map(|node| node.name.clone()).collect::<Vec<_>>();
    match fitting.pop() {
        None => shop.nothing_matches(&format!("{path}.node"), &with.node, &names(&others)),
        Some(_) if !fitting.is_empty() => {
            let problem = Problem::error(format!("several nodes match: {} and more", super::listed(&names(&fitting))));
            shop.fault(&format!("{path}.node"), problem.expecting("one node"));
        }
        Some(mut node) => {
            let unit = with.unit.0;
            node.mesh.transform(&DAffine3::from_scale(DVec3::splat(unit)));
            node.frame.translation *= unit;
            return Some(node);
        }
    }
    None
}

//! Which triangles a line of the system means: by material, by node, by custom property, or by the shape of a face.
//!
//! Names are matched by patterns: `*` stands for any text (`/` included), `?` for one character, case matters.
//! A node stands for everything below it.
//!
//! A face is a connected region of a node over which the normal changes by at most `smooth` from triangle to triangle;
//! predicates choose whole faces, so that a lens that is one mesh falls into front, rear and rim. Normals are weighted
//! with area, and those of slivers do not count.

pub use crate::filter::matches;
use crate::geometry::mesh::Mesh;
use crate::system::gltf::Node;
use glam::DVec3;
use std::borrow::Cow;

/// A choice of triangles.
#[derive(Clone, Debug, PartialEq)]
pub enum Selector {
    /// Triangles whose material's name matches.
    Tag(String),
    /// Nodes whose name or path matches, or that of a node above them.
    Node(String),
    /// Nodes with a custom property `key` whose text, number or truth value matches.
    Extras { key: String, value: String },
    /// Faces of the nodes that match `of`; `smooth` (rad) is the largest angle between neighbours on a face.
    Faces { of: String, predicate: Predicate, smooth: f64 },
    /// What any of them chooses.
    Any(Vec<Selector>),
}

/// A choice of faces.
#[derive(Clone, Debug, PartialEq)]
pub enum Predicate {
    /// Faces that run along `axis`, such as the rim of a lens or the bore of a barrel: their normals are perpendicular to
    /// it within `within` (rad) in the mean over their area. With `through` (m), a point of the axis, the normals must
    /// also point straight away from the axis or towards it; either will do.
    Radial { axis: DVec3, through: Option<DVec3>, within: f64 },
    /// Faces that look along `direction`: their mean normal does within `within` (rad), and so does one of their
    /// triangles, so that a conical rim is no front.
    Normal { direction: DVec3, within: f64 },
    /// Faces that lie wholly in a box with these corners, m.
    Box { min: DVec3, max: DVec3 },
    /// The one face, of all nodes together, that comes nearest to a point (m); within `All`, of those that remain.
    Nearest { point: DVec3 },
    /// Faces that satisfy all of them.
    All(Vec<Predicate>),
}

/// Some triangles of one node.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Picked {
    /// Index into the nodes given to `select`.
    pub node: usize,
    /// Indices into the triangles of its mesh, increasing; never empty.
    pub triangles: Vec<u32>,
}

/// What `selector` chooses from `nodes`, in order of nodes; empty if nothing fits.
/// `Faces` costs some 0.5 s per 1e6 triangles of the nodes that match, everything else a pass over them.
pub fn select(selector: &Selector, nodes: &[Node]) -> Vec<Picked> {
    match selector {
        Selector::Tag(pattern) => pick(nodes, |node| {
            let fits: Vec<bool> = node.tags.iter().map(|tag| matches(pattern, tag)).collect();
            let labels = node.mesh.labels.iter().enumerate();
            labels.filter(|(_, label)| fits[**label as usize]).map(|(i, _)| i as u32).collect()
        }),
        Selector::Node(pattern) => pick(nodes, |node| whole(node, named(pattern, node))),
        Selector::Extras { key, value } => pick(nodes, |node| whole(node, carries(node, key, value))),
        Selector::Faces { of, predicate, smooth } => faces(nodes, of, predicate, *smooth),
        Selector::Any(selectors) => union(selectors.iter().flat_map(|selector| select(selector, nodes)).collect()),
    }
}

fn pick(nodes: &[Node], triangles: impl Fn(&Node) -> Vec<u32>) -> Vec<Picked> {
    let picked = nodes.iter().enumerate().map(|(node, of)| Picked { node, triangles: triangles(of) });
    picked.filter(|picked| !picked.triangles.is_empty()).collect()
}

fn whole(node: &Node, chosen: bool) -> Vec<u32> {
    if chosen { (0..node.mesh.triangles.len() as u32).collect() } else { Vec::new() }
}

/// One entry per node, triangles once and in order.
fn union(mut all: Vec<Picked>) -> Vec<Picked> {
    all.sort_by_key(|picked| picked.node);
    let mut merged: Vec<Picked> = Vec::new();
    for picked in all {
        match merged.last_mut().filter(|last| last.node == picked.node) {
            Some(last) => last.triangles.extend(picked.triangles),
            None => merged.push(picked),
        }
    }
    for picked in &mut merged {
        picked.triangles.sort_unstable();
        picked.triangles.dedup();
    }
    merged
}

/// Whether a pattern means this node: its name, its path, or the name or path of a node above it.
pub fn named(pattern: &str, node: &Node) -> bool {
    matches(pattern, &node.name) || owner(pattern, &node.path).is_some()
}

/// Where in a path the first node ends that a pattern means by its name or path.
pub fn owner(pattern: &str, path: &str) -> Option<usize> {
    let mut ends = path.match_indices('/').map(|(at, _)| at).chain([path.len()]);
    let name = |path: &str| path.rfind('/').map_or(0, |at| at + 1);
    ends.find(|&end| matches(pattern, &path[..end]) || matches(pattern, &path[name(&path[..end])..end]))
}

fn carries(node: &Node, key: &str, pattern: &str) -> bool {
    match node.extras.get(key) {
        Some(serde_json::Value::String(text)) => matches(pattern, text),
        Some(value @ (serde_json::Value::Number(_) | serde_json::Value::Bool(_))) => {
            matches(pattern, &value.to_string())
        }
        _ => false,
    }
}

/// A face of a node.
struct Face<'a> {
    node: usize,
    mesh: &'a Mesh,
    triangles: Vec<u32>,
    /// Those with a trustworthy normal: all, if none has.
    sound: Vec<u32>,
}

fn faces(nodes: &[Node], of: &str, predicate: &Predicate, smooth: f64) -> Vec<Picked> {
    let matching = nodes.iter().enumerate().filter(|(_, node)| named(of, node));
    // What is written of a face is written of where the file has it.
    let meshes: Vec<(usize, Cow<Mesh>)> = matching.map(|(i, node)| (i, node.at_rest())).collect();
    let all = meshes.iter().flat_map(|(i, mesh)| split(*i, mesh, smooth)).collect();
    let chosen = choose(predicate, all);
    union(chosen.into_iter().map(|face| Picked { node: face.node, triangles: face.triangles }).collect())
}

fn split(node: usize, mesh: &Mesh, smooth: f64) -> Vec<Face<'_>> {
    let faces = mesh.faces(smooth);
    let face = || Face { node, mesh, triangles: Vec::new(), sound: Vec::new() };
    let mut split: Vec<Face> = (0..faces.count).map(|_| face()).collect();
    for (i, &of) in faces.of.iter().enumerate() {
        split[of as usize].triangles.push(i as u32);
        if faces.sound[i] {
            split[of as usize].sound.push(i as u32);
        }
    }
    for face in &mut split {
        if face.sound.is_empty() {
            face.sound.clone_from(&face.triangles);
        }
    }
    split
}

/// The faces that satisfy a predicate. `Nearest` comes last of `All`, whatever the order of writing.
fn choose<'a>(predicate: &Predicate, mut faces: Vec<Face<'a>>) -> Vec<Face<'a>> {
    match predicate {
        Predicate::Radial { axis, through, within } => faces.retain(|face| face.radial(*axis, *through) <= *within),
        Predicate::Normal { direction, within } => faces.retain(|face| face.looks(*direction, *within)),
        Predicate::Box { min, max } => faces.retain(|face| face.within(*min, *max)),
        Predicate::Nearest { point } => {
            let distance = |face: &Face| face.distance(*point);
            let best = (0..faces.len()).min_by(|&i, &j| distance(&faces[i]).total_cmp(&distance(&faces[j])));
            faces = best.map(|i| faces.swap_remove(i)).into_iter().collect();
        }
        Predicate::All(predicates) => {
            let (last, first): (Vec<_>, Vec<_>) =
                predicates.iter().partition(|predicate| matches!(predicate, Predicate::Nearest { .. }));
            for predicate in first.into_iter().chain(last) {
                faces = choose(predicate, faces);
            }
        }
    }
    faces
}

impl Face<'_> {
    /// Mean angle (rad) between the normals and the plane across `axis`, or the radius from the axis through a point.
    fn radial(&self, axis: DVec3, through: Option<DVec3>) -> f64 {
        let axis = axis.normalize_or_zero();
        let (mut sum, mut area) = (0.0, 0.0);
        for &i in &self.sound {
            let cross = self.mesh.cross(i as usize);
            let normal = cross.normalize_or_zero();
            let cosine = match through {
                None => normal.reject_from(axis).length(),
                Some(through) => {
                    let [a, b, c] = self.mesh.corners(i as usize);
                    let arm = (a + b + c) / 3.0 - through;
                    normal.dot((arm - arm.dot(axis) * axis).normalize_or_zero()).abs()
                }
            };
            sum += cross.length() * cosine.min(1.0).acos();
            area += cross.length();
        }
        sum / area
    }

    fn looks(&self, direction: DVec3, within: f64) -> bool {
        let crosses = || self.sound.iter().map(|&i| self.mesh.cross(i as usize));
        let mean: DVec3 = crosses().sum();
        let area: f64 = crosses().map(DVec3::length).sum();
        // The normals of a closed surface add up to zero but for rounding: it looks nowhere.
        mean.length() > 1e-6 * area
            && mean.angle_between(direction) <= within
            && crosses().any(|cross| cross.angle_between(direction) <= within)
    }

    fn within(&self, min: DVec3, max: DVec3) -> bool {
        let slack = DVec3::splat(self.mesh.tolerance);
        let inside = |v: DVec3| v.cmpge(min - slack).all() && v.cmple(max + slack).all();
        self.triangles.iter().flat_map(|&i| self.mesh.corners(i as usize)).all(inside)
    }

    /// m
    fn distance(&self, point: DVec3) -> f64 {
        let distance = |&i: &u32| nearest(point, self.mesh.corners(i as usize)).distance(point);
        self.triangles.iter().map(distance).fold(f64::INFINITY, f64::min)
    }
}

/// The point of a triangle that is nearest to `p`, m.
/// Source: Ericson, Real-Time Collision Detection (2005), section 5.1.5.
fn nearest(p: DVec3, [a, b, c]: [DVec3; 3]) -> DVec3 {
    let (ab, ac) = (b - a, c - a);
    let (d1, d2) = (ab.dot(p - a), ac.dot(p - a));
    let (d3, d4) = (ab.dot(p - b), ac.dot(p - b));
    let (d5, d6) = (ab.dot(p - c), ac.dot(p - c));
    if d1 <= 0.0 && d2 <= 0.0 {
        return a;
    }
    if d3 >= 0.0 && d4 <= d3 {
        return b;
    }
    if d6 >= 0.0 && d5 <= d6 {
        return c;
    }
    let (va, vb, vc) = (d3 * d6 - d5 * d4, d5 * d2 - d1 * d6, d1 * d4 - d3 * d2);
    if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        return a + d1 / (d1 - d3) * ab;
    }
    if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        return a + d2 / (d2 - d6) * ac;
    }
    if va <= 0.0 && d4 >= d3 && d5 >= d6 {
        return b + (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (c - b);
    }
    a + vb / (va + vb + vc) * ab + vc / (va + vb + vc) * ac
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nearest_point_of_a_triangle_is_nearer_than_any_other() {
        let triangle = [DVec3::ZERO, DVec3::new(2.0, 0.0, 0.0), DVec3::new(0.5, 1.5, 0.3)];
        for k in 0..500 {
            let angle = k as f64;
            let p = 2.5 * DVec3::new(angle.cos(), (1.7 * angle).sin(), (0.6 * angle).sin());
            let best = nearest(p, triangle).distance(p);
            let mut least = f64::INFINITY;
            for i in 0..=60 {
                for j in 0..=60 - i {
                    let (u, v) = (f64::from(i) / 60.0, f64::from(j) / 60.0);
                    let q = triangle[0] * (1.0 - u - v) + triangle[1] * u + triangle[2] * v;
                    least = least.min(q.distance(p));
                }
            }
            assert!(best <= least + 1e-12 && least - best < 0.05, "{best} {least}");
        }
    }
}

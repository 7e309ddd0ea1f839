//! Finding the forms that a mesh lost: every smooth face of every node, and the text that declares it.
//!
//! The axes of a node are looked for first: centre lines of circular rims, those that most rims share before others. A sphere has no axis of
//! its own; it takes one of these, or that of a cylinder or cone of the node, or the line through the centres of two spheres.

mod entry;

use crate::geometry::fit::{Circle, Cloud, Fit, Kind, Line, Outcome, Search, fit, rims};
use crate::geometry::mesh::Mesh;
use crate::system::gltf::Node;
use glam::DVec3;

/// What to look for.
#[derive(Clone, Debug)]
pub struct Wish {
    /// The largest angle between neighbours on a face, rad.
    pub smooth: f64,
    /// Powers of aspheres; none are looked for if it is empty.
    pub powers: Vec<u32>,
    /// The largest distance of a corner from its form, m; what the file's rounding explains if `None`.
    pub tolerance: Option<f64>,
}

/// A smooth face of a node and its form.
#[derive(Clone, Debug)]
pub struct Face {
    /// Name of the node.
    pub node: String,
    /// Counted from 1 in the node.
    pub number: usize,
    /// Triangles of the node's mesh.
    pub triangles: Vec<u32>,
    /// A point on its largest triangle, m.
    pub point: DVec3,
    pub outcome: Outcome,
    /// What was allowed, m.
    pub tolerance: f64,
    /// rad
    pub smooth: f64,
    /// True if the node has a sphere, conic or asphere.
    of_lens: bool,
    rims: Vec<Option<Circle>>,
}

/// The inner rim of a ring is told from the outer one if it is smaller than this part of it.
const NARROWEST: f64 = 0.97;

/// Lines of a face and of a node that are tried.
const MOST_LINES: usize = 2;

/// The faces of a node (world coordinates) in the order of their first triangles.
pub fn faces(node: &Node, wish: &Wish) -> Vec<Face> {
    let split = node.mesh.faces(wish.smooth);
    let mut patches: Vec<Patch> = (0..split.count).map(|_| Patch::default()).collect();
    for (i, &of) in split.of.iter().enumerate() {
        patches[of as usize].triangles.push(i as u32);
    }
    let mut patches: Vec<Patch> =
        patches.into_iter().map(|patch| Patch::new(&node.mesh, patch.triangles, wish)).collect();
    let common = shared(patches.iter().flat_map(|patch| &patch.lines).copied().collect(), &node.mesh);
    for patch in &mut patches {
        let lines: Vec<Line> =
            patch.lines.iter().take(MOST_LINES).chain(common.iter().take(MOST_LINES)).copied().collect();
        patch.outcome = patch.search(&lines, wish);
    }
    align(&mut patches, wish);
    let height = |fit: &Fit| matches!(fit.kind, Kind::Sphere | Kind::Conic | Kind::Asphere);
    let of_lens = patches.iter().filter_map(Patch::found).any(height);
    let faces = patches.into_iter().enumerate().filter_map(|(i, patch)| {
        let outcome = patch.outcome?;
        let (point, node) = (middle(&node.mesh, &patch.triangles), node.name.clone());
        let Patch { triangles, rims, tolerance, .. } = patch;
        Some(Face { node, number: i + 1, triangles, point, outcome, tolerance, smooth: wish.smooth, of_lens, rims })
    });
    faces.collect()
}

/// A face in the making.
#[derive(Default)]
struct Patch {
    triangles: Vec<u32>,
    cloud: Option<Cloud>,
    rims: Vec<Option<Circle>>,
    /// Centre lines of its rims.
    lines: Vec<Line>,
    /// m
    rounding: f64,
    tolerance: f64,
    outcome: Option<Outcome>,
}

impl Patch {
    fn new(mesh: &Mesh, triangles: Vec<u32>, wish: &Wish) -> Patch {
        let cloud = Cloud::new(mesh, &triangles);
        // Corners that were welded may be four roundings from where they belong; exporters calculate in single precision, too.
        let rounding = 4.0 * mesh.tolerance + 2e-6 * cloud.reach();
        let tolerance = wish.tolerance.unwrap_or(rounding);
        let rims = rims(mesh, &triangles, tolerance);
        let own = rims.iter().flatten().map(Circle::line);
        let lines = own.flat_map(|line| line.neat(cloud.centre(), cloud.reach()).into_iter().chain([line])).collect();
        let rounding = rounding.min(tolerance);
        Patch { triangles, cloud: Some(cloud), rims, lines, rounding, tolerance, outcome: None }
    }

    fn search(&self, lines: &[Line], wish: &Wish) -> Option<Outcome> {
        let search = Search { lines, powers: &wish.powers, tolerance: self.tolerance, rounding: self.rounding };
        fit(self.cloud.as_ref()?, &search)
    }

    fn found(&self) -> Option<&Fit> {
        self.outcome.as_ref().filter(|outcome| outcome.found).map(|outcome| &outcome.fit)
    }
}

/// Lines without repetition, those that occur most often first.
fn shared(lines: Vec<Line>, mesh: &Mesh) -> Vec<Line> {
    let size = mesh.bounds().map_or(0.0, |[low, high]| (high - low).length());
    let slack = 4.0 * mesh.tolerance + 2e-6 * size;
    let mut kinds: Vec<(Line, usize)> = Vec::new();
    for line in lines {
        match kinds.iter_mut().find(|(other, _)| other.same(&line, line.through, size, slack)) {
            Some((_, count)) => *count += 1,
            None => kinds.push((line, 1)),
        }
    }
    kinds.sort_by_key(|(_, count)| usize::MAX - count);
    kinds.into_iter().map(|(line, _)| line).collect()
}

/// Gives spheres without an axis one that the other faces have.
fn align(patches: &mut [Patch], wish: &Wish) {
    let axes: Vec<Line> = patches
        .iter()
        .filter_map(Patch::found)
        .filter(|fit| fit.has_axis && fit.kind != Kind::Plane)
        .map(Fit::line)
        .collect();
    let centre = |fit: &Fit| (fit.kind == Kind::Sphere).then(|| fit.at + fit.radius() * fit.axis);
    let centres: Vec<DVec3> = patches.iter().filter_map(Patch::found).filter_map(centre).collect();
    for patch in patches {
        let Some(fit) = patch.found().filter(|fit| !fit.has_axis) else { continue };
        let Some((own, cloud)) = centre(fit).zip(patch.cloud.as_ref()) else { continue };
        // Nearly one centre: no line is known through both.
        let apart = |other: &&DVec3| other.distance(own) > 1e-3 * fit.radius().abs();
        let joined = centres.iter().filter(apart).map(|other| Line::new(own, (own - other).normalize()));
        let neat = joined.flat_map(|line| line.neat(own, cloud.reach()).into_iter().chain([line]));
        // It must leave the sphere where the face is, within 60 degrees of its middle.
        let towards = (cloud.centre() - own).normalize_or_zero();
        let lines: Vec<Line> = axes
            .iter()
            .copied()
            .chain(neat)
            .filter(|line| line.direction.dot(towards).abs() > 0.5)
            .take(2 * MOST_LINES)
            .collect();
        let again = patch.search(&lines, wish);
        if again.as_ref().is_some_and(|again| again.found && again.fit.kind == Kind::Sphere) {
            patch.outcome = again;
        }
    }
}

/// Centroid of the largest triangle, m.
fn middle(mesh: &Mesh, triangles: &[u32]) -> DVec3 {
    let largest = triangles.iter().max_by(|&&a, &&b| mesh.area(a as usize).total_cmp(&mesh.area(b as usize)));
    largest.map_or(DVec3::ZERO, |&t| mesh.corners(t as usize).iter().sum::<DVec3>() / 3.0)
}

impl Face {
    /// Radius of the outer rim, m, if all rims are circles about the axis: one, or two that are well apart.
    pub fn semi_diameter(&self) -> Option<f64> {
        let fit = &self.outcome.fit;
        let height = !matches!(fit.kind, Kind::Cylinder | Kind::Cone);
        let about =
            |circle: &Circle| circle.line().same(&fit.line(), circle.centre, circle.radius, 2.0 * self.tolerance);
        let circles: Vec<Circle> = self.rims.iter().copied().collect::<Option<_>>()?;
        let outer = circles.iter().map(|circle| circle.radius).fold(0.0, f64::max);
        let apart = circles.iter().filter(|circle| circle.radius > NARROWEST * outer).count() == 1;
        (height && circles.len() <= 2 && apart && circles.iter().all(about)).then_some(outer)
    }
}

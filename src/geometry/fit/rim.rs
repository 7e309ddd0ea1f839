//! Where a face ends in circles.

use super::Line;
use super::cloud::Pose;
use super::line::oriented;
use super::plane::principal;
use crate::geometry::mesh::Mesh;
use crate::math::least_squares::minimise;
use glam::DVec3;
use std::collections::HashMap;

/// A rim that is a circle.
#[derive(Clone, Copy, Debug)]
pub struct Circle {
    /// m
    pub centre: DVec3,
    /// Unit; its largest component is positive.
    pub normal: DVec3,
    /// m
    pub radius: f64,
}

impl Circle {
    /// Its centre line.
    pub fn line(&self) -> Line {
        Line { through: self.centre, direction: self.normal }
    }
}

/// Fewer corners make a polygon that is meant: the corners of a square are on a circle, too.
const FEWEST: usize = 12;
/// Largest part of a circle that one edge may span, rad: the chord of a D-shaped lens spans more.
const WIDEST: f64 = std::f64::consts::FRAC_PI_4;

/// Every closed rim of a face; `None` for one that is no circle within `slack` (m).
pub fn rims(mesh: &Mesh, triangles: &[u32], slack: f64) -> Vec<Option<Circle>> {
    loops(mesh, triangles).into_iter().map(|rim| circle(mesh, &rim, slack)).collect()
}

/// Corners of each rim in order; those of a rim that touches itself or another one are not in order.
fn loops(mesh: &Mesh, triangles: &[u32]) -> Vec<Vec<u32>> {
    let mut uses: HashMap<[u32; 2], i32> = HashMap::new();
    for &t in triangles {
        let [a, b, c] = mesh.triangles[t as usize];
        for [p, q] in [[a, b], [b, c], [c, a]] {
            *uses.entry([p.min(q), p.max(q)]).or_default() += 1;
        }
    }
    let mut beside: HashMap<u32, Vec<u32>> = HashMap::new();
    for [p, q] in uses.into_iter().filter(|(_, uses)| *uses == 1).map(|(edge, _)| edge) {
        beside.entry(p).or_default().push(q);
        beside.entry(q).or_default().push(p);
    }
    let mut starts: Vec<u32> = beside.keys().copied().collect();
    starts.sort_unstable();
    let mut rims = Vec::new();
    for start in starts {
        let (mut rim, mut pending) = (Vec::new(), vec![start]);
        while let Some(corner) = pending.pop() {
            let Some(neighbours) = beside.remove(&corner) else { continue };
            rim.push(corner);
            pending.extend(neighbours);
        }
        if !rim.is_empty() {
            rims.push(rim);
        }
    }
    rims
}

fn circle(mesh: &Mesh, rim: &[u32], slack: f64) -> Option<Circle> {
    if rim.len() < FEWEST {
        return None;
    }
    let points: Vec<DVec3> = rim.iter().map(|&v| mesh.vertices[v as usize]).collect();
    let centre = points.iter().sum::<DVec3>() / points.len() as f64;
    let size = points.iter().map(|p| p.distance(centre)).fold(0.0, f64::max);
    let points: Vec<DVec3> = points.iter().map(|p| (*p - centre) / size).collect();
    let pose = Pose::new(DVec3::ZERO, oriented(principal(&points)[0].1));
    let local: Vec<DVec3> = points.iter().map(|p| pose.local(*p)).collect();
    let off = |v: &[f64]| local.iter().map(|p| (p.x - v[0]).hypot(p.y - v[1]) - v[2]).collect();
    let found = minimise(vec![0.0, 0.0, 1.0], &off)?.values;
    let [x, y, radius] = [found[0], found[1], found[2]];
    let far = local.iter().map(|p| p.z.abs().max(((p.x - x).hypot(p.y - y) - radius).abs())).fold(0.0, f64::max);
    let span = |i: usize| {
        let (p, q) = (local[i], local[(i + 1) % local.len()]);
        (p - q).truncate().length() / radius
    };
    let round = far * size <= slack && (0..local.len()).all(|i| span(i) <= WIDEST);
    let middle = centre + size * (x * pose.frame.x + y * pose.frame.y);
    round.then_some(Circle { centre: middle, normal: pose.frame.z, radius: size * radius })
}

//! Meshes of simple bodies, mm. Normals point outwards or, for flat ones, along z, unless it says otherwise.

#[path = "../solids/icosphere.rs"]
mod icosphere;

use super::model::Mesh;
use glam::{DQuat, DVec3};
use std::f64::consts::{PI, TAU};

/// Regular polygon of `sides` about the origin whose area is that of the disc.
pub fn disk(radius: f64, sides: usize) -> Mesh {
    let radius = equal_area(radius, sides);
    (0..sides).map(|k| [DVec3::ZERO, rim(radius, k, sides), rim(radius, k + 1, sides)]).collect()
}

/// Circumradius of the polygon that has the area of the circle.
pub fn equal_area(radius: f64, sides: usize) -> f64 {
    let angle = TAU / sides as f64;
    radius * (angle / angle.sin()).sqrt()
}

fn rim(radius: f64, k: usize, sides: usize) -> DVec3 {
    let (sin, cos) = (TAU * (k % sides) as f64 / sides as f64).sin_cos();
    DVec3::new(radius * cos, radius * sin, 0.0)
}

/// Ring between two polygons, each with the area of its circle.
pub fn annulus(inner: f64, outer: f64, sides: usize) -> Mesh {
    let [inner, outer] = [inner, outer].map(|r| equal_area(r, sides));
    (0..sides)
        .flat_map(|k| quad([(inner, k), (outer, k), (outer, k + 1), (inner, k + 1)].map(|(r, k)| rim(r, k, sides))))
        .collect()
}

/// Rectangle about the origin.
pub fn rectangle(width: f64, height: f64) -> Mesh {
    let (x, y) = (0.5 * width, 0.5 * height);
    quad([(-x, -y), (x, -y), (x, y), (-x, y)].map(|(x, y)| DVec3::new(x, y, 0.0))).to_vec()
}

/// Two triangles.
pub fn quad([a, b, c, d]: [DVec3; 4]) -> [[DVec3; 3]; 2] {
    [[a, b, c], [a, c, d]]
}

/// Closed box between two corners.
pub fn cuboid(min: DVec3, max: DVec3) -> Mesh {
    box_faces(min, max).into_iter().flatten().collect()
}

/// Faces of a box: x-, x+, y-, y+, z-, z+, normals outwards.
pub fn box_faces(min: DVec3, max: DVec3) -> [Mesh; 6] {
    let corner = |x: bool, y: bool, z: bool| DVec3::select(glam::BVec3::new(x, y, z), max, min);
    let face = |axis: usize, high: bool| {
        let at = |u: bool, v: bool| match axis {
            0 => corner(high, u, v),
            1 => corner(v, high, u),
            _ => corner(u, v, high),
        };
        let (far, near) = if high { ((true, false), (false, true)) } else { ((false, true), (true, false)) };
        quad([at(false, false), at(far.0, far.1), at(true, true), at(near.0, near.1)]).to_vec()
    };
    [face(0, false), face(0, true), face(1, false), face(1, true), face(2, false), face(2, true)]
}

/// Open tube about z from `z[0]` to `z[1]`, normals outwards: a prism whose cross-section has the area of the circle.
pub fn tube(radius: f64, z: [f64; 2], sides: usize) -> Mesh {
    let radius = equal_area(radius, sides);
    let at = |k: usize, z: f64| rim(radius, k, sides) + z * DVec3::Z;
    (0..sides).flat_map(|k| quad([at(k, z[0]), at(k + 1, z[0]), at(k + 1, z[1]), at(k, z[1])])).collect()
}

/// Closed sphere about the origin: an icosahedron divided in four `levels` times, 20 x 4^levels triangles.
pub fn sphere(radius: f64, levels: u32, equal: Equal) -> Mesh {
    let faces = icosphere::icosphere(levels);
    let scale = match equal {
        Equal::Corners => radius,
        Equal::Area => radius * (4.0 * PI / area(&faces)).sqrt(),
        Equal::Volume => radius * (4.0 / 3.0 * PI / volume(&faces)).cbrt(),
    };
    faces.into_iter().map(|t| t.map(|v| scale * v)).collect()
}

/// In what a faceted body equals the round one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Equal {
    Corners,
    Area,
    Volume,
}

/// Sphere about the origin without the cap whose rim has radius `port` about +z: latitudes and longitudes, corners on
/// the sphere.
pub fn sphere_with_port(radius: f64, port: f64, rings: usize, sectors: usize) -> Mesh {
    let opening = (port / radius).asin();
    zone(radius, [opening, PI], rings, sectors)
}

/// Part of a sphere between two polar angles from +z, rad, corners on the sphere, normals outwards.
pub fn zone(radius: f64, polar: [f64; 2], rings: usize, sectors: usize) -> Mesh {
    let at = |i: usize, j: usize| {
        let theta = polar[0] + (polar[1] - polar[0]) * i as f64 / rings as f64;
        let (sin, cos) = if theta >= PI { (0.0, -1.0) } else { theta.sin_cos() };
        rim(radius * sin, j, sectors) + radius * cos * DVec3::Z
    };
    let cells = (0..rings).flat_map(|i| (0..sectors).map(move |j| (i, j)));
    let faces = cells.flat_map(|(i, j)| quad([at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)]));
    faces.filter(|[a, b, c]| (*b - *a).cross(*c - *a).length() > 1e-12 * radius * radius).collect()
}

/// The same faces seen from the other side.
pub fn flipped(mesh: Mesh) -> Mesh {
    mesh.into_iter().map(|[a, b, c]| [a, c, b]).collect()
}

pub fn moved(mesh: Mesh, by: DVec3) -> Mesh {
    mesh.into_iter().map(|t| t.map(|v| v + by)).collect()
}

/// Turned so that z goes to `normal`.
pub fn facing(mesh: Mesh, normal: DVec3) -> Mesh {
    let turn = DQuat::from_rotation_arc(DVec3::Z, normal.normalize());
    mesh.into_iter().map(|t| t.map(|v| turn * v)).collect()
}

/// mm2.
pub fn area(mesh: &Mesh) -> f64 {
    mesh.iter().map(|[a, b, c]| 0.5 * (*b - *a).cross(*c - *a).length()).sum()
}

/// mm3, positive if normals point outwards.
pub fn volume(mesh: &Mesh) -> f64 {
    mesh.iter().map(|[a, b, c]| a.dot(b.cross(*c)) / 6.0).sum()
}

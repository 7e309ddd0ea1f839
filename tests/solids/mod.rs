//! Closed meshes with shared corners, and rays through them.

#![allow(dead_code, reason = "each test file uses its own part")]

mod icosphere;

use glam::DVec3;
use straylight::geometry::{Body, Bvh, Left, Ray, Triangle};
use straylight::math::Rng;

/// Icosahedron with every face divided in four `levels` times, corners on the unit sphere: 20 x 4^levels triangles.
pub fn icosphere(levels: u32) -> Vec<Triangle> {
    icosphere::icosphere(levels).into_iter().map(|vertices| Triangle { vertices }).collect()
}

/// Latitudes and longitudes: slivers at the poles.
pub fn uv_sphere(rings: usize, sectors: usize) -> Vec<Triangle> {
    let at = |i: usize, j: usize| {
        let (theta, phi) = (std::f64::consts::PI * i as f64 / rings as f64, angle(j, sectors));
        let radius = if i == 0 || i == rings { 0.0 } else { theta.sin() };
        DVec3::new(radius * phi.cos(), radius * phi.sin(), theta.cos())
    };
    quads(rings, sectors, at)
}

/// About z, radii 1 and 0.3.
pub fn torus(rings: usize, sectors: usize) -> Vec<Triangle> {
    let at = |i: usize, j: usize| {
        let (theta, phi) = (-angle(i, rings), angle(j, sectors));
        let radius = 1.0 + 0.3 * theta.cos();
        DVec3::new(radius * phi.cos(), radius * phi.sin(), 0.3 * theta.sin())
    };
    quads(rings, sectors, at)
}

fn angle(i: usize, of: usize) -> f64 {
    std::f64::consts::TAU * (i % of) as f64 / of as f64
}

fn quads(rows: usize, columns: usize, at: impl Fn(usize, usize) -> DVec3) -> Vec<Triangle> {
    let cells = (0..rows).flat_map(|i| (0..columns).map(move |j| (i, j)));
    let faces = cells.flat_map(|(i, j)| {
        let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
        [[a, b, c], [a, c, d]]
    });
    faces.map(|vertices| Triangle { vertices }).filter(|t| t.area() > 0.0).collect()
}

/// From -1 to 1, every face divided in `n` x `n` squares.
pub fn cube(n: usize) -> Vec<Triangle> {
    let at = |i: usize| -1.0 + 2.0 * i as f64 / n as f64;
    let mut faces = Vec::new();
    for axis in 0..3 {
        for (side, swap) in [(1.0, false), (-1.0, true)] {
            let place = |i: usize, j: usize| {
                let mut v = DVec3::ZERO;
                let (first, second) = if swap { (j, i) } else { (i, j) };
                (v[axis], v[(axis + 1) % 3], v[(axis + 2) % 3]) = (side, at(first), at(second));
                v
            };
            for (i, j) in (0..n).flat_map(|i| (0..n).map(move |j| (i, j))) {
                let [a, b, c, d] = [place(i, j), place(i + 1, j), place(i + 1, j + 1), place(i, j + 1)];
                faces.extend([[a, b, c], [a, c, d]]);
            }
        }
    }
    faces.into_iter().map(|vertices| Triangle { vertices }).collect()
}

/// One object, exact corners.
pub fn bvh(triangles: &[Triangle]) -> Bvh {
    let vertices: Vec<DVec3> = triangles.iter().flat_map(|triangle| triangle.vertices).collect();
    let triangles: Vec<_> = (0..triangles.len() as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    Bvh::build(&[Body { vertices: &vertices, triangles: &triangles, tolerance: 0.0, faces: &[], replaced: &[] }])
}

pub fn moved(triangles: &[Triangle], by: DVec3) -> Vec<Triangle> {
    triangles.iter().map(|t| Triangle { vertices: t.vertices.map(|v| v + by) }).collect()
}

/// Uniform on the unit sphere.
pub fn isotropic(rng: &mut Rng) -> DVec3 {
    let [a, b] = rng.pair();
    let (z, phi) = (1.0 - 2.0 * a, std::f64::consts::TAU * b);
    let sin = (1.0 - z * z).max(0.0).sqrt();
    DVec3::new(sin * phi.cos(), sin * phi.sin(), z)
}

/// Everything a ray meets until it escapes: how often it entered and left, walking on from each crossing.
pub fn walk(bvh: &Bvh, ray: &Ray) -> [usize; 2] {
    let (mut counts, mut ray, mut left) = ([0, 0], *ray, Left::nothing());
    for _ in 0..1000 {
        let Some(crossing) = bvh.nearest(&ray, &left) else { return counts };
        for hit in &crossing.hits {
            counts[!hit.front as usize] += 1;
        }
        left = Left::after(&crossing, true, &left);
        ray.origin = crossing.point;
    }
    panic!("{ray:?} never escapes");
}

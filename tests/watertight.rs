//! No ray leaks through a closed mesh, wherever it comes from and wherever it is aimed.

mod solids;

use glam::DVec3;
use proptest::prelude::*;
use solids::{bvh, cube, icosphere, isotropic, moved, torus, uv_sphere, walk};
use straylight::geometry::{Bvh, Left, Ray, Triangle};
use straylight::math::Rng;

fn meshes() -> Vec<(&'static str, Vec<Triangle>)> {
    vec![("icosphere", icosphere(4)), ("uv sphere", uv_sphere(40, 90)), ("cube", cube(7)), ("torus", torus(30, 80))]
}

/// Corners, edge midpoints, points on edges and the centre.
fn targets(triangles: &[Triangle]) -> Vec<DVec3> {
    let some = triangles.iter().step_by(1 + triangles.len() / 300);
    let of = |t: &Triangle| {
        let [a, b, c] = t.vertices;
        [a, 0.5 * (b + c), a + 0.3 * (b - a), 0.5 * (a + c), t.centroid()]
    };
    some.flat_map(of).chain([DVec3::ZERO]).collect()
}

#[test]
fn a_ray_enters_a_closed_surface_as_often_as_it_leaves_it() {
    for (name, triangles) in meshes() {
        let bvh = bvh(&triangles);
        let mut rng = Rng::new(1, 0, 0);
        for _ in 0..20_000 {
            let ray = Ray { origin: 3.0 * isotropic(&mut rng), direction: isotropic(&mut rng) };
            let [entered, left] = walk(&bvh, &ray);
            assert_eq!(entered, left, "{name} {ray:?}");
        }
    }
}

/// Away from the middle of the body: from there no silhouette is seen at `target`. (A ray that cuts off less of an
/// edge than a rounding may meet its two faces in either order.)
fn outward(name: &str, target: DVec3) -> DVec3 {
    let ring = DVec3::new(target.x, target.y, 0.0).normalize_or_zero();
    (if name == "torus" { target - ring } else { target }).normalize_or_zero()
}

#[test]
fn no_ray_leaks_through_a_corner_or_an_edge() {
    for (name, triangles) in meshes() {
        for offset in [DVec3::ZERO, DVec3::new(1000.0, -300.0, 77.7)] {
            let bvh = bvh(&moved(&triangles, offset));
            let mut rng = Rng::new(2, 0, 0);
            for target in targets(&triangles) {
                for distance in [6.0, 100.0, 2e4] {
                    let from = (outward(name, target) + 0.3 * isotropic(&mut rng)).normalize();
                    let (origin, through) = (offset + target + distance * from, offset + target);
                    let ray = Ray { origin, direction: (through - origin).normalize() };
                    let [entered, left] = walk(&bvh, &ray);
                    assert_eq!(entered, left, "{name} {ray:?}");
                    assert!(entered > 0 || (name, target) == ("torus", DVec3::ZERO), "{name} {ray:?}");
                }
            }
        }
    }
}

#[test]
fn no_ray_leaves_a_convex_body_through_a_corner_or_an_edge_without_meeting_it() {
    for (name, triangles) in meshes().into_iter().filter(|(name, _)| *name != "torus") {
        let bvh = bvh(&triangles);
        let mut rng = Rng::new(4, 0, 0);
        for target in targets(&triangles) {
            for size in [0.0, 1e-9, 0.5] {
                let origin = size * isotropic(&mut rng);
                let ray = Ray { origin, direction: (target - origin).try_normalize().unwrap_or(DVec3::X) };
                assert_eq!(walk(&bvh, &ray), [0, 1], "{name} {ray:?}");
            }
        }
    }
}

#[test]
fn a_beam_along_an_axis_meets_every_convex_body_twice_from_any_distance() {
    for (name, triangles) in meshes().into_iter().filter(|(name, _)| *name != "torus") {
        let bvh = bvh(&triangles);
        for axis in [DVec3::X, DVec3::Y, DVec3::Z] {
            for side in [1.0, -1.0] {
                for i in 0..900 {
                    let (u, v) = ((i % 30) as f64 / 29.0 - 0.5, (i / 30) as f64 / 29.0 - 0.5);
                    let across = u * axis.any_orthonormal_vector() + v * axis.cross(axis.any_orthonormal_vector());
                    for distance in [1.5, 1e4, 1e6] {
                        let ray = Ray { origin: across - side * distance * axis, direction: side * axis };
                        assert_eq!(walk(&bvh, &ray), [1, 1], "{name} {ray:?}");
                    }
                }
            }
        }
    }
}

#[test]
fn no_ray_escapes_from_a_closed_cavity() {
    for (name, triangles) in meshes() {
        for offset in [DVec3::ZERO, DVec3::new(0.0, 1000.0, 0.0)] {
            let bvh = bvh(&moved(&triangles, offset));
            let mut rng = Rng::new(3, 0, 0);
            let start = if name == "torus" { DVec3::X } else { DVec3::ZERO };
            let mut ray = Ray { origin: offset + start, direction: isotropic(&mut rng) };
            let mut left = Left::nothing();
            for bounce in 0..20_000 {
                let crossing = bvh.nearest(&ray, &left).unwrap_or_else(|| panic!("{name} {bounce} {ray:?}"));
                let hit = crossing.hits[0];
                assert!(!hit.front, "{name} {bounce} {ray:?}");
                let normal = bvh.normal(hit.triangle);
                let mut direction = isotropic(&mut rng);
                direction -= 2.0 * direction.dot(normal).max(0.0) * normal;
                left = Left::after(&crossing, false, &left);
                ray = Ray { origin: crossing.point, direction };
            }
        }
    }
}

/// The nearest hit by asking every triangle alone.
fn exhaustive(triangles: &[Triangle], ray: &Ray) -> Option<(f64, u32)> {
    let one = |(i, t): (usize, &Triangle)| {
        bvh(std::slice::from_ref(t)).nearest(ray, &Left::nothing()).map(|crossing| (crossing.distance, i as u32))
    };
    triangles.iter().enumerate().filter_map(one).min_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)))
}

fn soup(seed: u64, count: usize, size: f64) -> Vec<Triangle> {
    let mut rng = Rng::new(seed, 0, 0);
    let mut triangle = || {
        let (at, ball) = (isotropic(&mut rng), |rng: &mut Rng| size * rng.uniform() * isotropic(rng));
        Triangle { vertices: [at + ball(&mut rng), at + ball(&mut rng), at + ball(&mut rng)] }
    };
    (0..count).map(|_| triangle()).collect()
}

fn nearest(bvh: &Bvh, ray: &Ray) -> Option<(f64, u32)> {
    bvh.nearest(ray, &Left::nothing()).map(|crossing| (crossing.distance, crossing.hits[0].triangle))
}

#[test]
fn the_tree_finds_what_asking_every_triangle_finds() {
    for (seed, size) in [(1, 0.01), (2, 0.1), (3, 1.0)] {
        let triangles = soup(seed, 300, size);
        let bvh = bvh(&triangles);
        let mut rng = Rng::new(seed, 1, 0);
        for i in 0..1500 {
            let origin = [0.0, 1.0, 3.0, 1e4][i % 4] * isotropic(&mut rng);
            let direction = match i % 5 {
                0 => DVec3::AXES[i % 3],
                1 => (0.8 * isotropic(&mut rng) - origin).normalize(),
                _ => (triangles[i % 300].centroid() - origin).normalize(),
            };
            let ray = Ray { origin, direction };
            assert_eq!(nearest(&bvh, &ray), exhaustive(&triangles, &ray), "{ray:?}");
        }
    }
}

fn small() -> impl Strategy<Value = f64> {
    prop_oneof![(-4i32..=4).prop_map(f64::from), -4.0..4.0]
}

fn point() -> impl Strategy<Value = DVec3> {
    (small(), small(), small()).prop_map(|(x, y, z)| DVec3::new(x, y, z))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    /// A fan about one corner covers a disc: a ray through the corner, or any edge, meets one triangle of it.
    #[test]
    fn every_point_of_a_fan_belongs_to_exactly_one_triangle(
        apex in point(), n in 3usize..9, at in 0usize..9, part in prop_oneof![Just(0.0), Just(0.5), 0.0..0.9],
        from in point(),
    ) {
        let rim = |i: usize| {
            let phi = std::f64::consts::TAU * (i % n) as f64 / n as f64;
            apex + DVec3::new(phi.cos(), phi.sin(), 0.0)
        };
        let fan: Vec<_> = (0..n).map(|i| Triangle { vertices: [apex, rim(i), rim(i + 1)] }).collect();
        let target = apex + part * (rim(at) - apex);
        prop_assume!((from.z - apex.z).abs() > 1e-3);
        let ray = Ray { origin: from, direction: (target - from).normalize() };
        let owners = fan.iter().filter(|t| nearest(&bvh(std::slice::from_ref(t)), &ray).is_some()).count();
        prop_assert_eq!(owners, 1);
        prop_assert!(nearest(&bvh(&fan), &ray).is_some());
    }

    /// A closed tetrahedron is entered as often as it is left, wherever the ray comes from and however flat it is.
    #[test]
    fn a_tetrahedron_is_left_as_often_as_it_is_entered(
        v in [point(), point(), point(), point()], from in point(), through in point(),
        at in 0usize..4, mode in 0usize..4,
    ) {
        let target = [v[at], 0.5 * (v[at] + v[(at + 1) % 4]), through, (v[0] + v[1] + v[2]) / 3.0][mode];
        let origin = from + 20.0 * DVec3::new(1.0, 0.5, 0.25);
        let ray = Ray { origin, direction: (target - origin).normalize() };
        let faces = [[0, 1, 2], [0, 3, 1], [1, 3, 2], [2, 3, 0]];
        let mut balance = 0;
        for face in faces {
            let alone = bvh(&[Triangle { vertices: face.map(|i| v[i]) }]);
            if let Some(crossing) = alone.nearest(&ray, &Left::nothing()) {
                balance += if crossing.hits[0].front { 1 } else { -1 };
            }
        }
        prop_assert_eq!(balance, 0);
    }
}

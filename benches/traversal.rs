//! Closest-hit queries per second.

#[path = "../tests/solids/mod.rs"]
mod solids;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use glam::DVec3;
use solids::{bvh, icosphere, isotropic, torus};
use std::hint::black_box;
use straylight::geometry::{Bvh, Left, Ray};
use straylight::math::Rng;

const RAYS: usize = 20_000;

/// Rays between points of the inside, each starting on the wall: incoherent.
fn cavity(bvh: &Bvh, start: DVec3) -> Vec<(Ray, Left)> {
    let mut rng = Rng::new(1, 0, 0);
    let mut state = (Ray { origin: start, direction: isotropic(&mut rng) }, Left::nothing());
    let mut next = || {
        let crossing = bvh.nearest(&state.0, &state.1).expect("the cavity is closed");
        let hit = crossing.hits[0];
        let direction = (isotropic(&mut rng) - (1.0 + 1e-9) * bvh.normal(hit.triangle)).normalize();
        let left = Left::after(&crossing, false, &state.1);
        state = (Ray { origin: crossing.point, direction }, left);
        state.clone()
    };
    (0..RAYS).map(|_| next()).collect()
}

fn ask(bvh: &Bvh, queries: &[(Ray, Left)]) -> f64 {
    queries.iter().filter_map(|(ray, left)| bvh.nearest(ray, left)).map(|crossing| crossing.distance).sum()
}

fn traversal(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("closest hit");
    group.throughput(Throughput::Elements(RAYS as u64)).sample_size(20);
    for (name, triangles, start) in [
        ("icosphere 20480, cavity", icosphere(5), DVec3::ZERO),
        ("icosphere 1310720, cavity", icosphere(8), DVec3::ZERO),
        ("torus 20000, cavity", torus(100, 100), DVec3::X),
    ] {
        let bvh = bvh(&triangles);
        let queries = cavity(&bvh, start);
        group.bench_function(name, |bench| bench.iter(|| black_box(ask(&bvh, &queries))));
    }
    group.finish();
}

criterion_group!(benches, traversal);
criterion_main!(benches);

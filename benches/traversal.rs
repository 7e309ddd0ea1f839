//! Closest-hit queries per second.

#[path = "../tests/solids/mod.rs"]
mod solids;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use glam::DVec3;
use solids::{bvh, icosphere, isotropic, torus};
use std::hint::black_box;
use std::path::Path;
use straylight::geometry::{Bvh, Left, Ray};
use straylight::math::{Rng, sampling};
use straylight::system::compile::{compile, geometry};
use straylight::system::document::Document;

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

/// A biconvex lens 20 mm wide: as an element, whose surfaces are exact, or as the facets that `export` makes of it.
fn lens(folder: &Path, body: &str) -> Document {
    let text = format!(
        "System({body} media: {{ \"glass\": Constant(n: 1.5) }}, surfaces: [(on: Node(\"*\"), medium: \"glass\", specular: Fresnel)],
        sources: {{ \"lamp\": (flux: \"1 W\", extent: Point, at: \"(0, 0, -1) m\", angular: Collimated(direction: \"(0, 0, 1)\"),
        spectrum: Line(\"550 nm\")) }}, detectors: {{}}, run: (rays: 1000, seed: 1))"
    );
    let path = folder.join("system.ron");
    std::fs::write(&path, text).expect("written");
    Document::read(&path).expect("a system")
}

/// The same rays at the same lens, exact and faceted: what a hit on an exact surface costs beside one on a facet.
fn exact(criterion: &mut Criterion) {
    let folder = tempfile::tempdir().expect("a folder");
    let element = lens(
        folder.path(),
        "geometry: [], elements: { \"lens\": (body: Lens(surfaces: [(form: Sphere(radius: \"50 mm\")), (form: Sphere(radius: \"-40 mm\"))],
         thickness: [\"6 mm\"], media: [\"glass\"], diameter: \"20 mm\")) },",
    );
    let placed = geometry(&element).expect("its mesh");
    std::fs::write(folder.path().join("lens.glb"), placed.glb()).expect("written");
    let exact = compile(&element).expect("the element compiles").scene;
    let facets = compile(&lens(folder.path(), "geometry: [(file: \"lens.glb\")],")).expect("the mesh compiles").scene;
    let mut rng = Rng::new(1, 0, 0);
    let queries: Vec<(Ray, Left)> = (0..RAYS)
        .map(|_| {
            let origin = 0.06 * sampling::sphere(rng.pair());
            let target = DVec3::new(0.0, 0.0, 0.003) + 0.008 * sampling::sphere(rng.pair()) * DVec3::new(1.0, 1.0, 0.2);
            (Ray { origin, direction: (target - origin).normalize() }, Left::nothing())
        })
        .collect();
    let mut group = criterion.benchmark_group("a lens");
    group.throughput(Throughput::Elements(RAYS as u64)).sample_size(20);
    for (name, scene) in [("exact faces".into(), &exact), (format!("{} facets", facets.geometry.len()), &facets)] {
        let shift = scene.shift;
        let moved: Vec<(Ray, Left)> =
            queries.iter().map(|(ray, left)| (Ray { origin: ray.origin - shift, ..*ray }, left.clone())).collect();
        group.bench_function(name, |bench| bench.iter(|| black_box(ask(&scene.geometry, &moved))));
    }
    group.finish();
}

criterion_group!(benches, traversal, exact);
criterion_main!(benches);

//! Transport segments per second on the shipped systems, and closest-hit queries per second on the very same flights: what a
//! segment costs beyond its query is the physics. One thread, so that the two compare. And one plate, bare and under thirty films.
//! Requirement: the films cost less than twice the bare face.

use criterion::measurement::WallTime;
use criterion::{BenchmarkGroup, Criterion, Throughput, criterion_group, criterion_main};
use std::hint::black_box;
use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;
use straylight::geometry::{Bvh, Left, Ray};
use straylight::scene::Scene;
use straylight::settings::Settings;
use straylight::system::compile::{Compiled, compile};
use straylight::system::document::Document;
use straylight::tally::Live;
use straylight::transport::book::Book;
use straylight::transport::run;
use straylight::transport::walk::{Walk, quotas};
use straylight::transport::watch::Watch;

/// Source rays per system, for some 1e5 segments each.
const SYSTEMS: [(&str, u64); 4] =
    [("integrating_sphere", 2048), ("baffled_tube", 32768), ("slab", 8192), ("triplet", 8192)];

fn folder(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("systems").join(name)
}

fn load(path: &Path, rays: u64) -> Compiled {
    let document = Document::read(path).expect("the system ships with the project");
    let mut compiled = compile(&document).expect("the system compiles");
    // No pilot: it would trace rays that are not counted.
    compiled.settings = Settings { rays, batch: Some(rays / 32), paths: 0, until: None, ..compiled.settings };
    compiled
}

/// Notes every flight.
#[derive(Default)]
struct Flights(Vec<(Ray, Left)>);

impl Watch for Flights {
    fn flight(&mut self, ray: &Ray, left: &Left) {
        self.0.push((*ray, left.clone()));
    }
}

/// All flights of the run that [`run`] makes.
fn flights(scene: &Scene, settings: &Settings) -> Vec<(Ray, Left)> {
    let slots = scene.layout(0);
    let book = Book::new(&slots, Live::<1>::new(slots.len()), None);
    let watch = Flights::default();
    let mut walk = Walk { scene, settings, seed: settings.seed, book, watch, waiting: Vec::new(), start: 0.0 };
    let quotas = quotas(scene, settings.batch_rays());
    for batch in 0..settings.batches() {
        walk.batch(batch, &quotas);
        walk.book.finish();
    }
    walk.watch.0
}

fn ask(geometry: &Bvh, flights: &[(Ray, Left)]) -> f64 {
    flights.iter().filter_map(|(ray, left)| geometry.nearest(ray, left)).map(|crossing| crossing.distance).sum()
}

/// Segments of the run on one thread.
fn trace(scene: &Scene, settings: &Settings) -> u64 {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("one thread");
    pool.install(|| run::<1>(scene, settings, &AtomicBool::new(false), &|_| ()).segments)
}

fn system(group: &mut BenchmarkGroup<WallTime>, name: &str, rays: u64) {
    let Compiled { scene, settings, .. } = load(&folder(name).join("system.ron"), rays);
    let trace = || trace(&scene, &settings);
    let segments = trace();
    let flights = flights(&scene, &settings);
    assert_eq!(segments, flights.len() as u64, "{name}: the recorded run is another one");
    group.throughput(Throughput::Elements(segments)).sample_size(10);
    group.bench_function(format!("{name}, segments"), |bench| bench.iter(|| black_box(trace())));
    group.bench_function(format!("{name}, their closest hits"), |bench| {
        bench.iter(|| black_box(ask(&scene.geometry, &flights)))
    });
}

/// Thirty films of half a wave, which at normal incidence are as good as none: the rays are those of the bare plate.
fn films(group: &mut BenchmarkGroup<WallTime>) {
    let bare = std::fs::read_to_string(folder("slab").join("system.ron")).expect("the system ships with the project");
    let layers = r#"Stack(design: "1100 nm", layers: [Repeat(15, [("H", "1/4 wave"), ("L", "1/4 wave")])])"#;
    let coated = bare
        .replace("media: {", r#"media: { "H": Constant(n: 2.35), "L": Constant(n: 1.46),"#)
        .replace("surfaces: [", &format!("coatings: {{ \"films\": {layers} }},\n    surfaces: ["))
        .replace("specular: Fresnel", r#"coating: "films""#);
    let place = tempfile::tempdir().expect("a folder");
    std::fs::copy(folder("slab").join("slab.glb"), place.path().join("slab.glb")).expect("the mesh is there");
    for (name, text) in [("slab, bare", bare), ("slab, thirty films", coated)] {
        let path = place.path().join("system.ron");
        std::fs::write(&path, text).expect("the folder can be written");
        let Compiled { scene, settings, .. } = load(&path, 8192);
        group.throughput(Throughput::Elements(trace(&scene, &settings))).sample_size(10);
        group.bench_function(name, |bench| bench.iter(|| black_box(trace(&scene, &settings))));
    }
}

fn transport(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("transport");
    for (name, rays) in SYSTEMS {
        system(&mut group, name, rays);
    }
    films(&mut group);
    group.finish();
}

criterion_group!(benches, transport);
criterion_main!(benches);

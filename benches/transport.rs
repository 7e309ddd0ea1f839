//! Transport segments per second on the shipped systems, and closest-hit queries per second on the very same flights: what a
//! segment costs beyond its query is the physics. One thread, so that the two compare. Flights per second between coated lenses in
//! light of every kind of spectrum, since rays of each have a few per cent more or fewer: a band should cost no more than a line. And
//! one plate, bare and under thirty films. Requirement: the films cost less than twice the bare face.

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
use straylight::transport::importance::Importance;
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
    let importance = Importance::declared(scene);
    let mut walk = Walk::new(scene, settings, &importance, book, watch);
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

/// The kinds of spectra.
const SPECTRA: [(&str, &str); 5] = [
    ("line", "Line(\"550 nm\")"),
    ("lines", "Lines([(\"480 nm\", 1), (\"550 nm\", 2), (\"640 nm\", 1)])"),
    ("band", "Band(from: \"450 nm\", to: \"650 nm\")"),
    ("table", "Table(wavelength: [\"450 nm\", \"500 nm\", \"600 nm\", \"650 nm\"], weight: [0.2, 1, 1.5, 0.3])"),
    ("black body", "BlackBody(temperature: \"5778 K\", from: \"450 nm\", to: \"650 nm\")"),
];

/// Three lenses of catalogue glasses under forty layers each, in a tube of measured scatter. The layers are nearly those of the
/// glass, so that as much light takes each way in every spectrum.
fn coated(spectrum: &str, rays: u64) -> Compiled {
    let thickness = |i: usize| 30 + 37 * i % 80;
    let layers: Vec<String> =
        (0..40).map(|i| format!("(\"{}\", \"{} nm\")", ["H", "L"][i % 2], thickness(i))).collect();
    let wall = Path::new(env!("CARGO_MANIFEST_DIR")).join("systems/triplet/black-anodize-plausible.anisotropicbsdf");
    let text = format!(
        "System(
            ambient: \"air\",
            media: {{ \"air\": Air(), \"crown\": Glass(\"N-SK16\"), \"flint\": Glass(\"N-F2\"), \"L\": Glass(\"N-BK7\"),
                \"H\": Sellmeier(b: [1.5, 0.1], c: [\"0.01 um2\", \"0.03 um2\"]) }},
            coatings: {{ \"films\": Stack(layers: [{}]) }},
            scatter: {{ \"wall\": Table(file: {wall:?}) }},
            elements: {{
                \"L1\": (body: Lens(surfaces: [(form: Sphere(radius: \"60 mm\")), (form: Sphere(radius: \"-80 mm\"))],
                    thickness: [\"6 mm\"], media: [\"crown\"], diameter: \"24 mm\")),
                \"L2\": (body: Lens(surfaces: [(form: Sphere(radius: \"-50 mm\")), (form: Sphere(radius: \"70 mm\"))],
                    thickness: [\"2 mm\"], media: [\"flint\"], diameter: \"24 mm\"), at: \"(0, 0, 14) mm\"),
                \"L3\": (body: Lens(surfaces: [(form: Sphere(radius: \"90 mm\")), (form: Sphere(radius: \"-50 mm\"))],
                    thickness: [\"5 mm\"], media: [\"crown\"], diameter: \"24 mm\"), at: \"(0, 0, 22) mm\"),
                \"tube\": (body: Tube(inner: \"25 mm\", outer: \"28 mm\", length: \"70 mm\"), at: \"(0, 0, -5) mm\"),
                \"image\": (body: Aperture(diameter: \"0 mm\", outer: \"24.9 mm\"), at: \"(0, 0, 65) mm\"),
            }},
            default: (specular: Absorb, scatter: \"wall\"),
            surfaces: [
                (on: Tag(\"L?.front\"), coating: \"films\"), (on: Tag(\"L?.back\"), coating: \"films\"),
                (on: Node(\"image\"), specular: Absorb),
            ],
            sources: {{ \"sun\": (flux: \"1 W\", extent: Disk(radius: \"11 mm\"), at: \"(0, 1.5, -10) mm\",
                angular: Collimated(direction: \"(0, 0.1, 1)\"), spectrum: {spectrum}) }},
            detectors: {{ \"image\": (on: Node(\"image\"), quantity: Irradiance, pixels: (64, 64)) }},
            run: (rays: {rays}, paths: 0),
        )",
        layers.join(", ")
    );
    let folder = tempfile::tempdir().expect("a folder for the system");
    let path = folder.path().join("system.ron");
    std::fs::write(&path, text).expect("written");
    let document = Document::read(&path).unwrap_or_else(|e| panic!("{:#?}", e.problems()));
    compile(&document).unwrap_or_else(|e| panic!("{:#?}", e.problems()))
}

fn spectra(criterion: &mut Criterion) {
    const RAYS: u64 = 4096;
    let mut group = criterion.benchmark_group("spectra");
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("one thread");
    let stop = AtomicBool::new(false);
    for (name, spectrum) in SPECTRA {
        let Compiled { scene, settings, .. } = coated(spectrum, RAYS);
        let trace = || pool.install(|| run::<1>(&scene, &settings, &stop, &|_| ()).segments);
        let flights = trace();
        println!("{name}: {:.2} flights per ray", flights as f64 / RAYS as f64);
        group.throughput(Throughput::Elements(flights)).sample_size(10);
        group.bench_function(name, |bench| bench.iter(|| black_box(trace())));
    }
    group.finish();
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

criterion_group!(benches, transport, spectra);
criterion_main!(benches);

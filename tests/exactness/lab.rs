//! The bench: systems written as text, single rays sent through them, and everything that is seen.

use crate::support::Model;
use glam::{DVec2, DVec3};
use serde_json::Value;
use std::f64::consts::FRAC_PI_2;
use std::sync::atomic::AtomicBool;
use straylight::error::Error;
use straylight::geometry::Ray;
use straylight::source::Birth;
use straylight::system::compile::{Compiled, compile};
use straylight::system::document::Document;
use straylight::tally::results::{PathResult, Results};
use straylight::tally::{Layout, Live};
use straylight::transport::book::Book;
use straylight::transport::importance::Importance;
use straylight::transport::paths::Rows;
use straylight::transport::walk::{Walk, quotas};
use straylight::transport::watch::{Sight, Watch};
use straylight::transport::{self, summary};

/// Compiles a system whose geometry is `parts.gltf` (mm) with this text; `sections` as the harness has them.
pub fn compile_gltf(sections: &str, gltf: &str) -> Result<Compiled, Error> {
    let folder = tempfile::tempdir().expect("a folder for the system");
    let path = folder.path().join("system.ron");
    let geometry = "geometry: [(file: \"parts.gltf\", unit: \"mm\")],";
    let geometry = if sections.contains("geometry:") { "" } else { geometry };
    std::fs::write(folder.path().join("parts.gltf"), gltf).expect("written");
    std::fs::write(&path, format!("System(\n{geometry}\n{sections}\n)")).expect("written");
    compile(&Document::read(&path)?)
}

/// As [`compile_gltf`], for systems that must be right.
pub fn system(sections: &str, gltf: &str) -> Compiled {
    compile_gltf(sections, gltf).unwrap_or_else(|e| panic!("{e}\n{:#?}\n{sections}", e.problems()))
}

/// Traces as the system's own `run` section says.
pub fn traced(compiled: &Compiled) -> Results {
    let counts = transport::run::<1>(&compiled.scene, &compiled.settings, &AtomicBool::new(false), &|_| ());
    let results = summary::results(&compiled.scene, &compiled.settings, &counts, 0, Default::default(), Vec::new());
    assert!(results.trusted, "{:?}", results.warnings);
    results
}

/// Compiles and traces.
pub fn results(sections: &str, model: &Model) -> Results {
    traced(&system(sections, &model.gltf()))
}

/// A run of single rays, all the same.
pub const SINGLE: &str = "run: (rays: 32, batch: 1, paths: 0),";

/// A run without chance: every ray is the same, all branches are followed.
pub const CERTAIN: &str =
    "run: (rays: 32, batch: 1, splits: 40, scatter_splits: 40, roulette: (below: 1e-14, survive: 0.5), paths: 1000),";

/// Source section: a pencil of 1 W that starts 100 mm before `target` (mm).
pub fn pencil(target: DVec3, direction: DVec3, polarization: &str, wavelength: &str) -> String {
    pencil_from(target - 100.0 * direction, direction, polarization, wavelength)
}

/// Source section: a pencil of 1 W that starts at `from` (mm). Linear(0) is along y, or x for a pencil along y.
pub fn pencil_from(from: DVec3, direction: DVec3, polarization: &str, wavelength: &str) -> String {
    let x = if direction.y.abs() > 0.9 { "(1, 0, 0)" } else { "(0, 1, 0)" };
    format!(
        "sources: {{ \"beam\": (flux: \"1 W\", extent: Point, at: \"{} mm\", x: \"{x}\", \
         angular: Collimated(direction: \"{}\"), spectrum: Line(\"{wavelength}\"), polarization: {polarization}) }},",
        written(from),
        written(direction)
    )
}

/// A vector with all its digits.
pub fn written(v: DVec3) -> String {
    format!("({:?}, {:?}, {:?})", v.x, v.y, v.z)
}

/// What a watcher saw.
#[derive(Default)]
pub struct Seen {
    pub sights: Vec<Sight>,
    /// Rays that left the scene, and their flux, W.
    pub escaped: Vec<(Ray, f64)>,
}

impl Watch for Seen {
    fn event(&mut self, sight: impl FnOnce() -> Sight) {
        self.sights.push(sight());
    }
    fn escaped(&mut self, ray: Ray, flux: f64) {
        self.escaped.push((ray, flux));
    }
}

/// What a few rays came to: everything seen, and their bill, W.
pub struct Trace {
    pub seen: Seen,
    pub absorbed: f64,
    pub escaped: f64,
    pub terminated: f64,
    pub lost: f64,
    pub residual: f64,
}

impl Trace {
    /// Sights at a part, in order.
    pub fn at<'a>(&'a self, compiled: &Compiled, label: &str) -> Vec<&'a Sight> {
        let part = compiled.scene.parts.iter().position(|p| p.label == label);
        let part = part.unwrap_or_else(|| panic!("no part {label}")) as u32;
        self.seen.sights.iter().filter(|s| s.part == part).collect()
    }

    /// The brightest ray that left the scene.
    pub fn brightest(&self) -> Ray {
        self.seen.escaped.iter().max_by(|a, b| a.1.total_cmp(&b.1)).expect("something escapes").0
    }
}

/// Batch `batch` of the system's own sources, watched.
pub fn watched(compiled: &Compiled, batch: u64) -> Trace {
    let (scene, settings) = (&compiled.scene, &compiled.settings);
    follow(compiled, |walk| walk.batch(batch, &quotas(scene, settings.batch_rays())))
}

/// Rays of 1 W of unpolarised light of 550 nm, in world coordinates (m), watched.
pub fn shot(compiled: &Compiled, rays: &[Ray]) -> Trace {
    follow(compiled, |walk| {
        for (history, ray) in rays.iter().enumerate() {
            let ray = Ray { origin: ray.origin - compiled.scene.shift, ..*ray };
            let transverse = ray.direction.any_orthonormal_vector();
            let birth = Birth { ray, normal: ray.direction, from: None, wavelength: 550e-9, transverse };
            let rng = straylight::math::Rng::new(1, history as u64, 0);
            let mut packet = walk.born(&compiled.scene.sources[0], (0, history as u64), birth, 1.0, rng);
            walk.history(&mut packet);
        }
    })
}

/// A ray of 1 W of unpolarised light of a vacuum wavelength (m), in world coordinates (m), watched.
pub fn shot_at(compiled: &Compiled, ray: Ray, wavelength: f64) -> Trace {
    follow(compiled, |walk| {
        let ray = Ray { origin: ray.origin - compiled.scene.shift, ..ray };
        let birth = Birth {
            ray,
            normal: ray.direction,
            from: None,
            wavelength,
            transverse: ray.direction.any_orthonormal_vector(),
        };
        let mut packet = walk.born(&compiled.scene.sources[0], (0, 0), birth, 1.0, straylight::math::Rng::new(1, 0, 0));
        walk.history(&mut packet);
    })
}

/// A ray of 1 W of unpolarised light of 550 nm that may start inside a solid, in world coordinates (m), watched.
pub fn shot_from(compiled: &Compiled, ray: Ray) -> Trace {
    follow(compiled, |walk| {
        let ray = Ray { origin: ray.origin - compiled.scene.shift, ..ray };
        let birth = Birth {
            ray,
            normal: ray.direction,
            from: None,
            wavelength: 550e-9,
            transverse: ray.direction.any_orthonormal_vector(),
        };
        let mut packet = walk.born(&compiled.scene.sources[0], (0, 0), birth, 1.0, straylight::math::Rng::new(1, 0, 0));
        packet.solids = compiled.scene.solids_at(ray.origin);
        walk.history(&mut packet);
    })
}

fn follow(compiled: &Compiled, go: impl FnOnce(&mut Walk<1, Seen>)) -> Trace {
    let (scene, settings) = (&compiled.scene, &compiled.settings);
    let (layout, rows) = (scene.layout(0), Rows::default());
    let book = Book::new(&layout, Live::<1>::new(layout.len()), Some(&rows));
    let importance = Importance::declared(scene);
    let mut walk = Walk::new(scene, settings, &importance, book, Seen::default());
    go(&mut walk);
    let sums = walk.book.finish();
    let total = |slot| sums.estimate(slot, 0).mean;
    Trace {
        absorbed: total(Layout::ABSORBED),
        escaped: total(Layout::ESCAPED),
        terminated: total(Layout::TERMINATED),
        lost: total(Layout::LOST),
        residual: total(Layout::RESIDUAL),
        seen: walk.watch,
    }
}

/// Flux of the path with this sequence, W; 0 if there is no such row.
pub fn path(results: &Results, sequence: &str) -> f64 {
    row(results, sequence).map_or(0.0, |row| row.flux_w.mean)
}

pub fn row<'a>(results: &'a Results, sequence: &str) -> Option<&'a PathResult> {
    results.paths.iter().find(|row| row.sequence == sequence)
}

/// The same glTF text with a node scaled, in f64.
pub fn scaled_node(gltf: &str, name: &str, scale: DVec3) -> String {
    let mut value: Value = serde_json::from_str(gltf).expect("JSON");
    let nodes = value["nodes"].as_array_mut().expect("nodes");
    let node = nodes.iter_mut().find(|n| n["name"] == name).unwrap_or_else(|| panic!("no node {name}"));
    node["scale"] = serde_json::json!(scale.to_array());
    value.to_string()
}

/// Closed triangular prism between z = -`half` and `half`; the outline runs counter-clockwise seen from +z.
pub fn wedge(outline: [DVec2; 3], half: f64) -> Vec<[DVec3; 3]> {
    let [low, high] = [-half, half].map(|z| outline.map(|p| p.extend(z)));
    let mut faces = vec![[low[0], low[2], low[1]], high];
    for k in 0..3 {
        let next = (k + 1) % 3;
        faces.extend(crate::support::shapes::quad([low[k], low[next], high[next], high[k]]));
    }
    faces
}

/// In the plane y = 0: `angle` (rad) from -z towards +x.
pub fn downward(angle: f64) -> DVec3 {
    // The cosine near a right angle keeps its digits as the sine of the complement.
    DVec3::new(angle.sin(), 0.0, -(FRAC_PI_2 - angle).sin())
}

/// Angle between two unit vectors, rad, exact for small ones too.
pub fn between(a: DVec3, b: DVec3) -> f64 {
    a.cross(b).length().atan2(a.dot(b))
}

/// A deterministic number against its reference.
#[track_caller]
pub fn close(got: f64, wanted: f64, tolerance: f64, what: &str) {
    println!("{what}: {got:.15e}, reference {wanted:.15e}, off by {:.1e}", got - wanted);
    assert!((got - wanted).abs() <= tolerance, "{what}: {got:e}, reference {wanted:e}, off by {:e}", got - wanted);
}

/// The title of a case.
pub fn title(id: &str) -> String {
    let case = all_cases().into_iter().find(|case| case["id"] == id).unwrap_or_else(|| panic!("no case {id}"));
    case["title"].as_str().expect("a title").to_owned()
}

/// The whole verification set.
pub fn all_cases() -> Vec<Value> {
    let all: Value = serde_json::from_str(include_str!("../data/verification/public.json")).expect("JSON");
    all["cases"].as_array().expect("cases").clone()
}

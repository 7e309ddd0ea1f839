//! Nothing leaks: rays aimed at rims, seams and everywhere else, through every kind of exact face.

use crate::lab::{shot, system};
use crate::lenses::{around, ball};
use crate::meshes::{BICONVEX, MENISCUS, Singlet};
use crate::support::Model;
use crate::support::shapes::{Equal, sphere};
use glam::DVec2;
use std::f64::consts::TAU;
use straylight::geometry::Ray;
use straylight::math::{Rng, sampling};
use straylight::settings::{Roulette, Settings};
use straylight::system::compile::{Compiled, compile};
use straylight::system::document::Document;

/// Rays from a sphere around the lens: half of them at points within 1e-9 .. 1 mm of its
/// rims, the others anywhere at it, and some along its edge.
fn rays(lens: &Singlet, count: u64, seed: u64) -> Vec<Ray> {
    let ray = |i: u64| {
        let mut rng = Rng::new(seed, i, 0);
        let side = (rng.uniform() * 2.0) as usize;
        let angle = TAU * if i.is_multiple_of(3) { (rng.uniform() * 24.0).floor() / 24.0 } else { rng.uniform() };
        let rim = (lens.half * DVec2::from_angle(angle)).extend(lens.sag(side, lens.half));
        let spread = if i.is_multiple_of(2) { 10f64.powf(-9.0 * rng.uniform()) } else { lens.half };
        let target = rim + spread * sampling::sphere(rng.pair());
        let origin = 60.0 * sampling::sphere(rng.pair());
        if i.is_multiple_of(100) {
            // Along the edge: entered and left within roundings.
            let inside = 1.0 - 10f64.powf(-16.0 + 13.0 * rng.uniform());
            let radial = DVec2::from_angle(angle);
            let slope = rng.uniform() - 0.5;
            let towards = radial.perp().extend(slope).normalize();
            let middle = (lens.half * inside * radial).extend(0.5 * (lens.sag(0, lens.half) + lens.sag(1, lens.half)));
            return Ray { origin: 1e-3 * (middle - 50.0 * towards), direction: towards };
        }
        Ray { origin: 1e-3 * origin, direction: (target - origin).normalize() }
    };
    (0..count).map(ray).collect()
}

/// Fails if any flux is lost; the number of rays.
fn watertight(name: &str, compiled: &Compiled, lens: &Singlet, count: u64) {
    let (mut sent, mut lost) = (0, 0.0);
    for chunk in 0..count.div_ceil(2000) {
        let rays = rays(lens, 2000.min(count), 1 + chunk);
        let trace = shot(compiled, &rays);
        sent += rays.len();
        lost += trace.lost;
        assert!(trace.residual.abs() < 1e-9, "{name}: residual {}", trace.residual);
    }
    println!("{name}: {sent} rays, {lost:.3e} W lost");
    assert_eq!(lost, 0.0, "{name}");
}

fn bodies() -> Vec<(&'static str, Compiled, Singlet)> {
    let n = 1.5168;
    let cemented = "\"lens\": (body: Lens(surfaces: [(form: Sphere(radius: \"50 mm\")), (form: Sphere(radius: \"-30 mm\")), \
        (form: Sphere(radius: \"-120 mm\"))], thickness: [\"6 mm\", \"3 mm\"], media: [\"glass\", \"vacuum\"], \
        diameter: \"20 mm\")),";
    let shoulders = "\"lens\": (body: Lens(surfaces: [(form: Sphere(radius: \"50 mm\"), semi_diameter: \"9 mm\"), \
        (form: Sphere(radius: \"-40 mm\"), semi_diameter: \"8 mm\")], thickness: [\"6 mm\"], media: [\"glass\"], \
        diameter: \"20 mm\")),";
    let asphere = "\"lens\": (body: Lens(surfaces: [(form: Asphere(radius: \"50 mm\", conic: -0.5, terms: [(4, \"2e-6 mm^-3\"), \
        (6, \"-3e-8 mm^-5\"), (3, \"1e-5 mm^-2\")])), (form: Polynomial(terms: [((2, 0), \"-0.01 mm^-1\"), ((0, 2), \"-0.01 mm^-1\")]))], \
        thickness: [\"6 mm\"], media: [\"glass\"], diameter: \"20 mm\")),";
    let rim = |lens: &Singlet| format!(", semi_diameter: \"{:?} mm\"", lens.half);
    let wall = |lens: &Singlet| {
        format!(
            "(on: Faces(of: \"lens\", where: Radial(axis: \"(0, 0, 1)\", through: \"(0, 0, 0) mm\", within: \"10 deg\")), exact: (form: Cylinder(radius: \"{:?} mm\"))),",
            lens.half
        )
    };
    let spheroid = Model::new().add("lens", sphere(5.0, 2, Equal::Corners));
    let whole = BICONVEX
        .sections("(on: Node(\"lens\"), exact: (form: Sphere(radius: \"5 mm\"), vertex: \"(0, 0, -5) mm\")),", n);
    let globe = Singlet { curvature: [0.2, -0.2], thickness: 10.0, half: 5.0 };
    let mut bodies = vec![
        ("cemented", system(&around(cemented, n), ""), BICONVEX),
        ("shoulders", system(&around(shoulders, n), ""), BICONVEX),
        ("asphere", system(&around(asphere, n), ""), BICONVEX),
        ("ball", system(&around(&ball(5.0), n), ""), globe),
        ("ball mesh", system(&whole, &spheroid.gltf()), globe),
    ];
    for (name, lens) in [("biconvex", BICONVEX), ("meniscus", MENISCUS)] {
        let rounded = lens.exact(&rim(&lens));
        bodies.extend([
            (name, system(&around(&lens.element(), n), ""), lens),
            (name, lens.compiled(3, 24, &lens.exact(""), n), lens),
            (name, lens.compiled(3, 24, &rounded, n), lens),
            (name, lens.compiled(3, 24, &(lens.exact("") + &wall(&lens)), n), lens),
            (name, lens.compiled(3, 24, &(rounded + &wall(&lens)), n), lens),
        ]);
    }
    bodies
}

#[test]
fn no_ray_is_lost_at_any_rim() {
    for (name, compiled, lens) in bodies() {
        watertight(name, &compiled, &lens, 6000);
    }
}

#[test]
#[ignore = "10^7 rays: cargo test --release --test optics -- --ignored"]
fn no_ray_is_lost_at_any_rim_in_full() {
    for (name, compiled, lens) in bodies() {
        watertight(name, &compiled, &lens, 700_000);
    }
}

/// Whole runs through the shipped lens stacks, one branch drawn at every surface.
#[test]
#[ignore = "10^8 rays, an hour: cargo test --release --test optics -- --ignored stacks"]
fn no_ray_is_lost_in_the_lens_stacks() {
    for (name, rays) in [("triplet", 40e6), ("double_gauss", 40e6), ("questar", 20e6)] {
        let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("systems").join(name).join("system.ron");
        let mut compiled = compile(&Document::read(&path).expect("it ships with the project")).expect("it compiles");
        compiled.settings = Settings {
            rays: rays as u64,
            paths: 0,
            splits: 0,
            scatter_splits: 1,
            roulette: Roulette { below: 1e-3, survive: 0.1 },
            until: None,
            ..compiled.settings
        };
        let results = crate::lab::traced(&compiled);
        println!("{name}: {} rays, {:.3e} W lost", results.rays, results.ledger_w.lost.mean);
        assert_eq!(results.ledger_w.lost.mean, 0.0, "{name}");
    }
}

/// A curved detector counts all that arrives, on its exact face and on the facets and strips around it.
#[test]
fn a_curved_exact_face_is_one_bin_of_its_detector_and_misses_nothing() {
    let lens = BICONVEX;
    let watched = |entries: &str| {
        let sections = lens
            .sections(entries, 1.5)
            .replace(
                "extent: Point, at: \"(0, 0, -1000) mm\",",
                "extent: Disk(radius: \"12 mm\"), at: \"(0, 0, -20) mm\",",
            )
            .replace("medium: \"glass\", specular: Fresnel", "specular: Absorb")
            .replace(crate::lab::CERTAIN, "run: (rays: 20000, seed: 1),")
            .replace("default:", "detectors: { \"all\": (on: Node(\"lens\"), quantity: Irradiance) }, default:");
        let model = Model::new().add("lens", lens.mesh(3, 24));
        crate::lab::traced(&system(&sections, &model.gltf()))
    };
    let results = watched(&lens.exact(""));
    let (seen, taken) = (&results.detectors["all"].flux_w, &results.ledger_w.absorbed);
    assert!((seen.mean / taken.mean - 1.0).abs() < 1e-12 && seen.mean > 0.5, "{seen:?} {taken:?}");
}

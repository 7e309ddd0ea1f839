//! Faces, detectors and triangles that lie on each other.

use crate::lab::*;
use crate::support::case::number;
use crate::support::model::Mesh;
use crate::support::shapes::{box_faces, cuboid, quad, rectangle};
use crate::support::{Case, Model};
use glam::DVec3;

const LOW: DVec3 = DVec3::new(-5.0, -5.0, -10.0);
const HIGH: DVec3 = DVec3::new(5.0, 5.0, 10.0);

/// The box behind the plane z = 0, its face there divided along the other diagonal if `turned`.
fn second(turned: bool) -> Mesh {
    let mut faces = box_faces(DVec3::new(LOW.x, LOW.y, 0.0), HIGH);
    if turned {
        let [[a, b, c], [_, _, d]] = [faces[4][0], faces[4][1]];
        faces[4] = quad([b, c, d, a]).to_vec();
    }
    faces.into_iter().flatten().collect()
}

fn first() -> Mesh {
    cuboid(LOW, DVec3::new(HIGH.x, HIGH.y, 0.0))
}

/// Indices of both bodies, from the title of the case.
fn indices(case: &Case) -> [f64; 2] {
    let title = title(&case.id);
    let (_, numbers) = title.split_once("n=").expect("n1/n2 in the title");
    let numbers: Vec<f64> = numbers.split('/').map(|n| n.trim().parse().expect("an index")).collect();
    [numbers[0], numbers[1]]
}

fn cemented(case: &Case, name: &str, model: &Model, priority: u32) {
    let [n1, n2] = indices(case);
    for value in case.values() {
        let theta = number(&value, "theta_deg").to_radians();
        let r = value["R"].as_f64().unwrap_or_else(|| number(&value, "R_unpol"));
        // The middle lies on the diagonals of both faces, the others beside them or on one.
        for target in [DVec3::ZERO, DVec3::new(0.5, 0.25, 0.0), DVec3::new(1.0, 1.0, 0.0), DVec3::new(1.0, -1.0, 0.0)] {
            let direction = DVec3::new(theta.sin(), 0.0, theta.cos());
            let sections = format!(
                "media: {{ \"a\": Constant(n: {n1:?}), \"b\": Constant(n: {n2:?}) }},
                surfaces: [(on: Node(\"a\"), medium: \"a\", specular: Fresnel, priority: {priority}),
                           (on: Node(\"b\"), medium: \"b\", specular: Fresnel)],
                {} {SINGLE}",
                pencil_from(target - 2.0 * direction, direction, "Unpolarized", "550 nm")
            );
            let compiled = system(&sections, &model.gltf());
            let trace = watched(&compiled, 0);
            let what = format!("ROB-03 {name} {:.0} deg {target}", theta.to_degrees());
            let cement = &trace.seen.sights[0];
            assert!((cement.point - 1e-3 * target + compiled.scene.shift).length() < 1e-15, "{what}: {cement:?}");
            close(cement.fractions[0], r, case.tolerance("abs"), &what);
            close(cement.fractions[0] + cement.fractions[1], 1.0, 1e-15, &what);
            assert_eq!(trace.lost, 0.0, "{what}");
            // The refracted ray goes on from that very point, by one event: its next one is on another face.
            let sine = n1 / n2 * theta.sin();
            let on = cement.leaves[1].expect("a refracted ray");
            close(on.x, sine, 1e-15, &format!("{what} Snell"));
            let next: Vec<_> = trace.seen.sights.iter().filter(|s| s.depth == 1).collect();
            assert_eq!(next.len(), 2, "{what}");
            for sight in next {
                assert!(sight.distance > 1e-4, "{what}: {sight:?}");
                let from = sight.point - sight.distance * sight.direction;
                assert!((from - cement.point).length() < 1e-15, "{what}: shifted by {}", from - cement.point);
            }
        }
    }
}

#[test]
fn rob_03_cemented_faces_are_one_interface() {
    let case = Case::load("ROB-03");
    cemented(&case, "identical faces", &Model::new().add("a", first()).add("b", second(false)), 0);
    cemented(&case, "other diagonals", &Model::new().add("b", second(true)).add("a", first()), 0);
    // The shared face only once: b goes all the way, a is laid over its half.
    cemented(&case, "shared face once", &Model::new().add("a", first()).add("b", cuboid(LOW, HIGH)), 1);
}

#[test]
fn rob_03_a_body_that_lacks_the_shared_face_is_refused() {
    let open: Mesh = box_faces(DVec3::new(LOW.x, LOW.y, 0.0), HIGH)
        .into_iter()
        .enumerate()
        .filter(|(i, _)| *i != 4)
        .flat_map(|(_, f)| f)
        .collect();
    let sections = format!(
        "media: {{ \"a\": Constant(n: 1.5), \"b\": Constant(n: 1.6) }},
        surfaces: [(on: Node(\"a\"), medium: \"a\"), (on: Node(\"b\"), medium: \"b\")], {}",
        pencil(DVec3::ZERO, DVec3::Z, "Unpolarized", "550 nm")
    );
    let error = compile_gltf(&sections, &Model::new().add("a", first()).add("b", open).gltf()).expect_err("open glass");
    assert!(error.problems().iter().any(|p| p.to_string().contains("`b` has a medium but is not closed")), "{error}");
}

/// A glass plate with detectors on its very face; `detectors` is RON text.
fn watched_plate(at: DVec3, detectors: &str) -> straylight::tally::results::Results {
    let sections = format!(
        "media: {{ \"glass\": Constant(n: 1.5) }},
        surfaces: [(on: Node(\"plate\"), medium: \"glass\", specular: Fresnel)],
        detectors: {{ {detectors} }},
        {} {CERTAIN}",
        pencil(at, DVec3::Z, "Unpolarized", "550 nm")
    );
    results(&sections, &Model::new().add("plate", cuboid(DVec3::new(-5.0, -5.0, 0.0), DVec3::new(5.0, 5.0, 5.0))))
}

#[test]
fn rob_05_every_detector_on_a_face_counts_every_crossing_once() {
    let case = Case::load("ROB-05");
    let ratio = number(&case.values()[0], "count_ratio");
    let window = |name: &str, x: f64, width: f64, side: &str| {
        format!(
            "\"{name}\": (on: Rectangle(at: \"({x}, 0, 0) mm\", normal: \"(0, 0, -1)\", width: \"{width} mm\", height: \"8 mm\"),
                quantity: Irradiance, side: {side}),"
        )
    };
    let detectors = [
        window("one", 0.0, 8.0, "Front"),
        window("two", 0.0, 8.0, "Front"),
        // Their common rim goes through the pencils at x = 1.
        window("left", -1.0, 4.0, "Front"),
        window("right", 3.0, 4.0, "Front"),
        window("inside", 0.0, 8.0, "Back"),
        "\"faces\": (on: Node(\"plate\"), quantity: Irradiance, side: Front),".into(),
        "\"round\": (on: Disk(at: \"(0, 0, 0) mm\", normal: \"(0, 0, -1)\", radius: \"4 mm\"), quantity: Irradiance, side: Front),".into(),
    ]
    .concat();
    // Beside and on the diagonal of the face, on the rim, and where rim and diagonal meet.
    for at in [DVec3::new(0.5, 0.25, 0.0), DVec3::ZERO, DVec3::new(1.0, 0.25, 0.0), DVec3::new(1.0, 1.0, 0.0)] {
        let found = watched_plate(at, &detectors);
        let r = 0.04f64;
        let counted = |name: &str, flux: f64| {
            let detector = &found.detectors[name];
            assert_eq!(detector.rays as f64 / found.rays as f64, ratio, "{name} at {at}");
            close(detector.flux_w.mean, flux, 1e-12, &format!("ROB-05 {name} at {at}"));
        };
        ["one", "two", "left", "faces", "round"].iter().for_each(|name| counted(name, 1.0));
        counted("inside", (1.0 - r) * r / (1.0 - r * r));
        if at.x == 1.0 {
            counted("right", 1.0);
        } else {
            assert_eq!(found.detectors["right"].rays, 0);
        }
        // Nobody looks: the light does not mind.
        let unwatched = watched_plate(at, "");
        assert_eq!(found.ledger_w, unwatched.ledger_w);
    }
}

fn lit_cube(mesh: Mesh) -> Result<straylight::system::compile::Compiled, straylight::error::Error> {
    let sections = "media: { \"glass\": Constant(n: 1.5) },
        surfaces: [(on: Node(\"cube\"), medium: \"glass\", specular: Fresnel, scatter: \"haze\"), (on: Node(\"screen\"), specular: Absorb)],
        scatter: { \"haze\": Lambertian(reflectance: 0.1, transmittance: 0.1) },
        sources: { \"lamp\": (flux: \"1 W\", extent: Disk(radius: \"3 mm\"), at: \"(0, 0, -20) mm\", angular: Cone(half_angle: \"20 deg\"), spectrum: Line(\"550 nm\")) },
        detectors: { \"screen\": (on: Node(\"screen\"), quantity: Irradiance, pixels: (8, 8)) },
        run: (rays: 2000),";
    let screen: Mesh = rectangle(40.0, 40.0).into_iter().map(|t| t.map(|v| v + 15.0 * DVec3::Z)).collect();
    compile_gltf(sections, &Model::new().add("cube", mesh).add("screen", screen).gltf())
}

#[test]
fn rob_06_degenerate_triangles_change_nothing_and_numbers_that_are_none_are_refused() {
    let case = Case::load("ROB-06");
    let clean = cuboid(DVec3::splat(-5.0), DVec3::splat(5.0));
    let reference = traced(&lit_cube(clean.clone()).expect("a clean cube"));
    let mut dirty = clean.clone();
    for i in 0..100 {
        let [a, b, c] = clean[i % clean.len()];
        dirty.push([[a, a, b], [a, 0.5 * (a + b), b], [c, c, c], [a, b, a]][i % 4]);
    }
    dirty.extend(clean.iter().map(|[a, b, c]| [*b, *c, *a]));
    let compiled = lit_cube(dirty).expect("a dirty cube");
    assert!(!compiled.warnings.is_empty(), "nothing is said of degenerate and duplicate triangles");
    let found = traced(&compiled);
    let ratio = found.detectors["screen"].flux_w.mean / reference.detectors["screen"].flux_w.mean;
    close(ratio, number(&case.values()[0], "flux_ratio"), case.tolerance("abs"), "ROB-06");
    for (map, clean) in found.maps.iter().zip(&reference.maps) {
        assert!(map.mean.iter().chain(&map.error).all(|v| v.is_finite()));
        assert_eq!(map.rays, clean.rays);
    }
    for bad in [f64::NAN, f64::INFINITY, 1e37] {
        let mut broken = clean.clone();
        broken.push([DVec3::ZERO, DVec3::new(bad, 0.0, 0.0), DVec3::Y]);
        match lit_cube(broken) {
            Err(error) => assert!(!error.problems().is_empty(), "{error}"),
            Ok(compiled) => {
                assert!(bad.is_finite(), "{bad} was let in");
                let found = traced(&compiled);
                assert!(found.maps.iter().flat_map(|m| &m.mean).all(|v| v.is_finite()));
            }
        }
    }
}

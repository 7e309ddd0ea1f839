//! Ghosts with splitting: every path is found, with its exact flux.

use crate::lab::*;
use crate::support::case::number;
use crate::support::shapes::{cuboid, rectangle};
use crate::support::{Case, Model};
use glam::{DQuat, DVec3};

/// Names the faces of a plate that light meets from below as front and rear.
fn faces(node: &str) -> String {
    let face = |name: &str, z: i32| {
        format!(
            "(on: Faces(of: \"{node}\", where: Normal(direction: \"(0, 0, {z})\", within: \"1 deg\")), name: \"{name}\"),"
        )
    };
    face("front", -1) + &face("rear", 1)
}

fn plate(z: f64, thickness: f64) -> Vec<[DVec3; 3]> {
    cuboid(DVec3::new(-50.0, -50.0, z), DVec3::new(50.0, 50.0, z + thickness))
}

#[test]
fn gho_04_two_plates_have_six_ghosts_of_two_reflections() {
    let case = Case::load("GHO-04");
    let value = &case.values()[0];
    let sections = |run: &str| {
        format!(
            "media: {{ \"glass\": Constant(n: {:?}) }},
            surfaces: [
                (on: Node(\"plate_*\"), medium: \"glass\", specular: Fresnel), {} {}
                (on: Node(\"screen\"), specular: Absorb),
            ],
            detectors: {{ \"screen\": (on: Node(\"screen\"), quantity: Irradiance) }},
            {} run: (rays: 32, batch: 1, splits: 40, roulette: (below: 1e-14, survive: 0.5), {run}),",
            case.given("/n"),
            faces("plate_1"),
            faces("plate_2"),
            pencil(DVec3::new(1.0, 2.0, 0.0), DVec3::Z, "Unpolarized", "550 nm")
        )
    };
    let model = Model::new()
        .add("plate_1", plate(0.0, 5.0))
        .add("plate_2", plate(8.0, 3.0))
        .add("screen", rectangle(50.0, 50.0).into_iter().map(|t| t.map(|v| v + 20.0 * DVec3::Z)).collect());
    let two = results(&sections("max_reflections: 2"), &model);
    let ghosts: Vec<_> = two.paths.iter().filter(|row| row.ghost_order == 2).collect();
    assert_eq!(ghosts.len() as f64, number(value, "paths"), "{ghosts:#?}");
    assert!(ghosts.iter().all(|row| row.class == "ghost 2" && row.rays == two.rays));
    let close = |got: f64, key: &str| close(got, number(value, key), case.tolerance("rel") * number(value, key), key);
    close(ghosts.iter().map(|row| row.flux_w.mean).sum(), "flux_sum_two_reflections");
    close(two.detectors["screen"].classes["ghost 2"].mean, "flux_sum_two_reflections");
    close(two.detectors["screen"].classes["signal"].mean, "direct");
    close(results(&sections("paths: 0"), &model).detectors["screen"].flux_w.mean, "T_all_orders");
}

/// Light that a detector reflects comes back to it from both faces of its window.
fn window(id: &str) {
    let case = Case::load(id);
    let value = &case.values()[0];
    let thickness = case.given("/window/thickness");
    let title = case.setup("/beam").as_str().expect("text").to_owned();
    let angle: f64 = title.split_whitespace().find_map(|word| word.parse().ok()).expect("an angle");
    let direction = DVec3::new(angle.to_radians().sin(), 0.0, angle.to_radians().cos());
    let sections = format!(
        "media: {{ \"glass\": Constant(n: {:?}) }},
        surfaces: [
            (on: Node(\"window\"), medium: \"glass\", specular: Fresnel), {}
            (on: Node(\"chip\"), specular: Mirror(reflectance: {:?})),
        ],
        detectors: {{ \"chip\": (on: Node(\"chip\"), quantity: Irradiance) }},
        {} {CERTAIN}",
        case.given("/window/n"),
        faces("window"),
        case.given("/detector_specular_reflectance"),
        pencil(DVec3::new(1.0, 2.0, 0.0), direction, "Unpolarized", "550 nm")
    );
    let behind = (thickness + case.given("/gap_to_detector")) * DVec3::Z;
    let model =
        Model::new().add("window", plate(0.0, 1.0)).add_at("chip", rectangle(100.0, 100.0), DQuat::IDENTITY, behind);
    let compiled = system(&sections, &scaled_node(&model.gltf(), "window", DVec3::new(1.0, 1.0, thickness)));
    let found = traced(&compiled);
    let relative = case.tolerance("rel");
    let close =
        |got: f64, key: &str| close(got, number(value, key), relative * number(value, key), &format!("{id} {key}"));
    let first = "beam > window.front:T > window.rear:T";
    close(path(&found, first), "first_incident");
    close(found.detectors["chip"].classes["signal"].mean, "first_incident");
    let rear = path(&found, &format!("{first} > chip:R > window.rear:R"));
    let front = path(&found, &format!("{first} > chip:R > window.rear:T > window.front:R > window.rear:T"));
    close(rear, "second_incident_via_rear");
    close(front, "second_incident_via_front");
    let trace = watched(&compiled, 0);
    let landed = trace.at(&compiled, "chip");
    let at = |flux: f64| {
        let off = |s: &&&straylight::transport::watch::Sight| (s.flux - flux).abs();
        (*landed.iter().min_by(|a, b| off(a).total_cmp(&off(b))).expect("light on the chip")).clone()
    };
    let begin = at(path(&found, first));
    close(begin.flux * begin.fractions[3], "absorbed_first");
    close((at(rear).point - begin.point).length() * 1e3, "shift_rear");
    close((at(front).point - begin.point).length() * 1e3, "shift_front");
}

#[test]
fn gho_05_a_detector_that_reflects_sees_its_window() {
    window("GHO-05");
    window("GHO-05x");
}

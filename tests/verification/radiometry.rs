//! Sources, view factors and irradiance: light through empty space and one interface.

use crate::support::case::number;
use crate::support::shapes::*;
use crate::support::trial::{bin, scaled, spread};
use crate::support::{Model, Trial};
use glam::{DQuat, DVec3};
use straylight::tally::results::Estimate;

cases! {
    rad_01 rad_02 rad_03 rad_03x rad_04 rad_08 rad_08x rad_09 rad_10 rad_11 rad_11x rad_12 rad_13 rad_13x rad_14 rad_14x
    rad_15
}

/// Every surface is black.
const BLACK: &str = "surfaces: [(on: Node(\"*\"), specular: Absorb)],";

/// A green source of 1 W.
fn lamp(extent: &str, angular: &str) -> String {
    format!("sources: {{\"lamp\": (flux: \"1 W\", {extent}, angular: {angular}, spectrum: Line(\"550 nm\"))}},")
}

/// Detectors on the nodes of these names, called like them.
fn watching(nodes: &[&str]) -> String {
    let line = |node: &&str| format!("\"{node}\": (on: Node(\"{node}\"), quantity: Irradiance),");
    format!("detectors: {{ {} }},", nodes.iter().map(line).collect::<String>())
}

fn from_node(name: &str) -> String {
    lamp(&format!("extent: Node(name: \"{name}\")"), "Lambertian")
}

fn rad_01(trial: &mut Trial) {
    let [emitter, radius] = ["/source/radius", "/detector/radius"].map(|p| trial.case.given(p));
    let height = trial.case.given("/detector/center/2");
    let model = Model::new().add("target", moved(flipped(disk(radius, 512)), height * DVec3::Z));
    let lamp = lamp(&format!("extent: Disk(radius: \"{emitter} mm\")"), "Lambertian");
    let results = trial.run(&format!("{BLACK} {lamp} {}", watching(&["target"])), &model, 500_000);
    let (flux, size) = (results.detectors["target"].flux_w, 1e6 * results.maps[0].extent[0]);
    trial.check("flux_fraction", flux, trial.case.named("flux_fraction"), 0.0);
    trial.exact("area", size, std::f64::consts::PI * radius * radius, 1e-6 * size);
    trial.check_too("E_mean", scaled(flux, 1.0 / size), trial.case.named("E_mean"), 0.0);
}

fn rad_02(trial: &mut Trial) {
    let [radius, height] = ["/source/radius", "/detector/z"].map(|p| trial.case.given(p));
    let far = trial.case.list("/detector/pixel_centres_x").into_iter().fold(0.0, f64::max);
    let pitch = trial.case.given("/detector/pixel");
    let columns = (2.0 * far / pitch) as usize + 1;
    let lamp = lamp(&format!("extent: Disk(radius: \"{radius} mm\")"), "Lambertian");
    let text = format!(
        "{BLACK} {lamp} detectors: {{\"map\": (quantity: Irradiance, pixels: ({columns}, 3), on: Rectangle(
            at: \"(0, 0, {height}) mm\", normal: \"(0, 0, -1)\", x: \"(1, 0, 0)\",
            width: \"{} mm\", height: \"{} mm\"))}},",
        columns as f64 * pitch,
        3.0 * pitch,
    );
    let model = Model::new().add("backstop", moved(disk(400.0, 64), 2.0 * height * DVec3::Z));
    let results = trial.run(&text, &model, 600_000);
    let unit = 1.0 / (std::f64::consts::PI * radius * radius);
    for value in trial.case.values() {
        let x = number(&value, "r");
        let pixel = columns + columns / 2 + (x / pitch) as usize;
        let map = &results.maps[0];
        let found = Estimate { mean: map.mean[pixel], error: map.error[pixel] };
        trial.check(format!("E at {x}"), scaled(found, 1e-6 / unit), number(&value, "E_over_piL_pixel_mean"), 0.0);
    }
}

/// As many pixels as fit on a ring at the same angle: each is the same as the one on x, but for the square source,
/// which is 1e-6 of the distance squared.
fn cosine_law(trial: &mut Trial) {
    let (side, height) = (trial.case.given("/source/side"), trial.case.given("/detector/z"));
    let pixel = trial.case.given("/detector/pixel");
    let mut model = Model::new();
    let mut counts = Vec::new();
    for value in trial.case.values() {
        let theta = number(&value, "theta_deg");
        let radius = height * theta.to_radians().tan();
        let count = match radius > 0.0 {
            true => (std::f64::consts::PI / (0.5 * pixel / (radius - 0.5 * pixel)).atan()) as usize,
            false => 1,
        };
        let one = moved(flipped(rectangle(pixel, pixel)), DVec3::new(radius, 0.0, height));
        let turned = |k: usize| {
            let turn = DQuat::from_rotation_z(std::f64::consts::TAU * k as f64 / count as f64);
            one.iter().map(move |t| t.map(|v| turn * v)).collect::<Vec<_>>()
        };
        model = model.add(&format!("ring_{theta}"), (0..count).flat_map(turned).collect());
        counts.push(count as f64);
    }
    let names: Vec<String> = trial.case.values().iter().map(|v| format!("ring_{}", number(v, "theta_deg"))).collect();
    let lamp = lamp(&format!("extent: Rectangle(width: \"{side} mm\", height: \"{side} mm\")"), "Lambertian");
    let watch = watching(&names.iter().map(String::as_str).collect::<Vec<_>>());
    let results = trial.run(&format!("{BLACK} {lamp} {watch}"), &model, 500_000);
    for ((value, name), count) in trial.case.values().iter().zip(&names).zip(counts) {
        let found = scaled(results.detectors[name].flux_w, 1.0 / count);
        trial.check(name.as_str(), found, number(value, "flux_fraction_in_pixel"), 0.0);
    }
}

fn rad_03(trial: &mut Trial) {
    cosine_law(trial);
}

fn rad_03x(trial: &mut Trial) {
    cosine_law(trial);
}

/// The error of a moment is taken from independent runs: rings of one run are not independent.
fn rad_04(trial: &mut Trial) {
    const ROWS: usize = 20_000;
    let (half, index) = (trial.case.given("/source/half_angle_deg"), trial.case.given("/n2"));
    let lamp = lamp(
        "extent: Rectangle(width: \"1 mm\", height: \"1 mm\"), axis: \"(0, 0, 1)\"",
        &format!("AngularDiameter(\"{} deg\")", 2.0 * half),
    );
    let text = format!(
        "media: {{\"glass\": Constant(n: {index})}},
        surfaces: [(on: Node(\"plane\"), between: (\"glass\", \"vacuum\"),
            specular: Ideal(reflectance: 0, transmittance: 1))],
        {lamp}
        detectors: {{\"far\": (on: FarField(axis: \"(0, 0, 1)\"), quantity: Intensity, pixels: (1, {ROWS}),
            bins: Projected)}},"
    );
    let model = Model::new().add("plane", moved(rectangle(100.0, 100.0), 10.0 * DVec3::Z));
    let mut moments = Vec::new();
    let mut widest = 0.0f64;
    for _ in 0..24 {
        let results = trial.run(&text, &model, 10_000);
        trial.exact("flux", results.detectors["far"].flux_w.mean, 1.0, 1e-12);
        let middle = |row: usize| index * index * (row as f64 + 0.5) / ROWS as f64;
        let flux: Vec<f64> = (0..ROWS).map(|row| bin(&results, "far", row).mean).collect();
        moments.push(flux.iter().enumerate().map(|(row, f)| f * middle(row)).sum::<f64>());
        widest = (0..ROWS).filter(|&row| flux[row] > 0.0).map(middle).fold(widest, f64::max);
    }
    let ring = index * index / ROWS as f64;
    trial.check("<p^2+q^2>", spread(&moments), trial.case.named("<p^2+q^2>"), 1e-3 * ring);
    trial.exact("max(p^2+q^2)", widest, trial.case.named("max(p^2+q^2)"), ring);
    let after = trial.case.named("G_per_area_after");
    trial.exact("G_per_area_after", std::f64::consts::PI * widest, after, std::f64::consts::PI * ring);
}

/// The walls are 80 m wide and 1 mm away: a part in 1e9 of the light passes beside them.
fn immersed(trial: &mut Trial) {
    const BESIDE: f64 = 1e-8;
    let glass = cuboid(DVec3::new(-4e4, -4e4, 0.0), DVec3::new(4e4, 4e4, 50.0));
    let model = Model::new().add("glass", glass).add("black", moved(rectangle(7.9e4, 7.9e4), 2.0 * DVec3::Z));
    for value in trial.case.values() {
        let index = number(&value, "n");
        let text = |z: f64, axis: f64| {
            let lamp = lamp(
                &format!("extent: Disk(radius: \"1 mm\"), at: \"(0, 0, {z}) mm\", axis: \"(0, 0, {axis})\""),
                "Lambertian",
            );
            format!(
                "media: {{\"glass\": Constant(n: {index})}},
                surfaces: [(on: Node(\"glass\"), medium: \"glass\"), (on: Node(\"black\"), specular: Absorb)],
                {lamp} {}",
                watching(&["black"])
            )
        };
        let outside = trial.run(&text(-1.0, 1.0), &model, 100_000);
        let flux = outside.detectors["black"].flux_w;
        trial.check(format!("E_over_piL n={index}"), flux, number(&value, "E_over_piL"), BESIDE);
        trial.check_too(format!("R_ext n={index}"), outside.ledger_w.escaped, number(&value, "R_ext"), BESIDE);
        let inside = trial.run(&text(1.0, -1.0), &model, 100_000);
        let flux = inside.detectors["black"].flux_w;
        trial.check(format!("R_int n={index}"), flux, number(&value, "R_int"), BESIDE);
    }
}

fn rad_08(trial: &mut Trial) {
    immersed(trial);
}

fn rad_08x(trial: &mut Trial) {
    immersed(trial);
}

fn rad_09(trial: &mut Trial) {
    for value in trial.case.values() {
        let [r1, r2, a] = ["r1", "r2", "a"].map(|name| number(&value, name));
        let model = Model::new().add("from", disk(r1, 512)).add("to", moved(flipped(disk(r2, 512)), a * DVec3::Z));
        let text = format!("{BLACK} {} {}", from_node("from"), watching(&["to"]));
        let results = trial.run(&text, &model, 150_000);
        trial.check(format!("F12 {r1} {r2} {a}"), results.detectors["to"].flux_w, number(&value, "F12"), 0.0);
    }
}

fn rad_10(trial: &mut Trial) {
    for value in trial.case.values() {
        let [r1, r2, length] = ["r1", "r2", "L"].map(|name| number(&value, name));
        let model =
            Model::new().add("inner", tube(r1, [0.0, length], 512)).add("outer", flipped(tube(r2, [0.0, length], 512)));
        let watch = watching(&["inner", "outer"]);
        let results = trial.run(&format!("{BLACK} {} {watch}", from_node("outer")), &model, 150_000);
        let sys = trial.case.sys();
        trial.check("F21", results.detectors["inner"].flux_w, number(&value, "F21"), sys);
        trial.check_too("F22", results.detectors["outer"].flux_w, number(&value, "F22"), sys);
        let results = trial.run(&format!("{BLACK} {} {watch}", from_node("inner")), &model, 150_000);
        trial.check("F12", results.detectors["outer"].flux_w, number(&value, "F12"), sys);
        trial.exact("F11", results.detectors["inner"].flux_w.mean, 0.0, 0.0);
    }
}

fn sphere_to_disk(trial: &mut Trial) {
    for value in trial.case.values() {
        let [radius, height, ball] = ["r", "h", "rs"].map(|name| number(&value, name));
        let model = Model::new()
            .add("ball", sphere(ball, 5, Equal::Area))
            .add("disk", moved(flipped(disk(radius, 512)), height * DVec3::Z));
        let results = trial.run(&format!("{BLACK} {} {}", from_node("ball"), watching(&["disk"])), &model, 300_000);
        trial.check("F", results.detectors["disk"].flux_w, number(&value, "F"), 0.0);
    }
}

fn rad_11(trial: &mut Trial) {
    sphere_to_disk(trial);
}

fn rad_11x(trial: &mut Trial) {
    sphere_to_disk(trial);
}

/// A closed unit cube: the far wall is the parallel square, the four others share an edge with the emitter.
fn rad_12(trial: &mut Trial) {
    for kind in ["parallel", "perpendicular"] {
        for size in trial.case.setup(&format!("/{kind}")).as_array().expect("sizes") {
            assert!(size.as_object().expect("sizes").values().all(|v| v == 1), "the cube is a unit cube");
        }
    }
    let names = ["side_1", "side_2", "side_3", "side_4", "from", "far"];
    let faces = box_faces(DVec3::ZERO, DVec3::ONE);
    let model = names.iter().zip(faces).fold(Model::new(), |model, (name, face)| model.add(name, flipped(face)));
    let watch = watching(&["far", "side_1", "side_2", "side_3", "side_4"]);
    let results = trial.run(&format!("{BLACK} {} {watch}", from_node("from")), &model, 300_000);
    let reference = |row: usize| number(&trial.case.values()[row], "F12");
    let (parallel, perpendicular) = (reference(0), reference(1));
    trial.check("parallel", results.detectors["far"].flux_w, parallel, 0.0);
    for side in &names[..4] {
        trial.check_too(*side, results.detectors[*side].flux_w, perpendicular, 0.0);
    }
    trial.exact("escaped", results.ledger_w.escaped.mean, 0.0, 0.0);
}

/// Discs with their own node rotations, each looking at the centre of the sphere.
fn tilted(trial: &mut Trial) {
    let mut model = Model::new();
    for name in ["disk1", "disk2"] {
        let normal = DVec3::from_slice(&trial.case.list(&format!("/{name}/normal_from_centre"))).normalize();
        let [distance, radius] = ["plane_distance", "radius"].map(|p| trial.case.given(&format!("/{name}/{p}")));
        let turn = DQuat::from_rotation_arc(DVec3::Z, -normal);
        model = model.add_at(name, disk(radius, 512), turn, distance * normal);
    }
    let results = trial.run(&format!("{BLACK} {} {}", from_node("disk1"), watching(&["disk2"])), &model, 400_000);
    trial.check("F12", results.detectors["disk2"].flux_w, number(&trial.case.values()[0], "F12"), 0.0);
}

fn rad_13(trial: &mut Trial) {
    tilted(trial);
}

fn rad_13x(trial: &mut Trial) {
    tilted(trial);
}

fn isotropic(trial: &mut Trial) {
    for value in trial.case.values() {
        let [radius, height, offset] = ["R", "h", "r0"].map(|name| number(&value, name));
        let model = Model::new().add("disk", moved(flipped(disk(radius, 512)), DVec3::new(offset, 0.0, height)));
        let text = format!("{BLACK} {} {}", lamp("extent: Point", "Isotropic"), watching(&["disk"]));
        let results = trial.run(&text, &model, 300_000);
        trial.check(format!("r0={offset}"), results.detectors["disk"].flux_w, number(&value, "fraction"), 0.0);
    }
}

fn rad_14(trial: &mut Trial) {
    isotropic(trial);
}

fn rad_14x(trial: &mut Trial) {
    isotropic(trial);
}

fn rad_15(trial: &mut Trial) {
    let beam = "Collimated(direction: \"(0, 0, 1)\")";
    for value in trial.case.values() {
        if let Some(tilt) = value["tilt"].as_f64() {
            let turn = DQuat::from_rotation_y(tilt.to_radians());
            let model = Model::new().add_at("plate", flipped(rectangle(3.0, 5.0)), turn, 30.0 * DVec3::Z);
            let lamp = lamp("extent: Rectangle(width: \"10 mm\", height: \"10 mm\")", beam);
            let results = trial.run(&format!("{BLACK} {lamp} {}", watching(&["plate"])), &model, 100_000);
            let found = scaled(bin(&results, "plate", 0), 1e-6 / results.maps[0].extent[0]);
            trial.check(format!("E at {tilt} deg"), found, number(&value, "E"), 0.0);
        } else {
            let radius = number(&value, "a");
            let waist = trial.case.given("/gaussian/w");
            let model = Model::new().add("disk", moved(flipped(disk(radius, 512)), 30.0 * DVec3::Z));
            let lamp = lamp(&format!("extent: Gaussian(waist: \"{waist} mm\")"), beam);
            let results = trial.run(&format!("{BLACK} {lamp} {}", watching(&["disk"])), &model, 100_000);
            trial.check(format!("within {radius}"), results.detectors["disk"].flux_w, number(&value, "fraction"), 0.0);
        }
    }
}

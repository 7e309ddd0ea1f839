//! Critical and illuminated objects, and thermal light: closed forms, conservation, Kirchhoff, the same bits, messages.

#[allow(unused_imports, reason = "one harness, several test targets")]
#[macro_use]
mod support;

use glam::DVec3;
use std::f64::consts::PI;
use std::process::Command;
use std::sync::atomic::AtomicBool;

use straylight::source::planck;
use straylight::study::objects::{Objects, Question, Seen, View, Warmth, Way, objects};
use straylight::system::compile::{Compiled, compile_warm};
use straylight::system::document::Document;
use straylight::tally::results::Estimate;
use support::case::number;
use support::shapes::*;
use support::{Case, Model};
use tempfile::TempDir;

/// Standard errors that a difference may come to.
const SIGMAS: f64 = 4.0;

/// A system of `parts.gltf` (mm) and these sections, in a folder of its own.
fn written(sections: &str, model: &Model) -> (TempDir, std::path::PathBuf) {
    let folder = TempDir::new().expect("a folder for the system");
    let path = folder.path().join("system.ron");
    std::fs::write(folder.path().join("parts.gltf"), model.gltf()).expect("written");
    let geometry = "geometry: [(file: \"parts.gltf\", unit: \"mm\")],";
    std::fs::write(&path, format!("System({geometry} {sections})")).expect("written");
    (folder, path)
}

fn warm(sections: &str, model: &Model) -> Compiled {
    let (_folder, path) = written(sections, model);
    let document = Document::read(&path).unwrap_or_else(|e| panic!("{:#?}", e.problems()));
    compile_warm(&document).unwrap_or_else(|e| panic!("{:#?}", e.problems()))
}

fn looked(compiled: &Compiled) -> Objects {
    let Compiled { scene, settings, thermal, .. } = compiled;
    let question = Question { scene, thermal: thermal.as_ref(), settings };
    objects(question, &AtomicBool::new(false)).expect("finished")
}

fn agrees(what: &str, found: Estimate, wanted: f64, allowed: f64) {
    let off = (found.mean - wanted).abs();
    assert!(found.error > 0.0 || off <= allowed, "{what}: {found:?} without error instead of {wanted}");
    assert!(off <= SIGMAS * found.error + allowed, "{what}: {found:?} instead of {wanted}");
    assert!(found.error <= 0.02 * wanted.abs() + allowed, "{what}: {found:?} says too little of {wanted}");
}

fn object<'a>(view: &'a View, name: &str) -> &'a Seen {
    view.seen.iter().find(|seen| seen.object == name).unwrap_or_else(|| panic!("no {name}"))
}

/// Everything is absorbed or escapes: the sum is the whole, without what chance makes missing.
fn closes(view: &View) {
    let sum = view.absorbed_sr.mean + view.escaped_sr.mean + view.residual_sr.mean;
    assert!((sum / view.whole_sr - 1.0).abs() < 1e-12, "{view:#?}");
    let slack = 1e-12 * view.whole_sr;
    assert!(view.residual_sr.mean.abs() <= SIGMAS * view.residual_sr.error + slack, "{:?}", view.residual_sr);
    let direct: f64 =
        view.seen.iter().filter_map(|seen| seen.seen_sr.get(&Way::Direct)).map(|amount| amount.mean).sum();
    let direct = direct + view.sky_sr[&Way::Direct].mean;
    assert!((direct / view.whole_sr - 1.0).abs() < 1e-12, "in every direction there is one thing that is met first");
}

/// Configuration factor of a disc to a coaxial one (Howell, catalogue C-41).
fn discs(r1: f64, r2: f64, a: f64) -> f64 {
    let x = 1.0 + (a * a + r2 * r2) / (r1 * r1);
    0.5 * (x - (x * x - 4.0 * (r2 / r1).powi(2)).sqrt())
}

/// A detector of radius `r` (mm) about the origin that looks to +z.
fn eye(r: f64) -> String {
    format!(
        "detectors: {{\"eye\": (on: Disk(at: \"(0, 0, 0) mm\", normal: \"(0, 0, 1)\", radius: \"{r} mm\"),
            quantity: Irradiance, side: Front)}},"
    )
}

fn glowing(band: &str, temperatures: &str) -> String {
    format!("thermal: (band: {band}, temperatures: [{temperatures}]),")
}

const BAND: &str = "Band(from: \"3 um\", to: \"5 um\")";
const MICRONS: [f64; 2] = [3e-6, 5e-6];

#[test]
fn coaxial_discs_and_rings_are_seen_by_their_configuration_factors() {
    for value in Case::load("RAD-09").values() {
        let [r1, r2, a] = ["r1", "r2", "a"].map(|name| number(&value, name));
        let factor = number(&value, "F12");
        assert!((discs(r1, r2, a) / factor - 1.0).abs() < 1e-9);
        let model = Model::new()
            .add("disc", moved(disk(r2, 512), a * DVec3::Z))
            .add("ring", moved(annulus(r2, 2.0 * r2, 512), a * DVec3::Z));
        let text = format!(
            "surfaces: [(on: Node(\"*\"), specular: Absorb)], {} {} run: (rays: 200_000),",
            eye(r1),
            glowing(BAND, "(\"disc\", \"300 K\")")
        );
        let found = looked(&warm(&text, &model));
        let view = &found.views[0];
        closes(view);
        agrees("disc", object(view, "disc").seen_sr[&Way::Direct], PI * factor, 0.0);
        let ring = discs(r1, 2.0 * r2, a) - factor;
        agrees("ring", object(view, "ring").seen_sr[&Way::Direct], PI * ring, 0.0);
        agrees("sky", view.escaped_sr, PI * (1.0 - factor - ring), 0.0);
        assert!((view.area_m2 / (PI * (1e-3 * r1).powi(2)) - 1.0).abs() < 1e-12);
    }
}

/// A detector in glass sees the sky by (n_glass / 1)^2 of what passes, and the rest in what the face reflects.
#[test]
fn etendue_is_kept_at_the_face_of_a_glass() {
    let glass = cuboid(DVec3::new(-4e4, -4e4, 0.0), DVec3::new(4e4, 4e4, 50.0));
    let model = Model::new().add("glass", glass).add("black", moved(rectangle(7.9e4, 7.9e4), 2.0 * DVec3::Z));
    for value in Case::load("RAD-08").values() {
        let index = number(&value, "n");
        let text = format!(
            "media: {{\"glass\": Constant(n: {index})}},
            surfaces: [(on: Node(\"glass\"), medium: \"glass\"), (on: Node(\"black\"), specular: Absorb)],
            detectors: {{\"eye\": (on: Disk(at: \"(0, 0, 1) mm\", normal: \"(0, 0, -1)\", radius: \"1 mm\"),
                quantity: Irradiance, side: Front)}},
            {} run: (rays: 200_000),",
            glowing(BAND, "(\"black\", \"300 K\")")
        );
        let view = &looked(&warm(&text, &model)).views[0];
        closes(view);
        assert!((view.whole_sr / (PI * index * index) - 1.0).abs() < 1e-12);
        agrees("sky", view.sky_sr[&Way::Optics], PI * number(&value, "E_over_piL"), 1e-6);
        let reflected = PI * index * index * number(&value, "R_int");
        agrees("black", object(view, "black").seen_sr[&Way::Specular], reflected, 1e-6);
    }
}

/// In a sphere every place sees every patch by its share of the area, whatever was scattered on the way: a port of the share f ends
/// f / (1 - rho (1 - f)) of all ways, and one scatter brings rho (1 - f) f.
#[test]
fn a_port_of_a_sphere_is_seen_directly_by_one_scatter_and_by_all_of_them() {
    let (radius, port, rho) = (50.0, 0.3, 0.8);
    let [cap, rest] = [zone(radius, [0.0, port], 24, 128), zone(radius, [port, PI], 96, 128)];
    let share = area(&cap) / (area(&cap) + area(&rest));
    let model = Model::new().add("port", flipped(cap)).add("wall", flipped(rest));
    let text = format!(
        "scatter: {{\"white\": Lambertian(reflectance: {rho})}},
        surfaces: [(on: Node(\"port\"), specular: Absorb), (on: Node(\"wall\"), specular: Absorb, scatter: \"white\")],
        detectors: {{\"wall\": (on: Node(\"wall\"), quantity: Irradiance, side: Front)}},
        {} run: (rays: 100_000),",
        glowing(BAND, "(\"port\", \"300 K\")")
    );
    let view = &looked(&warm(&text, &model)).views[0];
    closes(view);
    let port = object(view, "port");
    // Facets sag by a part in a thousand of the radius.
    let sag = 3e-3 * PI * share;
    agrees("direct", port.seen_sr[&Way::Direct], PI * share, sag);
    agrees("one scatter", port.seen_sr[&Way::Scatter], PI * rho * (1.0 - share) * share, sag);
    agrees("all ways", port.absorbed_sr, PI * share / (1.0 - rho * (1.0 - share)), 3.0 * sag);
}

/// A small white plate is lit by a lamp and seen by a detector beside it: as it is Lambertian, its rank is its flux.
#[test]
fn a_plate_that_is_lit_and_seen_is_a_path_of_first_order_and_one_seen_from_behind_is_none() {
    let (rho, a) = (0.4, 10.0);
    let model = Model::new()
        .add("plate", flipped(moved(disk(1.0, 64), a * DVec3::Z)))
        .add("shade", moved(disk(1.0, 64), DVec3::new(30.0, 0.0, a)))
        .add("hidden", moved(disk(1.0, 64), -5e3 * DVec3::Z));
    let text = format!(
        "scatter: {{\"white\": Lambertian(reflectance: {rho})}},
        surfaces: [(on: Node(\"*\"), specular: Absorb, scatter: \"white\")],
        sources: {{
            \"on plate\": (flux: \"1 W\", extent: Disk(radius: \"0.5 mm\"), at: \"(6, 0, 2) mm\",
                angular: Collimated(aim_at: \"(0, 0, {a}) mm\"), spectrum: Line(\"550 nm\")),
            \"on shade\": (flux: \"2 W\", extent: Disk(radius: \"0.5 mm\"), at: \"(30, 0, 90) mm\",
                angular: Collimated(direction: \"(0, 0, -1)\"), spectrum: Line(\"550 nm\")),
        }},
        {} run: (rays: 500_000),",
        eye(2.0)
    );
    let compiled = support::compiled(&text, &model);
    let found = looked(&compiled);
    let view = &found.views[0];
    closes(view);
    let names: Vec<&str> = view.first_order.iter().map(|first| first.object.as_str()).collect();
    assert_eq!(names, ["plate"], "the shade is lit on its back and seen on its front");
    let first = &view.first_order[0];
    agrees("lit", first.lit_w, 1.0, 1e-12);
    agrees("seen", first.seen_sr, PI * discs(2.0, 1.0, a), 0.0);
    // Reciprocity: the plate's own factor to the detector.
    agrees("flux", first.flux_w, rho * discs(1.0, 2.0, a), 0.0);
    let lit = |name: &str| found.lit.iter().find(|lit| lit.object == name).expect("listed");
    agrees("shade", lit("shade").flux_w[&Way::Direct], 2.0, 1e-12);
    let limit = object(view, "hidden").upper_limit_sr.expect("not seen") * found.rays as f64 / PI;
    assert!((limit - 3.0).abs() < 1e-9, "{limit}");
    assert!(lit("hidden").upper_limit_w.is_some_and(|limit| limit < 1e-4));
    assert_eq!(found.sources_w, 3.0);
}

/// Photons of a black body in a band per joule of it: the integral of L lambda / (h c) over that of L, by Simpson's rule.
fn photons_per_joule(temperature: f64, [from, to]: [f64; 2]) -> f64 {
    let n = 2000;
    let at = |i: i32| from + (to - from) * f64::from(i) / f64::from(n);
    let weight = |i: i32| if i == 0 || i == n { 1.0 } else { f64::from(2 + 2 * (i % 2)) };
    let sum = |value: &dyn Fn(f64) -> f64| (0..=n).map(|i| weight(i) * value(at(i))).sum::<f64>();
    sum(&|x| planck::radiance(temperature, x) * planck::photons(x)) / sum(&|x| planck::radiance(temperature, x))
}

fn thermal(view: &View) -> &Warmth {
    view.thermal.as_ref().expect("temperatures are known")
}

fn glow(view: &View, name: &str) -> Estimate {
    let found = thermal(view).objects.iter().find(|warm| warm.object == name);
    found.unwrap_or_else(|| panic!("{name} is cold")).flux_w
}

/// A ring in a cold black tube, and a grey and a mirror-like one: A L(T) pi F times the emissivity.
#[test]
fn a_hot_baffle_in_a_cold_tube_sends_what_planck_and_its_configuration_factor_say() {
    let (r, inner, outer, a) = (2.0, 6.0, 10.0, 40.0);
    let factor = discs(r, outer, a) - discs(r, inner, a);
    let eye_area = PI * (1e-3 * r).powi(2);
    let model = Model::new()
        .add("tube", flipped(tube(outer, [-1.0, a], 512)))
        .add("baffle", flipped(moved(annulus(inner, outer, 512), a * DVec3::Z)));
    for (surface, emissivity) in [("Absorb", 1.0), ("Mirror(reflectance: 0.9)", 0.1)] {
        let text = format!(
            "surfaces: [(on: Node(\"tube\"), specular: Absorb), (on: Node(\"baffle\"), specular: {surface})], {} {} run: (rays: 300_000),",
            eye(r),
            glowing(BAND, "(\"*\", \"20 K\"), (\"baffle\", \"300 K\")")
        );
        let view = &looked(&warm(&text, &model)).views[0];
        let wanted = emissivity * eye_area * PI * factor * planck::band(300.0, MICRONS);
        agrees("baffle", glow(view, "baffle"), wanted, 0.0);
        let photons = thermal(view).objects[0].photons_per_s;
        agrees("photons", photons, wanted * photons_per_joule(300.0, MICRONS), 0.0);
        assert!(glow(view, "tube").mean < 1e-20 * wanted, "20 K is cold");
        assert_eq!(thermal(view).objects[0].temperature_k, 300.0);
    }
}

/// CAV-03: walls of any finish, a mirror, a disc and a plate of grey glass, all of one temperature: E = pi L everywhere.
#[test]
fn an_isothermal_enclosure_is_uniform_whatever_is_in_it() {
    let case = Case::load("CAV-03");
    let half = DVec3::new(50.0, 30.0, 20.0);
    let walls = case.setup("/walls").as_array().expect("walls").clone();
    let (mut model, mut surfaces, mut scatter, mut detectors) =
        (Model::new(), String::new(), String::new(), String::new());
    for (i, (wall, face)) in walls.iter().zip(box_faces(-half, half)).enumerate() {
        let rho = number(wall, "rho");
        model = model.add(&format!("wall_{i}"), flipped(face));
        scatter += &format!("\"wall_{i}\": Lambertian(reflectance: {rho}),");
        surfaces += &match i {
            1 => format!("(on: Node(\"wall_{i}\"), specular: Mirror(reflectance: {rho})),"),
            _ => format!("(on: Node(\"wall_{i}\"), specular: Absorb, scatter: \"wall_{i}\"),"),
        };
        detectors += &format!("\"wall_{i}\": (on: Node(\"wall_{i}\"), quantity: Irradiance, side: Front),");
    }
    let glass = cuboid(DVec3::new(10.0, -20.0, -5.0), DVec3::new(40.0, 20.0, 2.0));
    model = model.add("glass", glass).add("disc", moved(disk(6.0, 64), DVec3::new(-20.0, 7.0, 5.0)));
    surfaces += "(on: Node(\"glass\"), medium: \"grey\"), (on: Node(\"disc\"), specular: Absorb),";
    for (i, side) in ["Front", "Back", "Both"].iter().enumerate() {
        detectors += &format!(
            "\"floating_{side}\": (on: Disk(at: \"({}, -10, 8) mm\", normal: \"(1, {i}, 2)\", radius: \"2.5 mm\"),
                quantity: Irradiance, side: {side}),",
            10 * i
        );
    }
    let text = format!(
        "media: {{\"grey\": Constant(n: 1.5, absorption: \"0.1 /mm\")}}, scatter: {{ {scatter} }}, surfaces: [{surfaces}],
        detectors: {{ {detectors} }}, {} run: (rays: 8_000, roulette: (below: 0.1, survive: 0.3)),",
        glowing(BAND, "(\"*\", \"300 K\")")
    );
    let found = looked(&warm(&text, &model));
    assert_eq!(found.views.len(), 9);
    assert!(found.trusted && found.warnings.is_empty(), "{:?}", found.warnings);
    for view in &found.views {
        closes(view);
        let flux = thermal(view).flux_w;
        let unit = PI * planck::band(300.0, MICRONS) * view.area_m2;
        let reference = case.named("E/(pi L0)");
        agrees(&view.detector, Estimate { mean: flux.mean / unit, error: flux.error / unit }, reference, 1e-4);
    }
    assert!(glow(&found.views[0], "inside glass").mean > 0.0, "what absorbs on its way emits");
}

/// A slab that only absorbs, wider than what is looked at, against a cold sky: 1 - 2 E3(alpha d), E3 by Simpson's rule.
#[test]
fn a_grey_window_glows_by_what_it_absorbs() {
    let (depth, alpha) = (3.0, 0.2);
    let model = Model::new().add("window", cuboid(DVec3::new(-4e4, -4e4, 1.0), DVec3::new(4e4, 4e4, 1.0 + depth)));
    let text = format!(
        "media: {{\"smoke\": Constant(n: 1, absorption: \"{alpha} /mm\")}}, surfaces: [(on: Node(\"window\"), medium: \"smoke\")], {} {}
        run: (rays: 100_000),",
        eye(1.0),
        glowing(BAND, "(\"window\", \"350 K\")")
    );
    let view = &looked(&warm(&text, &model)).views[0];
    closes(view);
    let n = 20_000;
    let passes = |mu: f64| if mu > 0.0 { 2.0 * mu * (-alpha * depth / mu).exp() } else { 0.0 };
    let weight = |i: i32| if i == 0 || i == n { 1.0 } else { f64::from(2 + 2 * (i % 2)) };
    let passed: f64 =
        (0..=n).map(|i| weight(i) * passes(f64::from(i) / f64::from(n))).sum::<f64>() / (3.0 * f64::from(n));
    let wanted = PI * PI * 1e-6 * (1.0 - passed) * planck::band(350.0, MICRONS);
    agrees("window", glow(view, "inside window"), wanted, 0.0);
    agrees("sky", view.escaped_sr, PI * passed, 1e-6);
}

#[test]
fn threads_change_no_bit() {
    let model = Model::new().add("wall", flipped(sphere(20.0, 2, Equal::Corners)));
    let text = format!(
        "scatter: {{\"white\": Lambertian(reflectance: 0.7)}}, surfaces: [(on: Node(\"wall\"), specular: Absorb, scatter: \"white\")],
        sources: {{\"bulb\": (flux: \"1 W\", extent: Point, at: \"(3, 1, 5) mm\", angular: Isotropic, spectrum: Line(\"4 um\"))}},
        {} {} run: (rays: 5_000),",
        eye(2.0),
        glowing(BAND, "(\"wall\", \"300 K\")")
    );
    let compiled = warm(&text, &model);
    let json = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        serde_json::to_string(&pool.install(|| looked(&compiled))).expect("JSON")
    };
    let one = json(1);
    assert_eq!(one, json(3));
    assert!(one.contains("\"direct\":{\"mean\":"), "{one}");
}

#[test]
fn what_is_wrong_with_temperatures_is_said() {
    let model = Model::new().add("barrel", disk(5.0, 16));
    let problems = |thermal: &str| -> Vec<String> {
        let text = format!("surfaces: [(on: Node(\"*\"), specular: Absorb)], {} {thermal}", eye(1.0));
        let (_folder, path) = written(&text, &model);
        let error =
            Document::read(&path).and_then(|document| compile_warm(&document)).map(|_| ()).expect_err("refused");
        error
            .problems()
            .iter()
            .map(|problem| problem.to_string().rsplit("system.ron:").next().unwrap_or("").to_owned())
            .collect()
    };
    let said = |thermal: &str, wanted: &[&str]| {
        let found = problems(thermal);
        let fits = wanted.iter().all(|wanted| found.iter().any(|found| found.contains(wanted)));
        assert!(fits, "{found:#?} instead of {wanted:#?}");
    };
    said("thermal: (temperatures: [(\"*\", \"300 K\")]),", &["thermal: field `band` of Thermal is missing"]);
    said(
        "thermal: (band: Line(\"4 um\"), temperatures: [(\"*\", \"-3 K\")]),",
        &[
            "thermal.band: what is warm has the spectrum of its temperature; expected `Band(from: .., to: ..)`",
            "thermal.temperatures[0][1]: \"-3 K\" is out of range; expected 0 K or more",
        ],
    );
    said(&glowing(BAND, "(\"*\", \"0 K\")"), &["nothing is warm; expected a node with a temperature above 0 K"]);
    said(&glowing(BAND, "(\"barel\", \"300 K\")"), &["no node matches `barel`; did you mean `barrel`?"]);
    said(&glowing(BAND, "(\"barrel\", \"4 K\")"), &["at 4 K nothing glows in this band"]);
    said("", &["sources: the system has no light source"]);
}

#[test]
fn the_command_writes_a_page_a_table_and_all_numbers() {
    let model =
        Model::new().add("wall", flipped(sphere(20.0, 2, Equal::Corners))).add("spot", moved(disk(1.0, 16), DVec3::Z));
    let text = format!(
        "scatter: {{\"white\": Lambertian(reflectance: 0.5)}},
        surfaces: [(on: Node(\"*\"), specular: Absorb, scatter: \"white\")],
        sources: {{\"bulb\": (flux: \"1 W\", extent: Point, at: \"(3, 1, 5) mm\", angular: Isotropic, spectrum: Line(\"4 um\"))}},
        {} {}",
        eye(2.0),
        glowing(BAND, "(\"wall\", \"300 K\")")
    );
    let (folder, path) = written(&text, &model);
    let run = |arguments: &[&str]| {
        let all = Command::new(env!("CARGO_BIN_EXE_straylight"))
            .arg("objects")
            .arg(&path)
            .args(arguments)
            .output()
            .expect("run");
        (all.status.code(), String::from_utf8(all.stdout).expect("text"), String::from_utf8(all.stderr).expect("text"))
    };
    let out = folder.path().join("out");
    let (code, told, complaint) = run(&["-o", &out.display().to_string(), "--rays", "2000"]);
    assert_eq!((code, complaint.as_str()), (Some(0), ""), "{told}");
    for line in [
        "Seen by eye:",
        "Lit by the sources (1 W)",
        "Paths of first order to eye",
        "Thermal light on eye, 3 to 5 um",
        "open sky",
    ] {
        assert!(told.contains(line), "{line}: {told}");
    }
    let read = |name: &str| std::fs::read_to_string(out.join(name)).expect(name);
    let json: serde_json::Value = serde_json::from_str(&read("objects.json")).expect("JSON");
    assert_eq!(json["results"]["views"][0]["detector"], "eye");
    assert!(json["run"]["command"].as_str().is_some_and(|command| command.contains("--rays 2000 --seed 1")));
    assert!(read("objects.csv").starts_with("view,object,quantity,unit,mean,error\neye,"));
    let page = read("objects.html");
    assert!(page.contains("What it sees") && page.contains("What the sources light") && !page.contains("<script"));
    std::fs::write(
        &path,
        std::fs::read_to_string(&path)
            .expect("text")
            .replace(
                "Disk(at: \"(0, 0, 0) mm\", normal: \"(0, 0, 1)\", radius: \"2 mm\")",
                "FarField(axis: \"(0, 0, 1)\")",
            )
            .replace("Irradiance, side: Front", "Intensity"),
    )
    .expect("written");
    let (code, _, complaint) = run(&[]);
    assert!(code != Some(0) && complaint.contains("no detector to look from"), "{complaint}");
}

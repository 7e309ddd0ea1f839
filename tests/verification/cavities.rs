//! Cavities: light that meets walls again and again.

use crate::support::case::number;
use crate::support::model::Mesh;
use crate::support::shapes::*;
use crate::support::trial::{bin, scaled};
use crate::support::{Model, Trial};
use glam::DVec3;
use std::f64::consts::PI;
use straylight::tally::results::{Estimate, Results};

cases! { cav_01 cav_02 cav_03 cav_04 cav_04x cav_05 cav_06 cav_06x cav_07 cav_07x }

/// Ports are black caps just inside a sphere of 82 k triangles, deeper than its facets sag (4 um); light that enters the
/// slit between cap and wall adds 2 sag / port radius, at most 2e-3 of a port's flux.
fn cav_01(trial: &mut Trial) {
    let radius = trial.case.given("/sphere_inner_radius");
    let wall = sphere(radius, 6, Equal::Corners);
    let depth = wall.iter().map(|[a, b, c]| (*b - *a).cross(*c - *a).normalize().dot(*a)).fold(radius, f64::min);
    let mut model = Model::new().add("wall", flipped(wall));
    let axes = [DVec3::X, DVec3::Y];
    let ports: Vec<_> = trial.case.values().into_iter().filter(|v| v["port_radius"].is_number()).collect();
    for (i, port) in ports.iter().enumerate() {
        let angle = (number(port, "port_radius") / radius).asin();
        model = model.add(&format!("port_{i}"), facing(zone(depth - 1e-4, [0.0, angle], 32, 128), axes[i]));
    }
    let text = "scatter: {\"white\": Lambertian(reflectance: 0.95)},
        surfaces: [(on: Node(\"wall\"), specular: Absorb, scatter: \"white\"),
            (on: Node(\"port_*\"), specular: Absorb)],
        sources: {\"pencil\": (flux: \"1 W\", extent: Point, angular: Collimated(direction: \"(-1, -0.9, -0.8)\"),
            spectrum: Line(\"550 nm\"))},
        detectors: {\"wall\": (on: Node(\"wall\"), quantity: Irradiance)},
        run: (roulette: (below: 0.3, survive: 0.3), paths: 0),";
    assert_eq!(trial.case.setup("/wall"), "Lambertian rho=0.95");
    let results = trial.run(text, &model, 12_000);
    let sys = trial.case.sys();
    for (i, port) in ports.iter().enumerate() {
        let found = results.absorbed_w[&format!("port_{i}")];
        trial.check(format!("port_{i}"), found, number(port, "flux_out_fraction"), sys);
    }
    let share: f64 = ports.iter().map(|port| number(port, "cap_area_fraction")).sum();
    let hits = results.detectors["wall"].flux_w;
    trial.check_too("absorbed_wall", results.absorbed_w["wall"], trial.case.named("absorbed_wall"), 2.0 * sys);
    trial.check_too("wall hits", hits, trial.case.named("wall_hits_flux (incl. first)"), 40.0 * sys);
    let multiplier = scaled(Estimate { mean: hits.mean - 1.0, ..hits }, 1.0 / (1.0 - share));
    trial.check_too("multiplier", multiplier, trial.case.named("sphere_multiplier M=rho/(1-rho(1-f))"), 40.0 * sys);
}

/// A cube about the origin whose faces are cut at -inner and inner, so that neighbours share their corners; the middle
/// of the face at -z apart.
fn cut_cube(half: f64, inner: f64) -> [Mesh; 2] {
    let cuts = [-half, -inner, inner, half];
    let [mut walls, mut middle] = [Mesh::new(), Mesh::new()];
    for (axis, side) in [(0, -half), (0, half), (1, -half), (1, half), (2, -half), (2, half)] {
        for (i, j) in (0..3).flat_map(|i| (0..3).map(move |j| (i, j))) {
            let at = |u: f64, v: f64| {
                let mut corner = DVec3::ZERO;
                (corner[axis], corner[(axis + 1) % 3], corner[(axis + 2) % 3]) = (side, u, v);
                corner
            };
            let (u, v) = ([cuts[i], cuts[i + 1]], [cuts[j], cuts[j + 1]]);
            let corners = [at(u[0], v[0]), at(u[1], v[0]), at(u[1], v[1]), at(u[0], v[1])];
            let mesh = if (axis, side, i, j) == (2, -half, 1, 1) { &mut middle } else { &mut walls };
            mesh.extend(quad(corners));
        }
    }
    [walls, middle]
}

fn cav_02(trial: &mut Trial) {
    let [walls, detector] = cut_cube(50.0, 5.0);
    let model = Model::new().add("walls", walls).add("detector", detector);
    let text = "scatter: {\"white\": Lambertian(reflectance: 1)},
        surfaces: [(on: Node(\"walls\"), specular: Absorb, scatter: \"white\"),
            (on: Node(\"detector\"), specular: Absorb)],
        sources: {\"bulb\": (flux: \"1 W\", extent: Point, at: \"(20, -13, 7) mm\", angular: Isotropic,
            spectrum: Line(\"550 nm\"))},
        detectors: {\"detector\": (on: Node(\"detector\"), quantity: Irradiance)},
        run: (paths: 0),";
    let results = trial.run(text, &model, 1_000);
    let ledger = results.ledger_w;
    let absorbed = results.detectors["detector"].flux_w.mean;
    trial.exact("absorbed", absorbed, trial.case.named("absorbed"), 1e-12);
    let leaked = ledger.escaped.mean + ledger.lost.mean + ledger.terminated.mean;
    trial.exact("leaked_or_killed", leaked, trial.case.named("leaked_or_killed"), 0.0);
}

/// Half sizes of the box of CAV-03, mm.
const BOX: DVec3 = DVec3::new(50.0, 30.0, 20.0);

/// One wall is a mirror; a black disc that floats in the box shines as its own temperature wants.
fn cav_03(trial: &mut Trial) {
    assert_eq!(trial.case.setup("/geometry"), "closed box 100x60x40 mm");
    let walls = trial.case.setup("/walls").as_array().expect("walls").clone();
    let mut enclosure = Enclosure::default();
    for (i, (wall, face)) in walls.iter().zip(box_faces(-BOX, BOX)).enumerate() {
        enclosure.wall(i, number(wall, "rho"), face);
    }
    enclosure.patch();
    for (i, side) in ["Front", "Back", "Both"].iter().enumerate() {
        let at = DVec3::new(10.0 * i as f64, -10.0, 3.0);
        enclosure.detectors += &counter(&format!("floating_{side}"), at, DVec3::new(1.0, i as f64, 2.0), side);
    }
    let Enclosure { model, surfaces, sources, scatter, detectors } = enclosure;
    let text = format!(
        "scatter: {{ {scatter} }}, surfaces: [{surfaces}], sources: {{ {sources} }}, detectors: {{ {detectors} }},
        run: (roulette: (below: 0.3, survive: 0.3), paths: 0),"
    );
    let results = trial.run(&text, &model, 100_000);
    let reference = trial.case.named("E/(pi L0)");
    for (name, seen) in &results.detectors {
        if let Some(wall) = name.strip_prefix("wall_") {
            let area = [4.0 * BOX.y * BOX.z, 4.0 * BOX.x * BOX.z, 4.0 * BOX.x * BOX.y];
            let area = area[wall.parse::<usize>().expect("a number") / 2];
            trial.check_too(name.as_str(), scaled(seen.flux_w, 1.0 / (PI * area)), reference, 0.0);
        } else {
            let sides = if name == "floating_Both" { 2.0 } else { 1.0 };
            trial.check(name.as_str(), scaled(seen.flux_w, 1.0 / (sides * PI * PI * 6.25)), reference, 0.0);
        }
    }
}

/// A closed box whose walls all have the temperature that goes with a radiance of 1 W/(mm2 sr): by Kirchhoff a wall of
/// reflectance rho emits (1 - rho) pi.
#[derive(Default)]
struct Enclosure {
    model: Model,
    surfaces: String,
    sources: String,
    scatter: String,
    detectors: String,
}

impl Enclosure {
    fn wall(&mut self, i: usize, rho: f64, face: Mesh) {
        let name = format!("wall_{i}");
        self.emit(&name, "Front", (1.0 - rho) * PI * area(&face));
        self.scatter += &format!("\"{name}\": Lambertian(reflectance: {rho}),");
        self.surfaces += &match i {
            1 => format!("(on: Node(\"{name}\"), specular: Mirror(reflectance: {rho})),"),
            _ => format!("(on: Node(\"{name}\"), specular: Absorb, scatter: \"{name}\"),"),
        };
        let [a, b, c] = face[0];
        let normal = -(b - a).cross(c - a).normalize();
        // In the plane of the wall, off its centre.
        let at = -normal * BOX + 4.0 * DVec3::new(normal.y, normal.z, normal.x);
        self.detectors += &format!("\"{name}\": (on: Node(\"{name}\"), quantity: Irradiance),");
        self.detectors += &counter(&format!("on_{i}"), at, normal, "Front");
        self.model = std::mem::take(&mut self.model).add(&name, flipped(face));
    }

    fn patch(&mut self) {
        let patch = disk(2.5, 64);
        self.emit("patch", "Both", 2.0 * PI * area(&patch));
        self.surfaces += "(on: Node(\"patch\"), specular: Absorb),";
        self.detectors += "\"patch\": (on: Node(\"patch\"), quantity: Irradiance, side: Front),";
        self.model = std::mem::take(&mut self.model).add("patch", moved(patch, DVec3::new(-20.0, 7.0, 5.0)));
    }

    fn emit(&mut self, name: &str, side: &str, watts: f64) {
        self.sources += &format!(
            "\"{name}\": (flux: \"{watts} W\", extent: Node(name: \"{name}\", side: {side}), angular: Lambertian,
            spectrum: Line(\"10 um\")),"
        );
    }
}

/// A disc of 5 mm diameter that light passes.
fn counter(name: &str, at: DVec3, normal: DVec3, side: &str) -> String {
    format!(
        "\"{name}\": (on: Disk(at: \"({}, {}, {}) mm\", normal: \"({}, {}, {})\", radius: \"2.5 mm\"),
        quantity: Irradiance, side: {side}),",
        at.x, at.y, at.z, normal.x, normal.y, normal.z
    )
}

/// A pencil along the axis meets the wall opposite the aperture.
fn grey_sphere(trial: &mut Trial) {
    for value in trial.case.values() {
        let [grey, radius, aperture] = ["eps", "R", "aperture_radius"].map(|name| number(&value, name));
        let model = Model::new().add("wall", sphere_with_port(radius, aperture, 64, 128));
        let text = format!(
            "scatter: {{\"grey\": Lambertian(reflectance: {})}},
            surfaces: [(on: Node(\"wall\"), specular: Absorb, scatter: \"grey\")],
            sources: {{\"pencil\": (flux: \"1 W\", extent: Disk(radius: \"0.1 mm\"), at: \"(0, 0, {}) mm\",
                angular: Collimated(direction: \"(0, 0, -1)\"), spectrum: Line(\"550 nm\"))}},
            run: (roulette: (below: 0.1, survive: 0.3), paths: 0),",
            1.0 - grey,
            2.0 * radius
        );
        let results = trial.run(&text, &model, 30_000);
        let reference = number(&value, "absorbed_fraction_of_diffuse_or_any_entering_beam");
        trial.check(format!("eps={grey}"), results.absorbed_w["wall"], reference, 0.0);
    }
}

fn cav_04(trial: &mut Trial) {
    grey_sphere(trial);
}

fn cav_04x(trial: &mut Trial) {
    grey_sphere(trial);
}

/// The lamp is a polygon that fills the open end of the prism.
fn cav_05(trial: &mut Trial) {
    const SIDES: usize = 256;
    for value in trial.case.values() {
        let [depth, grey] = ["L_over_R", "eps"].map(|name| number(&value, name));
        let model = Model::new()
            .add("side", tube(1.0, [0.0, depth], SIDES))
            .add("bottom", moved(disk(1.0, SIDES), depth * DVec3::Z));
        let text = format!(
            "scatter: {{\"grey\": Lambertian(reflectance: {})}},
            surfaces: [(on: Node(\"*\"), specular: Absorb, scatter: \"grey\")],
            sources: {{\"lamp\": (flux: \"1 W\", extent: Polygon(radius: \"{} mm\", sides: {SIDES}),
                axis: \"(0, 0, 1)\", x: \"(1, 0, 0)\", angular: Lambertian, spectrum: Line(\"550 nm\"))}},
            run: (roulette: (below: 0.1, survive: 0.3), paths: 0),",
            1.0 - grey,
            equal_area(1.0, SIDES)
        );
        let results = trial.run(&text, &model, 100_000);
        let sys = 2e-5 + number(&value, "uncertainty");
        trial.check(format!("depth {depth}"), results.ledger_w.absorbed, number(&value, "alpha_eff"), sys);
    }
}

fn concentric(trial: &mut Trial) {
    for value in trial.case.values() {
        let [r1, r2, grey1, grey2] = ["r1", "r2", "eps1", "eps2"].map(|name| number(&value, name));
        let model =
            Model::new().add("inner", sphere(r1, 5, Equal::Area)).add("outer", flipped(sphere(r2, 5, Equal::Area)));
        let text = format!(
            "scatter: {{\"inner\": Lambertian(reflectance: {}), \"outer\": Lambertian(reflectance: {})}},
            surfaces: [(on: Node(\"inner\"), specular: Absorb, scatter: \"inner\"),
                (on: Node(\"outer\"), specular: Absorb, scatter: \"outer\")],
            sources: {{\"inner\": (flux: \"1 W\", extent: Node(name: \"inner\"), angular: Lambertian,
                spectrum: Line(\"10 um\"))}},
            run: (roulette: (below: 0.1, survive: 0.3), paths: 0),",
            1.0 - grey1,
            1.0 - grey2
        );
        let results = trial.run(&text, &model, 60_000);
        let sys = trial.case.sys();
        trial.check("absorbed_outer", results.absorbed_w["outer"], number(&value, "absorbed_outer"), sys);
        trial.check_too("absorbed_inner", results.absorbed_w["inner"], number(&value, "absorbed_inner"), sys);
        trial.exact("escaped", results.ledger_w.escaped.mean, 0.0, 0.0);
    }
}

fn cav_06(trial: &mut Trial) {
    concentric(trial);
}

fn cav_06x(trial: &mut Trial) {
    concentric(trial);
}

/// Enclosure and ball, mm.
fn furnace_model() -> Model {
    Model::new().add("enclosure", flipped(sphere(60.0, 5, Equal::Area))).add("ball", sphere(15.0, 5, Equal::Corners))
}

/// Of the black enclosure's light only the cone of 15.5 deg about each normal can meet the ball (seen under 14.5 deg):
/// only that cone is traced. Radiance is 1 W/(mm2 sr). Facets keep light that total reflection cannot: what still runs
/// round after 300 reflections is cut, and counted.
fn furnace_run(trial: &mut Trial, model: &Model, what: &str, detectors: &str) -> Results {
    let setup = (trial.case.setup("/enclosure").as_str(), trial.case.given("/ball/radius"));
    assert_eq!(setup, (Some("black emitting sphere radius 60 mm, radiance L=1"), 15.0));
    let watts = PI * 15.5f64.to_radians().sin().powi(2) * area(&sphere(60.0, 5, Equal::Area));
    let text = format!(
        "media: {{\"glass\": Constant(n: {})}},
        surfaces: [(on: Node(\"*\"), specular: Absorb), (on: Node(\"ball\"), medium: \"glass\", specular: Fresnel)],
        sources: {{\"enclosure\": (flux: \"{watts} W\", extent: Node(name: \"enclosure\"),
            angular: AngularDiameter(\"31 deg\"), spectrum: Line(\"10 um\"))}},
        detectors: {{ {detectors} }},
        run: (paths: 0, max_reflections: 300),",
        trial.case.given("/ball/n")
    );
    let results = trial.run(&text, model, 30_000);
    trial.exact(format!("cut {what}"), results.ledger_w.terminated.mean / watts, 0.0, 2e-3);
    results
}

fn glass_ball(trial: &mut Trial) {
    // Within radius / index of the centre every direction is lit from outside: a larger counter sees the same.
    let counters = [("small", 0.3f64), ("large", 3.0)];
    let windows = counters.map(|(name, radius)| {
        format!(
            "\"{name}\": (on: Disk(at: \"(0, 0, 0) mm\", normal: \"(1, 2, 3)\", radius: \"{radius} mm\"),
            quantity: Irradiance),"
        )
    });
    let outside = "\"outside\": (on: Disk(at: \"(0, 0, 25) mm\", normal: \"(0, 0, -1)\", radius: \"4 mm\"),
        quantity: Intensity, side: Front, bins: Projected, pixels: (1, 25)),";
    let results = furnace_run(trial, &furnace_model(), "counters", &format!("{}{outside}", windows.concat()));
    let inside = trial.case.named("b: one-sided irradiance/(pi L), transparent counter");
    for (name, radius) in counters {
        // Both sides.
        let found = scaled(results.detectors[name].flux_w, 0.5 / (PI * PI * radius * radius));
        trial.check(format!("b {name}"), found, inside, trial.case.sys());
    }
    // Up to sin^2 = 4/25 all lines through the window meet the ball.
    let seen: Vec<Estimate> = (0..4).map(|row| bin(&results, "outside", row)).collect();
    let mean = seen.iter().map(|e| e.mean).sum();
    let error = seen.iter().map(|e| e.error * e.error).sum::<f64>().sqrt();
    let throughput = PI * 16.0 * PI * 4.0 / 25.0;
    let reference = trial.case.named("a: radiance seen from outside /L");
    trial.check_too("a", scaled(Estimate { mean, error }, 1.0 / throughput), reference, 1e-3);
    let model = furnace_model().add("black", facing(disk(0.3, 64), DVec3::new(1.0, 2.0, 3.0)));
    let results = furnace_run(trial, &model, "black", "\"black\": (on: Node(\"black\"), quantity: Irradiance)");
    let found = scaled(results.detectors["black"].flux_w, 0.5 / (PI * PI * 0.09));
    let reference = trial.case.named("c: one-sided irradiance/(pi L), black detector (a->0 limit)");
    trial.check("c", found, reference, trial.case.sys());
}

fn cav_07(trial: &mut Trial) {
    glass_ball(trial);
}

fn cav_07x(trial: &mut Trial) {
    glass_ball(trial);
}

//! Stray light: one scatter and many, baffles, shadows.

use crate::support::case::number;
use crate::support::shapes::*;
use crate::support::trial::{bin, scaled};
use crate::support::{Model, Trial};
use glam::DVec3;
use serde_json::Value;
use std::f64::consts::PI;
use straylight::tally::results::{Estimate, Results};

cases! { str_01 str_01b str_02 str_03 str_04 str_05 str_06 str_06x str_07 str_07x sca_01 sca_04 }

/// A pencil of 1 W that meets the origin at an angle of incidence to +z, coming from -x, from 50 mm away.
fn pencil(incidence: f64) -> String {
    let (sin, cos) = incidence.to_radians().sin_cos();
    format!(
        "sources: {{\"pencil\": (flux: \"1 W\", extent: Point, at: \"({}, 0, {}) mm\",
            angular: Collimated(aim_at: \"(0, 0, 0) mm\"), spectrum: Line(\"550 nm\"))}},",
        -50.0 * sin,
        50.0 * cos
    )
}

/// A plate at z = 0 that scatters and does nothing else.
fn plate(model: &str) -> String {
    format!(
        "scatter: {{\"plate\": {model}}},
        surfaces: [(on: Node(\"*\"), specular: Absorb), (on: Node(\"plate\"), scatter: \"plate\")],"
    )
}

fn str_01(trial: &mut Trial) {
    pencil_plate_disk(trial);
}

fn str_01b(trial: &mut Trial) {
    pencil_plate_disk(trial);
}

fn pencil_plate_disk(trial: &mut Trial) {
    let [rho, incidence] = ["/plate/rho", "/pencil/incidence_deg"].map(|p| trial.case.given(p));
    let [radius, height, offset] =
        ["radius", "height", "lateral_offset"].map(|p| trial.case.given(&format!("/detector/{p}")));
    let model = Model::new()
        .add("plate", rectangle(10.0, 10.0))
        .add("target", moved(flipped(disk(radius, 512)), DVec3::new(offset, 0.0, height)));
    let text = format!(
        "{} {} detectors: {{\"target\": (on: Node(\"target\"), quantity: Irradiance)}},",
        plate(&format!("Lambertian(reflectance: {rho})")),
        pencil(incidence)
    );
    let results = trial.run(&text, &model, 500_000);
    trial.check("flux", results.detectors["target"].flux_w, number(&trial.case.values()[0], "flux"), 0.0);
}

/// Tube, black bottom with the detector at its centre, beam of unit irradiance (W/m2) that fills the entrance.
fn tube_run(
    trial: &mut Trial,
    detector: f64,
    vanes: Model,
    beam: f64,
    quick: u64,
) -> straylight::tally::results::Results {
    const SIDES: usize = 256;
    let [radius, length, rho] = ["radius", "length", "wall_rho"].map(|p| trial.case.given(&format!("/tube/{p}")));
    let model = vanes
        .add("wall", tube(radius, [0.0, length], SIDES))
        .add("bottom", moved(flipped(annulus(detector, radius, SIDES)), length * DVec3::Z))
        .add("detector", moved(flipped(disk(detector, SIDES)), length * DVec3::Z));
    let (sin, cos) = beam.to_radians().sin_cos();
    let text = format!(
        "scatter: {{\"wall\": Lambertian(reflectance: {rho})}},
        surfaces: [(on: Node(\"*\"), specular: Absorb), (on: Node(\"wall\"), scatter: \"wall\")],
        sources: {{\"sun\": (irradiance: \"1 W/m2\", extent: Polygon(radius: \"{} mm\", sides: {SIDES}),
            axis: \"(0, 0, 1)\", x: \"(1, 0, 0)\", angular: Collimated(direction: \"({sin}, 0, {cos})\"),
            spectrum: Line(\"550 nm\"))}},
        detectors: {{\"detector\": (on: Node(\"detector\"), quantity: Irradiance)}},",
        equal_area(radius, SIDES)
    );
    trial.run(&text, &model, quick)
}

fn str_02(trial: &mut Trial) {
    let detector = 10.0;
    let results = tube_run(trial, detector, Model::new(), 30.0, 250_000);
    assert!(trial.case.setup("/source").as_str().is_some_and(|text| text.contains("30 deg")));
    let value = &trial.case.values()[0];
    let seen = &results.detectors["detector"];
    let pst = 1e6 / (PI * detector * detector);
    trial.check("single", scaled(seen.classes["scatter 1"], pst), number(value, "PST_single_detector_mean"), 0.0);
    trial.check_too("all orders", scaled(seen.flux_w, pst), number(value, "PST_all_orders"), trial.case.sys());
}

fn str_03(trial: &mut Trial) {
    let (radius, inner) = (trial.case.given("/tube/radius"), trial.case.given("/vanes/inner_radius"));
    let vanes = trial.case.list("/vanes/z").into_iter().enumerate().fold(Model::new(), |model, (i, z)| {
        model.add(&format!("vane_{i}"), moved(annulus(inner, radius, 256), z * DVec3::Z))
    });
    let detector = 2.0;
    let results = tube_run(trial, detector, vanes, trial.case.given("/beam_deg"), 500_000);
    let pst = 1e6 / (PI * detector * detector);
    let value = &trial.case.values()[0];
    let single = results.detectors["detector"].classes["scatter 1"];
    trial.check("PST_single", scaled(single, pst), number(value, "PST_single"), trial.case.sys());
}

/// A paraboloid written as an element; the detector is a disc of 5 mm (2 mm at 1 deg, where the irradiance changes
/// fastest), over which the mean differs from its middle by less than 2 %.
fn str_04(trial: &mut Trial) {
    let (diameter, f) = (trial.case.given("/mirror/D"), trial.case.given("/mirror/focal_length"));
    let [a, b, g] = ["A", "B", "g"].map(|p| trial.case.given(&format!("/mirror/ABg/{p}")));
    for value in trial.case.values() {
        let (angle, wanted) = (number(&value, "theta_deg"), number(&value, "PST"));
        let radius = if angle < 2.0 { 2.0 } else { 5.0 };
        let (sin, cos) = angle.to_radians().sin_cos();
        let text = format!(
            "geometry: [], elements: {{
                \"mirror\": (body: Mirror(form: Conic(radius: \"{:?} mm\", conic: -1), diameter: \"{diameter:?} mm\")),
            }},
            scatter: {{ \"rough\": ABg(a: {a:?}, b: {b:?}, g: {g:?}) }},
            surfaces: [(on: Node(\"mirror\"), specular: Mirror(reflectance: 1), scatter: \"rough\")],
            sources: {{ \"star\": (flux: \"1 W\", extent: Disk(radius: \"{:?} mm\"), at: \"({:?}, 0, {:?}) mm\",
                axis: \"({sin:?}, 0, {cos:?})\", angular: Collimated(direction: \"({sin:?}, 0, {cos:?})\"), spectrum: Line(\"550 nm\")) }},
            detectors: {{ \"focus\": (on: Disk(at: \"(0, 0, {:?}) mm\", normal: \"(0, 0, 1)\", radius: \"{radius} mm\"),
                quantity: Irradiance, side: Front) }},",
            -2.0 * f,
            0.6 * diameter,
            -500.0 * sin,
            -500.0 * cos,
            -f
        );
        let results = trial.run(&text, &Model::new(), 400_000);
        // Irradiance of the beam across itself: 1 W over the disc of the source.
        let gain = (0.6 * diameter).powi(2) / (radius * radius);
        let seen = scaled(results.detectors["focus"].classes["scatter 1"], gain);
        trial.check(format!("{angle} deg"), seen, wanted, 0.02 * wanted);
    }
}

/// Peterson's sum over two surfaces, each traced as a paraboloid of its own with the same numerical aperture and its own footprint: light
/// scattered by it, in rings about the focus. A ring is wide; the formula is averaged over it.
fn str_05(trial: &mut Trial) {
    let (na, entrance) = (trial.case.given("/image_NA"), trial.case.given("/entrance_beam_radius"));
    let surfaces = trial.case.setup("/surfaces").as_array().expect("surfaces").clone();
    let traced: Vec<_> = surfaces
        .iter()
        .map(|surface| {
            let get = |name: &str| number(surface, name);
            let (footprint, f) = (get("beam_footprint_radius"), get("beam_footprint_radius") / na);
            let text = format!(
                "geometry: [], elements: {{
                    \"mirror\": (body: Mirror(form: Conic(radius: \"{:?} mm\", conic: -1), diameter: \"{:?} mm\")),
                }},
                scatter: {{ \"rough\": ABg(a: {:?}, b: {:?}, g: {:?}) }},
                surfaces: [(on: Node(\"mirror\"), specular: Mirror(reflectance: 1), scatter: \"rough\")],
                sources: {{ \"star\": (flux: \"1 W\", extent: Disk(radius: \"{footprint:?} mm\"), at: \"(0, 0, {:?}) mm\",
                    angular: Collimated(direction: \"(0, 0, 1)\"), spectrum: Line(\"550 nm\")) }},
                detectors: {{ \"focus\": (on: Disk(at: \"(0, 0, {:?}) mm\", normal: \"(0, 0, 1)\", radius: \"6 mm\"),
                    quantity: Irradiance, side: Front, pixels: (240, 240)) }},
                run: (paths: 0),",
                -2.0 * f,
                2.2 * footprint,
                get("A"),
                get("B"),
                get("g"),
                -0.9 * f,
                -f
            );
            (trial.run(&text, &Model::new(), 200_000), surface.clone())
        })
        .collect();
    for value in trial.case.values() {
        let radius = number(&value, "r_mm");
        let [from, to] = [0.8 * radius, 1.2 * radius];
        let formula = |r: f64| -> f64 {
            let term = |surface: &serde_json::Value| {
                let get = |name: &str| number(surface, name);
                let s = get("beam_footprint_radius");
                let bsdf = get("A") / (get("B") + (na * r / s).powf(get("g")));
                get("T_after") * PI * na * na * (entrance / s).powi(2) * bsdf
            };
            surfaces.iter().map(term).sum()
        };
        assert!((formula(radius) / number(&value, "E_over_Eent") - 1.0).abs() < 1e-9);
        let steps = 400;
        let middle = |i: u32| from + (to - from) * (f64::from(i) + 0.5) / f64::from(steps);
        let mean =
            (0..steps).map(|i| middle(i) * formula(middle(i))).sum::<f64>() / (0..steps).map(middle).sum::<f64>();
        let seen = traced.iter().map(|(results, surface)| {
            let s = number(surface, "beam_footprint_radius");
            // 1 W over the footprint is this many times the irradiance of the entrance beam.
            let scale = PI * s * s * (entrance / s).powi(2) * number(surface, "T_after");
            let Estimate { mean, error } = ring(results, "focus", [from, to]);
            Estimate { mean: scale * mean, error: scale * error }
        });
        let seen = seen.fold(Estimate { mean: 0.0, error: 0.0 }, |a, b| Estimate {
            mean: a.mean + b.mean,
            error: a.error.hypot(b.error),
        });
        trial.check(format!("r {radius} mm"), seen, mean, 0.03 * mean);
    }
}

/// Mean irradiance (W/mm2) in a ring about the middle of a map, between two radii in mm; every pixel counts by its middle.
fn ring(results: &Results, detector: &str, [from, to]: [f64; 2]) -> Estimate {
    let map = results.maps.iter().find(|map| map.detector == detector).expect("a map");
    let [rows, columns] = map.shape;
    let half = 6.0;
    let (mut flux, mut variance, mut area) = (0.0, 0.0, 0.0);
    for bin in 0..rows * columns {
        let middle = |i: usize, n: usize| half * (2.0 * (i as f64 + 0.5) / n as f64 - 1.0);
        let r = middle(bin % columns, columns).hypot(middle(bin / columns, rows));
        if (from..to).contains(&r) {
            flux += map.mean[bin] * map.extent[bin];
            variance += (map.error[bin] * map.extent[bin]).powi(2);
            area += 1e6 * map.extent[bin];
        }
    }
    Estimate { mean: flux / area, error: variance.sqrt() / area }
}

/// Every cone is a run of its own; the window stands 100 mm above the plate, behind the start of the pencil.
fn cones(trial: &mut Trial) {
    let [a, b, g] = ["/A", "/B", "/g"].map(|p| trial.case.given(p));
    let model = Model::new().add("plate", rectangle(10.0, 10.0));
    for value in trial.case.values() {
        let [angle, flux] = ["t_deg", "flux"].map(|name| number(&value, name));
        let watch = match angle < 90.0 {
            true => format!(
                "Disk(at: \"(0, 0, 100) mm\", normal: \"(0, 0, -1)\", radius: \"{} mm\"),
                    quantity: Irradiance, side: Front",
                100.0 * angle.to_radians().tan()
            ),
            false => "FarField(axis: \"(0, 0, 1)\"), quantity: Intensity".into(),
        };
        let text = format!(
            "{} {} detectors: {{\"cone\": (on: {watch})}},",
            plate(&format!("ABg(a: {a}, b: {b}, g: {g})")),
            pencil(0.0)
        );
        let results = trial.run(&text, &model, 100_000);
        trial.check(format!("{angle} deg"), results.detectors["cone"].flux_w, flux, 1e-9 * flux);
    }
}

fn str_06(trial: &mut Trial) {
    cones(trial);
}

fn str_06x(trial: &mut Trial) {
    cones(trial);
}

/// The beam overfills the front aperture by a known ratio of areas.
fn two_apertures(trial: &mut Trial) {
    const MORE: f64 = 1.2;
    let [front, rear, apart] = ["/front_radius", "/rear_radius", "/separation"].map(|p| trial.case.given(p));
    for value in trial.case.values() {
        let theta = number(&value, "theta_deg");
        let (sin, cos) = theta.to_radians().sin_cos();
        let model = Model::new()
            .add("front", annulus(front, 3.0 * front, 512))
            .add("rear", moved(annulus(rear, 6.0 * front, 512), apart * DVec3::Z))
            .add("behind", moved(flipped(disk(10.0 * front, 64)), 1.001 * apart * DVec3::Z));
        let text = format!(
            "surfaces: [(on: Node(\"*\"), specular: Absorb)],
            sources: {{\"beam\": (flux: \"{} W\", extent: Disk(radius: \"{} mm\"), at: \"({}, 0, -10) mm\",
                axis: \"(0, 0, 1)\", angular: Collimated(direction: \"({sin}, 0, {cos})\"),
            spectrum: Line(\"550 nm\"))}},
            detectors: {{\"behind\": (on: Node(\"behind\"), quantity: Irradiance)}},",
            MORE * MORE,
            MORE * front,
            -10.0 * sin / cos
        );
        let results = trial.run(&text, &model, 100_000);
        let fraction = number(&value, "fraction");
        trial.check(format!("{theta} deg"), results.detectors["behind"].flux_w, fraction, trial.case.sys());
    }
}

fn str_07(trial: &mut Trial) {
    two_apertures(trial);
}

fn str_07x(trial: &mut Trial) {
    two_apertures(trial);
}

/// The ledger books the model's albedo, the far field counts what the sampler sends out.
fn sca_01(trial: &mut Trial) {
    let model = Model::new().add("plate", rectangle(2000.0, 2000.0));
    for value in trial.case.values() {
        let [a, b, g, incidence, tis] = ["A", "B", "g", "theta_i_deg", "TIS"].map(|name| number(&value, name));
        let text = format!(
            "{} {} detectors: {{\"far\": (on: FarField(axis: \"(0, 0, 1)\"), quantity: Intensity)}},",
            plate(&format!("ABg(a: {a}, b: {b}, g: {g})")),
            pencil(incidence)
        );
        let results = trial.run(&text, &model, 20_000);
        let name = format!("A={a} {incidence} deg");
        trial.exact(format!("{name} albedo"), 1.0 - results.ledger_w.absorbed.mean, tis, 1e-6 * tis);
        trial.check(name, results.detectors["far"].flux_w, tis, 1e-6 * tis);
    }
}

fn sca_04(trial: &mut Trial) {
    const RINGS: usize = 20;
    let model = || Model::new().add("plate", rectangle(2000.0, 2000.0));
    let values = trial.case.values();
    let reflectances: Vec<&Value> = values.iter().filter(|v| v["R"].is_number()).collect();
    for incidence in trial.case.list("/incidence_deg") {
        for value in &reflectances {
            let [r, brdf, tis] = ["R", "BRDF", "TIS"].map(|name| number(value, name));
            let text = format!(
                "{} {} detectors: {{\"far\": (on: FarField(axis: \"(0, 0, 1)\"), quantity: Intensity, bins: Projected,
                    pixels: (1, {RINGS}))}},",
                plate(&format!("Lambertian(reflectance: {r})")),
                pencil(incidence)
            );
            let results = trial.run(&text, &model(), 40_000);
            trial.exact(format!("TIS {r} {incidence} deg"), results.detectors["far"].flux_w.mean, tis, 1e-9);
            // Rings of equal projected solid angle pi / RINGS: equal flux.
            for ring in [0, RINGS / 2, RINGS - 1] {
                let found = scaled(bin(&results, "far", ring), RINGS as f64 / PI);
                trial.check(format!("BRDF {r} {incidence} deg ring {ring}"), found, brdf, 0.0);
            }
        }
    }
    for value in values.iter().filter(|v| v["cone_half_deg"].is_number()) {
        let [angle, fraction] = ["cone_half_deg", "fraction"].map(|name| number(value, name));
        let text = format!(
            "{} {} detectors: {{\"cone\": (on: Disk(at: \"(0, 0, 10) mm\", normal: \"(0, 0, -1)\", radius: \"{} mm\"),
                quantity: Irradiance, side: Front)}},",
            plate("Lambertian(reflectance: 0.5)"),
            pencil(40.0),
            10.0 * angle.to_radians().tan()
        );
        let results = trial.run(&text, &model(), 40_000);
        trial.check(format!("cone {angle} deg"), scaled(results.detectors["cone"].flux_w, 2.0), fraction, 0.0);
    }
}

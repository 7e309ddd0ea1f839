//! Media that scatter: slabs, half-spaces, and the mean path in a body, which no scatter can change.

use crate::support::case::number;
use crate::support::shapes::*;
use crate::support::trial::{bin, scaled};
use crate::support::{Case, Model, Trial, run};
use glam::DVec3;
use serde_json::Value;
use straylight::tally::results::{Estimate, Results};

cases! { vol_01 vol_02 vol_03x vol_04 vol_06 vol_07 vol_08 }

/// Light that goes on (0) and that comes back (1): the two halves of the sky about +z.
const SKY: &str = "detectors: {\"sky\": (on: FarField(axis: \"(0, 0, 1)\"), quantity: Intensity, pixels: (1, 2))},";

/// One branch at every interface.
const DRAWN: &str = "run: (splits: 0, paths: 0),";

/// A pencil of 1 W in the xz plane that meets the origin at an angle (rad) to +z.
fn pencil(angle: f64) -> String {
    let (sin, cos) = angle.sin_cos();
    format!(
        "sources: {{\"beam\": (flux: \"1 W\", extent: Point, at: \"({:?}, 0, {:?}) mm\",
            angular: Collimated(direction: \"({sin:?}, 0, {cos:?})\"), spectrum: Line(\"550 nm\"))}},",
        -50.0 * sin,
        -50.0 * cos
    )
}

/// `coefficients`: absorption and scattering, 1/mm.
fn turbid(n: f64, [absorption, scattering]: [f64; 2], g: f64) -> String {
    format!(
        "media: {{\"milk\": Turbid(host: Constant(n: {n:?}, absorption: \"{absorption:?} /mm\"),
            scatter: HenyeyGreenstein(coefficient: \"{scattering:?} /mm\", g: {g:?}))}},
        surfaces: [(on: Node(\"body\"), medium: \"milk\", specular: Fresnel)],"
    )
}

/// From z = 0 to `thickness` (mm), so wide that no light leaves by the side.
fn plate(thickness: f64) -> Model {
    let wide = 1e4;
    Model::new().add("body", cuboid(DVec3::new(-wide, -wide, 0.0), DVec3::new(wide, wide, thickness)))
}

/// R and T of a plate.
fn slab(trial: &mut Trial, thickness: f64, medium: &str, angle: f64, rays: u64) -> [Estimate; 2] {
    let text = format!("{medium} {} {SKY} {DRAWN}", pencil(angle));
    let results = trial.run(&text, &plate(thickness), rays);
    [bin(&results, "sky", 1), bin(&results, "sky", 0)]
}

/// A published slab: everything in the setup is in cm.
fn published(trial: &mut Trial, g: f64, rays: u64) {
    let [absorption, scattering, n, thickness] =
        ["/mu_a", "/mu_s", "/n_medium", "/thickness"].map(|pointer| trial.case.given(pointer));
    let phase = trial.case.setup("/phase").as_str().expect("a phase function").to_owned();
    assert_eq!(phase, format!("Henyey-Greenstein g={g}"));
    let medium = turbid(n, [0.1 * absorption, 0.1 * scattering], g);
    let [back, through] = slab(trial, 10.0 * thickness, &medium, 0.0, rays);
    let value = trial.case.values().remove(0);
    let sys = trial.case.sys();
    trial.check("R", back, number(&value, "R_total"), sys);
    trial.check("T", through, number(&value, "T_total"), sys);
}

fn vol_01(trial: &mut Trial) {
    published(trial, 0.75, 60_000);
}

fn vol_02(trial: &mut Trial) {
    published(trial, 0.0, 30_000);
}

fn vol_03x(trial: &mut Trial) {
    published(trial, 0.6, 20_000);
}

/// A half-space, here 60 / sqrt(1 - a) mean free paths deep.
fn vol_04(trial: &mut Trial) {
    for value in trial.case.values() {
        let [albedo, cosine] = ["albedo", "mu0"].map(|name| number(&value, name));
        let medium = turbid(1.0, [1.0 - albedo, albedo], 0.0);
        let depth = 60.0 / (1.0f64 - albedo).sqrt();
        let [back, _] = slab(trial, depth, &medium, cosine.acos(), 20_000);
        trial.check(format!("albedo {albedo} cos {cosine}"), back, number(&value, "R"), 0.0);
    }
}

/// Nothing is absorbed: what is not reflected passes.
fn vol_07(trial: &mut Trial) {
    for value in trial.case.values() {
        let tau = number(&value, "tau");
        let [back, through] = slab(trial, tau, &turbid(1.0, [0.0, 1.0], 0.0), 0.0, 40_000);
        trial.check(format!("R tau {tau}"), back, number(&value, "R_total"), trial.case.sys());
        trial.exact(format!("R + T tau {tau}"), back.mean + through.mean, 1.0, 1e-12);
    }
}

/// Too weak to be felt, 1/mm: what it takes measures the path.
const PROBE: f64 = 1e-6;

/// Flux-weighted mean path in the body, mm, per watt that meets it.
fn mean_path(results: &Results, incident: f64) -> Estimate {
    scaled(results.absorbed_w["medium milk"], 1.0 / (PROBE * incident))
}

/// Four times volume over surface, mm: for a faceted body its own.
fn vol_06(trial: &mut Trial) {
    for value in trial.case.values() {
        let body = value["body"].as_str().expect("a body").to_owned();
        let mesh = match body.starts_with("cube") {
            true => cuboid(DVec3::ZERO, DVec3::splat(10.0)),
            false => sphere(10.0, 4, Equal::Corners),
        };
        let faceted = 4.0 * volume(&mesh) / area(&mesh);
        let ideal = 4.0 * number(&value, "V") / number(&value, "S");
        // The body's own surface shines inwards, into a medium of index 1.
        let text = format!(
            "{} sources: {{\"skin\": (flux: \"1 W\", extent: Node(name: \"body\", side: Back), angular: Lambertian,
                spectrum: Line(\"550 nm\"))}}, {DRAWN}",
            turbid(number(&value, "n"), [PROBE, number(&value, "mu_s")], 0.0)
        );
        let results = trial.run(&text, &Model::new().add("body", mesh), 60_000);
        trial.check(body, mean_path(&results, 1.0), number(&value, "mean_path") * faceted / ideal, 1e-4);
    }
}

/// A true sphere of glass in a closed lamp that sends 1 W, and the flux that meets the sphere, W. `scattering`: 1/mm.
fn ball(radius: f64, n: f64, scattering: f64) -> (String, Model, f64) {
    let shell = sphere(1.3 * radius, 3, Equal::Corners);
    let incident = 4.0 * std::f64::consts::PI * radius * radius / area(&shell);
    let text = format!(
        "elements: {{\"body\": (body: Lens(surfaces: [(form: Sphere(radius: \"{radius:?} mm\")), (form: Sphere(radius: \"-{radius:?} mm\"))],
            thickness: [\"{:?} mm\"], media: [\"milk\"], diameter: \"{:?} mm\"), at: \"(0, 0, {:?}) mm\")}},
        {} default: (specular: Absorb),
        sources: {{\"lamp\": (flux: \"1 W\", extent: Node(name: \"lamp\", side: Back), angular: Lambertian,
            spectrum: Line(\"550 nm\"))}}, {DRAWN}",
        2.0 * radius,
        2.0 * radius,
        -radius,
        turbid(n, [PROBE, scattering], 0.0)
    );
    (text, Model::new().add("lamp", shell), incident)
}

/// In the clear the trapped light of the sphere is out of reach; any scatter lets all of it in.
fn vol_08(trial: &mut Trial) {
    let (radius, n) = (trial.case.given("/R"), trial.case.given("/n"));
    let value: Value = trial.case.values().remove(0);
    for (name, scattering) in [("mean_path", 0.0), ("with_any_isotropic_scatter", 0.2)] {
        let (text, model, incident) = ball(radius, n, scattering);
        let results = trial.run(&text, &model, 60_000);
        // The probe takes 1e-6 per mm from all that is on its way.
        trial.check(name, mean_path(&results, incident), number(&value, name), 2e-4 * number(&value, name));
    }
}

/// Within four of its errors, each below a thousandth of itself.
#[track_caller]
fn to_a_thousandth(what: &str, found: Estimate, reference: f64, sys: f64) {
    let Estimate { mean, error } = found;
    println!("{what}: {mean:.6} +- {error:.6}, reference {reference:.6}: {:+.2} sigma", (mean - reference) / error);
    assert!(error < 1e-3 * reference, "{what}: {mean} +- {error}");
    assert!((mean - reference).abs() <= 4.0 * error + sys, "{what}: {mean} +- {error}, reference {reference}");
}

#[test]
#[ignore = "full size; cargo test --release --test verification -- --ignored"]
fn the_mean_path_of_diffuse_light_is_n_squared_four_v_over_s_to_a_thousandth() {
    let case = Case::load("VOL-08");
    let (radius, n) = (case.given("/R"), case.given("/n"));
    // 4 V / S of a sphere is 4 R / 3.
    let wanted = n * n * 4.0 * radius / 3.0;
    assert!((wanted - number(&case.values()[0], "with_any_isotropic_scatter")).abs() < 1e-12);
    for (seed, scattering) in [0.05, 0.2, 1.0].into_iter().enumerate() {
        let (text, model, incident) = ball(radius, n, scattering);
        let found = mean_path(&run(&text, &model, 6_000_000, 100 + seed as u64), incident);
        // The probe takes 1e-6 per mm from all that is on its way: of paths of the mean square length twice the mean squared.
        to_a_thousandth(&format!("{scattering} /mm"), found, wanted, 2e-4 * wanted);
    }
}

#[test]
#[ignore = "full size; cargo test --release --test verification -- --ignored"]
fn published_slabs_are_met_to_a_thousandth() {
    for (id, g) in [("VOL-01", 0.75), ("VOL-02", 0.0)] {
        let case = Case::load(id);
        let [absorption, scattering, n, thickness] =
            ["/mu_a", "/mu_s", "/n_medium", "/thickness"].map(|pointer| case.given(pointer));
        let medium = turbid(n, [0.1 * absorption, 0.1 * scattering], g);
        let text = format!("{medium} {} {SKY} {DRAWN}", pencil(0.0));
        let results = run(&text, &plate(10.0 * thickness), 12_000_000, 7);
        let value = &case.values()[0];
        // Five digits of the adding-doubling reference.
        to_a_thousandth(&format!("{id} R"), bin(&results, "sky", 1), number(value, "R_total"), 2e-5);
        let through = number(value, "T_total");
        if through > 0.0 {
            to_a_thousandth(&format!("{id} T"), bin(&results, "sky", 0), through, 2e-5);
        }
    }
}

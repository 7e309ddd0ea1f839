//! Media that scatter: slabs, half-spaces, and the mean path in a body, which no scatter can change.

use crate::support::case::number;
use crate::support::shapes::*;
use crate::support::trial::{bin, scaled};
use crate::support::{Model, Trial};
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

/// A true sphere of glass in a closed lamp: in the clear its trapped light is out of reach; any scatter lets all of it in.
fn vol_08(trial: &mut Trial) {
    let (radius, n) = (trial.case.given("/R"), trial.case.given("/n"));
    let value: Value = trial.case.values().remove(0);
    let shell = sphere(1.3 * radius, 3, Equal::Corners);
    let incident = 4.0 * std::f64::consts::PI * radius * radius / area(&shell);
    let model = Model::new().add("lamp", shell);
    for (name, scattering) in [("mean_path", 0.0), ("with_any_isotropic_scatter", 0.2)] {
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
        let results = trial.run(&text, &model, 60_000);
        // The probe takes 1e-6 per mm from all that is on its way.
        trial.check(name, mean_path(&results, incident), number(&value, name), 2e-4 * number(&value, name));
    }
}

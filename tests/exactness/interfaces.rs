//! Single interfaces through the whole chain: text, compile, trace, bill.

use crate::lab::*;
use crate::support::case::number;
use crate::support::shapes::{cuboid, rectangle};
use crate::support::{Case, Model};
use glam::{DQuat, DVec2, DVec3};
use serde_json::Value;
use straylight::tally::results::Results;

/// Polarisation of the beam and the key of its reflectance: s is along y.
const STATES: [(&str, &str); 3] =
    [("Unpolarized", "R_unpol"), ("Linear(angle: \"0 deg\")", "Rs"), ("Linear(angle: \"90 deg\")", "Rp")];

/// A beam meets the top (z = 0) of a block of `beyond`; all other faces are black.
fn block(media: &str, ambient: &str, beam: &str) -> Results {
    let sections = format!(
        "media: {{ {media} }}, ambient: \"{ambient}\",
        surfaces: [
            (on: Node(\"block\"), medium: \"block\", specular: Fresnel),
            (on: Any([Faces(of: \"block\", where: Normal(direction: \"(0, 0, -1)\", within: \"1 deg\")),
                      Faces(of: \"block\", where: Radial(axis: \"(0, 0, 1)\", within: \"80 deg\"))]),
             name: \"dark\", specular: Absorb),
        ],
        {beam}
        run: (rays: 32, batch: 1, paths: 0),"
    );
    results(
        &sections,
        &Model::new().add("block", cuboid(DVec3::new(-500.0, -500.0, -1000.0), DVec3::new(500.0, 500.0, 0.0))),
    )
}

/// Reflected and transmitted fraction where a beam passes from `n1` to `n2`; from inside the block if `inside`.
fn interface(n1: f64, n2: f64, theta: f64, state: &str, inside: bool) -> [f64; 2] {
    let (outer, inner) = if inside { (n2, n1) } else { (n1, n2) };
    let media = format!("\"outer\": Constant(n: {outer:?}), \"block\": Constant(n: {inner:?})");
    let mut direction = downward(theta);
    direction.z *= if inside { -1.0 } else { 1.0 };
    let found = block(&media, "outer", &pencil(DVec3::ZERO, direction, state, "550 nm"));
    let (out, dark) = (found.ledger_w.escaped.mean, found.absorbed_w.get("block.dark").map_or(0.0, |e| e.mean));
    if inside { [dark, out] } else { [out, dark] }
}

fn interfaces(id: &str, inside: bool) {
    let case = Case::load(id);
    let (n1, n2, tolerance) = (case.given("/n1"), case.given("/n2"), case.tolerance("abs"));
    for value in case.values() {
        let theta = number(&value, "theta_deg");
        for (state, key) in STATES {
            let [r, t] = interface(n1, n2, theta.to_radians(), state, inside);
            close(r, number(&value, key), tolerance, &format!("{id} {theta} deg {key}"));
            close(t, 1.0 - number(&value, key), tolerance, &format!("{id} {theta} deg 1 - {key}"));
        }
    }
}

#[test]
fn fre_01_from_air_into_glass() {
    interfaces("FRE-01", false);
}

#[test]
fn fre_02_from_glass_into_air_and_between_glasses() {
    interfaces("FRE-02", true);
    interfaces("FRE-02x", true);
}

/// Light reflected at Brewster's angle meets a second surface at Brewster's angle, turned by phi about the ray: it is all
/// s, so Malus' law holds and nothing is reflected where s has become p.
fn brewster(id: &str) {
    let case = Case::load(id);
    let (value, tolerance) = (&case.values()[0], case.tolerance("abs"));
    let (theta, rs) = (number(value, "theta_B_deg").to_radians(), number(value, "Rs"));
    close((case.given("/n2") / case.given("/n1")).atan().to_degrees(), theta.to_degrees(), 1e-10, "Brewster's angle");
    let first = DVec3::new(theta.sin(), 0.0, theta.cos());
    let on = -DVec3::Z + 2.0 * first.z * first;
    for phi in [0.0, 30.0, 45.0, 90.0f64] {
        let across = on.cross(DVec3::Y);
        let second =
            -theta.cos() * on + theta.sin() * (phi.to_radians().cos() * across + phi.to_radians().sin() * DVec3::Y);
        for (state, incident) in STATES.iter().zip([0.5, 1.0, 0.0]) {
            let sections = format!(
                "media: {{ \"front\": Constant(n: {:?}), \"back\": Constant(n: {:?}) }},
                surfaces: [(on: Node(\"*\"), between: (\"front\", \"back\"), specular: Fresnel)], {} {SINGLE}",
                case.given("/n1"),
                case.given("/n2"),
                pencil(DVec3::ZERO, -DVec3::Z, state.0, "550 nm")
            );
            let turn = |normal: DVec3| DQuat::from_rotation_arc(DVec3::Z, normal.normalize());
            let model = Model::new().add_at("first", rectangle(20.0, 20.0), turn(first), DVec3::ZERO).add_at(
                "second",
                rectangle(20.0, 20.0),
                turn(second),
                100.0 * on,
            );
            let compiled = system(&sections, &model.gltf());
            let trace = watched(&compiled, 0);
            let what = format!("{id} {} phi {phi}", state.0);
            let (met, met_again) = (trace.at(&compiled, "first"), trace.at(&compiled, "second"));
            // Per ray of flux 1 / batch.
            close(met[0].fractions[0], incident * rs, tolerance, &what);
            for sight in met_again.iter().filter(|s| s.flux > 1e-9 * met[0].flux) {
                close(sight.angle, theta, 1e-12, "angle on the second surface");
                let cos = phi.to_radians().cos();
                close(sight.fractions[0], rs * cos * cos, tolerance, &format!("{what}, second surface"));
            }
            assert_eq!(incident > 0.0, met_again.iter().any(|s| s.flux > 1e-9 * met[0].flux), "{what}");
        }
    }
}

#[test]
fn fre_04_light_reflected_at_brewsters_angle_is_polarised_and_stays_so() {
    brewster("FRE-04");
    brewster("FRE-04x");
}

#[test]
fn fre_05_total_reflection_in_a_right_angle_prism() {
    let case = Case::load("FRE-05");
    let prism = wedge([DVec2::ZERO, DVec2::new(20.0, 0.0), DVec2::new(0.0, 20.0)], 10.0);
    let gltf = Model::new().add("prism", prism).gltf();
    for value in case.values() {
        let entry = number(&value, "entry_angle_deg").to_radians();
        let direction = DVec3::new(entry.cos(), -entry.sin(), 0.0);
        for (state, key) in
            [STATES[0], ("Linear(angle: \"90 deg\")", "R_hyp_s"), ("Linear(angle: \"0 deg\")", "R_hyp_p")]
        {
            let face = |name: &str, normal: &str| {
                format!(
                    "(on: Faces(of: \"prism\", where: Normal(direction: \"{normal}\", within: \"1 deg\")), name: \"{name}\"),"
                )
            };
            let sections = format!(
                "media: {{ \"glass\": Constant(n: {:?}) }},
                surfaces: [(on: Node(\"prism\"), medium: \"glass\", specular: Fresnel), {} {} {}],
                detectors: {{ \"sky\": (on: FarField(axis: \"(0, 0, 1)\"), quantity: Intensity, pixels: (4, 4)) }},
                {} {CERTAIN}",
                case.given("/n"),
                face("entry", "(-1, 0, 0)"),
                face("exit", "(0, -1, 0)"),
                face("hyp", "(1, 1, 0)"),
                pencil(DVec3::new(0.0, 10.0, 0.0), direction, state, "550 nm")
            );
            prism_rays(&system(&sections, &gltf), &value, key, case.tolerance("abs"));
        }
    }
}

fn prism_rays(compiled: &straylight::system::compile::Compiled, value: &Value, key: &str, tolerance: f64) {
    let what = format!("FRE-05 {} deg {key}", number(value, "entry_angle_deg"));
    let trace = watched(compiled, 0);
    let first = *trace.at(compiled, "prism.hyp").iter().find(|s| s.depth == 1).expect("light on the hypotenuse");
    close(first.angle.to_degrees(), number(value, "hypotenuse_angle_deg"), tolerance, &format!("{what} angle"));
    if key != "R_unpol" {
        return close(first.fractions[0], number(value, key), tolerance, &what);
    }
    let found = traced(compiled);
    let through = path(&found, "beam > prism.entry:T > prism.hyp:R > prism.exit:T");
    close(through, number(value, "throughput_unpol_first_path"), tolerance, &what);
    let leak = path(&found, "beam > prism.entry:T > prism.hyp:T");
    close(leak, number(value, "leak_through_hypotenuse"), tolerance, &format!("{what} leak"));
}

#[test]
fn fre_06_metals() {
    let case = Case::load("FRE-06");
    for value in case.values() {
        let theta = number(&value, "theta_deg");
        for (state, key) in STATES {
            let sections = format!(
                "surfaces: [(on: Node(\"mirror\"), specular: Metal(n: {:?}, k: {:?}))],
                {} run: (rays: 32, batch: 1, paths: 0),",
                number(&value, "n"),
                number(&value, "k"),
                pencil(DVec3::ZERO, downward(theta.to_radians()), state, "632.8 nm")
            );
            let found = results(&sections, &Model::new().add("mirror", rectangle(100.0, 100.0)));
            let (r, tolerance) = (number(&value, key), case.tolerance("abs"));
            close(found.ledger_w.escaped.mean, r, tolerance, &format!("FRE-06 {} {theta} deg {key}", value["metal"]));
            close(found.absorbed_w["mirror"].mean, 1.0 - r, tolerance, "absorbed");
        }
    }
}

#[test]
fn fre_08_an_absorbing_block_takes_all_that_it_does_not_reflect() {
    let case = Case::load("FRE-08");
    for value in case.values() {
        let media = format!("\"block\": Constant(n: {:?}, k: {:?})", number(&value, "n2_re"), number(&value, "n2_im"));
        for (state, r, t) in [(STATES[1].0, "Rs", "Ts"), (STATES[2].0, "Rp", "Tp")] {
            let direction = downward(number(&value, "theta_deg").to_radians());
            let found = block(&media, "vacuum", &pencil(DVec3::ZERO, direction, state, "550 nm"));
            let (booked, tolerance) =
                (|name: &str| found.absorbed_w.get(name).map_or(0.0, |e| e.mean), case.tolerance("abs"));
            close(found.ledger_w.escaped.mean, number(&value, r), tolerance, &format!("FRE-08 {r}"));
            let entered = booked("medium block") + booked("block.dark");
            close(entered, number(&value, t), tolerance, &format!("FRE-08 {t}"));
            close(booked("block"), 0.0, tolerance, "FRE-08 in the face itself");
        }
    }
}

/// Transmitted flux keeps its digits, and of a beam that fills half a metre of plate not one ray is lost or slips through.
#[test]
fn rob_01_grazing_incidence() {
    let case = Case::load("ROB-01");
    for value in case.values() {
        let theta = number(&value, "theta_deg");
        for (state, key) in [(STATES[1].0, "one_minus_Rs"), (STATES[2].0, "one_minus_Rp")] {
            let direction = downward(theta.to_radians());
            let beam = format!(
                "sources: {{ \"beam\": (flux: \"1 W\", at: \"{} mm\", x: \"(0, 1, 0)\",
                    extent: Rectangle(width: \"500 mm\", height: \"{:?} mm\"),
                    angular: Collimated(direction: \"{}\"), spectrum: Line(\"550 nm\"), polarization: {state}) }},",
                written(-800.0 * direction),
                500.0 * -direction.z,
                written(direction)
            );
            let media = format!("\"block\": Constant(n: {:?})", case.given("/n"));
            let sections = grazing(&media, &beam);
            let found = results(&sections, &plate());
            let (t, dark) = (number(&value, key), found.absorbed_w["block.dark"].mean);
            close(dark, t, case.tolerance("rel") * t, &format!("ROB-01 {theta} deg {key}"));
            close(found.ledger_w.escaped.mean, 1.0 - t, 1e-12, "ROB-01 reflected");
            assert_eq!(found.ledger_w.lost.mean, 0.0);
            assert_eq!(found.detectors["top"].rays, found.rays, "each ray meets the plate");
            close(found.detectors["top"].flux_w.mean, 1.0, 1e-12, "ROB-01 arriving");
        }
    }
}

fn plate() -> Model {
    Model::new().add("block", cuboid(DVec3::new(-500.0, -500.0, -1000.0), DVec3::new(500.0, 500.0, 0.0)))
}

fn grazing(media: &str, beam: &str) -> String {
    format!(
        "media: {{ {media} }},
        surfaces: [
            (on: Node(\"block\"), medium: \"block\", specular: Fresnel),
            (on: Any([Faces(of: \"block\", where: Normal(direction: \"(0, 0, -1)\", within: \"1 deg\")),
                      Faces(of: \"block\", where: Radial(axis: \"(0, 0, 1)\", within: \"80 deg\"))]),
             name: \"dark\", specular: Absorb),
        ],
        detectors: {{ \"top\": (on: Node(\"block\"), quantity: Irradiance, side: Front) }},
        {beam}
        run: (rays: 20000, paths: 0),"
    )
}

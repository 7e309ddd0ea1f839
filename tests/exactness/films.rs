//! Thin films through the whole chain: text, compile, trace, bill; from both sides of their face.

use crate::lab::*;
use crate::support::case::number;
use crate::support::shapes::{cuboid, rectangle};
use crate::support::{Case, Model};
use glam::DVec3;
use serde_json::Value;
use straylight::error::Problem;
use straylight::system::compile::Compiled;

const STATES: [(&str, &str); 3] =
    [("Unpolarized", "_unpol"), ("Linear(angle: \"0 deg\")", "s"), ("Linear(angle: \"90 deg\")", "p")];

/// A sheet at z = 0 whose front is up; `coating` between the media `front` and `back`.
fn sheet(media: &str, coating: &str, beam: &str) -> Compiled {
    let sections = format!(
        "media: {{ {media} }}, coatings: {{ \"films\": {coating} }},
        surfaces: [(on: Node(\"sheet\"), between: (\"front\", \"back\"), coating: \"films\")],
        {beam} {SINGLE}"
    );
    system(&sections, &Model::new().add("sheet", rectangle(1000.0, 1000.0)).gltf())
}

/// R, T and A where a beam meets the sheet at an angle (rad) from the front, or from the back.
fn met(media: &str, coating: &str, theta: f64, state: &str, line: &str, back: bool) -> [f64; 3] {
    let mut direction = downward(theta);
    direction.z *= if back { -1.0 } else { 1.0 };
    let compiled = sheet(media, coating, &pencil(DVec3::ZERO, direction, state, line));
    let trace = watched(&compiled, 0);
    let [r, t, _, a] = trace.at(&compiled, "sheet")[0].fractions;
    [r, t, a]
}

fn constant(name: &str, layer: &Value) -> String {
    format!("\"{name}\": Constant(n: {:?}, k: {:?}), ", number(layer, "n"), number(layer, "k"))
}

/// The stack of a case met from the front, and written in reverse and met from the back: both are the reference.
fn stack(id: &str) {
    let case = Case::load(id);
    let layers = case.setup("/layers_from_incident").as_array().expect("layers").clone();
    let films = &layers[1..layers.len() - 1];
    let media: String = films.iter().enumerate().map(|(i, layer)| constant(&format!("film_{i}"), layer)).collect();
    let ends = [constant("front", &layers[0]), constant("back", &layers[layers.len() - 1])];
    let turned = [constant("back", &layers[0]), constant("front", &layers[layers.len() - 1])];
    for value in case.values() {
        let film = |(i, layer): (usize, &Value)| {
            let thickness = value["gap_nm"].as_f64().unwrap_or_else(|| number(layer, "d_nm"));
            format!("(\"film_{i}\", \"{thickness:?} nm\")")
        };
        let mut written: Vec<String> = films.iter().enumerate().map(film).collect();
        for (back, ends) in [(false, &ends), (true, &turned)] {
            let coating = format!("Stack(layers: [{}])", written.join(", "));
            let media = format!("{media}{}", ends.concat());
            for (state, key) in STATES {
                let theta = number(&value, "theta_deg");
                let line = format!("{} nm", number(&value, "lambda_nm"));
                let [r, t, a] = met(&media, &coating, theta.to_radians(), state, &line, back);
                let what = format!("{id} {theta} deg {line} {key}, from the back: {back}");
                let [wanted_r, wanted_t] = ["R", "T"].map(|power| number(&value, &format!("{power}{key}")));
                let tolerance = case.tolerance("abs");
                close(r, wanted_r, tolerance, &format!("R {what}"));
                close(t, wanted_t, tolerance, &format!("T {what}"));
                close(a, 1.0 - wanted_r - wanted_t, 2.0 * tolerance, &format!("A {what}"));
            }
            written.reverse();
        }
    }
}

#[test]
fn tf_01_a_quarter_wave() {
    stack("TF-01");
}

#[test]
fn tf_02_a_mirror_of_quarter_waves() {
    stack("TF-02");
}

#[test]
fn tf_03_three_layers_in_their_order() {
    stack("TF-03");
}

#[test]
fn tf_04_a_metal_film_from_both_sides() {
    stack("TF-04");
    stack("TF-04b");
}

#[test]
fn tf_05_frustrated_total_reflection() {
    stack("TF-05");
    stack("TF-05x");
}

#[test]
fn tf_06_two_layers_of_any_thickness() {
    stack("TF-06");
}

/// All orders inside the window, each face coated from its air side.
#[test]
fn tf_07_a_window_coated_on_both_sides() {
    let case = Case::load("TF-07");
    let film = &case.setup("/film").as_array().expect("films")[0];
    let media = format!("\"glass\": Constant(n: {:?}), {}", case.given("/substrate_n"), constant("film", film));
    let half = 0.5 * case.given("/substrate_thickness_mm");
    let window = Model::new().add("window", cuboid(DVec3::new(-1e3, -1e3, -half), DVec3::new(1e3, 1e3, half)));
    for value in case.values() {
        let theta = number(&value, "theta_deg");
        for (state, key) in STATES {
            let sections = format!(
                "media: {{ {media} }}, coatings: {{ \"ar\": Stack(layers: [(\"film\", \"{:?} nm\")]) }},
                surfaces: [(on: Node(\"window\"), medium: \"glass\", coating: \"ar\")],
                detectors: {{ \"sky\": (on: FarField(axis: \"(0, 0, 1)\"), quantity: Intensity, pixels: (1, 2)) }},
                {} {CERTAIN}",
                number(film, "d_nm"),
                pencil(DVec3::new(0.0, 0.0, half), downward(theta.to_radians()), state, "550 nm")
            );
            let found = results(&sections, &window);
            let map = found.maps.iter().find(|map| map.detector == "sky").expect("a map");
            let power = |bin: usize| map.mean[bin] * map.extent[bin];
            // Row 0 is about +z: what comes back.
            close(power(0), number(&value, &format!("R{key}")), 1e-8, &format!("TF-07 R{key} {theta}"));
            close(power(1), number(&value, &format!("T{key}")), 1e-8, &format!("TF-07 T{key} {theta}"));
        }
    }
}

const MEDIA: &str = "\"front\": Constant(n: 1), \"back\": Constant(n: 1.5168), \"H\": Constant(n: 2.35), \
                     \"L\": Constant(n: 1.46), \"silver\": Constant(n: 0.06, k: 3.597)";

fn normal(coating: &str, back: bool) -> [f64; 3] {
    met(MEDIA, coating, 0.0, "Unpolarized", "550 nm", back)
}

#[test]
fn quarter_waves_that_repeat_are_the_layers_written_out() {
    let written = "Stack(design: \"550 nm\", layers: [Repeat(2, [(\"H\", \"1/4 wave\"), (\"L\", \"0.25 waves\")]), (\"H\", \"1/4 wave\")])";
    let (h, l) = (550.0 / 4.0 / 2.35, 550.0 / 4.0 / 1.46);
    let out = format!(
        "Stack(layers: [(\"H\", \"{h:?} nm\"), (\"L\", \"{l:?} nm\"), (\"H\", \"{h:?} nm\"), (\"L\", \"{l:?} nm\"), (\"H\", \"{h:?} nm\")])"
    );
    for back in [false, true] {
        for (a, b) in normal(written, back).into_iter().zip(normal(&out, back)) {
            close(a, b, 1e-13, "repeated and written out");
        }
    }
    // Quarter waves: R = ((1 - Y) / (1 + Y))^2 with Y = (H / L)^4 H^2 / n.
    let admittance = (2.35f64 / 1.46).powi(4) * 2.35 * 2.35 / 1.5168;
    close(normal(written, false)[0], ((1.0 - admittance) / (1.0 + admittance)).powi(2), 1e-12, "R of quarter waves");
}

#[test]
fn an_opaque_substrate_under_a_stack_is_a_mirror_from_either_side() {
    let protected = "Stack(layers: [(\"L\", \"100 nm\")], substrate: \"silver\")";
    let [r, t, a] = normal(protected, false);
    assert!(t == 0.0 && (r + a - 1.0).abs() < 1e-15 && r > 0.95, "{r} {t} {a}");
    let same = normal("Stack(layers: [], substrate: \"silver\")", false);
    let opaque = normal("Opaque(medium: \"silver\")", false);
    assert!((same[0] - opaque[0]).abs() < 1e-15 && same[1] == 0.0);
}

#[test]
fn tables_and_splitters_share_as_they_say() {
    let splitter = "Splitter(reflectance: (0.5, 0.3), transmittance: (0.4, 0.6))";
    for (state, r, t) in [(STATES[0].0, 0.4, 0.5), (STATES[1].0, 0.5, 0.4), (STATES[2].0, 0.3, 0.6)] {
        let found = met(MEDIA, splitter, 0.5, state, "550 nm", false);
        close(found[0], r, 1e-15, "splitter R");
        close(found[1], t, 1e-15, "splitter T");
    }
    let table = "Table(rows: [(\"500 nm\", \"0 deg\", 0.1, 0.1, 0.9, 0.9), (\"600 nm\", \"0 deg\", 0.3, 0.3, 0.7, 0.7),
        (\"500 nm\", \"60 deg\", 0.5, 0.1, 0.5, 0.9), (\"600 nm\", \"60 deg\", 0.7, 0.3, 0.3, 0.7)])";
    let found = met(MEDIA, table, 30f64.to_radians(), "Unpolarized", "550 nm", false);
    close(found[0], 0.3, 1e-14, "table R: the mean of 0.4 and 0.2");
    // The same angle in front, from behind.
    let inside = (0.5f64 / 1.5168).asin();
    close(met(MEDIA, table, inside, "Unpolarized", "550 nm", true)[1], found[1], 1e-12, "table T from behind");
}

/// T of unpolarised light through sheets one behind the other in air, met at an angle (rad) in the xz plane.
fn through(coatings: &[&str], theta: f64) -> f64 {
    let written: String = coatings.iter().enumerate().map(|(i, coating)| format!("\"c{i}\": {coating}, ")).collect();
    let on: String = (0..coatings.len()).map(|i| format!("(on: Node(\"s{i}\"), coating: \"c{i}\"), ")).collect();
    let sections = format!(
        "coatings: {{ {written} }}, surfaces: [{on}], {} {SINGLE}",
        pencil(DVec3::ZERO, downward(theta), "Unpolarized", "550 nm")
    );
    let sheets = (0..coatings.len()).fold(Model::new(), |model, i| {
        let place = DVec3::new(0.0, 0.0, -10.0 * i as f64);
        model.add_at(&format!("s{i}"), rectangle(1000.0, 1000.0), glam::DQuat::IDENTITY, place)
    });
    results(&sections, &sheets).ledger_w.escaped.mean
}

#[test]
fn polarisers_obey_malus_and_wave_plates_turn_what_passes() {
    let polariser = |degrees: f64| {
        let (sin, cos) = degrees.to_radians().sin_cos();
        format!("Polarizer(axis: \"({cos:?}, {sin:?}, 0)\")")
    };
    let plate = |degrees: f64, retardance: f64| {
        let (sin, cos) = degrees.to_radians().sin_cos();
        format!("Retarder(axis: \"({cos:?}, {sin:?}, 0)\", retardance: \"{retardance:?} deg\")")
    };
    let (first, crossed) = (polariser(20.0), polariser(110.0));
    for turn in [0.0, 30.0, 60.0, 90.0f64] {
        let malus = 0.5 * turn.to_radians().cos().powi(2);
        close(through(&[&first, &polariser(20.0 + turn)], 0.0), malus, 1e-12, "Malus");
    }
    for retardance in [30.0, 90.0, 180.0f64] {
        // Between crossed polarisers at 45 deg: sin^2(delta / 2).
        let wanted = 0.5 * (0.5 * retardance.to_radians()).sin().powi(2);
        close(through(&[&first, &plate(65.0, retardance), &crossed], 0.0), wanted, 1e-12, "a plate between polarisers");
    }
    let quarters = [&first[..], &plate(65.0, 90.0), &plate(65.0, 90.0), &crossed];
    close(through(&quarters, 0.0), 0.5, 1e-12, "two quarter-wave plates are a half-wave plate");
    close(
        through(&[&first, &plate(65.0, 90.0), &plate(155.0, 90.0), &crossed], 0.0),
        0.0,
        1e-12,
        "crossed plates undo",
    );
    // Slanted: an axis along s (y) stays, one along x is seen along p; they stay crossed.
    close(through(&[&polariser(90.0), &polariser(0.0)], 0.7), 0.0, 1e-12, "crossed and slanted");
    let leaky = "Polarizer(axis: \"(1, 0, 0)\", transmittance: 0.8, leakage: 0.1)";
    close(through(&[leaky], 0.4), 0.45, 1e-12, "half of both");
}

/// What is wrong with a system of these coatings.
fn refused(coating: &str) -> Vec<Problem> {
    let sections = format!(
        "media: {{ {MEDIA} }}, coatings: {{ \"films\": {coating} }},
        surfaces: [(on: Node(\"sheet\"), between: (\"front\", \"back\"), coating: \"films\")],
        {} {SINGLE}",
        pencil(DVec3::ZERO, -DVec3::Z, "Unpolarized", "550 nm")
    );
    let outcome = compile_gltf(&sections, &Model::new().add("sheet", rectangle(1.0, 1.0)).gltf());
    outcome.expect_err("refused").problems().iter().filter(|problem| problem.is_error()).cloned().collect()
}

#[test]
fn wrong_coatings_are_refused_where_they_are_wrong() {
    for (coating, path, message) in [
        ("Stack(layers: [(\"G\", \"9 nm\")])", "coatings[\"films\"].layers[0][0]", "no medium \"G\""),
        ("Stack(layers: [(\"H\", \"9\")])", "coatings[\"films\"].layers[0][1]", "has no unit"),
        ("Stack(layers: [(\"H\", \"-9 nm\")])", "coatings[\"films\"].layers[0][1]", "out of range"),
        ("Stack(layers: [(\"H\", \"1/4 wave\")])", "coatings[\"films\"]", "not of which wavelength"),
        ("Stack(layers: [Twice(2, [(\"H\", \"9 nm\")])])", "coatings[\"films\"].layers[0]", "no `Twice`"),
        ("Stack(layers: [Repeat(0, [(\"H\", \"9 nm\")])])", "coatings[\"films\"].layers[0][0]", "out of range"),
        ("Stack(layers: [Repeat(99999, [(\"H\", \"9 nm\")])])", "coatings[\"films\"].layers", "99999 layers"),
        ("Stack(layers: [], substrate: \"steel\")", "coatings[\"films\"].substrate", "no medium"),
        ("Splitter(reflectance: (0.5, 0.9), transmittance: (0.5, 0.2))", "coatings[\"films\"]", "more light leaves"),
        ("Table()", "coatings[\"films\"]", "no table"),
        ("Table(rows: [(\"550 nm\", \"95 deg\", 0, 0, 1, 1)])", "coatings[\"films\"].rows[0][1]", "out of range"),
        (
            "Table(rows: [(\"600 nm\", \"0 deg\", 0, 0, 1, 1), (\"700 nm\", \"0 deg\", 0, 0, 1, 1)])",
            "coatings[\"films\"]",
            "do not cover the light",
        ),
        ("Zemax(file: \"none.dat\", coating: \"AR\")", "coatings[\"films\"].file", "does not exist"),
    ] {
        let problems = refused(coating);
        let found = problems.iter().find(|problem| problem.message.contains(message));
        assert!(found.is_some_and(|problem| problem.path == path), "{coating}: {problems:#?}");
    }
}

//! Thin films: the numbers of another program, energy, reciprocity, and what no film changes.

use crate::reference::{case, close, number, values};
use glam::DVec3;
use num_complex::Complex64;
use proptest::prelude::*;
use serde_json::Value;
use straylight::optics::refraction::refract;
use straylight::optics::stack::{Around, Layer, Table, split};
use straylight::optics::{Split, fresnel};

fn real(n: f64) -> Complex64 {
    Complex64::new(n, 0.0)
}

/// R_s, R_p, T_s, T_p.
fn powers(split: &Split) -> [f64; 4] {
    let (r, t) = (split.reflected, split.transmitted);
    [r.s, r.p, t.s, t.p].map(|a| a.norm_sqr())
}

/// The stack as it is, and from its table.
fn both(around: &Around, wavelength: f64, layers: &[Layer]) -> [Split; 2] {
    let table = Table::new(layers, wavelength, 2.0).expect("a table");
    [split(around, wavelength, layers.iter().copied()), table.split(around).expect("within the table")]
}

fn films(id: &str) {
    let case = case(id);
    let layers = case["setup"]["layers_from_incident"].as_array().expect("layers");
    let index = |layer: &Value| Complex64::new(number(layer, "n"), number(layer, "k"));
    let (first, last) = (index(&layers[0]), index(&layers[layers.len() - 1]));
    for v in values(&case) {
        let film = |layer: &Value| {
            let thickness = v["gap_nm"].as_f64().unwrap_or_else(|| number(layer, "d_nm"));
            Layer { index: index(layer), thickness: thickness * 1e-9 }
        };
        let films: Vec<Layer> = layers[1..layers.len() - 1].iter().map(film).collect();
        let theta = number(&v, "theta_deg").to_radians();
        let around = Around { n1: first.re, n2: last, cos1: theta.cos() };
        for (found, tolerance) in both(&around, number(&v, "lambda_nm") * 1e-9, &films).iter().zip([1e-12, 1e-10]) {
            for (got, key) in powers(found).into_iter().zip(["Rs", "Rp", "Ts", "Tp"]) {
                close(got, number(&v, key), tolerance, &format!("{id} {key}"));
            }
            close(found.reflected.unpolarised(), number(&v, "R_unpol"), tolerance, id);
            close(found.transmitted.unpolarised(), number(&v, "T_unpol"), tolerance, id);
        }
    }
}

#[test]
fn tf_01_to_06_films_by_their_matrices_and_tables() {
    ["TF-01", "TF-02", "TF-03", "TF-04", "TF-04b", "TF-05", "TF-05x", "TF-06"].into_iter().for_each(films);
}

/// Amplitudes, signs and phases included, of stacks by tmm (see `tests/data/films`).
#[test]
fn amplitudes_are_those_of_tmm() {
    let all: Value = serde_json::from_str(include_str!("../data/films/expected.json")).expect("JSON");
    for stack in all.as_array().expect("stacks") {
        let name = stack["name"].as_str().expect("a name");
        let layers = stack["layers"].as_array().expect("layers");
        let pair = |value: &Value| Complex64::new(value[0].as_f64().expect("re"), value[1].as_f64().expect("im"));
        let index: Vec<Complex64> = layers.iter().map(|layer| pair(&layer["index"])).collect();
        let film = |(layer, index): (&Value, &Complex64)| Layer {
            index: *index,
            thickness: number(layer, "thickness_nm") * 1e-9,
        };
        let inner = 1..layers.len() - 1;
        let films: Vec<Layer> = layers[inner.clone()].iter().zip(&index[inner]).map(film).collect();
        for v in stack["values"].as_array().expect("values") {
            let cos1 = number(v, "theta_deg").to_radians().cos();
            let around = Around { n1: index[0].re, n2: index[index.len() - 1], cos1 };
            for found in both(&around, number(v, "lambda_nm") * 1e-9, &films) {
                let what = format!("{name} at {} deg, {} nm", v["theta_deg"], v["lambda_nm"]);
                for (pol, r, t) in
                    [("s", found.reflected.s, found.transmitted.s), ("p", found.reflected.p, found.transmitted.p)]
                {
                    let wanted = pair(&v[&format!("r{pol}")]);
                    assert!((r - wanted).norm() < 1e-9, "{what}: r_{pol} {r}, reference {wanted}");
                    close(t.norm_sqr(), number(v, &format!("T{pol}")), 1e-9, &what);
                    let turned = Complex64::cis(number(v, &format!("arg_t{pol}")));
                    assert!((t - turned * t.norm()).norm() < 1e-9, "{what}: phase of t_{pol}");
                }
            }
        }
    }
}

/// A layer: index n + ik and thickness, m.
fn layer(lossless: bool) -> impl Strategy<Value = Layer> {
    (0.1..4.0f64, 0.0..5.0f64, 0.0..400e-9f64).prop_map(move |(n, k, thickness)| {
        let index = if lossless { real(1.0 + n) } else { Complex64::new(n, k) };
        Layer { index, thickness }
    })
}

proptest! {
    #[test]
    fn no_stack_sends_off_more_than_arrives(
        layers in prop::collection::vec(layer(false), 0..12), cos1 in 1e-6..1.0f64, n1 in 1.0..2.0f64, n2 in 1.0..2.0f64
    ) {
        let [rs, rp, ts, tp] = powers(&split(&Around { n1, n2: real(n2), cos1 }, 550e-9, layers.into_iter()));
        prop_assert!(rs + ts <= 1.0 + 1e-12 && rp + tp <= 1.0 + 1e-12, "{rs} {ts} {rp} {tp}");
    }

    #[test]
    fn a_lossless_stack_loses_nothing(
        layers in prop::collection::vec(layer(true), 0..12), cos1 in 1e-6..1.0f64, n1 in 1.0..2.0f64, n2 in 1.0..2.0f64
    ) {
        let [rs, rp, ts, tp] = powers(&split(&Around { n1, n2: real(n2), cos1 }, 550e-9, layers.into_iter()));
        prop_assert!((rs + ts - 1.0).abs() < 1e-12 && (rp + tp - 1.0).abs() < 1e-12, "{rs} {ts} {rp} {tp}");
    }

    #[test]
    fn light_passes_a_stack_alike_from_both_sides(
        layers in prop::collection::vec(layer(false), 0..8), cos1 in 0.01..1.0f64, n1 in 1.0..2.0f64, n2 in 1.0..2.0f64
    ) {
        let wi = DVec3::new((1.0 - cos1 * cos1).sqrt(), 0.0, cos1);
        let Some(t) = refract(wi, n1, n2).filter(|t| t.z < -0.01) else { return Ok(()) };
        let there = split(&Around { n1, n2: real(n2), cos1 }, 550e-9, layers.iter().copied());
        let back = split(&Around { n1: n2, n2: real(n1), cos1: -t.z }, 550e-9, layers.into_iter().rev());
        prop_assert!((there.transmitted.s - back.transmitted.s).norm() < 1e-11);
        prop_assert!((there.transmitted.p - back.transmitted.p).norm() < 1e-11);
    }

    #[test]
    fn layers_of_no_thickness_do_nothing(
        layers in prop::collection::vec(layer(false), 0..8), cos1 in 1e-6..1.0f64, n1 in 1.0..2.0f64, n2 in 1.0..2.0f64
    ) {
        let flat = layers.into_iter().map(|layer| Layer { thickness: 0.0, ..layer });
        let found = split(&Around { n1, n2: real(n2), cos1 }, 550e-9, flat);
        let bare = fresnel::interface(real(n1), real(n2), cos1);
        for (a, b) in powers(&found).into_iter().zip(powers(&bare)) {
            prop_assert!((a - b).abs() < 1e-14, "{a} {b}");
        }
    }

    #[test]
    fn a_half_wave_at_its_angle_is_absent(n in 1.1..3.0f64, cos1 in 0.05..1.0f64, n2 in 1.0..2.0f64) {
        // n d cos = lambda / 2 in the layer.
        let m = (n * n - 1.0 + cos1 * cos1).sqrt();
        let film = Layer { index: real(n), thickness: 550e-9 / 2.0 / m };
        let found = split(&Around { n1: 1.0, n2: real(n2), cos1 }, 550e-9, std::iter::once(film));
        for (a, b) in powers(&found).into_iter().zip(powers(&fresnel::interface(real(1.0), real(n2), cos1))) {
            prop_assert!((a - b).abs() < 1e-13, "{a} {b}");
        }
    }

    #[test]
    fn a_table_is_its_stack_at_all_angles(
        layers in prop::collection::vec(layer(false), 1..6), cos1 in 0.0..1.0f64, n1 in 1.0..2.0f64, n2 in 1.0..2.0f64
    ) {
        let around = Around { n1, n2: real(n2), cos1: cos1.max(1e-9) };
        // Beyond a hundred skin depths in all there is no table.
        let Some(table) = Table::new(&layers, 550e-9, 2.0) else { return Ok(()) };
        let direct = powers(&split(&around, 550e-9, layers.into_iter()));
        let found = powers(&table.split(&around).expect("within the table"));
        for (a, b) in direct.into_iter().zip(found) {
            prop_assert!((a - b).abs() < 1e-8, "{a} {b}");
        }
    }
}

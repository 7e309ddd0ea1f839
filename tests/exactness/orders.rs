//! Scatter and coating on one face, in the three orders: an anti-reflection coated lens with haze on its front, from the text to
//! the bill, against the layer's and the haze's own integrals.

use crate::lab::{row, system, traced, watched};
use crate::support::Model;
use num_complex::Complex64;
use std::f64::consts::{PI, TAU};
use straylight::tally::results::{Estimate, Results};

const GLASS: f64 = 1.5168;
const FILM: f64 = 1.38;
const LINE: f64 = 550e-9;

/// Haze 1 / (B + x^2) times A, reflected and transmitted.
const B: f64 = 0.01;
const HAZE: [f64; 2] = [0.02, 0.005];

/// A plano-convex lens, both faces under a quarter wave, met at an angle (rad) in the middle of its flat front.
fn lens(order: &str, theta: f64) -> String {
    let [back, through] = HAZE;
    let (sin, cos) = theta.sin_cos();
    format!(
        "geometry: [],
        media: {{ \"glass\": Constant(n: {GLASS:?}), \"film\": Constant(n: {FILM:?}) }},
        elements: {{ \"lens\": (body: Lens(surfaces: [(form: Plane), (form: Sphere(radius: \"-60 mm\"))],
            thickness: [\"6 mm\"], media: [\"glass\"], diameter: \"24 mm\")) }},
        coatings: {{ \"ar\": Stack(layers: [(\"film\", \"{:?} nm\")]) }},
        scatter: {{ \"haze\": Sum([ABg(a: {back:?}, b: {B:?}, g: 2), ABg(a: {through:?}, b: {B:?}, g: 2, side: Transmit)]) }},
        surfaces: [
            (on: Tag(\"*front\"), coating: \"ar\", scatter: \"haze\", order: {order}),
            (on: Tag(\"*back\"), coating: \"ar\"),
            (on: Tag(\"*edge\"), specular: Absorb),
        ],
        sources: {{ \"beam\": (flux: \"1 W\", extent: Point, at: \"({:?}, 0, {:?}) mm\",
            angular: Collimated(direction: \"({sin:?}, 0, {cos:?})\"), spectrum: Line(\"550 nm\")) }},
        detectors: {{
            \"sky\": (on: FarField(axis: \"(0, 0, 1)\"), quantity: Intensity, pixels: (1, 2)),
            \"inside\": (on: Rectangle(at: \"(0, 0, 1e-6) mm\", normal: \"(0, 0, -1)\", width: \"30 mm\",
                height: \"30 mm\"), quantity: Irradiance, side: Front),
        }},
        run: (rays: 20000, batch: 256, paths: 1000),",
        1e9 * quarter(),
        -10.0 * sin,
        -10.0 * cos,
    )
}

/// A quarter wave of the film, m.
fn quarter() -> f64 {
    LINE / (4.0 * FILM)
}

/// Reflectance of air, film and glass for unpolarised light: Airy's sum over all orders in the film.
fn reflectance(theta: f64) -> f64 {
    let cosine = |n: f64| (1.0 - (theta.sin() / n).powi(2)).sqrt();
    let [(n0, c0), (n1, c1), (n2, c2)] = [1.0, FILM, GLASS].map(|n| (n, cosine(n)));
    let turn = Complex64::cis(2.0 * TAU * n1 * quarter() * c1 / LINE);
    let airy = |first: f64, second: f64| ((first + second * turn) / (1.0 + first * second * turn)).norm_sqr();
    let s = airy((n0 * c0 - n1 * c1) / (n0 * c0 + n1 * c1), (n1 * c1 - n2 * c2) / (n1 * c1 + n2 * c2));
    let p = airy((n1 * c0 - n0 * c1) / (n1 * c0 + n0 * c1), (n2 * c1 - n1 * c2) / (n2 * c1 + n1 * c2));
    0.5 * (s + p)
}

/// Integral of A / (B + |u - u0|^2) over the disc |u| < n: rings about u0, each as far as it lies on the disc.
fn albedo(a: f64, theta: f64, n: f64) -> f64 {
    let specular = theta.sin();
    let arc = |x: f64| {
        let cosine = (n * n - specular * specular - x * x) / (2.0 * specular * x).max(f64::MIN_POSITIVE);
        2.0 * (PI - cosine.clamp(-1.0, 1.0).acos())
    };
    let steps = 400_000;
    let width = (n + specular) / f64::from(steps);
    let ring = |i: i32| {
        let x = (f64::from(i) + 0.5) * width;
        x * arc(x) / (B + x * x) * width
    };
    a * (0..steps).map(ring).sum::<f64>()
}

/// Reflected, transmitted, scattered back and scattered on, as the order says.
fn bill(order: &str, r: f64, [back, through]: [f64; 2]) -> [f64; 4] {
    let (t, rest) = (1.0 - r, 1.0 - back - through);
    match order {
        "ScatterFirst" => [rest * r, rest * t, back, through],
        "Scaled" => [(1.0 - back) * r, (1.0 - through) * t, r * back, t * through],
        _ => [0.0, rest * t, back, through],
    }
}

/// Flux of a path on a detector, W.
fn path(results: &Results, detector: &str, sequence: &str) -> Estimate {
    let found = results.paths.iter().find(|row| row.detector == detector && row.sequence == sequence);
    found.map_or(Estimate { mean: 0.0, error: 0.0 }, |row| row.flux_w)
}

#[track_caller]
fn within(found: Estimate, wanted: f64, what: &str) {
    println!("{what}: {:.6e} +- {:.1e}, integral {wanted:.6e}", found.mean, found.error);
    assert!((found.mean - wanted).abs() <= 4.0 * found.error + 1e-7, "{what}: {found:?}, integral {wanted:e}");
}

#[test]
fn the_three_orders_of_scatter_and_coating_are_their_closed_forms_in_the_bill_of_a_lens() {
    // Two layers' amplitudes of one sign: the closed form of a quarter wave at normal incidence.
    let quarter = ((GLASS - FILM * FILM) / (GLASS + FILM * FILM)).powi(2);
    assert!((reflectance(0.0) - quarter).abs() < 1e-14);
    // A ln(1 + n^2 / B) pi at normal incidence.
    let closed = HAZE[1] * PI * (GLASS * GLASS / B).ln_1p();
    assert!((albedo(HAZE[1], 0.0, GLASS) / closed - 1.0).abs() < 1e-7);
    for theta in [0.0, 40f64.to_radians()] {
        let r = reflectance(theta);
        let lobes = [albedo(HAZE[0], theta, 1.0), albedo(HAZE[1], theta, GLASS)];
        let mut through = Vec::new();
        for order in ["ScatterFirst", "Scaled", "Total"] {
            let what = |name: &str| format!("{order}, {:.0} deg, {name}", theta.to_degrees());
            let [reflected, transmitted, back, on] = bill(order, r, lobes);
            let compiled = system(&lens(order, theta), &Model::new().gltf());
            let found = watched(&compiled, 0).at(&compiled, "lens.front")[0].fractions;
            let left = 1.0 - reflected - transmitted - back - on;
            for (found, wanted) in found.into_iter().zip([reflected, transmitted, back + on, left]) {
                assert!((found - wanted).abs() < 1e-7, "{}: {found} {wanted}", what("bill"));
            }
            let results = traced(&compiled);
            within(path(&results, "sky", "beam > lens.front:R"), reflected, &what("reflected"));
            within(path(&results, "inside", "beam > lens.front:T"), transmitted, &what("transmitted"));
            within(path(&results, "sky", "beam > lens.front:S"), back, &what("scattered back"));
            within(path(&results, "inside", "beam > lens.front:S"), on, &what("scattered on"));
            // Nothing stays in a clear lens but what a total table has taken out of the reflected light. Haze that a coating scales
            // takes R and T of unpolarised light; what has been reflected inside is polarised a little.
            let stays = results.absorbed_w["lens.front"].mean;
            let allowed = if order == "Scaled" { 1e-4 } else { 1e-12 };
            let right = if order == "Total" { stays > 0.9 * left } else { stays.abs() < allowed };
            assert!(right, "{}: {stays:e}", what("absorbed"));
            through.push(row(&results, "beam > lens.front:S > lens.back:T").expect("haze behind the lens").flux_w);
        }
        // Behind both faces the haze is T of the front fainter where the coating scales it.
        let [first, scaled] = [through[0], through[1]];
        let (wanted, error) = ((1.0 - r) * first.mean, scaled.error.hypot((1.0 - r) * first.error));
        assert!((scaled.mean - wanted).abs() < 4.0 * error, "{scaled:?}, {wanted}");
    }
}

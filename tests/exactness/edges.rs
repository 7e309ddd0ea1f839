//! The rounded edge of a vane: what it takes from a beam and what it throws on behind the vane are in proportion to its radius.

use crate::lab::results;
use crate::support::Model;
use std::f64::consts::{FRAC_PI_2, PI, TAU};
use straylight::tally::results::Estimate;

/// Radius of the hole, and of a disc behind it and its distance, mm.
const HOLE: f64 = 5.0;
const DISC: f64 = 5.0;
const BEHIND: f64 = 6.0;

/// Of the beam that lights the edge, mm.
const OUTER: f64 = HOLE + 0.1;

const WHITE: f64 = 0.8;

/// What the edge absorbs and what it throws on the disc at once, W, of 1 W in a ring from the hole to [`OUTER`].
fn edge(radius: f64) -> [Estimate; 2] {
    let text = format!(
        "geometry: [],
        elements: {{ \"vane\": (body: Vane(inner: \"{:?} mm\", outer: \"20 mm\", thickness: \"0.5 mm\", bevel: \"20 deg\",
            edge_radius: \"{radius:?} mm\")) }},
        scatter: {{ \"white\": Lambertian(reflectance: {WHITE:?}) }},
        default: (specular: Absorb),
        surfaces: [(on: Tag(\"*edge\"), name: \"edge\", specular: Absorb, scatter: \"white\")],
        sources: {{ \"sun\": (flux: \"1 W\", extent: Annulus(inner: \"{HOLE:?} mm\", outer: \"{OUTER:?} mm\"), at: \"(0, 0, -9) mm\",
            angular: Collimated(direction: \"(0, 0, 1)\"), spectrum: Line(\"550 nm\")) }},
        detectors: {{ \"disc\": (on: Disk(at: \"(0, 0, {BEHIND:?}) mm\", normal: \"(0, 0, -1)\", radius: \"{DISC:?} mm\"),
            quantity: Irradiance) }},
        run: (rays: 400000, paths: 100),",
        2.0 * HOLE
    );
    let found = results(&text, &Model::new());
    let once = found.paths.iter().filter(|row| row.scatter_order == 1 && row.sequence.matches(" > ").count() == 1);
    let once = once.filter(|row| row.sequence.contains("edge:S")).map(|row| row.flux_w);
    let thrown = once.reduce(|a, b| Estimate { mean: a.mean + b.mean, error: a.error.hypot(b.error) });
    let absorbed = found.absorbed_w.iter().find(|(name, _)| name.contains("edge")).expect("an edge").1;
    [*absorbed, thrown.expect("light behind the vane")]
}

/// Of the light that meets a round edge of small radius: the share that its Lambertian surface sends straight to the disc.
///
///     integral over the quarter turn of cos(a) da        of  rho / pi  integral over the disc of cos cos' / D^2 dA
///
/// a: angle of the normal from the beam, 0 where the edge runs into the front, a right angle on the side of the axis.
fn share() -> f64 {
    let (turns, rings, sectors) = (200, 80, 160);
    let mut sum = 0.0;
    for i in 0..turns {
        let (sin, cos) = (FRAC_PI_2 * (f64::from(i) + 0.5) / f64::from(turns)).sin_cos();
        for j in 0..rings {
            let r = DISC * (f64::from(j) + 0.5) / f64::from(rings);
            for k in 0..sectors {
                let phi = TAU * (f64::from(k) + 0.5) / f64::from(sectors);
                // From a point (HOLE, 0, 0) whose normal is (-sin, 0, -cos).
                let (x, y) = (r * phi.cos() - HOLE, r * phi.sin());
                let square = x * x + y * y + BEHIND * BEHIND;
                let area = r * (DISC / f64::from(rings)) * (TAU / f64::from(sectors));
                let from = (-x * sin - BEHIND * cos).max(0.0);
                sum += cos * from * BEHIND / (square * square) * area * FRAC_PI_2 / f64::from(turns);
            }
        }
    }
    WHITE / PI * sum
}

#[test]
fn the_edge_of_a_vane_scatters_in_proportion_to_its_radius() {
    let share = share();
    for radius in [0.01, 0.02, 0.05] {
        let ring = |outer: f64| outer * outer - HOLE * HOLE;
        let met = ring(HOLE + radius) / ring(OUTER);
        let [absorbed, thrown] = edge(radius);
        println!("{radius} mm: {absorbed:?} of {met:.4e}, {thrown:?} of {:.4e}", share * met);
        // A few thousandths of it are thrown on the edge across the hole.
        assert!((absorbed.mean / ((1.0 - WHITE) * met) - 1.0).abs() < 0.01 + 4.0 * absorbed.error / absorbed.mean);
        // Twelve flats stand for the round: its light goes astray by half of one, 6 deg, at most, and not quite evenly to both sides.
        let off = (thrown.mean - share * met).abs();
        assert!(off < 4.0 * thrown.error + 0.04 * share * met, "{radius} mm: {thrown:?}, integral {}", share * met);
    }
}

//! Every pair of surfaces of a double Gauss.

use crate::gauss::{Gauss, gauss};
use crate::unfold::{exact, paraxial};
use std::f64::consts::SQRT_2;
use straylight::study::ghost::{Ghost, Ghosts};

/// The pairs with their places in the train.
fn pairs(found: &Ghosts) -> impl Iterator<Item = (&Ghost, [usize; 2])> {
    let place = |name: &String| found.surfaces.iter().position(|known| known == name).expect("a surface of the train");
    found.ghosts.iter().filter(|ghost| ghost.surfaces.len() == 2).map(move |ghost| {
        let [first, second] = ghost.surfaces.as_slice() else { unreachable!() };
        (ghost, [place(first), place(second)])
    })
}

/// Every later surface with every earlier one, each once.
fn complete(found: &Ghosts, surfaces: usize) {
    let mut seen: Vec<[usize; 2]> = pairs(found).map(|(_, pair)| pair).collect();
    seen.sort_unstable();
    let wanted: Vec<[usize; 2]> =
        (1..surfaces).flat_map(|first| (0..first).map(move |second| [first, second])).collect();
    assert_eq!(seen, wanted, "{:?}", found.surfaces);
}

#[track_caller]
fn near(got: f64, wanted: f64, within: f64, what: &str) {
    assert!((got - wanted).abs() <= within, "{what}: {got:e}, wanted {wanted:e} within {within:e}");
}

/// A beam of 20 um: flux, focus and radius of all pairs by first-order optics, to 1 %.
fn first_order(gauss: &Gauss, beam: f64, surfaces: usize) {
    let found = gauss.ghosts();
    complete(&found, surfaces);
    for (ghost, pair) in pairs(&found) {
        let wanted = paraxial(&gauss.train, pair);
        assert!(wanted.fullest * beam < 0.3, "{:?} is vignetted", ghost.surfaces);
        let what = |quantity: &str| format!("{quantity} of {:?}", ghost.surfaces);
        near(ghost.flux_w.mean, wanted.flux, 0.01 * wanted.flux, &what("flux"));
        let radius = wanted.height.abs() * beam / SQRT_2;
        near(ghost.rms_radius_m.expect("a radius").mean, radius, 0.01 * radius, &what("radius"));
        let focus = ghost.focus_m.expect("a focus").mean;
        near(focus, wanted.focus, 0.01 * wanted.focus.abs(), &what("focus"));
    }
}

#[test]
fn every_pair_has_its_paraxial_flux_focus_and_radius() {
    let gauss = gauss(0.02, 2048, &[]);
    first_order(&gauss, 0.02e-3, gauss.train.len() - 1);
}

#[test]
fn a_sensor_that_reflects_makes_a_ghost_with_every_surface() {
    let mut gauss = gauss(
        0.02,
        4096,
        &[("(on: Node(\"image\"), specular: Absorb)", "(on: Node(\"image\"), specular: Mirror(reflectance: 0.2))")],
    );
    let last = gauss.train.len() - 1;
    gauss.train[last].reflectance = Some(0.2);
    first_order(&gauss, 0.02e-3, gauss.train.len());
}

/// At a wide aperture rays are aberrated and vignetted: the flux of every pair by exact rays through the unfolded
/// train, to 1 % and four standard errors.
#[test]
fn every_pair_has_the_flux_of_its_unfolded_train() {
    let (beam, count) = (20e-3, 20_000);
    let gauss = gauss(1e3 * beam, 8192, &[]);
    let found = gauss.ghosts();
    complete(&found, gauss.train.len() - 1);
    let height = |i: u32| beam * ((f64::from(i) + 0.5) / f64::from(count)).sqrt();
    for (ghost, pair) in pairs(&found) {
        let sum: f64 = (0..count).map(|i| exact(&gauss.train, &gauss.bores, pair, height(i))).sum();
        let wanted = sum / f64::from(count);
        let error = 4.0 * ghost.flux_w.error;
        near(ghost.flux_w.mean, wanted, 0.01 * wanted + error, &format!("flux of {:?}", ghost.surfaces));
    }
}

#[test]
fn a_ghost_of_1e_minus_9_is_known_as_well_as_a_bright_one() {
    let edits = [
        (
            "    scatter: {",
            "    coatings: { \"ar\": Ideal(reflectance: 3e-5, transmittance: 0.99997) },\n    scatter: {",
        ),
        (
            "\n    surfaces: [\n",
            "\n    surfaces: [\n        (on: Any([Tag(\"L4.front\"), Tag(\"L4.back\")]), coating: \"ar\"),\n",
        ),
    ];
    let [bare, coated] = [[].as_slice(), &edits].map(|edits| gauss(20.0, 2048, edits).ghosts());
    let last = |found: &Ghosts| {
        let pair = pairs(found).find(|(_, pair)| *pair == [9, 8]).expect("the pair of the last lens").0.clone();
        (pair.flux_w.mean, pair.flux_w.error / pair.flux_w.mean, pair.rays)
    };
    let ((bright, known, rays), (faint, as_well, as_many)) = (last(&bare), last(&coated));
    assert!(bright > 1e-4 && faint < 1e-9 && faint > 0.0, "{bright:e} {faint:e}");
    assert_eq!(rays, as_many);
    near(as_well, known, 0.2 * known, "relative error");
}

/// Scatter and reflections of higher order aside, a run sees the same light: class by class, also what the sensor sends back.
#[test]
fn all_pairs_together_are_the_ghosts_of_a_plain_run() {
    let mirror =
        [("(on: Node(\"image\"), specular: Absorb)", "(on: Node(\"image\"), specular: Mirror(reflectance: 0.2))")];
    for edits in [[].as_slice(), &mirror] {
        let gauss = gauss(20.0, 4096, edits);
        let (found, run) = (gauss.ghosts(), gauss.run());
        let sum: f64 = pairs(&found).map(|(ghost, _)| ghost.flux_w.mean).sum();
        let error: f64 = pairs(&found).map(|(ghost, _)| ghost.flux_w.error).sum();
        let class = run.detectors["image"].classes["ghost 2"];
        near(sum, class.mean, 4.0 * class.error.hypot(error), "ghosts of two reflections");
        let (signal, same) = (found.signals[0].flux_w, run.detectors["image"].classes["signal"]);
        near(signal.mean, same.mean, 4.0 * signal.error.hypot(same.error), "signal");
        assert!(!run.detectors["image"].classes.contains_key("ghost 1"), "an even number turns light back");
    }
}

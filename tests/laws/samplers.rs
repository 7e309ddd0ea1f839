//! Every sampler draws what its density says, and carries the flux its model says.

use crate::cells::Cells;
use crate::family::{Member, family};
use crate::measured::{anodize, zemax};
use crate::polar::Pole;
use crate::reference::{case, close, number, values};
use glam::DVec3;
use statrs::distribution::{ChiSquared, ContinuousCDF};
use std::f64::consts::{PI, TAU};
use straylight::bsdf::{Abg, Bsdf, Side};
use straylight::math::Rng;
use straylight::optics::Incidence;

/// Chance that any test of a family of tests fails though all samplers are right.
const ALPHA: f64 = 0.01;

/// One test of one sampler at one incidence.
struct Tried {
    p: f64,
    what: String,
}

/// Every sampler at every incidence.
fn tried([draws, panels]: [usize; 2]) -> Vec<Tried> {
    let mut all = Vec::new();
    for member in family() {
        let Member { name, model, pole, kinks, .. } = member;
        // Kinks of a density, and many rings, want short panels.
        let fineness = [draws, if *kinks < 1e-3 { panels } else { 3 * panels }];
        for at in member.incidences() {
            let cells = Cells::new(&at, *pole, fineness, &|wo| model.pdf(&at, wo));
            let mut rng = Rng::new(77, all.len() as u64, 0);
            let p = cells.p_value(|| model.sample(&at, &mut rng));
            let what =
                format!("{name}: wi {:.3} from n = {}, density {:.7}", at.wi, at.index[0].re, cells.probability());
            all.push(Tried { p, what });
        }
    }
    all
}

/// No p-value below the level that the least of them all falls below once in 1 / ALPHA (Sidak).
#[track_caller]
fn assert_all(tried: &[Tried]) {
    let level = 1.0 - (1.0 - ALPHA).powf(1.0 / tried.len() as f64);
    let failed: Vec<String> =
        tried.iter().filter(|t| t.p < level).map(|t| format!("{}: p {:e}", t.what, t.p)).collect();
    assert!(failed.is_empty(), "{} of {} below {level:e}:\n{}", failed.len(), tried.len(), failed.join("\n"));
}

#[test]
fn every_sampler_draws_its_density() {
    assert_all(&tried([20_000, 180]));
}

/// A million draws each.
#[test]
#[ignore = "five minutes of draws"]
fn every_sampler_draws_its_density_to_a_million() {
    assert_all(&tried([1_000_000, 540]));
}

/// Lobes, and the cells of one drawn from by another that is little wider, or little turned.
#[test]
fn a_sampler_that_is_little_off_is_found() {
    let lobe = |b| Abg::new(1e-3, b, 2.0, Side::Reflect);
    let at = |theta| Incidence::in_air(f64::to_radians(theta), 550e-9);
    let (right, wide) = (lobe(1e-4), lobe(1.5e-4));
    let cells = Cells::new(&at(30.0), Pole::Specular, [200_000, 360], &|wo| right.pdf(&at(30.0), wo));
    let p = |model: &Abg, theta: f64| {
        let mut rng = Rng::new(5, 0, 0);
        cells.p_value(|| model.sample(&at(theta), &mut rng))
    };
    assert!(p(&right, 30.0) > 1e-3);
    assert!(p(&wide, 30.0) < 1e-6 && p(&right, 30.5) < 1e-6, "{} {}", p(&wide, 30.0), p(&right, 30.5));
}

#[test]
fn a_table_draws_its_density_at_grazing_incidence() {
    let tables: [(&str, Box<dyn Bsdf>); 2] = [("speos", Box::new(anodize())), ("zemax", Box::new(zemax()))];
    let mut all = Vec::new();
    for (name, model) in tables {
        for (k, theta) in [80.0f64, 84.3, 87.75, 89.0].into_iter().enumerate() {
            let at = Incidence::in_air(theta.to_radians(), 550e-9);
            let cells = Cells::new(&at, Pole::Grid, [400_000, 360], &|wo| model.pdf(&at, wo));
            let mut rng = Rng::new(8, k as u64, 0);
            let p = cells.p_value(|| model.sample(&at, &mut rng));
            all.push(Tried { p, what: format!("{name} at {theta} deg") });
        }
    }
    assert_all(&all);
}

#[test]
fn the_mean_weight_of_a_sampler_is_the_albedo() {
    for member in family() {
        let Member { name, model, slack, .. } = member;
        for at in member.incidences() {
            let mut rng = Rng::new(3, 1, 4);
            let (n, mut sum, mut squares) = (30_000, 0.0, 0.0);
            for _ in 0..n {
                let weight = |wo: DVec3| model.eval(&at, wo) * wo.z.abs() / model.pdf(&at, wo);
                let w = model.sample(&at, &mut rng).map_or(0.0, weight);
                sum += w;
                squares += w * w;
            }
            let mean = sum / f64::from(n);
            let sigma = ((squares / f64::from(n) - mean * mean).max(0.0) / f64::from(n)).sqrt();
            let wanted = model.albedo(&at);
            // Where all weights are the same, sigma is 0 and what is left is rounding, or the interpolation of the albedo.
            assert!((mean - wanted).abs() < 4.5 * sigma + slack * wanted, "{name}: {mean} +- {sigma}, {wanted}");
        }
    }
}

#[test]
fn drawn_directions_are_unit_and_have_a_density() {
    for member in family() {
        let Member { name, model, .. } = member;
        for at in member.incidences() {
            let mut rng = Rng::new(9, 2, 6);
            for _ in 0..2000 {
                let Some(wo) = model.sample(&at, &mut rng) else { continue };
                assert!((wo.length() - 1.0).abs() < 1e-12, "{name}: {wo}");
                assert!(model.pdf(&at, wo) > 0.0 && model.pdf(&at, wo).is_finite(), "{name}: {wo}");
            }
        }
    }
}

/// Kolmogorov-Smirnov distance of p-values from the uniform law.
fn distance(p: &mut [f64]) -> f64 {
    p.sort_by(f64::total_cmp);
    let n = p.len() as f64;
    let step = |(k, p): (usize, &f64)| (p - k as f64 / n).max((k + 1) as f64 / n - p);
    p.iter().enumerate().map(step).fold(0.0, f64::max)
}

/// Flux-weighted probabilities of SCA-03: rings of equal area in |beta|, sectors about the direction of beta_0.
#[test]
fn sca_03_abg_histogram() {
    let reference = &values(&case("SCA-03"))[0];
    let lobe = Abg::new(0.01, 0.02, 1.5, Side::Reflect);
    let at = Incidence::in_air(30f64.to_radians(), 550e-9);
    close(lobe.albedo(&at), number(reference, "TIS"), 1e-8, "TIS");
    let wanted: Vec<f64> = reference["P_normalised"]
        .as_array()
        .expect("rings")
        .iter()
        .flat_map(|r| r.as_array().expect("sectors").iter().map(|p| p.as_f64().expect("a number")))
        .collect();
    let mut p = Vec::new();
    for seed in 0..20 {
        let (mut rng, mut count, mut kept) = (Rng::new(seed, 0, 0), [0u32; 64], 0.0);
        for _ in 0..100_000 {
            // Weights are constant, so counts are fluxes.
            let Some(wo) = lobe.sample(&at, &mut rng) else { continue };
            kept += 1.0;
            let ring = ((wo.x * wo.x + wo.y * wo.y) * 8.0) as usize;
            let turn = ((-wo.y).atan2(-wo.x) / TAU).rem_euclid(1.0);
            count[ring.min(7) * 8 + ((turn * 8.0) as usize).min(7)] += 1;
        }
        let chi: f64 = wanted.iter().zip(count).map(|(w, c)| (f64::from(c) - w * kept).powi(2) / (w * kept)).sum();
        p.push(1.0 - ChiSquared::new(63.0).expect("63").cdf(chi));
    }
    let d = distance(&mut p);
    assert!(d < 0.422 && p[0] > 1e-4, "D {d}, {p:?}");
}

#[test]
fn str_06_flux_within_cones_of_thousandths_of_a_degree() {
    for id in ["STR-06", "STR-06x"] {
        let case = case(id);
        let setup = |name: &str| number(&case["setup"], name);
        let lobe = Abg::new(setup("A"), setup("B"), setup("g"), Side::Reflect);
        let at = Incidence::in_air(0.0, 550e-9);
        let (n, mut rng) = (1_000_000, Rng::new(6, 0, 0));
        let total = PI * setup("A") * (1.0 / setup("B")).ln_1p();
        let sines: Vec<f64> =
            (0..n).filter_map(|_| lobe.sample(&at, &mut rng)).map(|w| w.truncate().length()).collect();
        for v in values(&case) {
            let edge = number(&v, "t_deg").to_radians().sin();
            let part = sines.iter().filter(|s| **s <= edge).count() as f64 / f64::from(n);
            let p = number(&v, "flux") / total;
            close(part, p, 4.0 * (p * (1.0 - p) / f64::from(n)).sqrt() + 1e-12, id);
        }
    }
}

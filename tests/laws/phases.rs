//! Scatter inside media: every phase function is normalised, is drawn as it says, and has the moments it should; Mie spheres.

use crate::reference::{case, number, values};
use num_complex::Complex64;
use statrs::distribution::{ChiSquared, ContinuousCDF};
use std::f64::consts::TAU;
use straylight::math::Rng;
use straylight::math::quadrature::GaussLegendre;
use straylight::medium::bulk::{Bulk, Cosines, HenyeyGreenstein, Rayleigh, Spectrum, Spheres, Tabulated};
use straylight::medium::{Constant, Medium};
use straylight::optics::mie::Sphere;

const LINE: f64 = 550e-9;

fn henyey_greenstein(g: f64) -> HenyeyGreenstein {
    HenyeyGreenstein { coefficient: Spectrum::constant(1.0), g }
}

fn spheres(diameter: f64) -> Spheres {
    let clear = |n: f64| Constant::transparent(n);
    Spheres::filling(&clear(1.59), &clear(1.33), diameter, 1e-3, &[400e-9, 550e-9, 800e-9])
}

fn family() -> Vec<(String, Box<dyn Bulk>)> {
    let table = [(-1.0, 0.2), (-0.5, 1.0), (0.3, 0.0), (0.7, 0.0), (0.999, 50.0), (1.0, 80.0)];
    let cosines = Cosines::new(&table).expect("rising");
    let mut list: Vec<(String, Box<dyn Bulk>)> = vec![
        ("Rayleigh".into(), Box::new(Rayleigh { coefficient: 1.0, at: LINE })),
        ("table".into(), Box::new(Tabulated { coefficient: Spectrum::constant(1.0), cosines })),
        ("spheres of 0.1 um".into(), Box::new(spheres(0.1e-6))),
        ("spheres of 1 um".into(), Box::new(spheres(1e-6))),
        ("spheres of 20 um".into(), Box::new(spheres(20e-6))),
    ];
    for g in [0.0, 0.05, -0.3, 0.75, 0.999, -0.97] {
        list.push((format!("Henyey-Greenstein {g}"), Box::new(henyey_greenstein(g))));
    }
    list
}

/// Integral of 2 pi p f(cos) over the cosine, in panels that shrink towards both ends.
fn integral(model: &dyn Bulk, wavelength: f64, [from, to]: [f64; 2], f: impl Fn(f64) -> f64) -> f64 {
    let rule = GaussLegendre::new(12);
    let panels = 400;
    // u -> cos(pi u) with more panels at the ends.
    let at = |u: f64| -(std::f64::consts::PI * u).cos();
    let angle = |c: f64| (-c).clamp(-1.0, 1.0).acos() / std::f64::consts::PI;
    let (a, b) = (angle(from), angle(to));
    let slope = |u: f64| std::f64::consts::PI * (std::f64::consts::PI * u).sin();
    let value = |u: f64| TAU * model.phase(at(u), wavelength) * f(at(u)) * slope(u);
    let edge = |k: usize| a + (b - a) * k as f64 / panels as f64;
    (0..panels).map(|k| rule.integrate(edge(k), edge(k + 1), value)).sum()
}

#[test]
fn every_phase_function_is_normalised() {
    for (name, model) in family() {
        for wavelength in [400e-9, 500e-9, 550e-9] {
            let total = integral(model.as_ref(), wavelength, [-1.0, 1.0], |_| 1.0);
            assert!((total - 1.0).abs() < 2e-4, "{name}: {total}");
        }
    }
}

/// Chi-squared of the draws against the phase function, in bins of equal width in the angle.
#[test]
fn every_phase_function_is_drawn_as_it_says() {
    let (bins, draws) = (48, 100_000u64);
    let tests = family().len() * 2;
    for (at, (name, model)) in family().into_iter().enumerate() {
        for wavelength in [550e-9, 470e-9] {
            let mut rng = Rng::new(7, at as u64, (wavelength * 1e9) as u64);
            let mut counts = vec![0u64; bins];
            for _ in 0..draws {
                let cosine = model.draw(wavelength, &mut rng);
                assert!((-1.0..=1.0).contains(&cosine), "{name}: {cosine}");
                counts[((cosine.acos() / std::f64::consts::PI * bins as f64) as usize).min(bins - 1)] += 1;
            }
            let edge = |k: usize| (std::f64::consts::PI * k as f64 / bins as f64).cos();
            // Cells with few draws are put together.
            let (mut cells, mut open) = (Vec::new(), (0.0, 0u64));
            for (k, count) in counts.iter().enumerate() {
                let expected = draws as f64 * integral(model.as_ref(), wavelength, [edge(k + 1), edge(k)], |_| 1.0);
                open = (open.0 + expected, open.1 + count);
                if open.0 >= 10.0 {
                    cells.push(std::mem::take(&mut open));
                }
            }
            if let Some(last) = cells.last_mut() {
                *last = (last.0 + open.0, last.1 + open.1);
            }
            let chi: f64 = cells.iter().map(|(expected, count)| (*count as f64 - expected).powi(2) / expected).sum();
            if cells.len() < 2 {
                continue;
            }
            let p = 1.0 - ChiSquared::new((cells.len() - 1) as f64).expect("positive").cdf(chi);
            let least = 1.0 - 0.99f64.powf(1.0 / tests as f64);
            assert!(p > least, "{name} at {wavelength}: chi-squared {chi} in {} cells", cells.len());
        }
    }
}

#[test]
fn between_two_wavelengths_the_spheres_mix() {
    let model = spheres(1e-6);
    let [low, high] = [400e-9, 550e-9].map(|wavelength| model.coefficient(wavelength) * model.phase(0.9, wavelength));
    let middle = model.coefficient(475e-9) * model.phase(0.9, 475e-9);
    assert!((middle - 0.5 * (low + high)).abs() < 1e-12 * middle);
}

/// What scatters and absorbs is what the efficiencies say: per length, 3/2 f Q / D.
#[test]
fn spheres_scatter_by_their_efficiency() {
    let absorbing = Constant { n: 1.59, loss: straylight::medium::Loss::Extinction(0.01) };
    let model = Spheres::filling(&absorbing, &Constant::transparent(1.33), 1e-6, 1e-3, &[LINE]);
    let sphere = Sphere::new(1e-6, absorbing.index(LINE), 1.33, LINE);
    assert!((model.coefficient(LINE) / (1.5e3 * sphere.scattering) - 1.0).abs() < 1e-12);
    assert!((model.absorption(LINE) / (1.5e3 * (sphere.extinction - sphere.scattering)) - 1.0).abs() < 1e-12);
}

fn moments(id: &str) {
    let case = case(id);
    for value in values(&case) {
        let g = number(&value, "g");
        let model = henyey_greenstein(g);
        for (u, name) in [(0.1, "q10"), (0.5, "q50"), (0.9, "q90")] {
            let (found, wanted) = (model.quantile(u), number(&value, name));
            assert!((found - wanted).abs() < 1e-12, "{id} g {g} {name}: {found} {wanted}");
        }
        let draws = 1_000_000;
        let mut rng = Rng::new(3, (1e3 * (g + 1.0)) as u64, 0);
        let legendre = |c: f64| [c, 0.5 * (3.0 * c * c - 1.0), 0.5 * (5.0 * c * c * c - 3.0 * c)];
        let (mut sums, mut squares) = ([0.0; 3], [0.0; 3]);
        for _ in 0..draws {
            let p = legendre(model.draw(LINE, &mut rng));
            (0..3).for_each(|k| sums[k] += p[k]);
            (0..3).for_each(|k| squares[k] += p[k] * p[k]);
        }
        for (k, name) in ["mean_cos", "P2", "P3"].into_iter().enumerate() {
            let mean = sums[k] / f64::from(draws);
            let error = ((squares[k] / f64::from(draws) - mean * mean) / f64::from(draws)).sqrt();
            let wanted = number(&value, name);
            assert!((mean - wanted).abs() < 4.0 * error, "{id} g {g} {name}: {mean} +- {error}, {wanted}");
        }
    }
}

#[test]
fn sca_10_henyey_greenstein_moments_and_quantiles() {
    moments("SCA-10");
    moments("SCA-10x");
}

#[test]
fn sca_11_mie_efficiencies() {
    for value in values(&case("SCA-11")) {
        let get = |name: &str| number(&value, name);
        let sphere = Sphere::new(1e-6 * get("D_um"), Complex64::new(get("n"), get("k")), 1.0, 1e-6 * get("lambda_um"));
        let found = [sphere.x, sphere.extinction, sphere.scattering, sphere.backscattering(), sphere.asymmetry];
        for (found, name) in found.into_iter().zip(["x", "Qext", "Qsca", "Qback", "g"]) {
            let wanted = get(name);
            assert!((found / wanted - 1.0).abs() < 1e-5, "SCA-11 {name}: {found} {wanted}");
        }
    }
}

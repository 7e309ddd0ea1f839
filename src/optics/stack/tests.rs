//! A stack's algebra: what no film changes, what a thick one hides, both sides.

use super::*;
use crate::optics::fresnel;

const GREEN: f64 = 550e-9;

fn real(n: f64) -> Complex64 {
    Complex64::new(n, 0.0)
}

fn film(n: f64, k: f64, thickness: f64) -> Layer {
    Layer { index: Complex64::new(n, k), thickness }
}

fn at(n1: f64, n2: Complex64, cos1: f64, layers: &[Layer]) -> Split {
    split(&Around { n1, n2, cos1 }, GREEN, layers.iter().copied())
}

fn off(a: &Split, b: &Split) -> f64 {
    let pairs = [(a.reflected, b.reflected), (a.transmitted, b.transmitted)];
    pairs.iter().map(|(a, b)| (a.s - b.s).norm().max((a.p - b.p).norm())).fold(0.0, f64::max)
}

/// R and T of s and p.
fn powers(split: &Split) -> [f64; 4] {
    let (r, t) = (split.reflected, split.transmitted);
    [r.s, r.p, t.s, t.p].map(|a| a.norm_sqr())
}

const COSINES: [f64; 8] = [1.0, 0.9, 0.75, 0.745, 0.5, 0.1, 1e-6, 1e-100];

#[test]
fn no_layer_is_the_bare_interface() {
    let beyond = [real(1.0), real(1.5), real(2.4), Complex64::new(1.15, 6.69), Complex64::new(1.5, 1e-7)];
    for (n1, n2, cos1) in combined([1.0, 1.5168], beyond) {
        let bare = fresnel::interface(real(n1), n2, cos1);
        assert!(off(&at(n1, n2, cos1, &[]), &bare) <= 1e-15, "{n1} {n2} {cos1}");
        let nothing = [film(2.0, 0.0, 0.0), film(0.1, 4.0, 0.0)];
        assert!(off(&at(n1, n2, cos1, &nothing), &bare) <= 1e-15, "{n1} {n2} {cos1} with layers of no thickness");
    }
}

fn combined(n1: [f64; 2], n2: [Complex64; 5]) -> impl Iterator<Item = (f64, Complex64, f64)> {
    n1.into_iter().flat_map(move |n1| n2.into_iter().flat_map(move |n2| COSINES.map(|cos1| (n1, n2, cos1))))
}

#[test]
fn a_millimetre_of_metal_is_an_opaque_metal() {
    let silver = Complex64::new(0.06, 3.597);
    for cos1 in COSINES {
        let thick = at(1.0, real(1.5168), cos1, &[Layer { index: silver, thickness: 1e-3 }]);
        let metal = fresnel::interface(real(1.0), silver, cos1);
        assert!((thick.reflected.s - metal.reflected.s).norm() < 1e-14, "{cos1}");
        assert!((thick.reflected.p - metal.reflected.p).norm() < 1e-14, "{cos1}");
        assert_eq!(thick.transmitted, Amplitudes::ZERO);
    }
}

#[test]
fn a_gap_of_a_hundred_micrometres_reflects_totally() {
    let beyond_the_critical_angle = 45f64.to_radians().cos();
    let gap = at(1.5168, real(1.5168), beyond_the_critical_angle, &[film(1.0, 0.0, 100e-6)]);
    let total = fresnel::interface(real(1.5168), real(1.0), beyond_the_critical_angle);
    assert!((gap.reflected.s - total.reflected.s).norm() < 1e-14);
    assert!((gap.reflected.p - total.reflected.p).norm() < 1e-14);
    assert!(gap.transmitted.unpolarised() < 1e-100);
}

#[test]
fn at_the_critical_angle_of_a_layer_the_limit_is_met() {
    // n1 sin1 = 1 exactly: m = 0 in the gap.
    let n1 = 1.5f64;
    let cos1 = (1.0 - 1.0 / (n1 * n1)).sqrt();
    let gap = [film(1.0, 0.0, 300e-9)];
    let [below, there, above] = [cos1 + 1e-9, cos1, cos1 - 1e-9].map(|c| powers(&at(n1, real(n1), c, &gap)));
    for i in 0..4 {
        assert!((there[i] - below[i]).abs() < 1e-7 && (there[i] - above[i]).abs() < 1e-7, "{below:?} {there:?}");
    }
}

#[test]
fn ten_thousand_layers_do_not_overflow() {
    let pair = [film(2.35, 0.0, GREEN / 4.0 / 2.35), film(1.46, 0.0, GREEN / 4.0 / 1.46)];
    let mirror: Vec<Layer> = pair.into_iter().cycle().take(10_000).collect();
    let [rs, rp, ts, tp] = powers(&at(1.0, real(1.5), 0.8, &mirror));
    assert!((rs - 1.0).abs() < 1e-12 && (rp - 1.0).abs() < 1e-12 && ts < 1e-100 && tp < 1e-100);
}

#[test]
fn a_half_wave_layer_is_absent() {
    let absent = at(1.0, real(1.5168), 1.0, &[film(2.1, 0.0, GREEN / 2.0 / 2.1)]);
    let bare = fresnel::interface(real(1.0), real(1.5168), 1.0);
    for (a, b) in powers(&absent).into_iter().zip(powers(&bare)) {
        assert!((a - b).abs() < 1e-15);
    }
}

#[test]
fn a_quarter_wave_of_the_root_of_the_index_does_not_reflect() {
    let n = 1.5168f64;
    let film = film(n.sqrt(), 0.0, GREEN / 4.0 / n.sqrt());
    let [rs, rp, ts, tp] = powers(&at(1.0, real(n), 1.0, &[film]));
    assert!(rs < 1e-31 && rp < 1e-31 && (ts - 1.0).abs() < 1e-15 && (tp - 1.0).abs() < 1e-15);
}

#[test]
fn a_table_is_the_stack_within_its_bound() {
    let pair = [film(2.35, 0.0, GREEN / 4.0 / 2.35), film(1.46, 0.0, GREEN / 4.0 / 1.46)];
    let mirror: Vec<Layer> = pair.into_iter().cycle().take(41).collect();
    let silver = vec![film(0.06, 3.597, 30e-9)];
    let both = [mirror.clone(), silver.clone()].concat();
    let gap = vec![film(1.38, 0.0, 1e-6), film(1.0, 0.0, 1e-6)];
    for layers in [mirror, silver, both, gap] {
        let table = Table::new(&layers, GREEN, 2.0).expect("a table");
        let mut worst: f64 = 0.0;
        for (n1, n2) in [(1.0, 1.5168), (1.5168, 1.0), (1.9, 1.9), (1.5168, 1.62), (1.85, 1.0)] {
            for step in 0..=20_000 {
                let cos1 = (f64::from(step) / 20_000.0).max(f64::MIN_POSITIVE);
                let around = Around { n1, n2: real(n2), cos1 };
                let [direct, looked] = [
                    powers(&split(&around, GREEN, layers.iter().copied())),
                    powers(&table.split(&around).expect("within the table")),
                ];
                worst = direct.iter().zip(looked).fold(worst, |worst, (a, b)| worst.max((a - b).abs()));
            }
        }
        assert!(worst < 1e-9, "{worst:e}");
    }
}

/// Any wavelength of the band and any angle, from and into any medium: within the bound, and of a stack turned round too.
#[test]
fn a_table_over_a_band_is_the_stack() {
    let thick = |i: i32| 1e-9 * f64::from(40 + 13 * i % 70);
    // Dispersion as of a glass, and as of a table with a row at 520 nm.
    let glass = |n: f64, wavelength: f64| n + 5e-15 / (wavelength * wavelength);
    let kinked = |n: f64, wavelength: f64| n - 2e5 * (wavelength - 520e-9).max(0.0);
    let clear = |i: i32, w: f64| film(glass(if i % 2 == 0 { 2.2 } else { 1.45 }, w), 0.0, thick(i));
    let tabled = |i: i32, w: f64| film(kinked(if i % 2 == 0 { 2.2 } else { 1.45 }, w), 0.0, thick(i));
    let lossy = |i: i32, w: f64| {
        if i == 3 { film(glass(0.2, w), 3.1, 2e-8) } else { film(glass(1.5, w), 1e-3 * f64::from(i), 2e-8) }
    };
    type Recipe<'a> = &'a (dyn Fn(i32, f64) -> Layer + Sync);
    let stacks: [(i32, Recipe); 4] = [(40, &clear), (12, &tabled), (5, &lossy), (1, &clear)];
    for (count, layer) in stacks {
        let layers = |wavelength: f64| (0..count).map(|i| layer(i, wavelength)).collect::<Vec<_>>();
        let seen = Seen { layers: &layers, highest: &|_| 1.62, beyond: &|_| None };
        let band = Band::new(&seen, [450e-9, 650e-9]).expect("a table");
        let mut rng = crate::math::Rng::new(3, 0, 0);
        let (mut known, mut most) = (0, 0.0f64);
        for _ in 0..4000 {
            let wavelength = 450e-9 + 200e-9 * rng.uniform();
            let [n1, n2] = [rng.uniform(), rng.uniform()].map(|u| [1.0, 1.33, 1.62][(3.0 * u) as usize]);
            let around = Around { n1, n2: real(n2), cos1: rng.positive() };
            let mut films = layers(wavelength);
            let end = if rng.uniform() < 0.5 { End::Last } else { End::First };
            if end == End::Last {
                films.reverse();
            }
            let Some(found) = band.split(&around, wavelength, end) else { continue };
            let wanted = split(&around, wavelength, films.into_iter());
            known += 1;
            most = most.max(powers(&found).iter().zip(powers(&wanted)).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max));
        }
        let least = if count == 12 { 3000 } else { 3750 };
        assert!(known > least && most < 1e-6, "{count} layers: {known} of 4000 known, off by {most:e}");
    }
}

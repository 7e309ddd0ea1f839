//! The flux that a spectrum scatters above the horizon, with the cosine that Rayleigh-Rice puts on it.
//!
//!     G(k, u) = integral over |v| < 1 of PSD(k |v - u|) sqrt(1 - v^2) d^2 v   [m^4]
//!
//! u = |beta_0|, v = beta_s direction cosines, k = n_s / lambda, 1/m. In polar coordinates (x, phi) about u:
//!
//!     G = integral_0^(1+u) x PSD(k x) A(x, u) dx,    A = integral sqrt(a - b cos(phi)) dphi over the arc within the disc
//!     a = 1 - u^2 - x^2,  b = 2 u x;   x < 1 - u:  A = 4 sqrt(a + b) E(m),  1 - m = (a - b) / (a + b)
//!                                      beyond:     A = 4 sqrt(2 b) (E(m) - (1 - m) K(m)),  1 - m = (b - a) / (2 b)
//!
//! Tabulated in ln k, one row where it is first needed, and in zeta = asinh((u - 1) / w), w the lobe's width: the horizon eats a lobe
//! within about its own width. Cubics through 4 x 4 entries; relative error below 1e-5, with the
//! kinks of a table 5e-4 (measured beside this code).

use crate::bsdf::radial::Profile;
use crate::math::elliptic;
use crate::math::quadrature::GaussLegendre;
use crate::math::table::cubic;
use std::f64::consts::PI;
use std::sync::OnceLock;

/// Step of zeta.
const STEP: f64 = 0.04;
/// First row and step in ln k: from 1 / 1 mm on.
const FIRST: f64 = 6.9;
const ROW: f64 = 0.05;
/// Rows up to index 4.2 at 10 nm.
const ROWS: usize = 263;

/// G over k and u.
#[derive(Clone, Debug)]
pub struct Flux {
    rows: Vec<OnceLock<Row>>,
}

/// ln G over zeta at one k.
#[derive(Clone, Debug)]
struct Row {
    width: f64,
    start: f64,
    values: Vec<f64>,
}

impl Flux {
    pub fn new() -> Flux {
        Flux { rows: vec![OnceLock::new(); ROWS] }
    }

    /// G at `k` = n_s / lambda (1/m) and `u` = |beta_0|, m^4.
    pub fn at(&self, psd: &impl Profile, k: f64, u: f64) -> f64 {
        let place = (k.ln() - FIRST) / ROW;
        if !(0.0..=(ROWS - 1) as f64).contains(&place) {
            return integrate(psd, &GaussLegendre::new(16), k, u);
        }
        let (first, weights) = cubic(place, ROWS);
        let row = |j: usize| {
            let index = first + j;
            let row = self.rows[index].get_or_init(|| Row::new(psd, (FIRST + ROW * index as f64).exp()));
            weights[j] * row.at(u)
        };
        (0..4).map(row).sum::<f64>().exp()
    }
}

impl Row {
    fn new(psd: &impl Profile, k: f64) -> Row {
        let width = (psd.width() / k).clamp(1e-6, 0.2);
        let rule = GaussLegendre::new(16);
        // One column more than needed at either end centres the cubics: G is even in u, and goes on beyond the horizon.
        let start = (-1.0 / width).asinh() - STEP;
        let count = (-start / STEP) as usize + 4;
        let u = |column: usize| 1.0 + width * (start + STEP * column as f64).sinh();
        let values = (0..count).map(|column| integrate(psd, &rule, k, u(column).abs()).ln()).collect();
        Row { width, start, values }
    }

    fn at(&self, u: f64) -> f64 {
        let zeta = ((u - 1.0) / self.width).asinh();
        let (first, weights) = cubic((zeta - self.start) / STEP, self.values.len());
        self.values[first..first + 4].iter().zip(weights).map(|(v, w)| v * w).sum()
    }
}

/// G by quadrature in ln x, on both sides of x = |1 - u|. The integrand has a weak singularity there and a root at the end:
/// ln x = mid - half cos(t) makes them smooth.
fn integrate(psd: &impl Profile, rule: &GaussLegendre, k: f64, u: f64) -> f64 {
    let gap = (1.0 - u).abs().max(1e-12);
    let ring = |x: f64| x * x * psd.value(k * x) * arc(x, u);
    let piece = |from: f64, to: f64| {
        let (mid, half) = (0.5 * (from + to), 0.5 * (to - from));
        let panels = (half * psd.steepness()).ceil().max(2.0);
        let width = PI / panels;
        let panel = |j: usize| {
            rule.integrate(width * j as f64, width * (j + 1) as f64, |t| {
                ring((mid - half * t.cos()).exp()) * half * t.sin()
            })
        };
        (0..panels as usize).map(panel).sum::<f64>()
    };
    let outer = if u > 1e-12 { piece(gap.ln(), (1.0 + u).ln()) } else { 0.0 };
    if u >= 1.0 {
        return outer;
    }
    // Within a thousandth of all that changes, PSD f df is taken at once.
    let least = 1e-3 * gap.min(psd.width() / k);
    outer + piece(least.ln(), gap.ln()) + psd.integral(k * least) / (k * k) * arc(0.0, u)
}

/// A(x, u), rad.
fn arc(x: f64, u: f64) -> f64 {
    // a + b and a - b without cancellation.
    let (sum, difference) = ((1.0 - x + u) * (1.0 + x - u), (1.0 - x - u) * (1.0 + x + u));
    if sum <= 0.0 {
        return 0.0;
    }
    if difference > 0.0 {
        return 4.0 * sum.sqrt() * elliptic::complete(difference / sum)[1];
    }
    let b2 = sum - difference; // 2 b
    let m1 = (-difference / b2).max(f64::MIN_POSITIVE);
    let [first, second] = elliptic::complete(m1);
    4.0 * b2.sqrt() * (second - m1 * first)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bsdf::polish::{KCorrelation, PsdTable};

    /// Plain quadrature over the disc in its own polar coordinates.
    fn brute(psd: &impl Profile, k: f64, u: f64) -> f64 {
        let (r, phi) = (GaussLegendre::new(200), GaussLegendre::new(300));
        r.integrate(0.0, PI / 2.0, |t| {
            let v = t.sin();
            let ring = |p: f64| psd.value(k * (v * v + u * u - 2.0 * u * v * p.cos()).max(0.0).sqrt());
            2.0 * v * t.cos().powi(2) * phi.integrate(0.0, PI, ring)
        })
    }

    #[test]
    fn the_polar_form_is_the_integral_over_the_disc() {
        let (psd, rule) = (KCorrelation::new(1e-9, [0.0, f64::INFINITY], 2e-6, 2.5), GaussLegendre::new(16));
        for (k, u) in [(1e6, 0.0), (1e6, 0.4), (1e6, 0.9), (1e6, 0.999), (2e5, 0.7), (2e5, 1.0)] {
            let (a, b) = (integrate(&psd, &rule, k, u), brute(&psd, k, u));
            assert!((a / b - 1.0).abs() < 1e-6, "{k} {u}: {a} {b}");
        }
    }

    fn tabulated(psd: &impl Profile, tolerance: f64) {
        let (flux, rule) = (Flux::new(), GaussLegendre::new(48));
        for k in [1.58e6, 1.9e6, 1.234e5] {
            for step in 0..60 {
                let u = 1.0 - (-0.25 * f64::from(step)).exp();
                let (a, direct) = (flux.at(psd, k, u), integrate(psd, &rule, k, u));
                assert!((a / direct - 1.0).abs() < tolerance, "{psd:?} {k} {u}: {a} {direct}");
            }
        }
    }

    #[test]
    fn the_table_is_the_integral() {
        for (b, s) in [(5e-6, 3.0), (50e-6, 4.0), (1e-3, 1.5), (1e-7, 2.0)] {
            tabulated(&KCorrelation::new(1e-9, [0.0, 2e6], b, s), 1e-5);
        }
        tabulated(&PsdTable::new(&[(1e3, 1e-24), (1e5, 1e-26), (1e6, 1e-29), (2e6, 2e-30)]), 5e-4);
    }
}

//! TIS of a radial lobe over incidence and index.
//!
//! With rho = |q0| = n_i sin(theta_i) and n = n_s, in polar coordinates about the specular direction:
//!
//!     TIS / a = 2 pi I(n - rho) + integral_{|n - rho|}^{n + rho} S(x) x alpha(x) dx
//!     alpha = 2 arccos((x^2 - (n - rho)(n + rho)) / (2 x rho))     rad, the part of the circle x within the disc n
//!
//! It is tabulated in ln n and in zeta = asinh((rho/n - 1) / c), c about the width of the lobe: the horizon eats a lobe
//! within about its own width and by the logarithm of the distance outside it, so its logarithm is smooth in zeta. Local
//! cubics through 4 x 4 entries; relative error below 1e-5 (or 3e-7 of the lobe's flux, far outside it; measured beside this code).

use super::{Profile, Side};
use crate::math::quadrature::GaussLegendre;
use crate::math::table::cubic;
use std::f64::consts::TAU;

/// Step of zeta.
const STEP: f64 = 0.04;
/// Rows in ln n from 1 to 4.2 (germanium 4.0).
const ROWS: usize = 25;
const HIGHEST: f64 = 4.2;

/// TIS / a, sr, for 1 <= n <= 4.2; other indices are integrated on the spot.
#[derive(Clone, Debug)]
pub struct Tis {
    width: f64,
    /// zeta of the first column.
    start: f64,
    columns: usize,
    /// ln(TIS / a): [row of ln n][column of zeta].
    table: Vec<f64>,
}

impl Tis {
    pub fn new(profile: &impl Profile, side: Side) -> Tis {
        let width = profile.width().clamp(1e-6, 0.2);
        let highest = if side == Side::Reflect { 1.0 } else { HIGHEST };
        // Two columns more than needed at both ends centre every cubic; TIS is even in rho, so rho < 0 is no harm.
        let start = (-1.0 / width).asinh() - 2.0 * STEP;
        let columns = (((highest - 1.0) / width).asinh() - start) / STEP;
        let mut tis = Tis { width, start, columns: columns as usize + 4, table: Vec::new() };
        let rule = GaussLegendre::new(16);
        for row in 0..ROWS {
            let n = (row_step() * row as f64).exp();
            for column in 0..tis.columns {
                let zeta = tis.start + STEP * column as f64;
                let rho = n * (1.0 + width * zeta.sinh());
                // Far outside a steep lobe nothing is left, not even for the logarithm.
                tis.table.push(integrate(profile, &rule, rho.abs(), n).max(f64::MIN_POSITIVE).ln());
            }
        }
        tis
    }

    /// TIS / a, sr, at transverse index `rho` = n_i sin(theta_i) and scattering into index `n`.
    pub fn at(&self, profile: &impl Profile, rho: f64, n: f64) -> f64 {
        let column = (asinh((rho / n - 1.0) / self.width) - self.start) / STEP;
        let row = if n == 1.0 { 0.0 } else { n.ln() / row_step() };
        let inside = column >= 1.0 && column < (self.columns - 2) as f64;
        if !(inside && row >= 0.0 && row <= (ROWS - 1) as f64) {
            return integrate(profile, &GaussLegendre::new(16), rho, n);
        }
        let (j, weights) = cubic(column, self.columns);
        let along = |row: usize| -> f64 {
            let from = row * self.columns + j;
            self.table[from..from + 4].iter().zip(weights).map(|(t, w)| t * w).sum()
        };
        if row == 0.0 {
            return along(0).exp(); // scattering into air: the common case
        }
        let (i, weights) = cubic(row, ROWS);
        (0..4).map(|k| weights[k] * along(i + k)).sum::<f64>().exp()
    }
}

/// asinh(`x`) to 1e-16 of 1, which a place in a table may be off by; three times faster than to 1e-16 of itself.
fn asinh(x: f64) -> f64 {
    (x.abs() + (x * x + 1.0).sqrt()).ln().copysign(x)
}

fn row_step() -> f64 {
    HIGHEST.ln() / (ROWS - 1) as f64
}

/// TIS / a by quadrature in ln x. The arc alpha ends in square roots at both limits: u = mid - half cos(t) makes them smooth.
fn integrate(profile: &impl Profile, rule: &GaussLegendre, rho: f64, n: f64) -> f64 {
    let inner = if rho < n { TAU * profile.integral(n - rho) } else { 0.0 };
    if rho < 1e-12 * n {
        return inner;
    }
    // A gap below 1e-12 n holds no flux: S x dx there is at most (1e-12)^2 / B.
    let (from, to) = ((n - rho).abs().max(1e-12 * n).ln(), (n + rho).ln());
    let (mid, half) = (0.5 * (from + to), 0.5 * (to - from));
    let arc = |x: f64| 2.0 * ((x * x - (n - rho) * (n + rho)) / (2.0 * x * rho)).clamp(-1.0, 1.0).acos();
    // Panels no longer than the distance of the poles of S from the real axis of ln x.
    let panels = (half * profile.steepness().max(1.0)).ceil().max(1.0);
    let width = std::f64::consts::PI / panels;
    let panel = |j: usize| {
        rule.integrate(width * j as f64, width * (j + 1) as f64, |t| {
            let x = (mid - half * t.cos()).exp();
            x * x * profile.value(x) * arc(x) * half * t.sin()
        })
    };
    inner + (0..panels as usize).map(panel).sum::<f64>()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bsdf::abg::Law;
    use crate::bsdf::gaussian::Law as Gauss;
    use crate::bsdf::harvey::Law as Shack;

    /// Plain quadrature over the disc in its own polar coordinates, for lobes wide enough for it.
    fn brute(radial: &impl Profile, rho: f64, n: f64) -> f64 {
        let (r, phi) = (GaussLegendre::new(200), GaussLegendre::new(400));
        r.integrate(0.0, n, |q| {
            let ring = |p: f64| radial.value((q * q + rho * rho - 2.0 * q * rho * p.cos()).max(0.0).sqrt());
            2.0 * q * phi.integrate(0.0, std::f64::consts::PI, ring)
        })
    }

    fn polar(profile: &impl Profile) {
        let rule = GaussLegendre::new(16);
        for (rho, n) in [(0.0, 1.0), (0.5, 1.0), (0.98, 1.0), (1.0, 1.0), (0.7, 1.5), (1.4, 1.0), (2.9, 1.6)] {
            let (a, b) = (integrate(profile, &rule, rho, n), brute(profile, rho, n));
            // What is left of a Gaussian far outside is of no account.
            assert!((a / b - 1.0).abs() < 2e-6 || b < 1e-9, "{profile:?} {rho} {n}: {a} {b}");
        }
    }

    #[test]
    fn the_polar_form_is_the_integral_over_the_disc() {
        [(0.02, 1.5), (0.1, 2.0), (0.5, 3.0)].into_iter().for_each(|(b, g)| polar(&Law::new(b, g)));
        [(0.2, -1.5), (0.5, -4.0), (0.3, -2.0)].into_iter().for_each(|(l, s)| polar(&Shack { l, s }));
        [0.2, 0.5, 2.0].into_iter().for_each(|sigma| polar(&Gauss { sigma }));
    }

    fn tabulated(profile: &impl Profile) {
        let rule = GaussLegendre::new(48);
        for side in [Side::Reflect, Side::Transmit] {
            let tis = Tis::new(profile, side);
            for k in 0..400 {
                // Angles crowd towards the horizon; indices of glass, and air.
                let sine = 1.0 - (-0.05 * k as f64).exp();
                let n = if k % 3 == 0 { 1.0 } else { 1.0 + 0.0041 * k as f64 };
                let rho = if side == Side::Reflect || k % 2 == 0 { n * sine } else { n * (2.0 - sine) };
                let (a, direct) = (tis.at(profile, rho, n), integrate(profile, &rule, rho, n));
                let allowed = 1e-5 * direct + 3e-7 * TAU * profile.integral(n);
                assert!((a - direct).abs() < allowed, "{profile:?} rho {rho} n {n}: {a} {direct}");
            }
        }
    }

    #[test]
    fn the_table_is_the_integral_to_a_hundred_thousandth() {
        for (b, g) in [(1e-9, 2.0), (1e-3, 1.8), (1e-4, 3.0), (0.02, 1.0), (3.0, 2.0), (1e-6, 0.5), (1e-12, 2.2)] {
            tabulated(&Law::new(b, g));
        }
        [(1e-6, -2.0), (0.01, -1.5), (0.002, -2.6), (1.0, -6.0)]
            .into_iter()
            .for_each(|(l, s)| tabulated(&Shack { l, s }));
        [1e-3, 0.1, 0.3, 0.5].into_iter().for_each(|sigma| tabulated(&Gauss { sigma }));
    }
}

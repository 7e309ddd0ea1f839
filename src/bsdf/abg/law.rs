//! The radial law S(x) = 1 / (B + x^g) of an ABg lobe: value, integral over the plane, draws.

use crate::bsdf::radial::Profile;
use crate::math::Rng;
use crate::math::quadrature::GaussLegendre;

/// Largest x of the table: both media of index 8.
const FARTHEST: f64 = 16.0;

/// S(x) with its integral I(x) = integral_0^x S x' dx', tabulated in ln x.
#[derive(Clone, Debug)]
pub struct Law {
    b: f64,
    g: f64,
    /// ln of the knee B^(1/g), where x^g = B; -inf for g = 0.
    ln_knee: f64,
    /// ln x of the first entry, and the step.
    start: f64,
    step: f64,
    /// I and d I / d(ln x) times the step, at every entry.
    integral: Vec<f64>,
    rise: Vec<f64>,
}

impl Law {
    pub fn new(b: f64, g: f64) -> Law {
        let ln_knee = b.ln() / g;
        // Below a hundred-thousandth of the knee (and 1e-12) I = x^2 / 2B to better than 1e-10 of the whole.
        let start = (if g > 0.0 { ln_knee } else { 0.0 } + 1e-5f64.ln()).clamp(1e-12f64.ln(), -1.0);
        // Hermite error step^4/384 of the fourth derivative, which grows as g^3: below 1e-9.
        let count = ((FARTHEST.ln() - start) / (0.02f64).min(0.06 / g.max(1e-9))).ceil();
        let step = (FARTHEST.ln() - start) / count;
        let mut law = Law { b, g, ln_knee, start, step, integral: Vec::new(), rise: Vec::new() };
        law.integral = law.tabulate(count as usize);
        let rise = |j: usize| law.slope((start + j as f64 * step).exp()) * step;
        law.rise = (0..law.integral.len()).map(rise).collect();
        law
    }

    fn tabulate(&self, count: usize) -> Vec<f64> {
        let rule = GaussLegendre::new(6);
        let mut sum = (2.0 * self.start).exp() * self.value(self.start.exp()) * 0.5;
        let mut table = vec![sum];
        for j in 0..count {
            let from = self.start + j as f64 * self.step;
            sum += rule.integrate(from, from + self.step, |u| self.slope(u.exp()));
            table.push(sum);
        }
        table
    }

    /// x^g without the general power where g is a common whole number.
    fn power(&self, x: f64) -> f64 {
        if self.g == 2.0 {
            x * x
        } else if self.g == 1.0 {
            x
        } else {
            x.powf(self.g)
        }
    }

    /// d I / d ln x = x^2 S.
    fn slope(&self, x: f64) -> f64 {
        x * x * self.value(x)
    }

    /// I(x) past the table, for indices nobody has: exact but slow.
    fn beyond(&self, x: f64) -> f64 {
        let rule = GaussLegendre::new(32);
        self.integral[self.integral.len() - 1] + rule.integrate(FARTHEST.ln(), x.ln(), |u| self.slope(u.exp()))
    }

    /// I at the way `t` (0..1) through the interval `j` of the table, and its derivative: cubic Hermite with the exact slopes.
    fn between(&self, j: usize, t: f64) -> [f64; 2] {
        let (p0, m0, m1) = (self.integral[j], self.rise[j], self.rise[j + 1]);
        let height = self.integral[j + 1] - p0;
        // p0 + m0 t + c t^2 + d t^3, with the value and the slope of the far end.
        let (c, d) = (3.0 * height - 2.0 * m0 - m1, m0 + m1 - 2.0 * height);
        [p0 + t * (m0 + t * (c + t * d)), m0 + t * (2.0 * c + 3.0 * t * d)]
    }

    /// x where I is `wanted`, below I(16).
    fn inverse(&self, wanted: f64) -> f64 {
        let Some(j) = self.integral.partition_point(|i| *i <= wanted).checked_sub(1) else {
            // S is constant before the table.
            return self.start.exp() * (wanted / self.integral[0]).sqrt();
        };
        // I goes at most as the square of x, so that it is straight to 2 % in a step: Newton's method squares that twice.
        let mut t = (wanted - self.integral[j]) / (self.integral[j + 1] - self.integral[j]);
        for _ in 0..2 {
            let [value, slope] = self.between(j, t);
            t = (t - (value - wanted) / slope).clamp(0.0, 1.0);
        }
        (self.start + (j as f64 + t) * self.step).exp()
    }

    /// The same beyond the table, below I(`reach`): by bisection.
    fn inverse_beyond(&self, wanted: f64, reach: f64) -> f64 {
        let (mut low, mut high) = (FARTHEST, reach);
        for _ in 0..50 {
            let middle = 0.5 * (low + high);
            if self.integral(middle) < wanted { low = middle } else { high = middle }
        }
        high
    }
}

impl Profile for Law {
    /// 1 / (B + x^g), x >= 0.
    fn value(&self, x: f64) -> f64 {
        1.0 / (self.b + self.power(x))
    }

    /// I(x), relative error below 1e-8; cubic Hermite in ln x with the exact slope.
    fn integral(&self, x: f64) -> f64 {
        let at = (x.ln() - self.start) / self.step;
        if at <= 0.0 || x <= 0.0 {
            return 0.5 * self.slope(x.max(0.0));
        }
        let last = self.integral.len() - 2;
        if at >= (last + 1) as f64 {
            return self.beyond(x);
        }
        let j = (at as usize).min(last);
        self.between(j, at - j as f64)[0]
    }

    /// Draws x in [0, `reach`) with density S x / I(reach), by inversion of the table: one number.
    fn draw(&self, reach: f64, rng: &mut Rng) -> f64 {
        let wanted = rng.uniform() * self.integral(reach);
        let within = wanted < self.integral[self.integral.len() - 1];
        if within { self.inverse(wanted).min(reach) } else { self.inverse_beyond(wanted, reach) }
    }

    /// Where S falls to half its peak, B^(1/g); 0 for g = 0.
    fn width(&self) -> f64 {
        self.ln_knee.exp()
    }

    /// S has poles pi/g from the real axis of ln x.
    fn steepness(&self) -> f64 {
        self.g
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_integral_of_g_2_is_a_logarithm() {
        for b in [1e-14, 1e-9, 1e-3, 1.0, 50.0] {
            let s = Law::new(b, 2.0);
            for x in [1e-13, 1e-7, 3e-5, 0.01, 0.9, 2.0, 7.9, 20.0] {
                let closed = 0.5 * (x * x / b).ln_1p();
                // 1e-10 of the largest integral, or 1e-8 of itself.
                let tolerance = 1e-8 * closed + 1e-12 * s.integral(2.0);
                assert!((s.integral(x) - closed).abs() < tolerance, "B {b} x {x}: {} {closed}", s.integral(x));
            }
        }
    }

    #[test]
    fn the_integral_of_a_steep_law_is_that_of_a_disc() {
        // g = 40: 1/B inside x < 1, x^-40 outside.
        let s = Law::new(1.0, 40.0);
        assert!((s.integral(0.5) - 0.125).abs() < 1e-9);
    }

    #[test]
    fn draws_follow_the_integral() {
        for (b, g) in [(1e-9, 2.0), (1e-3, 1.8), (1e-4, 3.2), (0.02, 1.0), (1e-7, 0.01), (5.0, 2.0), (1e-3, 0.0)] {
            let s = Law::new(b, g);
            let mut rng = Rng::new(11, 0, 0);
            let n = 100_000;
            let mut cell = [0u32; 10];
            for _ in 0..n {
                let u = s.integral(s.draw(1.7, &mut rng)) / s.integral(1.7);
                cell[((u * 10.0) as usize).min(9)] += 1;
            }
            // Probability integral transform: ten cells of n/10; chi-squared of 9 degrees exceeds 33.7 once in 1e4.
            let chi: f64 = cell.iter().map(|&c| (c as f64 - 1e4).powi(2) / 1e4).sum();
            assert!(chi < 33.7, "B {b} g {g}: {chi} {cell:?}");
        }
    }
}

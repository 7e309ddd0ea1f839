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
    integral: Vec<f64>,
}

impl Law {
    pub fn new(b: f64, g: f64) -> Law {
        let ln_knee = b.ln() / g;
        // Below a hundred-thousandth of the knee (and 1e-12) I = x^2 / 2B to better than 1e-10 of the whole.
        let start = (if g > 0.0 { ln_knee } else { 0.0 } + 1e-5f64.ln()).clamp(1e-12f64.ln(), -1.0);
        // Hermite error step^4/384 of the fourth derivative, which grows as g^3: below 1e-9.
        let count = ((FARTHEST.ln() - start) / (0.02f64).min(0.06 / g.max(1e-9))).ceil();
        let step = (FARTHEST.ln() - start) / count;
        let mut law = Law { b, g, ln_knee, start, step, integral: Vec::new() };
        law.integral = law.tabulate(count as usize);
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

    /// `draw` where the knee lies beyond the reach: uniform on the disc, thinned by S B >= 1/2.
    fn draw_below(&self, reach: f64, rng: &mut Rng) -> f64 {
        loop {
            let x = reach * rng.uniform().sqrt();
            if rng.uniform() < self.b * self.value(x) {
                return x;
            }
        }
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
        let t = at - j as f64;
        let from = (self.start + j as f64 * self.step).exp();
        let (m0, m1) = (self.slope(from) * self.step, self.slope(from * self.step.exp()) * self.step);
        let (p0, p1) = (self.integral[j], self.integral[j + 1]);
        let s = 1.0 - t;
        s * s * ((1.0 + 2.0 * t) * p0 + t * m0) + t * t * ((3.0 - 2.0 * t) * p1 - s * m1)
    }

    /// Draws x in [0, `reach`) with density S x / I(reach).
    ///
    /// Rejection from the envelope min(1/B, x^-g) x, which is invertible and at most twice S x: with t = x / knee, half
    /// the unit square below the knee (t < 1) and t^(1-g) above. L = ln(reach / knee), d = 2 - g:
    ///
    ///     mass above / mass below = 2 (e^(dL) - 1) / d,      t = (1 + v (e^(dL) - 1))^(1/d)
    ///
    /// Takes two numbers per trial, less than two trials on the average.
    fn draw(&self, reach: f64, rng: &mut Rng) -> f64 {
        let span = reach.ln() - self.ln_knee;
        if self.g == 0.0 {
            return reach * rng.uniform().sqrt();
        }
        if span <= 0.0 {
            return self.draw_below(reach, rng);
        }
        let tail = Tail::new(2.0 - self.g, span);
        let below = 1.0 / (1.0 + 2.0 * tail.mass());
        loop {
            let u = rng.uniform();
            let (ln_t, keep) = if u < below {
                let t = (u / below).sqrt();
                (t.ln(), 1.0 / (1.0 + self.power(t)))
            } else {
                let ln_t = tail.invert((u - below) / (1.0 - below));
                (ln_t, 1.0 / (1.0 + (-self.g * ln_t).exp()))
            };
            if rng.uniform() < keep {
                return (self.ln_knee + ln_t).exp();
            }
        }
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

/// The envelope above the knee: density t^(1-g) = t^(d-1) on 1 <= t < e^span.
struct Tail {
    d: f64,
    span: f64,
    /// e^(d span) - 1.
    growth: f64,
}

impl Tail {
    fn new(d: f64, span: f64) -> Tail {
        Tail { d, span, growth: if d == 0.0 { 0.0 } else { (d * span).exp_m1() } }
    }

    /// Integral of t^(d-1) from 1 to e^span.
    fn mass(&self) -> f64 {
        if self.d == 0.0 { self.span } else { self.growth / self.d }
    }

    /// ln t at the fraction `v` of the mass.
    fn invert(&self, v: f64) -> f64 {
        if self.d == 0.0 {
            return v * self.span;
        }
        // e^(d span) may overflow for g near 0: there ln(1 + v e^y) = y + ln v up to 1e-16.
        let y = self.d * self.span;
        if y > 300.0 { (y + v.ln()).max(0.0) / self.d } else { (v * self.growth).ln_1p() / self.d }
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

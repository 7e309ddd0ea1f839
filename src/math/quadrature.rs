//! Gauss-Legendre quadrature.
//!
//!     integral_a^b f dx = (b - a)/2 sum_j w_j f((a + b)/2 + (b - a)/2 x_j)
//!
//! exact for polynomials of degree 2n - 1; for an analytic f the error falls as rho^(-2n), rho the size of the ellipse
//! about [a, b] free of poles. Nodes are the roots of P_n by Newton's method from Tricomi's estimate.
//!
//! Source: Abramowitz & Stegun (1964), 25.4.29-30 and 22.16.6.

/// Nodes and weights on [-1, 1].
#[derive(Clone, Debug)]
pub struct GaussLegendre {
    nodes: Vec<(f64, f64)>,
}

impl GaussLegendre {
    /// The rule of `n` points, n >= 1.
    pub fn new(n: usize) -> GaussLegendre {
        GaussLegendre { nodes: (0..n).map(|j| node(n, j)).collect() }
    }

    /// Integral of `f` from `a` to `b`.
    pub fn integrate(&self, a: f64, b: f64, mut f: impl FnMut(f64) -> f64) -> f64 {
        let (mid, half) = (0.5 * (a + b), 0.5 * (b - a));
        half * self.nodes.iter().map(|&(x, w)| w * f(mid + half * x)).sum::<f64>()
    }
}

/// Root j of P_n and its weight 2 / ((1 - x^2) P_n'(x)^2).
fn node(n: usize, j: usize) -> (f64, f64) {
    let mut x = (std::f64::consts::PI * (j as f64 + 0.75) / (n as f64 + 0.5)).cos();
    let mut slope = 1.0;
    // Quadratic convergence from a start good to O(n^-2): six steps reach the rounding for any n.
    for _ in 0..6 {
        let (value, derivative) = legendre(n, x);
        slope = derivative;
        x -= value / derivative;
    }
    (x, 2.0 / ((1.0 - x * x) * slope * slope))
}

/// P_n(x) and P_n'(x) by the three-term recurrence.
fn legendre(n: usize, x: f64) -> (f64, f64) {
    let (mut before, mut here) = (1.0, x);
    for k in 2..=n {
        let k = k as f64;
        (before, here) = (here, ((2.0 * k - 1.0) * x * here - (k - 1.0) * before) / k);
    }
    (here, n as f64 * (x * here - before) / (x * x - 1.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn polynomials_of_degree_2n_minus_1_are_exact() {
        for n in [2, 5, 16, 32] {
            let degree = 2 * n - 2;
            let got = GaussLegendre::new(n).integrate(0.0, 1.0, |x| x.powi(degree as i32) + x);
            assert!((got - 1.0 / (degree as f64 + 1.0) - 0.5).abs() < 1e-14, "{n}: {got}");
        }
    }

    #[test]
    fn the_single_point_is_the_midpoint() {
        assert!((GaussLegendre::new(1).integrate(1.0, 3.0, |x| x) - 4.0).abs() < 1e-15);
    }
}

//! Complete elliptic integrals of the first and second kind by the arithmetic-geometric mean.
//!
//!     K(m) = integral_0^(pi/2) (1 - m sin^2 t)^(-1/2) dt,     E(m) = integral_0^(pi/2) (1 - m sin^2 t)^(1/2) dt
//!
//! Source: Abramowitz & Stegun (1964), 17.3.1, 17.3.3 and 17.6.3-4.

use std::f64::consts::FRAC_PI_2;

/// K and E of the parameter m = 1 - `m1`, 0 < m1 <= 1: the complement, which keeps its digits where m is near 1. Relative error
/// below 1e-14.
pub fn complete(m1: f64) -> [f64; 2] {
    let (mut a, mut b, mut power) = (1.0, m1.sqrt(), 0.5);
    let mut sum = 0.5 * (1.0 - m1); // of 2^(n-1) c_n^2
    // The mean converges quadratically, after some steps of halving the logarithm: nine for any m1 a double holds.
    for _ in 0..12 {
        let c = 0.5 * (a - b);
        (a, b) = (0.5 * (a + b), (a * b).sqrt());
        power *= 2.0;
        sum += power * c * c;
        if c <= 1e-9 * a {
            break;
        }
    }
    let first = FRAC_PI_2 / a;
    [first, first * (1.0 - sum)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::quadrature::GaussLegendre;

    #[test]
    fn they_are_their_integrals() {
        let rule = GaussLegendre::new(60);
        for m in [0.0, 0.1, 0.5, 0.9, 0.99] {
            let root = |t: f64| (1.0 - m * t.sin().powi(2)).sqrt();
            let [k, e] = complete(1.0 - m);
            assert!((k - rule.integrate(0.0, FRAC_PI_2, |t| 1.0 / root(t))).abs() < 1e-12, "{m}");
            assert!((e - rule.integrate(0.0, FRAC_PI_2, root)).abs() < 1e-13, "{m}");
        }
    }

    #[test]
    fn near_one_the_first_grows_as_a_logarithm() {
        for m1 in [1e-6, 1e-12, 1e-100] {
            let [k, e] = complete(m1);
            let leading = (4.0 / f64::sqrt(m1)).ln();
            assert!((k / leading - 1.0).abs() < 1e-6 && (e - 1.0).abs() < 1e-4, "{m1}: {k} {e}");
        }
    }
}

//! Means, standard errors and the distributions that judge them.

use statrs::distribution::{ChiSquared, ContinuousCDF, StudentsT};

/// ln of Euler's beta function; 1 - erf; the inverse of erf on (-1, 1).
pub use statrs::function::{
    beta::ln_beta,
    erf::{erf_inv as inverse_erf, erfc},
};

/// Mean and standard error of a mean from `n` independent values with the given sum and `spread`, the sum of their squared
/// deviations from the mean. The error is 0 for n < 2 (nothing is known about it; callers see to n >= 20).
pub fn mean_and_error(sum: f64, spread: f64, n: u64) -> (f64, f64) {
    let count = n as f64;
    let mean = sum / count;
    if n < 2 {
        return (mean, 0.0);
    }
    (mean, (spread / (count - 1.0) / count).sqrt())
}

/// Relative variance of the variance of the mean of independent values, sum d^4 / (sum d^2)^2 - 1 / n with d the deviations from their
/// mean (Pederson, Forster, Booth, Nuclear Science and Engineering 127, 1997); 0 where there is no variance.
pub fn variance_of_variance(values: impl ExactSizeIterator<Item = f64> + Clone) -> f64 {
    let count = values.len() as f64;
    let mean = values.clone().sum::<f64>() / count;
    let power = |exponent: i32| values.clone().map(|value| (value - mean).powi(exponent)).sum::<f64>();
    let squares = power(2);
    if squares > 0.0 { (power(4) / (squares * squares) - 1.0 / count).max(0.0) } else { 0.0 }
}

/// Half-width of the central 95 % interval in units of the standard error for a mean of `n` batches (Student's t, n - 1 degrees).
pub fn student95(n: u64) -> f64 {
    student_quantile(n, 0.975)
}

/// Quantile of Student's t for a mean of `n` batches (n - 1 degrees): below it with probability `confidence`, 0.5..1.
pub fn student_quantile(n: u64, confidence: f64) -> f64 {
    if n < 2 {
        return f64::INFINITY;
    }
    StudentsT::new(0.0, 1.0, (n - 1) as f64).map_or(f64::INFINITY, |t| t.inverse_cdf(confidence))
}

/// Probability that chi-squared with `freedom` degrees exceeds `value`, 0..1.
pub fn chi_squared_tail(value: f64, freedom: f64) -> f64 {
    ChiSquared::new(freedom).map_or(f64::NAN, |d| d.sf(value.max(0.0)))
}

/// Probability that a Kolmogorov-Smirnov distance from uniform as large as that of `values` (each in 0..1) arises by chance:
/// asymptotic series with Stephens' finite-n correction (Numerical Recipes, 3rd ed., sec. 14.3.3).
pub fn uniformity(values: &[f64]) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let n = sorted.len() as f64;
    let distance = sorted
        .iter()
        .enumerate()
        .fold(0.0f64, |d, (i, &v)| d.max((v - i as f64 / n).abs()).max(((i + 1) as f64 / n - v).abs()));
    let z = (n.sqrt() + 0.12 + 0.11 / n.sqrt()) * distance;
    if z < 0.2 {
        return 1.0;
    }
    let series: f64 = (1..=100)
        .map(|k| {
            let sign = if k % 2 == 1 { 2.0 } else { -2.0 };
            sign * (-2.0 * (k * k) as f64 * z * z).exp()
        })
        .sum();
    series.clamp(0.0, 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn students_factor_matches_the_tables() {
        assert!((student95(20) - 2.093).abs() < 1e-3);
        assert!((student95(31) - 2.042).abs() < 1e-3);
        assert!((student_quantile(64, 0.95) - 1.669).abs() < 1e-3 && (student_quantile(11, 0.99) - 2.764).abs() < 1e-3);
    }

    /// A uniform variable has the kurtosis 9/5, a single bright value the most: 1 - 1/n.
    #[test]
    fn variance_of_variance_of_known_samples() {
        let n = 1000;
        let uniform = (0..n).map(|i| f64::from(i) / f64::from(n));
        assert!((variance_of_variance(uniform) * f64::from(n) - 0.8).abs() < 1e-3);
        let one = (0..64).map(|i| (i == 7) as u8 as f64);
        assert!((variance_of_variance(one) - 0.9535).abs() < 1e-3);
        assert_eq!(variance_of_variance([2.0; 5].into_iter()), 0.0);
    }

    #[test]
    fn mean_and_error_of_a_known_sample() {
        let values = [1.0, 2.0, 3.0, 4.0];
        let spread = values.iter().map(|v| (v - 2.5) * (v - 2.5)).sum();
        let (mean, error) = mean_and_error(values.iter().sum(), spread, 4);
        assert!((mean - 2.5).abs() < 1e-15 && (error - (5.0f64 / 3.0 / 4.0).sqrt()).abs() < 1e-15);
    }

    #[test]
    fn chi_squared_and_uniformity_know_their_own() {
        assert!((chi_squared_tail(3.841, 1.0) - 0.05).abs() < 1e-4);
        let even: Vec<f64> = (0..50).map(|i| (i as f64 + 0.5) / 50.0).collect();
        assert!(uniformity(&even) > 0.99);
        let skew: Vec<f64> = even.iter().map(|v| v * 0.5).collect();
        assert!(uniformity(&skew) < 1e-6);
    }
}

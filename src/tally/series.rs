//! Values of batches: means, differences and ratios of what varies together.
//!
//! Batches of the same number are drawn by the same random numbers, so the difference of two of their values is known far better than
//! either of them. Over n batches with values x and y:
//!
//!     D = mean(y) - mean(x)      var D = sum (y - x - D)^2 / (n (n - 1))
//!     R = mean(y) / mean(x)      var R = sum (y - R x)^2 / (n (n - 1)) / mean(x)^2
//!
//! The second by linearisation (Cochran, Sampling Techniques, 3rd ed. 1977, eq. 6.13); its bias is of order R / n times the squared
//! relative spread of x over batches.

use super::results::Estimate;
use crate::math::statistics::mean_and_error;

/// A value per batch.
pub type Series = Vec<f64>;

/// Mean of y - x, in their unit, with its error.
pub fn difference(x: &[f64], y: &[f64]) -> Estimate {
    let apart: Series = x.iter().zip(y).map(|(x, y)| y - x).collect();
    mean(&apart)
}

/// Mean of a series with its error.
pub fn mean(values: &[f64]) -> Estimate {
    let n = values.len() as f64;
    let sum: f64 = values.iter().sum();
    let spread = values.iter().map(|value| (value - sum / n).powi(2)).sum();
    let (mean, error) = mean_and_error(sum, spread, values.len() as u64);
    Estimate { mean, error }
}

/// Share of the largest in the sum; 0 if there is none.
pub fn brightest(values: &[f64]) -> f64 {
    let sum: f64 = values.iter().sum();
    if sum > 0.0 { values.iter().copied().fold(0.0, f64::max) / sum } else { 0.0 }
}

/// mean y / mean x, dimensionless, with its error; `None` if x is zero.
pub fn ratio(x: &[f64], y: &[f64]) -> Option<Estimate> {
    let n = x.len() as f64;
    let [mx, my] = [x, y].map(|series| series.iter().sum::<f64>() / n);
    if mx <= 0.0 {
        return None;
    }
    let ratio = my / mx;
    let spread: f64 = x.iter().zip(y).map(|(x, y)| (y - ratio * x).powi(2)).sum();
    let (_, error) = mean_and_error(my * n, spread, x.len() as u64);
    Some(Estimate { mean: ratio, error: error / mx })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_varies_together_differs_by_little() {
        let x: Series = (0..40).map(|i| 1.0 + f64::from(i * 7 % 40) / 40.0).collect();
        let y: Series = x.iter().map(|x| 0.98 * x).collect();
        let (apart, part) = (difference(&x, &y), ratio(&x, &y).expect("light"));
        assert!((apart.mean + 0.02 * mean(&x).mean).abs() < 1e-14 && apart.error < 0.021 * mean(&x).error);
        assert!((part.mean - 0.98).abs() < 1e-14 && part.error < 1e-14);
        assert_eq!(difference(&x, &x), Estimate::default());
        assert!(ratio(&vec![0.0; 40], &x).is_none());
    }
}

//! The error bars of all cases together: neither too small nor too large.

use crate::support::{Check, full};
use statrs::distribution::{ContinuousCDF, Normal};
use straylight::math::statistics::{chi_squared_tail, uniformity};

/// A correct program fails one run in a thousand on either side.
const CHANCE: f64 = 1e-3;

/// (value - reference) / error over all independent Monte-Carlo numbers of the set is a sample of N(0, 1). Numbers
/// whose model is known to differ from its reference by more than a third of their error say nothing here.
#[test]
#[ignore = "full size; cargo test --release --test verification -- --ignored"]
fn pulls_of_all_cases_are_normal() {
    let cases = [
        crate::adjoint::CASES,
        crate::radiometry::CASES,
        crate::cavities::CASES,
        crate::stray::CASES,
        crate::slabs::CASES,
        crate::volumes::CASES,
    ]
    .concat();
    let checks: Vec<Check> = cases.into_iter().flat_map(|(name, case)| full(name, case)).collect();
    let random = checks.iter().filter(|c| c.independent && c.error > 1e-9 * c.value.abs());
    let pulls: Vec<f64> = random.filter(|c| c.sys < 0.33 * c.error).map(Check::pull).collect();
    let squares: f64 = pulls.iter().map(|pull| pull * pull).sum();
    let (count, mean) = (pulls.len() as f64, pulls.iter().sum::<f64>() / pulls.len() as f64);
    let normal = Normal::standard();
    let shape = uniformity(&pulls.iter().map(|&pull| normal.cdf(pull)).collect::<Vec<_>>());
    let tail = chi_squared_tail(squares, count);
    println!("{count} pulls: mean {mean:+.3}, chi-squared {squares:.1}, tail {tail:.4}, Kolmogorov-Smirnov {shape:.4}");
    assert!(count >= 100.0, "only {count} pulls");
    assert!((CHANCE..=1.0 - CHANCE).contains(&tail), "chi-squared {squares:.1} of {count} pulls: tail {tail:e}");
    assert!(mean.abs() * count.sqrt() < 3.3, "the mean of {count} pulls is {mean:+.3}");
    assert!(shape > CHANCE, "the pulls are not normal: {shape:e}");
}

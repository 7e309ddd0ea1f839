//! Whether what is required of a run holds.

use crate::math::statistics::student_quantile;
use crate::scene::Scene;
use crate::system::compile::Requirement;
use crate::system::document::Limit;
use crate::tally::required::{Required, Verdict};
use crate::tally::results::{DetectorResult, Estimate, RequirementResult, Results};

/// Share of the stray light in one batch above which an error is a guess, and a verdict with it.
const BRIGHTEST: f64 = 0.25;

/// The verdicts, in the order of the system file.
pub fn judge(requirements: &[Requirement], scene: &Scene, results: &Results) -> Vec<RequirementResult> {
    requirements.iter().filter_map(|requirement| verdict(requirement, scene, results)).collect()
}

fn verdict(requirement: &Requirement, scene: &Scene, results: &Results) -> Option<RequirementResult> {
    let watched = &scene.detectors[requirement.detector];
    let found = results.detectors.get(&watched.label)?;
    let grid = &watched.grid;
    let area: f64 = (0..grid.shape().iter().product()).map(|bin| grid.extent(bin)).sum();
    let (quantity, unit, value, scale) = match requirement.limit {
        Limit::StrayToSignal(_) => {
            let signal = found.stray.signal_w.map_or(0.0, |signal| signal.mean);
            ("stray / signal", "", found.stray.to_signal, 1.0 / signal)
        }
        Limit::StrayFlux(_) => ("stray flux", "W", Some(found.stray.flux_w), 1.0),
        Limit::StrayIrradiance(_) => ("stray irradiance", "W/m2", Some(over(found.stray.flux_w, area)), 1.0 / area),
    };
    let quantile = student_quantile(results.batches, requirement.confidence);
    // That of 95 % is -ln 0.05 rays. Without signal the ratio to it has no limit that it could stay below.
    let upper = scale * found.stray.upper_limit_w * (-(1.0 - requirement.confidence).ln() / 3.0).max(1.0);
    let required = Required::of(
        requirement.limit.value(),
        value.unwrap_or_default(),
        if value.is_some() { contributing(found) } else { 0 },
        if upper.is_nan() { f64::INFINITY } else { upper },
        quantile,
    );
    // What was lost or cut may be stray light.
    let pass = required.verdict == Verdict::Pass && !results.trusted;
    let required = Required { verdict: if pass { Verdict::NotResolved } else { required.verdict }, ..required };
    Some(RequirementResult {
        name: requirement.label.clone(),
        detector: watched.label.clone(),
        quantity: quantity.into(),
        unit: unit.into(),
        value,
        confidence: requirement.confidence,
        required,
    })
}

/// Source rays that a verdict may rest on; of an error that is a guess, too few.
fn contributing(found: &DetectorResult) -> u64 {
    if found.stray.brightest_batch > BRIGHTEST { found.stray.rays.min(1) } else { found.stray.rays }
}

fn over(flux: Estimate, area: f64) -> Estimate {
    Estimate { mean: flux.mean / area, error: flux.error / area }
}

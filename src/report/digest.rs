//! What a reader wants first: stray against signal, the paths that matter, whether the numbers can be trusted.
//!
//! Only sums of what the results hold. Where fluxes with errors are added, their errors may be correlated (one source ray feeds several rows),
//! so the sum of the errors is given: by the triangle inequality the true error is never larger.

use super::cause::is_meant;
use super::measured::{Digits, below, grouped, measured};
use super::picture::superscript;
use super::share::shares;
use crate::packet::LONGEST_PATH;
use crate::tally::results::{
    DetectorResult, Estimate, FilterResult, GuidanceResult, LedgerResult, PathResult, RequirementResult, Results,
    RunInfo,
};

/// Lost flux above this part of the emitted flux is worth a warning.
const LOST: f64 = 1e-6;

/// Classes with their flux, W, and share in %: signal first, then by falling flux.
pub fn classes(detector: &DetectorResult) -> Vec<(&str, Estimate, String)> {
    let mut rows: Vec<_> = detector.classes.iter().map(|(name, flux)| (name.as_str(), *flux)).collect();
    rows.sort_by(|a, b| is_meant(b.0).cmp(&is_meant(a.0)).then(b.1.mean.total_cmp(&a.1.mean)));
    let fluxes: Vec<f64> = rows.iter().map(|row| row.1.mean).collect();
    let shares = shares(&fluxes, fluxes.iter().sum());
    rows.into_iter().zip(shares).map(|((name, flux), share)| (name, flux, share)).collect()
}

/// Flux by source, W, where there is more than one: names by the first number in them, then by letters.
pub fn sources(detector: &DetectorResult) -> Vec<(&str, Estimate)> {
    let number = |name: &str| name.split(' ').find_map(|word| word.parse().ok()).unwrap_or(f64::INFINITY);
    let mut rows: Vec<_> = detector.sources.iter().map(|(name, flux)| (name.as_str(), *flux)).collect();
    rows.sort_by(|a, b| number(a.0).total_cmp(&number(b.0)));
    if rows.len() > 1 { rows } else { Vec::new() }
}

/// What the filters mean of the light on a detector.
pub fn filters<'a>(results: &'a Results, detector: &str) -> Vec<&'a FilterResult> {
    results.filters.iter().filter(|filter| filter.detector == detector).collect()
}

/// What a filter could not decide, in words.
pub fn open(filter: &FilterResult) -> String {
    let more = measured(filter.open_w.mean, filter.open_w.error);
    format!(
        "{more} W more may be meant: they came on paths of more than {LONGEST_PATH} steps, which are not spelled out"
    )
}

/// The figure of merit in words; `None` where the error is nothing or everything.
pub fn merit(detector: &DetectorResult, run: &RunInfo) -> Option<String> {
    let (relative, cpu) = (detector.flux_w.error / detector.flux_w.mean, run.seconds * run.threads as f64);
    let known = relative > 0.0 && relative < 1.0 && cpu > 0.0;
    known.then(|| {
        let merit = rounded(1.0 / (relative * relative * cpu));
        let brightest = 100.0 * detector.brightest_batch;
        let unsure = rounded(detector.variance_of_variance);
        format!(
            "figure of merit 1 / (relative error² × thread seconds): {merit} /s; brightest batch {brightest:.1} % of the flux; variance of the variance {unsure}"
        )
    })
}

/// What a detector counts by its own measure, and in its regions: what, how much, unit.
pub fn counted(detector: &DetectorResult) -> Vec<(String, Estimate, &str)> {
    let counted = detector.counted.as_ref();
    let unit = counted.map_or("W", |counted| &counted.unit);
    let all = counted.map(|counted| ("counted".into(), counted.total, unit));
    let regions = detector.regions.iter().map(|(name, value)| (format!("in {name}"), *value, unit));
    all.into_iter().chain(regions).collect()
}

/// What was found of what is required: a value, or what it is below; nothing without signal.
pub fn required(row: &RequirementResult) -> String {
    match row.value {
        None => "no signal".into(),
        Some(value) if value.mean > 0.0 => measured(value.mean, value.error),
        Some(_) => below(row.required.limit / row.required.margin),
    }
}

/// "4.4" times of room, or what is too much.
pub fn margin(row: &RequirementResult) -> String {
    row.value.map_or("-".into(), |_| measured(rounded(row.required.margin), 0.0))
}

/// Stray over signal, where there is stray light.
pub fn stray_to_signal(detector: &DetectorResult) -> Option<Estimate> {
    detector.stray.to_signal.filter(|ratio| ratio.mean > 0.0)
}

/// The largest arrival in words.
pub fn largest(detector: &DetectorResult) -> Option<String> {
    let largest = detector.largest.as_ref()?;
    Some(format!("largest arrival: {} % of the flux, {}", rounded(100.0 * largest.share), largest.sequence))
}

/// Two digits of a number.
pub fn rounded(value: f64) -> f64 {
    format!("{value:.1e}").parse().unwrap_or(value)
}

/// What the run learned before it began, in words.
pub fn guidance(guidance: &GuidanceResult) -> String {
    let targets = guidance.targets.join(", ");
    let aimed = if targets.is_empty() { String::new() } else { format!(", aims at {targets}") };
    let taken = if guidance.used {
        "drawn by what was learned of importance"
    } else {
        "drawn plainly: what was learned of importance does not pay"
    };
    format!("{taken} ({} patches{aimed}; figure of merit × {} in a trial)", guidance.patches, rounded(guidance.gain))
}

/// Sum of the means, and of the errors as an upper bound.
pub fn sum(parts: impl Iterator<Item = Estimate>) -> Estimate {
    parts.fold(Estimate::default(), |sum, part| Estimate { mean: sum.mean + part.mean, error: sum.error + part.error })
}

/// The strongest paths of one detector and the rest in one row; shares add up to 100 %.
pub struct Strongest<'a> {
    pub rows: Vec<(&'a PathResult, String)>,
    /// Flux (W), share and number of further sequences that have a row in paths.csv; `None` when nothing is left.
    pub other: Option<(Estimate, String, usize)>,
}

/// At most `count` paths by falling flux. What had no row of its own is part of the rest.
pub fn strongest<'a>(results: &'a Results, detector: &str, count: usize) -> Strongest<'a> {
    let of_detector = results.paths.iter().filter(|path| path.detector == detector);
    let (mut rows, mut rest): (Vec<_>, Vec<_>) = of_detector.partition(|path| path.sequence != "other");
    rows.sort_by(|a, b| b.flux_w.mean.total_cmp(&a.flux_w.mean));
    let further = rows.split_off(rows.len().min(count));
    let sequences = further.len();
    rest.extend(further);
    let left = sum(rest.iter().map(|path| path.flux_w));
    let fluxes: Vec<f64> = rows.iter().map(|path| path.flux_w.mean).chain([left.mean]).collect();
    let mut shares = shares(&fluxes, fluxes.iter().sum());
    let share = shares.pop().unwrap_or_default();
    let other = (!rest.is_empty()).then_some((left, share, sequences));
    Strongest { rows: rows.into_iter().zip(shares).collect(), other }
}

/// Where the watts went: rows that add up to the emitted flux, with their share in %.
pub fn ledger(ledger: &LedgerResult) -> Vec<(&'static str, &'static str, Estimate, String)> {
    let rows = [
        ("absorbed", "in surfaces and media", ledger.absorbed),
        ("escaped", "left the scene", ledger.escaped),
        ("terminated", "roulette (net) and order limits", ledger.terminated),
        ("lost", "geometry faults", ledger.lost),
        ("residual", "what these leave open", ledger.residual),
    ];
    let shares = shares(&rows.map(|row| row.2.mean), ledger.emitted.mean);
    rows.into_iter().zip(shares).map(|((name, what, flux), share)| (name, what, flux, share)).collect()
}

/// A sentence, and whether it is good news.
pub struct Verdict {
    pub good: bool,
    pub text: String,
}

/// Whether the total of a detector is known, and how well.
pub fn resolution(detector: &DetectorResult) -> Verdict {
    if detector.upper_limit_w.is_some() {
        let text = "No ray arrived. The limit is three times the most that one source ray carries, over their number.";
        return Verdict { good: false, text: text.into() };
    }
    let flux = detector.flux_w;
    let relative = |error: f64| measured_percent(error / flux.mean.abs());
    let text = format!(
        "Known to {} (1σ), ±{} at 95 %, from {} source rays.",
        relative(flux.error),
        relative(detector.interval95_w),
        grouped(detector.rays, "\u{202f}")
    );
    Verdict { good: detector.rays >= 30 && flux.error.is_finite(), text }
}

/// How much of the map can be read pixel by pixel.
pub fn pixels(detector: &DetectorResult) -> Verdict {
    if detector.unresolved > 0.0 {
        let part = measured_percent(detector.unresolved);
        let text = format!("{part} of the lit bins rest on fewer than 30 source rays: average before reading them.");
        return Verdict { good: false, text };
    }
    Verdict { good: true, text: "Every lit bin rests on at least 30 source rays.".into() }
}

/// Whether the watts add up.
pub fn closure(ledger: &LedgerResult) -> Verdict {
    let (residual, emitted) = (ledger.residual, ledger.emitted.mean.abs());
    let rounding = residual.mean.abs() <= 1e-9 * emitted; // 1e-9: sums of up to 1e12 terms of f64
    let good = ledger.closes();
    let how = match (rounding && good, residual.error > 0.0) {
        (true, _) => "to rounding".into(),
        (false, true) => format!("with a residual of {:.1} σ", residual.mean.abs() / residual.error),
        (false, false) => format!("with a residual of {} W", measured(residual.mean, 0.0)),
    };
    let verb = if good { "closes" } else { "does not close:" };
    Verdict { good, text: format!("The ledger {verb} {how}.") }
}

/// Whether flux went astray in the geometry.
pub fn losses(ledger: &LedgerResult) -> Verdict {
    let part = ledger.lost.mean / ledger.emitted.mean;
    if ledger.lost.mean == 0.0 {
        return Verdict { good: true, text: "No flux was lost to geometry faults.".into() };
    }
    Verdict { good: part <= LOST, text: format!("{} of the flux was lost to geometry faults.", measured_percent(part)) }
}

/// A fraction in per cent, two digits.
pub fn measured_percent(fraction: f64) -> String {
    let rounded = format!("{:.1e}", 100.0 * fraction).parse().unwrap_or(f64::NAN);
    if !fraction.is_finite() {
        return "? %".into();
    }
    let Digits { mean, exponent, .. } = Digits::of(rounded, 0.0);
    if exponent == 0 { format!("{mean} %") } else { format!("{mean} × 10{} %", superscript(exponent)) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ledger_closes_within_five_sigma_or_to_rounding() {
        let with = |mean, error| LedgerResult {
            emitted: Estimate { mean: 1.0, error: 0.0 },
            residual: Estimate { mean, error },
            ..Default::default()
        };
        assert!(closure(&with(1e-13, 0.0)).good);
        assert!(closure(&with(3e-6, 1e-6)).good);
        assert!(!closure(&with(5.1e-6, 1e-6)).good);
        assert!(!closure(&with(5e-6, 0.0)).good);
    }

    #[test]
    fn per_cent_have_two_digits() {
        assert_eq!(measured_percent(0.006_617), "0.66 %");
        assert_eq!(measured_percent(0.123_4), "12 %");
        assert_eq!(measured_percent(1.2e-9), "1.2 × 10⁻⁷ %");
        assert_eq!(measured_percent(f64::INFINITY), "? %");
    }
}

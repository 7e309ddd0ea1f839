//! The result for the terminal: plain lines, no colour, no width assumed.

use super::cause::causes;
use super::digest::{self, Verdict};
use super::measured::{below, grouped, measured};
use crate::tally::results::{Estimate, RequirementResult, Results, RunInfo};
use std::fmt::{self, Write};

/// Paths listed per detector.
const PATHS: usize = 10;

/// Widest path on one line.
const SEQUENCE: usize = 100;

/// Key numbers with errors (one sigma), classes, the strongest paths, the ledger, warnings. Ends with a newline.
#[must_use]
pub fn text(results: &Results, run: &RunInfo) -> String {
    let mut out = String::new();
    // Writing into a String cannot fail.
    let _ = whole(&mut out, results, run);
    out
}

fn whole(out: &mut String, results: &Results, run: &RunInfo) -> fmt::Result {
    heading(out, results, run)?;
    requirements(out, results)?;
    for name in results.detectors.keys() {
        key_numbers(out, results, run, name)?;
        filters(out, results, name)?;
        paths(out, results, name)?;
    }
    ledger(out, results)?;
    for warning in &results.warnings {
        writeln!(out, "warning: {warning}")?;
    }
    Ok(())
}

fn heading(out: &mut String, results: &Results, run: &RunInfo) -> fmt::Result {
    let rays = grouped(results.rays, " ");
    writeln!(out, "{}", results.system)?;
    write!(out, "{rays} source rays in {} batches, seed {}", results.batches, results.seed)?;
    if results.rays != results.rays_requested {
        write!(out, " ({} requested)", grouped(results.rays_requested, " "))?;
    }
    writeln!(out, "; {:.1} s on {} threads", run.seconds, run.threads)?;
    if !results.parameters.is_empty() {
        let all: Vec<String> = results.parameters.iter().map(|(name, value)| format!("{name} = {value}")).collect();
        writeln!(out, "parameters: {}", all.join(", "))?;
    }
    for finish in &results.finishes {
        writeln!(out, "finish: {finish}")?;
    }
    if let Some(guidance) = &results.importance {
        writeln!(out, "{}", digest::guidance(guidance))?;
    }
    if run.interrupted {
        writeln!(out, "interrupted: what was finished is below")?;
    }
    writeln!(out, "errors are one standard error of the mean")
}

/// What is required, and whether it holds.
fn requirements(out: &mut String, results: &Results) -> fmt::Result {
    for row in &results.requirements {
        let RequirementResult { name, quantity, detector, unit, required, .. } = row;
        let (found, margin) = (digest::required(row), digest::margin(row));
        let limit = measured(required.limit, 0.0);
        writeln!(
            out,
            "{}: {name}: {quantity} on {detector} {found} {unit}, limit {limit} {unit}, margin {margin} x",
            required.verdict
        )?;
    }
    Ok(())
}

fn key_numbers(out: &mut String, results: &Results, run: &RunInfo, name: &str) -> fmt::Result {
    let Some(detector) = results.detectors.get(name) else { return Ok(()) };
    let flux = match detector.upper_limit_w {
        Some(limit) => below(limit),
        None => estimate(detector.flux_w),
    };
    writeln!(out, "\n{name}: {flux} W")?;
    said(out, digest::resolution(detector))?;
    if detector.upper_limit_w.is_some() {
        return Ok(());
    }
    for (what, value, unit) in digest::counted(detector) {
        writeln!(out, "  {what}: {} {unit}", estimate(value))?;
    }
    said(out, digest::pixels(detector))?;
    let [row, column] = detector.peak_w_m2.pixel;
    let peak = measured(detector.peak_w_m2.mean, detector.peak_w_m2.error);
    writeln!(
        out,
        "  brightest bin: {peak} {} at row {row}, column {column} (a maximum is biased upward)",
        detector.unit
    )?;
    if let Some(ratio) = digest::stray_to_signal(detector) {
        writeln!(out, "  stray / signal: {}", estimate(ratio))?;
    }
    if let Some(cause) = causes(results, name).first() {
        let share = measured(100.0 * cause.share.mean, 100.0 * cause.share.error);
        writeln!(out, "  {share} % of the stray light is {}", cause.text)?;
    }
    if let Some(merit) = digest::merit(detector, run) {
        writeln!(out, "  {merit}")?;
    }
    if let Some(largest) = digest::largest(detector) {
        writeln!(out, "  {}", shortened(&largest))?;
    }
    for (class, flux, share) in digest::classes(detector) {
        writeln!(out, "  {class:<14} {:>26} W {share:>12} %", estimate(flux))?;
    }
    for (source, flux) in digest::sources(detector) {
        writeln!(out, "  from {source:<14} {:>26} W", estimate(flux))?;
    }
    Ok(())
}

fn filters(out: &mut String, results: &Results, detector: &str) -> fmt::Result {
    for filter in digest::filters(results, detector) {
        let flux = filter.upper_limit_w.map_or_else(|| estimate(filter.flux_w), below);
        let share = digest::rounded(filter.percent);
        writeln!(out, "  filter {:?}: {flux} W, {share} %  ({})", filter.filter, filter.expression)?;
        if filter.open_w.mean > 0.0 {
            writeln!(out, "  ! {}", digest::open(filter))?;
        }
    }
    Ok(())
}

fn paths(out: &mut String, results: &Results, detector: &str) -> fmt::Result {
    let strongest = digest::strongest(results, detector, PATHS);
    if strongest.rows.is_empty() {
        return Ok(());
    }
    writeln!(out, "  strongest paths:")?;
    for (path, share) in &strongest.rows {
        writeln!(out, "  {share:>12} % {:>26} W  {}", estimate(path.flux_w), shortened(&path.sequence))?;
    }
    if let Some((flux, share, sequences)) = &strongest.other {
        writeln!(
            out,
            "  {share:>12} % {:>26} W  other ({sequences} of them in paths.csv; error: upper bound)",
            estimate(*flux)
        )?;
    }
    Ok(())
}

fn ledger(out: &mut String, results: &Results) -> fmt::Result {
    writeln!(out, "\nledger: {} W emitted", estimate(results.ledger_w.emitted))?;
    for (name, what, flux, share) in digest::ledger(&results.ledger_w) {
        writeln!(out, "  {name:<14} {:>26} W {share:>12} %  {what}", estimate(flux))?;
    }
    said(out, digest::closure(&results.ledger_w))?;
    said(out, digest::losses(&results.ledger_w))
}

fn said(out: &mut String, verdict: Verdict) -> fmt::Result {
    writeln!(out, "  {}{}", if verdict.good { "" } else { "! " }, verdict.text.replace('\u{202f}', " "))
}

fn estimate(value: Estimate) -> String {
    measured(value.mean, value.error)
}

/// A long path with its runs of transmissions counted instead of named, and cut if it is still too long.
pub(super) fn shortened(sequence: &str) -> String {
    if sequence.chars().count() <= SEQUENCE {
        return sequence.into();
    }
    let mut steps: Vec<String> = Vec::new();
    let mut through = 0;
    for step in sequence.split(" > ") {
        if step.ends_with(":T") {
            through += 1;
            continue;
        }
        steps.extend((through > 0).then(|| format!("({through} T)")));
        through = 0;
        steps.push(step.into());
    }
    steps.extend((through > 0).then(|| format!("({through} T)")));
    let counted = steps.join(" > ");
    if counted.chars().count() <= SEQUENCE {
        return counted;
    }
    format!("{} ...", counted.chars().take(SEQUENCE - 4).collect::<String>())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_long_path_keeps_what_makes_it_stray() {
        let lenses = "Lens_with_a_long_name.front:T > Lens_with_a_long_name.back:T".to_owned();
        let path = format!("sun > {lenses} > {lenses} > Barrel:S > {lenses} > Detector");
        assert_eq!(shortened(&path), "sun > (4 T) > Barrel:S > (2 T) > Detector");
        assert_eq!(shortened("sun > Lens:T > Detector"), "sun > Lens:T > Detector");
    }
}

//! A comparison for the terminal: plain lines, no colour, no width assumed.

use crate::report::measured::{grouped, measured};
use crate::study::compare::{Change, Comparison, Shift, VariantResult};
use crate::tally::results::RunInfo;
use std::fmt::{self, Write};

/// Paths and surfaces that are listed of each variant.
const LISTED: usize = 3;

/// Stray light and signal of every variant on every detector, what changed most, warnings. Ends with a newline.
#[must_use]
pub fn comparison(comparison: &Comparison, run: &RunInfo) -> String {
    let mut out = String::new();
    // Writing into a String cannot fail.
    let _ = whole(&mut out, comparison, run);
    out
}

fn whole(out: &mut String, comparison: &Comparison, run: &RunInfo) -> fmt::Result {
    let (rays, count) = (grouped(comparison.rays, " "), comparison.variants.len());
    let traces = if comparison.traces == 1 { "one trace".into() } else { format!("{} traces", comparison.traces) };
    writeln!(out, "{}: the baseline and {} variants in {traces}", comparison.system, count - 1)?;
    write!(out, "{rays} source rays in {} batches, seed {}", comparison.batches, comparison.seed)?;
    writeln!(out, "; {:.1} s on {} threads", run.seconds, run.threads)?;
    if comparison.interrupted {
        writeln!(out, "interrupted: what was finished is below")?;
    }
    writeln!(
        out,
        "errors are one standard error of the mean; those of ratios come from batches paired with the baseline's"
    )?;
    let detectors = comparison.variants.first().map(|variant| variant.detectors.keys());
    for detector in detectors.into_iter().flatten() {
        writeln!(out, "\n{detector}")?;
        table(out, comparison, detector)?;
    }
    for variant in comparison.variants.iter().skip(1) {
        changes(out, variant)?;
    }
    for warning in &comparison.warnings {
        writeln!(out, "warning: {warning}")?;
    }
    Ok(())
}

fn table(out: &mut String, comparison: &Comparison, detector: &str) -> fmt::Result {
    let signal = comparison.variants.iter().any(|variant| variant.detectors[detector].signal.is_some());
    let mut rows = vec![vec!["variant".to_owned(), "stray, W".into(), "of baseline".into()]];
    if signal {
        rows[0].extend(["signal, W".to_owned(), "of baseline".into()]);
    }
    rows[0].push("verdict".into());
    for (number, variant) in comparison.variants.iter().enumerate() {
        let found = &variant.detectors[detector];
        let mut row = vec![variant.name.clone()];
        row.extend(pair(Some(&found.stray), number));
        if signal {
            row.extend(pair(found.signal.as_ref(), number));
        }
        row.push(if number == 0 { String::new() } else { found.verdict.clone() });
        rows.push(row);
    }
    lay(out, &rows)
}

/// A flux and its ratio to the baseline's.
fn pair(change: Option<&Change>, number: usize) -> [String; 2] {
    let Some(change) = change else { return ["-".into(), String::new()] };
    let ratio = change.ratio.filter(|_| number > 0).map(|ratio| measured(ratio.mean, ratio.error));
    [measured(change.flux_w.mean, change.flux_w.error), ratio.unwrap_or_default()]
}

/// Columns as wide as their widest cell, the first and the last to the left.
fn lay(out: &mut String, rows: &[Vec<String>]) -> fmt::Result {
    let columns = rows.first().map_or(0, Vec::len);
    let width = |column: usize| rows.iter().map(|row| row[column].chars().count()).max().unwrap_or(0);
    let widths: Vec<usize> = (0..columns).map(width).collect();
    for row in rows {
        let cell = |(column, cell): (usize, &String)| {
            let width = widths[column];
            if column == 0 || column + 1 == columns { format!("{cell:<width$}") } else { format!("{cell:>width$}") }
        };
        let line: Vec<String> = row.iter().enumerate().map(cell).collect();
        writeln!(out, "  {}", line.join("   ").trim_end())?;
    }
    Ok(())
}

fn changes(out: &mut String, variant: &VariantResult) -> fmt::Result {
    writeln!(out, "\n{}", variant.name)?;
    if !variant.together {
        writeln!(out, "  other shapes or indices: a run of its own, paired by batch")?;
    }
    for (name, value) in &variant.parameters {
        writeln!(out, "  {name} = {value}")?;
    }
    listed(out, "paths that changed most", &variant.paths)?;
    listed(out, "surfaces that absorb another flux", &variant.absorbed)
}

fn listed(out: &mut String, title: &str, shifts: &[Shift]) -> fmt::Result {
    if shifts.is_empty() {
        return Ok(());
    }
    writeln!(out, "  {title}:")?;
    for shift in shifts.iter().take(LISTED) {
        let amount = measured(shift.difference_w.mean, shift.difference_w.error);
        let label =
            if shift.detector.is_empty() { shift.label.clone() } else { super::super::text::shortened(&shift.label) };
        writeln!(out, "    {amount:>24} W  {label}")?;
    }
    Ok(())
}

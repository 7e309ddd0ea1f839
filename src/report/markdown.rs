//! report.md: the first sheet of the report as text, for a repository, a ticket or a mail.

use super::cause::{causes, top};
use super::digest;
use super::measured::{below, grouped, measured};
use crate::tally::results::{Results, RunInfo};
use std::fmt::{self, Write};

/// Paths that are listed.
const PATHS: usize = 5;

/// The whole text.
pub fn markdown(results: &Results, run: &RunInfo) -> String {
    let mut out = String::new();
    // Writing into a String cannot fail.
    let _ = whole(&mut out, results, run);
    out
}

fn whole(out: &mut String, results: &Results, run: &RunInfo) -> fmt::Result {
    writeln!(out, "# {}\n", plain(&results.system))?;
    requirements(out, results)?;
    for (name, found) in &results.detectors {
        let flux = found.upper_limit_w.map_or_else(|| measured(found.flux_w.mean, found.flux_w.error), below);
        writeln!(out, "## {}\n\n- flux {flux} W", plain(name))?;
        if let Some(ratio) = digest::stray_to_signal(found) {
            writeln!(out, "- stray / signal {}", measured(ratio.mean, ratio.error))?;
        }
        for cause in causes(results, name).iter().take(3) {
            let share = measured(100.0 * cause.share.mean, 100.0 * cause.share.error);
            writeln!(out, "- {share} % of the stray light is {}", plain(&cause.text))?;
        }
        let top = top(results, name, found, PATHS);
        if !top.rows.is_empty() {
            writeln!(out, "\n| share of stray light, % | flux, W | path |\n|---:|---:|---|")?;
        }
        for (path, share) in &top.rows {
            let flux = measured(path.flux_w.mean, path.flux_w.error);
            writeln!(out, "| {share} | {flux} | {} |", plain(&path.sequence))?;
        }
        if let Some((flux, share)) = &top.other {
            writeln!(out, "| {share} | {} | other |", measured(digest::rounded(*flux), 0.0))?;
        }
        writeln!(out)?;
    }
    closing(out, results, run)
}

fn requirements(out: &mut String, results: &Results) -> fmt::Result {
    if results.requirements.is_empty() {
        return Ok(());
    }
    writeln!(out, "| requirement | found | limit | margin | verdict |\n|---|---:|---:|---:|---|")?;
    for row in &results.requirements {
        let found = digest::required(row);
        let about = format!("{}: {} on {}", row.name, row.quantity, row.detector);
        let (required, unit) = (&row.required, &row.unit);
        let margin = digest::margin(row);
        let limit = measured(required.limit, 0.0);
        writeln!(out, "| {} | {found} {unit} | {limit} {unit} | {margin} × | {} |", plain(&about), required.verdict)?;
    }
    writeln!(out)
}

fn closing(out: &mut String, results: &Results, run: &RunInfo) -> fmt::Result {
    writeln!(out, "## Assumed\n")?;
    for [heading, text] in &results.assumptions {
        writeln!(out, "- {heading}: {}", plain(text))?;
    }
    if run.interrupted {
        writeln!(out, "\nInterrupted: this holds the batches that were finished.")?;
    }
    let trust = if results.trusted { "Sound" } else { "Not to be trusted" };
    let [closure, losses] = [digest::closure(&results.ledger_w), digest::losses(&results.ledger_w)];
    writeln!(out, "\n{trust}: {} {}", closure.text, losses.text)?;
    for warning in &results.warnings {
        writeln!(out, "- warning: {}", plain(warning))?;
    }
    let rays = grouped(results.rays, " ");
    writeln!(out, "\n{rays} source rays, seed {}, straylight {}: `{}`", results.seed, run.version, run.command)
}

/// Text in which nothing is taken for a mark of the language.
fn plain(text: &str) -> String {
    let marked = |c: char| "\\|*_`[]#&<".contains(c);
    text.replace('\n', " ").chars().flat_map(|c| marked(c).then_some('\\').into_iter().chain([c])).collect()
}

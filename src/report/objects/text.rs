//! Critical and illuminated objects for the terminal: plain lines, no colour, no width assumed.

use super::heading;
use crate::report::measured::{below, grouped, measured};
use crate::study::objects::{Objects, View, Warmth, Way, Ways};
use crate::tally::results::{Estimate, RunInfo};
use std::fmt::{self, Write};

/// Rows of a table; the files have all of them.
const LISTED: usize = 20;

/// What is seen, what is lit, what is both, what glows, warnings. Ends with a newline.
#[must_use]
pub fn objects(found: &Objects, run: &RunInfo) -> String {
    let mut out = String::new();
    // Writing into a String cannot fail.
    let _ = whole(&mut out, found, run);
    out
}

fn whole(out: &mut String, found: &Objects, run: &RunInfo) -> fmt::Result {
    writeln!(out, "{}: critical and illuminated objects", found.system)?;
    write!(out, "{} rays of each trace in {} batches, ", grouped(found.rays, " "), found.batches)?;
    writeln!(out, "seed {}; {:.1} s on {} threads", found.seed, run.seconds, run.threads)?;
    writeln!(out, "errors are one standard error of the mean")?;
    for view in &found.views {
        seen(out, view)?;
    }
    if !found.lit.is_empty() {
        lit(out, found)?;
    }
    for view in &found.views {
        first_order(out, view, !found.lit.is_empty())?;
        if let Some(warmth) = &view.thermal {
            thermal(out, view, warmth)?;
        }
    }
    for warning in &found.warnings {
        writeln!(out, "warning: {warning}")?;
    }
    Ok(())
}

fn seen(out: &mut String, view: &View) -> fmt::Result {
    writeln!(out, "\nSeen by {}: projected solid angle, sr, weighed with what arrives", view.detector)?;
    let mut rows = vec![titles(&["absorbs, any way"])];
    for seen in view.seen.iter().filter(|seen| seen.upper_limit_sr.is_none()).take(LISTED) {
        rows.push(row(&seen.object, &seen.seen_sr, &[seen.absorbed_sr]));
    }
    rows.push(row("open sky", &view.sky_sr, &[view.escaped_sr]));
    lay(out, &rows)?;
    let number = |amount: Estimate| measured(amount.mean, amount.error);
    let sum = [view.absorbed_sr, view.escaped_sr, view.residual_sr].map(number);
    writeln!(out, "  absorbed {} + sky {} + missing {} = {} sr", sum[0], sum[1], sum[2], measured(view.whole_sr, 0.0))?;
    let hidden: Vec<&str> =
        view.seen.iter().filter(|seen| seen.upper_limit_sr.is_some()).map(|seen| seen.object.as_str()).collect();
    let limit = view.seen.iter().find_map(|seen| seen.upper_limit_sr);
    unseen(out, "not seen", &hidden, limit, "sr")
}

fn lit(out: &mut String, found: &Objects) -> fmt::Result {
    writeln!(out, "\nLit by the sources ({} W): flux that falls on it, W", measured(found.sources_w, 0.0))?;
    let mut rows = vec![titles(&[])];
    for lit in found.lit.iter().filter(|lit| lit.upper_limit_w.is_none()).take(LISTED) {
        rows.push(row(&lit.object, &lit.flux_w, &[]));
    }
    lay(out, &rows)?;
    let dark: Vec<&str> =
        found.lit.iter().filter(|lit| lit.upper_limit_w.is_some()).map(|lit| lit.object.as_str()).collect();
    unseen(out, "dark", &dark, found.lit.iter().find_map(|lit| lit.upper_limit_w), "W")
}

fn first_order(out: &mut String, view: &View, lights: bool) -> fmt::Result {
    if view.first_order.is_empty() {
        let none = "nothing that scatters is both lit and seen, directly or through the optics";
        return if lights { writeln!(out, "\nPaths of first order to {}: {none}", view.detector) } else { Ok(()) };
    }
    writeln!(out, "\nPaths of first order to {}: lit and seen, directly or through the optics", view.detector)?;
    let mut rows = vec![["object", "lit, W", "seen, sr", "as if scattered evenly, W"].map(String::from).to_vec()];
    for first in view.first_order.iter().take(LISTED) {
        let numbers = [first.lit_w, first.seen_sr, first.flux_w].map(cell);
        rows.push([first.object.clone()].into_iter().chain(numbers).collect());
    }
    lay(out, &rows)?;
    writeln!(
        out,
        "  the first are candidates for a baffle, a stop or a better finish; the last column is a rank, no result"
    )
}

fn thermal(out: &mut String, view: &View, warmth: &Warmth) -> fmt::Result {
    let [from, to] = warmth.band_m.map(|m| measured(1e6 * m, 0.0));
    writeln!(out, "\nThermal light on {}, {from} to {to} um", view.detector)?;
    let mut rows = vec![["object", "K", "W", "photons/s"].map(String::from).to_vec()];
    for warm in warmth.notable().take(LISTED) {
        let flux = match warm.upper_limit_w {
            Some(limit) => [below(limit), "-".into()],
            None => [warm.flux_w, warm.photons_per_s].map(cell),
        };
        rows.push([warm.object.clone(), measured(warm.temperature_k, 0.0)].into_iter().chain(flux).collect());
    }
    let all = [warmth.flux_w, warmth.photons_per_s].map(cell);
    rows.push(["all".to_owned(), String::new()].into_iter().chain(all).collect());
    lay(out, &rows)
}

fn titles(last: &[&'static str]) -> Vec<String> {
    let ways = Way::ALL.into_iter().map(heading);
    ["object"].into_iter().chain(ways).chain(last.iter().copied()).map(String::from).collect()
}

fn row(object: &str, ways: &Ways, last: &[Estimate]) -> Vec<String> {
    let amounts = Way::ALL.into_iter().map(|way| ways.get(&way).copied().unwrap_or_default());
    let cells = amounts.chain(last.iter().copied()).map(cell);
    [object.to_owned()].into_iter().chain(cells).collect()
}

fn cell(amount: Estimate) -> String {
    if amount == Estimate::default() { "-".into() } else { measured(amount.mean, amount.error) }
}

fn unseen(out: &mut String, what: &str, objects: &[&str], limit: Option<f64>, unit: &str) -> fmt::Result {
    let Some(limit) = limit else { return Ok(()) };
    let more = objects.len().saturating_sub(LISTED);
    let more = if more > 0 { format!(" and {more} more") } else { String::new() };
    let listed = objects[..objects.len().min(LISTED)].join(", ");
    writeln!(out, "  {what}, each {} {unit}: {listed}{more}", below(limit))
}

/// Columns as wide as their widest cell, the first to the left.
fn lay(out: &mut String, rows: &[Vec<String>]) -> fmt::Result {
    let columns = rows.first().map_or(0, Vec::len);
    let width = |column: usize| rows.iter().map(|row| row[column].chars().count()).max().unwrap_or(0);
    let widths: Vec<usize> = (0..columns).map(width).collect();
    for row in rows {
        let cell = |(column, cell): (usize, &String)| {
            let width = widths[column];
            if column == 0 { format!("{cell:<width$}") } else { format!("{cell:>width$}") }
        };
        let line: Vec<String> = row.iter().enumerate().map(cell).collect();
        writeln!(out, "  {}", line.join("   ").trim_end())?;
    }
    Ok(())
}

//! Ghosts for the terminal.

use super::{View, shown, views};
use crate::report::measured::{below, grouped, measured};
use crate::study::ghost::{Ghost, Ghosts};
use crate::tally::results::{Estimate, RunInfo};
use std::fmt::{self, Write};

/// Ghosts listed per detector and source.
const LISTED: usize = 20;

/// Columns of a matrix that fit on a line; the file has them all.
const WIDEST: usize = 14;

/// The strongest ghosts with errors (one sigma), and the pairs as a matrix. Ends with a newline.
#[must_use]
pub fn ghosts(ghosts: &Ghosts, run: &RunInfo) -> String {
    let mut out = String::new();
    // Writing into a String cannot fail.
    let _ = whole(&mut out, ghosts, run);
    out
}

fn whole(out: &mut String, ghosts: &Ghosts, run: &RunInfo) -> fmt::Result {
    writeln!(out, "{}: ghosts of up to {} unintended reflections", ghosts.system, ghosts.order)?;
    let rays = grouped(ghosts.rays, " ");
    write!(out, "{rays} source rays in {} batches, seed {}", ghosts.batches, ghosts.seed)?;
    writeln!(out, "; {:.1} s on {} threads", run.seconds, run.threads)?;
    writeln!(
        out,
        "errors are one standard error of the mean; focus: from the detector along the mean ray, + beyond it"
    )?;
    for view in views(ghosts) {
        one(out, ghosts, &view)?;
    }
    for warning in &ghosts.warnings {
        writeln!(out, "warning: {warning}")?;
    }
    Ok(())
}

fn one(out: &mut String, ghosts: &Ghosts, view: &View) -> fmt::Result {
    let signal = view.signal.map_or("none".into(), |signal| format!("{} W", told(Some(signal.flux_w), 1.0)));
    writeln!(out, "\n{} from {}: signal {signal}", view.detector, view.source)?;
    writeln!(
        out,
        "  {:>24} {:>24} {:>24} {:>18} {:>20}  surfaces, in the order of the light",
        "flux W", "of the signal", "peak W/m2", "rms radius mm", "focus mm"
    )?;
    for ghost in view.lit.iter().take(LISTED) {
        writeln!(out, "{}", line(ghost))?;
    }
    if view.lit.len() > LISTED {
        writeln!(out, "  and {} more in ghosts.csv", view.lit.len() - LISTED)?;
    }
    if let Some(limit) = view.limit() {
        writeln!(out, "  of {} more sequences nothing arrives: {} W each", view.dark.len(), below(limit))?;
    }
    matrix(out, ghosts, view)
}

fn line(ghost: &Ghost) -> String {
    format!(
        "  {:>24} {:>24} {:>24} {:>18} {:>20}  {}",
        told(Some(ghost.flux_w), 1.0),
        told(ghost.relative, 1.0),
        told(Some(Estimate { mean: ghost.peak_w_m2.mean, error: ghost.peak_w_m2.error }), 1.0),
        told(ghost.rms_radius_m, 1e3),
        told(ghost.focus_m, 1e3),
        ghost.surfaces.join(", ")
    )
}

fn told(value: Option<Estimate>, factor: f64) -> String {
    value.map(|value| shown(value, factor)).map_or("-".into(), |value| measured(value.mean, value.error))
}

/// Rows: first surface; columns: second surface, by number; `0`: nothing arrives, blank: no such way.
fn matrix(out: &mut String, ghosts: &Ghosts, view: &View) -> fmt::Result {
    let [first, second] = view.sides(ghosts);
    if first.is_empty() {
        return Ok(());
    }
    if second.len() > WIDEST {
        return writeln!(out, "  the matrix of first and second surfaces is in matrix.csv");
    }
    let number = |name: &str| ghosts.surfaces.iter().position(|known| known == name).unwrap_or_default() + 1;
    let widest = first.iter().map(|name| name.chars().count()).max().unwrap_or_default();
    let heads: String = second.iter().map(|name| format!(" {:>8}", number(name))).collect();
    writeln!(out, "  flux W by first surface and, in columns, by the number of the second:")?;
    writeln!(out, "  {:>4} {:<widest$}{heads}", "", "")?;
    for one in first {
        let cell = |other: &&str| match view.pair(one, other) {
            Some(ghost) if ghost.rays > 0 => format!(" {:>8.1e}", ghost.flux_w.mean),
            Some(_) => format!(" {:>8}", 0),
            None => format!(" {:>8}", ""),
        };
        let cells: String = second.iter().map(cell).collect();
        writeln!(out, "  {:>4} {one:<widest$}{}", number(one), cells.trim_end())?;
    }
    Ok(())
}

//! Where the watts went.

use super::number::estimate;
use crate::report::digest;
use crate::report::share::shares;
use crate::tally::results::{Estimate, Results};
use maud::{Markup, html};
use std::collections::BTreeMap;

/// Surfaces listed; the rest is one row.
const SURFACES: usize = 40;

pub fn ledger(results: &Results) -> Markup {
    let rows = digest::ledger(&results.ledger_w);
    let emitted = results.ledger_w.emitted;
    html! {
        section.ledger {
            h2 { "Where the watts went" }
            table {
                thead { tr { th { "Fate" } th {} th.right { "Flux" } th.right { "Share" } th {} } }
                tbody { @for (name, what, flux, share) in &rows {
                    tr { td { (name) } td.quiet { (what) } td.right { (estimate(*flux, "W")) } td.right { (share) " %" }
                        td.gauge { (gauge(flux.mean / emitted.mean, "#56616d")) } }
                } }
                tfoot { tr { th { "Emitted" } td.quiet { "the sum of the rows above" } td.right { (estimate(emitted, "W")) } td.right { "100 %" } td {} } }
            }
            (parts("Absorbed, by surface", "Surface or medium", &results.absorbed_w, "All absorbed", results.ledger_w.absorbed))
            (parts("Terminated, by cause", "Cause", &results.terminated_w, "All terminated", results.ledger_w.terminated))
            (parts("Lost, by cause", "Cause", &results.lost_w, "All lost", results.ledger_w.lost))
        }
    }
}

/// A named breakdown of one fate, largest first, drawn to the largest.
fn parts(title: &str, column: &str, parts: &BTreeMap<String, Estimate>, all: &str, sum: Estimate) -> Markup {
    let mut rows: Vec<_> = parts.iter().map(|(name, flux)| (name.clone(), *flux)).collect();
    rows.sort_by(|a, b| b.1.mean.total_cmp(&a.1.mean));
    if rows.len() > SURFACES {
        let rest = rows.split_off(SURFACES - 1);
        rows.push((format!("{} others (error: upper bound)", rest.len()), digest::sum(rest.iter().map(|row| row.1))));
    }
    let fluxes: Vec<f64> = rows.iter().map(|row| row.1.mean).collect();
    let largest = fluxes.iter().copied().fold(0.0, f64::max);
    let shares = shares(&fluxes, fluxes.iter().sum());
    html! {
        @if !rows.is_empty() && largest > 0.0 {
            h3 { (title) }
            table.parts {
                thead { tr { th { (column) } th.right { "Flux" } th.right { "Share" } th {} } }
                tbody { @for ((name, flux), share) in rows.iter().zip(&shares) {
                    tr { td { (name) } td.right { (estimate(*flux, "W")) } td.right { (share) " %" }
                        td.gauge { (gauge(flux.mean / largest, "#c0632b")) } }
                } }
                tfoot { tr { th { (all) } td.right { (estimate(sum, "W")) } td.right { "100 %" } td {} } }
            }
        }
    }
}

/// A bar of the given part (0..1) of its cell.
pub fn gauge(part: f64, colour: &str) -> Markup {
    let width = if part.is_finite() { 100.0 * part.clamp(0.0, 1.0) } else { 0.0 };
    html! { span.track { span style=(format!("width:{width:.2}%;background:{colour}")) {} } }
}

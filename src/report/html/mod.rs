//! report.html: one page that needs no network, no script and no program but a browser; it prints on A4.
//!
//! The order is that of a reader: what was found, whether it can be trusted, where the light fell, which way it came, where the rest
//! went, how to repeat it.

mod compare;
mod figure;
mod ghosts;
mod ledger;
mod number;
mod overview;
mod paths;
mod pst;
mod reproduce;
mod section;

use crate::study::compare::Comparison;
use crate::study::ghost::Ghosts;
use crate::tally::results::{Results, RunInfo};
use maud::{DOCTYPE, Markup, PreEscaped, html};
pub use pst::{curve_picture, pst_page, sky_picture};

/// Colours, type and print rules.
const STYLE: &str = include_str!("style.css");

/// The page of a run.
pub fn page(results: &Results, run: &RunInfo) -> String {
    whole(
        &results.system,
        &html! {
            (overview::overview(results, run))
            @for (index, name) in results.detectors.keys().enumerate() { (section::detector(results, index, name)) }
            (ledger::ledger(results))
            (warnings(results))
            (reproduce::reproduce(results, run))
        },
    )
}

/// The page of a comparison.
pub fn comparison(comparison: &Comparison, run: &RunInfo) -> String {
    whole(&comparison.system, &compare::body(comparison, run))
}

/// The page of a study of ghosts.
pub fn ghosts(ghosts: &Ghosts, run: &RunInfo) -> String {
    whole(&ghosts.system, &ghosts::body(ghosts, run))
}

fn whole(system: &str, body: &Markup) -> String {
    html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta name="viewport" content="width=device-width, initial-scale=1";
                meta http-equiv="Content-Security-Policy" content="default-src 'none'; img-src data:; style-src 'unsafe-inline'";
                title { (system) " – stray light" }
                style { (PreEscaped(STYLE)) }
            }
            body { main { (body) } }
        }
    }
    .into_string()
}

fn warnings(results: &Results) -> Markup {
    html! {
        @if !results.warnings.is_empty() {
            section.warnings id="warnings" {
                h2 { "Warnings" }
                ol { @for warning in &results.warnings { li { (warning) } } }
            }
        }
    }
}

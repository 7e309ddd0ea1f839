//! report.html: one page that needs no network and no program but a browser; its first screen prints on one A4. Without scripts it lacks
//! the 3-D view, sorting and read-outs, and nothing else.
//!
//! The order is that of a reader: what was found, whether it can be trusted, where the light fell, which way it came, where the rest
//! went, how to repeat it.

mod compare;
mod convergence;
mod cutaway;
mod figure;
mod ghosts;
mod ledger;
mod light;
mod number;
mod objects;
mod overview;
mod paths;
mod pst;
mod reproduce;
mod section;
mod sheet;
mod view;

use crate::study::compare::Comparison;
use crate::study::ghost::Ghosts;
use crate::study::objects::Objects;
use crate::tally::drawing::Drawing;
use crate::tally::results::{Results, RunInfo};
use maud::{DOCTYPE, Markup, PreEscaped, html};
pub use pst::{curve_picture, pst_page, sky_picture};
pub use view::page as view;

/// Colours, type and print rules.
const STYLE: &str = include_str!("style.css");

/// Scripts of a report beside those of its 3-D view.
const SCRIPTS: [&str; 2] = [include_str!("script/map.js"), include_str!("script/table.js")];

/// The page of a run.
pub fn page(results: &Results, run: &RunInfo) -> String {
    let body = html! {
        (overview::overview(results, run))
        @if let Some(drawing) = &results.drawing { (three(drawing)) }
        @for (index, name) in results.detectors.keys().enumerate() { (section::detector(results, run, index, name)) }
        (ledger::ledger(results))
        (warnings(results))
        (reproduce::reproduce(results, run))
        (light::blocks(results))
    };
    let scripts: Vec<&str> = view::SCRIPTS.iter().chain(&SCRIPTS).copied().collect();
    document(
        &Page { title: &results.system, kind: "stray light", class: "", style: view::STYLE, scripts: &scripts },
        &body,
    )
}

/// The system with the ways of its strongest paths.
fn three(drawing: &Drawing) -> Markup {
    html! {
        section.three {
            h2 { "The system, and how the light came" }
            p.note { "A click on a path in the tables below lights up its rays here. Drawn are up to 24 rays of each of the strongest paths, as they were traced." }
            (view::stage(drawing))
            figure.pathmap id="pathmap" hidden { h3 {} canvas width="256" height="256" {} figcaption.note {} }
        }
    }
}

/// The page of a comparison.
pub fn comparison(comparison: &Comparison, run: &RunInfo) -> String {
    whole(&comparison.system, &compare::body(comparison, run))
}

/// The page of critical and illuminated objects.
pub fn objects(found: &Objects, run: &RunInfo) -> String {
    whole(&found.system, &objects::body(found, run))
}

/// The page of a study of ghosts.
pub fn ghosts(ghosts: &Ghosts, run: &RunInfo) -> String {
    whole(&ghosts.system, &ghosts::body(ghosts, run))
}

fn whole(system: &str, body: &Markup) -> String {
    document(&Page { title: system, kind: "stray light", class: "", style: "", scripts: &[] }, body)
}

/// What frames the body of a page.
struct Page<'a> {
    title: &'a str,
    kind: &'a str,
    /// Of the body's one block.
    class: &'a str,
    /// Added to that of all pages.
    style: &'a str,
    /// Run in this order in one scope; empty: no script may run at all.
    scripts: &'a [&'a str],
}

/// A page that asks the network for nothing: its browser is told to refuse.
fn document(page: &Page, body: &Markup) -> String {
    let scripts = if page.scripts.is_empty() { "" } else { "; script-src 'unsafe-inline'" };
    let policy = format!("default-src 'none'; img-src data:; style-src 'unsafe-inline'{scripts}");
    html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta name="viewport" content="width=device-width, initial-scale=1";
                meta name="color-scheme" content="light dark";
                meta http-equiv="Content-Security-Policy" content=(policy);
                title { (page.title) " – " (page.kind) }
                style { (PreEscaped(STYLE)) (PreEscaped(page.style)) }
            }
            body {
                main class=(page.class) { (body) }
                @if !page.scripts.is_empty() { script type="module" { (PreEscaped(page.scripts.join("\n"))) } }
            }
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

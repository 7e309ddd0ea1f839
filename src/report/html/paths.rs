//! The paths by which light reached a detector, strongest first.

use super::number::{estimate, plain, tone};
use crate::report::digest;
use crate::report::measured::grouped;
use crate::tally::results::{PathResult, Results};
use maud::{Markup, html};

/// Rows per detector, and of them those that are shown at first; all are in paths.csv.
const ROWS: usize = 200;
const SHOWN: usize = 25;

pub fn table(results: &Results, detector: &str) -> Markup {
    let strongest = digest::strongest(results, detector, ROWS);
    html! {
        @if !strongest.rows.is_empty() {
            h3 { "Strongest paths" }
            div.tools {
                input type="search" data-filter="" placeholder="filter: Barrel, ghost, Lens_2:R" aria-label="Filter paths";
                @if strongest.rows.len() > SHOWN { button type="button" data-more="" { "show all " (strongest.rows.len()) } }
                span.note data-found="" role="status" {}
            }
            table.paths data-sortable="" {
                thead { tr {
                    th {} (head("class", "Class", false)) (head("flux", "Flux", true)) th.right { "Share" } (head("rays", "Rays", true))
                    (head("length", "Optical path", true)) (head("peak", "Peak", true))
                } }
                @for (index, (path, share)) in strongest.rows.iter().enumerate() { (row(index + 1, path, share)) }
                tbody.last {
                    @if let Some((flux, share, sequences)) = &strongest.other {
                        tr { td {} td { "other" } td.right { (estimate(*flux, "W")) } td.right { (share) " %" } td colspan="3" {} }
                        tr.sequence { td {} td colspan="6" {
                            @if *sequences > 0 { (sequences) " more sequences are in paths.csv. " }
                            "The error is an upper bound: the sum of the errors."
                        } }
                    }
                }
                tfoot { tr { th {} th { "All paths" } td.right { (total(results, detector)) } td.right { "100 %" } td colspan="3" {} } }
            }
            p.note { "Events: " b.event.t { "T" } " transmitted, " b.event.r { "R" } " reflected, " b.event.s { "S" } " scattered, "
                b.event.v { "V" } " scattered in a medium. Peak: largest irradiance on a grid of " (results.path_grid) " × " (results.path_grid)
                " cells. Rays: source rays that contributed." }
        }
    }
}

/// A column that can be sorted by.
fn head(key: &str, title: &str, right: bool) -> Markup {
    html! { th.right[right] { button type="button" data-sort=(key) { (title) } } }
}

fn total(results: &Results, detector: &str) -> Markup {
    html! { @if let Some(detector) = results.detectors.get(detector) { (estimate(detector.flux_w, "W")) } }
}

fn row(rank: usize, path: &PathResult, share: &str) -> Markup {
    html! {
        tbody.more[rank > SHOWN] tabindex="0" data-detector=(path.detector) data-path=(path.sequence) data-class=(path.class)
            data-flux=(path.flux_w.mean) data-rays=(path.rays) data-length=(path.optical_path_m) data-peak=(path.peak_w_m2) {
            tr {
                td.rank { (rank) }
                td { span.swatch style=(format!("background:{}", tone(&path.class))) {} (path.class) }
                td.right { (estimate(path.flux_w, "W")) }
                td.right { (share) " %" }
                td.right { (grouped(path.rays, "\u{202f}")) @if path.rays < 30 { span.few title="fewer than 30 source rays: not resolved" { " !" } } }
                td.right { (plain(1e3 * path.optical_path_m, "mm")) }
                td.right { (plain(path.peak_w_m2, "W/m2")) }
            }
            tr.sequence { td {} td colspan="6" { (sequence(&path.sequence)) } }
        }
    }
}

/// Surfaces with their events, in the order of the light.
pub fn sequence(text: &str) -> Markup {
    html! {
        @for (index, step) in text.split(" > ").enumerate() {
            @if index > 0 { span.then { " › " } }
            span.step {
                @match step.rsplit_once(':') {
                    Some((surface, event)) => { (surface) " " b class=(format!("event {}", kind(event))) { (event) } },
                    None => { (step) },
                }
            }
        }
    }
}

fn kind(event: &str) -> &'static str {
    match event.chars().next() {
        Some('T') => "t",
        Some('R') => "r",
        Some('S') => "s",
        _ => "v",
    }
}

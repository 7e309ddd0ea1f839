//! objects.html: what a detector sees, what the sources light, what is both, what glows.

use super::ledger::gauge;
use super::number::{estimate, limit, plain};
use super::reproduce;
use crate::report::measured::grouped;
use crate::report::objects::heading;
use crate::study::objects::{Objects, View, Warmth, Way, Ways};
use crate::tally::results::{Estimate, RunInfo};
use maud::{Markup, html};

/// Rows of a table; the files have all of them.
const LISTED: usize = 40;

/// Colours of the bars: what is seen, what is lit, what is both, what glows.
const SEEN: &str = "#1f5c7a";
const LIT: &str = "#d9822b";
const BOTH: &str = "#a3243b";
const WARM: &str = "#c0632b";

/// Width of the bars beside many columns of numbers.
const GAUGE: &str = "width:11%";

/// The whole body.
pub fn body(found: &Objects, run: &RunInfo) -> Markup {
    html! {
        header {
            p.overline { "Critical and illuminated objects" }
            h1 { (found.system) }
            (facts(found, run))
        }
        @for view in &found.views {
            section.detector {
                h2 { (view.detector) }
                (first_order(view, found))
                (seen(view))
                @if let Some(warmth) = &view.thermal { (thermal(warmth)) }
            }
        }
        (lit(found))
        @if !found.warnings.is_empty() {
            section.warnings { h2 { "Warnings" } ol { @for warning in &found.warnings { li { (warning) } } } }
        }
        (reproduce::repeat(run, &found.inputs))
    }
}

fn facts(found: &Objects, run: &RunInfo) -> Markup {
    let gap = "\u{202f}";
    html! {
        dl.facts {
            div { dt { "Rays of each trace" } dd { (grouped(found.rays, gap)) } }
            div { dt { "Batches" } dd { (grouped(found.batches, gap)) " × " (grouped(found.batch_rays, gap)) } }
            div { dt { "Seed" } dd { (found.seed) } }
            div { dt { "Time" } dd { (format!("{:.1} s", run.seconds)) small { " on " (run.threads) " threads" } } }
        }
    }
}

fn first_order(view: &View, found: &Objects) -> Markup {
    let largest = view.first_order.first().map_or(0.0, |first| first.flux_w.mean);
    html! {
        @if !found.lit.is_empty() {
            h3 { "Paths of first order: lit and seen, directly or through the optics" }
            @if view.first_order.is_empty() { p { "Nothing that scatters is both." } }
            @else {
                table.parts {
                    thead { tr { th { "Object" } th.right { "Lit" } th.right { "Seen" } th.right { "If it scattered evenly" } th {} } }
                    tbody { @for first in view.first_order.iter().take(LISTED) { tr {
                        td { (first.object) }
                        td.right { (estimate(first.lit_w, "W")) }
                        td.right { (estimate(first.seen_sr, "sr")) }
                        td.right { (estimate(first.flux_w, "W")) }
                        td.gauge { (gauge(first.flux_w.mean / largest, BOTH)) }
                    } } }
                }
                (more(view.first_order.len()))
                p.note { "The first are candidates for a baffle, a stop or a better finish. The flux on the detector is a rank, no result: lobes, and that lit and seen "
                    "places of an object may differ, are in a run only." }
            }
        }
    }
}

/// What a table that has room for [`LISTED`] of so many rows leaves out.
fn more(rows: usize) -> Markup {
    html! { @if rows > LISTED { p.note { (rows - LISTED) " more are in objects.csv." } } }
}

fn seen(view: &View) -> Markup {
    let total = |ways: &Ways| ways.values().map(|amount| amount.mean).sum::<f64>();
    let shown: Vec<_> = view.seen.iter().filter(|seen| seen.upper_limit_sr.is_none()).take(LISTED).collect();
    let largest = shown.iter().map(|seen| total(&seen.seen_sr)).fold(total(&view.sky_sr), f64::max);
    let hidden: Vec<&str> =
        view.seen.iter().filter(|seen| seen.upper_limit_sr.is_some()).map(|seen| seen.object.as_str()).collect();
    html! {
        h3 { "What it sees: projected solid angle, sr, weighed with what arrives of the light" }
        table.parts {
            thead { tr { (first_column()) @for way in Way::ALL { th.right { (title(way)) } } th.right { "Absorbs, any way" } th {} } }
            tbody { @for seen in &shown { tr {
                td { (seen.object) }
                (ways(&seen.seen_sr))
                td.right { (cell(seen.absorbed_sr)) }
                td.gauge style=(GAUGE) { (gauge(total(&seen.seen_sr) / largest, SEEN)) }
            } }
            tr { td { "Open sky" } (ways(&view.sky_sr)) td.right { (cell(view.escaped_sr)) } td.gauge style=(GAUGE) { (gauge(total(&view.sky_sr) / largest, SEEN)) } } }
        }
        (more(view.seen.iter().filter(|seen| seen.upper_limit_sr.is_none()).count()))
        p.note { "Flux on the detector = radiance of the object × " (plain(1e6 * view.area_m2, "mm2")) " × solid angle. Of " (plain(view.whole_sr, "sr"))
            ", " (estimate(view.absorbed_sr, "sr")) " end in objects, " (estimate(view.escaped_sr, "sr")) " in the sky; missing " (estimate(view.residual_sr, "sr")) "." }
        (unseen("Not seen", &hidden, view.seen.iter().find_map(|seen| seen.upper_limit_sr), "sr"))
    }
}

fn lit(found: &Objects) -> Markup {
    let total = |ways: &Ways| ways.values().map(|amount| amount.mean).sum::<f64>();
    let shown: Vec<_> = found.lit.iter().filter(|lit| lit.upper_limit_w.is_none()).take(LISTED).collect();
    let largest = shown.iter().map(|lit| total(&lit.flux_w)).fold(0.0, f64::max);
    let dark: Vec<&str> =
        found.lit.iter().filter(|lit| lit.upper_limit_w.is_some()).map(|lit| lit.object.as_str()).collect();
    html! {
        @if !found.lit.is_empty() {
            section.detector {
                h2 { "What the sources light" }
                h3 { "Flux that falls on it, W, of " (plain(found.sources_w, "W")) }
                table.parts {
                    thead { tr { (first_column()) @for way in Way::ALL { th.right { (title(way)) } } th {} } }
                    tbody { @for lit in &shown { tr {
                        td { (lit.object) }
                        (ways(&lit.flux_w))
                        td.gauge style=(GAUGE) { (gauge(total(&lit.flux_w) / largest, LIT)) }
                    } } }
                }
                (more(found.lit.iter().filter(|lit| lit.upper_limit_w.is_none()).count()))
                (unseen("Dark", &dark, found.lit.iter().find_map(|lit| lit.upper_limit_w), "W"))
            }
        }
    }
}

fn thermal(warmth: &Warmth) -> Markup {
    let largest = warmth.objects.first().map_or(0.0, |warm| warm.flux_w.mean);
    let [from, to] = warmth.band_m.map(|m| plain(1e6 * m, ""));
    html! {
        h3 { "What warm objects send to it, " (from) " to " (to) " µm" }
        table.parts {
            thead { tr { th { "Object" } th.right { "Temperature" } th.right { "Flux" } th.right { "Photons" } th {} } }
            tbody { @for warm in warmth.notable().take(LISTED) { tr {
                td { (warm.object) }
                td.right { (plain(warm.temperature_k, "K")) }
                @if let Some(most) = warm.upper_limit_w { td.right { (limit(most, "W")) } td.right { "–" } }
                @else { td.right { (estimate(warm.flux_w, "W")) } td.right { (estimate(warm.photons_per_s, "/s")) } }
                td.gauge { (gauge(warm.flux_w.mean / largest, WARM)) }
            } } }
            tfoot { tr { th { "All" } td {} td.right { (estimate(warmth.flux_w, "W")) } td.right { (estimate(warmth.photons_per_s, "/s")) } td {} } }
        }
        (more(warmth.notable().count()))
    }
}

/// The heading of the names, which many columns of numbers would squeeze.
fn first_column() -> Markup {
    html! { th style="min-width:8.5em" { "Object" } }
}

fn title(way: Way) -> String {
    let text = heading(way);
    text[..1].to_uppercase() + &text[1..]
}

fn ways(ways: &Ways) -> Markup {
    html! { @for way in Way::ALL { td.right { (cell(ways.get(&way).copied().unwrap_or_default())) } } }
}

fn cell(amount: Estimate) -> Markup {
    html! { @if amount == Estimate::default() { "–" } @else { (estimate(amount, "")) } }
}

fn unseen(what: &str, objects: &[&str], most: Option<f64>, unit: &str) -> Markup {
    let more = objects.len().saturating_sub(LISTED);
    html! {
        @if let Some(most) = most {
            p.note { (what) ", each " (limit(most, unit)) ": " (objects[..objects.len().min(LISTED)].join(", "))
                @if more > 0 { " and " (more) " more" } "." }
        }
    }
}

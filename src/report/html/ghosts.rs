//! ghosts.html: which pair of surfaces makes how much, the worst as maps, all in a table.

use super::figure::{self, Figure};
use super::number::{estimate, limit, plain};
use super::reproduce;
use crate::report::ghosts::{View, shown, views};
use crate::report::measured::grouped;
use crate::report::picture::{Field, Palette, Scale};
use crate::study::ghost::{Ghost, Ghosts};
use crate::tally::results::{Estimate, RunInfo};
use maud::{Markup, html};

/// Ghosts that are drawn.
const DRAWN: usize = 9;

/// Rows of the table; the file has them all.
const LISTED: usize = 60;

/// The whole body.
pub fn body(ghosts: &Ghosts, run: &RunInfo) -> Markup {
    html! {
        header {
            p.overline { "Ghosts" }
            h1 { (ghosts.system) }
            (facts(ghosts, run))
        }
        @for view in views(ghosts) {
            section.detector {
                h2 { (view.detector) ", lit by " (view.source) }
                (heading(&view))
                (matrix(ghosts, &view))
                (maps(&view))
                (table(&view))
                (dark(&view))
            }
        }
        p.note { "A ghost is light that surfaces have reflected which should not have: those that can transmit, and what the detector itself watches. Every sequence is traced with the exact "
            "coefficients of all surfaces, without chance: its error, one standard error of the mean over " (ghosts.batches) " batches, is that of vignetting alone. Scattered light is not in it. "
            "Focus: where the rms radius of the bundle is least, along its mean ray from the detector; positive beyond the detector. Peak: the brightest bin of the detector’s map; a maximum is biased upward by noise." }
        @if !ghosts.warnings.is_empty() {
            section.warnings { h2 { "Warnings" } ol { @for warning in &ghosts.warnings { li { (warning) } } } }
        }
        (reproduce::repeat(run, &ghosts.inputs))
    }
}

fn facts(ghosts: &Ghosts, run: &RunInfo) -> Markup {
    let gap = "\u{202f}";
    let lit = ghosts.ghosts.iter().filter(|ghost| ghost.rays > 0).count();
    html! {
        dl.facts {
            div { dt { "Reflections" } dd { "up to " (ghosts.order) } }
            div { dt { "Sequences" } dd { (ghosts.ghosts.len()) small { ", " (lit) " arrive" } } }
            div { dt { "Source rays" } dd { (grouped(ghosts.rays, gap)) } }
            div { dt { "Batches" } dd { (grouped(ghosts.batches, gap)) " × " (grouped(ghosts.batch_rays, gap)) } }
            div { dt { "Seed" } dd { (ghosts.seed) } }
            div { dt { "Time" } dd { (format!("{:.1} s", run.seconds)) small { " on " (run.threads) " threads" } } }
        }
    }
}

fn heading(view: &View) -> Markup {
    html! {
        @match view.signal {
            Some(signal) => p { "Signal: " (estimate(signal.flux_w, "W")) "." },
            None => p { "No signal arrives." },
        }
    }
}

/// Flux by first (rows) and second (columns) surface, darker where there is more.
fn matrix(ghosts: &Ghosts, view: &View) -> Markup {
    let [first, second] = view.sides(ghosts);
    let pairs = || view.lit.iter().filter(|ghost| ghost.surfaces.len() == 2);
    let scale = Scale::of(pairs().map(|ghost| ghost.flux_w.mean));
    html! {
        @if !first.is_empty() {
            h3 { "Flux in W by surface: rows reflect first, columns second" }
            table.heat {
                thead { tr { th {} @for name in &second { th { span { (name) } } } } }
                tbody { @for one in &first { tr {
                    th { (one) }
                    @for other in &second { (cell(view.pair(one, other), &scale)) }
                } } }
            }
            p.note { "0: light takes that way and nothing of it arrives; blank: there is no such way." }
        }
    }
}

fn cell(ghost: Option<&Ghost>, scale: &Scale) -> Markup {
    html! {
        @match ghost {
            Some(ghost) if ghost.rays > 0 => {
                @let place = scale.place(ghost.flux_w.mean);
                td style=(format!("background:rgba(192,99,43,{:.2})", 0.06 + 0.74 * place)) title=(ghost.surfaces.join(", ")) { (format!("{:.1e}", ghost.flux_w.mean)) }
            },
            Some(_) => td.quiet { "0" },
            None => td {},
        }
    }
}

/// The worst ghosts side by side.
fn maps(view: &View) -> Markup {
    html! {
        @if !view.lit.is_empty() {
            h3 { "Irradiance of the strongest" }
            div.small-maps { @for ghost in view.lit.iter().filter(|ghost| ghost.map.shape != [1, 1]).take(DRAWN) { (small(ghost)) } }
        }
    }
}

fn small(ghost: &Ghost) -> Markup {
    let field = Field::of(&ghost.map);
    let scale = Scale::of(field.lit());
    let title = ghost.surfaces.join(", ");
    html! {
        figure.small {
            h3 { (title) }
            (figure::figure(&Figure {
                field: &field, scale: &scale, palette: Palette::Light, unit: ghost.map.unit, title: &title, longest: 230.0,
            }))
        }
    }
}

fn table(view: &View) -> Markup {
    html! {
        @if !view.lit.is_empty() {
            h3 { "Ghosts by falling flux" }
            table.ghosts {
                thead { tr {
                    th { "Surfaces" } th.right { "Flux, W" } th.right { "Of the signal" } th.right { "Peak, W/m²" }
                    th.right { "Centre, mm" } th.right { "rms radius, mm" } th.right { "Size, mm" } th.right { "Focus, mm" }
                } }
                tbody { @for ghost in view.lit.iter().take(LISTED) { (row(ghost)) } }
            }
            @if view.lit.len() > LISTED { p.note { (view.lit.len() - LISTED) " more are in ghosts.csv." } }
        }
    }
}

fn row(ghost: &Ghost) -> Markup {
    let peak = Estimate { mean: ghost.peak_w_m2.mean, error: ghost.peak_w_m2.error };
    html! {
        tr {
            td.named { (ghost.surfaces.join(" › ")) }
            td.right { (known(Some(ghost.flux_w), 1.0)) }
            td.right { @if let Some(relative) = ghost.relative { (plain(relative.mean, "")) } }
            td.right { (known(Some(peak), 1.0)) }
            td.right { @if let Some([x, y]) = ghost.centroid_m { (format!("{:.3}, {:.3}", 1e3 * x.mean, 1e3 * y.mean)) } }
            td.right { (known(ghost.rms_radius_m, 1e3)) }
            td.right { @if let Some([width, height]) = ghost.size_m { (format!("{:.2} × {:.2}", 1e3 * width, 1e3 * height)) } }
            td.right { @if ghost.parallel { "parallel" } @else { (known(ghost.focus_m, 1e3)) } }
        }
    }
}

fn known(value: Option<Estimate>, factor: f64) -> Markup {
    html! { @if let Some(value) = value { (estimate(shown(value, factor), "")) } }
}

/// What is begun and never arrives.
fn dark(view: &View) -> Markup {
    html! {
        @if let Some(most) = view.limit() {
            p.note { "Of " (view.dark.len()) " more sequences nothing arrives: " (limit(most, "W")) " each, three times the most that one source ray carries along the brightest of them. Their limits are in ghosts.csv." }
        }
    }
}

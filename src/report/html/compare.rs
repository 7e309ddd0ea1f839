//! compare.html: variants against the baseline on one page, in the order of a reader: verdicts, bars, what changed, how to repeat it.

use super::number::{estimate, minus, plain};
use super::{paths, reproduce};
use crate::report::compare::folders;
use crate::report::measured::{grouped, measured};
use crate::study::compare::{Change, Comparison, Shift, VariantResult};
use crate::tally::results::RunInfo;
use maud::{Markup, html};
use std::collections::BTreeMap;

/// Height of a row of the figure, and widths: names, a bar of the baseline's length at least, numbers; its own units.
const ROW: f64 = 30.0;
const NAMES: f64 = 190.0;
const BARS: f64 = 260.0;
const NUMBERS: f64 = 140.0;

/// Surfaces that are listed of a variant.
const SURFACES: usize = 12;

/// The whole body.
pub fn body(comparison: &Comparison, run: &RunInfo) -> Markup {
    let detectors = comparison.variants.first().map(|variant| variant.detectors.keys());
    html! {
        header {
            p.overline { "Comparison of variants" }
            h1 { (comparison.system) }
            (facts(comparison, run))
            @if comparison.interrupted { p.interrupted { "Interrupted: this report holds what was finished." } }
        }
        @for detector in detectors.into_iter().flatten() {
            section.detector {
                h2 { (detector) }
                (figure(comparison, detector))
                (table(comparison, detector))
            }
        }
        p.note { "Errors are one standard error of the mean over " (comparison.batches) " batches. Those of differences and ratios come from batches that are paired "
            "with the baseline’s: the same random numbers, in one trace where shapes and indices are the same." }
        @for (variant, folder) in comparison.variants.iter().zip(folders(comparison)) { (section(variant, &folder)) }
        @if !comparison.warnings.is_empty() {
            section.warnings { h2 { "Warnings" } ol { @for warning in &comparison.warnings { li { (warning) } } } }
        }
        (reproduce::repeat(run, &comparison.inputs))
    }
}

fn facts(comparison: &Comparison, run: &RunInfo) -> Markup {
    let gap = "\u{202f}";
    html! {
        dl.facts {
            div { dt { "Variants" } dd { (comparison.variants.len() - 1) small { " and the baseline, " (comparison.traces) @if comparison.traces == 1 { " trace" } @else { " traces" } } } }
            div { dt { "Source rays" } dd { (grouped(comparison.rays, gap)) } }
            div { dt { "Batches" } dd { (grouped(comparison.batches, gap)) " × " (grouped(comparison.batch_rays, gap)) } }
            div { dt { "Seed" } dd { (comparison.seed) } }
            div { dt { "Time" } dd { (format!("{:.1} s", run.seconds)) small { " on " (run.threads) " threads" } } }
        }
    }
}

/// Bars of stray light and signal against the baseline, with their errors.
fn figure(comparison: &Comparison, detector: &str) -> Markup {
    let stray: Vec<Option<&Change>> = comparison.variants.iter().map(|v| Some(&v.detectors[detector].stray)).collect();
    let signal: Vec<Option<&Change>> =
        comparison.variants.iter().map(|v| v.detectors[detector].signal.as_ref()).collect();
    let names: Vec<&str> = comparison.variants.iter().map(|v| v.name.as_str()).collect();
    let both = signal.iter().any(Option::is_some);
    let panel = BARS + NUMBERS;
    let (width, height) = (NAMES + panel * if both { 2.0 } else { 1.0 }, ROW * (names.len() as f64 + 1.2));
    html! {
        figure.bars {
            svg viewBox=(format!("0 0 {width:.0} {height:.0}")) style=(format!("max-width:{width:.0}px")) role="img"
                aria-label=(format!("Stray light and signal on {detector}, relative to the baseline")) {
                @for (row, name) in names.iter().enumerate() {
                    text.axis x=(px(NAMES - 14.0)) y=(px(ROW * (row as f64 + 1.62))) text-anchor="end" { (short(name)) }
                }
                (bars("Stray light / baseline", &stray, NAMES, "#6a4c93"))
                @if both { (bars("Signal / baseline", &signal, NAMES + panel, "#1f5c7a")) }
            }
        }
    }
}

/// One panel, its left edge at `left`.
fn bars(title: &str, changes: &[Option<&Change>], left: f64, colour: &str) -> Markup {
    let ratio = |change: &Option<&Change>| change.and_then(|change| change.ratio);
    let most = changes.iter().filter_map(ratio).map(|r| r.mean + r.error).fold(1.0, f64::max);
    let scale = BARS / most;
    let bottom = ROW * (changes.len() as f64 + 1.0);
    html! {
        g transform=(format!("translate({left:.0} 0)")) {
            text.axis x="0" y=(px(0.5 * ROW)) { (title) }
            @for (row, change) in changes.iter().enumerate() {
                @let top = ROW * (row as f64 + 1.0);
                @if let Some(found) = ratio(change) {
                    @let (length, error) = (found.mean * scale, found.error * scale);
                    rect x="0" y=(px(top + 7.0)) width=(px(length.max(0.5))) height=(px(ROW - 14.0)) fill=(if row == 0 { "#aab1b9" } else { colour }) {}
                    @if row > 0 {
                        line x1=(px(length - error)) x2=(px(length + error)) y1=(px(top + 0.5 * ROW)) y2=(px(top + 0.5 * ROW)) {}
                        @for end in [length - error, length + error] {
                            line x1=(px(end)) x2=(px(end)) y1=(px(top + 0.5 * ROW - 4.0)) y2=(px(top + 0.5 * ROW + 4.0)) {}
                        }
                    }
                    text x=(px(length.max(length + error) + 10.0)) y=(px(top + 0.62 * ROW)) {
                        @if row == 0 { "1" } @else { (minus(&measured(found.mean, found.error))) }
                    }
                }
            }
            line.one x1=(px(scale)) x2=(px(scale)) y1=(px(ROW)) y2=(px(bottom)) stroke-dasharray="2 3" {}
            line x1="0" x2="0" y1=(px(ROW)) y2=(px(bottom)) {}
        }
    }
}

fn table(comparison: &Comparison, detector: &str) -> Markup {
    let signal = comparison.variants.iter().any(|variant| variant.detectors[detector].signal.is_some());
    html! {
        table.classes {
            thead { tr {
                th { "Variant" } th.right { "Stray light" }
                @if signal { th.right { "Signal" } }
                th.right { "Stray − baseline" } th { "Verdict" }
            } }
            tbody { @for (number, variant) in comparison.variants.iter().enumerate() {
                @let found = &variant.detectors[detector];
                tr {
                    td { a href=(format!("#variant-{}", variant.name)) { (variant.name) } }
                    td.right { (estimate(found.stray.flux_w, "W")) }
                    @if signal { td.right { @if let Some(signal) = &found.signal { (estimate(signal.flux_w, "W")) } } }
                    td.right { @if number > 0 { (estimate(found.stray.difference_w, "W")) } }
                    td { @if number > 0 { (found.verdict) } }
                }
            } }
        }
    }
}

/// What one variant is, and what it changes.
fn section(variant: &VariantResult, folder: &str) -> Markup {
    html! {
        section.detector id=(format!("variant-{}", variant.name)) {
            h2 { (variant.name) }
            p.note { a href=(format!("{folder}/report.html")) { "The full report of " (variant.name) ", with its maps" }
                @if !variant.together { ". Other shapes or indices than the baseline: a run of its own, paired by batch." } }
            @if !variant.parameters.is_empty() {
                p.note { "Parameters: " @for (name, value) in &variant.parameters { (name) " = " (value) "; " } }
            }
            @if !variant.surfaces.is_empty() {
                h3 { "What is different" }
                table.parts {
                    thead { tr { th { "Finish" } th { "Surfaces" } } }
                    tbody { @for (finish, parts) in finishes(variant) { tr { td { (finish) } td { (parts) } } } }
                }
            }
            (shifts("Paths that changed most", "Path", &variant.paths))
            (shifts("Absorbed, where it changed most", "Surface", &variant.absorbed))
        }
    }
}

/// Finishes that a variant has otherwise, and the surfaces that have them.
fn finishes(variant: &VariantResult) -> Vec<(&str, String)> {
    let mut by_finish: BTreeMap<&str, Vec<&str>> = BTreeMap::new();
    for (part, finish) in &variant.surfaces {
        by_finish.entry(finish).or_default().push(part);
    }
    let listed = |parts: Vec<&str>| {
        let more = if parts.len() > SURFACES { format!(" and {} more", parts.len() - SURFACES) } else { String::new() };
        parts[..parts.len().min(SURFACES)].join(", ") + &more
    };
    by_finish.into_iter().map(|(finish, parts)| (finish, listed(parts))).collect()
}

fn shifts(title: &str, column: &str, shifts: &[Shift]) -> Markup {
    html! {
        @if !shifts.is_empty() {
            h3 { (title) }
            table.parts {
                thead { tr { th { (column) } th.right { "Baseline" } th.right { "Variant" } th.right { "Difference" } } }
                tbody { @for shift in shifts { tr {
                    td { (paths::sequence(&shift.label)) }
                    td.right { (plain(shift.baseline_w, "W")) }
                    td.right { (plain(shift.variant_w, "W")) }
                    td.right { (estimate(shift.difference_w, "W")) }
                } } }
            }
        }
    }
}

/// A name that fits beside its bar.
fn short(name: &str) -> String {
    const MOST: usize = 26;
    if name.chars().count() <= MOST { name.into() } else { name.chars().take(MOST - 1).chain(['…']).collect() }
}

fn px(length: f64) -> String {
    format!("{length:.1}")
}

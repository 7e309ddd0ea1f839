//! How a number became known: its error against the batches, which should fall as N^-1/2, and whether the two halves of the run agree.

use super::number::estimate;
use crate::report::digest;
use crate::report::measured::grouped;
use crate::report::picture::superscript;
use crate::tally::results::{DetectorResult, Estimate, Results, RunInfo, Stage};
use maud::{Markup, html};

/// Of the plot, its own units.
const WIDTH: f64 = 420.0;
const HEIGHT: f64 = 210.0;
const LEFT: f64 = 62.0;
const BOTTOM: f64 = 40.0;

pub fn convergence(results: &Results, run: &RunInfo, detector: &DetectorResult) -> Markup {
    let stages: Vec<&Stage> = detector.convergence.stages.iter().filter(|stage| relative(stage.flux_w) > 0.0).collect();
    let Some(last) = stages.last() else { return html! {} };
    let merit = |stage: &Stage| {
        let error = relative(stage.flux_w) / relative(last.flux_w);
        last.batches as f64 / (stage.batches as f64 * error * error)
    };
    html! {
        details.convergence {
            summary { "How it became known" }
            div.pair {
                div {
                    table.thin {
                        thead { tr { th.right { "Source rays" } th.right { "Flux" } th.right { "Relative error" } th.right { "Figure of merit, of the last" } } }
                        tbody { @for stage in &stages { tr {
                            td.right { (grouped(stage.batches * results.batch_rays, "\u{202f}")) }
                            td.right { (estimate(stage.flux_w, "W")) }
                            td.right { (format!("{:.2} %", 100.0 * relative(stage.flux_w))) }
                            td.right { (format!("{:.2}", merit(stage))) }
                        } } }
                    }
                    p.verdict.good[agreement(detector) <= 3.0].bad[agreement(detector) > 3.0] { (halves(detector)) }
                    @if let Some(merit) = digest::merit(detector, run) { p.verdict.plain { (merit) "." } }
                    @if let Some(largest) = digest::largest(detector) { p.verdict.plain { (largest) "." } }
                }
                figure.small { (plot(&stages, last, results.batch_rays)) }
            }
        }
    }
}

fn relative(flux: Estimate) -> f64 {
    if flux.mean > 0.0 { flux.error / flux.mean } else { 0.0 }
}

/// Difference of the two halves of the run over its error.
fn agreement(detector: &DetectorResult) -> f64 {
    let [first, second] = detector.convergence.halves_w;
    let error = first.error.hypot(second.error);
    if error > 0.0 { (first.mean - second.mean).abs() / error } else { 0.0 }
}

fn halves(detector: &DetectorResult) -> String {
    if detector.convergence.halves_w.iter().any(|half| half.error <= 0.0) {
        return "The run is too short for a comparison of its halves.".into();
    }
    let sigma = agreement(detector);
    let verb = if sigma <= 3.0 { "agree" } else { "do not agree" };
    format!("The two halves of the run {verb}: {sigma:.1} σ apart.")
}

/// Relative error against source rays, both logarithmic, with the line of N^-1/2 through the last.
fn plot(stages: &[&Stage], last: &Stage, batch_rays: u64) -> Markup {
    let rays = |stage: &Stage| (stage.batches * batch_rays) as f64;
    let ends = [rays(stages[0]).log10(), rays(last).log10()];
    let width = (ends[1] - ends[0]).max(0.3);
    let law = |power: f64| relative(last.flux_w).log10() - 0.5 * (power - ends[1]);
    let errors = || stages.iter().map(|stage| relative(stage.flux_w).log10()).chain([law(ends[0]), law(ends[1])]);
    let low = errors().fold(f64::INFINITY, f64::min) - 0.15;
    let high = errors().fold(f64::NEG_INFINITY, f64::max) + 0.15;
    let x = |power: f64| LEFT + (WIDTH - LEFT - 16.0) * (power - ends[0]) / width;
    let y = |power: f64| 10.0 + (HEIGHT - BOTTOM - 10.0) * (high - power) / (high - low);
    let decades = |from: f64, to: f64| (from.ceil() as i32..=to.floor() as i32).collect::<Vec<_>>();
    html! {
        svg viewBox=(format!("0 0 {WIDTH} {HEIGHT}")) role="img" aria-label="Relative error against source rays" {
            rect.frame x=(LEFT) y="10" width=(WIDTH - LEFT - 16.0) height=(HEIGHT - BOTTOM - 10.0) {}
            line x1=(px(x(ends[0]))) x2=(px(x(ends[1]))) y1=(px(y(law(ends[0])))) y2=(px(y(law(ends[1])))) stroke-dasharray="3 3" {}
            @for stage in stages {
                circle.dot cx=(px(x(rays(stage).log10()))) cy=(px(y(relative(stage.flux_w).log10()))) r="3.2" {}
            }
            @for power in decades(ends[0], ends[1]) {
                text x=(px(x(f64::from(power)))) y=(HEIGHT - BOTTOM + 17.0) text-anchor="middle" { "10" (superscript(power)) }
            }
            @for power in decades(low, high) {
                text x=(LEFT - 7.0) y=(px(y(f64::from(power)) + 4.0)) text-anchor="end" { "10" (superscript(power)) }
            }
            text.axis x=(px(0.5 * (LEFT + WIDTH))) y=(HEIGHT - 4.0) text-anchor="middle" { "source rays; dashed: N" (superscript(-1)) "ᐟ²" }
            text.axis transform=(format!("translate(14 {:.0}) rotate(-90)", 0.5 * (HEIGHT - BOTTOM))) text-anchor="middle" { "relative error" }
        }
    }
}

fn px(length: f64) -> String {
    format!("{length:.1}")
}

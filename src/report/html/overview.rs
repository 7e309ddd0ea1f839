//! The first screen: what was found, and whether it can be trusted.

use super::number::{estimate, limit, tone};
use super::sheet;
use crate::report::cause::is_meant;
use crate::report::digest::{self, Verdict};
use crate::report::measured::grouped;
use crate::tally::results::{DetectorResult, Results, RunInfo};
use maud::{Markup, html};

/// Part of the stray light from which a class of it is in the legend; all are in the table of its detector.
const LISTED: f64 = 1e-4;

pub fn overview(results: &Results, run: &RunInfo) -> Markup {
    let subject = sheet::subject(results);
    let found = subject.and_then(|name| results.detectors.get(name));
    let cards = || results.detectors.iter().enumerate().filter(|(_, (name, _))| Some(name.as_str()) != subject);
    html! {
        section.sheet {
            header {
                p.overline { "Stray-light report" }
                h1 { (results.system) }
                (facts(results, run))
                @if run.interrupted { p.interrupted { "Interrupted: this report holds the batches that were finished." } }
            }
            (sheet::requirements(results))
            @if let Some((name, found)) = subject.zip(found) {
                (sheet::sentence(results, name))
                (card(results.detectors.keys().position(|other| other == name).unwrap_or(0), name, found))
                (sheet::pictures(results, name))
                (sheet::strongest(results, name))
            }
            (sheet::assumed(results))
            (sheet::health(results))
        }
        @for (index, (name, detector)) in cards() { (card(index, name, detector)) }
        (trust(results))
    }
}

fn facts(results: &Results, run: &RunInfo) -> Markup {
    let gap = "\u{202f}";
    let rounded = results.rays != results.rays_requested && !run.interrupted;
    html! {
        dl.facts {
            div { dt { "Source rays" } dd { (grouped(results.rays, gap))
                @if rounded { small { " " (grouped(results.rays_requested, gap)) " requested, whole batches traced" } } } }
            div { dt { "Batches" } dd { (grouped(results.batches, gap)) " × " (grouped(results.batch_rays, gap)) } }
            div { dt { "Seed" } dd { (results.seed) } }
            div { dt { "Time" } dd { (duration(run.seconds)) small { " on " (run.threads) " threads" } } }
        }
    }
}

fn duration(seconds: f64) -> String {
    match seconds {
        s if s < 120.0 => format!("{s:.1} s"),
        s if s < 7200.0 => format!("{:.0} min", s / 60.0),
        s => format!("{:.1} h", s / 3600.0),
    }
}

fn card(index: usize, name: &str, detector: &DetectorResult) -> Markup {
    html! {
        section.card {
            div.key {
                h2 { a href=(format!("#detector-{index}")) { (name) } }
                @if let Some(flux) = detector.upper_limit_w {
                    p.total { (limit(flux, "W")) }
                } @else {
                    p.total { (estimate(detector.flux_w, "W")) }
                }
                p.label { "flux on the detector" }
                (ratio(detector))
            }
            div.light {
                (bar(detector))
                (said(&digest::resolution(detector)))
                @if detector.upper_limit_w.is_none() { (said(&digest::pixels(detector))) }
            }
        }
    }
}

/// Stray against signal, in one line.
fn ratio(detector: &DetectorResult) -> Markup {
    let stray = &detector.stray;
    html! {
        @if detector.upper_limit_w.is_none() {
            dl.ratio {
                @if let Some(signal) = stray.signal_w { div { dt { "Signal" } dd { (estimate(signal, "W")) } } }
                div { dt { "Stray" } dd { @if stray.flux_w.mean > 0.0 { (estimate(stray.flux_w, "W")) } @else { (limit(stray.upper_limit_w, "W")) } } }
                @if let Some(ratio) = digest::stray_to_signal(detector) {
                    div.strong { dt { "Stray / signal" } dd { (estimate(ratio, "")) } }
                }
                @for (what, value, unit) in digest::counted(detector) { div { dt { (what) } dd { (estimate(value, unit)) } } }
            }
        }
    }
}

/// Signal and stray as one bar; below it stray light alone, drawn to full width, by class.
fn bar(detector: &DetectorResult) -> Markup {
    let classes = digest::classes(detector);
    let stray = detector.stray.flux_w.mean;
    let total: f64 = classes.iter().map(|class| class.1.mean.max(0.0)).sum();
    let enlarged = total > 0.0 && stray > 0.0 && stray < 0.5 * total;
    html! {
        @if total > 0.0 {
            figure.bar {
                (strip(&classes, total, |_| true))
                @if enlarged {
                    (funnel(100.0 * (1.0 - stray / total)))
                    (strip(&classes, stray, |class| !is_meant(class)))
                }
                figcaption {
                    @if enlarged { p.note { "Lower strip: stray light alone, × " (crate::report::measured::measured(digest::rounded(total / stray), 0.0)) "." } }
                    ul.legend {
                        @for (class, _, share) in classes.iter().filter(|class| is_meant(class.0) || class.1.mean >= LISTED * stray) {
                            li { span.swatch style=(format!("background:{}", tone(class))) {} (class) " " span.share { (share) " %" } }
                        }
                    }
                }
            }
        }
    }
}

type Class<'a> = (&'a str, crate::tally::results::Estimate, String);

fn strip(classes: &[Class], whole: f64, shown: impl Fn(&str) -> bool) -> Markup {
    html! {
        div.strip {
            @for (class, flux, share) in classes.iter().filter(|class| shown(class.0) && class.1.mean > 0.0) {
                span style=(format!("width:{:.4}%;background:{}", 100.0 * flux.mean / whole, tone(class))) title=(format!("{class}: {share} %")) {}
            }
        }
    }
}

/// From the stray end of the upper strip to the whole lower one; `from` in % of the width.
fn funnel(from: f64) -> Markup {
    html! {
        svg.funnel viewBox="0 0 100 10" preserveAspectRatio="none" aria-hidden="true" {
            path d=(format!("M{:.3} 0 L100 0 L100 10 L0 10 Z", from.min(99.7))) {}
        }
    }
}

/// What holds for the whole run.
fn trust(results: &Results) -> Markup {
    html! {
        div.trust {
            @if let Some(guidance) = &results.importance { p.verdict.plain { "Light was " (digest::guidance(guidance)) "." } }
            p.verdict.plain { "Errors are one standard error of the mean over " (results.batches) " batches." }
        }
    }
}

pub fn said(verdict: &Verdict) -> Markup {
    html! { p.verdict.good[verdict.good].bad[!verdict.good] { (verdict.text) } }
}

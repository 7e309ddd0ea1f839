//! The first screen, one sheet of A4: the answer, its cause, where the light fell and how it came, what is assumed, whether it can be trusted.

use super::cutaway::cutaway;
use super::figure::{self, Figure};
use super::number::{estimate, limit, minus, plain, tone};
use super::paths::sequence;
use super::section::stray_map;
use crate::report::cause::{causes, top};
use crate::report::digest;
use crate::report::measured::measured;
use crate::report::picture::{Field, Palette, Scale};
use crate::report::text::shortened;
use crate::tally::drawing::Way;
use crate::tally::required::Verdict;
use crate::tally::results::{DetectorResult, RequirementResult, Results};
use maud::{Markup, html};

/// Paths on the sheet; the rest is one row.
const PATHS: usize = 5;

/// The detector that the sheet is about: that of the worst requirement, else the first on which stray light fell beside a signal, else the
/// first with light.
pub fn subject(results: &Results) -> Option<&str> {
    let worst = results.requirements.iter().max_by(|a, b| {
        let (a, b) = (&a.required, &b.required);
        a.verdict.cmp(&b.verdict).then(b.margin.total_cmp(&a.margin))
    });
    let lit = |test: &dyn Fn(&DetectorResult) -> bool| {
        results.detectors.iter().find(|(_, found)| test(found)).map(|(name, _)| name.as_str())
    };
    let mapped = |name: &str| results.maps.iter().any(|map| map.detector == name && map.unit == "W/m2");
    worst
        .map(|requirement| requirement.detector.as_str())
        .or_else(|| lit(&|found| found.stray.to_signal.is_some_and(|ratio| ratio.mean > 0.0)))
        .or_else(|| {
            results
                .detectors
                .iter()
                .find(|(name, found)| found.flux_w.mean > 0.0 && mapped(name))
                .map(|(name, _)| name.as_str())
        })
        .or_else(|| lit(&|found| found.flux_w.mean > 0.0))
        .or_else(|| lit(&|_| true))
}

/// What is required, and whether it holds.
pub fn requirements(results: &Results) -> Markup {
    html! {
        @if results.requirements.is_empty() {
            p.note.open { "Nothing is required of this system: with " code { "requirements: {..}" } " in its file, PASS or FAIL stands here." }
        } @else {
            table.verdicts {
                thead { tr { th { "Requirement" } th.right { "Found" } th.right { "Limit" } th.right { "Margin" } th.right { "Verdict" } } }
                tbody { @for row in &results.requirements { (requirement(row)) } }
            }
        }
    }
}

fn requirement(row: &RequirementResult) -> Markup {
    let RequirementResult { required, unit, .. } = row;
    let found = row.value.filter(|value| value.mean > 0.0);
    html! {
        tr {
            td { b { (row.name) } small { " " (row.quantity) " on " (row.detector) } }
            td.right {
                @match found {
                    Some(value) => { (estimate(value, unit)) }
                    None if row.value.is_none() => { "no signal" }
                    None => { (limit(required.limit / required.margin, unit)) }
                }
            }
            td.right { "< " (plain(required.limit, unit)) }
            td.right { @if row.value.is_some() { (factor(required.margin)) } @else { "–" } }
            td.right { (badge(required.verdict)) small.wide { " at " (percent(row.confidence)) } }
        }
    }
}

/// "4.4 ×" of room, or what is too much.
fn factor(margin: f64) -> Markup {
    html! { (plain(digest::rounded(margin), "")) " ×" }
}

fn percent(share: f64) -> String {
    format!("{} %", (1e4 * share).round() / 1e2)
}

/// PASS, FAIL or NOT RESOLVED.
pub fn badge(verdict: Verdict) -> Markup {
    let class = match verdict {
        Verdict::Pass => "badge pass",
        Verdict::NotResolved => "badge open",
        Verdict::Fail => "badge fail",
    };
    html! { span class=(class) { (verdict) } }
}

/// One sentence: what most of the stray light is.
pub fn sentence(results: &Results, name: &str) -> Markup {
    let causes = causes(results, name);
    let share = |share: crate::tally::results::Estimate| minus(&measured(100.0 * share.mean, 100.0 * share.error));
    html! {
        @if let Some(first) = causes.first() {
            p.cause {
                b { (share(first.share)) " %" } " of the stray light on " (name) " is " b { (first.text) }
                @if let Some(second) = causes.get(1).filter(|second| second.share.mean > 0.02) { "; " (share(second.share)) " % is " (second.text) }
                "."
            }
        }
    }
}

/// The worst path in the system, and where stray light fell.
pub fn pictures(results: &Results, name: &str) -> Markup {
    let map = results.maps.iter().find(|map| map.detector == name);
    let worst = results.detectors.get(name).map(|detector| top(results, name, detector, PATHS));
    let ways = worst
        .iter()
        .flat_map(|top| &top.rows)
        .map(|(path, _)| ways(results, name, &path.sequence))
        .find(|ways| !ways.is_empty());
    html! {
        div.two {
            @if let Some(drawing) = &results.drawing {
                figure.cutaway {
                    h3 { @if ways.is_some() { "Section, with a strong path of stray light" } @else { "Section" } }
                    (cutaway(drawing, &ways.unwrap_or_default()))
                }
            }
            @if let Some(map) = map {
                @let (stray, apart) = stray_map(map);
                @let field = Field::of(&stray);
                @let scale = Scale::of(field.lit());
                figure.small {
                    h3 { @if apart { "Stray light on " (name) ", signal excluded" } @else { "Light on " (name) } }
                    (figure::figure(&Figure { field: &field, scale: &scale, palette: Palette::Light, unit: map.unit, title: "Map of stray light", longest: 300.0 }))
                }
            }
        }
    }
}

fn ways<'a>(results: &'a Results, name: &str, sequence: &str) -> Vec<&'a Way> {
    let of = |way: &&Way| way.path.as_ref().is_some_and(|path| path[0] == name && path[1] == sequence);
    results.drawing.iter().flat_map(|drawing| &drawing.ways).filter(of).collect()
}

/// The strongest paths of stray light; shares add up to 100 %.
pub fn strongest(results: &Results, name: &str) -> Markup {
    let Some(detector) = results.detectors.get(name) else { return html! {} };
    let top = top(results, name, detector, PATHS);
    html! {
        @if !top.rows.is_empty() {
            table.top {
                thead { tr { th { "Strongest paths of stray light" } th.right { "Flux" } th.right { "Share" } } }
                tbody {
                    @for (path, share) in &top.rows {
                        tr { td { span.swatch style=(format!("background:{}", tone(&path.class))) title=(path.class) {} (sequence(&shortened(&path.sequence))) }
                            td.right { (estimate(path.flux_w, "W")) } td.right { (share) " %" } }
                    }
                    @if let Some((flux, share)) = &top.other {
                        tr { td { "other" } td.right { (plain(*flux, "W")) } td.right { (share) " %" } }
                    }
                }
                tfoot { tr { th { "All stray light" } td.right { (estimate(detector.stray.flux_w, "W")) } td.right { "100 %" } } }
            }
        }
    }
}

/// What is taken for granted and left out.
pub fn assumed(results: &Results) -> Markup {
    html! {
        @if !results.assumptions.is_empty() {
            aside.assumed { dl {
                @for [heading, text] in &results.assumptions { div { dt { (heading) } dd { (text) } } }
            } }
        }
    }
}

/// One line, green or red: whether the numbers can be trusted.
pub fn health(results: &Results) -> Markup {
    let doubts: Vec<String> = [digest::closure(&results.ledger_w), digest::losses(&results.ledger_w)]
        .into_iter()
        .filter(|verdict| !verdict.good)
        .map(|verdict| verdict.text)
        .collect();
    let good = results.trusted && doubts.is_empty();
    let warnings = results.warnings.len();
    html! {
        p.health.good[good].bad[!good] {
            @if good { "Sound: " (digest::closure(&results.ledger_w).text) " " (digest::losses(&results.ledger_w).text) }
            @else { "Not to be trusted. " (doubts.join(" ")) }
            @if warnings > 0 { " " a href="#warnings" { (warnings) @if warnings == 1 { " warning" } @else { " warnings" } " to read." } }
        }
    }
}

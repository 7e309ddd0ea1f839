//! pst.html: curves of point source transmittance on one page, in the order of a reader: verdict, curve, sky, numbers, how to repeat.

mod plot;
mod sky;
mod table;

use super::STYLE;
use super::number::{estimate, limit, plain};
use super::sheet::badge;
use crate::report::measured::grouped;
use crate::report::pst::Went;
use crate::study::pst::{Curve, Point, Sweeps, Verdict};
use maud::{DOCTYPE, Markup, PreEscaped, html};

pub use plot::picture as curve_picture;
pub use sky::picture as sky_picture;

/// What this page adds to the style of a report.
const MORE: &str = "
h2 .badge { font-size: 15px; vertical-align: 4px; margin-left: 12px; }
figure.wide svg { display: block; width: 100%; height: auto; } figure.wide { margin: 8px 0 26px; break-inside: avoid; }
.total .badge { font-size: 20px; padding: 6px 14px; } .sky { max-width: 620px; }
.thin .strip { height: 10px; min-width: 90px; }
@media screen and (prefers-color-scheme: dark) { figure.wide svg { background: #fff; border-radius: 4px; } }
";

/// The whole page.
pub fn pst_page(sweeps: &Sweeps, went: &Went) -> String {
    html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta name="viewport" content="width=device-width, initial-scale=1";
                meta http-equiv="Content-Security-Policy" content="default-src 'none'; img-src data:; style-src 'unsafe-inline'";
                title { (sweeps.system) " – point source transmittance" }
                style { (PreEscaped(STYLE)) (PreEscaped(MORE)) }
            }
            body { main {
                header {
                    p.overline { "Point source transmittance" }
                    h1 { (sweeps.system) }
                    (facts(sweeps, went))
                    @if went.interrupted { p.interrupted { "Interrupted: this report holds the rounds that were finished." } }
                }
                @for (index, curve) in sweeps.curves.iter().enumerate() { (card(index, curve)) }
                @for (index, curve) in sweeps.curves.iter().enumerate() { (section(index, curve)) }
                (warnings(sweeps))
                (reproduce(sweeps, went))
            } }
        }
    }
    .into_string()
}

fn facts(sweeps: &Sweeps, went: &Went) -> Markup {
    let rays: u64 = sweeps.curves.iter().map(|curve| curve.rays).sum();
    let directions: usize = sweeps.curves.iter().map(|curve| curve.points.len()).sum();
    let seed = sweeps.curves.first().map_or(0, |curve| curve.seed);
    html! {
        dl.facts {
            div { dt { "Directions" } dd { (directions) } }
            div { dt { "Source rays" } dd { (grouped(rays, "\u{202f}")) } }
            div { dt { "Seed" } dd { (seed) } }
            div { dt { "Time" } dd { (format!("{:.1} s", went.seconds)) small { " on " (went.threads) " threads" } } }
        }
    }
}

/// The answer to the requirement, and where it is tightest.
fn card(index: usize, curve: &Curve) -> Markup {
    let tightest = curve.points.iter().filter_map(|point| Some((point, point.required?)));
    let tightest = tightest.min_by(|a, b| a.1.margin.total_cmp(&b.1.margin));
    let [brightest, faintest] = ends(curve);
    html! {
        section.card {
            div.key {
                h2 { a href=(format!("#sweep-{index}")) { (curve.sweep) " on " (curve.detector) } }
                @match curve.verdict {
                    Some(verdict) => { p.total { (badge(verdict)) } p.label { "stray light against the requirement" } }
                    None => { p.label { "no requirement" } }
                }
            }
            div.light {
                @if let Some((point, required)) = tightest {
                    p.verdict.plain { "Smallest margin: a factor of " (short(required.margin)) " at " (place(curve, point)) "." }
                    p.verdict.plain { (count(curve)) }
                }
                @if let Some(point) = brightest { p.verdict.plain { "Largest PST: " (value(point)) " at " (place(curve, point)) "." } }
                @if let Some(point) = faintest { p.verdict.plain { "Smallest PST: " (value(point)) " at " (place(curve, point)) "." } }
                @if let Some(sky) = &curve.sky {
                    p.verdict.plain { "A uniform sky from " (sky.from_deg) "° to " (sky.to_deg) "° "
                        @if sky.around_deg < 359.9 { "over " (format!("{:.0}°", sky.around_deg)) " of azimuth " }
                        "gives a stray irradiance of " (estimate(sky.stray_sr, "sr")) " × its radiance (" (short(sky.logarithmic_sr)) " with log PST linear between the angles)." }
                }
                p.verdict.plain { "Mean irradiance over " (curve.detector) ", " (plain(1e6 * curve.area_m2, "mm2")) ", over the irradiance across the beam; the image is in it. Requirements are about stray light." }
            }
        }
    }
}

/// Largest and smallest of what arrived.
fn ends(curve: &Curve) -> [Option<&Point>; 2] {
    let lit = || curve.points.iter().filter(|point| point.pst.mean > 0.0);
    let by = |a: &&Point, b: &&Point| a.pst.mean.total_cmp(&b.pst.mean);
    [lit().max_by(by), lit().min_by(by)]
}

fn count(curve: &Curve) -> String {
    let of =
        |verdict: Verdict| curve.points.iter().filter(|p| p.required.is_some_and(|r| r.verdict == verdict)).count();
    format!(
        "Of the directions with a requirement, {} pass, {} fail and {} are not resolved.",
        of(Verdict::Pass),
        of(Verdict::Fail),
        of(Verdict::NotResolved)
    )
}

fn place(curve: &Curve, point: &Point) -> String {
    let azimuth = if curve.cuts().len() > 1 { format!(", azimuth {}°", point.azimuth_deg) } else { String::new() };
    format!("{}°{azimuth}", point.angle_deg)
}

fn value(point: &Point) -> Markup {
    point.upper_limit.map_or_else(|| estimate(point.pst, ""), |upper| limit(upper, ""))
}

/// Three digits are enough for what is compared.
fn short(value: f64) -> Markup {
    plain(format!("{value:.2e}").parse().unwrap_or(value), "")
}

fn section(index: usize, curve: &Curve) -> Markup {
    html! {
        section.detector id=(format!("sweep-{index}")) {
            h2 { (curve.sweep) @if let Some(verdict) = curve.verdict { (badge(verdict)) } }
            figure.wide { (PreEscaped(plot::picture(curve))) }
            @if let Some(sky) = sky::picture(curve) {
                h3 { "As it stands in the sky, seen along the boresight" }
                figure.wide.sky { (PreEscaped(sky)) }
            }
            (table::table(curve))
            p.note { "Errors are one standard error of the mean. Where nothing arrived, the limit is 3 × the largest part that one source ray can carry / N. "
                @if let Some(mask) = &curve.mask { "Limits are those of " (mask) ", with log(limit) linear in the angle between its rows; a verdict has 95 % confidence (one-sided, Student’s t) at each angle, and 30 source rays at least. " }
                "What no source ray has found yet is in no error bar." }
        }
    }
}

fn warnings(sweeps: &Sweeps) -> Markup {
    let all: Vec<&String> = sweeps.curves.iter().flat_map(|curve| &curve.warnings).collect();
    html! {
        @if !all.is_empty() {
            section.warnings id="warnings" { h2 { "Warnings" } ol { @for warning in all { li { (warning) } } } }
        }
    }
}

fn reproduce(sweeps: &Sweeps, went: &Went) -> Markup {
    html! {
        section.reproduce {
            h2 { "Repeat or continue" }
            p { "The same version, inputs, seed and rays give the same bits on any number of threads, at once or in several goes: with more --rays or a smaller --until, what is in the folder is not traced again." }
            pre { (went.command) }
            dl { dt { "Version" } dd { "straylight " (went.version) } dt { "Run" } dd { (went.threads) " threads on " (went.host) } }
            @if !sweeps.parameters.is_empty() {
                table.inputs {
                    thead { tr { th { "Parameter" } th { "Value" } } }
                    tbody { @for (name, value) in &sweeps.parameters { tr { td { (name) } td { (value) } } } }
                }
            }
            table.inputs {
                thead { tr { th { "Input" } th { "SHA-256" } } }
                tbody { @for (name, hash) in &sweeps.inputs { tr { td { (name) } td.hash { (hash) } } } }
            }
            footer { "Geometric optics: diffraction is outside of this model. Made by straylight " (went.version) "." }
        }
    }
}

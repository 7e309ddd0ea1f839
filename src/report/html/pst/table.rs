//! The numbers of a curve, azimuth by azimuth.

use super::super::number::estimate;
use super::{badge, short, value};
use crate::study::pst::{Curve, GROUPS, Point};
use maud::{Markup, html};

/// Rows shown; the rest is in pst.csv.
const ROWS: usize = 400;

/// Colours of [`GROUPS`], those of the classes elsewhere.
pub const TONES: [&str; 5] = ["#1f5c7a", "#a3243b", "#d9822b", "#6a4c93", "#9479b8"];

pub fn table(curve: &Curve) -> Markup {
    let cuts = curve.cuts();
    let each = (ROWS / cuts.len().max(1)).max(1);
    html! {
        ul.legend { @for (group, tone) in GROUPS.iter().zip(TONES) { li { span.swatch style=(format!("background:{tone}")) {} (group) } } }
        @for cut in &cuts {
            @if cuts.len() > 1 { h3 { "Azimuth " (cut[0].azimuth_deg) "°" } }
            (rows(curve, &cut[..cut.len().min(each)]))
        }
        @if curve.points.len() > ROWS { p.note { "All " (curve.points.len()) " directions are in pst.csv." } }
    }
}

fn rows(curve: &Curve, points: &[Point]) -> Markup {
    let required = curve.mask.is_some();
    let ratio = points.iter().any(|point| point.psrr.is_some());
    html! {
        table.thin {
            thead { tr {
                th.right { "Angle" } th.right { "PST" } th.right { "Error" }
                @if ratio { th.right { "PSRR" } }
                th { "Classes" } th.right { "Rays that came" }
                @if required { th.right { "Limit" } th.right { "Margin" } th { "Stray light" } }
            } }
            tbody { @for point in points {
                tr {
                    td.right { (point.angle_deg) "°" }
                    td.right { (value(point)) }
                    td.right { (relative(point)) }
                    @if ratio { td.right { @if let Some(ratio) = point.psrr { (estimate(ratio, "")) } } }
                    td { (strip(point)) }
                    td.right { (point.contributing) }
                    @if required {
                        @match &point.required {
                            Some(required) => {
                                td.right { (short(required.limit)) } td.right { "× " (short(required.margin)) } td { (badge(required.verdict)) }
                            }
                            None => { td.right.quiet { "none" } td {} td {} }
                        }
                    }
                }
            } }
        }
    }
}

fn relative(point: &Point) -> String {
    let percent = 100.0 * point.pst.error / point.pst.mean;
    if percent.is_finite() { format!("{percent:.1} %") } else { "–".into() }
}

/// What the PST is made of.
fn strip(point: &Point) -> Markup {
    let all: f64 = point.groups.iter().map(|part| part.mean).sum();
    html! {
        @if all > 0.0 {
            div.strip {
                @for ((part, tone), group) in point.groups.iter().zip(TONES).zip(GROUPS) {
                    @if part.mean > 0.0 {
                        span style=(format!("width:{:.4}%;background:{tone}", 100.0 * part.mean / all))
                            title=(format!("{group}: {:.3} %", 100.0 * part.mean / all)) {}
                    }
                }
            }
        }
    }
}

//! One detector: its map, its classes, its paths.

use super::convergence::convergence;
use super::figure::{self, Figure};
use super::ledger::gauge;
use super::light::is_read_out;
use super::number::{estimate, limit, plain, power, ten, tone, triple};
use super::paths;
use crate::report::digest;
use crate::report::measured::grouped;
use crate::report::picture::{Field, Palette, Scale};
use crate::tally::results::{DetectorResult, MapKind, MapResult, Results, RunInfo};
use maud::{Markup, html};

pub fn detector(results: &Results, run: &RunInfo, index: usize, name: &str) -> Markup {
    let map = results.maps.iter().find(|map| map.detector == name);
    html! {
        section.detector id=(format!("detector-{index}")) {
            h2 { (name) }
            @if let (Some(map), Some(detector)) = (map, results.detectors.get(name)) { (picture(map, detector)) }
            @if let Some(detector) = results.detectors.get(name).filter(|detector| detector.upper_limit_w.is_none()) {
                div.pair {
                    div { (classes(detector)) (sources(detector)) }
                    @if let Some(map) = map { (uncertainty(map)) }
                }
            }
            (filters(results, name))
            (paths::table(results, name))
            @if let Some(detector) = results.detectors.get(name) { (convergence(results, run, detector)) }
        }
    }
}

/// The light that each filter means: how much, and where.
fn filters(results: &Results, detector: &str) -> Markup {
    let rows = digest::filters(results, detector);
    html! {
        @if !rows.is_empty() {
            h3 { "Filters" }
            table.classes {
                thead { tr { th { "Filter" } th { "Light on its way" } th.right { "Flux" } th.right { "Share" } } }
                tbody { @for row in &rows {
                    tr {
                        td { (row.filter) }
                        td { code { (row.expression) } @if row.open_w.mean > 0.0 { p.note { (digest::open(row)) "." } } }
                        td.right { @match row.upper_limit_w { Some(most) => { (limit(most, "W")) }, None => { (estimate(row.flux_w, "W")) } } }
                        td.right { (digest::measured_percent(0.01 * row.percent)) }
                    }
                } }
            }
            div.small-maps { @for row in rows.iter().filter(|row| row.rays > 0) { (small(&row.map)) } }
        }
    }
}

/// A small map of filtered light.
fn small(map: &MapResult) -> Markup {
    let field = Field::of(map);
    let scale = Scale::of(field.lit());
    let name = map.filter.as_deref().unwrap_or_default();
    html! {
        figure.small {
            h3 { (name) }
            (figure::figure(&Figure {
                field: &field, scale: &scale, palette: Palette::Light, unit: map.unit, title: name, longest: 230.0,
            }))
        }
    }
}

fn picture(map: &MapResult, detector: &DetectorResult) -> Markup {
    let field = Field::of(map);
    let scale = Scale::of(field.lit());
    let title = format!("Map of {}", map.detector);
    html! {
        figure.map {
            div.picture data-map=[is_read_out(map).then_some(&map.detector)] { (figure::figure(&Figure {
                field: &field, scale: &scale, palette: Palette::Light, unit: map.unit, title: &title, longest: 480.0,
            })) }
            figcaption { (caption(map, &field, &scale, detector)) }
        }
    }
}

/// The same map of stray light alone, and whether it is told apart.
pub fn stray_map(map: &MapResult) -> (MapResult, bool) {
    let Some([mean, error]) = map.stray.clone() else { return (map.clone(), false) };
    // Where no stray light came, other light may have.
    let rays = map.rays.iter().zip(&mean).map(|(rays, mean)| if *mean > 0.0 { *rays } else { 0 }).collect();
    (MapResult { mean, error, rays, ..map.clone() }, true)
}

/// A small map of the error of each bin.
fn uncertainty(map: &MapResult) -> Markup {
    let field = Field::relative_error(map);
    let scale = Scale::of(field.lit());
    let title = format!("Relative error of {}", map.detector);
    let drawn =
        Figure { field: &field, scale: &scale, palette: Palette::Error, unit: "%", title: &title, longest: 230.0 };
    html! {
        figure.small {
            h3 { "Relative error per bin, 1σ" }
            (figure::figure(&drawn))
        }
    }
}

fn caption(map: &MapResult, field: &Field, scale: &Scale, detector: &DetectorResult) -> Markup {
    let [rows, columns] = map.shape;
    let quantity = map.quantity();
    html! {
        h3 { (quantity) ", " (power(map.unit)) }
        dl {
            @if map.kind == MapKind::Triangles {
                dt { "Bins" } dd { (grouped(columns as u64, "\u{202f}")) " triangles in the order of the mesh; their sizes are in the FITS file" }
            } @else {
                dt { "Bins" } dd { (columns) " columns × " (rows) " rows" @if field.averaged > 1 { ", averaged over up to " (field.averaged) " × " (field.averaged) " for this picture" }
                    @if !field.true_to_scale() { "; axes not to one scale" } }
            }
            (bearings(map, field))
            dt { "Side" } dd { (map.side) (sense(map.side)) }
            @if *scale != Scale::Empty { dt { "Scale" } dd { (words(scale, map.unit)) } }
            @if field.has_dark() {
                dt { "No ray arrived" } dd { span.swatch.dark {} "where grey; " @if let Some(limit) = dark(map) { (limit) } }
            }
            @if detector.upper_limit_w.is_none() {
                dt { "Brightest bin" } dd {
                    @let peak = detector.peak_w_m2;
                    (estimate(crate::tally::results::Estimate { mean: peak.mean, error: peak.error }, &detector.unit))
                    ", row " (peak.pixel[0]) ", column " (peak.pixel[1]) ". A maximum is biased upward by noise."
                }
            }
        }
    }
}

/// What the colours show and hide.
fn words(scale: &Scale, unit: &str) -> Markup {
    match *scale {
        Scale::Empty => html! {},
        Scale::Linear { top } => html! { "linear, 0 to " (plain(top, unit)) },
        Scale::Log { floor, top } => html! {
            "logarithmic, " (ten(floor.log10().round() as i32)) " to " (plain(top, unit)) "; fainter light has the colour of the floor"
        },
    }
}

/// The largest upper limit of a bin without rays.
fn dark(map: &MapResult) -> Option<Markup> {
    let limits = map.upper.iter().zip(&map.rays).filter(|(_, rays)| **rays == 0).map(|(limit, _)| *limit);
    let largest = limits.fold(0.0, f64::max);
    (largest > 0.0).then(|| html! { "there " (limit(largest, map.unit)) " per bin" })
}

fn sense(side: &str) -> &'static str {
    match side {
        "front" => ": seen looking against the detector’s normal",
        "back" => ": seen looking along the detector’s normal",
        _ => "",
    }
}

/// How the map lies in the world.
fn bearings(map: &MapResult, field: &Field) -> Markup {
    let Some([x, y]) = &field.spans else { return html! {} };
    let range = |span: &crate::report::picture::Span| {
        html! { (span.name) ", " (plain(span.from, "")) " to " (plain(span.to, span.unit)) }
    };
    html! {
        dt { "Right" } dd { (range(x)) @if map.kind == MapKind::Plane { "; columns along " (triple(map.column_direction, 1.0)) } }
        dt { "Up" } dd { (range(y)) @if map.kind == MapKind::Plane { "; rows along " (triple(map.row_direction, 1.0)) ", row 0 at the bottom" } }
        @if map.kind == MapKind::Plane {
            dt { "Origin" } dd { "lower left corner at " (triple(map.origin, 1e3)) " mm in world axes" }
        } @else {
            dt { "Angles" } dd { "θ from the axis, 0 at the centre; φ = 0 to the right along " (triple(map.column_direction, 1.0)) ", anticlockwise" }
        }
    }
}

fn classes(detector: &DetectorResult) -> Markup {
    let rows = digest::classes(detector);
    let floor = floor(rows.iter().map(|row| row.1.mean / detector.flux_w.mean));
    html! {
        @if !rows.is_empty() {
            h3 { "Classes of light" }
            table.classes {
                thead { tr { th { "Class" } th.right { "Flux" } th.right { "Share" } th { (decades(floor)) } } }
                tbody { @for (class, flux, share) in &rows {
                    tr {
                        td { span.swatch style=(format!("background:{}", tone(class))) {} (class) }
                        td.right { (estimate(*flux, "W")) }
                        td.right { (share) " %" }
                        td.gauge { (gauge(length(flux.mean / detector.flux_w.mean, floor), tone(class))) }
                    }
                } }
                tfoot { tr { th { "Total" } td.right { (estimate(detector.flux_w, "W")) } td.right { "100 %" } td {} } }
            }
        }
    }
}

fn sources(detector: &DetectorResult) -> Markup {
    let rows = digest::sources(detector);
    html! {
        @if !rows.is_empty() {
            h3 { "Light by source" }
            table.classes {
                thead { tr { th { "Source" } th.right { "Flux" } th.right { "Relative error" } } }
                tbody { @for (source, flux) in &rows {
                    tr {
                        td { (source) }
                        td.right { (estimate(*flux, "W")) }
                        td.right { @if flux.mean > 0.0 { (format!("{:.1} %", 100.0 * flux.error / flux.mean)) } @else { "-" } }
                    }
                } }
            }
        }
    }
}

/// Decade below the smallest share, when a linear bar would hide it: exponent of the bar's left end.
fn floor(shares: impl Iterator<Item = f64>) -> Option<i32> {
    let smallest = shares.filter(|share| *share > 0.0).fold(1.0, f64::min);
    (smallest < 0.01).then(|| (smallest.log10().ceil() as i32 - 1).max(-12))
}

/// Length of a bar, 0..1: linear, or logarithmic from the floor to the whole.
fn length(share: f64, floor: Option<i32>) -> f64 {
    match floor {
        Some(power) if share > 0.0 => 1.0 - share.log10() / f64::from(power),
        Some(_) => 0.0,
        None => share,
    }
}

/// The ends of a logarithmic bar.
fn decades(floor: Option<i32>) -> Markup {
    html! { @if let Some(power) = floor { span.ends { span { (ten(power)) } span { "logarithmic" } span { "1" } } } }
}

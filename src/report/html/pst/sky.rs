//! The directions of a sweep as they stand in the sky: the boresight in the middle, up at the top, azimuths clockwise.

use super::plot::px;
use crate::report::picture::{Palette, Scale, superscript, ticks};
use crate::study::pst::{Curve, Point, Verdict};
use maud::{Markup, html};

const RADIUS: f64 = 220.0;
/// Centre of the sky, and the whole picture, in its own units: letters are 13 high.
const CENTRE: [f64; 2] = [268.0, 262.0];
const SIZE: [f64; 2] = [640.0, 530.0];

/// Fewest azimuths that make a picture of the sky.
const FEWEST: usize = 3;

/// Steps of the colour bar.
const STEPS: usize = 64;

const FONT: &str = "font-family:Inter,'Segoe UI',system-ui,Arial,'Liberation Sans',sans-serif;font-size:13px";

/// The picture as SVG, which needs nothing else; `None` if there are too few azimuths or angles.
pub fn picture(curve: &Curve) -> Option<String> {
    let cuts = curve.cuts();
    if cuts.len() < FEWEST || cuts[0].len() < 2 {
        return None;
    }
    let angles = edges(&cuts[0].iter().map(|point| point.angle_deg).collect::<Vec<_>>());
    let angles: Vec<f64> = angles.into_iter().map(|angle| angle.max(0.0)).collect();
    let azimuths = around(&cuts.iter().map(|cut| cut[0].azimuth_deg).collect::<Vec<_>>());
    let largest = angles.last().copied().unwrap_or(1.0);
    let scale = Scale::of(curve.points.iter().map(|point| point.pst.mean));
    let cell = |column: usize, row: usize| {
        let radii = [angles[row], angles[row + 1]].map(|angle| angle / largest * RADIUS);
        let point = &cuts[column][row];
        html! { path d=(wedge(radii, azimuths[column])) fill=(colour(&scale, point)) {} }
    };
    let failed = |column: usize, row: usize| {
        let radii = [angles[row], angles[row + 1]].map(|angle| angle / largest * RADIUS);
        html! { path d=(wedge(radii, azimuths[column])) fill="none" stroke="#c0182b" stroke-width="2.2" {} }
    };
    let all = || (0..cuts.len()).flat_map(|column| (0..cuts[0].len()).map(move |row| (column, row)));
    let fails = |p: &Point| p.required.is_some_and(|required| required.verdict == Verdict::Fail);
    let any = curve.points.iter().any(fails);
    let picture = html! {
        svg xmlns="http://www.w3.org/2000/svg" viewBox=(format!("0 0 {} {}", SIZE[0], SIZE[1])) style=(FONT) role="img"
            aria-label=(format!("PST of {} over the sky", curve.sweep)) {
            rect width="100%" height="100%" fill="#fff" {}
            @for (column, row) in all() { (cell(column, row)) }
            @for (column, row) in all().filter(|&(column, row)| fails(&cuts[column][row])) { (failed(column, row)) }
            (web(largest))
            (bar(&scale))
            @if any {
                rect x="540" y="476" width="14" height="14" fill="none" stroke="#c0182b" stroke-width="2.2" {}
                text x="562" y="488" fill="#161b22" { "fails" }
            }
        }
    };
    Some(picture.into_string())
}

/// Edges of cells about values, half-way between neighbours; the outer cells are as wide outwards as inwards.
fn edges(values: &[f64]) -> Vec<f64> {
    let (first, last) = (values[0], values[values.len() - 1]);
    let inner = values.windows(2).map(|pair| 0.5 * (pair[0] + pair[1]));
    let before = first - 0.5 * (values[1] - first);
    let after = last + 0.5 * (last - values[values.len() - 2]);
    std::iter::once(before).chain(inner).chain([after]).collect()
}

/// From and to of each azimuth, deg; where they go all around, the last meets the first.
fn around(azimuths: &[f64]) -> Vec<[f64; 2]> {
    let mut all = edges(azimuths);
    let (first, last) = (azimuths[0], azimuths[azimuths.len() - 1]);
    let gap = first + 360.0 - last;
    let widest = azimuths.windows(2).map(|pair| pair[1] - pair[0]).fold(0.0, f64::max);
    if gap <= 1.01 * widest {
        let count = all.len();
        (all[0], all[count - 1]) = (first - 0.5 * gap, last + 0.5 * gap);
    }
    all.windows(2).map(|pair| [pair[0], pair[1]]).collect()
}

/// Outline of a cell between two radii and two azimuths (deg).
fn wedge([inner, outer]: [f64; 2], [from, to]: [f64; 2]) -> String {
    let point = |radius: f64, azimuth: f64| {
        let [x, y] = place(radius, azimuth);
        format!("{x:.2} {y:.2}")
    };
    let large = u8::from(to - from > 180.0);
    format!(
        "M{} A{outer:.2} {outer:.2} 0 {large} 1 {} L{} A{inner:.2} {inner:.2} 0 {large} 0 {} Z",
        point(outer, from),
        point(outer, to),
        point(inner, to),
        point(inner, from)
    )
}

/// Up is at the top, azimuths (deg) go clockwise.
fn place(radius: f64, azimuth: f64) -> [f64; 2] {
    let (sin, cos) = azimuth.to_radians().sin_cos();
    [CENTRE[0] + radius * sin, CENTRE[1] - radius * cos]
}

fn colour(scale: &Scale, point: &Point) -> String {
    if point.pst.mean <= 0.0 {
        return "#c6cbd1".into();
    }
    hex(Palette::Light.colour(scale.place(point.pst.mean)))
}

fn hex([r, g, b]: [u8; 3]) -> String {
    format!("#{r:02x}{g:02x}{b:02x}")
}

/// Circles of angles, and azimuths around.
fn web(largest: f64) -> Markup {
    html! {
        @for (part, text) in ticks(0.0, largest, 4).into_iter().filter(|(part, _)| *part > 0.0) {
            circle cx=(CENTRE[0]) cy=(CENTRE[1]) r=(px(part * RADIUS)) fill="none" stroke="#fff" stroke-opacity="0.55" {}
            text x=(px(CENTRE[0] + 4.0)) y=(px(CENTRE[1] - part * RADIUS + 14.0)) style="fill:#fff;stroke:#161b22;stroke-width:2.5;paint-order:stroke" { (text) "°" }
        }
        circle cx=(CENTRE[0]) cy=(CENTRE[1]) r=(RADIUS) fill="none" stroke="#161b22" {}
        @for azimuth in (0..360).step_by(30) {
            @let [x, y] = place(RADIUS + 20.0, f64::from(azimuth));
            text x=(px(x)) y=(px(y + 4.5)) text-anchor="middle" fill="#5a6470" { @if azimuth == 0 { "up 0°" } @else { (azimuth) "°" } }
        }
    }
}

fn bar(scale: &Scale) -> Markup {
    let (x, top, height) = (540.0, 60.0, 400.0);
    let step = height / STEPS as f64;
    let factor = if scale.exponent() == 0 { String::new() } else { format!(", 10{}", superscript(scale.exponent())) };
    html! {
        @if *scale != Scale::Empty {
            text x=(x) y=(top - 14.0) fill="#161b22" { "PST" (factor) }
            @for k in 0..STEPS {
                rect x=(x) y=(px(top + k as f64 * step)) width="16" height=(px(step + 0.4))
                    fill=(hex(Palette::Light.colour(1.0 - (k as f64 + 0.5) / STEPS as f64))) {}
            }
            rect x=(x) y=(top) width="16" height=(height) fill="none" stroke="#161b22" {}
            @for mark in scale.marks() {
                text x=(x + 22.0) y=(px(top + (1.0 - mark.place) * height + 4.5)) fill="#5a6470" {
                    @match mark.power { Some(power) => { "10" (superscript(power)) }, None => { (mark.text) } }
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_meet_and_a_full_circle_closes() {
        assert_eq!(edges(&[1.0, 2.0, 4.0]), [0.5, 1.5, 3.0, 5.0]);
        assert_eq!(around(&[0.0, 90.0, 180.0, 270.0]).last(), Some(&[225.0, 315.0]));
        assert_eq!(around(&[0.0, 10.0, 20.0]), [[-5.0, 5.0], [5.0, 15.0], [15.0, 25.0]]);
        let [x, y] = place(RADIUS, 90.0);
        assert!((x - CENTRE[0] - RADIUS).abs() < 1e-9 && (y - CENTRE[1]).abs() < 1e-9, "clockwise from the top");
    }
}

//! A map as vector graphics around one embedded picture: sharp letters at any size and on paper.

use super::number::{minus, power, ten};
use crate::report::picture::{Field, Mark, Palette, Scale, Span, bare, ticks};
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use maud::{Markup, html};

/// Stops of the colour bar: between them the scale is straight to the eye.
const STOPS: usize = 32;

/// Space left, above, right (colour bar), below.
const MARGIN: [f64; 4] = [62.0, 26.0, 96.0, 52.0];

/// What is drawn, and how large.
pub struct Figure<'a> {
    pub field: &'a Field,
    pub scale: &'a Scale,
    pub palette: Palette,
    /// Unit on the colour bar.
    pub unit: &'a str,
    /// For those who cannot see it.
    pub title: &'a str,
    /// Longest side of the plot in the picture's own units, in which letters are 12.5 high.
    pub longest: f64,
}

pub fn figure(figure: &Figure) -> Markup {
    let &Figure { field, scale, palette, longest, .. } = figure;
    let aspect = field.aspect();
    let size = if aspect >= 1.0 { [longest, longest / aspect] } else { [longest * aspect, longest] };
    let [width, height] = [MARGIN[0] + size[0] + MARGIN[2], MARGIN[1] + size[1].max(120.0) + MARGIN[3]];
    html! {
        svg viewBox=(format!("0 0 {width:.1} {height:.1}")) style=(format!("max-width:{:.0}px", 1.12 * width))
            role="img" aria-label=(figure.title) {
            g transform=(format!("translate({} {})", MARGIN[0], MARGIN[1])) {
                (image(&bare(field, scale, palette).unwrap_or_default(), size))
                @match &field.spans {
                    Some([x, y]) => { (across(x, size)) (up(y, size)) },
                    None => { text.axis x=(px(size[0] / 2.0)) y=(px(size[1] + 24.0)) text-anchor="middle" { "triangle, in the order of the mesh" } },
                }
                @if *scale != Scale::Empty { (bar(figure, size[0] + 24.0, size[1].max(120.0))) }
            }
        }
    }
}

/// The pixels, enlarged without smoothing, in a thin frame.
fn image(png: &[u8], [width, height]: [f64; 2]) -> Markup {
    let data = format!("data:image/png;base64,{}", STANDARD.encode(png));
    html! {
        image.pixels href=(data) width=(px(width)) height=(px(height)) preserveAspectRatio="none" {}
        rect.frame width=(px(width)) height=(px(height)) {}
    }
}

fn across(span: &Span, [width, height]: [f64; 2]) -> Markup {
    html! {
        @for (place, text) in ticks(span.from, span.to, (width / 70.0).max(2.0) as usize) {
            line x1=(px(place * width)) x2=(px(place * width)) y1=(px(height)) y2=(px(height + 5.0)) {}
            text x=(px(place * width)) y=(px(height + 19.0)) text-anchor="middle" { (minus(&text)) }
        }
        text.axis x=(px(width / 2.0)) y=(px(height + 42.0)) text-anchor="middle" { (span.label()) }
    }
}

fn up(span: &Span, [_, height]: [f64; 2]) -> Markup {
    html! {
        @for (place, text) in ticks(span.from, span.to, (height / 60.0).max(1.0) as usize) {
            @let y = height * (1.0 - place);
            line x1="-5" x2="0" y1=(px(y)) y2=(px(y)) {}
            text x="-9" y=(px(y + 4.0)) text-anchor="end" { (minus(&text)) }
        }
        text.axis transform=(format!("translate(-46 {:.1}) rotate(-90)", height / 2.0)) text-anchor="middle" { (span.label()) }
    }
}

/// Colour bar with its unit on top.
fn bar(&Figure { scale, palette, unit, .. }: &Figure, x: f64, height: f64) -> Markup {
    let id = if palette == Palette::Light { "light" } else { "error" };
    let factor = match scale.exponent() {
        0 => String::new(),
        power => format!("{} ", ten(power)),
    };
    html! {
        g transform=(format!("translate({x:.1} 0)")) {
            text.axis x="0" y="-10" { (factor) (power(unit)) }
            defs { linearGradient id=(id) x1="0" x2="0" y1="1" y2="0" {
                @for stop in 0..=STOPS { stop offset=(format!("{:.3}", stop as f64 / STOPS as f64)) stop-color=(shade(palette, stop)) {} }
            } }
            rect.frame width="16" height=(px(height)) style=(format!("fill:url(#{id})")) {}
            @for mark in legible(scale.marks(), height) {
                @let y = height * (1.0 - mark.place);
                line x1="16" x2="21" y1=(px(y)) y2=(px(y)) {}
                text x="26" y=(px(y + 4.0)) { @match mark.power { Some(power) => { (ten(power)) }, None => { (mark.text) } } }
            }
        }
    }
}

/// Marks that are at least a line apart, from the lowest.
fn legible(marks: Vec<Mark>, height: f64) -> Vec<Mark> {
    let mut kept: Vec<Mark> = Vec::new();
    for mark in marks {
        if kept.last().is_none_or(|last| (mark.place - last.place) * height >= 16.0) {
            kept.push(mark);
        }
    }
    kept
}

/// Colour of a stop of the bar.
fn shade(palette: Palette, stop: usize) -> String {
    let [r, g, b] = palette.colour(stop as f64 / STOPS as f64);
    format!("#{r:02x}{g:02x}{b:02x}")
}

/// A length to a tenth of a unit.
fn px(length: f64) -> String {
    format!("{length:.1}")
}

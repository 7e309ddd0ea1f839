//! Curves over an axis, on a sheet of panels with one logarithmic scale.

use super::canvas::{Anchor, Canvas, Weight, length};
use super::{Span, plot, ticks};
use std::io;

/// A line through points (x, y), y > 0.
#[derive(Clone, Debug)]
pub struct Line {
    pub points: Vec<[f64; 2]>,
    pub ink: Ink,
    pub stroke: Stroke,
}

/// Colours of curves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ink {
    Red,
    Blue,
    Grey,
}

/// How a curve is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stroke {
    /// Thick.
    Bold,
    Thin,
    Dashed,
}

/// A diagram.
#[derive(Clone, Debug)]
pub struct Panel {
    pub title: String,
    pub x: Span,
    pub curves: Vec<Line>,
}

/// Size of a panel's diagram, and the space around it: left, above, right, below, pixels.
const SIZE: [i32; 2] = [520, 340];
const MARGIN: [i32; 4] = [92, 52, 24, 76];
/// Height of the head of the sheet, pixels.
const HEAD: i32 = 96;
/// Decades that are shown below 1.
const DECADES: i32 = 5;

/// A PNG of panels, two in a row. `legend`: what inks and strokes mean.
pub fn curves(title: &str, legend: &[(Ink, Stroke, &str)], panels: &[Panel]) -> io::Result<Vec<u8>> {
    let whole = [MARGIN[0] + SIZE[0] + MARGIN[2], MARGIN[1] + SIZE[1] + MARGIN[3]];
    let rows = panels.len().div_ceil(2) as i32;
    let mut canvas = Canvas::new(2 * whole[0], HEAD + rows * whole[1]);
    canvas.text([16, 28], Anchor::Start, Weight::Bold, title);
    let mut at = 16;
    for (ink, stroke, meaning) in legend {
        line(&mut canvas, [f64::from(at), 64.0], [f64::from(at + 40), 64.0], *ink, *stroke, &mut 0.0);
        canvas.text([at + 50, 64], Anchor::Start, Weight::Regular, meaning);
        at += 74 + length(meaning);
    }
    for (index, panel) in panels.iter().enumerate() {
        let [column, row] = [index as i32 % 2, index as i32 / 2];
        draw(&mut canvas, [column * whole[0] + MARGIN[0], HEAD + row * whole[1] + MARGIN[1]], panel);
    }
    plot::encode(&canvas)
}

fn draw(canvas: &mut Canvas, [left, top]: [i32; 2], panel: &Panel) {
    let ([width, height], bottom) = (SIZE, top + SIZE[1]);
    canvas.text([left, top - 20], Anchor::Start, Weight::Bold, &panel.title);
    canvas.frame([left, top], SIZE);
    for (place, text) in ticks(panel.x.from, panel.x.to, 6) {
        let at = left + (place * f64::from(width - 1)).round() as i32;
        canvas.tick([at, bottom + 1], [1, 6]);
        canvas.text([at, bottom + 20], Anchor::Middle, Weight::Regular, &text);
    }
    canvas.text([left + width / 2, bottom + 48], Anchor::Middle, Weight::Regular, &panel.x.label());
    for decade in 0..=DECADES {
        let at = top + decade * (height - 1) / DECADES;
        canvas.tick([left - 7, at], [6, 1]);
        let text = if decade <= 3 { 10f64.powi(-decade).to_string() } else { format!("1e-{decade}") };
        canvas.text([left - 12, at], Anchor::End, Weight::Regular, &text);
    }
    for curve in &panel.curves {
        let place = |[x, y]: [f64; 2]| {
            let along = (x - panel.x.from) / (panel.x.to - panel.x.from);
            let down = -y.log10() / f64::from(DECADES);
            let inside = (-1e-9..=1.0).contains(&down);
            inside.then(|| {
                [f64::from(left) + along * f64::from(width - 1), f64::from(top) + down * f64::from(height - 1)]
            })
        };
        let mut run = 0.0;
        for pair in curve.points.windows(2) {
            if let (Some(from), Some(to)) = (place(pair[0]), place(pair[1])) {
                line(canvas, from, to, curve.ink, curve.stroke, &mut run);
            }
        }
    }
}

/// A straight line; `run` is the length drawn so far, pixels, which dashes count.
fn line(canvas: &mut Canvas, from: [f64; 2], to: [f64; 2], ink: Ink, stroke: Stroke, run: &mut f64) {
    let colour = match ink {
        Ink::Red => [0xc9, 0x2a, 0x2a],
        Ink::Blue => [0x1c, 0x5f, 0xc4],
        Ink::Grey => [0x86, 0x8e, 0x96],
    };
    let start = *run;
    let inked = |way: f64| stroke != Stroke::Dashed || (start + way).rem_euclid(12.0) <= 7.0;
    canvas.line([from, to], if stroke == Stroke::Bold { 3 } else { 1 }, colour, inked);
    *run += (to[0] - from[0]).hypot(to[1] - from[1]);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_curve_is_drawn_where_it_is() {
        let mut canvas = Canvas::new(MARGIN[0] + SIZE[0] + 10, MARGIN[1] + SIZE[1] + MARGIN[3]);
        let x = Span { name: "x".into(), unit: "", from: 0.0, to: 1.0 };
        let flat = Line { points: vec![[0.0, 0.1], [1.0, 0.1], [1.0, 1e-9]], ink: Ink::Red, stroke: Stroke::Thin };
        draw(&mut canvas, [MARGIN[0], MARGIN[1]], &Panel { title: String::new(), x, curves: vec![flat] });
        let red = |x: i32, y: i32| canvas.pixels[3 * (y * canvas.width + x) as usize..][..3] == [0xc9, 0x2a, 0x2a];
        // One decade of five below the top; nothing of what is off the scale.
        let y = MARGIN[1] + ((SIZE[1] - 1) as f64 / 5.0).round() as i32;
        assert!(red(MARGIN[0] + 100, y) && red(MARGIN[0] + SIZE[0] - 1, y));
        assert!(!(y + 1..MARGIN[1] + SIZE[1]).any(|y| red(MARGIN[0] + SIZE[0] - 1, y)));
    }
}

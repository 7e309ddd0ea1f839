//! Curves over two axes, linear or logarithmic, as a picture.

use super::canvas::{Anchor, Canvas, LETTER, Weight, length};
use super::plot::encode;
use super::ticks;
use std::io;

/// Size of the plot, and space left, above, right (legend) and below it, pixels.
const SIZE: [i32; 2] = [720, 480];
const MARGIN: [i32; 4] = [110, 84, 230, 84];

/// Decades shown at most: what is fainter is cut off.
const DECADES: f64 = 12.0;

/// Colours that differ for colour-blind eyes, too (Okabe & Ito 2008).
const COLOURS: [[u8; 3]; 7] =
    [[0, 114, 178], [213, 94, 0], [0, 158, 115], [204, 121, 167], [230, 159, 0], [86, 180, 233], [90, 90, 90]];

/// How an axis is divided.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Division {
    Linear,
    /// Values that are not above 0 are left out.
    Decades,
}

/// What runs along an axis: quantity with its unit, and how it is divided.
#[derive(Clone, Copy, Debug)]
pub struct Ruler<'a> {
    pub label: &'a str,
    pub division: Division,
}

/// A curve and its name.
#[derive(Clone, Debug)]
pub struct Curve {
    pub label: String,
    /// (x, y) in the order in which they are joined; a gap where a value is not finite or not on the axis.
    pub points: Vec<[f64; 2]>,
}

/// The curves as a PNG with axes, title and legend.
pub fn chart(title: &str, [x, y]: [Ruler; 2], curves: &[Curve]) -> io::Result<Vec<u8>> {
    let values = |axis: usize| curves.iter().flat_map(move |curve| curve.points.iter().map(move |point| point[axis]));
    let reaches = [Reach::of(x.division, values(0)), Reach::of(y.division, values(1))];
    let mut canvas = Canvas::new(MARGIN[0] + SIZE[0] + MARGIN[2], MARGIN[1] + SIZE[1] + MARGIN[3]);
    canvas.text([16, 30], Anchor::Start, Weight::Bold, title);
    for (curve, colour) in curves.iter().zip(colours()) {
        let place = |point: &[f64; 2]| Some(pixel(reaches[0].place(point[0])?, reaches[1].place(point[1])?));
        canvas.curve(&curve.points.iter().map(place).collect::<Vec<_>>(), colour);
    }
    canvas.frame([MARGIN[0], MARGIN[1]], SIZE);
    axes(&mut canvas, &reaches, [x.label, y.label]);
    legend(&mut canvas, [MARGIN[0] + SIZE[0] + 20, MARGIN[1]], curves);
    encode(&canvas)
}

/// What an axis shows; of decades their logarithms.
pub(super) struct Reach {
    division: Division,
    from: f64,
    to: f64,
}

impl Reach {
    pub fn of(division: Division, values: impl Iterator<Item = f64>) -> Reach {
        let shown = values.filter_map(|value| scaled(division, value));
        let (low, high) = shown.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), v| (a.min(v), b.max(v)));
        let (low, high) = if low > high { (0.0, 1.0) } else { (low, high) };
        match division {
            Division::Linear => Reach { division, from: low, to: if high > low { high } else { low + 1.0 } },
            Division::Decades => {
                let top = (high - 1e-9).ceil();
                Reach { division, from: (low + 1e-9).floor().max(top - DECADES).min(top - 1.0), to: top }
            }
        }
    }

    /// Place 0..1 along the axis; `None` if it is not on it.
    pub fn place(&self, value: f64) -> Option<f64> {
        let place = (scaled(self.division, value)? - self.from) / (self.to - self.from);
        (-1e-9..=1.0 + 1e-9).contains(&place).then_some(place)
    }

    pub fn marks(&self, count: usize) -> Vec<(f64, String)> {
        match self.division {
            Division::Linear => ticks(self.from, self.to, count),
            Division::Decades => {
                let (from, to) = (self.from as i32, self.to as i32);
                let step = ((to - from) as usize).div_ceil(count).max(1);
                let mark = |power: i32| (f64::from(power - from) / f64::from(to - from), format!("1e{power}"));
                (from..=to).step_by(step).map(mark).collect()
            }
        }
    }
}

fn scaled(division: Division, value: f64) -> Option<f64> {
    let value = if division == Division::Decades { value.log10() } else { value };
    value.is_finite().then_some(value)
}

/// Upper left corner of the pixel of a place.
fn pixel(x: f64, y: f64) -> [f64; 2] {
    [f64::from(MARGIN[0]) + x * f64::from(SIZE[0] - 2), f64::from(MARGIN[1]) + (1.0 - y) * f64::from(SIZE[1] - 2)]
}

fn axes(canvas: &mut Canvas, [x, y]: &[Reach; 2], labels: [&str; 2]) {
    let (left, bottom) = (MARGIN[0], MARGIN[1] + SIZE[1]);
    for (place, text) in x.marks(8) {
        let at = pixel(place, 0.0)[0].round() as i32;
        canvas.tick([at, bottom + 1], [1, 6]);
        canvas.text([at, bottom + 20], Anchor::Middle, Weight::Regular, &text);
    }
    canvas.text([left + SIZE[0] / 2, bottom + 52], Anchor::Middle, Weight::Regular, labels[0]);
    let mut widest = 0;
    for (place, text) in y.marks(7) {
        let at = pixel(0.0, place)[1].round() as i32;
        canvas.tick([left - 7, at], [6, 1]);
        canvas.text([left - 12, at], Anchor::End, Weight::Regular, &text);
        widest = widest.max(length(&text));
    }
    canvas.upward([left - 12 - widest - 16, MARGIN[1] + SIZE[1] / 2], Anchor::Middle, labels[1]);
}

/// Names of curves beside their colours, from a place down.
pub(super) fn legend(canvas: &mut Canvas, [left, top]: [i32; 2], curves: &[Curve]) {
    for (row, (curve, colour)) in curves.iter().zip(colours()).enumerate() {
        let y = top + 12 + row as i32 * (LETTER[1] + 6);
        canvas.fill([left, y - 1], [24, 3], colour);
        canvas.text([left + 32, y], Anchor::Start, Weight::Regular, &curve.label);
    }
}

/// Colours of curves in their order.
pub(super) fn colours() -> impl Iterator<Item = [u8; 3]> {
    COLOURS.into_iter().cycle()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn decades_are_whole_and_hold_all_values() {
        let span = Reach::of(Division::Decades, [3e-5, 0.0, 0.2, f64::NAN].into_iter());
        assert_eq!((span.from, span.to), (-5.0, 0.0));
        assert_eq!(span.place(0.0), None);
        assert_eq!(span.marks(7).last().map(|mark| mark.1.clone()), Some("1e0".into()));
        let one = Reach::of(Division::Decades, [1e-3].into_iter());
        assert!(one.place(1e-3).is_some());
    }

    #[test]
    fn a_chart_shows_each_curve_in_its_colour() {
        let ruler = Ruler { label: "x", division: Division::Linear };
        let curve = |y: f64| Curve { label: "c".into(), points: vec![[0.0, y], [1.0, y + 1.0]] };
        let bytes = chart("title", [ruler, ruler], &[curve(0.0), curve(1.0)]).unwrap();
        assert!(bytes.len() > 1000);
    }
}

//! The system cut open as a line drawing, with ways of light projected onto it.
//!
//! The plane holds the longest side of the box around everything and, of the other two, the one along which the light spreads most; it
//! goes through the middle of the box.

use super::number::tone;
use crate::tally::drawing::{Drawing, Way};
use maud::{Markup, html};
use std::fmt::Write;

/// Width of the picture, and space around the drawing; its own units.
const WIDTH: f64 = 640.0;
const MARGIN: f64 = 14.0;
/// Heights between which the picture stays.
const HEIGHTS: [f64; 2] = [150.0, 420.0];
/// Lines shorter than this are not seen.
const SHORTEST: f64 = 0.15;

/// A plane and how it is drawn.
struct Plane {
    /// Axes of the world: to the right, up, and across the plane.
    axes: [usize; 3],
    /// Of the box around everything, m.
    low: [f64; 3],
    high: [f64; 3],
    /// Units of the picture to a metre.
    scale: f64,
    height: f64,
}

pub fn cutaway(drawing: &Drawing, ways: &[&Way]) -> Markup {
    let plane = Plane::new(drawing, ways);
    let mut lines = String::new();
    drawing.triangles.iter().for_each(|triangle| plane.cut(drawing, triangle, &mut lines));
    let height = plane.height + 2.0 * MARGIN + 18.0;
    html! {
        svg viewBox=(format!("0 0 {WIDTH} {height:.0}")) role="img" aria-label="Section of the system with the strongest path of stray light" {
            path.wall d=(lines) {}
            @for way in ways { path.way d=(plane.way(way)) style=(format!("stroke:{}", tone(&way.class))) {} }
            (plane.ruler(height - 12.0))
        }
    }
}

impl Plane {
    fn new(drawing: &Drawing, ways: &[&Way]) -> Plane {
        let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        for corner in &drawing.corners {
            for axis in 0..3 {
                low[axis] = low[axis].min(f64::from(corner[axis]));
                high[axis] = high[axis].max(f64::from(corner[axis]));
            }
        }
        let size = |axis: usize| (high[axis] - low[axis]).max(1e-9);
        let across = (0..3).max_by(|a, b| size(*a).total_cmp(&size(*b))).unwrap_or(2);
        let first = if across == 1 { 2 } else { 1 };
        let second = 3 - across - first;
        let spread = |axis: usize| ways.iter().map(|way| reach(way, axis)).sum::<f64>();
        let [up, through] = if spread(second) > 1.2 * spread(first) { [second, first] } else { [first, second] };
        let scale = ((WIDTH - 2.0 * MARGIN) / size(across)).min(HEIGHTS[1] / size(up));
        Plane { axes: [across, up, through], low, high, scale, height: (scale * size(up)).max(HEIGHTS[0]) }
    }

    /// Where a point of the drawing is in the picture.
    fn place(&self, point: [f64; 3]) -> [f64; 2] {
        let [x, y] = [self.axes[0], self.axes[1]];
        let middle = |axis: usize| 0.5 * (self.low[axis] + self.high[axis]);
        [
            0.5 * WIDTH + self.scale * (point[x] - middle(x)),
            MARGIN + 0.5 * self.height - self.scale * (point[y] - middle(y)),
        ]
    }

    /// Adds the line in which the plane cuts a triangle.
    fn cut(&self, drawing: &Drawing, triangle: &[u32; 3], lines: &mut String) {
        let through = self.axes[2];
        let corners = triangle.map(|corner| drawing.corners[corner as usize].map(f64::from));
        // A hair beside the middle, where the corners of symmetric bodies lie.
        let middle = 0.5 * (self.low[through] + self.high[through]) + 1e-6 * drawing.radius;
        let heights = corners.map(|corner| corner[through] - middle);
        let mut ends = Vec::with_capacity(2);
        for [i, k] in [[0, 1], [1, 2], [2, 0]] {
            if (heights[i] > 0.0) != (heights[k] > 0.0) {
                let part = heights[i] / (heights[i] - heights[k]);
                ends.push(self.place(std::array::from_fn(|axis| {
                    corners[i][axis] + part * (corners[k][axis] - corners[i][axis])
                })));
            }
        }
        if let [a, b] = ends[..]
            && (b[0] - a[0]).hypot(b[1] - a[1]) >= SHORTEST
        {
            // Writing into a String cannot fail.
            let _ = write!(lines, "M{:.1} {:.1}L{:.1} {:.1}", a[0], a[1], b[0], b[1]);
        }
    }

    fn way(&self, way: &Way) -> String {
        let mut line = String::new();
        for (index, point) in way.points.iter().enumerate() {
            let [x, y] = self.place(point.to_array());
            // Light may come from afar; the picture ends before.
            let _ = write!(
                line,
                "{}{:.1} {:.1}",
                if index == 0 { "M" } else { "L" },
                x.clamp(-1e5, 1e5),
                y.clamp(-1e5, 1e5)
            );
        }
        line
    }

    /// A length to compare with.
    fn ruler(&self, y: f64) -> Markup {
        let decade = 10f64.powf((0.25 * WIDTH / self.scale).log10().floor());
        let length = [5.0, 2.0, 1.0].map(|n| n * decade).into_iter().find(|length| length * self.scale <= 0.25 * WIDTH);
        let length = length.unwrap_or(decade);
        let (from, to) = (MARGIN, MARGIN + self.scale * length);
        let axes = ["x", "y", "z"];
        html! {
            line x1=(format!("{from:.1}")) x2=(format!("{to:.1}")) y1=(y) y2=(y) {}
            text x=(format!("{:.1}", to + 8.0)) y=(y + 4.0) { ((1e9 * length).round() / 1e6) " mm" }
            text x=(WIDTH - MARGIN) y=(y + 4.0) text-anchor="end" { (axes[self.axes[0]]) " to the right, " (axes[self.axes[1]]) " up" }
        }
    }
}

/// How far a way goes along an axis, m.
fn reach(way: &Way, axis: usize) -> f64 {
    let along = || way.points.iter().map(|point| point[axis]);
    along().fold(f64::NEG_INFINITY, f64::max) - along().fold(f64::INFINITY, f64::min)
}

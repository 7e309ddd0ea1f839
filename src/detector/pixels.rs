//! Pixels on a plane: irradiance maps.
//!
//! Columns run along the frame's x, rows along its y; pixel (row 0, column 0) is at the corner of least x and least y.
//! Pixels that the detector's outline cuts have the area that is left.

use super::{Arrival, Axis, Grid, MapKind, Shape};
use crate::geometry::Frame;
use glam::{DVec2, DVec3};

/// A grid of equal rectangles.
#[derive(Debug)]
pub struct Pixels {
    frame: Frame,
    /// Corner of least x and y, scene coordinates, m.
    corner: DVec3,
    /// Pixel pitch, m.
    pitch: DVec2,
    columns: usize,
    rows: usize,
    /// Area of each pixel inside the outline, m2.
    areas: Vec<f64>,
}

impl Pixels {
    /// A grid of `columns` x `rows` over the rectangle [`low`, `high`] (m, in `frame` about `centre`), all of it sensitive.
    pub fn new(frame: Frame, centre: DVec3, low: DVec2, high: DVec2, [columns, rows]: [usize; 2]) -> Pixels {
        let pitch = (high - low) / DVec2::new(columns as f64, rows as f64);
        let corner = centre + low.x * frame.x + low.y * frame.y;
        Pixels { frame, corner, pitch, columns, rows, areas: vec![pitch.x * pitch.y; columns * rows] }
    }

    /// A grid over a window's outline.
    pub fn over(shape: Shape, frame: Frame, centre: DVec3, pixels: [usize; 2]) -> Pixels {
        match shape {
            Shape::Rectangle { half: [x, y] } => {
                Pixels::new(frame, centre, -DVec2::new(x, y), DVec2::new(x, y), pixels)
            }
            Shape::Disk { radius } => {
                let mut grid = Pixels::new(frame, centre, DVec2::splat(-radius), DVec2::splat(radius), pixels);
                for bin in 0..grid.areas.len() {
                    let low = DVec2::splat(-radius) + grid.pitch * grid.place(bin);
                    grid.areas[bin] = disk_overlap(radius, low, low + grid.pitch);
                }
                grid
            }
        }
    }

    /// Restricts the sensitive area to flat triangles (scene coordinates, m) that do not overlap.
    pub fn within(mut self, triangles: &[[DVec3; 3]]) -> Pixels {
        self.areas.iter_mut().for_each(|area| *area = 0.0);
        for triangle in triangles {
            let corners = triangle.map(|vertex| self.plane(vertex) / self.pitch);
            let low = corners.iter().fold(DVec2::INFINITY, |m, c| m.min(*c)).floor().max(DVec2::ZERO);
            let high = corners.iter().fold(DVec2::NEG_INFINITY, |m, c| m.max(*c));
            for row in low.y as usize..(high.y.ceil().max(0.0) as usize).min(self.rows) {
                for column in low.x as usize..(high.x.ceil().max(0.0) as usize).min(self.columns) {
                    let cell = DVec2::new(column as f64, row as f64);
                    let area = clipped_area(corners.map(|c| c - cell).to_vec());
                    self.areas[row * self.columns + column] += area * self.pitch.x * self.pitch.y;
                }
            }
        }
        self
    }

    fn place(&self, bin: usize) -> DVec2 {
        DVec2::new((bin % self.columns) as f64, (bin / self.columns) as f64)
    }

    /// Coordinates from the corner, m.
    fn plane(&self, point: DVec3) -> DVec2 {
        DVec2::new(self.frame.x.dot(point - self.corner), self.frame.y.dot(point - self.corner))
    }
}

impl Grid for Pixels {
    fn bin(&self, arrival: &Arrival) -> Option<usize> {
        let place = self.plane(arrival.point) / self.pitch;
        // Light on the very rim may round to just outside: it belongs to the outermost pixel.
        let index = |x: f64, n: usize| (x >= -1e-9 && x <= n as f64 + 1e-9).then(|| (x.max(0.0) as usize).min(n - 1));
        Some(index(place.y, self.rows)? * self.columns + index(place.x, self.columns)?)
    }

    fn shape(&self) -> [usize; 2] {
        [self.rows, self.columns]
    }

    fn extent(&self, bin: usize) -> f64 {
        self.areas[bin]
    }

    fn unit(&self) -> &'static str {
        "W/m2"
    }

    fn kind(&self) -> MapKind {
        MapKind::Plane
    }

    fn axes(&self) -> Option<[Axis; 2]> {
        let axis = |name: &str, n: usize, step: f64| Axis {
            name: name.into(),
            unit: "m",
            start: -0.5 * n as f64 * step,
            step,
        };
        Some([axis("x", self.columns, self.pitch.x), axis("y", self.rows, self.pitch.y)])
    }

    fn frame(&self) -> Frame {
        self.frame
    }

    fn origin(&self) -> DVec3 {
        self.corner
    }

    fn place(&self, point: DVec3) -> Option<DVec2> {
        let size = self.pitch * DVec2::new(self.columns as f64, self.rows as f64);
        Some(self.plane(point) - 0.5 * size)
    }
}

/// Area of the disc of radius `r` about the origin inside the rectangle [low, high], m2: by the exact antiderivative of the
/// half chord, strip by strip between the points where the circle meets the rectangle's horizontal sides.
fn disk_overlap(r: f64, low: DVec2, high: DVec2) -> f64 {
    let chord = |x: f64| (r * r - x * x).max(0.0).sqrt();
    let primitive = |x: f64| 0.5 * (x * chord(x) + r * r * (x / r).clamp(-1.0, 1.0).asin());
    let mut cuts = vec![low.x.max(-r), high.x.min(r)];
    if cuts[0] >= cuts[1] {
        return 0.0;
    }
    for y in [low.y, high.y] {
        if y.abs() < r {
            cuts.extend(
                [-chord(y), chord(y)].iter().filter(|x| **x > cuts[0] && **x < cuts[1]).copied().collect::<Vec<_>>(),
            );
        }
    }
    cuts.sort_by(f64::total_cmp);
    let strip = |a: f64, b: f64| {
        let half = chord(0.5 * (a + b));
        let (top, bottom) = (high.y.min(half), low.y.max(-half));
        if top <= bottom {
            return 0.0;
        }
        let arc = primitive(b) - primitive(a);
        let upper = if half <= high.y { arc } else { high.y * (b - a) };
        let lower = if -half >= low.y { -arc } else { low.y * (b - a) };
        upper - lower
    };
    cuts.windows(2).map(|w| strip(w[0], w[1])).sum()
}

/// Area of a convex polygon inside the unit square (Sutherland-Hodgman), in squares.
fn clipped_area(mut polygon: Vec<DVec2>) -> f64 {
    for (axis, bound, sign) in [(0, 0.0, 1.0), (0, 1.0, -1.0), (1, 0.0, 1.0), (1, 1.0, -1.0)] {
        let depth = |p: DVec2| sign * (p[axis] - bound);
        let mut kept = Vec::with_capacity(polygon.len() + 1);
        for (i, &to) in polygon.iter().enumerate() {
            let from = polygon[(i + polygon.len() - 1) % polygon.len()];
            let (a, b) = (depth(from), depth(to));
            if (a < 0.0) != (b < 0.0) {
                kept.push(from + (to - from) * (a / (a - b)));
            }
            if b >= 0.0 {
                kept.push(to);
            }
        }
        polygon = kept;
    }
    let doubled: f64 = polygon.iter().enumerate().map(|(i, p)| p.perp_dot(polygon[(i + 1) % polygon.len()])).sum();
    0.5 * doubled.abs()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pixel_areas_of_a_disc_add_up_to_the_disc() {
        for n in [1, 2, 7, 64] {
            let grid = Pixels::over(Shape::Disk { radius: 1.3 }, Frame::WORLD, DVec3::ONE, [n, n + 3]);
            let total: f64 = grid.areas.iter().sum();
            assert!((total / (std::f64::consts::PI * 1.69) - 1.0).abs() < 1e-12, "{n}: {total}");
        }
    }

    #[test]
    fn pixel_areas_of_a_polygon_add_up_to_the_polygon() {
        let hexagon: Vec<[DVec3; 3]> = (0..6)
            .map(|i| {
                let corner = |k: f64| {
                    let angle = (i as f64 + k) * std::f64::consts::FRAC_PI_3 + 0.1;
                    DVec3::new(angle.cos(), angle.sin(), 0.0)
                };
                [DVec3::ZERO, corner(0.0), corner(1.0)]
            })
            .collect();
        let grid =
            Pixels::new(Frame::WORLD, DVec3::ZERO, DVec2::splat(-1.0), DVec2::splat(1.0), [13, 9]).within(&hexagon);
        let total: f64 = grid.areas.iter().sum();
        assert!((total - 1.5 * 3f64.sqrt()).abs() < 1e-12);
    }

    #[test]
    fn columns_run_along_x_and_rows_along_y() {
        let grid = Pixels::new(Frame::WORLD, DVec3::ZERO, DVec2::new(-2.0, -1.0), DVec2::new(2.0, 1.0), [4, 2]);
        let bin = |x: f64, y: f64| {
            let point = DVec3::new(x, y, 0.0);
            grid.bin(&Arrival { point, direction: DVec3::Z, wavelength: 550e-9, triangle: None })
        };
        assert_eq!(bin(-1.9, -0.9), Some(0));
        assert_eq!(bin(1.9, -0.9), Some(3));
        assert_eq!(bin(-1.9, 0.9), Some(4));
        assert_eq!(bin(2.1, 0.0), None);
    }
}

//! What a picture of a map shows in each of its pixels.

use super::Span;
use crate::tally::results::{Axis, MapKind, MapResult};
use std::f64::consts::TAU;

/// Longest side of a field, pixels: larger maps are averaged, over whole bins, for the picture only.
const LONGEST: usize = 1024;

/// Width over height, or height over width, beyond which a picture is stretched to remain legible.
const SLENDER: f64 = 8.0;

/// Side of the disc that shows directions, pixels.
const DISC: usize = 480;

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Cell {
    /// Not on the detector.
    Outside,
    /// No ray arrived here.
    Dark,
    /// In the map's unit.
    Lit(f64),
}

/// Pixels, row 0 at the bottom, and what their edges mean.
pub struct Field {
    /// [rows, columns] of `cells`.
    pub shape: [usize; 2],
    pub cells: Vec<Cell>,
    /// Columns, then rows. `None` for a detector whose bins have no order in space.
    pub spans: Option<[Span; 2]>,
    /// Bins averaged into one pixel, along each side.
    pub averaged: usize,
}

impl Field {
    /// The map itself.
    pub fn of(map: &MapResult) -> Field {
        Field::new(map, &map.mean)
    }

    /// Standard error over mean in %, where there is light.
    pub fn relative_error(map: &MapResult) -> Field {
        let percent: Vec<f64> = map.mean.iter().zip(&map.error).map(|(mean, error)| 100.0 * error / mean).collect();
        Field::new(map, &percent)
    }

    /// `values`, one per bin, as the bins of the map lie.
    fn new(map: &MapResult, values: &[f64]) -> Field {
        match (&map.axes, map.kind) {
            (Some(axes), MapKind::Plane) => Field::plane(map, values, axes),
            (Some(axes), MapKind::Polar | MapKind::Projected) => Field::disc(map, values, axes),
            _ => Field::grid(map, values),
        }
    }

    fn plane(map: &MapResult, values: &[f64], axes: &[Axis; 2]) -> Field {
        let [rows, columns] = map.shape;
        Field { spans: Some([span(&axes[0], columns), span(&axes[1], rows)]), ..Field::grid(map, values) }
    }

    /// Bins as they lie, averaged over squares where there are too many.
    fn grid(map: &MapResult, values: &[f64]) -> Field {
        let [rows, columns] = map.shape;
        let side = rows.max(columns).div_ceil(LONGEST).max(1);
        let shape = [rows.div_ceil(side), columns.div_ceil(side)];
        let pixels = (0..shape[0]).flat_map(|row| (0..shape[1]).map(move |column| (row, column)));
        let cells = pixels.map(|(row, column)| average(map, values, [row * side, column * side], side)).collect();
        Field { shape, cells, spans: None, averaged: side }
    }

    /// Directions on a disc: distance from the centre is the polar angle (or its sine), azimuth runs anticlockwise from the right.
    fn disc(map: &MapResult, values: &[f64], axes: &[Axis; 2]) -> Field {
        let [azimuth, polar] = axes;
        let sine = map.kind == MapKind::Projected;
        let last = polar.start + polar.step * map.shape[0] as f64;
        let rim = if sine { last.max(0.0).sqrt() } else { last };
        let offset = |pixel: usize| (2.0 * (pixel as f64 + 0.5) / DISC as f64 - 1.0) * rim;
        let cell = |index: usize| {
            let (x, y) = (offset(index % DISC), offset(index / DISC));
            let radius = x.hypot(y);
            let row = position(polar, if sine { radius * radius } else { radius });
            let turns = (y.atan2(x) - azimuth.start).rem_euclid(TAU);
            let column = (turns / azimuth.step.abs()).floor().max(0.0) as usize;
            match row {
                Some(row) if row < map.shape[0] && column < map.shape[1] => bin(map, values, row, column),
                _ => Cell::Outside,
            }
        };
        let (radius, rim) = if sine { ("sin θ", rim) } else { ("θ", rim.to_degrees()) };
        let unit = if sine { "" } else { "deg" };
        let span = |part: &str| Span { name: format!("{radius} {part} φ"), unit, from: -rim, to: rim };
        Field {
            shape: [DISC, DISC],
            cells: (0..DISC * DISC).map(cell).collect(),
            spans: Some([span("cos"), span("sin")]),
            averaged: 1,
        }
    }

    /// Width over height of the picture: as on the detector, but never more slender than 8 : 1. A detector whose bins have no order in
    /// space is a ribbon.
    pub fn aspect(&self) -> f64 {
        let aspect = self.true_aspect().unwrap_or(f64::INFINITY);
        if aspect > 0.0 { aspect.clamp(1.0 / SLENDER, SLENDER) } else { 1.0 }
    }

    /// Whether both axes have one scale.
    pub fn true_to_scale(&self) -> bool {
        self.true_aspect().is_none_or(|aspect| (1.0 / SLENDER..=SLENDER).contains(&aspect))
    }

    fn true_aspect(&self) -> Option<f64> {
        let [x, y] = self.spans.as_ref()?;
        Some((x.to - x.from).abs() / (y.to - y.from).abs())
    }

    /// Cells that are lit, in the map's unit.
    pub fn lit(&self) -> impl Iterator<Item = f64> {
        self.cells.iter().filter_map(|cell| if let Cell::Lit(value) = cell { Some(*value) } else { None })
    }

    pub fn has_dark(&self) -> bool {
        self.cells.contains(&Cell::Dark)
    }
}

/// Bin number along an axis; `None` below its start.
fn position(axis: &Axis, value: f64) -> Option<usize> {
    let bins = (value - axis.start) / axis.step;
    (bins >= 0.0).then_some(bins as usize)
}

fn bin(map: &MapResult, values: &[f64], row: usize, column: usize) -> Cell {
    let index = row * map.shape[1] + column;
    let value = values[index];
    match map.rays[index] {
        0 if map.extent[index] <= 0.0 => Cell::Outside,
        0 => Cell::Dark,
        _ if value.is_finite() => Cell::Lit(value),
        _ => Cell::Dark,
    }
}

/// Mean over a square of bins, weighted with their size.
fn average(map: &MapResult, values: &[f64], [row, column]: [usize; 2], side: usize) -> Cell {
    if side == 1 {
        return bin(map, values, row, column);
    }
    let (mut flux, mut extent, mut lit) = (0.0, 0.0, false);
    for row in row..(row + side).min(map.shape[0]) {
        for column in column..(column + side).min(map.shape[1]) {
            let size = map.extent[row * map.shape[1] + column];
            extent += size;
            if let Cell::Lit(value) = bin(map, values, row, column) {
                flux += value * size;
                lit = true;
            }
        }
    }
    match (extent > 0.0, lit) {
        (true, true) => Cell::Lit(flux / extent),
        (true, false) => Cell::Dark,
        (false, _) => Cell::Outside,
    }
}

fn span(axis: &Axis, bins: usize) -> Span {
    let (unit, factor) = match axis.unit {
        "m" => ("mm", 1e3),
        "rad" => ("deg", 180.0 / std::f64::consts::PI),
        _ => ("", 1.0),
    };
    let end = axis.start + axis.step * bins as f64;
    Span { name: axis.name.clone(), unit, from: factor * axis.start, to: factor * end }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn axis(name: &str, unit: &'static str, step: f64) -> Axis {
        Axis { name: name.into(), unit, start: 0.0, step }
    }

    fn map(kind: MapKind, shape: [usize; 2], axes: [Axis; 2]) -> MapResult {
        let bins = shape[0] * shape[1];
        MapResult {
            detector: "d".into(),
            filter: None,
            kind,
            shape,
            axes: Some(axes),
            unit: "W/sr",
            mean: (0..bins).map(|bin| bin as f64 + 1.0).collect(),
            error: vec![0.5; bins],
            rays: vec![100; bins],
            upper: vec![0.0; bins],
            extent: vec![1.0; bins],
            origin: [0.0; 3],
            column_direction: [1.0, 0.0, 0.0],
            row_direction: [0.0, 1.0, 0.0],
            side: "front",
        }
    }

    #[test]
    fn directions_lie_anticlockwise_from_the_right_and_the_axis_in_the_centre() {
        let axes = [axis("azimuth", "rad", TAU / 4.0), axis("polar angle", "rad", 0.4)];
        let field = Field::of(&map(MapKind::Polar, [2, 4], axes));
        let at = |x: f64, y: f64| {
            let pixel = |part: f64| (0.5 * (part + 1.0) * DISC as f64) as usize;
            field.cells[pixel(y) * DISC + pixel(x)]
        };
        assert_eq!(at(0.2, 0.1), Cell::Lit(1.0)); // row 0, first quarter turn
        assert_eq!(at(-0.1, 0.2), Cell::Lit(2.0));
        assert_eq!(at(0.1, -0.9), Cell::Lit(8.0)); // row 1, last quarter turn
        assert_eq!(at(0.9, 0.9), Cell::Outside);
    }

    #[test]
    fn what_is_outside_the_detector_is_not_dark() {
        let mut map = map(MapKind::Plane, [1, 3], [axis("x", "m", 1e-3), axis("y", "m", 1e-3)]);
        (map.rays, map.extent) = (vec![0, 0, 9], vec![0.0, 1.0, 1.0]);
        assert_eq!(Field::of(&map).cells, [Cell::Outside, Cell::Dark, Cell::Lit(3.0)]);
    }

    #[test]
    fn averaging_a_large_map_keeps_its_flux() {
        let axes = [axis("x", "m", 1e-3), axis("y", "m", 1e-3)];
        let map = map(MapKind::Plane, [2, 2 * LONGEST], axes);
        let field = Field::of(&map);
        assert_eq!((field.averaged, field.shape), (2, [1, LONGEST]));
        let flux = 4.0 * field.lit().sum::<f64>();
        assert!((flux / map.mean.iter().sum::<f64>() - 1.0).abs() < 1e-12);
    }
}

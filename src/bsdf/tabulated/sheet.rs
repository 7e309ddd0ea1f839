//! A function on a grid, bilinear in its coordinates: evaluated, integrated and drawn from, all exactly the same function.
//!
//! Values of two bytes, times one factor in double precision, *are* the function. An event waits for memory more than for anything else,
//! and what is rounded is the table, by less than a part in two thousand; its integral and its draws are those of the rounded values.
//!
//! Draws take an edge of a ring by its flux, then an edge of a sector by adding up the row of values, then a place under their hats.

use super::grid::{Grid, Place};
use super::half::Half;
use crate::math::alias::Alias;
use glam::DVec3;

/// BRDF at one incidence over a [`Grid`], bilinear in (q, phi).
#[derive(Clone, Debug)]
pub struct Sheet {
    /// At the corners, in units of `factor`.
    value: Vec<Half>,
    /// BRDF of the value 1, 1/sr.
    factor: f64,
    /// Sum of the values of each row times the arcs of the sectors.
    rows: Vec<f64>,
    /// Over the rows, in proportion to their flux.
    rings: Alias,
    /// Scattered / incident flux.
    flux: f64,
}

/// Corners whose masses are added up at once.
const BLOCK: usize = 8;

impl Sheet {
    /// The function with these values (>= 0) at the corners of `grid`, times a factor that makes its flux (the integral of f cos dw)
    /// `flux`; the zero function where the values have no integral.
    pub fn new(grid: &Grid, value: &[f64], flux: f64) -> Sheet {
        let most = value.iter().copied().fold(0.0, f64::max);
        let value: Vec<Half> =
            value.iter().map(|f| if most > 0.0 { Half::new(f / most) } else { Half::ZERO }).collect();
        let rows: Vec<f64> = value.chunks(grid.columns()).map(|row| masses(row, &grid.arcs).sum()).collect();
        let mass: Vec<f64> = rows.iter().zip(&grid.widths).map(|(row, width)| row * width).collect();
        let total: f64 = mass.iter().sum();
        let (flux, factor) = if total > 0.0 { (flux, flux / total) } else { (0.0, 0.0) };
        Sheet { value, factor, rows, rings: Alias::new(&mass), flux }
    }

    /// Scattered / incident flux.
    pub fn flux(&self) -> f64 {
        self.flux
    }

    /// The value at a place of `grid`, 1/sr.
    pub fn at(&self, grid: &Grid, place: &Place) -> f64 {
        let [u, v] = place.way;
        let row = |at: usize| (1.0 - v) * self.value[at].value() + v * self.value[at + 1].value();
        self.factor * ((1.0 - u) * row(place.corner) + u * row(place.corner + grid.columns()))
    }

    /// A direction with density value cos(theta) / flux per sr, by two uniform numbers. The flux must be positive.
    pub fn draw(&self, grid: &Grid, [first, second]: [f64; 2]) -> DVec3 {
        let (ring, way) = self.rings.draw(first);
        let (side, turn) = grid.side(second);
        let columns = grid.columns();
        let (sector, arc) = taken(&self.value[ring * columns..][..columns], &grid.arcs, turn * self.rows[ring]);
        let d = grid.draw([ring, sector], [way, arc]);
        DVec3::new(d.x, side * d.y, d.z)
    }
}

/// The mass of every corner of a row.
fn masses(row: &[Half], arcs: &[f64]) -> impl Iterator<Item = f64> {
    row.iter().zip(arcs).map(|(value, arc)| value.value() * arc)
}

/// Among the masses of a row, one after the other, the one that reaches beyond `rest`, and the part of it below.
fn taken(row: &[Half], arcs: &[f64], mut rest: f64) -> (usize, f64) {
    // Blocks at a time: the sums of several do not wait for each other.
    let mut passed = 0;
    for (row, arcs) in row.as_chunks::<BLOCK>().0.iter().zip(arcs.as_chunks::<BLOCK>().0) {
        let mass = masses(row, arcs).sum();
        if rest < mass {
            break;
        }
        rest -= mass;
        passed += BLOCK;
    }
    for (at, mass) in masses(&row[passed..], &arcs[passed..]).enumerate() {
        if rest < mass {
            return (passed + at, rest / mass);
        }
        rest -= mass;
    }
    // Rounding has left none: the last that has a mass, to its end.
    (row.iter().rposition(|value| *value != Half::ZERO).unwrap_or(0), 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Rng;
    use std::f64::consts::{PI, TAU};

    fn grid() -> Grid {
        // Sectors that widen.
        Grid::new(9, (0..=48).map(|j| TAU * (f64::from(j) / 48.0).powf(1.1)).collect())
    }

    #[test]
    fn a_constant_is_drawn_by_the_cosine_law() {
        let grid = grid();
        let sheet = Sheet::new(&grid, &vec![7.0; grid.len()], 0.5);
        assert!((sheet.flux() - 0.5).abs() < 1e-15);
        let d = DVec3::new(0.48, -0.36, 0.8);
        assert!((sheet.at(&grid, &grid.place(d)) - 0.5 / PI).abs() < 1e-15);
        let mut rng = Rng::new(1, 2, 3);
        let mean = (0..100_000).map(|_| sheet.draw(&grid, rng.pair()).z).sum::<f64>() / 1e5;
        // <cos> = 2/3, sigma 0.236 / sqrt(1e5).
        assert!((mean - 2.0 / 3.0).abs() < 0.003, "{mean}");
    }

    #[test]
    fn nothing_is_drawn_where_the_function_is_zero() {
        let grid = grid();
        let mut value = vec![0.0; grid.len()];
        value[3 * grid.columns() + 2] = 1.0;
        let sheet = Sheet::new(&grid, &value, 0.1);
        let mut rng = Rng::new(1, 2, 3);
        let edges = [0.0, 0.5, 1.0 - f64::EPSILON / 2.0];
        let corners = edges.iter().flat_map(|&a| edges.map(|b| [a, b]));
        for uv in corners.chain((0..1000).map(|_| rng.pair())) {
            let d = sheet.draw(&grid, uv);
            assert!(sheet.at(&grid, &grid.place(d)) > 0.0, "{uv:?}: {d}");
        }
    }

    #[test]
    fn draws_follow_the_function_on_both_sides_of_a_folded_grid() {
        let folded = Grid::new(9, (0..=20).map(|j| PI * f64::from(j) / 20.0).collect());
        let function = |d: DVec3| 1.0 + 0.5 * d.x + d.x * d.x;
        let value: Vec<f64> = folded.corners().map(function).collect();
        let sheet = Sheet::new(&folded, &value, 1.0);
        let (mut rng, mut sums) = (Rng::new(1, 2, 3), [0.0; 3]);
        for _ in 0..100_000 {
            let d = sheet.draw(&folded, rng.pair());
            let each = PI * sheet.at(&folded, &folded.place(d));
            // The mean of 1 / f over draws of f is the area.
            sums = [sums[0] + 1.0 / each, sums[1] + d.x / each, sums[2] + d.y];
        }
        // Sigma of each mean: 0.3 / sqrt(1e5) or less; of y 0.5 / sqrt(1e5).
        let [area, along, across] = sums.map(|sum| sum / 1e5);
        assert!((area - 1.0).abs() < 0.004 && along.abs() < 0.007 && across.abs() < 0.007, "{area} {along} {across}");
    }

    #[test]
    fn a_function_without_flux_is_zero() {
        let grid = grid();
        assert_eq!(Sheet::new(&grid, &vec![0.0; grid.len()], 0.1).flux(), 0.0);
    }
}

//! A function on a grid, bilinear in its coordinates: evaluated, integrated and drawn from, all exactly the same function.

use super::grid::{Grid, Place, invert};
use crate::math::alias::Alias;
use glam::DVec3;

/// BRDF at one incidence over a [`Grid`], bilinear in (q, phi).
#[derive(Clone, Debug)]
pub struct Sheet {
    /// At the corners, 1/sr.
    value: Vec<f64>,
    /// Over cells \[ring\]\[sector\], in proportion to their flux.
    cells: Alias,
    /// Scattered / incident flux.
    flux: f64,
}

impl Sheet {
    /// The function with these values (>= 0) at the corners of `grid`, times a factor that makes its flux (the integral of f cos dw)
    /// `flux`; the zero function where the values have no integral.
    pub fn new(grid: &Grid, mut value: Vec<f64>, flux: f64) -> Sheet {
        let mass = masses(grid, &value);
        let total: f64 = mass.iter().sum();
        let factor = if total > 0.0 { flux / total } else { 0.0 };
        value.iter_mut().for_each(|f| *f *= factor);
        Sheet { value, cells: Alias::new(&mass), flux: factor * total }
    }

    /// Scattered / incident flux.
    pub fn flux(&self) -> f64 {
        self.flux
    }

    /// The value at a place of `grid`, 1/sr.
    pub fn at(&self, grid: &Grid, place: &Place) -> f64 {
        let [u, v] = place.way;
        let row = |at: usize| (1.0 - v) * self.value[at] + v * self.value[at + 1];
        (1.0 - u) * row(place.corner) + u * row(place.corner + grid.phi.len())
    }

    /// A direction with density value cos(theta) / flux per sr, by two uniform numbers. The flux must be positive.
    pub fn draw(&self, grid: &Grid, [first, second]: [f64; 2]) -> DVec3 {
        let columns = grid.phi.len();
        let (cell, rest) = self.cells.draw(first);
        let (ring, sector) = (cell / (columns - 1), cell % (columns - 1));
        let corner = ring * columns + sector;
        let (low, high) = (&self.value[corner..corner + 2], &self.value[corner + columns..corner + columns + 2]);
        let u = invert(low[0] + low[1], high[0] + high[1], rest);
        let edge = |j: usize| (1.0 - u) * low[j] + u * high[j];
        let v = invert(edge(0), edge(1), second);
        let square = grid.square[ring] + u * (grid.square[ring + 1] - grid.square[ring]);
        grid.direction(square, grid.phi[sector] + v * (grid.phi[sector + 1] - grid.phi[sector]))
    }
}

/// Integral of the function over each cell: the mean of the corners times dq dphi / 2.
fn masses(grid: &Grid, value: &[f64]) -> Vec<f64> {
    let columns = grid.phi.len();
    let mass = |ring: usize, sector: usize| {
        let at = ring * columns + sector;
        let sum = (value[at] + value[at + 1]) + (value[at + columns] + value[at + columns + 1]);
        let area = 0.5 * (grid.square[ring + 1] - grid.square[ring]) * (grid.phi[sector + 1] - grid.phi[sector]);
        0.25 * sum * area
    };
    let rings = 0..grid.square.len() - 1;
    rings.flat_map(|ring| (0..columns - 1).map(move |sector| (ring, sector))).map(|(i, j)| mass(i, j)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Rng;
    use std::f64::consts::PI;

    fn grid() -> Grid {
        Grid::new(9, vec![0.0, 1.0, 2.5, 4.0, 2.0 * PI])
    }

    #[test]
    fn a_constant_is_drawn_by_the_cosine_law() {
        let grid = grid();
        let sheet = Sheet::new(&grid, vec![7.0; grid.len()], 0.5);
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
        value[3 * 5 + 2] = 1.0;
        let sheet = Sheet::new(&grid, value, 0.1);
        let mut rng = Rng::new(1, 2, 3);
        let edges = [0.0, 0.5, 1.0 - f64::EPSILON / 2.0];
        let corners = edges.iter().flat_map(|&a| edges.map(|b| [a, b]));
        for uv in corners.chain((0..1000).map(|_| rng.pair())) {
            let d = sheet.draw(&grid, uv);
            assert!(sheet.at(&grid, &grid.place(d)) > 0.0, "{uv:?}: {d}");
        }
    }

    #[test]
    fn a_function_without_flux_is_zero() {
        let grid = grid();
        assert_eq!(Sheet::new(&grid, vec![0.0; grid.len()], 0.1).flux(), 0.0);
    }
}

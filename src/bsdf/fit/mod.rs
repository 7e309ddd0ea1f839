//! Fits of a law to measured scatter.
//!
//!     sum over all entries of (ln f_law - ln f_measured)^2  ->  minimum
//!
//! over all incidences and directions at once, in the logarithms of the four coefficients: a scatter that spans decades is met equally well in
//! its peak and in its wings. Entries that are zero are left out: nothing was measured there, or nothing was seen. Errors are those of
//! least squares with residuals that are independent; of a law that does not fit they say little.
//!
//! Left out: weights by solid angle or by the noise of the instrument, which tables do not state.

mod law;

use super::Bsdf;
use super::radial::Side;
use super::tabulated::Table;
use crate::math::least_squares::minimise;
use crate::optics::Incidence;

pub use law::Law;

/// An entry of a table.
#[derive(Clone, Copy, Debug)]
pub struct Point {
    /// Angle of incidence, rad.
    pub incidence: f64,
    /// |beta - beta0|, dimensionless.
    pub x: f64,
    /// Cosines of incidence and scatter with the normal.
    pub cosines: [f64; 2],
    /// Sine of the scattering angle in the plane of incidence, positive beyond the normal; `None` outside of the plane.
    pub in_plane: Option<f64>,
    /// 1/sr, > 0
    pub value: f64,
}

/// Where a direction counts as in the plane of incidence: |beta| across it.
const PLANE: f64 = 1e-6;

/// The entries of a table above zero, at factor 1 of its spectrum times `factor`.
pub fn points(table: &Table, factor: f64) -> Vec<Point> {
    let of = |lobe: &super::tabulated::Lobe| {
        let (sin, cos) = lobe.incidence().sin_cos();
        let incidence = lobe.incidence();
        let point = move |(d, value): (glam::DVec3, f64)| Point {
            incidence,
            x: (d.x - sin).hypot(d.y),
            cosines: [cos, d.z],
            in_plane: (d.y.abs() < PLANE).then_some(d.x),
            value: factor * value,
        };
        lobe.entries().into_iter().map(point).filter(|point| point.value > 0.0).collect::<Vec<_>>()
    };
    table.lobes().iter().flat_map(of).collect()
}

/// A law with its coefficients.
#[derive(Clone, Debug)]
pub struct Fit {
    pub law: Law,
    /// As [`Law::coefficients`] names them.
    pub values: [f64; 4],
    /// One standard error each; infinite where the points do not determine it.
    pub errors: [f64; 4],
    /// Rms of ln (law / measured).
    pub rms: f64,
    /// Largest |ln (law / measured)|, and at which point.
    pub largest: (f64, usize),
}

/// Widths and slopes of the lobe from which the search starts.
const WIDTHS: [f64; 4] = [1e-3, 0.01, 0.1, 0.5];
const SLOPES: [f64; 2] = [1.6, 3.0];

/// The best fit of a law. `None` if there are not more points than coefficients, or nothing was found. Cost: some 1000 evaluations of the law
/// at every point.
pub fn fit(points: &[Point], law: Law) -> Option<Fit> {
    let low = points.iter().map(|point| point.value).fold(f64::INFINITY, f64::min);
    let high = points.iter().map(|point| point.value).fold(0.0, f64::max);
    let measured: Vec<f64> = points.iter().map(|point| point.value.ln()).collect();
    let residuals = |logarithms: &[f64]| -> Vec<f64> {
        let f = law.at(exponentials(logarithms));
        points.iter().zip(&measured).map(|(point, measured)| f(point).ln() - measured).collect()
    };
    let starts = WIDTHS.iter().flat_map(|width| SLOPES.map(|slope| law.guess(high, *width, slope, 0.5 * low)));
    let found = starts.filter_map(|start| minimise(start.map(f64::ln).to_vec(), &residuals));
    let best = found.filter(|_| points.len() > 4).min_by(|a, b| a.squares.total_cmp(&b.squares))?;
    let values = exponentials(&best.values);
    let errors = std::array::from_fn(|i| values[i] * best.errors[i]);
    let apart = residuals(&best.values).into_iter().map(f64::abs).enumerate();
    let largest = apart.map(|(at, apart)| (apart, at)).max_by(|a, b| a.0.total_cmp(&b.0))?;
    Some(Fit { law, values, errors, rms: (best.squares / points.len() as f64).sqrt(), largest })
}

fn exponentials(logarithms: &[f64]) -> [f64; 4] {
    std::array::from_fn(|i| logarithms[i].exp())
}

impl Fit {
    /// BSDF at a point, 1/sr.
    pub fn at(&self, point: &Point) -> f64 {
        self.law.at(self.values)(point)
    }

    /// Scattered / incident flux in air at angles of incidence (rad).
    pub fn tis(&self, incidence: &[f64], side: Side) -> Vec<f64> {
        // Only a K-correlation knows its wavelength, and needs it.
        let wavelength = if let Law::KCorrelation { wavelength, .. } = self.law { wavelength } else { 1e-6 };
        let lobes: Vec<Box<dyn Bsdf>> = self.law.lobes(self.values, side);
        let at = |theta: &f64| {
            let at = Incidence::in_air(*theta, wavelength);
            lobes.iter().map(|lobe| lobe.albedo(&at)).sum()
        };
        incidence.iter().map(at).collect()
    }

    /// True if the floor is below a thousandth of the least of the points: there is none.
    pub fn is_bare(&self, points: &[Point]) -> bool {
        let least = points.iter().map(|point| point.value).fold(f64::INFINITY, f64::min);
        self.values[3] < 1e-3 * std::f64::consts::PI * least
    }
}

#[cfg(test)]
mod tests;

//! Which wavelengths light has. A band costs no more than a line: every ray draws one vacuum wavelength.

use super::planck::C2;

/// Flux against vacuum wavelength, normalised.
#[derive(Clone, Debug, PartialEq)]
pub enum Spectrum {
    /// One wavelength, m.
    Line(f64),
    /// Wavelengths (m) with running sums of their shares, the last 1.
    Lines(Vec<(f64, f64)>),
    /// Piecewise linear density over wavelength.
    Table(Density),
}

/// A piecewise linear density.
#[derive(Clone, Debug, PartialEq)]
pub struct Density {
    /// Rising, m.
    wavelengths: Vec<f64>,
    /// Per m, relative.
    weights: Vec<f64>,
    /// Running integral, relative; the first 0.
    cumulative: Vec<f64>,
}

impl Spectrum {
    /// Lines with relative powers (> 0 in sum).
    pub fn lines(lines: &[(f64, f64)]) -> Spectrum {
        let total: f64 = lines.iter().map(|line| line.1).sum();
        let mut running = 0.0;
        let cumulative = lines.iter().map(|&(wavelength, power)| {
            running += power / total;
            (wavelength, running)
        });
        Spectrum::Lines(cumulative.collect())
    }

    /// Piecewise linear flux per wavelength: wavelengths (m, rising) with relative weights.
    pub fn table(points: &[(f64, f64)]) -> Spectrum {
        Spectrum::Table(Density::table(points))
    }

    /// Planck's law between `from` and `to` (m), T in K.
    pub fn black_body(temperature: f64, from: f64, to: f64) -> Spectrum {
        Spectrum::Table(Density::black_body(temperature, from, to))
    }

    /// The wavelength (m) below which the fraction `u` of the flux lies.
    pub fn wavelength(&self, u: f64) -> f64 {
        match self {
            Spectrum::Line(wavelength) => *wavelength,
            Spectrum::Lines(lines) => lines[lines.partition_point(|line| line.1 <= u).min(lines.len() - 1)].0,
            Spectrum::Table(density) => density.quantile(u),
        }
    }

    /// Shortest and longest wavelength, m.
    pub fn range(&self) -> [f64; 2] {
        let ends = |values: &mut dyn Iterator<Item = f64>| {
            values.fold([f64::INFINITY, 0.0], |[low, high]: [f64; 2], x| [low.min(x), high.max(x)])
        };
        match self {
            Spectrum::Line(wavelength) => [*wavelength; 2],
            Spectrum::Lines(lines) => ends(&mut lines.iter().map(|line| line.0)),
            Spectrum::Table(density) => ends(&mut density.wavelengths.iter().copied()),
        }
    }
}

impl Density {
    /// Piecewise linear: wavelengths (m, rising) with relative weights.
    fn table(points: &[(f64, f64)]) -> Density {
        let (wavelengths, weights): (Vec<f64>, Vec<f64>) = points.iter().copied().unzip();
        let mut cumulative = vec![0.0];
        for i in 1..points.len() {
            let area = 0.5 * (weights[i] + weights[i - 1]) * (wavelengths[i] - wavelengths[i - 1]);
            cumulative.push(cumulative[i - 1] + area);
        }
        Density { wavelengths, weights, cumulative }
    }

    /// Planck's exitance lambda^-5 / (exp(C2 / (lambda T)) - 1) between `from` and `to` (m), T in K, in 512 linear pieces of equal
    /// ratio.
    pub fn black_body(temperature: f64, from: f64, to: f64) -> Density {
        let planck = |x: f64| x.powi(-5) / (C2 / (x * temperature)).exp_m1();
        let peak = planck((C2 / (4.965_114 * temperature)).clamp(from, to));
        let point = |i: usize| from * (to / from).powf(i as f64 / 512.0);
        Density::table(&(0..=512).map(|i| (point(i), planck(point(i)) / peak)).collect::<Vec<_>>())
    }

    /// Share of the flux per wavelength, 1/m; within the range.
    pub fn at(&self, wavelength: f64) -> f64 {
        let last = self.wavelengths.len() - 1;
        let piece = self.wavelengths.partition_point(|&x| x <= wavelength).clamp(1, last);
        let (a, b) = (self.weights[piece - 1], self.weights[piece]);
        let step = self.wavelengths[piece] - self.wavelengths[piece - 1];
        let weight = a + (b - a) * (wavelength - self.wavelengths[piece - 1]) / step;
        weight / self.cumulative[last]
    }

    /// The wavelength (m) below which the fraction `u` of the flux lies. In a piece with weights a, b over h, a t + (b - a) t^2 / (2 h) = rest, solved in
    /// the form that does not cancel.
    pub fn quantile(&self, u: f64) -> f64 {
        let target = u * self.cumulative[self.cumulative.len() - 1];
        let piece = self.cumulative.partition_point(|&c| c <= target).clamp(1, self.cumulative.len() - 1);
        let (a, b) = (self.weights[piece - 1], self.weights[piece]);
        let step = self.wavelengths[piece] - self.wavelengths[piece - 1];
        let rest = target - self.cumulative[piece - 1];
        let root = (a * a + 2.0 * (b - a) * rest / step).max(0.0).sqrt();
        let along = if a + root > 0.0 { 2.0 * rest / (a + root) } else { 0.0 };
        self.wavelengths[piece - 1] + along.min(step)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_invert_the_running_integral() {
        let Spectrum::Table(density) = Spectrum::table(&[(1.0, 0.0), (2.0, 3.0), (4.0, 1.0), (5.0, 0.0)]) else {
            unreachable!()
        };
        // Integrals by hand: 1.5, 4, 0.5 of 6.
        assert!((density.quantile(0.25) - 2.0).abs() < 1e-12);
        assert!((density.quantile(5.5 / 6.0) - 4.0).abs() < 1e-12);
        assert!((density.quantile(0.0) - 1.0).abs() < 1e-12 && density.quantile(1.0 - 1e-16) <= 5.0);
    }

    /// Fraction of a black body's power below lambda T = 2898 um K is 0.2501 (Siegel & Howell, table of black-body functions).
    #[test]
    fn a_quarter_of_planck_lies_below_the_peak() {
        let spectrum = Spectrum::black_body(5778.0, 0.05e-6, 60e-6);
        let peak = 2897.77e-6 / 5778.0;
        let fraction =
            (0..100_000).filter(|&i| spectrum.wavelength((i as f64 + 0.5) / 1e5) < peak).count() as f64 / 1e5;
        assert!((fraction - 0.2501).abs() < 0.001, "{fraction}");
    }
}

//! A phase function given as a table over the scattering angle: linear in its cosine between the rows.

use super::{Bulk, Spectrum};
use crate::math::Rng;
use crate::math::table::{Discrete, linear};
use std::f64::consts::{PI, TAU};

/// A density over the cosine in [-1, 1] that is linear between nodes.
#[derive(Clone, Debug)]
pub struct Cosines {
    /// Rising, from -1 to 1.
    cosine: Vec<f64>,
    /// Per solid angle, 1/sr; integral over the sphere 1.
    phase: Vec<f64>,
    /// The light between two nodes.
    intervals: Discrete,
}

impl Cosines {
    /// Rows of (cosine of the scattering angle, relative value >= 0) with rising cosines; the end values are held out to -1 and 1.
    /// `None` if the cosines do not rise or leave [-1, 1], or nothing is scattered.
    pub fn new(rows: &[(f64, f64)]) -> Option<Cosines> {
        let (&(first, low), &(last, high)) = (rows.first()?, rows.last()?);
        if first < -1.0 || last > 1.0 || rows.windows(2).any(|w| w[0].0 >= w[1].0) {
            return None;
        }
        let before = (first > -1.0).then_some((-1.0, low));
        let after = (last < 1.0).then_some((1.0, high));
        let (cosine, mut phase): (Vec<f64>, Vec<f64>) =
            before.into_iter().chain(rows.iter().copied()).chain(after).unzip();
        let mass = |k: usize| 0.5 * (phase[k] + phase[k + 1]) * (cosine[k + 1] - cosine[k]);
        let masses: Vec<f64> = (0..cosine.len() - 1).map(mass).collect();
        let intervals = Discrete::new(&masses)?;
        let scale = 1.0 / (TAU * masses.iter().sum::<f64>());
        phase.iter_mut().for_each(|value| *value *= scale);
        Some(Cosines { cosine, phase, intervals })
    }

    /// 1/sr
    pub fn phase(&self, cosine: f64) -> f64 {
        linear(&self.cosine, &self.phase, cosine)
    }

    /// The cosine below which a share `u` in [0, 1) of the light lies.
    pub fn quantile(&self, u: f64) -> f64 {
        let (k, v) = self.intervals.draw(u);
        let [a, b] = [self.phase[k], self.phase[k + 1]];
        // Linear density a + (b - a) w on [0, 1]: its distribution is a quadratic in w, solved without cancellation.
        let w = v * (a + b) / (a + (a * a + v * (b * b - a * a)).max(0.0).sqrt());
        self.cosine[k] + w.clamp(0.0, 1.0) * (self.cosine[k + 1] - self.cosine[k])
    }

    /// Share of the light that goes into the hemisphere about a pole, `cosine` being that of the angle between the pole and the
    /// way straight on: of a ring of scattering angle g about an axis at angle t from the pole, the part acos(-cot g cot t) / pi.
    pub fn ahead(&self, cosine: f64) -> f64 {
        let sine = ((1.0 - cosine) * (1.0 + cosine)).max(0.0).sqrt();
        let part = |c: f64| {
            let s = ((1.0 - c) * (1.0 + c)).max(0.0).sqrt();
            let reach = c * cosine;
            if s * sine <= reach.abs() { f64::from(u8::from(reach > 0.0)) } else { (-reach / (s * sine)).acos() / PI }
        };
        let share = |k: usize| {
            let ([x, y], [a, b]) = ([self.cosine[k], self.cosine[k + 1]], [self.phase[k], self.phase[k + 1]]);
            TAU * 0.5 * (a + b) * (y - x) * part(0.5 * (x + y))
        };
        (0..self.cosine.len() - 1).map(share).sum()
    }

    /// Mean cosine.
    pub fn asymmetry(&self) -> f64 {
        let moment = |k: usize| {
            let ([x, y], [a, b]) = ([self.cosine[k], self.cosine[k + 1]], [self.phase[k], self.phase[k + 1]]);
            TAU * (y - x) * (a * (2.0 * x + y) + b * (x + 2.0 * y)) / 6.0
        };
        (0..self.cosine.len() - 1).map(moment).sum()
    }
}

/// Scattering coefficient (1/m) and the table.
#[derive(Clone, Debug)]
pub struct Tabulated {
    pub coefficient: Spectrum,
    pub cosines: Cosines,
}

impl Bulk for Tabulated {
    fn coefficient(&self, wavelength: f64) -> f64 {
        self.coefficient.at(wavelength)
    }

    fn phase(&self, cosine: f64, _wavelength: f64) -> f64 {
        self.cosines.phase(cosine)
    }

    fn draw(&self, _wavelength: f64, rng: &mut Rng) -> f64 {
        self.cosines.quantile(rng.uniform())
    }

    fn range(&self) -> Option<[f64; 2]> {
        self.coefficient.range()
    }
}

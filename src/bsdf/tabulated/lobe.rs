//! One measured lobe: BRDF over scattering angle at one incidence.

use crate::math::table::bracket;
use glam::DVec3;
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// Cosine below which a direction lies in the surface: the rounding of angles in degrees.
const HORIZON: f64 = 1e-9;

/// The direction from which polar angles count.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pole {
    /// The normal; azimuth 0 is the specular side.
    Normal,
    /// The specular direction; azimuth 0 is towards the normal, and on beyond it.
    Specular,
}

/// What lies beyond the last polar angle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Beyond {
    /// The last value.
    Hold,
    /// Nothing.
    Zero,
}

/// BRDF over polar angle and azimuth, bilinear between the entries; the polar angle's first row is held before it.
#[derive(Clone, Debug)]
pub struct Lobe {
    theta: Vec<f64>,
    phi: Vec<f64>,
    /// \[theta\]\[phi\], 1/sr.
    value: Vec<f64>,
    /// Angle of incidence, rad, and its sine and cosine.
    incidence: f64,
    pub(super) specular: (f64, f64),
    pole: Pole,
    beyond: Beyond,
}

impl Lobe {
    /// Lobe at `incidence` (rad) over `theta` (rad, strictly rising, 0..pi/2) from the normal and `phi` (rad, strictly rising from 0 to 2 pi) with
    /// `value[theta][phi]` (1/sr, finite, >= 0), the last row held beyond. `None` if the lengths do not fit or the angles do not rise.
    pub fn new(incidence: f64, theta: Vec<f64>, phi: Vec<f64>, value: Vec<f64>) -> Option<Lobe> {
        let rises = |a: &[f64]| a.len() > 1 && a.windows(2).all(|w| w[0] < w[1]);
        if !rises(&theta) || !rises(&phi) || value.len() != theta.len() * phi.len() {
            return None;
        }
        let specular = incidence.sin_cos();
        Some(Lobe { theta, phi, value, incidence, specular, pole: Pole::Normal, beyond: Beyond::Hold })
    }

    /// The same entries, counted from another direction and continued otherwise.
    pub fn about(self, pole: Pole, beyond: Beyond) -> Lobe {
        Lobe { pole, beyond, ..self }
    }

    /// BRDF towards `d` (1/sr) in the axes (forward, across, normal); below the horizon the value at the horizon.
    pub fn at(&self, d: DVec3) -> f64 {
        let d = DVec3::new(d.x, d.y, d.z.max(0.0));
        let from = match self.pole {
            Pole::Normal => d,
            Pole::Specular => {
                let (sin, cos) = self.specular;
                DVec3::new(d.z * sin - d.x * cos, d.y, d.x * sin + d.z * cos)
            }
        };
        let polar = from.truncate().length().atan2(from.z);
        if self.beyond == Beyond::Zero && polar > self.theta[self.theta.len() - 1] {
            return 0.0;
        }
        let (i, u) = bracket(&self.theta, polar);
        let phi = from.y.atan2(from.x);
        let (j, v) = bracket(&self.phi, if phi < 0.0 { phi + TAU } else { phi });
        let at = i * self.phi.len() + j;
        let row = |at: usize| self.value[at] + v * (self.value[at + 1] - self.value[at]);
        let (low, high) = (row(at), row(at + self.phi.len()));
        low + u * (high - low)
    }

    /// The entries above the horizon, each once: unit direction in the axes (forward, across, normal), and the value there, 1/sr. Where
    /// the two sides of the plane of incidence are alike, one of them.
    pub fn entries(&self) -> Vec<(DVec3, f64)> {
        let columns = self.phi.len();
        let value = |i: usize, j: usize| self.value[i * columns + j];
        let mirrored = |i: usize, j: usize| {
            let twin = self.phi.iter().position(|phi| (phi + self.phi[j] - TAU).abs() < 1e-9);
            self.phi[j] > PI + 1e-9 && twin.is_some_and(|twin| value(i, twin) == value(i, j))
        };
        let mut entries = Vec::new();
        for (i, theta) in self.theta.iter().enumerate() {
            // At the pole all azimuths are one direction, and the last azimuth is the first.
            let around = if *theta == 0.0 { 1 } else { columns - 1 };
            for j in (0..around).filter(|j| !mirrored(i, *j)) {
                let d = self.direction(*theta, self.phi[j]);
                if d.z > HORIZON {
                    entries.push((d, value(i, j)));
                }
            }
        }
        entries
    }

    /// The direction at polar angle `theta` and azimuth `phi` (rad): inverse of what [`Lobe::at`] does.
    fn direction(&self, theta: f64, phi: f64) -> DVec3 {
        let from = DVec3::new(theta.sin() * phi.cos(), theta.sin() * phi.sin(), theta.cos());
        match self.pole {
            Pole::Normal => from,
            Pole::Specular => {
                let (sin, cos) = self.specular;
                DVec3::new(from.z * sin - from.x * cos, from.y, from.x * sin + from.z * cos)
            }
        }
    }

    /// Scattered / incident flux. Of entries about the normal that reach the horizon: the trapezoidal sum of BRDF cos(theta) sin(theta)
    /// d theta d phi over them, with which such tables are written; else the integral, by midpoints of cells of equal projected solid angle.
    pub fn tis(&self) -> f64 {
        let whole = self.theta[self.theta.len() - 1] >= FRAC_PI_2 * (1.0 - 1e-9);
        if self.pole == Pole::Normal && whole { self.sum() } else { self.integral() }
    }

    fn sum(&self) -> f64 {
        let columns = self.phi.len();
        let ring = |i: usize| -> f64 {
            let row = &self.value[i * columns..(i + 1) * columns];
            let around: f64 = (1..columns).map(|j| 0.5 * (row[j] + row[j - 1]) * (self.phi[j] - self.phi[j - 1])).sum();
            around * self.theta[i].sin() * self.theta[i].cos()
        };
        (1..self.theta.len()).map(|i| 0.5 * (ring(i) + ring(i - 1)) * (self.theta[i] - self.theta[i - 1])).sum()
    }

    fn integral(&self) -> f64 {
        const RINGS: u32 = 300;
        let middle = |k: u32| (f64::from(k) + 0.5) / f64::from(RINGS);
        let cell = |i: u32, j: u32| {
            let (square, (sin, cos)) = (middle(i), (TAU * middle(j)).sin_cos());
            self.at(DVec3::new(square.sqrt() * cos, square.sqrt() * sin, (1.0 - square).sqrt()))
        };
        let sum: f64 = (0..RINGS).map(|i| (0..RINGS).map(|j| cell(i, j)).sum::<f64>()).sum();
        PI * sum / f64::from(RINGS * RINGS)
    }

    /// True if the two sides of the plane of incidence are alike, to the rounding of decimals.
    pub(super) fn symmetric(&self) -> bool {
        const ROUNDING: f64 = 1e-9;
        let last = self.phi.len() - 1;
        let near = |a: f64, b: f64| (a - b).abs() <= ROUNDING * a.abs().max(b.abs());
        let alike = |row: &[f64]| (0..=last).all(|j| near(row[j], row[last - j]));
        (0..=last).all(|j| near(self.phi[j] + self.phi[last - j], TAU)) && self.value.chunks(last + 1).all(alike)
    }

    /// Smallest step of theta, rad.
    pub(super) fn finest(&self) -> f64 {
        self.theta.windows(2).map(|w| w[1] - w[0]).fold(f64::INFINITY, f64::min)
    }

    /// Azimuths about the normal in which the lobe is told apart, rad: its own, or every 10 deg if they count from elsewhere.
    pub(super) fn azimuths(&self) -> Vec<f64> {
        match self.pole {
            Pole::Normal => self.phi.clone(),
            Pole::Specular => (0..=36).map(|j| TAU * f64::from(j) / 36.0).collect(),
        }
    }

    /// Angle of incidence, rad.
    pub fn incidence(&self) -> f64 {
        self.incidence
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn entries_are_met_and_the_horizon_is_held() {
        let lobe = Lobe::new(0.0, vec![0.0, 1.0, FRAC_PI_2], vec![0.0, PI, TAU], (0..9).map(f64::from).collect())
            .expect("three by three");
        let at =
            |theta: f64, phi: f64| lobe.at(DVec3::new(theta.sin() * phi.cos(), theta.sin() * phi.sin(), theta.cos()));
        assert!((at(1.0, 0.0) - 3.0).abs() < 1e-12);
        assert!((at(1.0, PI) - 4.0).abs() < 1e-12);
        assert!((at(0.5, 0.0) - 1.5).abs() < 1e-12);
        assert!((at(1.0, FRAC_PI_2) - 3.5).abs() < 1e-12);
        assert!((at(1.0, -FRAC_PI_2) - 4.5).abs() < 1e-12);
        assert!((at(2.0, PI) - 7.0).abs() < 1e-12);
    }

    #[test]
    fn entries_are_where_the_lobe_says() {
        let theta = vec![0.0, 0.3, 0.6];
        let value = [[5.0; 5], [4.0, 3.0, 2.0, 3.0, 4.0], [2.0, 1.5, 1.0, 1.2, 2.0]].concat();
        let phi = vec![0.0, 0.5 * PI, PI, 1.5 * PI, TAU];
        for pole in [Pole::Normal, Pole::Specular] {
            let lobe =
                Lobe::new(0.4, theta.clone(), phi.clone(), value.clone()).expect("a lobe").about(pole, Beyond::Zero);
            let entries = lobe.entries();
            // The pole, three sides of the first ring, four of the second.
            assert_eq!(entries.len(), 8);
            assert!(entries.iter().all(|(d, value)| (lobe.at(*d) - value).abs() < 1e-9), "{entries:?}");
        }
    }

    #[test]
    fn a_table_that_does_not_rise_is_none() {
        assert!(Lobe::new(0.0, vec![0.0, 0.0], vec![0.0, TAU], vec![1.0; 4]).is_none());
        assert!(Lobe::new(0.0, vec![0.0, 1.0], vec![0.0, TAU], vec![1.0; 3]).is_none());
    }
}

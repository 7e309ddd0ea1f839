//! One measured lobe: BRDF over scattering angle at one incidence.

use crate::math::table::bracket;
use glam::DVec3;
use std::f64::consts::TAU;

/// BRDF over polar angle (from the normal) and azimuth (from the specular side), bilinear between the entries; the polar
/// angle's first and last rows are held outside them.
#[derive(Clone, Debug)]
pub struct Lobe {
    theta: Vec<f64>,
    phi: Vec<f64>,
    /// \[theta\]\[phi\], 1/sr.
    value: Vec<f64>,
    /// Angle of incidence, rad, and its sine and cosine.
    incidence: f64,
    pub(super) specular: (f64, f64),
}

impl Lobe {
    /// Lobe at `incidence` (rad) over `theta` (rad, strictly rising, 0..pi/2) and `phi` (rad, strictly rising from 0 to 2 pi) with
    /// `value[theta][phi]` (1/sr, finite, >= 0). `None` if the lengths do not fit or the angles do not rise.
    pub fn new(incidence: f64, theta: Vec<f64>, phi: Vec<f64>, value: Vec<f64>) -> Option<Lobe> {
        let rises = |a: &[f64]| a.len() > 1 && a.windows(2).all(|w| w[0] < w[1]);
        if !rises(&theta) || !rises(&phi) || value.len() != theta.len() * phi.len() {
            return None;
        }
        Some(Lobe { theta, phi, value, incidence, specular: incidence.sin_cos() })
    }

    /// BRDF towards `d` (1/sr) in the axes (forward, across, normal); below the horizon the value at the horizon.
    pub fn at(&self, d: DVec3) -> f64 {
        let (i, u) = bracket(&self.theta, d.truncate().length().atan2(d.z.max(0.0)));
        let phi = d.y.atan2(d.x);
        let (j, v) = bracket(&self.phi, if phi < 0.0 { phi + TAU } else { phi });
        let at = i * self.phi.len() + j;
        let row = |at: usize| self.value[at] + v * (self.value[at + 1] - self.value[at]);
        let (low, high) = (row(at), row(at + self.phi.len()));
        low + u * (high - low)
    }

    /// Trapezoidal sum of BRDF cos(theta) sin(theta) d theta d phi over the entries: the TIS the table was written with, 0..1.
    pub fn tis(&self) -> f64 {
        let columns = self.phi.len();
        let ring = |i: usize| -> f64 {
            let row = &self.value[i * columns..(i + 1) * columns];
            let around: f64 = (1..columns).map(|j| 0.5 * (row[j] + row[j - 1]) * (self.phi[j] - self.phi[j - 1])).sum();
            around * self.theta[i].sin() * self.theta[i].cos()
        };
        (1..self.theta.len()).map(|i| 0.5 * (ring(i) + ring(i - 1)) * (self.theta[i] - self.theta[i - 1])).sum()
    }

    /// Smallest step of theta, rad.
    pub(super) fn finest(&self) -> f64 {
        self.theta.windows(2).map(|w| w[1] - w[0]).fold(f64::INFINITY, f64::min)
    }

    /// phi of the entries, rad.
    pub(super) fn azimuths(&self) -> &[f64] {
        &self.phi
    }

    /// Angle of incidence, rad.
    pub fn incidence(&self) -> f64 {
        self.incidence
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::{FRAC_PI_2, PI};

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
    fn a_table_that_does_not_rise_is_none() {
        assert!(Lobe::new(0.0, vec![0.0, 0.0], vec![0.0, TAU], vec![1.0; 4]).is_none());
        assert!(Lobe::new(0.0, vec![0.0, 1.0], vec![0.0, TAU], vec![1.0; 3]).is_none());
    }
}

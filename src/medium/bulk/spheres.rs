//! Spheres far apart: Mie scatter.
//!
//! N_j spheres of diameter D_j per m3 (or, for what lies on a surface, per m2): coefficients sum N C_sca and sum N C_abs, 1/m (or
//! dimensionless), and the mean phase function, worked out at a few wavelengths. Between two of them coefficients are linear, and the
//! phase function is the mean of both, weighted by what each scatters. See [`crate::optics::mie`].

use super::{Bulk, Cosines, Spectrum};
use crate::math::Rng;
use crate::math::table::{bracket, linear};
use crate::medium::Medium;
use crate::optics::mie::Sphere;
use std::f64::consts::PI;

/// Spheres in a host.
#[derive(Debug)]
pub struct Spheres {
    /// Vacuum wavelengths, m, rising.
    wavelengths: Vec<f64>,
    /// At each of them.
    phases: Vec<Cosines>,
    scattering: Spectrum,
    absorption: Spectrum,
}

impl Spheres {
    /// Spheres of `diameter` (m) that fill the share `fraction` of a host, at `wavelengths` (m, rising).
    pub fn filling(
        spheres: &dyn Medium,
        host: &dyn Medium,
        diameter: f64,
        fraction: f64,
        wavelengths: &[f64],
    ) -> Spheres {
        Spheres::new(spheres, host, &[(diameter, 6.0 * fraction / (PI * diameter.powi(3)))], wavelengths)
    }

    /// Spheres of diameters (m) and as many each per m3 or m2, at `wavelengths` (m, rising).
    pub fn new(spheres: &dyn Medium, host: &dyn Medium, sizes: &[(f64, f64)], wavelengths: &[f64]) -> Spheres {
        let (mut phases, mut scattering, mut absorption) = (Vec::new(), Vec::new(), Vec::new());
        for &wavelength in wavelengths {
            let (index, outside) = (spheres.index(wavelength), host.index(wavelength).re);
            // Each with the area that all of its size cover.
            let all: Vec<(f64, Sphere)> = sizes
                .iter()
                .map(|(diameter, number)| {
                    (0.25 * PI * diameter * diameter * number, Sphere::new(*diameter, index, outside, wavelength))
                })
                .collect();
            let sum = |efficiency: fn(&Sphere) -> f64| all.iter().map(|(area, sphere)| area * efficiency(sphere)).sum();
            scattering.push((wavelength, sum(|sphere| sphere.scattering)));
            absorption.push((wavelength, sum(|sphere| (sphere.extinction - sphere.scattering).max(0.0))));
            phases.extend(cosines(&all));
        }
        let spectrum = |rows: &[(f64, f64)]| Spectrum::new(rows).unwrap_or_else(|| Spectrum::constant(0.0));
        Spheres {
            wavelengths: wavelengths.to_vec(),
            phases,
            scattering: spectrum(&scattering),
            absorption: spectrum(&absorption),
        }
    }

    /// Share of the scattered light that goes into the hemisphere about a pole, by the cosine of the angle between pole and the way
    /// straight on; one list for every wavelength of [`Spheres::new`].
    pub fn ahead(&self, cosines: &[f64]) -> Vec<Vec<f64>> {
        self.phases.iter().map(|phase| cosines.iter().map(|cosine| phase.ahead(*cosine)).collect()).collect()
    }

    /// Index of the first of the two tables around a wavelength, and the share of the second in what is scattered.
    pub fn place(&self, wavelength: f64) -> (usize, f64) {
        let (k, w) = bracket(&self.wavelengths, wavelength);
        let next = (k + 1).min(self.phases.len() - 1);
        let [near, far] = [k, next].map(|at| self.scattering.at(self.wavelengths[at]));
        let share = w * far / ((1.0 - w) * near + w * far);
        (k, if share.is_finite() { share } else { 0.0 })
    }

    fn tables(&self, wavelength: f64) -> ([&Cosines; 2], f64) {
        let (k, share) = self.place(wavelength);
        ([&self.phases[k], &self.phases[(k + 1).min(self.phases.len() - 1)]], share)
    }
}

/// The mean phase function of spheres at angles that resolve the forward lobe and the rings of the largest, some lambda / (pi D) wide.
/// Every sphere is worked out at angles that resolve its own.
fn cosines(all: &[(f64, Sphere)]) -> Option<Cosines> {
    let steps = |sphere: &Sphere| (24.0 * (sphere.x + 8.0)).ceil() as usize;
    let count = all.iter().map(|(_, sphere)| steps(sphere)).max()?;
    let angle = |i: usize, of: usize| PI * (1.0 - i as f64 / of as f64);
    let mut sum = vec![0.0; count + 1];
    for (area, sphere) in all {
        let own = steps(sphere);
        let grid: Vec<f64> = (0..=own).map(|i| i as f64 / own as f64).collect();
        let values: Vec<f64> = (0..=own).map(|i| area * sphere.differential(angle(i, own).cos())).collect();
        sum.iter_mut().enumerate().for_each(|(i, value)| *value += linear(&grid, &values, i as f64 / count as f64));
    }
    let rows: Vec<(f64, f64)> = sum.into_iter().enumerate().map(|(i, value)| (angle(i, count).cos(), value)).collect();
    Cosines::new(&rows)
}

impl Bulk for Spheres {
    fn coefficient(&self, wavelength: f64) -> f64 {
        self.scattering.at(wavelength)
    }

    fn absorption(&self, wavelength: f64) -> f64 {
        self.absorption.at(wavelength)
    }

    fn phase(&self, cosine: f64, wavelength: f64) -> f64 {
        let ([near, far], share) = self.tables(wavelength);
        (1.0 - share) * near.phase(cosine) + share * far.phase(cosine)
    }

    fn draw(&self, wavelength: f64, rng: &mut Rng) -> f64 {
        let ([near, far], share) = self.tables(wavelength);
        let table = if share > 0.0 && rng.uniform() < share { far } else { near };
        table.quantile(rng.uniform())
    }

    fn range(&self) -> Option<[f64; 2]> {
        self.scattering.range()
    }
}

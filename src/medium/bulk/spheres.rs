//! A dilute suspension of equal spheres: Mie scatter.
//!
//! N = 6 f / (pi D^3) spheres per m3, f their share of the volume; coefficients N C_sca and N C_abs (1/m) and the phase function are
//! worked out at a few wavelengths. Between two of them coefficients are linear, and the phase function is the mean of both,
//! weighted by what each scatters. See [`crate::optics::mie`].

use super::{Bulk, Cosines, Spectrum};
use crate::math::Rng;
use crate::math::table::bracket;
use crate::medium::Medium;
use crate::optics::mie::Sphere;
use std::f64::consts::PI;

/// Spheres of one size in a host.
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
    pub fn new(spheres: &dyn Medium, host: &dyn Medium, diameter: f64, fraction: f64, wavelengths: &[f64]) -> Spheres {
        let per_length = 1.5 * fraction / diameter;
        let (mut phases, mut scattering, mut absorption) = (Vec::new(), Vec::new(), Vec::new());
        for &wavelength in wavelengths {
            let sphere = Sphere::new(diameter, spheres.index(wavelength), host.index(wavelength).re, wavelength);
            scattering.push((wavelength, per_length * sphere.scattering));
            absorption.push((wavelength, per_length * (sphere.extinction - sphere.scattering).max(0.0)));
            phases.extend(cosines(&sphere));
        }
        let spectrum = |rows: &[(f64, f64)]| Spectrum::new(rows).unwrap_or_else(|| Spectrum::constant(0.0));
        Spheres {
            wavelengths: wavelengths.to_vec(),
            phases,
            scattering: spectrum(&scattering),
            absorption: spectrum(&absorption),
        }
    }

    /// The two tables around a wavelength and the share of the second in what is scattered.
    fn tables(&self, wavelength: f64) -> ([&Cosines; 2], f64) {
        let (k, w) = bracket(&self.wavelengths, wavelength);
        let next = (k + 1).min(self.phases.len() - 1);
        let [near, far] = [k, next].map(|at| self.scattering.at(self.wavelengths[at]));
        let share = w * far / ((1.0 - w) * near + w * far);
        ([&self.phases[k], &self.phases[next]], if share.is_finite() { share } else { 0.0 })
    }
}

/// The phase function of a sphere at angles that resolve its forward lobe and its rings, some lambda / (pi D) wide.
fn cosines(sphere: &Sphere) -> Option<Cosines> {
    let count = (24.0 * (sphere.x + 8.0)).ceil() as usize;
    let row = |i: usize| {
        let cosine = -(PI * i as f64 / count as f64).cos();
        (cosine, sphere.differential(cosine))
    };
    Cosines::new(&(0..=count).map(row).collect::<Vec<_>>())
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

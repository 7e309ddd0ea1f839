//! Particles on a surface: a dilute layer of spheres (Mie).
//!
//! Cumulated numbers of particles per 0.1 m2 by IEST-STD-CC1246, diameter d in um, level L, slope c (0.926 by the standard):
//!
//!     log10 N(>= d) = c (log10^2 L - log10^2 d)
//!
//! in 24 bins, each of the number N(>= d1) - N(>= d2) with its geometric mean diameter. With E and S the sums of N C_ext and N C_sca per
//! area, light that crosses the layer at cos = m keeps t = exp(-E / m) of itself, and s = (1 - t) S / E of it is scattered, with the mean
//! phase function p of the particles. What it does to light on a surface: [`crate::surface::dust`].
//!
//! Source: E. N. Borson in Semiconductor Digest (2005) on revision D of the standard (0.1 m2). Left out: light that meets two
//! particles, particles that shade each other.

use crate::math::Rng;
use crate::math::table::bracket;
use crate::medium::Medium;
use crate::medium::bulk::{Bulk, Spheres};
use glam::{DVec2, DVec3};
use std::f64::consts::{PI, TAU};

/// Bins of the distribution.
const BINS: i32 = 24;

/// Nodes of the cosine at which the share of light that goes on is worked out; closer together at grazing incidence.
const NODES: usize = 257;

/// Particles per area.
#[derive(Debug)]
pub struct Deposit {
    spheres: Spheres,
    /// Share of the area that they cover.
    pub coverage: f64,
    cosines: Vec<f64>,
    /// By wavelength: share of the scattered light that does not turn back, at `cosines` of incidence.
    ahead: Vec<Vec<f64>>,
}

/// Particles of a diameter (m) or larger per m2, by level and slope.
pub fn cumulated(level: f64, slope: f64, diameter: f64) -> f64 {
    let micrometres = 1e6 * diameter;
    10.0 * 10f64.powf(slope * (level.log10().powi(2) - micrometres.log10().powi(2)))
}

/// Diameters (m) and numbers per m2 of the bins between two diameters (m).
pub fn distribution(level: f64, slope: f64, [least, greatest]: [f64; 2]) -> Vec<(f64, f64)> {
    let edge = |bin: i32| least * (greatest / least).powf(f64::from(bin) / f64::from(BINS));
    let number = |bin: i32| cumulated(level, slope, edge(bin)) - cumulated(level, slope, edge(bin + 1));
    (0..BINS).map(|bin| ((edge(bin) * edge(bin + 1)).sqrt(), number(bin))).collect()
}

impl Deposit {
    /// Particles of these diameters (m) and numbers per m2, in vacuum, at `wavelengths` (m, rising).
    pub fn new(particles: &dyn Medium, sizes: &[(f64, f64)], wavelengths: &[f64]) -> Deposit {
        let vacuum = crate::medium::Constant::transparent(1.0);
        let spheres = Spheres::new(particles, &vacuum, sizes, wavelengths);
        let cosines: Vec<f64> = (0..NODES).map(|i| (i as f64 / (NODES - 1) as f64).powi(3)).collect();
        let ahead = spheres.ahead(&cosines);
        let coverage = sizes.iter().map(|(diameter, number)| 0.25 * PI * diameter * diameter * number).sum();
        Deposit { spheres, coverage, cosines, ahead }
    }

    /// Extinction at normal incidence, dimensionless.
    pub fn extinction(&self, wavelength: f64) -> f64 {
        self.spheres.coefficient(wavelength) + self.spheres.absorption(wavelength)
    }

    /// Share of the light that crosses the layer at cos = `cosine` untouched.
    pub fn passes(&self, cosine: f64, wavelength: f64) -> f64 {
        (-self.extinction(wavelength) / cosine).exp()
    }

    /// Share of the light that is scattered on crossing at cos = `cosine`.
    pub fn scatters(&self, cosine: f64, wavelength: f64) -> f64 {
        let extinction = self.extinction(wavelength);
        if extinction <= 0.0 {
            return 0.0;
        }
        -(-extinction / cosine).exp_m1() * self.spheres.coefficient(wavelength) / extinction
    }

    /// Share of the scattered light that does not turn back.
    pub fn ahead(&self, cosine: f64, wavelength: f64) -> f64 {
        let (k, share) = self.spheres.place(wavelength);
        let (at, w) = bracket(&self.cosines, cosine);
        let of = |table: &[f64]| table[at] + w * (table[at + 1] - table[at]);
        let next = (k + 1).min(self.ahead.len() - 1);
        (1.0 - share) * of(&self.ahead[k]) + share * of(&self.ahead[next])
    }

    /// Phase function, 1/sr.
    pub fn phase(&self, cosine: f64, wavelength: f64) -> f64 {
        self.spheres.phase(cosine, wavelength)
    }

    /// A direction scattered out of the unit direction `axis`.
    pub fn draw(&self, axis: DVec3, wavelength: f64, rng: &mut Rng) -> DVec3 {
        let cosine = self.spheres.draw(wavelength, rng);
        let sine = ((1.0 - cosine) * (1.0 + cosine)).max(0.0).sqrt();
        let across: DVec2 = sine * DVec2::from_angle(TAU * rng.uniform());
        crate::geometry::Frame::from_z(axis).to_world(across.extend(cosine)).normalize()
    }
}

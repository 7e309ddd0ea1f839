//! What light that meets several facets of a rough mirror adds: energy that single scattering loses.
//!
//!     f = F_ms (1 - E(wi)) (1 - E(wo)) / (pi (1 - E_avg))   [1/sr],    E_avg = 2 integral_0^1 E cos dcos
//!     F_ms = F_avg^2 E_avg / (1 - F_avg (1 - E_avg)),                  F_avg = 2 integral_0^1 F cos dcos
//!
//! E(theta) albedo of the reflected lobe with facets that reflect everything ([`super::Facets::Perfect`]), F of the facets. Reciprocal; with F = 1
//! lobe and compensation together reflect everything at every angle (the white furnace). An estimate of where, and by F of how much:
//! each bounce loses 1 - F_avg. For opaque surfaces: what passes several facets of glass is left out.
//!
//! Source: Kulla & Conty, "Revisiting physically based shading at Imageworks", SIGGRAPH 2017 course, with the F_ms of Fdez-Aguera, JCGT 8(1),
//! 45 (2019).

use super::distribution::Rules;
use super::{Distribution, Facets, Shape, Side};
use crate::bsdf::Bsdf;
use crate::math::Rng;
use crate::math::quadrature::GaussLegendre;
use crate::math::table::{Discrete, Even};
use crate::optics::Incidence;
use glam::DVec3;
use std::f64::consts::{FRAC_1_PI, FRAC_PI_2, TAU};

/// Cells of cos^2 in which directions are drawn.
const CELLS: usize = 256;

/// The lobe that a rough mirror lacks.
#[derive(Clone, Debug)]
pub struct Compensation {
    shape: Shape,
    /// 1 - E over theta.
    loss: Even,
    /// 1 - E_avg.
    mean: f64,
    cells: Discrete,
    rule: GaussLegendre,
}

impl Compensation {
    /// For the reflected lobe of roughness `alpha` (0.001..1). Cost: 10 to 100 ms.
    pub fn new(distribution: Distribution, alpha: f64, facets: Facets) -> Compensation {
        let shape = Shape { distribution, alpha, facets, side: Side::Reflect };
        let mirror = Shape { facets: Facets::Perfect, ..shape };
        let (rules, rule) = (Rules::new(24), GaussLegendre::new(24));
        let index = Incidence::in_air(0.0, 550e-9).index;
        let loss = Even::new(0.0, FRAC_PI_2, 256, |theta| (1.0 - mirror.albedo(&rules, index, theta)).max(1e-12));
        let mean = GaussLegendre::new(200).integrate(0.0, FRAC_PI_2, |t| (2.0 * t).sin() * loss.at(t));
        let middle = |k: usize| ((k as f64 + 0.5) / CELLS as f64).sqrt().acos();
        let mass: Vec<f64> = (0..CELLS).map(|k| loss.at(middle(k)).max(1e-12)).collect();
        // Positive everywhere, so there is a distribution.
        let cells = Discrete::new(&mass).unwrap_or_else(|| unreachable!("masses of at least 1e-12"));
        Compensation { shape, loss, mean, cells, rule }
    }

    /// 1 - E of a direction.
    fn loss(&self, w: DVec3) -> f64 {
        self.loss.at(w.truncate().length().atan2(w.z.abs()))
    }

    /// F_ms.
    fn tint(&self, at: &Incidence) -> f64 {
        if self.shape.facets == Facets::Perfect {
            return 1.0;
        }
        let facet = self.rule.integrate(0.0, 1.0, |cos| 2.0 * cos * self.shape.fraction(at.index, cos));
        facet * facet * (1.0 - self.mean) / (1.0 - facet * self.mean)
    }
}

impl Bsdf for Compensation {
    fn eval(&self, at: &Incidence, wo: DVec3) -> f64 {
        if wo.z <= 0.0 {
            return 0.0;
        }
        FRAC_1_PI * self.tint(at) * self.loss(at.wi) * self.loss(wo) / self.mean
    }

    /// Even in cos^2 within each cell, cells in proportion to 1 - E(wo).
    fn pdf(&self, _: &Incidence, wo: DVec3) -> f64 {
        if wo.z <= 0.0 {
            return 0.0;
        }
        let cell = ((wo.z * wo.z * CELLS as f64) as usize).min(CELLS - 1);
        FRAC_1_PI * wo.z * self.cells.probability(cell) * CELLS as f64
    }

    fn sample(&self, _: &Incidence, rng: &mut Rng) -> Option<DVec3> {
        let (cell, rest) = self.cells.draw(rng.uniform());
        let square = (cell as f64 + rest) / CELLS as f64;
        let (sin, cos) = (TAU * rng.uniform()).sin_cos();
        let radius = (1.0 - square).max(0.0).sqrt();
        (square > 0.0).then(|| DVec3::new(radius * cos, radius * sin, square.sqrt()))
    }

    fn albedo(&self, at: &Incidence) -> f64 {
        self.tint(at) * self.loss(at.wi)
    }
}

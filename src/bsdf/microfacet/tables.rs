//! Albedo of a rough surface over incidence, by the index beyond relative to that here.
//!
//! Tables (cubic between) over
//!
//!     x = k theta + ln(1 + alpha tan(theta))
//!
//! which is even in theta, k steps to the width alpha of a critical angle, and goes with Lambda where the surface shadows itself: what is
//! transmitted at grazing incidence falls as a power of it. They are kept at relative indices on a grid: ln|n| in steps of 0.001 for dielectrics, real and imaginary part in
//! steps of 0.01 for metals, each worked out where it is first needed, linear between. A table depends on its place alone, so results do
//! not depend on who needed it first. Absolute error below 4e-4 (measured beside this code); the facets' total reflection, whose root
//! the quadrature meets, is the worst of it.

use super::distribution::Rules;
use super::{Facets, Shape};
use crate::math::table::Even;
use crate::optics::Incidence;
use num_complex::Complex64;
use std::collections::HashMap;
use std::f64::consts::FRAC_PI_2;
use std::sync::{Arc, PoisonError, RwLock};

/// Steps of the grid of indices.
const DIELECTRIC: f64 = 1e-3;
const METAL: f64 = 1e-2;
/// Step of x.
const STEP: f64 = 0.05;

/// A place on the grid of indices: dielectric or not, and its coordinates.
type Place = (bool, i32, i32);

/// Tables that were needed so far.
#[derive(Debug)]
pub struct Tables {
    alpha: f64,
    k: f64,
    rules: Rules,
    known: RwLock<HashMap<Place, Arc<Even>>>,
}

impl Tables {
    pub fn new(alpha: f64) -> Tables {
        // The narrowest feature, a critical angle, is alpha wide; no finer than 1.5 mrad.
        let k = STEP / (0.25 * alpha).clamp(1.5e-3, 0.02);
        Tables { alpha, k, rules: Rules::new(24), known: RwLock::default() }
    }

    /// x of a direction with this sine and cosine; within a microradian of the horizon it is held.
    fn place(&self, sin: f64, cos: f64) -> f64 {
        let cos = cos.max(1e-6);
        self.k * sin.atan2(cos) + (self.alpha * sin / cos).ln_1p()
    }

    /// The angle (rad) at `x`, by bisection.
    fn angle(&self, x: f64) -> f64 {
        let (mut low, mut high) = (0.0, FRAC_PI_2);
        for _ in 0..60 {
            let middle: f64 = 0.5 * (low + high);
            if self.place(middle.sin(), middle.cos()) < x { low = middle } else { high = middle }
        }
        0.5 * (low + high)
    }

    pub fn at(&self, shape: &Shape, at: &Incidence) -> f64 {
        let x = self.place(at.wi.truncate().length(), at.cos());
        let [here, beyond] = at.index;
        if shape.facets == Facets::Perfect && !self.bends(shape, at) {
            return self.table(shape, (true, 0, 0)).at(x);
        }
        if here.re == beyond.re && beyond.im == 0.0 {
            return 0.0;
        }
        let relative = beyond / here.re;
        let (dielectric, u, v) = match relative.im == 0.0 {
            true => (true, relative.re.ln() / DIELECTRIC, 0.0),
            false => (false, relative.re / METAL, relative.im / METAL),
        };
        let (i, j) = (u.floor(), v.floor());
        let mut sum = 0.0;
        for (di, wu) in [(0.0, 1.0 - (u - i)), (1.0, u - i)] {
            for (dj, wv) in [(0.0, 1.0 - (v - j)), (1.0, v - j)] {
                if wu * wv > 0.0 {
                    sum += wu * wv * self.table(shape, (dielectric, (i + di) as i32, (j + dj) as i32)).at(x);
                }
            }
        }
        sum
    }

    /// True if directions depend on the indices.
    fn bends(&self, shape: &Shape, at: &Incidence) -> bool {
        shape.side == super::Side::Transmit && at.index[0].re != at.index[1].re
    }

    fn table(&self, shape: &Shape, place: Place) -> Arc<Even> {
        // A table is whole or not there: a lock that somebody left in a panic holds no half of one.
        if let Some(known) = self.known.read().unwrap_or_else(PoisonError::into_inner).get(&place) {
            return known.clone();
        }
        let beyond = match place {
            (true, u, _) => Complex64::new((DIELECTRIC * f64::from(u)).exp(), 0.0),
            (false, u, v) => Complex64::new(METAL * f64::from(u), METAL * f64::from(v)),
        };
        let albedo = |x: f64| shape.albedo(&self.rules, [Complex64::ONE, beyond], self.angle(x));
        let end = self.place(1.0, 0.0);
        let table = Arc::new(Even::new(0.0, end, (end / STEP) as usize + 4, albedo));
        self.known.write().unwrap_or_else(PoisonError::into_inner).entry(place).or_insert(table).clone()
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Distribution, Side};
    use super::*;

    #[test]
    fn the_tables_are_the_integral() {
        let rules = Rules::new(48);
        for distribution in [Distribution::Ggx, Distribution::Beckmann] {
            for (alpha, index) in [(0.05, [1.0, 1.52]), (0.05, [1.52, 1.0]), (0.5, [1.0, 1.52]), (0.5, [1.52, 1.0])] {
                for side in [Side::Reflect, Side::Transmit] {
                    let shape = Shape { distribution, alpha, facets: Facets::Interface, side };
                    let tables = Tables::new(alpha);
                    for theta in [0.0, 0.31, 0.7, 0.75, 1.1, 1.4, 1.54, 1.57] {
                        let index = index.map(|n| Complex64::new(n, 0.0));
                        let got = tables.at(&shape, &Incidence { index, ..Incidence::in_air(theta, 550e-9) });
                        let wanted = shape.albedo(&rules, index, theta);
                        assert!((got - wanted).abs() < 4e-4, "{shape:?} {index:?} {theta}: {got} {wanted}");
                    }
                }
            }
        }
    }
}

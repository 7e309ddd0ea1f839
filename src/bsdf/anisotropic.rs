//! Measured scatter that depends on the azimuth of the sample: a table for each of several azimuths.
//!
//! The azimuth phi is that of the light's travel along the surface, counter-clockwise from the lay as seen from where the light comes from.
//! Between two azimuths of the tables, over the period P,
//!
//!     f = (1 - w) f_k + w f_(k+1)    [1/sr]      w = (phi - phi_k) / (phi_(k+1) - phi_k)      phi_(n) = phi_0 + P
//!
//! with every f_k an isotropic table of its own ([`super::tabulated`]), turned with the plane of incidence. P = 2 pi if an azimuth lies
//! beyond pi, else pi: grooves have no sense. Albedo, density and draws are those of the mixture, exactly.
//!
//! What many azimuths cost: the tables share the memory of one, each on a coarser grid if it must.
//!
//! Left out: polarisation; lobes that move between azimuths fade out at one and in at the next.

use super::Bsdf;
use super::tabulated::{Table, Tabulated, TooBright};
use crate::math::Rng;
use crate::optics::Incidence;
use glam::DVec3;
use std::f64::consts::{PI, TAU};

/// Tables at several azimuths.
#[derive(Clone, Debug)]
pub struct Anisotropic {
    /// rad, strictly rising from 0 to below the period.
    azimuth: Vec<f64>,
    /// rad
    period: f64,
    tables: Vec<Tabulated>,
}

impl Anisotropic {
    /// Tables (at least one) for light that goes one way, each at its azimuth, with every value multiplied by `scale` (>= 0). Of tables at
    /// one azimuth, as 0 and 2 pi, the first counts. Fails if one scatters more light than arrives.
    pub fn new(tables: Vec<Table>, scale: f64) -> Result<Anisotropic, TooBright> {
        // Degrees that were written as decimals.
        const SAME: f64 = 1e-9;
        let period = if tables.iter().any(|table| table.azimuth() > PI + SAME) { TAU } else { PI };
        let turn = |table: &Table| (table.azimuth() + SAME).rem_euclid(period) - SAME;
        let mut turned: Vec<(f64, Table)> = tables.into_iter().map(|table| (turn(&table).max(0.0), table)).collect();
        turned.sort_by(|a, b| a.0.total_cmp(&b.0));
        turned.dedup_by(|later, first| later.0 - first.0 < SAME);
        let count = turned.len();
        let (azimuth, tables): (Vec<f64>, Vec<Table>) = turned.into_iter().unzip();
        let tables = tables.into_iter().map(|table| Tabulated::among(count, table, scale)).collect::<Result<_, _>>()?;
        Ok(Anisotropic { azimuth, period, tables })
    }

    /// The tables on either side of the light's azimuth with their weights.
    fn around(&self, at: &Incidence) -> [(&Tabulated, f64); 2] {
        let travel = at.along_lay(-at.wi.truncate());
        let azimuth = travel.y.atan2(travel.x).rem_euclid(self.period);
        let count = self.azimuth.len();
        let after = self.azimuth.partition_point(|known| *known <= azimuth);
        let (from, to) = ((after + count - 1) % count, after % count);
        let way = |a: f64, b: f64| (b - a).rem_euclid(self.period);
        let step = way(self.azimuth[from], self.azimuth[to]);
        let w = if step > 0.0 { way(self.azimuth[from], azimuth) / step } else { 0.0 };
        [(&self.tables[from], 1.0 - w), (&self.tables[to], w)]
    }
}

impl Bsdf for Anisotropic {
    fn eval(&self, at: &Incidence, wo: DVec3) -> f64 {
        self.around(at).iter().map(|(table, weight)| weight * table.eval(at, wo)).sum()
    }

    fn pdf(&self, at: &Incidence, wo: DVec3) -> f64 {
        let total = self.albedo(at);
        let part = |(table, weight): &(&Tabulated, f64)| weight * table.albedo(at) * table.pdf(at, wo);
        if total > 0.0 { self.around(at).iter().map(part).sum::<f64>() / total } else { 0.0 }
    }

    fn sample(&self, at: &Incidence, rng: &mut Rng) -> Option<DVec3> {
        let [(a, s), (b, w)] = self.around(at);
        let (one, other) = (s * a.albedo(at), w * b.albedo(at));
        let first = rng.uniform() * (one + other) < one;
        if first { a.sample(at, rng) } else { b.sample(at, rng) }
    }

    fn albedo(&self, at: &Incidence) -> f64 {
        self.around(at).iter().map(|(table, weight)| weight * table.albedo(at)).sum()
    }

    fn anisotropic(&self) -> bool {
        true
    }

    fn transmits(&self) -> bool {
        self.tables[0].transmits()
    }
}

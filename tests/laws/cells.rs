//! Chi-squared over cells of equal probability.
//!
//! Each side that light takes is cut into rings about the lobe's pole that hold the same probability, and each ring into sectors that do,
//! both found in the cumulated density along many azimuths.

use crate::polar::{Polar, Pole, Ray};
use glam::DVec3;
use statrs::distribution::{ChiSquared, ContinuousCDF};
use std::f64::consts::TAU;
use straylight::optics::Incidence;

/// Rings of a side and sectors of a ring: as many as leave every cell the draws that it must expect.
const PARTS: [usize; 4] = [16, 8, 4, 2];

/// Least number of draws that a cell expects; those of fewer are pooled.
const LEAST: f64 = 5.0;

/// The density along one azimuth: in every panel of u a straight line through its values at the two points of Gauss.
struct Profile<'a> {
    ray: Ray<'a>,
    /// Mean of the panel and rise over half of it.
    panels: Vec<[f64; 2]>,
    /// Integral up to the start of each panel, and the whole.
    cumulated: Vec<f64>,
}

impl Profile<'_> {
    fn new<'a>(ray: Ray<'a>, panels: usize, density: &dyn Fn(DVec3) -> f64) -> Profile<'a> {
        let (width, third) = (2.0 / panels as f64, 1.0 / 3f64.sqrt());
        let panel = |k: usize| {
            let [a, b] = [-third, third].map(|t| ray.flux(width * (k as f64 + 0.5 + 0.5 * t), density));
            [0.5 * (a + b), 0.5 * (b - a) / third]
        };
        let panels: Vec<[f64; 2]> = (0..panels).map(panel).collect();
        let mut cumulated = vec![0.0];
        panels.iter().for_each(|[mean, _]| cumulated.push(cumulated[cumulated.len() - 1] + width * mean));
        Profile { ray, panels, cumulated }
    }

    /// Probability up to distance `x`, per rad.
    fn up_to(&self, x: f64) -> f64 {
        let (width, at) = (2.0 / self.panels.len() as f64, self.ray.coordinate(x) / 2.0 * self.panels.len() as f64);
        let k = (at as usize).min(self.panels.len() - 1);
        let (t, [mean, rise]) = (2.0 * (at - k as f64) - 1.0, self.panels[k]);
        self.cumulated[k] + 0.5 * width * (mean * (t + 1.0) + 0.5 * rise * (t * t - 1.0))
    }
}

/// Rings and sectors of equal probability on one side, as many of either.
struct Mosaic {
    polar: Polar,
    /// Probability of the whole side.
    probability: f64,
    parts: usize,
    /// Inner edges of the rings in x, and of every ring's sectors in turns.
    rings: Vec<f64>,
    sectors: Vec<Vec<f64>>,
}

impl Mosaic {
    fn new(polar: Polar, [draws, panels]: [usize; 2], density: &dyn Fn(DVec3) -> f64) -> Mosaic {
        let profiles: Vec<Profile> = polar.rays().map(|ray| Profile::new(ray, panels, density)).collect();
        let part = TAU / profiles.len() as f64;
        let within = |x: f64| profiles.iter().map(|p| p.up_to(x)).sum::<f64>() * part;
        let probability = within(f64::INFINITY);
        let enough = |parts: &usize| probability * draws as f64 >= LEAST * (parts * parts) as f64;
        let parts = PARTS.into_iter().find(enough).unwrap_or(1);
        let rings: Vec<f64> = (1..parts).map(|k| root(&within, probability * k as f64 / parts as f64)).collect();
        let edges: Vec<f64> = [0.0].into_iter().chain(rings.iter().copied()).chain([f64::INFINITY]).collect();
        let sectors = edges.windows(2).map(|e| {
            let masses: Vec<f64> = profiles.iter().map(|p| p.up_to(e[1]) - p.up_to(e[0])).collect();
            quantiles(&masses, parts)
        });
        Mosaic { probability, parts, sectors: sectors.collect(), rings, polar }
    }

    fn cells(&self) -> usize {
        self.parts * self.parts
    }

    fn cell(&self, wo: DVec3) -> usize {
        let [x, turn] = self.polar.place(wo);
        let ring = self.rings.partition_point(|edge| *edge <= x);
        ring * self.parts + self.sectors[ring].partition_point(|edge| *edge <= turn)
    }
}

/// Where the rising function `f` of a distance takes a value, by bisection of the logarithm.
fn root(f: &dyn Fn(f64) -> f64, value: f64) -> f64 {
    let (mut low, mut high) = (1e-13f64, 20.0f64);
    while high / low > 1.0 + 1e-7 {
        let middle = (low * high).sqrt();
        if f(middle) < value { low = middle } else { high = middle }
    }
    high
}

/// Inner edges (turns) of so many sectors of equal mass, by the `masses` of equal parts of the turn, each of a density that rises as its
/// neighbours say.
fn quantiles(masses: &[f64], sectors: usize) -> Vec<f64> {
    let count = masses.len();
    let rise = |k: usize| {
        let (before, after) = (masses[k] - masses[(k + count - 1) % count], masses[(k + 1) % count] - masses[k]);
        // A step between two parts says nothing about either.
        if before * after <= 0.0 { 0.0 } else { 0.5 * before.signum() * before.abs().min(after.abs()) }
    };
    let total: f64 = masses.iter().sum();
    let (mut edges, mut below, mut k) = (Vec::new(), 0.0, 0);
    for sector in 1..sectors {
        let wanted = total * sector as f64 / sectors as f64;
        while k + 1 < count && below + masses[k] < wanted {
            below += masses[k];
            k += 1;
        }
        let way = ((wanted - below) / masses[k].max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
        // m (t + 1) + r (t^2 - 1) / 2 = 2 m way over -1 < t < 1.
        let slope = rise(k) / masses[k].max(f64::MIN_POSITIVE);
        let start = 0.5 * (1.0 - slope);
        let t = way / (start + (start * start + way * slope).max(0.0).sqrt()).max(f64::MIN_POSITIVE);
        edges.push((k as f64 + t.min(1.0)) / count as f64);
    }
    edges
}

/// Cells for so many draws of a density, on both sides of a surface.
pub struct Cells {
    draws: usize,
    mosaics: Vec<Mosaic>,
}

impl Cells {
    /// Cells of equal probability of the `density` (1/sr) for `draws`; `panels` of it along each azimuth, a multiple of 36 so that rings of tables are edges of panels.
    pub fn new(at: &Incidence, pole: Pole, [draws, panels]: [usize; 2], density: &dyn Fn(DVec3) -> f64) -> Cells {
        let sides = Polar::sides(at, pole).into_iter().map(|polar| Mosaic::new(polar, [draws, panels], density));
        Cells { draws, mosaics: sides.filter(|mosaic| mosaic.probability > 0.0).collect() }
    }

    /// Probability of a direction at all.
    pub fn probability(&self) -> f64 {
        self.mosaics.iter().map(|mosaic| mosaic.probability).sum()
    }

    /// Probability of every cell.
    fn probabilities(&self) -> Vec<f64> {
        let side = |mosaic: &Mosaic| vec![mosaic.probability / mosaic.cells() as f64; mosaic.cells()];
        self.mosaics.iter().flat_map(side).collect()
    }

    /// `None` on a side where nothing should go.
    fn cell(&self, wo: DVec3) -> Option<usize> {
        let side = self.mosaics.iter().position(|mosaic| mosaic.polar.side * wo.z > 0.0)?;
        let before: usize = self.mosaics[..side].iter().map(Mosaic::cells).sum();
        Some(before + self.mosaics[side].cell(wo))
    }

    /// p-value of the draws.
    pub fn p_value(&self, mut draw: impl FnMut() -> Option<DVec3>) -> f64 {
        let probabilities = self.probabilities();
        let mut count = vec![0u32; probabilities.len()];
        let mut none = 0u32;
        for _ in 0..self.draws {
            match draw() {
                Some(wo) => match self.cell(wo) {
                    Some(cell) => count[cell] += 1,
                    None => return 0.0,
                },
                None => none += 1,
            }
        }
        let cells = probabilities.into_iter().zip(count).chain([(1.0 - self.probability(), none)]);
        chi_squared(cells.map(|(p, count)| (p * self.draws as f64, f64::from(count))))
    }
}

/// p-value of cells by their expected and found counts. Those that expect too few are pooled; if they still do, with the last of the others.
fn chi_squared(cells: impl Iterator<Item = (f64, f64)>) -> f64 {
    let (many, few): (Vec<_>, Vec<_>) = cells.partition(|(expected, _)| *expected >= LEAST);
    let pool = few.iter().fold((0.0, 0.0), |pool, cell| (pool.0 + cell.0, pool.1 + cell.1));
    let mut kept = many;
    match kept.last_mut() {
        Some(last) if pool.0 < LEAST => *last = (last.0 + pool.0, last.1 + pool.1),
        _ => kept.push(pool),
    }
    let chi: f64 = kept.iter().map(|(expected, found)| (found - expected).powi(2) / expected).sum();
    if kept.len() < 2 {
        return 1.0;
    }
    ChiSquared::new(kept.len() as f64 - 1.0).expect("several cells").sf(chi)
}

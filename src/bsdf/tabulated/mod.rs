//! Measured scatter: a table of BRDF over incidence and scattering angle, isotropic about the normal.
//!
//! What lies between the table's entries is said in `shape`: lobes are turned so that their peaks move with the ray, and blended. That
//! function is computed once, at nodes of incidence theta_j about every degree, on a grid of (q = sin^2 theta_s, phi), and scaled there to
//!
//!     integral of f_j cos(theta_s) dw_s = TIS(theta_j)
//!
//! where TIS is linear between the trapezoidal sums over the table's lobes and goes on rising as it rose beyond the last (see `shape`). Light sees, in its plane of incidence,
//!
//!     f = (1 - w) f_j + w f_(j+1),     w = (theta - theta_j) / (theta_(j+1) - theta_j)    (see `nodes`)
//!
//! with every f_j bilinear in (q, phi). Such a function has its integral and its cumulated flux in closed form: the albedo is the
//! integral to rounding at every incidence, and draws follow f cos(theta_s) itself, so that every draw carries the same weight.
//!
//! What the grid costs: against the function it samples, the black-anodize table (1 deg by 10 deg at 15 deg steps of incidence) is
//! misplaced by at most 0.5 % of its flux (half a part in a thousand at the table's incidences), rms 1.2 % over the disc, and up to 36 %
//! in single directions where the table falls by half from one azimuth to the next. The table itself is known to 6 % between its
//! incidences.
//!
//! What an event costs is the memory that it waits for, so a table is kept small: values of two bytes, and one side of the plane of
//! incidence if the table's sides are alike to a part in 10^9. What is rounded is the function, by less than 0.05 % of each value; albedo,
//! density and draws are those of the rounded function.
//!
//! Transmitted lobes are the same, mirrored in the surface: about the ray that goes straight on, with angles in the medium beyond.
//!
//! Left out: dependence on the azimuth of the sample ([`super::anisotropic`]), polarisation; reciprocity is as good as the table.

mod grid;
mod half;
mod lobe;
mod nodes;
mod shape;
mod sheet;

use super::{Bsdf, Weighed};
use crate::math::Rng;
use crate::math::table::linear;
use crate::optics::Incidence;
use glam::DVec3;
use grid::{Grid, WIDEST};
use nodes::Nodes;
use shape::{Plane, Shape};
use sheet::Sheet;
use std::f64::consts::{FRAC_PI_2, FRAC_PI_3, PI, TAU};

pub use lobe::{Beyond, Lobe, Pole};

/// A measured table as a file gives it.
#[derive(Clone, Debug)]
pub struct Table {
    /// Angles of incidence, rad.
    incidence: Vec<f64>,
    /// One lobe per incidence.
    lobes: Vec<Lobe>,
    /// Vacuum wavelengths, m.
    wavelength: Vec<f64>,
    /// Factor on the whole table at each wavelength, dimensionless; linear between, held outside.
    factor: Vec<f64>,
    /// Scattered / incident flux at each incidence at factor 1.
    tis: Vec<f64>,
    /// True if the lobes are those of transmitted light, about the ray that goes straight on.
    transmitted: bool,
    /// Azimuth of the light's travel from the lay, rad; for tables at several.
    azimuth: f64,
}

impl Table {
    /// `lobes` by rising incidence in [0, pi/2) and `spectrum` of (vacuum wavelength m, factor >= 0) by rising wavelength.
    /// `None` if either is empty or does not rise.
    pub fn new(lobes: Vec<Lobe>, spectrum: Vec<(f64, f64)>) -> Option<Table> {
        let incidence: Vec<f64> = lobes.iter().map(Lobe::incidence).collect();
        let (wavelength, factor): (Vec<f64>, Vec<f64>) = spectrum.into_iter().unzip();
        let rises = |a: &[f64]| !a.is_empty() && a.windows(2).all(|w| w[0] < w[1]);
        if !rises(&incidence) || !rises(&wavelength) || incidence[0] < 0.0 || incidence[lobes.len() - 1] >= FRAC_PI_2 {
            return None;
        }
        let tis = lobes.iter().map(Lobe::tis).collect();
        Some(Table { incidence, lobes, wavelength, factor, tis, transmitted: false, azimuth: 0.0 })
    }

    /// The same shapes with a stated scattered / incident flux for each incidence (as many).
    pub fn scattering(self, tis: Vec<f64>) -> Table {
        Table { tis, ..self }
    }

    /// The same lobes on the other side of the surface.
    pub fn transmitted(self) -> Table {
        Table { transmitted: true, ..self }
    }

    /// The lobes as they were given, by rising incidence; the values of the table are theirs times a factor of the wavelength.
    pub fn lobes(&self) -> &[Lobe] {
        &self.lobes
    }

    /// Vacuum wavelengths (m) and the factors on all values there, dimensionless.
    pub fn spectrum(&self) -> impl Iterator<Item = (f64, f64)> + '_ {
        self.wavelength.iter().copied().zip(self.factor.iter().copied())
    }

    /// True if the lobes are those of transmitted light.
    pub fn is_transmitted(&self) -> bool {
        self.transmitted
    }

    /// The same table at an azimuth (rad) of the light's travel from the lay.
    pub fn turned(self, azimuth: f64) -> Table {
        Table { azimuth, ..self }
    }

    /// Azimuth of the light's travel from the lay, rad; 0 if there is but one.
    pub fn azimuth(&self) -> f64 {
        self.azimuth
    }

    /// Scattered / incident flux by angle of incidence (rad) at factor 1: as it is used, and as the lobes integrate.
    pub fn totals(&self) -> impl Iterator<Item = (f64, [f64; 2])> + '_ {
        let pairs = self.tis.iter().zip(&self.lobes);
        self.incidence.iter().zip(pairs).map(|(incidence, (tis, lobe))| (*incidence, [*tis, lobe.tis()]))
    }
}

/// More light comes back than arrives.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error("the table scatters {:.1} % of the light at {:.1} deg incidence; expected at most 100 %", tis * 100.0, incidence.to_degrees())]
pub struct TooBright {
    /// Angle of incidence, rad.
    pub incidence: f64,
    /// Scattered / incident flux there, > 1.
    pub tis: f64,
}

/// Scatter interpolated in a [`Table`].
#[derive(Clone, Debug)]
pub struct Tabulated {
    /// Vacuum wavelengths (m) and the factors there, as in [`Table`], the scale included.
    spectrum: (Vec<f64>, Vec<f64>),
    grid: Grid,
    /// Angles of incidence of the sheets, 0 to pi/2.
    nodes: Nodes,
    /// BSDF at the nodes, before the spectrum.
    sheets: Vec<Sheet>,
    /// Sign of z where the light goes.
    side: f64,
}

impl Tabulated {
    /// The table with every value multiplied by `scale` (>= 0). Memory and time grow with the inverse square of the table's finest step:
    /// 0.8 MB and 0.1 s for steps of 1 by 10 deg, at most about 6 MB. Fails if it scatters more light than arrives.
    pub fn new(table: Table, scale: f64) -> Result<Tabulated, TooBright> {
        Tabulated::among(1, table, scale)
    }

    /// The same as one of `count` (>= 1) tables that together have the memory of one.
    pub fn among(count: usize, mut table: Table, scale: f64) -> Result<Tabulated, TooBright> {
        table.factor.iter_mut().for_each(|f| *f *= scale);
        if table.factor.iter().all(|f| *f == table.factor[0]) {
            table.wavelength.truncate(1);
            table.factor.truncate(1);
        }
        let tis = table.tis;
        let brightest = table.factor.iter().copied().fold(0.0, f64::max);
        for (&incidence, tis) in table.incidence.iter().zip(&tis) {
            // Tables that mean exactly 100 % reach it to the rounding of their decimals.
            if tis * brightest > 1.0 + 1e-9 {
                return Err(TooBright { incidence, tis: tis * brightest });
            }
        }
        let shape = Shape { incidence: table.incidence, lobes: table.lobes };
        let (grid, nodes) = resolution(&shape, MOST / count as f64);
        let sheet = |&theta: &f64| {
            let plane = Plane::at(theta);
            let value: Vec<f64> = grid.corners().map(|d| shape.at(&plane, d)).collect();
            Sheet::new(&grid, &value, continued(&shape.incidence, &tis, theta).min(1.0 / brightest))
        };
        let sheets = nodes.iter().map(sheet).collect();
        let side = if table.transmitted { -1.0 } else { 1.0 };
        Ok(Tabulated { spectrum: (table.wavelength, table.factor), grid, nodes: Nodes::new(&nodes), sheets, side })
    }

    /// A direction on the side of the lobes as one with z > 0, and back.
    fn mirrored(&self, d: DVec3) -> DVec3 {
        DVec3::new(d.x, d.y, self.side * d.z)
    }

    /// Factor of the spectrum and the scale at a vacuum wavelength (m).
    fn factor(&self, wavelength: f64) -> f64 {
        linear(&self.spectrum.0, &self.spectrum.1, wavelength)
    }

    /// The sheets on either side of an incidence with their weights in the mixture.
    fn around(&self, plane: &Plane) -> [(&Sheet, f64); 2] {
        let (j, w) = self.nodes.bracket([plane.sin, plane.cos]);
        [(&self.sheets[j], 1.0 - w), (&self.sheets[j + 1], w)]
    }

    /// BRDF at unit factor towards `wo`, 1/sr, and the albedo.
    fn mixture(&self, wi: DVec3, wo: DVec3) -> (f64, f64) {
        let plane = Plane::of(wi);
        let place = self.grid.place(plane.enter(wo));
        let [(a, s), (b, w)] = self.around(&plane);
        (s * a.at(&self.grid, &place) + w * b.at(&self.grid, &place), s * a.flux() + w * b.flux())
    }
}

/// TIS at incidence `theta` (rad): linear between the entries of a table, held below the first; beyond the last it rises as it rose
/// between the last two, if it did. Not yet kept below 1.
fn continued(incidence: &[f64], tis: &[f64], theta: f64) -> f64 {
    match (incidence, tis) {
        ([.., from, last], [.., before, end]) if theta > *last => {
            end + ((end - before) / (last - from)).max(0.0) * (theta - last)
        }
        _ => linear(incidence, tis, theta),
    }
}

/// Corners of the grid times nodes, at most about: 2 bytes each.
const MOST: f64 = 2.5e6;

/// Azimuth about the specular side in which lobes are steep, rad.
const STEEP: f64 = FRAC_PI_3;

/// The grid of the sheets and their nodes of incidence. Rings and steps of incidence are as fine as the table's finest step of theta, but
/// within 0.25 to 1.5 deg, and coarser where memory (`most` corners) asks for it; the table's own incidences are nodes.
fn resolution(shape: &Shape, most: f64) -> (Grid, Vec<f64>) {
    let mut phi = sectors(&shape.azimuths());
    if shape.lobes.iter().all(Lobe::symmetric) {
        // Half of the turn says it all; a sector may lie across its end.
        phi.retain(|phi| *phi < PI - 1e-9);
        phi.push(PI);
    }
    let finest = shape.lobes.iter().map(Lobe::finest).fold(f64::INFINITY, f64::min);
    let smallest = FRAC_PI_2 * (phi.len() as f64 / most).sqrt();
    let step = finest.clamp(0.25f64.to_radians(), 1.5f64.to_radians()).max(smallest);
    let mut nodes = vec![0.0];
    for &end in shape.incidence.iter().chain([&FRAC_PI_2]) {
        let from = nodes[nodes.len() - 1];
        let count = ((end - from) / step - 1e-9).ceil().max(0.0) as usize;
        nodes.extend((1..=count).map(|j| from + (end - from) * j as f64 / count as f64));
    }
    (Grid::new((FRAC_PI_2 / step - 1e-9).ceil() as usize, phi), nodes)
}

/// The table's azimuths (rad), and between those within [`STEEP`] of the specular side three more: turned lobes cross the sectors
/// aslant there, and are steep. None farther from the next than [`WIDEST`].
fn sectors(phi: &[f64]) -> Vec<f64> {
    let cuts = |p: &[f64]| {
        let middle = 0.5 * (p[0] + p[1]);
        let (from, width) = (p[0], p[1] - p[0]);
        let least = if middle.min(TAU - middle) < STEEP { 4.0 } else { 1.0 };
        let count = (width / WIDEST - 1e-9).ceil().max(least);
        (0..count as usize).map(move |i| from + width * i as f64 / count)
    };
    phi.windows(2).flat_map(cuts).chain([TAU]).collect()
}

impl Bsdf for Tabulated {
    fn eval(&self, at: &Incidence, wo: DVec3) -> f64 {
        self.weigh(at, wo).value
    }

    fn pdf(&self, at: &Incidence, wo: DVec3) -> f64 {
        self.weigh(at, wo).density
    }

    fn weigh(&self, at: &Incidence, wo: DVec3) -> Weighed {
        let wo = self.mirrored(wo);
        if wo.z <= 0.0 {
            return Weighed::default();
        }
        let (f, albedo) = self.mixture(at.wi, wo);
        Weighed { value: self.factor(at.wavelength) * f, density: if f > 0.0 { f * wo.z / albedo } else { 0.0 } }
    }

    fn sample(&self, at: &Incidence, rng: &mut Rng) -> Option<DVec3> {
        let plane = Plane::of(at.wi);
        let [(a, s), (b, w)] = self.around(&plane);
        let [first, second] = rng.pair();
        // What the choice of the sheet leaves of the first number is uniform again.
        let (one, other) = (s * a.flux(), w * b.flux());
        let rest = first * (one + other);
        // Looked up, not branched to: a branch would often be guessed wrongly.
        let (sheet, from, flux) = [(b, one, other), (a, 0.0, one)][usize::from(rest < one)];
        let part = ((rest - from) / flux).min(1.0 - f64::EPSILON / 2.0);
        (one + other > 0.0).then(|| self.mirrored(plane.leave(sheet.draw(&self.grid, [part, second]))))
    }

    fn albedo(&self, at: &Incidence) -> f64 {
        let [(a, s), (b, w)] = self.around(&Plane::of(at.wi));
        self.factor(at.wavelength) * (s * a.flux() + w * b.flux())
    }

    fn transmits(&self) -> bool {
        self.side < 0.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bsdf::speos;

    /// The direction at q = `square` and azimuth `phi` (rad).
    fn direction(square: f64, phi: f64) -> DVec3 {
        DVec3::new(square.sqrt() * phi.cos(), square.sqrt() * phi.sin(), (1.0 - square).sqrt())
    }

    /// Largest and rms relative difference of `model` from `shape` (scaled alike) over the disc, and the flux that lies elsewhere.
    fn difference(model: &Tabulated, shape: &Shape, theta: f64) -> [f64; 3] {
        let plane = Plane::at(theta);
        let fine = Grid::new(720, (0..=720).map(|j| TAU * f64::from(j) / 720.0).collect());
        let exact = Sheet::new(&fine, &fine.corners().map(|d| shape.at(&plane, d)).collect::<Vec<f64>>(), 1.0);
        let [(a, s), (b, w)] = model.around(&plane);
        let flux = s * a.flux() + w * b.flux();
        let (mut most, mut squares, mut elsewhere) = (0.0f64, 0.0, 0.0);
        // Middles of cells of equal projected solid angle.
        let cells = 300;
        for cell in 0..cells * cells {
            let part = |k: i32| (f64::from(k) + 0.5) / f64::from(cells);
            let d = direction(part(cell / cells), TAU * part(cell % cells));
            let place = model.grid.place(d);
            let got = (s * a.at(&model.grid, &place) + w * b.at(&model.grid, &place)) / flux;
            let wanted = exact.at(&fine, &fine.place(d));
            most = most.max((got / wanted - 1.0).abs());
            squares += (got / wanted - 1.0).powi(2) / f64::from(cells * cells);
            elsewhere += (got - wanted).abs() * PI / f64::from(cells * cells);
        }
        [most, squares.sqrt(), elsewhere]
    }

    #[test]
    fn the_grid_keeps_to_the_table() {
        let text = include_str!("../../../systems/triplet/black-anodize-plausible.anisotropicbsdf");
        let table = speos::parse(text).expect("a good table").remove(0);
        let shape = Shape { incidence: table.incidence.clone(), lobes: table.lobes.clone() };
        let model = Tabulated::new(table, 1.0).expect("below 100 %");
        // At the table's incidences, between them, and where its last lobe is turned farthest.
        for (theta, elsewhere) in
            [(0.0, 5e-4), (7.5, 5e-3), (45.0, 5e-4), (58.5, 5e-3), (67.5, 5e-3), (85.5, 6e-3), (89.5, 6e-3)]
        {
            let [most, rms, moved] = difference(&model, &shape, f64::to_radians(theta));
            assert!(most < 0.4 && rms < 0.013 && moved < elsewhere, "{theta}: {most} {rms} {moved}");
        }
    }

    #[test]
    fn scatter_goes_on_rising_beyond_the_last_incidence() {
        let (incidence, tis) = ([0.0, 1.0, 1.2], [0.1, 0.1, 0.3]);
        assert!((continued(&incidence, &tis, 1.3) - 0.4).abs() < 1e-12);
        assert_eq!(continued(&incidence, &tis, 0.5), 0.1);
        assert_eq!(continued(&incidence, &[0.3, 0.3, 0.1], 1.3), 0.1);
        assert_eq!(continued(&[0.0], &[0.2], 1.3), 0.2);
    }

    #[test]
    fn memory_is_bounded_for_the_finest_table() {
        let theta: Vec<f64> = (0..=9000).map(|i| FRAC_PI_2 * f64::from(i) / 9000.0).collect();
        let phi: Vec<f64> = (0..=100).map(|j| TAU * f64::from(j) / 100.0).collect();
        let value = vec![0.1; theta.len() * phi.len()];
        let lobe = Lobe::new(0.3, theta, phi, value).expect("a lobe");
        let shape = Shape { incidence: vec![0.3], lobes: vec![lobe] };
        for most in [MOST, MOST / 8.0] {
            let (grid, nodes) = resolution(&shape, most);
            assert!(((grid.len() * nodes.len()) as f64) < 1.1 * most, "{} x {}", grid.len(), nodes.len());
        }
    }
}

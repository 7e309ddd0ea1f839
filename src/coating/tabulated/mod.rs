//! Shares over wavelength and angle, as a maker measures or calculates them.
//!
//!     R_s, R_p, T_s, T_p(lambda, theta)   bilinear between the rows, dimensionless, R + T <= 1; the rest is absorbed
//!     a = sqrt(share) exp(i phase)        phases in the frames of [`Amplitudes`]; a mirror's where none are given
//!
//! theta is the angle on the front side (in air, for a face of glass in air); light that arrives at the back is looked up
//! at the angle that Snell's law gives it in front, with the same shares: T is the same from both sides, R only if
//! nothing is absorbed. Beyond the last angle and wavelength the end values hold. Where no ray is refracted, T is reflected: R + T.
//! Left out: what a lossy coating reflects from its back (a [`super::Stack`] knows).

mod csv;

use super::{Coating, Side};
use crate::error::Problem;
use crate::math::table::bracket;
use crate::optics::refraction::normal_component_squared;
use crate::optics::{Amplitudes, Incidence, Split};
use num_complex::Complex64;
use std::f64::consts::{FRAC_PI_2, PI};

pub use self::csv::parse;

/// Shares that are typed with some digits may exceed 1 by so much, dimensionless.
const ROUNDING: f64 = 1e-6;

/// Phases of R_s, R_p, T_s, T_p where none are given: a mirror's, rad.
pub const MIRROR: [f64; 4] = [PI, 0.0, 0.0, 0.0];

/// One row of a table.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Row {
    /// Vacuum wavelength, m.
    pub wavelength: f64,
    /// Angle of incidence in front, rad.
    pub angle: f64,
    /// R_s, R_p, T_s, T_p, 0..1.
    pub power: [f64; 4],
    /// Phases of the same, rad.
    pub phase: [f64; 4],
}

/// A table, for light from one side.
#[derive(Clone, Debug)]
pub struct Tabulated {
    wavelengths: Vec<f64>,
    angles: Vec<f64>,
    /// Powers and phase factors, all angles of the first wavelength first.
    cells: Vec<Cell>,
    from: Side,
}

#[derive(Clone, Copy, Debug)]
struct Cell {
    power: [f64; 4],
    phase: [Complex64; 4],
}

impl Tabulated {
    /// A table of rows in any order: all wavelengths at all angles.
    pub fn new(rows: &[Row], from: Side) -> Result<Tabulated, Problem> {
        let sorted = |value: fn(&Row) -> f64| {
            let mut values: Vec<f64> = rows.iter().map(value).collect();
            values.sort_by(f64::total_cmp);
            values.dedup();
            values
        };
        let (wavelengths, angles) = (sorted(|row| row.wavelength), sorted(|row| row.angle));
        if rows.is_empty() {
            return Err(Problem::error("this table has no rows"));
        }
        let mut cells = vec![None; wavelengths.len() * angles.len()];
        for row in rows {
            let [r, a] = [(&wavelengths, row.wavelength), (&angles, row.angle)]
                .map(|(grid, value)| grid.partition_point(|&known| known < value));
            let place = format!("{:.4} nm and {:.4} deg", row.wavelength * 1e9, row.angle.to_degrees());
            if let Some(sum) = [0, 1].map(|k| row.power[k] + row.power[k + 2]).iter().find(|sum| **sum > 1.0 + ROUNDING)
            {
                return Err(Problem::error(format!("R + T is {sum} at {place}")).expecting("at most 1"));
            }
            let cell = Cell { power: row.power, phase: row.phase.map(Complex64::cis) };
            if cells[r * angles.len() + a].replace(cell).is_some() {
                return Err(Problem::error(format!("there are two rows at {place}")));
            }
        }
        let missing = cells.iter().position(Option::is_none);
        if let Some(at) = missing {
            let (wavelength, angle) = (wavelengths[at / angles.len()] * 1e9, angles[at % angles.len()].to_degrees());
            let what = format!("the table has no row at {wavelength:.4} nm and {angle:.4} deg");
            return Err(Problem::error(what).expecting("every wavelength at every angle"));
        }
        Ok(Tabulated { wavelengths, angles, cells: cells.into_iter().flatten().collect(), from })
    }

    /// The same table for light from the other side.
    pub fn from(&self, from: Side) -> Tabulated {
        Tabulated { from, ..self.clone() }
    }

    /// Angle in front, rad; grazing where none leads there.
    fn angle(&self, at: &Incidence) -> f64 {
        let sin = at.wi.x.hypot(at.wi.y);
        match self.from {
            Side::Front => sin.atan2(at.cos()),
            Side::Back => (sin * at.index[0].re / at.index[1].re).min(1.0).asin(),
        }
    }

    fn cell(&self, wavelength: f64, angle: f64) -> Cell {
        let (row, down) = bracket(&self.wavelengths, wavelength);
        let (column, along) = bracket(&self.angles, angle);
        let mut cell = Cell { power: [0.0; 4], phase: [Complex64::ZERO; 4] };
        for (r, weight) in [(row, 1.0 - down), (row + 1, down)] {
            for (c, weight) in [(column, weight * (1.0 - along)), (column + 1, weight * along)] {
                let Some(corner) = self.cells.get(r * self.angles.len() + c).filter(|_| weight > 0.0) else { continue };
                for k in 0..4 {
                    cell.power[k] += weight * corner.power[k];
                    cell.phase[k] += weight * corner.phase[k];
                }
            }
        }
        cell
    }
}

impl Coating for Tabulated {
    fn split(&self, at: &Incidence) -> Split {
        let cell = self.cell(at.wavelength, self.angle(at).min(FRAC_PI_2));
        let total = normal_component_squared(at.cos(), at.index[0].re, at.index[1].re) <= 0.0;
        let amplitude = |k: usize, power: f64| {
            // Opposite phases cancel half-way between two rows: the phase is then any.
            let size = cell.phase[k].norm();
            if size > 0.0 { cell.phase[k] * (power.sqrt() / size) } else { power.sqrt().into() }
        };
        let [rs, rp, ts, tp] = cell.power;
        if total {
            let reflected = Amplitudes { s: amplitude(0, rs + ts), p: amplitude(1, rp + tp) };
            return Split { reflected, transmitted: Amplitudes::ZERO };
        }
        let reflected = Amplitudes { s: amplitude(0, rs), p: amplitude(1, rp) };
        Split { reflected, transmitted: Amplitudes { s: amplitude(2, ts), p: amplitude(3, tp) } }
    }

    fn opaque(&self) -> bool {
        self.cells.iter().all(|cell| cell.power[2..] == [0.0; 2])
    }

    fn range(&self) -> Option<[f64; 2]> {
        // Of a single wavelength the shares are taken to hold at all.
        (self.wavelengths.len() > 1).then(|| [self.wavelengths[0], self.wavelengths[self.wavelengths.len() - 1]])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table() -> Tabulated {
        let row = |nm: f64, degrees: f64, r: f64| Row {
            wavelength: nm * 1e-9,
            angle: degrees.to_radians(),
            power: [r, 0.5 * r, 1.0 - r, 1.0 - 0.5 * r],
            phase: MIRROR,
        };
        let rows = [row(500.0, 0.0, 0.1), row(500.0, 90.0, 0.9), row(600.0, 0.0, 0.3), row(600.0, 90.0, 0.7)];
        Tabulated::new(&rows, Side::Front).expect("a grid")
    }

    #[test]
    fn rows_are_met_and_between_them_it_is_bilinear() {
        let table = table();
        let rs = |nm: f64, degrees: f64| {
            let at = Incidence::in_air(f64::to_radians(degrees), nm * 1e-9);
            table.split(&at).reflected.s.norm_sqr()
        };
        for (nm, degrees, wanted) in [(500.0, 0.0, 0.1), (600.0, 0.0, 0.3), (550.0, 45.0, 0.5), (400.0, 45.0, 0.5)] {
            assert!((rs(nm, degrees) - wanted).abs() < 1e-12, "{nm} {degrees}: {}", rs(nm, degrees));
        }
    }

    #[test]
    fn both_sides_pass_the_same() {
        let glass = [1.0, 1.5].map(|n| Complex64::new(n, 0.0));
        let front = Incidence { index: glass, ..Incidence::in_air(0.7, 520e-9) };
        let inside = (0.7f64.sin() / 1.5).asin();
        let back = Incidence { index: [glass[1], glass[0]], ..Incidence::in_air(inside, 520e-9) };
        let [one, other] = [table().split(&front), table().from(Side::Back).split(&back)];
        assert!((one.transmitted.unpolarised() - other.transmitted.unpolarised()).abs() < 1e-15);
        let beyond = Incidence { index: [glass[1], glass[0]], ..Incidence::in_air(0.9, 520e-9) };
        assert!((table().from(Side::Back).split(&beyond).reflected.unpolarised() - 1.0).abs() < 1e-15);
    }

    #[test]
    fn holes_and_doubles_are_refused() {
        let row = |nm: f64, angle: f64| Row { wavelength: nm, angle, power: [0.5; 4], phase: MIRROR };
        let message = |rows: &[Row]| Tabulated::new(rows, Side::Front).expect_err("no grid").message;
        assert!(message(&[row(5e-7, 0.0), row(6e-7, 1.0)]).contains("no row"));
        assert!(message(&[row(5e-7, 0.0), row(5e-7, 0.0)]).contains("two rows"));
        assert!(message(&[Row { power: [0.6; 4], ..row(5e-7, 0.0) }]).contains("R + T"));
        assert!(message(&[]).contains("no rows"));
    }
}

//! The characteristic matrix of a whole stack over a band of wavelengths and a range of x = (n1 sin theta1)^2.
//!
//! The wavenumber 1 / lambda and x are each divided evenly: phases are linear in the one and smooth in the other
//! ([`Table`](super::Table) says why one table serves all exterior media). In every rectangle the entries of the matrix are a
//! polynomial ([`patch`](super::patch)). The division is made finer by half along either axis until R and T of s and p light differ
//! from the stack's own by no more than [`BOUND`] where they are tried, in all but a sixteenth of the rectangles: elsewhere, then, by
//! less than 1e-6. In the rectangles that are left - at the rows of a tabulated index, at guided waves - there is no table.
//!
//! What vanishes without absorption has as few terms as it needs.
//! Cost: 20 ns more than a look-up at one wavelength; half a second and 2 MB for forty layers from blue to red in both zones.

use super::patch::{self, DEGREE, NODES, Row, Terms, Values};
use super::table::{Matrix, matrix};
use super::{Around, Fields, Layer, split};
use crate::optics::Split;
use num_complex::Complex64;
use rayon::prelude::*;
use std::f64::consts::TAU;

/// Largest error of R and T where it is tried.
const BOUND: f64 = 2e-7;
/// What the terms left out of the lesser half may come to, relative to the greater.
const FAINT: f64 = 1e-7;
/// Rectangles at most: 1.2 kB each, up to twice that in a stack that absorbs.
const MOST: usize = 1 << 12;
/// Rectangles per radian of phase along either axis, to begin with.
const DENSITY: [f64; 2] = [1.0, 1.5];
/// Places in a rectangle, along either axis, where the error is tried: it is largest in the corners.
const TRIALS: [f64; 4] = [-0.98, -0.4, 0.4, 0.98];

/// Which end of the stack light meets first.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum End {
    First,
    Last,
}

/// A stack, the light it is met by, and what may lie beyond it; functions of the vacuum wavelength (m).
pub struct Seen<'a> {
    /// The layers in the order light meets them.
    pub layers: &'a (dyn Fn(f64) -> Vec<Layer> + Sync),
    /// Highest real index of a medium that light comes from.
    pub highest: &'a (dyn Fn(f64) -> f64 + Sync),
    /// Index of an opaque substrate; `None`: any of the media.
    pub beyond: &'a (dyn Fn(f64) -> Option<Complex64> + Sync),
}

/// The matrix of a stack over wavelength and some angles.
#[derive(Clone, Debug)]
pub struct Zone {
    wavenumber: Axis,
    tangential: Axis,
    /// By wavenumber, then x: the patch of what does not vanish without absorption, and of the rest where there is any.
    rows: Vec<Row>,
    /// Degree of the rest.
    rest: Option<usize>,
    /// Which patches are good.
    good: Vec<bool>,
}

/// Even pieces.
#[derive(Clone, Copy, Debug)]
struct Axis {
    from: f64,
    /// Pieces per unit.
    density: f64,
    count: usize,
}

impl Axis {
    fn new(from: f64, to: f64, count: usize) -> Axis {
        Axis { from, density: count as f64 / (to - from), count }
    }

    /// At `t`, -1..1, in a piece.
    fn at(&self, piece: usize, t: f64) -> f64 {
        self.from + (piece as f64 + 0.5 + 0.5 * t) / self.density
    }

    /// The piece `x` is in, and where in it, -1..1; `None` beyond the ends.
    fn place(&self, x: f64) -> Option<(usize, f64)> {
        let place = (x - self.from) * self.density;
        // The last piece has both its ends; a rounding beyond the first is none.
        let inside = (-1e-9..self.count as f64 + 1e-9).contains(&place);
        let piece = (place as usize).min(self.count - 1);
        inside.then_some((piece, 2.0 * (place - piece as f64) - 1.0))
    }
}

impl Zone {
    /// The table from the first to the second vacuum wavelength (m) and x. `None` if it would be too large, or good in less than
    /// three quarters of it.
    pub fn new(stack: &Seen, [from, to]: [f64; 2], x: [f64; 2]) -> Option<Zone> {
        if x[0] >= x[1] {
            return None;
        }
        let mut counts = first_counts(stack, [from, to], x);
        loop {
            if counts[0] * counts[1] > MOST {
                return None;
            }
            let axes = [Axis::new(1.0 / to, 1.0 / from, counts[0]), Axis::new(x[0], x[1], counts[1])];
            let terms = all_terms(stack, axes)?;
            let zone = Zone::tried(stack, axes, &terms);
            let failed = zone.good.iter().filter(|good| !**good).count();
            let larger = 3 * zone.good.len() <= 2 * MOST;
            if !larger || 16 * failed <= zone.good.len() {
                return (4 * failed < zone.good.len()).then_some(zone);
            }
            let bad = terms.iter().zip(&zone.good).filter(|(_, good)| !**good);
            let [u, v] = bad.map(|(terms, _)| terms[0].highest()).fold([0.0; 2], |a, b| [a[0] + b[0], a[1] + b[1]]);
            let axis = if u > v { 0 } else { 1 };
            counts[axis] += counts[axis] / 2;
        }
    }

    /// The table of these terms, and where it is good.
    fn tried(stack: &Seen, [wavenumber, tangential]: [Axis; 2], terms: &[[Terms; 2]]) -> Zone {
        let absorbs = terms.iter().any(|[main, rest]| rest.size() > 1e-13 * main.size());
        let enough = |&degree: &usize| terms.iter().all(|[main, rest]| rest.beyond(degree) <= FAINT * main.size());
        let rest = absorbs.then(|| (0..DEGREE).find(enough).unwrap_or(DEGREE));
        let mut rows = Vec::new();
        for [main, lesser] in terms {
            main.store(DEGREE, &mut rows);
            rest.inspect(|&degree| lesser.store(degree, &mut rows));
        }
        let mut zone = Zone { wavenumber, tangential, rows, rest, good: vec![true; terms.len()] };
        zone.good = (0..terms.len()).into_par_iter().map(|patch| zone.is_good(stack, patch)).collect();
        zone
    }

    fn is_good(&self, stack: &Seen, patch: usize) -> bool {
        let (row, column) = (patch / self.tangential.count, patch % self.tangential.count);
        TRIALS.iter().all(|&u| {
            let wavelength = 1.0 / self.wavenumber.at(row, u);
            let layers = (stack.layers)(wavelength);
            let error = |v: f64| self.error(stack, &layers, wavelength, self.tangential.at(column, v));
            TRIALS.iter().all(|&v| error(v) <= BOUND)
        })
    }

    /// Largest error of R and T of s and p light, and a hundredth of that of r and t, whose phases turn fast in narrow resonances; for
    /// light from the medium of highest index and from vacuum, into either.
    fn error(&self, stack: &Seen, layers: &[Layer], wavelength: f64, x: f64) -> f64 {
        let ends = [1.0, (stack.highest)(wavelength)];
        let beyond = (stack.beyond)(wavelength);
        let mut error = 0.0f64;
        for n1 in ends.into_iter().filter(|n1| n1 * n1 > x) {
            for n2 in ends.map(Complex64::from) {
                let around = Around { n1, n2: beyond.unwrap_or(n2), cos1: (1.0 - x / (n1 * n1)).sqrt() };
                let wanted = split(&around, wavelength, layers.iter().copied());
                let found = self.column(x).and_then(|place| self.split(&around, 1.0 / wavelength, place, End::First));
                let Some(found) = found else { continue };
                for (a, b) in [(found.reflected, wanted.reflected), (found.transmitted, wanted.transmitted)] {
                    for (a, b) in [(a.s, b.s), (a.p, b.p)] {
                        error = error.max((a.norm_sqr() - b.norm_sqr()).abs()).max(0.01 * (a - b).norm());
                    }
                }
            }
        }
        error
    }

    /// The column of `x` and where in it; `None` beyond the zone.
    pub fn column(&self, x: f64) -> Option<(usize, f64)> {
        self.tangential.place(x)
    }

    /// What the stack does to light of a wavenumber (1/m) at a place of a column that meets `end` of it; `None` where the table is not
    /// good.
    pub fn split(&self, around: &Around, wavenumber: f64, (column, v): (usize, f64), end: End) -> Option<Split> {
        let (row, u) = self.wavenumber.place(wavenumber)?;
        let patch = row * self.tangential.count + column;
        if !self.good[patch] {
            return None;
        }
        const MAIN: usize = patch::rows(DEGREE);
        let stride = MAIN + self.rest.map_or(0, patch::rows);
        let rows = &self.rows[patch * stride..(patch + 1) * stride];
        let main = patch::sum(rows.first_chunk()?, [u, v]);
        let rest = self.rest.map_or([0.0; 8], |degree| patch::sum_of(degree, &rows[MAIN..], [u, v]));
        let mut entries = joined(&main, &rest);
        if end == End::Last {
            entries.swap(0, 3);
            entries.swap(4, 7);
        }
        let beyond = around.beyond();
        let top = |i: usize, [e, h]: [Complex64; 2]| {
            [entries[i] * e + entries[i + 1] * h, entries[i + 2] * e + entries[i + 3] * h]
        };
        Some(around.split(&Fields { s: top(0, beyond.s), p: top(4, beyond.p) }, 1.0))
    }
}

/// The terms in every rectangle, by wavenumber, then x.
fn all_terms(stack: &Seen, [wavenumber, tangential]: [Axis; 2]) -> Option<Vec<[Terms; 2]>> {
    let row = |row: usize| {
        let lights = patch::nodes().map(|u| 1.0 / wavenumber.at(row, u));
        let layers = lights.map(|wavelength| (stack.layers)(wavelength));
        let terms = |column: usize| {
            let places = patch::nodes().map(|v| tangential.at(column, v));
            let mut values = [[[[0.0; 8]; NODES]; NODES]; 2];
            for (i, j) in (0..NODES).flat_map(|i| (0..NODES).map(move |j| (i, j))) {
                [values[0][i][j], values[1][i][j]] = parted(&matrix(&layers[i], lights[i], places[j])?);
            }
            Some(values.each_ref().map(Terms::through))
        };
        (0..tangential.count).map(terms).collect::<Option<Vec<_>>>()
    };
    let rows: Option<Vec<_>> = (0..wavenumber.count).into_par_iter().map(row).collect();
    Some(rows?.into_iter().flatten().collect())
}

/// Real parts of the diagonal with imaginary ones beside it, which do not vanish without absorption, and the others.
fn parted(entries: &Matrix) -> [Values; 2] {
    let main = |i: usize| {
        if matches!(i % 4, 0 | 3) { [entries[2 * i], entries[2 * i + 1]] } else { [entries[2 * i + 1], entries[2 * i]] }
    };
    [0, 1].map(|half| std::array::from_fn(|i| main(i)[half]))
}

/// The entries again.
fn joined(main: &Values, rest: &Values) -> [Complex64; 8] {
    std::array::from_fn(|i| {
        if matches!(i % 4, 0 | 3) { Complex64::new(main[i], rest[i]) } else { Complex64::new(rest[i], main[i]) }
    })
}

/// Rectangles for the phase that the stack gains along either axis.
fn first_counts(stack: &Seen, [short, long]: [f64; 2], [least, most]: [f64; 2]) -> [usize; 2] {
    let gained = |wavelength: f64, x: f64| {
        let (here, there) = ((stack.layers)(short), (stack.layers)(wavelength));
        let phase = |layer: &Layer, wavelength: f64, x: f64| {
            TAU / wavelength * layer.thickness * (layer.index * layer.index - x).sqrt()
        };
        let pairs = here.iter().zip(&there);
        pairs.map(|(a, b)| (phase(a, short, least) - phase(b, wavelength, x)).norm()).sum::<f64>()
    };
    let count = |axis: usize, phase: f64| ((DENSITY[axis] * phase).ceil() as usize).clamp(4, MOST / 16);
    [count(0, gained(long, least)), count(1, gained(short, most))]
}

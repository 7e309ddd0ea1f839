//! The characteristic matrix of a whole stack at one wavelength, looked up instead of multiplied.
//!
//! Every entry of the matrix is an entire function of x = (n1 sin theta1)^2 - the square of m is linear in x, and the
//! matrix of a layer is even in m - so it has no kink at any critical angle, and one table serves both exterior media,
//! whatever they are, and all angles. x is divided into equal pieces, twice as many until a Chebyshev series of
//! [`TERMS`] terms in each differs from the matrix by no more than [`BOUND`] of its size half-way between all nodes.
//!
//! Only what the table gives comes from a series; R, T and the amplitudes follow as for the stack itself.
//! Source: Trefethen, Approximation Theory and Approximation Practice (2013), ch. 8 (geometric convergence).

use super::{Around, Fields, Layer, Passage};
use crate::optics::Split;
use num_complex::Complex64;
use std::f64::consts::{PI, TAU};

/// Terms of a series.
const TERMS: usize = 10;
/// Largest error of the matrix, relative to its largest entry.
const BOUND: f64 = 1e-12;
/// More pieces are not worth their memory: such a stack is not tabulated.
const MOST: usize = 1024;
/// A stack that lets less amplitude through than this has entries too large for a table.
const FAINTEST: f64 = 1e-100;
/// Four complex entries for s, four for p.
const ENTRIES: usize = 16;

/// Real and imaginary parts of the entries, row by row, of s and then of p.
pub type Matrix = [f64; ENTRIES];

/// The matrix of a stack over the angle, at one wavelength.
#[derive(Clone, Debug)]
pub struct Table {
    /// Largest x.
    reach: f64,
    /// Chebyshev coefficients of each piece.
    pieces: Vec<[Matrix; TERMS]>,
}

impl Table {
    /// The table of `layers` (in the order light meets them) at vacuum wavelength `wavelength` (m) for light from media of
    /// index up to `highest`. `None` if the stack is too thick to be tabulated.
    pub fn new(layers: &[Layer], wavelength: f64, highest: f64) -> Option<Table> {
        let reach = highest * highest;
        let at = |x: f64| matrix(layers, wavelength, x);
        let mut count = 1;
        loop {
            let piece = |i: usize| piece(&at, reach * i as f64 / count as f64, reach * (i + 1) as f64 / count as f64);
            let pieces: Option<Vec<Option<_>>> = (0..count).map(piece).collect();
            match pieces?.into_iter().collect::<Option<Vec<_>>>() {
                Some(pieces) => return Some(Table { reach, pieces }),
                None if count == MOST => return None,
                None => count *= 2,
            }
        }
    }

    /// How many pieces there are.
    pub fn pieces(&self) -> usize {
        self.pieces.len()
    }

    /// What the stack does; `None` where the light comes from a medium of a higher index than the table was made for.
    pub fn split(&self, around: &Around) -> Option<Split> {
        let place = around.tangential_squared() / self.reach * self.pieces.len() as f64;
        let index = place as usize;
        let piece = self.pieces.get(index)?;
        let entries = sum(piece, 2.0 * (place - index as f64) - 1.0);
        let entry = |i: usize| Complex64::new(entries[2 * i], entries[2 * i + 1]);
        let beyond = around.beyond();
        let top =
            |i: usize, [e, h]: [Complex64; 2]| [entry(i) * e + entry(i + 1) * h, entry(i + 2) * e + entry(i + 3) * h];
        Some(around.split(&Fields { s: top(0, beyond.s), p: top(4, beyond.p) }, 1.0))
    }
}

/// The series at t, -1..1.
fn sum(piece: &[Matrix; TERMS], t: f64) -> Matrix {
    let mut polynomial = [1.0, t];
    let mut sum = piece[0];
    for terms in &piece[1..] {
        for (sum, term) in sum.iter_mut().zip(terms) {
            *sum += polynomial[1] * term;
        }
        polynomial = [polynomial[1], 2.0 * t * polynomial[1] - polynomial[0]];
    }
    sum
}

/// The coefficients between `from` and `to`: `Some(None)` if they are not good enough, `None` if there is no table at all.
fn piece(at: &impl Fn(f64) -> Option<Matrix>, from: f64, to: f64) -> Option<Option<[Matrix; TERMS]>> {
    let x = |t: f64| 0.5 * (from + to) + 0.5 * (to - from) * t;
    let node = |j: usize| (PI * (j as f64 + 0.5) / TERMS as f64).cos();
    let mut piece = [[0.0; ENTRIES]; TERMS];
    for j in 0..TERMS {
        let values = at(x(node(j)))?;
        for (k, terms) in piece.iter_mut().enumerate() {
            let weight = if k == 0 { 1.0 } else { 2.0 } / TERMS as f64;
            let polynomial = (PI * k as f64 * (j as f64 + 0.5) / TERMS as f64).cos();
            terms.iter_mut().zip(values).for_each(|(term, value)| *term += weight * polynomial * value);
        }
    }
    for j in 0..=TERMS {
        // Between the nodes and at both ends.
        let t = (PI * j as f64 / TERMS as f64).cos();
        let (found, wanted) = (sum(&piece, t), at(x(t))?);
        let largest = wanted.iter().fold(0.0, |size: f64, entry| size.max(entry.abs()));
        if found.iter().zip(wanted).any(|(found, wanted)| (found - wanted).abs() > BOUND * largest) {
            return Some(None);
        }
    }
    Some(Some(piece))
}

/// The matrix at one x; `None` if it is too large.
pub fn matrix(layers: &[Layer], wavelength: f64, x: f64) -> Option<Matrix> {
    let [one, zero] = [Complex64::ONE, Complex64::ZERO];
    let mut columns = [[one, zero], [zero, one]].map(|column| Fields { s: column, p: column });
    let mut scale = 1.0;
    for layer in layers.iter().rev() {
        let passage = Passage::new(layer, layer.index * layer.index - x, TAU / wavelength);
        columns = columns.map(|column| passage.cross(&column));
        scale *= passage.scale;
    }
    let [left, right] = columns;
    let entries = [left.s[0], right.s[0], left.s[1], right.s[1], left.p[0], right.p[0], left.p[1], right.p[1]];
    let finite = entries.iter().all(|entry| entry.is_finite());
    (finite && scale > FAINTEST)
        .then(|| std::array::from_fn(|i| if i % 2 == 0 { entries[i / 2].re } else { entries[i / 2].im } / scale))
}

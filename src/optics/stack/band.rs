//! The characteristic matrix of a whole stack over a band of wavelengths and all angles, looked up instead of multiplied.
//!
//! An even grid over the wavenumber 1 / lambda and over x = (n1 sin theta1)^2: phases are linear in the one and smooth in the other
//! ([`Table`](super::Table) says why one table serves all exterior media). Between its nodes the matrix is Lagrange's polynomial
//! through 8 x 8 of them. The grid is made finer by half along either axis until between the nodes R and T of s and p light differ from
//! the stack's own by no more than [`BOUND`] in all but a sixteenth of the steps where it is tried: elsewhere, then, by less than 1e-6.
//! In the steps that are left - at the rows of a tabulated index, at guided waves - the layers are multiplied out.
//!
//! Of a stack that is met from its other side the matrix is the same with its diagonal turned round, for that of each layer is.
//! Cost: some 100 ns per look-up; a second and 4 MB for forty layers from blue to red, 8 MB at most if nothing absorbs.

use super::table::{Matrix, matrix};
use super::{Around, Fields, Layer, split};
use crate::optics::Split;
use num_complex::Complex64;
use std::f64::consts::TAU;
use std::ops::Range;

/// Nodes of a polynomial.
const NODES: usize = 8;
/// Largest error of R and T where it is tried.
const BOUND: f64 = 2e-7;
/// Nodes of a table at most: 64 bytes each, 128 in a stack that absorbs.
const MOST: usize = 1 << 17;
/// Steps of the grid per radian of phase along either axis, to begin with.
const DENSITY: [f64; 2] = [4.5, 9.0];
/// Places across the axis at which steps along the other are tried.
const TRIALS: usize = 20;

/// Half of a matrix: one of the real and imaginary parts of each entry, four of s and four of p.
type Half = [f64; 8];

/// Which end of the stack light meets first.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum End {
    First,
    Last,
}

/// A stack, the light it is met by, and what may lie beyond it; functions of the vacuum wavelength (m).
pub struct Seen<'a> {
    /// The layers in the order light meets them.
    pub layers: &'a dyn Fn(f64) -> Vec<Layer>,
    /// Highest real index of a medium that light comes from.
    pub highest: &'a dyn Fn(f64) -> f64,
    /// Index of an opaque substrate; `None`: any of the media.
    pub beyond: &'a dyn Fn(f64) -> Option<Complex64>,
}

/// The matrix of a stack over wavelength and angle.
#[derive(Clone, Debug)]
pub struct Band {
    wavenumber: Axis,
    tangential: Axis,
    /// By wavenumber, then x: what does not vanish without absorption, and the rest where there is any.
    halves: Vec<Vec<Half>>,
    /// Steps of the wavenumber and of x within which the table is good.
    good: [Vec<bool>; 2],
}

/// Even places.
#[derive(Clone, Copy, Debug)]
struct Axis {
    from: f64,
    step: f64,
    count: usize,
}

impl Axis {
    fn new(from: f64, to: f64, count: usize) -> Axis {
        Axis { from, step: (to - from) / (count - 1) as f64, count }
    }

    fn at(&self, place: f64) -> f64 {
        self.from + self.step * place
    }

    /// First of the eight nodes about `x`, which step it is in, and the weights of the nodes; `None` beyond the ends.
    fn weights(&self, x: f64) -> Option<(usize, usize, [f64; NODES])> {
        let place = (x - self.from) / self.step;
        let inside = (0.0..(self.count - 1) as f64).contains(&place);
        let step = place as usize;
        let first = step.saturating_sub(NODES / 2 - 1).min(self.count - NODES);
        inside.then(|| (first, step, lagrange(place - first as f64)))
    }

    /// The steps at which there is light.
    fn steps(&self) -> Range<usize> {
        NODES / 2 - 1..self.count - NODES / 2
    }

    /// Which steps are good, those without light among them.
    fn tried(&self, good: impl Fn(usize) -> bool) -> Vec<bool> {
        let light = self.steps();
        (0..self.count - 1).map(|step| !light.contains(&step) || good(step)).collect()
    }

    /// Some of the nodes about them.
    fn trials(&self) -> impl Iterator<Item = f64> {
        let (axis, steps) = (*self, self.steps());
        (0..TRIALS).map(move |trial| axis.at((steps.start + steps.len() * trial / (TRIALS - 1)) as f64))
    }
}

/// Weights of the values at 0 to 7 for the polynomial through them at `t`.
fn lagrange(t: f64) -> [f64; NODES] {
    // One over the products of i - j over the others.
    const OTHERS: [f64; NODES] =
        [-1.0 / 5040.0, 1.0 / 720.0, -1.0 / 240.0, 1.0 / 144.0, -1.0 / 144.0, 1.0 / 240.0, -1.0 / 720.0, 1.0 / 5040.0];
    let mut weights = [1.0; NODES];
    let (mut below, mut above) = (1.0, 1.0);
    for i in 0..NODES {
        weights[i] *= below * OTHERS[i];
        weights[NODES - 1 - i] *= above;
        below *= t - i as f64;
        above *= t - (NODES - 1 - i) as f64;
    }
    weights
}

impl Band {
    /// The table from the first to the second vacuum wavelength (m). `None` if it would be too large, or good in less than
    /// three quarters of the band.
    pub fn new(stack: &Seen, [from, to]: [f64; 2]) -> Option<Band> {
        if from >= to {
            return None;
        }
        let mut counts = first_counts(stack, [from, to]);
        loop {
            if counts[0] * counts[1] > MOST {
                return None;
            }
            let reach = [from, 0.5 * (from + to), to].map(stack.highest).into_iter().fold(1.0, f64::max).powi(2);
            // At either end of the light the polynomials are in the middle of their nodes, too; the matrix goes on beyond.
            let axis = |from: f64, to: f64, count: usize| {
                let margin = 0.5 * (NODES - 1) as f64 * (to - from) / (count - NODES) as f64;
                Axis::new(from - margin, to + margin, count)
            };
            let mut band = Band {
                wavenumber: axis(1.0 / to, 1.0 / from, counts[0]),
                tangential: axis(0.0, reach, counts[1]),
                halves: Vec::new(),
                good: counts.map(|count| vec![true; count - 1]),
            };
            band.fill(stack)?;
            band.good = [band.wavenumber_steps(stack), band.tangential_steps(stack)];
            let failed = [0, 1].map(|axis| band.good[axis].iter().filter(|good| !**good).count());
            let larger = 3 * counts[0] * counts[1] <= 2 * MOST;
            match [0, 1].into_iter().find(|&axis| larger && 16 * failed[axis] > counts[axis]) {
                Some(axis) => counts[axis] += counts[axis] / 2,
                None => return [0, 1].iter().all(|&axis| 4 * failed[axis] < counts[axis]).then_some(band),
            }
        }
    }

    fn fill(&mut self, stack: &Seen) -> Option<()> {
        let mut nodes: [Vec<Half>; 2] = Default::default();
        for row in 0..self.wavenumber.count {
            let wavelength = 1.0 / self.wavenumber.at(row as f64);
            let layers = (stack.layers)(wavelength);
            for column in 0..self.tangential.count {
                let entries = matrix(&layers, wavelength, self.tangential.at(column as f64))?;
                nodes.iter_mut().zip(parted(&entries)).for_each(|(half, entries)| half.push(entries));
            }
        }
        let largest = |half: &[Half]| half.iter().flatten().fold(0.0, |most: f64, entry| most.max(entry.abs()));
        let absorbs = largest(&nodes[1]) > 1e-13 * largest(&nodes[0]);
        self.halves = nodes.into_iter().take(if absorbs { 2 } else { 1 }).collect();
        Some(())
    }

    /// Which steps of x are short enough, at some wavenumbers of the grid.
    fn tangential_steps(&self, stack: &Seen) -> Vec<bool> {
        let good = |step: usize| {
            let x = self.tangential.at(step as f64 + 0.5);
            self.wavenumber.trials().all(|wavenumber| self.error(stack, 1.0 / wavenumber, x) <= BOUND)
        };
        self.tangential.tried(good)
    }

    /// Which steps of the wavenumber are, at some x of the grid.
    fn wavenumber_steps(&self, stack: &Seen) -> Vec<bool> {
        let within = |step: usize, part: f64, x: f64| {
            self.error(stack, 1.0 / self.wavenumber.at(step as f64 + part), x) <= BOUND
        };
        let good =
            |step: usize| self.tangential.trials().all(|x| [0.25, 0.5, 0.75].iter().all(|part| within(step, *part, x)));
        self.wavenumber.tried(good)
    }

    /// Largest error of R and T of s and p light, and a hundredth of that of r and t, whose phases turn fast in narrow resonances; for
    /// light from the medium of highest index and from vacuum, into either.
    fn error(&self, stack: &Seen, wavelength: f64, x: f64) -> f64 {
        let (layers, highest) = ((stack.layers)(wavelength), (stack.highest)(wavelength));
        let beyond = (stack.beyond)(wavelength);
        let ends = [1.0, highest];
        let mut error = 0.0f64;
        for n1 in ends.into_iter().filter(|n1| n1 * n1 > x && x >= 0.0) {
            for n2 in ends.map(Complex64::from) {
                let around = Around { n1, n2: beyond.unwrap_or(n2), cos1: (1.0 - x / (n1 * n1)).sqrt() };
                let wanted = split(&around, wavelength, layers.iter().copied());
                let Some(found) = self.split(&around, wavelength, End::First) else { continue };
                for (a, b) in [(found.reflected, wanted.reflected), (found.transmitted, wanted.transmitted)] {
                    for (a, b) in [(a.s, b.s), (a.p, b.p)] {
                        error = error.max((a.norm_sqr() - b.norm_sqr()).abs()).max(0.01 * (a - b).norm());
                    }
                }
            }
        }
        error
    }

    /// What the stack does to light of a vacuum wavelength (m) that meets `end` of it; `None` where the table is not made for it.
    pub fn split(&self, around: &Around, wavelength: f64, end: End) -> Option<Split> {
        let (row, step, down) = self.wavenumber.weights(1.0 / wavelength)?;
        let (column, place, across) = self.tangential.weights(around.tangential_squared())?;
        if !(self.good[0][step] && self.good[1][place]) {
            return None;
        }
        let first = |i: usize| (row + i) * self.tangential.count + column;
        let sum = |half: &Vec<Half>| {
            let mut sum = [0.0; 8];
            for (i, down) in down.into_iter().enumerate() {
                let nodes: &[Half; NODES] = half[first(i)..].first_chunk().unwrap_or(&[[0.0; 8]; NODES]);
                let mut along = [0.0; 8];
                for (node, across) in nodes.iter().zip(across) {
                    along.iter_mut().zip(node).for_each(|(along, entry)| *along += across * entry);
                }
                sum.iter_mut().zip(along).for_each(|(sum, along)| *sum += down * along);
            }
            sum
        };
        let main = sum(&self.halves[0]);
        let rest = self.halves.get(1).map_or([0.0; 8], sum);
        // On the diagonal the real part is the main one, beside it the imaginary.
        let entry = |i: usize| match i % 4 {
            0 | 3 => Complex64::new(main[i], rest[i]),
            _ => Complex64::new(rest[i], main[i]),
        };
        let diagonal = if end == End::First { [0, 3] } else { [3, 0] };
        let beyond = around.beyond();
        let top = |i: usize, [e, h]: [Complex64; 2]| {
            [entry(i + diagonal[0]) * e + entry(i + 1) * h, entry(i + 2) * e + entry(i + diagonal[1]) * h]
        };
        Some(around.split(&Fields { s: top(0, beyond.s), p: top(4, beyond.p) }, 1.0))
    }
}

/// Real parts of the diagonal with imaginary ones beside it, and the others.
fn parted(entries: &Matrix) -> [Half; 2] {
    let main = |i: usize| {
        if matches!(i % 4, 0 | 3) { [entries[2 * i], entries[2 * i + 1]] } else { [entries[2 * i + 1], entries[2 * i]] }
    };
    [0, 1].map(|half| std::array::from_fn(|i| main(i)[half]))
}

/// Nodes for the phase that the stack gains along either axis.
fn first_counts(stack: &Seen, [short, long]: [f64; 2]) -> [usize; 2] {
    let gained = |wavelength: f64, x: f64| {
        let (here, there) = ((stack.layers)(short), (stack.layers)(wavelength));
        let phase = |layer: &Layer, wavelength: f64, x: f64| {
            TAU / wavelength * layer.thickness * (layer.index * layer.index - x).sqrt()
        };
        let pairs = here.iter().zip(&there);
        pairs.map(|(a, b)| (phase(a, short, 0.0) - phase(b, wavelength, x)).norm()).sum::<f64>()
    };
    let count = |axis: usize, phase: f64| ((DENSITY[axis] * phase).ceil() as usize).clamp(16, MOST / 16);
    // So many that the nodes beyond the longest wave are less than half of its wavenumber away.
    let least = NODES + ((NODES - 1) as f64 * (long / short - 1.0)).ceil() as usize;
    [count(0, gained(long, 0.0)).max(least), count(1, gained(short, (stack.highest)(short).powi(2)))]
}

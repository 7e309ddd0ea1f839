//! A measured power spectral density.
//!
//!     PSD(f) = P_j (f / f_j)^p_j   between f_j and f_(j+1),      p_j = ln(P_(j+1) / P_j) / ln(f_(j+1) / f_j)
//!
//! a straight line between entries in log-log, two-dimensional, m^4 over 1/m. Below the first frequency it is held, beyond the last it
//! goes on as between the last two. Integral and draws in closed form: with d = p + 2,
//!
//!     integral_(f_j)^f PSD f df = P_j f_j^2 ((f / f_j)^d - 1) / d          (d = 0: the logarithm)
//!
//! Source: how measured bands are joined: Stover, Optical Scattering, 3rd ed. (2012), sec. 2.2.

use crate::bsdf::harvey::{growth, logarithm};
use crate::bsdf::radial::Profile;
use crate::math::Rng;

/// PSD over spatial frequency.
#[derive(Clone, Debug)]
pub struct PsdTable {
    pieces: Vec<Piece>,
}

/// The power law from one entry on.
#[derive(Clone, Copy, Debug)]
struct Piece {
    /// 1/m
    from: f64,
    /// m^4
    density: f64,
    /// p + 2
    d: f64,
    /// Integral of PSD f df up to `from`, m^2.
    below: f64,
}

impl Piece {
    /// Integral of PSD f df up to `f`, m^2.
    fn integral(&self, f: f64) -> f64 {
        self.below + self.density * self.from * self.from * growth(self.d, (f / self.from).ln())
    }
}

impl PsdTable {
    /// `entries` of (frequency 1/m, density m^4), both > 0, by rising frequency, two at least.
    pub fn new(entries: &[(f64, f64)]) -> PsdTable {
        let (first, density) = entries[0];
        let mut below = 0.5 * density * first * first;
        let mut pieces = Vec::new();
        for pair in entries.windows(2) {
            let [(from, density), (to, end)] = [pair[0], pair[1]];
            let piece = Piece { from, density, d: (end / density).ln() / (to / from).ln() + 2.0, below };
            below = piece.integral(to);
            pieces.push(piece);
        }
        PsdTable { pieces }
    }

    /// The power law that holds at `f`; `None` below the first entry.
    fn piece(&self, f: f64) -> Option<&Piece> {
        let count = self.pieces.partition_point(|piece| piece.from <= f);
        count.checked_sub(1).map(|at| &self.pieces[at])
    }
}

impl Profile for PsdTable {
    fn value(&self, f: f64) -> f64 {
        let held = self.pieces[0].density;
        self.piece(f).map_or(held, |p| p.density * ((p.d - 2.0) * (f / p.from).ln()).exp())
    }

    fn integral(&self, f: f64) -> f64 {
        let held = self.pieces[0].density;
        self.piece(f).map_or(0.5 * held * f * f, |p| p.integral(f))
    }

    /// By inversion of the integral: one number.
    fn draw(&self, reach: f64, rng: &mut Rng) -> f64 {
        let wanted = rng.uniform() * self.integral(reach);
        let count = self.pieces.partition_point(|piece| piece.below <= wanted);
        match count.checked_sub(1).map(|at| &self.pieces[at]) {
            None => (2.0 * wanted / self.pieces[0].density).sqrt(),
            Some(p) => p.from * logarithm(p.d, (wanted - p.below) / (p.density * p.from * p.from)).exp(),
        }
    }

    fn width(&self) -> f64 {
        self.pieces[0].from
    }

    /// Kinks at the entries want short panels.
    fn steepness(&self) -> f64 {
        12.0
    }
}

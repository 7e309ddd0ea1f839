//! What an interface does to s and p light: flux-normalised complex amplitudes.
//!
//! The field is written in the frame (s, p = k x s, k) of the ray itself, before and after, time factor exp(-i omega t):
//!
//!     E_s' = a_s E_s,   E_p' = a_p E_p
//!     I' = (R_s + R_p)/2 I + (R_s - R_p)/2 Q        R_s = |a_s|^2, R_p = |a_p|^2   power fractions
//!     Q' = (R_s - R_p)/2 I + (R_s + R_p)/2 Q
//!     U' + i V' = a_s conj(a_p) (U + i V)
//!
//! because U + i V = 2 E_s conj(E_p) ([`Stokes`]). As p turns over with k in a reflection, a mirror at normal incidence
//! has a_p = -a_s: it changes the hand of circular light.
//!
//! Source: Born & Wolf, Principles of Optics, 7th ed., sec. 1.5.2; the Mueller matrix of a diagonal Jones matrix,
//! Bohren & Huffman (1983), sec. 2.11.3.

use super::Stokes;
use num_complex::Complex64;

/// Complex amplitudes for s and p, normalised to flux: |s|^2 is the power fraction R_s or T_s (T includes
/// n2 cos2 / n1 cos1), the argument is the phase. Both zero where nothing goes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Amplitudes {
    pub s: Complex64,
    pub p: Complex64,
}

impl Amplitudes {
    pub const ZERO: Amplitudes = Amplitudes { s: Complex64::ZERO, p: Complex64::ZERO };

    /// Ideal transmission of power fraction `power`, 0..1: the same real amplitude for s and p, polarisation kept.
    pub fn ideal(power: f64) -> Amplitudes {
        let a = Complex64::new(power.sqrt(), 0.0);
        Amplitudes { s: a, p: a }
    }

    /// Ideal reflection of power fraction `power`, 0..1: the perfect conductor's signs, a_s = -a, a_p = +a.
    pub fn mirror(power: f64) -> Amplitudes {
        let a = Complex64::new(power.sqrt(), 0.0);
        Amplitudes { s: -a, p: a }
    }

    /// What does to row vectors from the right what these do to Stokes vectors: a^T M = (M^T a)^T. I and Q mix by a symmetric matrix,
    /// U and V are turned, and turned back by the complex conjugate.
    pub fn transposed(&self) -> Amplitudes {
        Amplitudes { s: self.s.conj(), p: self.p.conj() }
    }

    /// Power fraction of unpolarised light, (|s|^2 + |p|^2) / 2, 0..1.
    pub fn unpolarised(&self) -> f64 {
        0.5 * (self.s.norm_sqr() + self.p.norm_sqr())
    }

    /// The light that leaves, W, for light (W) that arrives; both in their (s, k x s) frames.
    pub fn apply(&self, light: Stokes) -> Stokes {
        let (rs, rp) = (self.s.norm_sqr(), self.p.norm_sqr());
        let (mean, half) = (0.5 * (rs + rp), 0.5 * (rs - rp));
        let cross = self.s * self.p.conj() * Complex64::new(light.u, light.v);
        Stokes { i: mean * light.i + half * light.q, q: half * light.i + mean * light.q, u: cross.re, v: cross.im }
    }
}

/// Both ways on from an interface; what is missing to one is absorbed there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Split {
    pub reflected: Amplitudes,
    pub transmitted: Amplitudes,
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::optics::stokes::Hand;

    #[test]
    fn a_mirror_changes_the_hand_of_circular_light() {
        let light = Stokes::circular(2.0, Hand::Right);
        assert_eq!(Amplitudes::mirror(1.0).apply(light), Stokes::circular(2.0, Hand::Left));
        assert_eq!(Amplitudes::ideal(1.0).apply(light), light);
    }

    #[test]
    fn a_transposed_matrix_gives_the_same_product() {
        let a = Amplitudes { s: Complex64::new(0.3, 0.6), p: Complex64::new(-0.2, 0.5) };
        let (light, row) = (Stokes { i: 1.0, q: 0.2, u: -0.5, v: 0.6 }, Stokes { i: 0.4, q: -0.1, u: 0.2, v: 0.3 });
        let (one, other) = (row.dot(a.apply(light)), a.transposed().apply(row).dot(light));
        assert!((one - other).abs() < 1e-15 && (one - row.dot(a.transposed().apply(light))).abs() > 1e-3);
    }

    #[test]
    fn s_light_keeps_only_the_s_fraction() {
        let a = Amplitudes { s: Complex64::new(0.0, 0.6), p: Complex64::new(0.2, 0.0) };
        let s = a.apply(Stokes::linear(1.0, 0.0));
        assert!((s.i - 0.36).abs() < 1e-15 && (s.q - 0.36).abs() < 1e-15);
        let p = a.apply(Stokes::linear(1.0, std::f64::consts::FRAC_PI_2));
        assert!((p.i - 0.04).abs() < 1e-15 && (p.q + 0.04).abs() < 1e-15);
    }
}

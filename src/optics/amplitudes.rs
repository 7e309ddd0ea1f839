//! What an interface does to s and p light: flux-normalised complex amplitudes.

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

    /// The same real amplitude for both: power fraction `power`, 0..1, no phase between s and p
    /// other than that of the sign convention (`mirror` flips p, as an ideal mirror does).
    pub fn ideal(power: f64) -> Amplitudes {
        let a = Complex64::new(power.sqrt(), 0.0);
        Amplitudes { s: a, p: a }
    }

    /// Power fraction of unpolarised light, (|s|^2 + |p|^2) / 2, 0..1.
    pub fn unpolarised(&self) -> f64 {
        0.5 * (self.s.norm_sqr() + self.p.norm_sqr())
    }
}

/// Both ways on from an interface; what is missing to one is absorbed there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Split {
    pub reflected: Amplitudes,
    pub transmitted: Amplitudes,
}

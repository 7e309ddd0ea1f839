//! Fresnel's amplitudes of a bare interface.
//!
//!     m1 = n1 cos1,   m2 = n2 cos2 = sqrt(n2^2 - n1^2 + m1^2)   (Im m2 >= 0: the wave decays beyond)
//!     r_s = (m1 - m2) / (m1 + m2)              T_s = 4 m1 Re(m2) / |m1 + m2|^2
//!     r_p = (n2 cos1 - n1 cos2) / (n2 cos1 + n1 cos2)
//!     T_p = 4 m1 Re(n2 conj(cos2)) / |n2 cos1 + n1 cos2|^2
//!
//! n = n + ik, time factor exp(-i omega t), amplitudes in the frames of [`Amplitudes`]. T is the *power* that enters
//! the second medium, (n2 cos2 / n1 cos1)|t|^2, never |t|^2, so R + T = 1 even where medium 2 absorbs; both are
//! computed directly, so 1 - R is exact to the last digits at grazing incidence, where it is T.
//!
//! The index of the first medium counts with its real part: with k1 > 0 incident and reflected fluxes are not
//! additive (their interference carries power), by O(k1), and bulk absorption is booked along the path instead.
//! Where the real parts have no refracted ray, what enters an absorbing second medium is absorbed at the interface
//! (attenuated total reflection): nothing is transmitted.
//!
//! Source: Born & Wolf, Principles of Optics, 7th ed., sec. 1.5.2 and 14.2; T_p of absorbing media: Byrnes,
//! "Multilayer optical calculations", arXiv:1603.02720, eq. 21-22.

use super::refraction::{normal_component_squared, root};
use super::{Amplitudes, Split};
use num_complex::Complex64;

/// What an uncoated interface does to light arriving at `cos1` (> 0) from index `n1` (k1 left out, see above) on `n2`.
pub fn interface(n1: Complex64, n2: Complex64, cos1: f64) -> Split {
    if n2.im == 0.0 { dielectric(n1.re, n2.re, cos1) } else { absorbing(n1.re, n2, cos1) }
}

/// Both media transparent: real arithmetic.
fn dielectric(n1: f64, n2: f64, cos1: f64) -> Split {
    let square = normal_component_squared(cos1, n1, n2);
    let m1 = n1 * cos1;
    if square <= 0.0 {
        return total(m1, (-square).sqrt(), n1, n2);
    }
    let m2 = square.sqrt();
    // p, with both terms multiplied by n1 n2: n2^2 m1 and n1^2 m2.
    let (e1, e2) = (n2 * n2 * m1, n1 * n1 * m2);
    let root = 2.0 * (m1 * m2).sqrt();
    Split {
        reflected: Amplitudes { s: real((m1 - m2) / (m1 + m2)), p: real((e1 - e2) / (e1 + e2)) },
        transmitted: Amplitudes { s: real(root / (m1 + m2)), p: real(root * n1 * n2 / (e1 + e2)) },
    }
}

/// Total internal reflection: m2 = i `decay`; r = (a - ib)/(a + ib) has modulus 1.
fn total(m1: f64, decay: f64, n1: f64, n2: f64) -> Split {
    let reflected = Amplitudes { s: phase(m1, decay), p: phase(n2 * n2 * m1, n1 * n1 * decay) };
    Split { reflected, transmitted: Amplitudes::ZERO }
}

/// (a - ib) / (a + ib), its squared modulus never above 1 by rounding.
fn phase(a: f64, b: f64) -> Complex64 {
    let norm = a * a + b * b;
    if norm == 0.0 {
        return Complex64::new(-1.0, 0.0); // the limit a -> 0 at any b: grazing
    }
    let r = Complex64::new((a - b) * (a + b) / norm, -2.0 * a * b / norm);
    // Two roundings of 1.1e-16 each, twice: 1 - 5e-16 brings any excess back to at most 1.
    if r.norm_sqr() > 1.0 { r * (1.0 - 5e-16) } else { r }
}

/// An absorbing second medium.
fn absorbing(n1: f64, n2: Complex64, cos1: f64) -> Split {
    let m1 = n1 * cos1;
    let m2 = root((n2 - n1) * (n2 + n1) + m1 * m1);
    let cos2 = m2 / n2;
    let (s, p) = (m1 + m2, n2 * cos1 + cos2 * n1);
    let reflected = Amplitudes { s: (m1 - m2) / s, p: (n2 * cos1 - cos2 * n1) / p };
    if normal_component_squared(cos1, n1, n2.re) <= 0.0 {
        return Split { reflected, transmitted: Amplitudes::ZERO };
    }
    // Both fluxes are >= 0 where Im n2 >= 0; the rounding of a grazing difference could give -0.
    let flux_s = (m1 * m2.re).max(0.0).sqrt();
    let flux_p = (m1 * (n2 * cos2.conj()).re).max(0.0).sqrt();
    Split { reflected, transmitted: Amplitudes { s: 2.0 * flux_s / s, p: 2.0 * flux_p / p } }
}

fn real(x: f64) -> Complex64 {
    Complex64::new(x, 0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_absorbing_formula_goes_over_into_the_transparent_one() {
        for cos1 in [1.0, 0.7, 0.2, 1e-6] {
            let a = dielectric(1.0, 1.5, cos1);
            let b = absorbing(1.0, Complex64::new(1.5, 1e-14), cos1);
            for (x, y) in [(a.reflected, b.reflected), (a.transmitted, b.transmitted)] {
                assert!((x.s - y.s).norm() < 1e-13 && (x.p - y.p).norm() < 1e-13);
            }
        }
    }

    #[test]
    fn s_and_p_have_opposite_signs_at_normal_incidence() {
        let split = dielectric(1.0, 1.5, 1.0);
        assert!((split.reflected.s.re + 0.2).abs() < 1e-16 && (split.reflected.p.re - 0.2).abs() < 1e-16);
    }
}

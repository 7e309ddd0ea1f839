//! Dispersion formulas of transparent media: the refractive index against the wavelength. One formula, one file.
//!
//! Coefficients are kept as they are published, for wavelengths in um (only [`Sellmeier`] holds SI); each formula turns
//! metres into micrometres itself. A formula knows nothing of the range of its fit nor of the air that its index may be
//! relative to: that is [`Catalogued`](super::Catalogued)'s part.
//!
//! Sources: M. Polyanskiy, "Dispersion formulas", refractiveindex.info (formulas 1 to 9); Ansys Zemax OpticStudio Help,
//! "Glass catalog formulas" (AGF formulas 1 to 13). Which formula of theirs is which file stands in
//! [`page`](super::page) and [`agf`](super::agf).

pub mod cauchy;
pub mod exotic;
pub mod fraction;
pub mod gas;
pub mod herzberger;
pub mod polynomial;
pub mod retro;
pub mod sellmeier;

pub use cauchy::Cauchy;
pub use exotic::Exotic;
pub use fraction::{Fraction, Fractions};
pub use gas::Gas;
pub use herzberger::Herzberger;
pub use polynomial::Polynomial;
pub use retro::Retro;
pub use sellmeier::Sellmeier;

use super::MICROMETRES;
use num_complex::Complex64;

/// The index whose square is `square`: imaginary below 0, which is total reflection, as in a reststrahlen band.
fn root(square: f64) -> Complex64 {
    if square < 0.0 { Complex64::new(0.0, (-square).sqrt()) } else { Complex64::new(square.sqrt(), 0.0) }
}

/// Sum of a_j x^e_j over pairs (a, e): catalogues have whole exponents, for which no logarithm is needed.
fn powers(terms: &[(f64, f64)], x: f64) -> f64 {
    let power = |e: f64| if e.fract() == 0.0 && e.abs() < 64.0 { x.powi(e as i32) } else { x.powf(e) };
    terms.iter().map(|&(a, e)| a * power(e)).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::medium::Medium;

    /// n at 0.5 um with round coefficients, by hand: lambda^2 = 0.25, lambda^-2 = 4.
    #[test]
    fn each_formula_gives_its_value_by_hand() {
        let n = |medium: &dyn Medium| medium.index(0.5e-6).re;
        let close = |got: f64, wanted: f64| assert!((got - wanted).abs() < 1e-14, "{got} for {wanted}");
        // 1 + 1.2 * 0.25 / (0.25 - 0.01)
        close(n(&Sellmeier { terms: vec![(1.2, 0.01e-12)], range: None }).powi(2), 2.25);
        // 2 + 0.8 * 0.25 + 0.01 * 4
        close(n(&Polynomial { terms: vec![(2.0, 0.0), (0.8, 2.0), (0.01, -2.0)] }).powi(2), 2.24);
        // 1.5 + 0.01 * 4 + 0.001 * 0.5^-3.5
        let cauchy = Cauchy { terms: vec![(1.5, 0.0), (0.01, -2.0), (0.001, -3.5)] };
        close(n(&cauchy), 1.54 + 0.001 * 2f64.powf(3.5));
        // 2 + 0.3 * 0.25 / (0.25 - 0.1^2) + 0.4 * 0.25
        let fraction = Fraction { strength: 0.3, power: 2.0, pole: 0.01 };
        close(n(&Fractions { fractions: vec![fraction], terms: vec![(2.0, 0.0), (0.4, 2.0)] }).powi(2), 2.4125);
        // 1 + 1e-4 + 0.05 / (204 - 4)
        close(n(&Gas { constant: 1e-4, terms: vec![(0.05, 204.0)] }), 1.00035);
        // L = 1 / (0.25 - 0.028): 1.5 + 0.01 L + 0.001 L^2 + 0.04 * 0.25 + 0.16 / 16 + 0.64 / 64
        let l = 1.0 / 0.222;
        close(n(&Herzberger { coefficients: [1.5, 0.01, 0.001, 0.04, 0.16, 0.64] }), 1.53 + 0.01 * l + 0.001 * l * l);
        // q = 0.2 + 0.1 * 0.25 / (0.25 - 0.05) + 0.1 * 0.25 = 0.35: n^2 = 1.7 / 0.65
        close(n(&Retro { coefficients: [0.2, 0.1, 0.05, 0.1] }).powi(2), 1.7 / 0.65);
        // 2 + 0.12 / (0.25 - 0.01) + 0.5 * (0.5 - 0.1) / (0.16 + 0.04)
        close(n(&Exotic { coefficients: [2.0, 0.12, 0.01, 0.5, 0.1, 0.04] }).powi(2), 3.5);
    }

    #[test]
    fn below_zero_the_index_is_imaginary() {
        assert_eq!(root(-4.0), Complex64::new(0.0, 2.0));
        assert_eq!(root(4.0), Complex64::new(2.0, 0.0));
    }
}

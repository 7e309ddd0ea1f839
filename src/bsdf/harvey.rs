//! The Harvey-Shack model, shift-invariant with three parameters: scatter of polished surfaces.
//!
//!     f = n_s^2 b0 (1 + (x / l)^2)^(s/2)   [1/sr]        x = |beta - beta_0| in air
//!
//! b0 BSDF at the specular ray, 1/sr; l the shoulder, s <= 0 the slope, both dimensionless; x, n_s, the horizon and the TIS as of
//! every radial lobe ([`super::radial`]). It equals an ABg only at s = -2: A = b0 l^2, B = l^2, g = 2.
//!
//!     I(x) = integral_0^x S x dx = l^2/2 ((1 + x^2/l^2)^d - 1) / d,   d = 1 + s/2     (d = 0: l^2/2 ln(1 + x^2/l^2))
//!
//! Check, air, normal incidence: TIS = 2 pi b0 I(1).
//!
//! Left out: scaling with wavelength (l as lambda, b0 as lambda^-4: of polish only); the measured range; polarisation.
//! Source: Harvey, Light-Scattering Characteristics of Optical Surfaces, thesis, Univ. of Arizona (1976); Fest, Stray Light
//! Analysis and Control (2013), sec. 4.1.3.

use super::radial::{Lobe, Profile, Side};
use crate::math::Rng;

/// A Harvey-Shack lobe.
pub type Harvey = Lobe<Law>;

impl Harvey {
    /// A lobe of `b0` (1/sr, >= 0), `l` (> 0) and `s` (<= 0) on one side. Cost: up to 0.1 s for its table of TIS.
    pub fn new(b0: f64, l: f64, s: f64, side: Side) -> Harvey {
        Lobe::of(b0, Law { l, s }, side)
    }
}

/// S(x) = (1 + (x/l)^2)^(s/2).
#[derive(Clone, Copy, Debug)]
pub struct Law {
    /// Shoulder, dimensionless, > 0.
    pub l: f64,
    /// Slope, dimensionless, <= 0.
    pub s: f64,
}

impl Law {
    /// 1 + s/2, the power of the integral.
    fn d(&self) -> f64 {
        1.0 + 0.5 * self.s
    }

    /// ln(1 + (x/l)^2).
    fn logarithm(&self, x: f64) -> f64 {
        (x / self.l).powi(2).ln_1p()
    }
}

impl Profile for Law {
    fn value(&self, x: f64) -> f64 {
        (0.5 * self.s * self.logarithm(x)).exp()
    }

    fn integral(&self, x: f64) -> f64 {
        0.5 * self.l * self.l * growth(self.d(), self.logarithm(x))
    }

    /// By inversion of the integral: one number.
    fn draw(&self, reach: f64, rng: &mut Rng) -> f64 {
        let part = rng.uniform() * growth(self.d(), self.logarithm(reach));
        self.l * logarithm(self.d(), part).exp_m1().sqrt()
    }

    fn width(&self) -> f64 {
        self.l
    }

    /// S has branch points pi/2 from the real axis of ln x; a large power narrows what lies between.
    fn steepness(&self) -> f64 {
        (-2.0 * self.s).sqrt().max(2.0)
    }
}

/// (e^(d y) - 1) / d, y for d = 0.
pub(super) fn growth(d: f64, y: f64) -> f64 {
    if d == 0.0 { y } else { (d * y).exp_m1() / d }
}

/// Inverse of [`growth`] in y.
pub(super) fn logarithm(d: f64, growth: f64) -> f64 {
    if d == 0.0 { growth } else { (d * growth).ln_1p() / d }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bsdf::{Abg, Bsdf};
    use crate::math::quadrature::GaussLegendre;
    use crate::optics::Incidence;

    #[test]
    fn the_integral_is_that_of_the_shape() {
        let rule = GaussLegendre::new(40);
        for (l, s) in [(0.01, -1.5), (1e-6, -2.0), (0.3, -3.7), (2.0, -0.4), (0.1, 0.0)] {
            let law = Law { l, s };
            for x in [1e-3 * l, l, 20.0 * l] {
                let direct = rule.integrate(0.0, x.sqrt(), |r| 2.0 * r.powi(3) * law.value(r * r));
                assert!((law.integral(x) / direct - 1.0).abs() < 1e-9, "l {l} s {s} x {x}");
            }
        }
    }

    #[test]
    fn a_slope_of_minus_two_is_abg() {
        let (b0, l) = (2.0, 1e-4f64);
        let (harvey, abg) = (Harvey::new(b0, l, -2.0, Side::Reflect), Abg::new(b0 * l * l, l * l, 2.0, Side::Reflect));
        for theta in [0.0, 0.4, 1.5] {
            let at = Incidence::in_air(theta, 550e-9);
            assert!((harvey.albedo(&at) / abg.albedo(&at) - 1.0).abs() < 1e-7, "{theta}");
        }
    }

    #[test]
    fn a_lobe_a_microradian_wide_has_its_closed_form() {
        for s in [-1.5, -2.0, -2.6] {
            let lobe = Harvey::new(1e3, 1e-6, s, Side::Reflect);
            let wanted = std::f64::consts::TAU * 1e3 * Law { l: 1e-6, s }.integral(1.0);
            assert!((lobe.albedo(&Incidence::in_air(0.0, 550e-9)) / wanted - 1.0).abs() < 1e-8, "{s}");
        }
    }

    #[test]
    fn draws_follow_the_integral() {
        for (l, s) in [(1e-6, -2.0), (0.01, -1.5), (0.3, -4.0), (5.0, -1.0), (0.1, 0.0)] {
            let law = Law { l, s };
            let mut rng = Rng::new(13, 0, 0);
            let mut cell = [0u32; 10];
            for _ in 0..100_000 {
                let u = law.integral(law.draw(1.7, &mut rng)) / law.integral(1.7);
                cell[((u * 10.0) as usize).min(9)] += 1;
            }
            // Ten cells of 1e4; chi-squared of 9 degrees exceeds 33.7 once in 1e4.
            let chi: f64 = cell.iter().map(|&c| (c as f64 - 1e4).powi(2) / 1e4).sum();
            assert!(chi < 33.7, "l {l} s {s}: {chi} {cell:?}");
        }
    }
}

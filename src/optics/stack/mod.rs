//! Thin films: amplitudes of a stack of homogeneous layers between two media, coherent throughout.
//!
//! Tangential fields E and H at the top of a layer follow from those at its foot by its characteristic matrix:
//!
//!     [E]   [   cos delta          -i sin delta / eta ] [E]        m   = sqrt(n^2 - n1^2 sin^2 theta1)
//!     [H] = [ -i eta sin delta          cos delta     ] [H]foot    delta = 2 pi m d / lambda
//!
//!     eta = m for s,  n^2 / m for p;  n = n + ik of the layer, d its thickness (m), lambda the vacuum wavelength (m)
//!
//! from the wave that goes on beyond the stack up to its top. With m1 = n1 cos1, m2 = n2 cos2 there:
//!
//!     r_s = (m1 E - H) / (m1 E + H)                T_s = 4 m1 Re(m2) |E_beyond / (m1 E + H)|^2
//!     r_p = (m1 H - n1^2 E) / (m1 H + n1^2 E)      T_p likewise with eta_p, in the signs of [`fresnel`](super::fresnel)
//!
//! The matrix is even in m, so the sign of the root is free and there is no singularity at any critical angle: sin delta / m
//! is what is computed. It is scaled by exp(-Im delta), so that neither evanescent waves nor thick metals overflow.
//!
//! The conventions of [`fresnel`](super::fresnel) hold: amplitudes normalised to flux, exp(-i omega t), the first medium
//! with its real index; where the real indices around the stack have no refracted ray nothing is transmitted.
//! Left out: inhomogeneous and anisotropic layers, roughness, partial coherence (a layer much thicker than the coherence
//! length is a solid of the scene, not a layer).
//!
//! Source: Macleod, Thin-Film Optical Filters, 4th ed. (2010), sec. 2.7; Born & Wolf, Principles of Optics, 7th ed., sec. 1.6.

mod band;
mod patch;
mod table;
mod zone;

use super::refraction::{normal_component_squared, root};
use super::{Amplitudes, Split};
use num_complex::Complex64;
use std::f64::consts::TAU;

pub use band::Band;
pub use table::Table;
pub use zone::{End, Seen};

/// Fields beyond this size are scaled down; 1e300 is the largest double.
const LARGE: f64 = 1e100;

/// A homogeneous film.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Layer {
    /// Complex index n + ik, dimensionless, not 0; k >= 0.
    pub index: Complex64,
    /// m, >= 0.
    pub thickness: f64,
}

/// The media around a stack and how light arrives.
#[derive(Clone, Copy, Debug)]
pub struct Around {
    /// Real index on the side of the light.
    pub n1: f64,
    /// Complex index beyond.
    pub n2: Complex64,
    /// Cosine of the angle of incidence in the first medium, (0, 1].
    pub cos1: f64,
}

/// Tangential fields [E, H] of s and p light, any scale.
#[derive(Clone, Copy, Debug)]
struct Fields {
    s: [Complex64; 2],
    p: [Complex64; 2],
}

/// What a stack does to light of vacuum wavelength `wavelength` (m). Layers in the order the light meets them.
/// Costs some 30 ns per layer.
pub fn split(around: &Around, wavelength: f64, layers: impl DoubleEndedIterator<Item = Layer>) -> Split {
    let wavenumber = TAU / wavelength;
    let mut fields = around.beyond();
    let mut scale = 1.0;
    for layer in layers.rev() {
        let passage = Passage::new(&layer, around.square(layer.index), wavenumber);
        fields = passage.cross(&fields);
        scale *= passage.scale * fields.shrink();
    }
    around.split(&fields, scale)
}

impl Around {
    /// m^2 in a medium of index `n`: without a difference of near-equal numbers at grazing incidence.
    fn square(&self, n: Complex64) -> Complex64 {
        let m1 = self.n1 * self.cos1;
        (n - self.n1) * (n + self.n1) + m1 * m1
    }

    /// (n1 sin1)^2, the same in all layers.
    fn tangential_squared(&self) -> f64 {
        self.n1 * self.n1 * (1.0 - self.cos1) * (1.0 + self.cos1)
    }

    /// The wave that goes on beyond the stack.
    fn beyond(&self) -> Fields {
        let m2 = root(self.square(self.n2));
        Fields { s: [Complex64::ONE, m2], p: [m2, self.n2 * self.n2] }
    }

    /// Amplitudes from the fields at the top of the stack, which came out `scale` times too small beyond it.
    fn split(&self, top: &Fields, scale: f64) -> Split {
        let (m1, m2, n1_squared) = (self.n1 * self.cos1, root(self.square(self.n2)), self.n1 * self.n1);
        let ([es, hs], [ep, hp]) = (top.s, top.p);
        let (s, p) = (es * m1 + hs, hp * m1 + ep * n1_squared);
        let reflected = Amplitudes { s: ratio(es * m1 - hs, s), p: ratio(hp * m1 - ep * n1_squared, p) };
        if normal_component_squared(self.cos1, self.n1, self.n2.re) <= 0.0 {
            return Split { reflected, transmitted: Amplitudes::ZERO };
        }
        // Both fluxes are >= 0 where Im n2 >= 0; the rounding of a grazing difference could give -0. Roots apart: no underflow.
        let n2 = self.n2;
        let enters = 2.0 * scale * m1.sqrt();
        let flux_s = enters * m2.re.max(0.0).sqrt();
        let flux_p = enters * self.n1 * (n2 * n2 * m2.conj()).re.max(0.0).sqrt();
        let phase = n2 / n2.norm();
        Split { reflected, transmitted: Amplitudes { s: ratio(flux_s.into(), s), p: ratio(phase * flux_p, p) } }
    }
}

impl Fields {
    /// Brings large fields back to the order of 1; the factor.
    fn shrink(&mut self) -> f64 {
        let size = self.s.iter().chain(&self.p).fold(0.0, |size: f64, field| size.max(field.l1_norm()));
        if size < LARGE {
            return 1.0;
        }
        let factor = 1.0 / size;
        self.s.iter_mut().chain(&mut self.p).for_each(|field| *field *= factor);
        factor
    }
}

/// The characteristic matrix of one layer, times `scale`.
struct Passage {
    /// scale * cos delta
    cos: Complex64,
    /// scale * sin delta / m
    sin: Complex64,
    /// m^2 and n^2.
    square: Complex64,
    permittivity: Complex64,
    /// exp(-Im delta), 0..1.
    scale: f64,
}

impl Passage {
    fn new(layer: &Layer, square: Complex64, wavenumber: f64) -> Passage {
        let depth = wavenumber * layer.thickness;
        let delta = root(square) * depth;
        let (a, b) = (delta.re, delta.im);
        let (sin, cos) = a.sin_cos();
        let permittivity = layer.index * layer.index;
        if b == 0.0 {
            let sinc = if a == 0.0 { 1.0 } else { sin / a };
            return Passage { cos: cos.into(), sin: (depth * sinc).into(), square, permittivity, scale: 1.0 };
        }
        // exp(-b) cosh b and exp(-b) sinh b.
        let half = -0.5 * (-2.0 * b).exp_m1();
        let (even, odd) = (1.0 - half, half);
        Passage {
            cos: Complex64::new(cos * even, -sin * odd),
            sin: Complex64::new(sin * even, cos * odd) / delta * depth,
            square,
            permittivity,
            scale: (-b).exp(),
        }
    }

    /// Fields at the top of the layer from those at its foot.
    fn cross(&self, foot: &Fields) -> Fields {
        // -i sin delta / m
        let sin = Complex64::new(self.sin.im, -self.sin.re);
        let turned =
            |[e, h]: [Complex64; 2], up: Complex64, down: Complex64| [self.cos * e + up * h, down * e + self.cos * h];
        Fields {
            s: turned(foot.s, sin, sin * self.square),
            p: turned(foot.p, sin * self.square / self.permittivity, sin * self.permittivity),
        }
    }
}

/// a / b, also where |b|^2 would underflow.
fn ratio(a: Complex64, b: Complex64) -> Complex64 {
    let size = 1.0 / b.l1_norm();
    (a * size) / (b * size)
}

#[cfg(test)]
mod tests;

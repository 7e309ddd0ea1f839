//! Surfaces given as a height over the xy plane, z = s(x, y), m.
//!
//! | form       | s                                                                                     |
//! |------------|---------------------------------------------------------------------------------------|
//! | asphere    | conic(r) + sum a_p r^p, any powers p >= 1, even or odd                                   |
//! | polynomial | conic(r) + sum a_ij x^i y^j (extended polynomial)                                        |
//! | toroid     | g(x) turned about an axis along x at height R: s = g + T - sign(T) sqrt(T^2 - y^2), T = R - g |
//!
//! A toroid with R infinite is a cylinder lens with its power in x. Coefficients in m^(1 - p).
//! Left out: terms of Zernike or Forbes form; they can be written as polynomials.
//! Source: ISO 10110-12:2019.

use super::conic::Conic;

/// A height over the plane.
#[derive(Clone, Debug, PartialEq)]
pub enum Sag {
    Asphere {
        base: Conic,
        /// (power of r, coefficient in m^(1 - power)).
        terms: Vec<(u32, f64)>,
    },
    Polynomial {
        base: Conic,
        /// (powers of x and y, coefficient in m^(1 - their sum)).
        terms: Vec<([u32; 2], f64)>,
    },
    Toroid {
        /// The curve in the xz plane, with even terms.
        base: Conic,
        terms: Vec<(u32, f64)>,
        /// Radius of rotation R, m; > 0: centre towards +z; infinite: a cylinder lens.
        radius: f64,
    },
}

impl Sag {
    /// The conic that the terms are added to.
    pub fn base(&self) -> &Conic {
        match self {
            Sag::Asphere { base, .. } | Sag::Polynomial { base, .. } | Sag::Toroid { base, .. } => base,
        }
    }

    /// s, ds/dx, ds/dy at (x, y) m; NaN where there is no surface.
    pub fn at(&self, x: f64, y: f64) -> [f64; 3] {
        match self {
            Sag::Asphere { base, terms } => {
                let r = x.hypot(y);
                let [s, slope] = meridian(base, terms, r);
                let over = if r > 0.0 { slope / r } else { 0.0 };
                [s, over * x, over * y]
            }
            Sag::Polynomial { base, terms } => {
                let r = x.hypot(y);
                let over = if r > 0.0 { base.slope(r) / r } else { 0.0 };
                let start = [base.sag(r), over * x, over * y];
                terms.iter().fold(start, |[s, sx, sy], &([i, j], a)| {
                    let (xi, yj) = (x.powi(i as i32), y.powi(j as i32));
                    let dx = if i > 0 { i as f64 * x.powi(i as i32 - 1) } else { 0.0 };
                    let dy = if j > 0 { j as f64 * y.powi(j as i32 - 1) } else { 0.0 };
                    [s + a * xi * yj, sx + a * dx * yj, sy + a * xi * dy]
                })
            }
            Sag::Toroid { base, terms, radius } => {
                let [g, size] = meridian(base, terms, x.abs());
                let slope = size * 1f64.copysign(x);
                if radius.is_infinite() {
                    return [g, slope, 0.0];
                }
                // T - sign(T) sqrt(T^2 - y^2), without cancellation.
                let t = radius - g;
                let root = (t * t - y * y).sqrt().copysign(t);
                let rise = y * y / (t + root);
                [g + rise, slope * t / root, y / root]
            }
        }
    }
}

/// Height and slope of a conic with terms at distance r.
fn meridian(base: &Conic, terms: &[(u32, f64)], r: f64) -> [f64; 2] {
    terms.iter().fold([base.sag(r), base.slope(r)], |[s, slope], &(p, a)| {
        [s + a * r.powi(p as i32), slope + a * p as f64 * r.powi(p as i32 - 1)]
    })
}

//! The form of one surface about its vertex.
//!
//!     z = c r^2 / (1 + sqrt(1 - (1 + k) c^2 r^2)) + sum_p a_p r^p        r^2 = x^2 + y^2
//!
//! c curvature, 1/m (positive: the centre lies at positive z); k conic constant, dimensionless (-1 parabola); a_p in m^(1-p).
//! A toroid turns that curve, drawn in the y-z plane (r = y), about the line parallel to y through z = R:
//!
//!     z = R - (R - g) sqrt(1 - x^2 / (R - g)^2)        g(y) the curve, R infinite: a cylinder
//!
//! Source: ISO 10110-12:2019, 4.2.

use glam::{DVec2, DVec3};

/// One polynomial term a r^p.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Term {
    /// p, 1 or more.
    pub power: u32,
    /// a, m^(1-p).
    pub coefficient: f64,
}

/// A conic with polynomial terms: z against the distance from the axis.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Curve {
    /// c, 1/m; 0 is a plane.
    pub curvature: f64,
    /// k, dimensionless.
    pub conic: f64,
    /// The terms, any power once.
    pub terms: Vec<Term>,
}

/// What a surface is.
#[derive(Clone, Debug, PartialEq)]
pub enum Profile {
    /// The curve turned about z.
    Revolved(Curve),
    /// The curve of the y-z plane turned about a line parallel to y at z = `radius` (m; infinite: a cylinder).
    Toroid {
        /// The curve in the y-z plane.
        curve: Curve,
        /// R, m, signed.
        radius: f64,
    },
    /// An ideal thin lens in the plane z = 0: every bundle keeps its focus.
    Thin {
        /// 1/f in air, 1/m.
        power: f64,
    },
}

impl Curve {
    /// A sphere of curvature `curvature`, 1/m.
    pub fn sphere(curvature: f64) -> Curve {
        Curve { curvature, ..Curve::default() }
    }

    /// Height z (m) and slope dz/dr at distance `r` (m) from the axis; `None` beyond the rim of the conic.
    pub fn at(&self, r: f64) -> Option<(f64, f64)> {
        let c = self.curvature;
        let square = 1.0 - (1.0 + self.conic) * c * c * r * r;
        let root = (square > 0.0).then(|| square.sqrt())?;
        let mut z = c * r * r / (1.0 + root);
        let mut slope = c * r / root;
        for term in &self.terms {
            let below = term.coefficient * r.powi(term.power as i32 - 1);
            z += below * r;
            slope += f64::from(term.power) * below;
        }
        (z.is_finite() && slope.is_finite()).then_some((z, slope))
    }

    /// Curvature at the vertex, 1/m, the term in r^2 included; a term in r has none and is left out.
    pub fn vertex_curvature(&self) -> f64 {
        let square: f64 = self.terms.iter().filter(|t| t.power == 2).map(|t| t.coefficient).sum();
        self.curvature + 2.0 * square
    }
}

impl Profile {
    /// A sphere of curvature `curvature`, 1/m.
    pub fn sphere(curvature: f64) -> Profile {
        Profile::Revolved(Curve::sphere(curvature))
    }

    /// Height z (m) and slopes (dz/dx, dz/dy) above the point (x, y) of the vertex plane, m; `None` where there is no surface.
    pub fn at(&self, point: DVec2) -> Option<(f64, DVec2)> {
        match self {
            Profile::Thin { .. } => Some((0.0, DVec2::ZERO)),
            Profile::Revolved(curve) => {
                let r = point.length();
                let (z, slope) = curve.at(r)?;
                Some((z, if r > 0.0 { point * (slope / r) } else { DVec2::ZERO }))
            }
            Profile::Toroid { curve, radius } => {
                let (g, slope) = curve.at(point.y.abs())?;
                let slope = slope * point.y.signum();
                if radius.is_infinite() {
                    return Some((g, DVec2::new(0.0, slope)));
                }
                let arm = radius - g;
                let square = 1.0 - (point.x / arm).powi(2);
                let root = (square > 0.0).then(|| square.sqrt())?;
                Some((radius - arm * root, DVec2::new(point.x / (arm * root), slope / root)))
            }
        }
    }

    /// Path (m, signed) from `origin` along the unit vector `direction` to the surface; `None` if they do not meet.
    pub fn meet(&self, origin: DVec3, direction: DVec3) -> Option<f64> {
        let plane = -origin.z / direction.z;
        let mut path = plane + self.conic_path(origin + direction * plane, direction).unwrap_or(0.0);
        // Newton's steps on z - sag; each squares the error, so one that is lost in rounding is the last.
        for _ in 0..50 {
            let point = origin + direction * path;
            let (z, slopes) = self.at(point.truncate())?;
            let step = (point.z - z) / (direction.z - slopes.dot(direction.truncate()));
            path -= step;
            if step.abs() <= 1e-15 * (origin.length() + path.abs()) {
                return Some(path);
            }
        }
        None
    }

    /// Path from a point of the vertex plane to the conic beneath a surface of revolution.
    fn conic_path(&self, point: DVec3, direction: DVec3) -> Option<f64> {
        let Profile::Revolved(curve) = self else { return None };
        let c = curve.curvature;
        let a = c * (1.0 + curve.conic * direction.z * direction.z);
        let b = direction.z - c * point.truncate().dot(direction.truncate());
        let square = b * b - a * c * point.truncate().length_squared();
        let path = c * point.truncate().length_squared() / (b + direction.z.signum() * square.sqrt());
        path.is_finite().then_some(path)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slopes_are_the_derivatives_of_the_height() {
        let curve = Curve {
            curvature: 20.0,
            conic: -1.3,
            terms: vec![Term { power: 4, coefficient: 3e3 }, Term { power: 3, coefficient: 40.0 }],
        };
        let toroid = Profile::Toroid { curve: curve.clone(), radius: -0.07 };
        for profile in [Profile::Revolved(curve), toroid] {
            let (at, h) = (DVec2::new(0.006, -0.009), 1e-6);
            let z = |dx: f64, dy: f64| profile.at(at + DVec2::new(dx, dy)).expect("on the surface").0;
            let slopes = profile.at(at).expect("on the surface").1;
            let differences = DVec2::new(z(h, 0.0) - z(-h, 0.0), z(0.0, h) - z(0.0, -h)) / (2.0 * h);
            assert!((slopes - differences).length() < 1e-9, "{slopes} {differences}");
        }
    }

    #[test]
    fn a_ray_meets_the_surface_it_is_traced_to() {
        let term = |power, coefficient| Term { power, coefficient };
        let asphere = Curve { curvature: -25.0, conic: 2.0, terms: vec![term(4, 1e4), term(6, -2e6)] };
        let toroid = Profile::Toroid { curve: Curve::sphere(-20.0), radius: 0.3 };
        for profile in [Profile::sphere(0.0), Profile::sphere(30.0), Profile::Revolved(asphere), toroid] {
            let (origin, direction) = (DVec3::new(0.003, -0.002, -0.4), DVec3::new(0.01, 0.02, 1.0).normalize());
            for (origin, direction) in [(origin, direction), (origin, -direction)] {
                let point = origin + direction * profile.meet(origin, direction).expect("they meet");
                let (z, _) = profile.at(point.truncate()).expect("on the surface");
                assert!((point.z - z).abs() < 1e-15, "{profile:?}: {}", point.z - z);
            }
        }
    }

    #[test]
    fn a_ray_beside_a_sphere_meets_nothing() {
        assert_eq!(Profile::sphere(100.0).meet(DVec3::new(0.011, 0.0, -1.0), DVec3::Z), None);
    }
}

//! A flat source as it is seen by who looks back along its light.
//!
//! A source of flux F that leaves its plane with density rho (1/m2) at a place and p (1/sr) in a direction k at angle a to the normal
//! of the plane puts the irradiance and has the radiance
//!
//!     E = F rho / |cos a|   on a plane across k, if all its light goes along k,          L = F rho p / |cos a|

use super::angular::Pattern;
use super::{Extent, Source};
use glam::{DVec2, DVec3};

/// Beams up to this half-angle (rad) are looked for: light followed backwards would rarely find them by chance.
const NARROW: f64 = 0.2;

/// How light that is followed backwards comes to a source.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reach {
    /// Narrow: along a direction of its beam.
    Beam,
    /// By chance, through its plane.
    Plane,
    /// Not at all: it is no area in one plane.
    Never,
}

impl Source {
    /// How light that is followed backwards comes to it.
    pub fn reach(&self) -> Reach {
        let flat = matches!(self.extent, Extent::Flat { .. }) && self.extent.area() > 0.0;
        let narrow = match self.angular.pattern {
            Pattern::Collimated => true,
            Pattern::Cone { half_angle } | Pattern::Radiance { half_angle } | Pattern::Gaussian { half_angle } => {
                half_angle < NARROW
            }
            Pattern::Ring { outer, .. } => outer < NARROW,
        };
        match (flat, narrow) {
            (true, true) if self.outside => Reach::Beam,
            (true, _) if self.angular.pattern != Pattern::Collimated => Reach::Plane,
            _ => Reach::Never,
        }
    }

    /// Unit direction of its light at two coordinates in [0, 1).
    pub fn direction(&self, u: [f64; 2]) -> DVec3 {
        let Extent::Flat { frame, .. } = &self.extent else { return DVec3::ZERO };
        self.angular.frame().unwrap_or(*frame).to_world(self.angular.direction(u)).normalize()
    }

    /// Of light that comes to `point` along the unit `direction`: its way from the plane of the source, m, and the irradiance (W/m2) on a
    /// plane across it if all light went along it. `None` where no light of the source comes from.
    pub fn behind(&self, point: DVec3, direction: DVec3) -> Option<(f64, f64)> {
        let Extent::Flat { frame, at, outline } = &self.extent else { return None };
        let cosine = direction.dot(frame.z);
        let way = (point - *at).dot(frame.z) / cosine;
        let from = point - way * direction - *at;
        let density = outline.density(DVec2::new(frame.x.dot(from), frame.y.dot(from)));
        (way > 0.0 && way.is_finite() && density > 0.0).then(|| (way, self.flux * density / cosine.abs()))
    }

    /// Share of the flux per solid angle along the unit `direction`, 1/sr.
    pub fn towards(&self, direction: DVec3) -> f64 {
        let Extent::Flat { frame, .. } = &self.extent else { return 0.0 };
        self.angular.density(self.angular.frame().unwrap_or(*frame).to_local(direction))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Frame;
    use crate::math::Rng;
    use crate::math::statistics::chi_squared_tail;
    use crate::optics::Stokes;
    use crate::source::extent::Outline;
    use crate::source::{Angular, Polarization, Spectrum};

    fn source(outline: Outline, pattern: Pattern) -> Source {
        let frame = Frame::from_z_x(DVec3::new(0.3, -0.2, 0.9).normalize(), DVec3::X);
        Source {
            label: String::new(),
            flux: 2.0,
            extent: Extent::Flat { frame, at: DVec3::new(1.0, 2.0, 3.0), outline },
            angular: Angular { axis: Some(Frame::from_z_x(DVec3::Z, DVec3::X)), pattern },
            spectrum: Spectrum::Line(550e-9),
            polarization: Polarization { stokes: Stokes::unpolarised(1.0), reference: DVec3::X },
            outside: true,
        }
    }

    /// Counts of emitted rays in cells of a plane across the beam against the irradiance.
    #[test]
    fn rays_have_the_irradiance() {
        let outlines = [
            Outline::Disk { radius: 0.5 },
            Outline::Annulus { inner: 0.2, outer: 0.5 },
            Outline::Polygon { radius: 0.5, sides: 5 },
            Outline::Rectangle { width: 0.7, height: 0.9 },
            Outline::Gaussian { waist: 0.3 },
        ];
        for outline in outlines {
            let source = source(outline, Pattern::Collimated);
            let (cells, fine, side, draws) = (12, 40, 1.4, 200_000);
            let place = |i: f64, j: f64| DVec3::new(1.0 + (i - 0.5) * side, 2.0 + (j - 0.5) * side, 5.0);
            let mut expected = vec![0.0; cells * cells];
            let step = 1.0 / (cells * fine) as f64;
            for i in 0..cells * fine {
                for j in 0..cells * fine {
                    let point = place((i as f64 + 0.5) * step, (j as f64 + 0.5) * step);
                    let irradiance = source.behind(point, DVec3::Z).map_or(0.0, |behind| behind.1);
                    expected[i / fine * cells + j / fine] += irradiance * (side * step).powi(2) / source.flux;
                }
            }
            assert!((expected.iter().sum::<f64>() - 1.0).abs() < 3e-3, "{outline:?}: {}", expected.iter().sum::<f64>());
            let mut rng = Rng::new(5, 0, 0);
            let mut counts = vec![0.0; cells * cells];
            for _ in 0..draws {
                let ray = source.emit(&mut |_| rng.uniform()).ray;
                let at = (ray.origin.truncate() - DVec2::new(1.0, 2.0)) / side + 0.5;
                counts[(at.x * cells as f64) as usize * cells + (at.y * cells as f64) as usize] += 1.0;
            }
            let pairs = expected.iter().map(|e| e * f64::from(draws)).zip(counts).filter(|(e, _)| *e > 200.0);
            let (mut chi, mut freedom) = (0.0, 0.0);
            // The edges of an outline pass through fine cells: 1 % of a cell's count.
            pairs.for_each(|(e, c): (f64, f64)| {
                chi += (c - e).powi(2) / (e + (0.01 * e).powi(2));
                freedom += 1.0;
            });
            assert!(chi_squared_tail(chi, freedom) > 1e-3, "{outline:?}: {chi} of {freedom}");
        }
    }

    /// Counts in rings of equal cosine against the density.
    #[test]
    fn directions_have_the_density() {
        for pattern in [
            Pattern::Cone { half_angle: 0.4 },
            Pattern::Radiance { half_angle: 1.2 },
            Pattern::Radiance { half_angle: 0.1 },
            Pattern::Gaussian { half_angle: 0.5 },
            Pattern::Ring { inner: 0.4, outer: 1.2 },
        ] {
            let source = source(Outline::Disk { radius: 1.0 }, pattern);
            let (rings, fine, draws) = (400, 50, 200_000);
            let direction = |cosine: f64| DVec3::new((1.0 - cosine * cosine).sqrt(), 0.0, cosine);
            let mut expected = vec![0.0; rings];
            for k in 0..rings * fine {
                let step = 1.0 / (rings * fine) as f64;
                expected[k / fine] += source.towards(direction((k as f64 + 0.5) * step)) * std::f64::consts::TAU * step;
            }
            assert!((expected.iter().sum::<f64>() - 1.0).abs() < 1e-2, "{pattern:?}: {}", expected.iter().sum::<f64>());
            let mut rng = Rng::new(6, 0, 0);
            let mut counts = vec![0.0; rings];
            (0..draws).for_each(|_| counts[(source.direction(rng.pair()).z * rings as f64) as usize] += 1.0);
            let pairs = expected.iter().map(|e| e * f64::from(draws)).zip(counts).filter(|(e, _)| *e > 100.0);
            for (e, count) in pairs {
                assert!((count - e).abs() < 5.0 * e.sqrt() + 0.02 * e, "{pattern:?}: {count} of {e}");
            }
        }
    }
}

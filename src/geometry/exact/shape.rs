//! The shape of an exact surface in its own coordinates. One form, one variant.

use super::Root;
use super::conic::{Conic, quadratic};
use super::sag::Sag;
use super::solve::{MOST, zeros};
use arrayvec::ArrayVec;
use glam::DVec3;

/// A surface in the coordinates of its vertex, m; its normal looks to +z there, outwards for a cone.
#[derive(Clone, Debug)]
pub enum Shape {
    Conic(Conic),
    /// About z, of radius `radius` + `taper` z: a cylinder if the taper is 0.
    Cone {
        /// At z = 0, m.
        radius: f64,
        /// Change of radius with height, dimensionless.
        taper: f64,
    },
    Sag {
        sag: Sag,
        /// Greatest |second derivative| along any line over the extent that is used, 1/m.
        bend: f64,
    },
}

impl Shape {
    pub fn plane() -> Shape {
        Shape::Conic(Conic { curvature: 0.0, conic: 0.0 })
    }

    pub fn is_flat(&self) -> bool {
        matches!(self, Shape::Conic(conic) if conic.curvature == 0.0)
    }

    /// A height over the disc of radius `reach` (m).
    pub fn sag(sag: Sag, reach: f64) -> Shape {
        let bend = 2.0 * steepest_bend(&sag, reach);
        Shape::Sag { sag, bend }
    }

    /// Signed height above the surface along z, or distance outside a cone across its axis, m; NaN where there is none.
    pub fn level(&self, p: DVec3) -> f64 {
        match self {
            Shape::Conic(conic) => p.z - conic.sag(p.x.hypot(p.y)),
            Shape::Cone { radius, taper } => p.x.hypot(p.y) - (radius + taper * p.z),
            Shape::Sag { sag, .. } => p.z - sag.at(p.x, p.y)[0],
        }
    }

    /// Distance of a point from the surface, to first order, m; NaN where there is none.
    pub fn distance(&self, p: DVec3) -> f64 {
        match self {
            Shape::Cone { taper, .. } => self.level(p).abs() / taper.hypot(1.0),
            // Exact for a sphere, also beyond its equator.
            Shape::Conic(Conic { curvature, conic }) if *conic == 0.0 && *curvature != 0.0 => {
                ((p - DVec3::Z / *curvature).length() - 1.0 / curvature.abs()).abs()
            }
            _ => (self.level(p) * self.normal(self.settle(p)).z).abs(),
        }
    }

    /// Unit normal at a point of the surface.
    pub fn normal(&self, p: DVec3) -> DVec3 {
        match self {
            Shape::Conic(conic) => conic.normal(p),
            Shape::Cone { taper, .. } => p.truncate().normalize().extend(-taper).normalize(),
            Shape::Sag { sag, .. } => {
                let [_, x, y] = sag.at(p.x, p.y);
                DVec3::new(-x, -y, 1.0).normalize()
            }
        }
    }

    /// The point of the surface beside a point that is off it by rounding (above or below it, for a height).
    pub fn settle(&self, p: DVec3) -> DVec3 {
        match self {
            Shape::Conic(conic) if conic.level_known(p) => p.truncate().extend(conic.sag(p.x.hypot(p.y))),
            Shape::Conic(conic) => conic.settle(p),
            Shape::Cone { radius, taper } => (p.truncate().normalize() * (radius + taper * p.z)).extend(p.z),
            Shape::Sag { sag, .. } => DVec3::new(p.x, p.y, sag.at(p.x, p.y)[0]),
        }
    }

    /// Where the line o + t d meets it; heights only over `span` = [least t, greatest t].
    pub fn roots(&self, o: DVec3, d: DVec3, span: [f64; 2]) -> ArrayVec<Root, MOST> {
        match self {
            Shape::Conic(conic) => conic.roots(o, d).into_iter().flatten().collect(),
            Shape::Cone { radius, taper } => {
                let (across, along) = (o.truncate(), d.truncate());
                let (at, rate) = (radius + taper * o.z, taper * d.z);
                let a = along.length_squared() - rate * rate;
                let c = (across.length() - at) * (across.length() + at);
                let roots = quadratic(a, across.dot(along) - at * rate, c).into_iter().flatten();
                let real = roots.filter(|(t, _)| at + t * rate > 0.0);
                real.map(|(t, falls)| Root { t, rises: !falls }).collect()
            }
            Shape::Sag { sag, bend } => {
                let mut found = ArrayVec::new();
                let level = |t: f64| {
                    let p = o + t * d;
                    let [s, x, y] = sag.at(p.x, p.y);
                    [p.z - s, d.z - x * d.x - y * d.y]
                };
                let [from, to] = span;
                if from < to {
                    zeros(&level, bend * d.truncate().length_squared(), from, to, &mut found);
                }
                found
            }
        }
    }
}

/// Greatest |second derivative| of a height over a disc, from differences of its slopes on a grid of 48 rings and 32 spokes, 1/m.
fn steepest_bend(sag: &Sag, reach: f64) -> f64 {
    let h = reach * 1e-5;
    let mut most = 0f64;
    for ring in 0..=48 {
        for spoke in 0..32 {
            let (sin, cos) = (std::f64::consts::TAU * f64::from(spoke) / 32.0).sin_cos();
            let r = reach * f64::from(ring) / 48.0;
            let (x, y) = (r * cos, r * sin);
            let change = |dx: f64, dy: f64| {
                let ([_, ax, ay], [_, bx, by]) = (sag.at(x - dx, y - dy), sag.at(x + dx, y + dy));
                [(bx - ax) / (2.0 * h), (by - ay) / (2.0 * h)]
            };
            let ([xx, xy], [yx, yy]) = (change(h, 0.0), change(0.0, h));
            let norm = (xx * xx + xy * xy + yx * yx + yy * yy).sqrt();
            // Beyond the edge of the surface there is no slope.
            most = most.max(if norm.is_finite() { norm } else { 0.0 });
        }
    }
    most
}

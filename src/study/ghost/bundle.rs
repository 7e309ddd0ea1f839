//! A bundle of rays on a plane: how much light, where, how wide, and where it comes to a focus.
//!
//! A ray crosses the plane at x, y (m) with slopes u = dx/dz, v = dy/dz, z running along the normal with the light. Over the rays,
//! weighted with their flux w, with means written < >:
//!
//!     c     = <x>, <y>                                               centroid, m
//!     r     = sqrt(<|x - c|^2>)                                      rms radius, m
//!     z     = -<(x - c).(u - <u>)> / <|u - <u>|^2>                   plane parallel to the detector in which r is least, m
//!     f     = z sqrt(1 + |<u>|^2)                                    its distance along the mean ray: the focus
//!
//! f > 0: the light would come to its focus beyond the detector; f < 0: it had it before. The best focus of a bundle by least
//! squares in the ray heights (Welford, Aberrations of Optical Systems, 1986, sec. 8.5, for defocus alone).
//!
//! Left out: rays that run within 1e-6 rad along the plane have no slope; bundles whose slopes differ by less than 1e-7 have no focus.

use crate::detector::{Arrival, Grid, MapKind};
use std::collections::BTreeMap;

/// Sums over the rays of a bundle.
#[derive(Clone, Debug, Default)]
pub struct Bundle {
    /// Largest flux that one ray of a batch had when it had made its last reflection, W.
    pub begun: f64,
    pub rays: u64,
    pub sums: Moments,
    /// Least and largest x and y, m.
    pub extremes: Option<[[f64; 2]; 2]>,
    /// Flux (W) and rays in the bins that are lit.
    pub bins: BTreeMap<u32, (f64, u64)>,
}

/// Sums of w times 1; x, y; x^2 + y^2; u, v; u^2 + v^2; x u + y v.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Moments {
    /// Flux, W.
    pub flux: f64,
    place: [f64; 2],
    spread: f64,
    slope: [f64; 2],
    slopes: f64,
    both: f64,
}

/// Cosine to the normal below which a ray has no slope.
const GRAZING: f64 = 1e-6;

/// Variance of slopes below which they are equal: differences of unit vectors are known to 1e-16, squares of sums relative to 1.
const PARALLEL: f64 = 1e-14;

impl Bundle {
    /// One ray more.
    pub fn add(&mut self, grid: &dyn Grid, bin: usize, arrival: &Arrival, flux: f64) {
        self.rays += 1;
        let lit = self.bins.entry(bin as u32).or_default();
        *lit = (lit.0 + flux, lit.1 + 1);
        let (MapKind::Plane, Some(axes)) = (grid.kind(), grid.axes()) else {
            self.sums.flux += flux;
            return;
        };
        let frame = grid.frame();
        let from = arrival.point - grid.origin();
        let [x, y] = [axes[0].start + frame.x.dot(from), axes[1].start + frame.y.dot(from)];
        let forward = frame.z.dot(arrival.direction).abs().max(GRAZING);
        let slope = [frame.x, frame.y].map(|axis| axis.dot(arrival.direction) / forward);
        self.sums.add([x, y], slope, flux);
        let [[x0, x1], [y0, y1]] = self.extremes.unwrap_or([[x, x], [y, y]]);
        self.extremes = Some([[x0.min(x), x1.max(x)], [y0.min(y), y1.max(y)]]);
    }
}

impl Moments {
    fn add(&mut self, [x, y]: [f64; 2], [u, v]: [f64; 2], flux: f64) {
        let more = Moments {
            flux,
            place: [flux * x, flux * y],
            spread: flux * (x * x + y * y),
            slope: [flux * u, flux * v],
            slopes: flux * (u * u + v * v),
            both: flux * (x * u + y * v),
        };
        *self = self.plus(&more, 1.0);
    }

    /// These and `factor` times others.
    #[must_use]
    pub fn plus(&self, other: &Moments, factor: f64) -> Moments {
        let two = |a: [f64; 2], b: [f64; 2]| [a[0] + factor * b[0], a[1] + factor * b[1]];
        Moments {
            flux: self.flux + factor * other.flux,
            place: two(self.place, other.place),
            spread: self.spread + factor * other.spread,
            slope: two(self.slope, other.slope),
            slopes: self.slopes + factor * other.slopes,
            both: self.both + factor * other.both,
        }
    }

    /// Along an axis of the grid, m.
    pub fn centroid(&self, axis: usize) -> f64 {
        self.place[axis] / self.flux
    }

    /// m.
    pub fn rms_radius(&self) -> f64 {
        let centre = self.centroid(0).powi(2) + self.centroid(1).powi(2);
        (self.spread / self.flux - centre).max(0.0).sqrt()
    }

    /// Along the mean ray from the detector, m; infinite where rays are parallel.
    pub fn focus(&self) -> f64 {
        let slope = self.slope.map(|slope| slope / self.flux);
        let tilt = slope[0] * slope[0] + slope[1] * slope[1];
        let variance = self.slopes / self.flux - tilt;
        if variance <= PARALLEL * (1.0 + tilt) {
            return f64::INFINITY;
        }
        let shear = self.both / self.flux - slope[0] * self.centroid(0) - slope[1] * self.centroid(1);
        -shear / variance * (1.0 + tilt).sqrt()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cone_of_rays_has_its_focus_where_they_meet() {
        for (focus, tilt) in [(0.25, 0.0), (-0.1, 0.0), (0.04, 0.5)] {
            let mut sums = Moments::default();
            for k in 0..100 {
                let angle = f64::from(k) * 0.37;
                let [a, b] = [0.01 * angle.cos(), 0.01 * angle.sin()];
                // Slopes about the tilt; all rays pass through one point.
                sums.add([2.0 - a * focus, 1.0 - b * focus], [tilt + a, b], 1.0 + f64::from(k % 3));
            }
            let along = focus * (1.0 + sums.slope[0] * sums.slope[0] / sums.flux / sums.flux).sqrt();
            assert!((sums.focus() / along - 1.0).abs() < 1e-4, "{focus} {tilt}: {}", sums.focus());
            assert!((sums.rms_radius() / (0.01 * focus.abs()) - 1.0).abs() < 1e-2, "{}", sums.rms_radius());
            assert!((sums.centroid(1) - 1.0).abs() < 1e-3 * focus.abs());
        }
        let mut parallel = Moments::default();
        (0..9).for_each(|k| parallel.add([f64::from(k), 0.0], [0.1, 0.2], 1.0));
        assert_eq!(parallel.focus(), f64::INFINITY);
    }
}

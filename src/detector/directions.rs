//! Directions as bins: radiant intensity maps.
//!
//! theta is the angle between the light's direction of flight and the frame's z, phi the azimuth from x towards y of that
//! direction. Rows are rings of theta, columns sectors of phi starting at x. Light beyond `limit` is outside the grid.
//!
//!     Polar       rings of equal theta           extent = (cos theta0 - cos theta1) dphi            [sr]
//!     Projected   rings of equal sin^2 theta     (equal projected solid angle); limit <= 90 deg

use super::{Arrival, Axis, Grid, MapKind};
use crate::geometry::Frame;
use glam::DVec3;
use std::f64::consts::TAU;

/// How rings are spaced.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Rings {
    #[default]
    Polar,
    Projected,
}

/// A polar grid of directions.
#[derive(Debug)]
pub struct Directions {
    pub frame: Frame,
    pub rings: Rings,
    /// Largest theta, rad.
    pub limit: f64,
    pub rows: usize,
    pub columns: usize,
}

impl Directions {
    /// Lower edge of ring `row` in theta, rad.
    fn edge(&self, row: usize) -> f64 {
        let part = row as f64 / self.rows as f64;
        match self.rings {
            Rings::Polar => self.limit * part,
            Rings::Projected => (self.limit.sin() * part.sqrt()).asin(),
        }
    }
}

impl Grid for Directions {
    fn bin(&self, arrival: &Arrival) -> Option<usize> {
        let local = self.frame.to_local(arrival.direction);
        let sine = local.x.hypot(local.y);
        let theta = sine.atan2(local.z);
        if theta > self.limit {
            return None;
        }
        let part = match self.rings {
            Rings::Polar => theta / self.limit,
            Rings::Projected => (sine / self.limit.sin()).powi(2),
        };
        let turn = local.y.atan2(local.x).rem_euclid(TAU) / TAU;
        let row = ((part * self.rows as f64) as usize).min(self.rows - 1);
        let column = ((turn * self.columns as f64) as usize).min(self.columns - 1);
        Some(row * self.columns + column)
    }

    fn shape(&self) -> [usize; 2] {
        [self.rows, self.columns]
    }

    fn extent(&self, bin: usize) -> f64 {
        let row = bin / self.columns;
        // cos a - cos b without cancellation.
        let (a, b) = (self.edge(row), self.edge(row + 1));
        2.0 * (0.5 * (a + b)).sin() * (0.5 * (b - a)).sin() * TAU / self.columns as f64
    }

    fn unit(&self) -> &'static str {
        "W/sr"
    }

    fn kind(&self) -> MapKind {
        match self.rings {
            Rings::Polar => MapKind::Polar,
            Rings::Projected => MapKind::Projected,
        }
    }

    fn axes(&self) -> Option<[Axis; 2]> {
        let phi = Axis { name: "phi".into(), unit: "rad", start: 0.0, step: TAU / self.columns as f64 };
        let theta = match self.rings {
            Rings::Polar => Axis { name: "theta".into(), unit: "rad", start: 0.0, step: self.limit / self.rows as f64 },
            Rings::Projected => Axis {
                name: "sin2 theta".into(),
                unit: "sin2",
                start: 0.0,
                step: self.limit.sin().powi(2) / self.rows as f64,
            },
        };
        Some([phi, theta])
    }

    fn frame(&self) -> Frame {
        self.frame
    }

    fn origin(&self) -> DVec3 {
        DVec3::ZERO
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn solid_angles_add_up_to_the_cap() {
        for rings in [Rings::Polar, Rings::Projected] {
            let grid = Directions { frame: Frame::WORLD, rings, limit: 1.1, rows: 13, columns: 5 };
            let total: f64 = (0..65).map(|bin| grid.extent(bin)).sum();
            assert!((total - TAU * (1.0 - 1.1f64.cos())).abs() < 1e-12);
        }
    }

    #[test]
    fn azimuth_runs_from_x_towards_y() {
        let grid = Directions { frame: Frame::WORLD, rings: Rings::Polar, limit: 1.0, rows: 1, columns: 4 };
        let bin = |x: f64, y: f64| {
            let direction = DVec3::new(x, y, 2.0).normalize();
            grid.bin(&Arrival { point: DVec3::ZERO, direction, wavelength: 550e-9, triangle: None })
        };
        assert_eq!(
            [bin(1.0, 0.1), bin(-0.1, 1.0), bin(-1.0, -0.1), bin(0.1, -1.0)],
            [Some(0), Some(1), Some(2), Some(3)]
        );
    }
}

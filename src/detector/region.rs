//! Regions of interest on a flat detector.

use glam::DVec2;

/// A named part of the map's plane.
#[derive(Clone, Debug)]
pub struct Region {
    pub label: String,
    /// Along columns and rows from the middle of the map, m.
    pub at: DVec2,
    pub outline: Outline,
}

/// Its shape, m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Outline {
    /// Between two radii; inner 0: a disc.
    Ring { inner: f64, outer: f64 },
    /// Half sides.
    Rectangle { half: DVec2 },
}

impl Region {
    /// Whether a place on the map (m, from its middle) lies inside.
    pub fn holds(&self, place: DVec2) -> bool {
        let away = place - self.at;
        match self.outline {
            Outline::Ring { inner, outer } => (inner..=outer).contains(&away.length()),
            Outline::Rectangle { half } => away.abs().cmple(half).all(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn regions_end_where_they_should() {
        let ring = Region { label: String::new(), at: DVec2::X, outline: Outline::Ring { inner: 0.5, outer: 1.0 } };
        let held = [0.0, 0.4, 0.6, 1.0, 1.6, 2.1].map(|x| ring.holds(DVec2::new(x, 0.0)));
        assert_eq!(held, [true, true, false, false, true, false]);
        let square = Region { outline: Outline::Rectangle { half: DVec2::new(1.0, 0.1) }, ..ring };
        assert!(square.holds(DVec2::new(1.9, 0.1)) && !square.holds(DVec2::new(1.9, 0.11)));
    }
}

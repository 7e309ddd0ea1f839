//! Where an exact surface ends: the outline of the triangles that stand for it.
//!
//! Every outline edge A -> B cuts the surface along the plane through A, B and a direction k: the axis for a height, the mean
//! radius for a cylinder. A point is inside if a line from it along the surface, towards +x (heights) or +z (cylinders), crosses
//! an odd number of those cuts. The cut of an edge is half open in y (heights) or azimuth (cylinders), so that a line through a
//! corner counts once.

use glam::DVec3;
use std::f64::consts::{PI, TAU};

/// Across what an outline is swept.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sweep {
    /// y; cuts run along z.
    Y,
    /// Azimuth about z; cuts run along the radius.
    Azimuth,
}

/// The cut of one edge.
#[derive(Clone, Copy, Debug)]
struct Cut {
    /// Points with normal . p < offset lie before the cut, seen along the line.
    normal: DVec3,
    offset: f64,
    /// Swept interval [low, high).
    low: f64,
    high: f64,
}

/// The cuts, sorted into slices of the sweep.
#[derive(Clone, Debug)]
pub struct Outline {
    sweep: Sweep,
    slices: Vec<Vec<Cut>>,
    start: f64,
    /// Slices per unit of the sweep.
    density: f64,
}

impl Outline {
    /// From edges in the coordinates of the surface, m.
    pub fn new(sweep: Sweep, edges: &[[DVec3; 2]]) -> Outline {
        let cuts: Vec<Cut> = edges.iter().flat_map(|edge| cuts(sweep, edge)).collect();
        let start = cuts.iter().fold(f64::INFINITY, |least, cut| least.min(cut.low));
        let end = cuts.iter().fold(f64::NEG_INFINITY, |most, cut| most.max(cut.high));
        let count = cuts.len().clamp(1, 4096);
        let density = if end > start { count as f64 / (end - start) } else { 0.0 };
        let mut outline = Outline { sweep, slices: vec![Vec::new(); count], start, density };
        for cut in cuts {
            let (first, last) = (outline.slice(cut.low), outline.slice(cut.high));
            (first..=last).for_each(|slice| outline.slices[slice].push(cut));
        }
        outline
    }

    fn slice(&self, at: f64) -> usize {
        (((at - self.start) * self.density) as usize).min(self.slices.len() - 1)
    }

    /// Whether a point of the surface lies inside.
    pub fn holds(&self, p: DVec3) -> bool {
        let at = match self.sweep {
            Sweep::Y => p.y,
            Sweep::Azimuth => p.y.atan2(p.x),
        };
        let crossed = |cut: &&Cut| (cut.low..cut.high).contains(&at) && cut.normal.dot(p) < cut.offset;
        at >= self.start && self.slices[self.slice(at)].iter().filter(crossed).count() % 2 == 1
    }
}

/// The direction in which the cut of an edge runs off the chord; unit.
pub fn lift(sweep: Sweep, [a, b]: [DVec3; 2]) -> DVec3 {
    match sweep {
        Sweep::Y => DVec3::Z,
        Sweep::Azimuth => {
            (a.truncate().normalize_or_zero() + b.truncate().normalize_or_zero()).normalize_or_zero().extend(0.0)
        }
    }
}

/// The cut of an edge, in two pieces where it passes the azimuth of +-180 degrees; none if it runs along the line.
fn cuts(sweep: Sweep, edge: &[DVec3; 2]) -> Vec<Cut> {
    let [a, b] = *edge;
    let mut normal = (b - a).cross(lift(sweep, *edge));
    // The line runs towards +x or +z: that is the side beyond.
    let along = if sweep == Sweep::Y { normal.x } else { normal.z };
    if along < 0.0 {
        normal = -normal;
    }
    let piece = |low: f64, high: f64| Cut { normal, offset: normal.dot(a), low, high };
    let swept = |p: DVec3| if sweep == Sweep::Y { p.y } else { p.y.atan2(p.x) };
    let (low, high) = (swept(a).min(swept(b)), swept(a).max(swept(b)));
    let pieces = if sweep == Sweep::Azimuth && high - low > PI {
        // Up to and including pi, which atan2 may return.
        vec![piece(high, TAU), piece(-TAU, low)]
    } else {
        vec![piece(low, high)]
    };
    pieces.into_iter().filter(|cut| cut.low < cut.high && along != 0.0).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec2;

    fn loop_of(points: &[DVec3]) -> Vec<[DVec3; 2]> {
        (0..points.len()).map(|i| [points[i], points[(i + 1) % points.len()]]).collect()
    }

    #[test]
    fn a_star_with_a_hole_holds_what_winding_says() {
        let ring = |radius: &dyn Fn(usize) -> f64, n: usize| -> Vec<DVec3> {
            (0..n)
                .map(|i| (DVec2::from_angle(0.1 + TAU * i as f64 / n as f64) * radius(i)).extend(0.3 * i as f64))
                .collect()
        };
        let star = ring(&|i| if i % 2 == 0 { 2.0 } else { 1.0 }, 10);
        let hole = ring(&|_| 0.4, 7);
        let edges = [loop_of(&star), loop_of(&hole)].concat();
        let outline = Outline::new(Sweep::Y, &edges);
        let winding = |p: DVec2, points: &[DVec3]| -> f64 {
            loop_of(points).iter().map(|[a, b]| (a.truncate() - p).angle_to(b.truncate() - p)).sum::<f64>() / TAU
        };
        let mut inside = 0;
        for i in 0..4000 {
            let p = DVec2::from_angle(2.4 * f64::from(i)) * (2.2 * (f64::from(i) / 4000.0).sqrt());
            let expected = winding(p, &star).round() == 1.0 && winding(p, &hole).round() == 0.0;
            assert_eq!(outline.holds(p.extend(7.0)), expected, "{p}");
            inside += expected as u32;
        }
        assert!(inside > 1000);
    }

    #[test]
    fn a_band_round_a_cylinder_is_bounded_by_its_two_rims() {
        let rim = |z: f64| -> Vec<DVec3> {
            (0..24).map(|i| DVec2::from_angle(0.05 + TAU * f64::from(i) / 24.0).extend(z)).collect()
        };
        let outline = Outline::new(Sweep::Azimuth, &[loop_of(&rim(1.0)), loop_of(&rim(2.0))].concat());
        for i in 0..1000 {
            let around = DVec2::from_angle(PI - 0.2 + 1e-3 * f64::from(i));
            for (z, inside) in [(0.999_999, false), (1.000_001, true), (1.999_999, true), (2.000_001, false)] {
                assert_eq!(outline.holds(around.extend(z)), inside, "{around} {z}");
            }
        }
        assert!(outline.holds(DVec3::new(-1.0, 0.0, 1.5)) && outline.holds(DVec3::new(-1.0, -0.0, 1.5)));
    }
}

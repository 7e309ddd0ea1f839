//! Elements with plane faces only: their triangles are exact.

use super::{Draft, positive};
use crate::error::Problem;
use glam::{DVec2, DVec3};
use std::f64::consts::TAU;

impl Draft {
    /// A convex plane polygon, counter-clockwise seen from its front.
    fn polygon(&mut self, tag: &str, corners: &[DVec3]) {
        let known = self.tags.iter().position(|known| known == tag);
        let label = known.unwrap_or_else(|| {
            self.tags.push(tag.to_owned());
            self.tags.len() - 1
        });
        let first = self.vertices.len() as u32;
        self.vertices.extend(corners);
        for i in 1..corners.len() as u32 - 1 {
            self.triangles.push([first, first + i, first + i + 1]);
            self.labels.push(label as u16);
        }
    }

    /// A polygon of a plane moved along `along`; the polygon runs counter-clockwise seen against `along`.
    fn extruded(&mut self, base: &[DVec3], along: DVec3, sides: &dyn Fn(usize) -> String, ends: [&str; 2]) {
        let top: Vec<DVec3> = base.iter().map(|corner| *corner + along).collect();
        for i in 0..base.len() {
            let j = (i + 1) % base.len();
            self.polygon(&sides(i), &[base[i], base[j], top[j], top[i]]);
        }
        let bottom: Vec<DVec3> = base.iter().rev().copied().collect();
        self.polygon(ends[0], &bottom);
        self.polygon(ends[1], &top);
    }
}

pub fn plate(width: f64, height: f64, thickness: f64, medium: Option<String>) -> Result<Draft, Problem> {
    let (x, y) = (0.5 * positive(width, "the width")?, 0.5 * positive(height, "the height")?);
    let along = positive(thickness, "the thickness")? * DVec3::Z;
    let base = [(-x, -y), (x, -y), (x, y), (-x, y)].map(|(x, y)| DVec3::new(x, y, 0.0));
    let mut draft = Draft { medium, ..Draft::default() };
    draft.extruded(&base, along, &|_| "edge".to_owned(), ["front", "back"]);
    Ok(draft)
}

/// The polygon (y, z), extended along x.
pub fn prism(corners: &[[f64; 2]], length: f64, medium: Option<String>) -> Result<Draft, Problem> {
    let half = 0.5 * positive(length, "the length of the prism")?;
    let points: Vec<DVec2> = corners.iter().map(|[y, z]| DVec2::new(*y, *z)).collect();
    let count = points.len();
    let turns: Vec<f64> = (0..count)
        .map(|i| (points[(i + 1) % count] - points[i]).perp_dot(points[(i + 2) % count] - points[(i + 1) % count]))
        .collect();
    let (left, right) = (turns.iter().all(|t| *t > 0.0), turns.iter().all(|t| *t < 0.0));
    if count < 3 || !(left || right) {
        return Err(Problem::error("these corners are not those of a convex polygon")
            .expecting("three corners or more, in order around the prism"));
    }
    // In (y, z), counter-clockwise is seen against +x.
    let along = if left { 2.0 * half } else { -2.0 * half } * DVec3::X;
    let base: Vec<DVec3> = points.iter().map(|p| DVec3::new(-0.5 * along.x, p.x, p.y)).collect();
    let mut draft = Draft { medium, ..Draft::default() };
    draft.extruded(&base, along, &|i| format!("side{}", i + 1), ["ends", "ends"]);
    Ok(draft)
}

pub fn spider(vanes: u32, width: f64, depth: f64, inner: f64, outer: f64) -> Result<Draft, Problem> {
    let (half, depth) = (0.5 * positive(width, "the width of a vane")?, positive(depth, "the depth of a vane")?);
    if !((1..=64).contains(&vanes) && inner >= 0.0 && inner < outer) {
        return Err(Problem::error(format!("{vanes} vanes from {inner} m to {outer} m"))
            .expecting("1 to 64 vanes, an inner diameter below the outer one"));
    }
    let mut draft = Draft::default();
    for vane in 0..vanes {
        let out = DVec2::from_angle(TAU * f64::from(vane) / f64::from(vanes));
        let corner = |radius: f64, side: f64| (radius * out + side * out.perp()).extend(0.0);
        let base = [
            corner(0.5 * inner, -half),
            corner(0.5 * outer, -half),
            corner(0.5 * outer, half),
            corner(0.5 * inner, half),
        ];
        draft.extruded(&base, depth * DVec3::Z, &|_| "side".to_owned(), ["front", "back"]);
    }
    Ok(draft)
}

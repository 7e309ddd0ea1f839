//! Round mechanics: screens, tubes, vanes, and any profile.

use super::lathe::{Curve, Stretch, turn};
use super::{Draft, positive};
use crate::error::Problem;
use std::f64::consts::PI;

fn straight(tag: &str, a: [f64; 2], b: [f64; 2]) -> Stretch {
    Stretch { tag: tag.to_owned(), curve: Curve::Straight(a, b) }
}

/// Inner and outer radius, m.
fn radii(inner: f64, outer: f64) -> Result<[f64; 2], Problem> {
    if inner >= 0.0 && inner < outer && outer.is_finite() {
        return Ok([0.5 * inner, 0.5 * outer]);
    }
    let problem = format!("an inner diameter of {:.6} mm in an outer one of {:.6} mm", 1e3 * inner, 1e3 * outer);
    Err(Problem::error(problem).expecting("an inner diameter of 0 or more, below the outer one"))
}

pub fn aperture(diameter: f64, outer: f64) -> Result<Draft, Problem> {
    let [hole, edge] = radii(diameter, outer)?;
    Ok(turn(&[straight("front", [hole, 0.0], [edge, 0.0])]))
}

pub fn tube(inner: f64, outer: f64, length: f64) -> Result<Draft, Problem> {
    let [bore, shell] = radii(inner, outer)?;
    let end = positive(length, "the length of the tube")?;
    let mut profile = vec![
        straight("front", [bore, 0.0], [shell, 0.0]),
        straight("outside", [shell, 0.0], [shell, end]),
        straight("back", [shell, end], [bore, end]),
    ];
    if bore > 0.0 {
        profile.push(straight("inside", [bore, end], [bore, 0.0]));
    }
    Ok(turn(&profile))
}

/// Stretches that stand for the rounded edge of a vane.
const EDGE: u32 = 12;

/// The front is the plane z = 0; the bevel looks to +z and to the axis. The edge is a circle of radius `rho` about
/// (inner / 2 + rho, rho), tangent to both, as a polygon around it: its light goes where that of the circle goes, to within
/// the angle of a stretch.
pub fn vane(inner: f64, outer: f64, thickness: f64, bevel: f64, rho: f64) -> Result<Draft, Problem> {
    let [hole, shell] = radii(inner, outer)?;
    let (rho, thickness) =
        (positive(rho, "the radius of the edge")?, positive(thickness, "the thickness of the vane")?);
    if !(bevel > 0.0 && bevel < 0.5 * PI) {
        return Err(Problem::error("the angle of the bevel").expecting("an angle above 0 and below 90 deg"));
    }
    let centre = [hole + rho, rho];
    let tangent = [centre[0] - rho * bevel.sin(), centre[1] + rho * bevel.cos()];
    let top = tangent[0] + (thickness - tangent[1]) / bevel.tan();
    if thickness <= tangent[1] || top >= shell || centre[0] >= shell {
        let problem = Problem::error("the bevel does not end within the vane");
        return Err(problem.expecting("a thinner vane, a steeper bevel or a greater outer diameter"));
    }
    // From the bevel round to the front: outward normals from angle bevel (off +z towards the axis) to -z.
    let turned = PI - bevel;
    let step = turned / f64::from(EDGE);
    let at = |angle: f64, radius: f64| [centre[0] - radius * angle.sin(), centre[1] + radius * angle.cos()];
    let mut corners = vec![tangent];
    corners.extend((0..EDGE).map(|i| at(bevel + (f64::from(i) + 0.5) * step, rho / (0.5 * step).cos())));
    corners.push([centre[0], 0.0]);
    let mut profile = vec![
        straight("front", [centre[0], 0.0], [shell, 0.0]),
        straight("outside", [shell, 0.0], [shell, thickness]),
        straight("back", [shell, thickness], [top, thickness]),
        straight("bevel", [top, thickness], tangent),
    ];
    profile.extend(corners.windows(2).map(|pair| straight("edge", pair[0], pair[1])));
    Ok(turn(&profile))
}

/// Any profile.
pub fn turned(profile: &[[f64; 2]], closed: bool) -> Result<Draft, Problem> {
    if profile.len() < if closed { 3 } else { 2 } {
        return Err(Problem::error(format!("a profile of {} corners", profile.len())).expecting("more corners"));
    }
    if profile.iter().any(|[r, z]| !(*r >= 0.0 && r.is_finite() && z.is_finite())) {
        return Err(Problem::error("a corner beyond the axis").expecting("distances from the axis of 0 or more"));
    }
    let ends = profile.iter().copied().skip(1).chain(closed.then_some(profile[0]));
    let pairs: Vec<_> = profile.iter().copied().zip(ends).collect();
    if let Some(at) = pairs.iter().position(|(a, b)| a == b || (a[0] == 0.0 && b[0] == 0.0 && !closed)) {
        return Err(Problem::error(format!("stretch {} has no area", at + 1)).expecting("corners that differ"));
    }
    let stretches = pairs.into_iter().enumerate().filter(|(_, (a, b))| a[0] > 0.0 || b[0] > 0.0);
    Ok(turn(&stretches.map(|(i, (a, b))| straight(&format!("s{}", i + 1), a, b)).collect::<Vec<_>>()))
}

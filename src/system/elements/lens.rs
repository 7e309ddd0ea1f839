//! Lenses and mirrors.

use super::lathe::{Curve, Stretch, height, turn};
use super::{Draft, positive};
use crate::error::Problem;
use crate::geometry::exact::Shape;
use crate::system::document::{Form, Optical};
use crate::system::exact;
use crate::system::units::Length;

/// One glass after the other, cemented.
pub fn lens(
    surfaces: &[Optical],
    thickness: &[Length],
    media: &[String],
    diameter: Option<Length>,
) -> Result<Vec<Draft>, Problem> {
    if media.is_empty() || surfaces.len() != media.len() + 1 || thickness.len() != media.len() {
        let counts = format!("{} surfaces, {} thicknesses and {} media", surfaces.len(), thickness.len(), media.len());
        return Err(Problem::error(counts).expecting("as many thicknesses as media, and one surface more"));
    }
    let largest = surfaces.iter().filter_map(|s| s.semi_diameter).map(|s| s.0).fold(0.0, f64::max);
    let edge = diameter.map_or(largest, |d| 0.5 * d.0);
    if edge == 0.0 {
        return Err(Problem::error("this lens has no size").expecting("`diameter`, or `semi_diameter` of its surfaces"));
    }
    positive(edge, "the radius of the edge")?;
    let mut vertex = 0.0;
    let mut faces = Vec::new();
    for (i, optical) in surfaces.iter().enumerate() {
        let semi = optical.semi_diameter.map_or(edge, |s| s.0);
        if semi > edge * (1.0 + 1e-12) {
            let problem = Problem::error(format!("surface {} is larger than the lens", i + 1));
            return Err(problem.expecting(format!("a semi-diameter of at most {:.6} mm", 1e3 * edge)));
        }
        let semi = positive(semi.min(edge), "a semi-diameter")?;
        faces.push(Cap { shape: exact::shape(&optical.form, semi)?, vertex, semi });
        vertex += thickness.get(i).map_or(0.0, |t| t.0);
    }
    let glass = |(i, medium): (usize, &String)| {
        let [front, back] = [&faces[i], &faces[i + 1]];
        let gap = back.rim() - front.rim();
        if gap < 0.0 || thickness[i].0 <= 0.0 {
            let problem = Problem::error(format!("glass {} is {:.6} mm thick at its edge", i + 1, 1e3 * gap));
            return Err(problem.expecting("surfaces that do not cross: a greater thickness or a smaller diameter"));
        }
        let mut draft = turn(&block(front, back, edge));
        draft.medium = Some(medium.clone());
        Ok(draft)
    };
    media.iter().enumerate().map(glass).collect()
}

/// An optical surface about the axis.
struct Cap {
    shape: Shape,
    vertex: f64,
    semi: f64,
}

impl Cap {
    /// Height of its rim, m.
    fn rim(&self) -> f64 {
        height(&self.shape, self.vertex, self.semi)
    }

    fn curve(&self, from: f64, to: f64) -> Curve {
        Curve::Surface { shape: self.shape.clone(), vertex: self.vertex, from, to }
    }
}

fn stretch(tag: &str, curve: Curve) -> Stretch {
    Stretch { tag: tag.to_owned(), curve }
}

/// The profile of a glass between two caps.
fn block(front: &Cap, back: &Cap, edge: f64) -> Vec<Stretch> {
    let (low, high) = (front.rim(), back.rim());
    let mut profile = vec![stretch("front", front.curve(0.0, front.semi))];
    if front.semi < edge {
        profile.push(stretch("shoulder", Curve::Straight([front.semi, low], [edge, low])));
    }
    if high > low {
        profile.push(stretch("edge", Curve::Straight([edge, low], [edge, high])));
    }
    if back.semi < edge {
        profile.push(stretch("shoulder", Curve::Straight([edge, high], [back.semi, high])));
    }
    profile.push(stretch("back", back.curve(back.semi, 0.0)));
    profile
}

/// A reflecting front, with or without a blank.
pub fn mirror(form: &Form, diameter: f64, hole: f64, thickness: Option<f64>) -> Result<Draft, Problem> {
    let edge = 0.5 * positive(diameter, "the diameter of the mirror")?;
    let inner = 0.5 * hole;
    if !(0.0..edge).contains(&inner) {
        return Err(
            Problem::error("the hole is no smaller than the mirror").expecting("a hole of 0 or more, below `diameter`")
        );
    }
    let cap = Cap { shape: exact::shape(form, edge)?, vertex: 0.0, semi: edge };
    let front = |from, to| stretch("front", cap.curve(from, to));
    let Some(back) = thickness else { return Ok(turn(&[front(inner, edge)])) };
    let (outer, rim) = (cap.rim(), height(&cap.shape, 0.0, inner));
    let behind = if back > 0.0 { back > outer.max(rim) } else { back < outer.min(rim) };
    if !behind {
        return Err(Problem::error("the back of the blank cuts the front").expecting("a thicker blank"));
    }
    let straight = |tag: &str, a, b| stretch(tag, Curve::Straight(a, b));
    let mut profile = if back > 0.0 {
        vec![
            front(inner, edge),
            straight("edge", [edge, outer], [edge, back]),
            straight("back", [edge, back], [inner, back]),
        ]
    } else {
        vec![
            front(edge, inner),
            straight("back", [inner, back], [edge, back]),
            straight("edge", [edge, back], [edge, outer]),
        ]
    };
    if inner > 0.0 {
        let wall = if back > 0.0 { ([inner, back], [inner, rim]) } else { ([inner, rim], [inner, back]) };
        profile.push(straight("hole", wall.0, wall.1));
    }
    Ok(turn(&profile))
}

//! Exact shapes as the scene needs them: from what the document says.

use crate::error::Problem;
use crate::geometry::Frame;
use crate::geometry::exact::{Conic, Sag, Shape};
use crate::system::document::Form;
use crate::system::units::Coefficient;
use glam::DVec3;

/// Triangles of a node and what they are triangles of.
#[derive(Clone, Debug)]
pub struct Declared {
    /// Triangles of the node's mesh.
    pub triangles: Vec<u32>,
    pub shape: Shape,
    /// Vertex, world (scene coordinates once the scene is numbered), m.
    pub at: DVec3,
    /// z: the axis.
    pub frame: Frame,
    /// Rims that are circles about the axis.
    pub rim: Round,
}

/// What is round about the rim of a declared surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Round {
    /// Nothing: the outline of the triangles.
    Polygon,
    /// Between two distances from the axis, m.
    Ring { inner: f64, outer: f64 },
    /// Between two heights along the axis, m.
    Band { low: f64, high: f64 },
}

/// The shape that a form describes within `reach` (m) of its axis.
pub fn shape(form: &Form, reach: f64) -> Result<Shape, Problem> {
    let shape = match form {
        Form::Plane => Shape::plane(),
        Form::Sphere { radius } => Shape::Conic(conic(Some(radius.0), 0.0)?),
        Form::Conic { radius, conic: k } => Shape::Conic(conic(Some(radius.0), *k)?),
        Form::Asphere { radius, conic: k, terms } => {
            let base = conic(radius.map(|r| r.0), *k)?;
            Shape::sag(Sag::Asphere { base, terms: powers(terms)? }, reach)
        }
        Form::Polynomial { radius, conic: k, terms } => {
            let base = conic(radius.map(|r| r.0), *k)?;
            let known = |&((i, j), a): &((u32, u32), Coefficient)| Ok(([i, j], coefficient(i + j, a)?));
            let terms = terms.iter().map(known).collect::<Result<_, Problem>>()?;
            Shape::sag(Sag::Polynomial { base, terms }, reach)
        }
        Form::Toroid { radius, conic: k, terms, rotation } => {
            let base = conic(radius.map(|r| r.0), *k)?;
            let radius = rotation.map_or(f64::INFINITY, |r| r.0);
            if radius == 0.0 {
                return Err(Problem::error("a toroid of radius 0").expecting("a radius of rotation that is not 0"));
            }
            Shape::sag(Sag::Toroid { base, terms: powers(terms)?, radius }, reach)
        }
        Form::Cylinder { radius } if radius.0 > 0.0 => Shape::Cone { radius: radius.0, taper: 0.0 },
        Form::Cylinder { .. } => return Err(Problem::error("the radius of a cylinder is above 0")),
    };
    let edge = DVec3::new(reach, 0.0, 0.0);
    if !matches!(form, Form::Cylinder { .. }) && !shape.level(edge).is_finite() {
        let most = (0..1000).map(|i| reach * f64::from(i) / 1000.0);
        let most = most.take_while(|r| shape.level(DVec3::new(*r, 0.0, 0.0)).is_finite()).last().unwrap_or(0.0);
        let problem = format!("this surface has no height at {:.6} mm from its axis", 1e3 * reach);
        return Err(Problem::error(problem).expecting(format!("a semi-diameter of at most {:.6} mm", 1e3 * most)));
    }
    Ok(shape)
}

fn conic(radius: Option<f64>, conic: f64) -> Result<Conic, Problem> {
    let curvature = radius.map_or(0.0, |radius| 1.0 / radius);
    if !curvature.is_finite() || !conic.is_finite() {
        return Err(Problem::error("a radius of 0").expecting("a radius that is not 0, or `Plane`"));
    }
    Ok(Conic { curvature, conic })
}

fn powers(terms: &[(u32, Coefficient)]) -> Result<Vec<(u32, f64)>, Problem> {
    terms.iter().map(|&(p, a)| Ok((p, coefficient(p, a)?))).collect()
}

/// A coefficient of power `power` in m^(1 - power).
fn coefficient(power: u32, written: Coefficient) -> Result<f64, Problem> {
    let exponent = 1 - power as i32;
    if !(1..=40).contains(&power) {
        return Err(Problem::error(format!("a term of power {power}")).expecting("a power from 1 to 40"));
    }
    if written.exponent != exponent && !(written.value == 0.0 || exponent == 0 && written.exponent == 0) {
        let problem =
            Problem::error(format!("the coefficient of power {power} has a length to the power {}", written.exponent));
        return Err(problem.expecting(format!("a unit such as mm^{exponent}")));
    }
    Ok(written.value)
}

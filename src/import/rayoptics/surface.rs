//! Surfaces of a `.roa` file.
//!
//! | profile | is |
//! |---|---|
//! | `Spherical` | `cv` |
//! | `Conic` | `cv`, `cc` |
//! | `EvenPolynomial` | and `coefs` of r^2, r^4 ... |
//! | `RadialPolynomial` | `cv`, `ec` = conic constant + 1, `coefs` of r, r^2 ... |
//! | `YToroid` | as `EvenPolynomial` in y, turned with curvature `cR` |

use super::super::decentre::{Axes, motions};
use super::{glass, node::Node};
use crate::error::Problem;
use crate::prescription::{Curve, Material, Opening, Outline, Profile, Role, Surface, Term};

/// The surface of an interface and the gap behind it (none behind the image); `unit` in m.
pub fn read(interface: &Node, gap: Option<&Node>, profiles: Option<&Node>, unit: f64) -> Result<Surface, Problem> {
    let values = interface.attributes();
    let length = |node: Node| node.number().map(|value| value * unit);
    let mut surface = Surface { profile: profile(interface, profiles, unit)?, ..Surface::plane() };
    if let Some(label) = values.find("label") {
        surface.label = label.text()?.to_owned();
    }
    if let Some(gap) = gap.map(Node::attributes) {
        let thickness = gap.get("thi")?.number()?;
        surface.thickness = if thickness >= 1e10 { f64::INFINITY } else { thickness * unit };
        surface.material = glass::read(&gap.get("medium")?)?;
    }
    if values.get("interact_mode")?.text()? == "reflect" {
        surface.material = Material::Mirror;
    }
    if surface.thickness.is_finite() {
        surface.semi_diameter = values.find("max_aperture").map(length).transpose()?.filter(|r| *r > 0.0);
    }
    for (name, role) in [("clear_apertures", Role::Clear), ("edge_apertures", Role::Edge)] {
        for node in values.find(name).map_or(Ok(Vec::new()), |list| list.list())? {
            surface.openings.push(opening(&node, role, unit)?);
        }
    }
    if let Some(decentre) = values.find("decenter") {
        (surface.before, surface.after) = moved(&decentre, unit)?;
    }
    Ok(surface)
}

fn profile(interface: &Node, profiles: Option<&Node>, unit: f64) -> Result<Profile, Problem> {
    let values = interface.attributes();
    if interface.class() == "ThinLens" {
        return Ok(Profile::Thin { power: values.get("_power")?.number()? / unit });
    }
    if let Some(phase) = values.find("phase_element") {
        return Err(phase.problem(format!("no phase element {:?} here", phase.class())).expecting("none"));
    }
    let node = match values.find("profile") {
        Some(inline) => inline,
        None => {
            let all = profiles.ok_or_else(|| interface.problem("has no profile").expecting("a `profile_dict`"))?;
            all.get(values.get("profile_id")?.text()?)?
        }
    };
    let form = node.attributes();
    let number = |name: &str| form.find(name).map_or(Ok(0.0), |node| node.number());
    let curvature = number("cv")? / unit;
    let terms = |step: u32| polynomial(&form, step, unit);
    Ok(match node.class() {
        "Spherical" => Profile::sphere(curvature),
        "Conic" => Profile::Revolved(Curve { curvature, conic: number("cc")?, terms: Vec::new() }),
        "EvenPolynomial" => Profile::Revolved(Curve { curvature, conic: number("cc")?, terms: terms(2)? }),
        "RadialPolynomial" => {
            let conic = form.find("ec").map_or(Ok(1.0), |ec| ec.number())? - 1.0;
            Profile::Revolved(Curve { curvature, conic, terms: terms(1)? })
        }
        "YToroid" => {
            let curve = Curve { curvature, conic: number("cc")?, terms: terms(2)? };
            Profile::Toroid { curve, radius: unit / number("cR")? }
        }
        class => return Err(node.problem(format!("no profile {class:?} here")).expecting("a conic or an asphere")),
    })
}

/// `coefs`, of the powers step, 2 step, 3 step ...
fn polynomial(form: &Node, step: u32, unit: f64) -> Result<Vec<Term>, Problem> {
    let coefficients = form.find("coefs").map_or(Ok(Vec::new()), |coefs| coefs.numbers())?;
    let powers = (1..100).map(|i| i * step);
    let terms = powers.zip(coefficients).filter(|(_, a)| *a != 0.0);
    Ok(terms.map(|(power, a)| Term { power, coefficient: a * unit.powi(1 - power as i32) }).collect())
}

fn opening(node: &Node, role: Role, unit: f64) -> Result<Opening, Problem> {
    let values = node.attributes();
    let length = |name: &str| values.find(name).map_or(Ok(0.0), |node| node.number()).map(|value| value * unit);
    let outline = match node.class() {
        "Circular" => Outline::Circle(length("radius")?),
        "Rectangular" => Outline::Rectangle(length("x_half_width")?, length("y_half_width")?),
        "Elliptical" => Outline::Ellipse(length("x_half_width")?, length("y_half_width")?),
        class => {
            return Err(node
                .problem(format!("no aperture {class:?} here"))
                .expecting("a circle, rectangle or ellipse"));
        }
    };
    if length("rotation")? != 0.0 {
        return Err(node.problem("a turned aperture").expecting("`rotation` 0"));
    }
    Ok(Opening { role, outline, centre: [length("x_offset")?, length("y_offset")?] })
}

fn moved(node: &Node, unit: f64) -> Result<(crate::prescription::Motion, crate::prescription::Motion), Problem> {
    let values = node.attributes();
    let kind = values.find("_dtype").map_or_else(|| values.get("dtype"), Ok)?;
    let axes = match kind.text()? {
        "decenter" => Axes::Stay,
        "reverse" => Axes::Reverse,
        "dec and return" => Axes::Return,
        "bend" => Axes::Bend,
        other => return Err(kind.problem(format!("no decentre {other:?} here")).expecting("a local decentre or bend")),
    };
    let triple = |name: &str| -> Result<[f64; 3], Problem> {
        let Some(list) = values.find(name) else { return Ok([0.0; 3]) };
        list.numbers()?.try_into().map_err(|_| list.problem("are not three numbers").expecting("x, y and z"))
    };
    if triple("rot_pt")? != [0.0; 3] {
        return Err(node.problem("a pivot beside the vertex").expecting("`rot_pt` [0, 0, 0]"));
    }
    motions(axes, triple("dec")?.map(|v| v * unit), triple("euler")?)
        .ok_or_else(|| node.problem("a bend about several axes").expecting("one angle"))
}

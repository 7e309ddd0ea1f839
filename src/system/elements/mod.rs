//! Elements without CAD: each becomes nodes with named faces, a mesh for pictures, selection and volumes, and exact shapes
//! that the light meets instead of it.

mod flat;
mod lathe;
mod lens;
mod ring;

use crate::error::Problem;
use crate::geometry::mesh::Mesh;
use crate::geometry::{Frame, rotation};
use crate::system::document::{Body, Element};
use crate::system::exact::Declared;
use crate::system::gltf::Node;
use glam::{DAffine3, DVec3};

/// A shape before it is placed: triangles with one label each, tags by label, and what labels truly are.
#[derive(Debug, Default)]
pub(super) struct Draft {
    pub vertices: Vec<DVec3>,
    pub triangles: Vec<[u32; 3]>,
    pub labels: Vec<u16>,
    pub tags: Vec<String>,
    /// Exact shapes by label; their triangles are found by it.
    pub exact: Vec<(u16, Declared)>,
    pub medium: Option<String>,
}

/// The nodes of an element.
pub fn nodes(name: &str, element: &Element) -> Result<Vec<Node>, Problem> {
    let drafts = match &element.body {
        Body::Lens { surfaces, thickness, media, diameter } => lens::lens(surfaces, thickness, media, *diameter)?,
        Body::Mirror { form, diameter, hole, thickness } => {
            vec![lens::mirror(form, diameter.0, hole.map_or(0.0, |h| h.0), thickness.map(|t| t.0))?]
        }
        Body::Aperture { diameter, outer } => vec![ring::aperture(diameter.0, outer.0)?],
        Body::Tube { inner, outer, length } => vec![ring::tube(inner.0, outer.0, length.0)?],
        Body::Vane { inner, outer, thickness, bevel, edge_radius } => {
            vec![ring::vane(inner.0, outer.0, thickness.0, bevel.0, edge_radius.0)?]
        }
        Body::Spider { vanes, width, depth, inner, outer } => {
            vec![flat::spider(*vanes, width.0, depth.0, inner.0, outer.0)?]
        }
        Body::Plate { width, height, thickness, medium } => {
            vec![flat::plate(width.0, height.0, thickness.0, medium.clone())?]
        }
        Body::Prism { corners, length, medium } => {
            let corners: Vec<[f64; 2]> = corners.iter().map(|(y, z)| [y.0, z.0]).collect();
            vec![flat::prism(&corners, length.0, medium.clone())?]
        }
        Body::Lathe { profile, closed } => {
            let profile: Vec<[f64; 2]> = profile.iter().map(|(r, z)| [r.0, z.0]).collect();
            vec![ring::turned(&profile, *closed)?]
        }
    };
    let single = drafts.len() == 1;
    let named = |i: usize| if single { name.to_owned() } else { format!("{name}.{}", i + 1) };
    Ok(drafts.into_iter().enumerate().map(|(i, draft)| place(draft, named(i), name, element)).collect())
}

/// Turned about its origin, then moved.
fn place(draft: Draft, name: String, family: &str, element: &Element) -> Node {
    let turn = rotation(element.rotate.0);
    let at = element.at.0;
    let vertices: Vec<DVec3> = draft.vertices.iter().map(|v| at + turn * *v).collect();
    let reach = vertices.iter().fold(0f64, |most, v| most.max(v.abs().max_element()));
    let read = draft.triangles.len();
    let (mesh, repairs) = Mesh::weld(vertices, draft.triangles, draft.labels, reach * 2f64.powi(-48));
    let exact = draft.exact.into_iter().map(|(label, declared)| Declared {
        triangles: (0..mesh.triangles.len() as u32).filter(|&t| mesh.labels[t as usize] == label).collect(),
        at: at + turn * declared.at,
        frame: Frame { x: turn * declared.frame.x, y: turn * declared.frame.y, z: turn * declared.frame.z },
        ..declared
    });
    let exact = exact.collect();
    let tags = draft.tags.into_iter().map(|tag| format!("{name}.{tag}")).collect();
    let path = if name == family { name.clone() } else { format!("{family}/{name}") };
    Node {
        name,
        path,
        index: 0,
        extras: Default::default(),
        frame: DAffine3::from_mat3_translation(turn, at),
        mesh,
        tags,
        read,
        repairs,
        exact,
        medium: draft.medium,
        is_element: true,
        moved: DAffine3::IDENTITY,
    }
}

/// A length that must be above zero.
fn positive(value: f64, what: &str) -> Result<f64, Problem> {
    if value > 0.0 && value.is_finite() {
        return Ok(value);
    }
    Err(Problem::error(format!("{what} is {:.6} mm", 1e3 * value)).expecting("a length above 0"))
}

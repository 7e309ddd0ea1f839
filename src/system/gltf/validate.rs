//! Everything that can be said about a document before a vertex is read.
//!
//! Byte ranges are computed in checked u64 arithmetic, so that no later slice can fail; every problem is collected.

use super::document::Root;
use super::{extension, layout};
use crate::error::Problem;
use gltf::json;

/// All problems of the document's structure, errors and warnings.
pub fn check(root: &Root) -> Vec<Problem> {
    let mut problems = version(root);
    if !problems.is_empty() {
        return problems; // Another version's fields mean other things.
    }
    problems.extend(extension::check(root));
    for (i, buffer) in root.buffers.iter().enumerate() {
        if buffer.byte_length.0 == 0 {
            problems.push(Problem::error("is missing or 0").on(format!("buffers[{i}].byteLength")));
        }
    }
    for (i, view) in root.buffer_views.iter().enumerate() {
        problems.extend(self::view(root, view).err().map(|p| on(p, format!("bufferViews[{i}]"))));
    }
    for (i, accessor) in root.accessors.iter().enumerate() {
        problems.extend(self::accessor(root, accessor).err().map(|p| on(p, format!("accessors[{i}]"))));
    }
    for (i, mesh) in root.meshes.iter().enumerate() {
        if mesh.primitives.is_empty() {
            problems.push(Problem::error("is empty").on(format!("meshes[{i}].primitives")));
        }
        for (j, primitive) in mesh.primitives.iter().enumerate() {
            let place = format!("meshes[{i}].primitives[{j}]");
            problems.extend(self::primitive(root, primitive).into_iter().map(|p| on(p, place.clone())));
        }
    }
    problems
}

/// Puts the place in front of what the problem already says about its field.
fn on(problem: Problem, place: String) -> Problem {
    let path = if problem.path.is_empty() { place } else { format!("{place}.{}", problem.path) };
    problem.on(path)
}

fn version(root: &Root) -> Vec<Problem> {
    let asset = &root.asset;
    let needs = asset.min_version.as_deref().filter(|least| *least != "2.0").map(|least| ("asset.minVersion", least));
    let is = Some(("asset.version", asset.version.as_str())).filter(|(_, version)| !version.starts_with("2."));
    let problem = |(path, found): (&str, &str)| {
        Problem::error(format!("is glTF {}", super::shorten(found))).on(path).expecting("2.0")
    };
    is.or(needs).map(problem).into_iter().collect()
}

/// `index` into a list of `len`.
pub fn within(index: usize, len: usize, path: &str) -> Result<usize, Problem> {
    if index < len {
        return Ok(index);
    }
    Err(Problem::error(format!("{index} does not exist; there are {len}")).on(path))
}

fn view(root: &Root, view: &json::buffer::View) -> Result<(), Problem> {
    let buffer = &root.buffers[within(view.buffer.value(), root.buffers.len(), "buffer")?];
    if view.byte_length.0 == 0 {
        return Err(Problem::error("is 0").on("byteLength"));
    }
    let end = view.byte_offset.map_or(0, |offset| offset.0).checked_add(view.byte_length.0);
    if end.is_none_or(|end| end > buffer.byte_length.0) {
        let problem = format!("reaches beyond buffer {} of {} bytes", view.buffer.value(), buffer.byte_length.0);
        return Err(Problem::error(problem));
    }
    match view.byte_stride {
        Some(stride) if !(4..=252).contains(&stride.0) || stride.0 % 4 != 0 => {
            Err(Problem::error(format!("is {}", stride.0)).on("byteStride").expecting("a multiple of 4 from 4 to 252"))
        }
        _ => Ok(()),
    }
}

fn accessor(root: &Root, accessor: &json::Accessor) -> Result<(), Problem> {
    let shape = layout::Shape::of(accessor)?;
    if accessor.count.0 == 0 {
        return Err(Problem::error("is 0").on("count"));
    }
    match accessor.buffer_view {
        Some(view) => {
            let offset = accessor.byte_offset.map_or(0, |offset| offset.0);
            layout::fits(root, view.value(), offset, accessor.count.0, &shape)?;
        }
        None if accessor.byte_offset.is_some_and(|offset| offset.0 != 0) => {
            return Err(Problem::error("is given without a bufferView").on("byteOffset"));
        }
        None => {}
    }
    let Some(sparse) = &accessor.sparse else { return Ok(()) };
    if sparse.count.0 == 0 || sparse.count.0 > accessor.count.0 {
        let problem = format!("is {}", sparse.count.0);
        return Err(Problem::error(problem).on("sparse.count").expecting(format!("1 to {}", accessor.count.0)));
    }
    let index = layout::Shape::of_sparse_indices(&sparse.indices)?;
    layout::fits(root, sparse.indices.buffer_view.value(), sparse.indices.byte_offset.0, sparse.count.0, &index)
        .map_err(|p| on(p, "sparse.indices".into()))?;
    layout::fits(root, sparse.values.buffer_view.value(), sparse.values.byte_offset.0, sparse.count.0, &shape)
        .map_err(|p| on(p, "sparse.values".into()))
}

/// Indices of a primitive in range, types as the specification (or KHR_mesh_quantization) allows, counts equal.
fn primitive(root: &Root, primitive: &super::document::Primitive) -> Vec<Problem> {
    let mut problems = Vec::new();
    let quantized = root.extensions_used.iter().any(|name| name == "KHR_mesh_quantization");
    let accessors = root.accessors.len();
    let vertices =
        primitive.attributes.get("POSITION").and_then(|&i| root.accessors.get(i as usize)).map(|a| a.count.0);
    if primitive.attributes.get("POSITION").is_none() {
        problems.push(Problem::error("has no POSITION").on("attributes"));
    }
    for (name, index) in &primitive.attributes.0 {
        let path = format!("attributes.{}", super::shorten(name));
        let accessor = match within(*index as usize, accessors, &path) {
            Ok(index) => &root.accessors[index],
            Err(problem) => {
                problems.push(problem);
                continue;
            }
        };
        problems.extend(layout::attribute(name, accessor, quantized).map(|p| p.on(path.as_str())));
        if vertices.is_some_and(|count| count != accessor.count.0) {
            problems.push(Problem::error("has another count than POSITION").on(path));
        }
    }
    if let Some(index) = primitive.indices {
        match within(index as usize, accessors, "indices") {
            Ok(index) => problems.extend(layout::indices(root, &root.accessors[index]).map(|p| p.on("indices"))),
            Err(problem) => problems.push(problem),
        }
    }
    if primitive.mode > json::mesh::TRIANGLE_FAN {
        problems.push(Problem::error(format!("is {}", primitive.mode)).on("mode").expecting("0 to 6"));
    }
    if let Some(material) = primitive.material {
        problems.extend(within(material as usize, root.materials.len(), "material").err());
    }
    problems
}

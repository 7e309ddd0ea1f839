//! How elements lie in a buffer view: type, size, stride, alignment, end.
//!
//! Source: Khronos, glTF 2.0 specification (2021), section 3.6.2.

use super::document::Root;
use super::validate::within;
use crate::error::Problem;
use gltf::json;
use gltf::json::accessor::{ComponentType, Type};
use gltf::json::validation::Checked;

/// Type of the elements of an accessor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shape {
    pub component: ComponentType,
    pub dimension: Type,
    /// Integers stand for fractions of their largest value.
    pub normalized: bool,
}

impl Shape {
    pub fn of(accessor: &json::Accessor) -> Result<Shape, Problem> {
        let Checked::Valid(component) = accessor.component_type else {
            return Err(Problem::error("is none of 5120 to 5123, 5125, 5126").on("componentType"));
        };
        let Checked::Valid(dimension) = accessor.type_ else {
            return Err(Problem::error("is none of SCALAR, VEC2 to VEC4, MAT2 to MAT4").on("type"));
        };
        Ok(Shape { component: component.0, dimension, normalized: accessor.normalized })
    }

    pub fn of_sparse_indices(indices: &json::accessor::sparse::Indices) -> Result<Shape, Problem> {
        let Checked::Valid(component) = indices.component_type else {
            return Err(Problem::error("is none of 5121, 5123, 5125").on("sparse.indices.componentType"));
        };
        Ok(Shape { component: component.0, dimension: Type::Scalar, normalized: false })
    }

    /// Bytes of one element. Columns of a matrix start at multiples of four bytes.
    pub fn size(&self) -> u64 {
        let component = self.component.size() as u64;
        let column = |rows: u64| (rows * component).next_multiple_of(4);
        match self.dimension {
            Type::Scalar => component,
            Type::Vec2 => 2 * component,
            Type::Vec3 => 3 * component,
            Type::Vec4 => 4 * component,
            Type::Mat2 => 2 * column(2),
            Type::Mat3 => 3 * column(3),
            Type::Mat4 => 4 * column(4),
        }
    }
}

/// Bytes from one element to the next.
pub fn stride(view: &json::buffer::View, shape: &Shape) -> u64 {
    view.byte_stride.map_or(shape.size(), |stride| stride.0 as u64)
}

/// Whether `count` elements from byte `offset` of a view lie within it, aligned to their component.
pub fn fits(root: &Root, view: usize, offset: u64, count: u64, shape: &Shape) -> Result<(), Problem> {
    let number = within(view, root.buffer_views.len(), "bufferView")?;
    let view = &root.buffer_views[number];
    let start = view.byte_offset.map_or(0, |offset| offset.0);
    let component = shape.component.size() as u64;
    let aligned = |at: u64| at.is_multiple_of(component);
    if !aligned(offset) || !start.checked_add(offset).is_some_and(aligned) {
        return Err(Problem::error(format!("is not aligned to {component} bytes")).on("byteOffset"));
    }
    let stride = stride(view, shape);
    if stride < shape.size() {
        let problem = format!("elements of {} bytes overlap: byteStride is {stride}", shape.size());
        return Err(Problem::error(problem));
    }
    let end = (count - 1).checked_mul(stride).and_then(|n| n.checked_add(shape.size())?.checked_add(offset));
    if end.is_none_or(|end| end > view.byte_length.0) {
        let problem = format!("{count} elements reach beyond bufferViews[{number}] of {} bytes", view.byte_length.0);
        return Err(Problem::error(problem).on("count"));
    }
    Ok(())
}

/// What is wrong with the type of a vertex attribute. Only those with a bearing on shape are looked at.
pub fn attribute(name: &str, accessor: &json::Accessor, quantized: bool) -> Option<Problem> {
    use ComponentType::*;
    let wanted = match name {
        "POSITION" | "NORMAL" => Type::Vec3,
        "TANGENT" => Type::Vec4,
        _ => return None,
    };
    let shape = Shape::of(accessor).ok()?;
    let component = match shape.component {
        F32 => true,
        I8 | I16 => quantized,
        U8 | U16 => quantized && name == "POSITION",
        U32 => false,
    };
    if shape.dimension == wanted && component {
        return None;
    }
    let upper = |dimension: Type| format!("{dimension:?}").to_uppercase();
    let problem = Problem::error(format!("is {} of {:?}", upper(shape.dimension), shape.component))
        .expecting(format!("{} of F32", upper(wanted)));
    Some(if component || quantized {
        problem
    } else {
        problem.hinting("integers need KHR_mesh_quantization".to_owned())
    })
}

/// What is wrong with an accessor used for indices.
pub fn indices(root: &Root, accessor: &json::Accessor) -> Option<Problem> {
    let shape = Shape::of(accessor).ok()?;
    let unsigned = matches!(shape.component, ComponentType::U8 | ComponentType::U16 | ComponentType::U32);
    if shape.dimension != Type::Scalar || !unsigned || shape.normalized {
        return Some(Problem::error("are not plain unsigned integers").expecting("SCALAR of U8, U16 or U32"));
    }
    let view = accessor.buffer_view.and_then(|view| root.buffer_views.get(view.value()))?;
    view.byte_stride.map(|_| Problem::error("lie in a bufferView with byteStride, which is for vertices only"))
}

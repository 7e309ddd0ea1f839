//! Elements out of buffers: positions in f64, indices in u32. The layout has been checked before.

use super::document::Root;
use super::layout::{Shape, stride};
use super::{extension, uri};
use crate::error::Problem;
use glam::DVec3;
use gltf::json;
use gltf::json::accessor::ComponentType;
use std::path::{Path, PathBuf};

/// Largest coordinate read, m (ten times the radius of Neptune's orbit: beyond it is a mistake).
pub const MOST_METRES: f64 = 4.5e13;

/// A checked document with the bytes of its buffers.
pub struct Store<'a> {
    pub root: &'a Root,
    buffers: Vec<Bytes<'a>>,
    /// Files read besides the document.
    pub files: Vec<PathBuf>,
}

enum Bytes<'a> {
    Own(Vec<u8>),
    Chunk(&'a [u8]),
}

impl Bytes<'_> {
    fn get(&self) -> &[u8] {
        match self {
            Bytes::Own(bytes) => bytes,
            Bytes::Chunk(bytes) => bytes,
        }
    }
}

/// Positions of an accessor as stored, in the units of the node, and what one step of their encoding is.
pub struct Positions {
    pub points: Vec<DVec3>,
    /// Spacing of integer coordinates; 0 for floating point.
    pub step: f64,
}

impl<'a> Store<'a> {
    /// Loads all buffers; `bin` is the BIN chunk of a .glb.
    pub fn load(root: &'a Root, bin: Option<&'a [u8]>, folder: &Path) -> Result<Store<'a>, Vec<Problem>> {
        let mut store = Store { root, buffers: Vec::new(), files: Vec::new() };
        let mut problems = Vec::new();
        for (i, buffer) in root.buffers.iter().enumerate() {
            match store.buffer(buffer, bin.filter(|_| i == 0), folder) {
                Ok(bytes) if (bytes.get().len() as u64) < buffer.byte_length.0 => {
                    let problem = format!("is {}, but there are {} bytes", buffer.byte_length.0, bytes.get().len());
                    problems.push(Problem::error(problem).on(format!("buffers[{i}].byteLength")));
                }
                Ok(bytes) => store.buffers.push(bytes),
                Err(problem) => problems.push(problem.on(format!("buffers[{i}]"))),
            }
        }
        if problems.is_empty() { Ok(store) } else { Err(problems) }
    }

    fn buffer(&mut self, buffer: &json::Buffer, bin: Option<&'a [u8]>, folder: &Path) -> Result<Bytes<'a>, Problem> {
        match (&buffer.uri, bin) {
            (Some(uri), _) => {
                let (bytes, file) = uri::load(uri, buffer.byte_length.0, folder)?;
                self.files.extend(file);
                Ok(Bytes::Own(bytes))
            }
            (None, Some(chunk)) => Ok(Bytes::Chunk(chunk)),
            (None, None) => {
                let reason = extension::no_data(self.root);
                Err(reason.unwrap_or_else(|| Problem::error("has no uri, and there is no BIN chunk for it")))
            }
        }
    }

    /// The elements of a view from `offset`: `count` slices of the size of `shape`.
    fn elements(&self, view: usize, offset: u64, count: u64, shape: &Shape) -> impl Iterator<Item = &[u8]> {
        (0..count as usize).map(move |i| self.element(view, offset, i, shape))
    }

    /// Element `i`. The layout has been checked by `layout::fits`, the length of the buffer by `load`.
    fn element(&self, view: usize, offset: u64, i: usize, shape: &Shape) -> &[u8] {
        let view = &self.root.buffer_views[view];
        let start =
            (view.byte_offset.map_or(0, |offset| offset.0) + offset) as usize + i * stride(view, shape) as usize;
        &self.buffers[view.buffer.value()].get()[start..start + shape.size() as usize]
    }

    /// Positions of accessor `index`, finite and of bearable size: all of them, or only those in `which`.
    pub fn positions(&self, index: u32, which: Option<&[u32]>) -> Result<Positions, Problem> {
        let accessor = &self.root.accessors[index as usize];
        let shape = Shape::of(accessor)?;
        let points = match (accessor.buffer_view, which) {
            (Some(view), None) => {
                let mut points: Vec<DVec3> = self
                    .elements(view.value(), offset(accessor), accessor.count.0, &shape)
                    .map(|e| point(e, &shape))
                    .collect();
                self.substitute(accessor, &shape, &mut points)?;
                points
            }
            (Some(view), Some(which)) => {
                let element = |i: &u32| self.element(view.value(), offset(accessor), *i as usize, &shape);
                which.iter().map(|i| point(element(i), &shape)).collect()
            }
            (None, _) if accessor.sparse.is_some() => {
                let mut points = vec![DVec3::ZERO; accessor.count.0 as usize];
                self.substitute(accessor, &shape, &mut points)?;
                points
            }
            (None, _) => return Err(self.no_data(index)),
        };
        // NaN fails the comparison as well.
        let bearable = |p: &DVec3| p.abs().max_element() <= MOST_METRES && p.is_finite();
        if let Some(i) = points.iter().position(|p| !bearable(p)) {
            let problem =
                format!("vertex {} is at {:?}", which.map_or(i as u32, |which| which[i]), points[i].to_array());
            let problem = Problem::error(problem).on(format!("accessors[{index}]"));
            return Err(problem.expecting("finite coordinates below 4.5e13"));
        }
        Ok(Positions { points, step: step(&shape) })
    }

    fn no_data(&self, index: u32) -> Problem {
        let missing = || Problem::error("has no bufferView: its vertices are not in the file");
        extension::no_data(self.root).unwrap_or_else(missing).on(format!("accessors[{index}]"))
    }

    /// Replaces the elements that a sparse accessor names.
    fn substitute(&self, accessor: &json::Accessor, shape: &Shape, points: &mut [DVec3]) -> Result<(), Problem> {
        let Some(sparse) = &accessor.sparse else { return Ok(()) };
        let index = Shape::of_sparse_indices(&sparse.indices)?;
        let at =
            self.elements(sparse.indices.buffer_view.value(), sparse.indices.byte_offset.0, sparse.count.0, &index);
        let values =
            self.elements(sparse.values.buffer_view.value(), sparse.values.byte_offset.0, sparse.count.0, shape);
        let mut last = None;
        for (at, value) in at.map(unsigned).zip(values) {
            if last.is_some_and(|last| at <= last) {
                return Err(Problem::error("sparse indices do not increase"));
            }
            let Some(place) = points.get_mut(at as usize) else {
                return Err(Problem::error(format!("sparse index {at} is beyond the {} vertices", points.len())));
            };
            *place = point(value, shape);
            last = Some(at);
        }
        Ok(())
    }

    /// Indices of accessor `index`, all below `vertices`.
    pub fn indices(&self, index: u32, vertices: usize) -> Result<Vec<u32>, Problem> {
        let accessor = &self.root.accessors[index as usize];
        let shape = Shape::of(accessor)?;
        let path = format!("accessors[{index}]");
        if accessor.sparse.is_some() {
            return Err(Problem::error("sparse indices are not supported").on(path));
        }
        let Some(view) = accessor.buffer_view else { return Err(self.no_data(index)) };
        let offset = accessor.byte_offset.map_or(0, |offset| offset.0);
        let indices: Vec<u32> = self.elements(view.value(), offset, accessor.count.0, &shape).map(unsigned).collect();
        match indices.iter().position(|&i| i as usize >= vertices) {
            None => Ok(indices),
            Some(at) => {
                Err(Problem::error(format!("index {} is beyond the {vertices} vertices", indices[at])).on(path))
            }
        }
    }
}

fn offset(accessor: &json::Accessor) -> u64 {
    accessor.byte_offset.map_or(0, |offset| offset.0)
}

/// Little-endian unsigned integer of one, two or four bytes.
fn unsigned(bytes: &[u8]) -> u32 {
    bytes.iter().rev().fold(0, |value, byte| value << 8 | u32::from(*byte))
}

/// Three components; integers as KHR_mesh_quantization says (signed fractions: max(c / 127, -1)).
fn point(bytes: &[u8], shape: &Shape) -> DVec3 {
    let size = shape.component.size();
    let component = |i: usize| number(&bytes[i * size..(i + 1) * size], shape);
    DVec3::new(component(0), component(1), component(2))
}

fn number(bytes: &[u8], shape: &Shape) -> f64 {
    let bits = unsigned(bytes);
    let value = match shape.component {
        ComponentType::F32 => return f64::from(f32::from_bits(bits)),
        ComponentType::I8 => f64::from(bits as u8 as i8),
        ComponentType::I16 => f64::from(bits as u16 as i16),
        ComponentType::U8 | ComponentType::U16 | ComponentType::U32 => f64::from(bits),
    };
    if shape.normalized { (value / largest(shape.component)).max(-1.0) } else { value }
}

fn largest(component: ComponentType) -> f64 {
    match component {
        ComponentType::I8 => 127.0,
        ComponentType::U8 => 255.0,
        ComponentType::I16 => 32767.0,
        ComponentType::U16 => 65535.0,
        ComponentType::U32 | ComponentType::F32 => 1.0,
    }
}

fn step(shape: &Shape) -> f64 {
    match (shape.component, shape.normalized) {
        (ComponentType::F32, _) => 0.0,
        (component, true) => 1.0 / largest(component),
        (_, false) => 1.0,
    }
}

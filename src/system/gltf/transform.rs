//! Where a node puts its mesh: an affine map in f64.
//!
//!     p_world = M_root ... M_parent M_node p        M = T R S, or the 16 numbers of `matrix`, column after column
//!
//! Source: Khronos, glTF 2.0 specification (2021), section 3.5.3.

use super::document::Node;
use crate::error::Problem;
use glam::{DAffine3, DMat3, DQuat, DVec3};

/// Largest scale or translation read. What lies beyond is a mistake, and its square would overflow f32 boxes.
const MOST: f64 = 4.5e13;
/// How far from 1 the length of a quaternion may be: three decimals. It is normalised.
const UNIT: f64 = 1e-3;

/// The node's own map, from its coordinates to those of its parent.
pub fn of(node: &Node) -> Result<DAffine3, Problem> {
    let trs = node.translation.is_some() || node.rotation.is_some() || node.scale.is_some();
    match node.matrix {
        Some(_) if trs => Err(Problem::error("gives a matrix and also translation, rotation or scale")),
        Some(matrix) => affine(&matrix),
        None => compose(node),
    }
}

fn affine(m: &[f64; 16]) -> Result<DAffine3, Problem> {
    bounded(m, "matrix")?;
    let projective = [m[3], m[7], m[11], m[15] - 1.0];
    // One rounding of f32 is 6e-8: such a row is meant as 0, 0, 0, 1.
    if projective.iter().any(|x| x.abs() > 1e-6) {
        return Err(Problem::error("is projective").on("matrix").expecting("0, 0, 0, 1 as the last row"));
    }
    let column = |i: usize| DVec3::new(m[i], m[i + 1], m[i + 2]);
    Ok(DAffine3 { matrix3: DMat3::from_cols(column(0), column(4), column(8)), translation: column(12) })
}

fn compose(node: &Node) -> Result<DAffine3, Problem> {
    let translation = node.translation.unwrap_or([0.0; 3]);
    let rotation = node.rotation.unwrap_or([0.0, 0.0, 0.0, 1.0]);
    let scale = node.scale.unwrap_or([1.0; 3]);
    bounded(&translation, "translation")?;
    bounded(&rotation, "rotation")?;
    bounded(&scale, "scale")?;
    let quaternion = DQuat::from_array(rotation);
    let length = quaternion.length();
    if (length - 1.0).abs() > UNIT {
        let problem = format!("is a quaternion of length {length:.4}");
        return Err(Problem::error(problem).on("rotation").expecting("length 1"));
    }
    let turn = DMat3::from_quat(quaternion / length);
    Ok(DAffine3 {
        matrix3: turn * DMat3::from_diagonal(DVec3::from_array(scale)),
        translation: DVec3::from_array(translation),
    })
}

fn bounded(values: &[f64], path: &str) -> Result<(), Problem> {
    match values.iter().find(|x| x.is_nan() || x.abs() > MOST) {
        None => Ok(()),
        Some(x) => Err(Problem::error(format!("contains {x:e}")).on(path).expecting("finite numbers below 4.5e13")),
    }
}

/// The most a length can grow: the longest image of a unit axis (exact for rotations with axis-aligned scale).
pub fn stretch(map: &DAffine3) -> f64 {
    let m = map.matrix3;
    m.x_axis.length().max(m.y_axis.length()).max(m.z_axis.length())
}

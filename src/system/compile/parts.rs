//! The parts that files hold, without what a system says of them.

use super::assembly::{self, make_unique, place};
use super::{Document, Error, Problem, Shop};
use crate::system::document::{Geometry, Up};
use crate::system::gltf::{self, Node};
use crate::system::units::{Angles, LengthUnit, Position};
use glam::{DAffine3, DVec3};
use std::path::Path;

/// The nodes of all geometry files of a system, placed in the world (m) and named as in the system, and warnings. Elements are not
/// among them.
pub fn parts_of_system(document: &Document) -> Result<(Vec<Node>, Vec<Problem>), Error> {
    let mut shop = Shop::new(document, document.warnings.clone());
    let assembly = assembly::read(&mut shop);
    let problems = shop.problems;
    if problems.iter().any(Problem::is_error) {
        return Err(Error::Input(problems));
    }
    let mut nodes: Vec<Node> = assembly.nodes.into_iter().filter(|node| !node.is_element).collect();
    for node in &mut nodes {
        node.mesh.vertices.iter_mut().for_each(|vertex| *vertex += assembly.shift);
        node.frame.translation += assembly.shift;
        let rest = DAffine3::from_translation(assembly.shift)
            * node.moved.inverse()
            * DAffine3::from_translation(-assembly.shift);
        node.mesh.transform(&rest);
        node.frame = rest * node.frame;
    }
    Ok((nodes, problems))
}

/// The nodes of a glTF file in the unit `unit` (m), as a system would name and place them that says no more of it, and warnings.
pub fn parts_of_file(path: &Path, unit: LengthUnit) -> Result<(Vec<Node>, Vec<Problem>), Error> {
    if let Err(error) = std::fs::File::open(path) {
        return Err(Error::Missing(vec![Problem::error(format!("cannot be opened: {error}")).in_file(path)]));
    }
    let file = gltf::read(path).map_err(Error::Input)?;
    let (at, rotate) = (Position(DVec3::ZERO), Angles(DVec3::ZERO));
    let placed = Geometry { file: path.to_owned(), unit, up: Up::Stored, at, rotate };
    let solid = file.nodes.into_iter().filter(|node| !node.mesh.triangles.is_empty());
    let mut nodes: Vec<Node> = solid.map(|node| place(node, &placed)).collect();
    make_unique(&mut nodes);
    Ok((nodes, file.warnings))
}

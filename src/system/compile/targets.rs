//! Targets: from the document to boxes in scene coordinates.

use super::Shop;
use super::assembly::Assembly;
use crate::aim::Target;
use crate::geometry::Frame;
use crate::system::document as written;
use glam::DVec3;

/// Triangles whose normals agree this well (cos) lie in one plane.
const FLAT: f64 = 1.0 - 1e-9;

/// Every target of the document, in its order.
pub fn targets(shop: &mut Shop, assembly: &Assembly) -> Vec<Target> {
    let document = shop.document;
    let mut targets = Vec::new();
    for (name, target) in document.system.targets.iter() {
        let label = name.to_owned();
        let flat = |normal: DVec3, x: DVec3, at: DVec3, half: [f64; 2]| Target {
            label: label.clone(),
            frame: Frame::from_z_x(normal, x),
            centre: at - assembly.shift,
            half: DVec3::new(half[0], half[1], 0.0),
        };
        targets.push(match target {
            written::Target::Rectangle { at, normal, x, width, height } => {
                flat(normal.0, x.map_or(DVec3::X, |x| x.0), at.0, [0.5 * width.0, 0.5 * height.0])
            }
            written::Target::Disk { at, normal, radius } => flat(normal.0, DVec3::X, at.0, [radius.0; 2]),
            written::Target::Node(glob) => {
                let nodes = assembly.matching(glob);
                if nodes.is_empty() {
                    shop.nothing_matches(&format!("targets[{name:?}]"), glob, &assembly.names());
                    continue;
                }
                around(assembly, &nodes, label)
            }
        });
    }
    targets
}

/// The box around nodes: in their plane if they are flat, else along the axes of the world.
fn around(assembly: &Assembly, nodes: &[usize], label: String) -> Target {
    let triangles: Vec<[DVec3; 3]> = nodes.iter().flat_map(|&node| assembly.triangles_of(node)).map(|t| t.1).collect();
    let doubled = |c: &[DVec3; 3]| (c[1] - c[0]).cross(c[2] - c[0]);
    let normal = triangles.iter().map(doubled).sum::<DVec3>().normalize_or(DVec3::Z);
    let flat = triangles.iter().all(|corners| doubled(corners).normalize_or(normal).dot(normal) > FLAT);
    let frame = if flat { Frame::from_z_x(normal, DVec3::X) } else { Frame::WORLD };
    Target::around(label, frame, triangles.into_iter().flatten())
}

//! A scene as a drawing: its triangles, merged where there are too many for a page, and some rays before anything is traced in earnest.
//!
//! Exact surfaces are drawn by the facets that stand for them.

mod merge;
mod pen;

use crate::scene::{Part, Scene};
use crate::tally::drawing::{Drawing, DrawnPart, Way};
use crate::transport::{Counts, Followed, summary};
use glam::DVec3;
use merge::{Soup, closed, merged};
pub use pen::sketch;
use std::collections::{BTreeMap, BTreeSet};

/// Triangles that a page holds with ease.
const MOST: usize = 100_000;

/// What a scene looks like.
pub fn draw(scene: &Scene) -> Drawing {
    let mut by_part = vec![Vec::new(); scene.parts.len()];
    let mut areas = vec![0.0; scene.parts.len()];
    let all_triangles = scene.geometry.len();
    for (triangle, &part) in scene.part_of.iter().enumerate().take(all_triangles) {
        let facet = scene.geometry.triangle(triangle as u32);
        if facet.is_finite() {
            by_part[part as usize].push(facet.vertices);
            areas[part as usize] += facet.area();
        }
    }
    let radius = scene.geometry.radius();
    let Soup { corners, triangles, counts, moved } = merged(&by_part, radius, MOST);
    let solid = solid(scene, &by_part);
    let parts = scene.parts.iter().enumerate().map(|(index, part)| DrawnPart {
        triangles: counts[index],
        area: areas[index],
        solid: solid[index],
        ..drawn(scene, part)
    });
    let parts = parts.collect();
    Drawing { centre: scene.shift, radius, corners, triangles, parts, all_triangles, moved, ways: Vec::new() }
}

/// Which parts are faces of closed bodies: the parts of a node together.
fn solid(scene: &Scene, by_part: &[Vec<[DVec3; 3]>]) -> Vec<bool> {
    let mut parts_of: BTreeMap<u32, BTreeSet<u32>> = BTreeMap::new();
    for (triangle, &part) in scene.part_of.iter().enumerate().take(scene.geometry.len()) {
        parts_of.entry(scene.geometry.object(triangle as u32)).or_default().insert(part);
    }
    let mut solid = vec![false; scene.parts.len()];
    for parts in parts_of.values() {
        if closed(parts.iter().flat_map(|part| &by_part[*part as usize])) {
            parts.iter().for_each(|part| solid[*part as usize] = true);
        }
    }
    solid
}

/// Ways along the strongest paths of a run, as far as it kept any.
pub fn followed<const V: usize>(scene: &Scene, counts: &Counts<V>) -> Vec<Way> {
    let way = |followed: &Followed| {
        let row = &counts.rows.rows[followed.row];
        Way {
            source: scene.sources[row.source].label.clone(),
            class: row.class.label(scene.has_optics),
            path: Some([scene.detectors[row.detector].label.clone(), summary::sequence(scene, row)]),
            points: followed.points.clone(),
            flux: followed.flux,
        }
    };
    counts.ways.iter().map(way).collect()
}

/// The names of a part.
fn drawn(scene: &Scene, part: &Part) -> DrawnPart {
    let surfaces = part.surface[0].map(|surface| scene.surfaces[surface as usize].label.as_str());
    // The label of a surface is that of its finish: "coating ar + scatter black".
    let split = surfaces.map(|label| label.split_once(" + scatter ").unwrap_or((label, "")));
    DrawnPart {
        label: part.label.clone(),
        speculars: split.map(|(specular, _)| specular.to_owned()),
        scatters: split.map(|(_, scatter)| scatter.to_owned()),
        media: scene.sides(part).map(|medium| scene.media[medium as usize].label.clone()),
        detectors: part.detectors.iter().map(|&index| scene.detectors[index as usize].label.clone()).collect(),
        ..DrawnPart::default()
    }
}

/// Single precision is a thousandth of a pixel.
fn single(point: DVec3) -> [f32; 3] {
    point.as_vec3().to_array()
}

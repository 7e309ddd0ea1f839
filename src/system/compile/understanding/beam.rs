//! Whether a source lights what it should: its footprint against the scene as seen along the beam.

use crate::geometry::{Frame, Left, Ray};
use crate::math::lowdiscrepancy::Block;
use crate::scene::Scene;
use crate::source::angular::Pattern;
use crate::source::extent::{Extent, Outline};
use crate::source::{Birth, Source};
use glam::{DVec2, DVec3};
use std::f64::consts::{FRAC_PI_4, TAU};

/// Rays along each side of the square that the scene is looked at through.
const GRID: usize = 96;
/// Rays that a source is tried with.
const TRIED: u32 = 4096;

/// What a source reaches.
#[derive(Clone, Copy, Debug)]
pub struct Beam {
    /// Part of the scene's silhouette along the beam that the beam covers, 0..1; `None` for what is not a beam.
    pub covers: Option<f64>,
    /// Part of the rays that meet anything, 0..1.
    pub meets: f64,
}

pub(super) fn beam(scene: &Scene, source: &Source) -> Beam {
    let meeting = births(source, TRIED).filter(|birth| {
        let left = birth.from.map_or_else(Left::nothing, |(triangle, front)| {
            Left::one(triangle, scene.geometry.object(triangle), front)
        });
        scene.geometry.nearest(&birth.ray, &left).is_some()
    });
    Beam { covers: covers(scene, source), meets: meeting.count() as f64 / TRIED as f64 }
}

/// The first `count` rays of a source; always the same.
pub(super) fn births(source: &Source, count: u32) -> impl Iterator<Item = Birth> + '_ {
    let block = Block::new(0, 0);
    (0..count).map(move |i| source.emit(&mut |dimension| block.coordinate(i, dimension, 0.5)))
}

/// Rays parallel to the beam from ahead of everything show the silhouette; each is lit if it passes through the source's
/// outline and meets something beyond.
fn covers(scene: &Scene, source: &Source) -> Option<f64> {
    let Extent::Flat { frame: plane, at, outline } = &source.extent else { return None };
    let narrow = match source.angular.pattern {
        Pattern::Collimated => true,
        Pattern::Radiance { half_angle } => half_angle < FRAC_PI_4,
        Pattern::Cone { .. } | Pattern::Gaussian { .. } | Pattern::Ring { .. } => false,
    };
    let along = source.angular.frame()?.z;
    let slant = along.dot(plane.z);
    if !narrow || slant == 0.0 || outline.area() == 0.0 {
        return None;
    }
    let frame = Frame::from_z(along);
    let (low, high) = silhouette_box(scene, &frame);
    let (mut seen, mut lit) = (0, 0);
    for i in 0..GRID * GRID {
        let cell = (DVec2::new((i % GRID) as f64, (i / GRID) as f64) + 0.5) / GRID as f64;
        let place = low.truncate() + cell * (high - low).truncate();
        let start = low.z - (high - low).length();
        let ray = Ray { origin: frame.to_world(place.extend(start)), direction: along };
        if scene.geometry.nearest(&ray, &Left::nothing()).is_none() {
            continue;
        }
        seen += 1;
        let distance = (*at - ray.origin).dot(plane.z) / slant;
        let foot = Ray { origin: ray.at(distance), direction: along };
        let place = foot.origin - *at;
        let inside = contains(outline, DVec2::new(plane.x.dot(place), plane.y.dot(place)));
        lit += (inside && scene.geometry.nearest(&foot, &Left::nothing()).is_some()) as usize;
    }
    (seen > 0).then(|| lit as f64 / seen as f64)
}

/// Least and greatest coordinates of the scene's box in `frame`, m.
fn silhouette_box(scene: &Scene, frame: &Frame) -> (DVec3, DVec3) {
    let [low, high] = scene.geometry.bounds();
    let corner = |i: usize| {
        let pick = |bit: usize, a: f64, b: f64| if i >> bit & 1 == 0 { a } else { b };
        frame.to_local(DVec3::new(pick(0, low.x, high.x), pick(1, low.y, high.y), pick(2, low.z, high.z)))
    };
    (0..8).map(corner).fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(l, h), c| (l.min(c), h.max(c)))
}

/// Whether a point (m, from the centre) is inside an outline; of a Gaussian, inside its waist.
fn contains(outline: &Outline, point: DVec2) -> bool {
    let distance = point.length();
    match *outline {
        Outline::Point => false,
        Outline::Disk { radius } => distance <= radius,
        Outline::Gaussian { waist } => distance <= waist,
        Outline::Annulus { inner, outer } => (inner..=outer).contains(&distance),
        Outline::Rectangle { width, height } => point.x.abs() <= 0.5 * width && point.y.abs() <= 0.5 * height,
        Outline::Polygon { radius, sides } => {
            // Corners at multiples of the wedge: fold the azimuth to the middle of its own.
            let wedge = TAU / sides as f64;
            let azimuth = point.to_angle().rem_euclid(wedge) - 0.5 * wedge;
            distance * azimuth.cos() <= radius * (0.5 * wedge).cos()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn outlines_contain_what_they_emit_from() {
        let outlines = [
            Outline::Disk { radius: 2.0 },
            Outline::Annulus { inner: 1.0, outer: 2.0 },
            Outline::Polygon { radius: 2.0, sides: 5 },
            Outline::Rectangle { width: 3.0, height: 1.0 },
        ];
        let side = 400;
        for outline in outlines {
            let place = |i: usize| (DVec2::new((i % side) as f64, (i / side) as f64) + 0.5) / side as f64;
            let inside = (0..side * side).filter(|&i| contains(&outline, 4.0 * place(i) - 2.0)).count();
            let area = 16.0 * inside as f64 / (side * side) as f64;
            // Cells that the edge cuts: of the order of its length times a cell.
            assert!((area - outline.area()).abs() < 0.01 * outline.area(), "{outline:?}: {area}");
        }
    }
}

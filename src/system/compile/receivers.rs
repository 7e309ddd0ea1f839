//! Detectors: from the document to grids in scene coordinates.

use super::Shop;
use super::assembly::Assembly;
use crate::detector::directions::{Directions, Rings};
use crate::detector::pixels::Pixels;
use crate::detector::region::{Outline, Region};
use crate::detector::response::{Count, Efficiency, Response};
use crate::detector::triangles::Triangles;
use crate::detector::{Detector, Grid, Place, Shape, Side, Window};
use crate::error::Problem;
use crate::geometry::Frame;
use crate::system::document as written;
use glam::{DVec2, DVec3};
use std::f64::consts::{FRAC_PI_2, PI};

/// Triangles of a detector's nodes whose normals agree this well (cos) lie in one plane.
const FLAT: f64 = 1.0 - 1e-9;

/// Every detector of the document, and which parts it watches.
pub fn detectors(shop: &mut Shop, assembly: &Assembly) -> Vec<(Detector, Vec<usize>)> {
    let mut detectors = Vec::new();
    for (name, written) in shop.document.system.detectors.iter() {
        let (place, frame, base, parts) = match &written.on {
            written::Receiver::Node(glob) => {
                let nodes = assembly.matching(glob);
                if nodes.is_empty() {
                    shop.nothing_matches(&format!("detectors[{name:?}].on"), glob, &assembly.names());
                    continue;
                }
                let (frame, base) = node_grid(assembly, &nodes, written.pixels);
                (Place::Parts, frame, base, assembly.parts_of(&nodes))
            }
            written::Receiver::Rectangle { at, normal, x, width, height } => {
                let frame = Frame::from_z_x(normal.0, x.map_or(DVec3::X, |x| x.0));
                let shape = Shape::Rectangle { half: [0.5 * width.0, 0.5 * height.0] };
                window(assembly, frame, at.0, shape, written.pixels)
            }
            written::Receiver::Disk { at, normal, radius } => {
                let frame = Frame::from_z_x(normal.0, DVec3::X);
                window(assembly, frame, at.0, Shape::Disk { radius: radius.0 }, written.pixels)
            }
            written::Receiver::FarField { axis } => {
                let frame = Frame::from_z_x(axis.0, DVec3::X);
                if written.quantity == written::Quantity::Irradiance {
                    let problem = Problem::error("the far field has no area, so no irradiance");
                    shop.fault(&format!("detectors[{name:?}].quantity"), problem.expecting("quantity: Intensity"));
                    continue;
                }
                (Place::FarField, frame, None, Vec::new())
            }
        };
        let grid = match (written.quantity, base) {
            (written::Quantity::Irradiance, Some(base)) => base,
            _ => directions(written, &place, frame),
        };
        let side = match written.side {
            written::Side::Both => Side::Both,
            written::Side::Front => Side::Front,
            written::Side::Back => Side::Back,
        };
        let regions = regions(written);
        if grid.place(DVec3::ZERO).is_none() && !regions.is_empty() {
            let problem = Problem::error("regions lie on a plane, and this detector is curved");
            shop.fault(
                &format!("detectors[{name:?}].regions"),
                problem.expecting("a flat node, a rectangle or a disc"),
            );
        }
        let response = response(written);
        detectors.push((Detector { label: name.into(), place, side, grid, response, regions }, parts));
    }
    detectors
}

/// What a watt counts as.
fn response(written: &written::Detector) -> Response {
    let efficiency = |efficiency: &written::Efficiency| Efficiency::new(&efficiency.0);
    let count = match &written.counts {
        written::Counts::Watts => Count::Watts,
        written::Counts::Photons => Count::Photons,
        written::Counts::Electrons { qe } => Count::Electrons(efficiency(qe)),
        written::Counts::Lumens => Count::Lumens,
    };
    Response { count, filter: written.filter.as_ref().map(efficiency) }
}

fn regions(written: &written::Detector) -> Vec<Region> {
    let region = |(label, region): &(String, written::Region)| {
        let (at, outline) = match region {
            written::Region::Disk { at, radius } => (at, Outline::Ring { inner: 0.0, outer: radius.0 }),
            written::Region::Annulus { at, inner, outer } => (at, Outline::Ring { inner: inner.0, outer: outer.0 }),
            written::Region::Rectangle { at, width, height } => {
                (at, Outline::Rectangle { half: 0.5 * DVec2::new(width.0, height.0) })
            }
        };
        Region { label: label.clone(), at: DVec2::new(at.0.0, at.1.0), outline }
    };
    written.regions.iter().map(region).collect()
}

type Watched = (Place, Frame, Option<Box<dyn Grid>>, Vec<usize>);

fn window(assembly: &Assembly, frame: Frame, at: DVec3, shape: Shape, pixels: Option<(u32, u32)>) -> Watched {
    let centre = at - assembly.shift;
    // The rounding of a surface point that was computed to lie in this plane.
    let thickness = 64.0 * f64::EPSILON * (assembly.radius + centre.length());
    let grid = Pixels::over(shape, frame, centre, counts(pixels, [1, 1]));
    (Place::Window(Window { frame, centre, shape, thickness }), frame, Some(Box::new(grid)), Vec::new())
}

fn counts(pixels: Option<(u32, u32)>, otherwise: [usize; 2]) -> [usize; 2] {
    pixels.map_or(otherwise, |(columns, rows)| [columns as usize, rows as usize])
}

/// Directions of flight: polar angle from the axis of the far field, or from straight through for a surface (up to 90 deg).
fn directions(written: &written::Detector, place: &Place, frame: Frame) -> Box<dyn Grid> {
    let [columns, rows] = counts(written.pixels, [72, 90]);
    let rings = match written.bins {
        Some(written::Bins::Projected) => Rings::Projected,
        _ => Rings::Polar,
    };
    let whole = matches!(place, Place::FarField) && rings == Rings::Polar;
    // A detector looks against its normal: theta counts from the direction of light that comes straight in.
    let inward = Frame { x: frame.x, y: -frame.y, z: -frame.z };
    let frame = match (place, written.side) {
        (Place::FarField, _) | (_, written::Side::Back) => frame,
        _ => inward,
    };
    Box::new(Directions { frame, rings, limit: if whole { PI } else { FRAC_PI_2 }, rows, columns })
}

/// Pixels on flat nodes, one bin per triangle on curved ones. Columns run along world x as seen in the plane (world y if the
/// plane is perpendicular to x), rows along normal x columns.
fn node_grid(assembly: &Assembly, nodes: &[usize], pixels: Option<(u32, u32)>) -> (Frame, Option<Box<dyn Grid>>) {
    let triangles: Vec<(u32, [DVec3; 3])> = nodes.iter().flat_map(|&node| assembly.triangles_of(node)).collect();
    let doubled = |c: &[DVec3; 3]| (c[1] - c[0]).cross(c[2] - c[0]);
    let sum: DVec3 = triangles.iter().map(|(_, corners)| doubled(corners)).sum();
    let normal = sum.normalize_or(DVec3::Z);
    let flat = triangles.iter().all(|(_, corners)| doubled(corners).normalize_or(normal).dot(normal) > FLAT);
    let centre = triangles.iter().flat_map(|(_, c)| c).sum::<DVec3>() / (3 * triangles.len()).max(1) as f64;
    let along = if normal.cross(DVec3::X).length() < 1e-6 { DVec3::Y } else { DVec3::X };
    let frame = Frame::from_z_x(normal, along);
    if !flat {
        let bins = nodes.iter().flat_map(|&node| assembly.met_on(node)).collect();
        return (frame, Some(Box::new(Triangles::new(bins, centre))));
    }
    let plane = |v: DVec3| DVec2::new(frame.x.dot(v - centre), frame.y.dot(v - centre));
    let corners = triangles.iter().flat_map(|(_, c)| c.iter().map(|&v| plane(v)));
    let (low, high) = corners.fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(l, h), p| (l.min(p), h.max(p)));
    let grid = Pixels::new(frame, centre, low, high, counts(pixels, [1, 1]));
    let outline: Vec<[DVec3; 3]> = triangles.into_iter().map(|(_, corners)| corners).collect();
    (frame, Some(Box::new(grid.within(&outline))))
}

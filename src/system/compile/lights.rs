//! Sources: from the document to extents, patterns and spectra in scene coordinates.

use super::Shop;
use super::assembly::Assembly;
use crate::error::Problem;
use crate::geometry::Frame;
use crate::optics::Stokes;
use crate::optics::stokes::Hand;
use crate::source::angular::{Angular, Pattern};
use crate::source::extent::{Extent, Mesh, Outline};
use crate::source::{Polarization, Source, Spectrum};
use crate::system::document as written;
use glam::{DVec2, DVec3};
use std::f64::consts::{FRAC_PI_2, PI};

/// The wavelengths of some light, by its name.
#[derive(Clone, Debug)]
pub struct Light {
    pub label: String,
    /// Least and greatest vacuum wavelength, m.
    pub range: [f64; 2],
}

impl Light {
    /// That of a source.
    pub fn of(source: &Source) -> Light {
        Light { label: source.label.clone(), range: source.spectrum.range() }
    }
}

/// Every source of the document.
pub fn sources(shop: &mut Shop, assembly: &Assembly) -> Vec<Source> {
    let document = shop.document;
    document
        .system
        .sources
        .iter()
        .filter_map(|(name, written)| source(shop, assembly, (&format!("sources[{name:?}]"), name), written))
        .collect()
}

/// A source under this name, written at this path of the document.
pub fn source(
    shop: &mut Shop,
    assembly: &Assembly,
    (path, name): (&str, &str),
    written: &written::Source,
) -> Option<Source> {
    let at = written.at.map_or(DVec3::ZERO, |at| at.0) - assembly.shift;
    let beam = beam(written, at, assembly.shift);
    let axis = written.axis.map(|a| a.0).or(beam).unwrap_or(DVec3::Z);
    let reference = written.x.map_or(DVec3::X, |x| x.0);
    let frame = Frame::from_z_x(axis, reference);
    let pattern = pattern(&written.angular);
    // A beam has its own direction; any other pattern surrounds the normal of a node or the axis of a flat extent.
    let on_node = matches!(written.extent, written::Extent::Node { .. });
    let fixed = match beam {
        Some(beam) => Some(Frame::from_z_x(beam, reference)),
        None if on_node && written.axis.is_none() => None,
        None => Some(frame),
    };
    let extent = extent(shop, assembly, path, written, frame, at, beam)?;
    let flux = flux(shop, path, written, &extent, &frame, beam)?;
    let reach = match &extent {
        Extent::Flat { outline, .. } => outline.reach(),
        Extent::Mesh(_) => f64::INFINITY,
    };
    Some(Source {
        label: name.into(),
        flux,
        angular: Angular { axis: fixed, pattern },
        spectrum: spectrum(&written.spectrum),
        polarization: Polarization { stokes: stokes(written.polarization), reference },
        outside: assembly.clear_of_solids(at, reach),
        extent,
    })
}

/// Direction of a collimated beam or of the disc at infinity.
fn beam(written: &written::Source, at: DVec3, shift: DVec3) -> Option<DVec3> {
    let written::Angular::Collimated { direction, aim_at, field } = &written.angular else { return None };
    if let Some(direction) = direction {
        return Some(direction.0);
    }
    if let Some(target) = aim_at {
        return (target.0 - shift - at).try_normalize();
    }
    let (x, y) = field.as_ref()?;
    let axis = written.axis.map_or(DVec3::Z, |a| a.0);
    let frame = Frame::from_z_x(axis, written.x.map_or(DVec3::X, |x| x.0));
    Some(frame.to_world(DVec3::new(x.0.tan(), y.0.tan(), 1.0)).normalize())
}

fn pattern(written: &written::Angular) -> Pattern {
    match written {
        written::Angular::Collimated { .. } => Pattern::Collimated,
        written::Angular::Cone { half_angle } => Pattern::Cone { half_angle: half_angle.0 },
        written::Angular::AngularDiameter(angle) => Pattern::Radiance { half_angle: 0.5 * angle.0 },
        written::Angular::Ring { inner, outer } => Pattern::Ring { inner: 0.5 * inner.0, outer: 0.5 * outer.0 },
        written::Angular::Lambertian => Pattern::Radiance { half_angle: FRAC_PI_2 },
        written::Angular::Gaussian { half_angle } => Pattern::Gaussian { half_angle: half_angle.0 },
        written::Angular::Isotropic => Pattern::Cone { half_angle: PI },
    }
}

fn extent(
    shop: &mut Shop,
    assembly: &Assembly,
    path: &str,
    written: &written::Source,
    frame: Frame,
    at: DVec3,
    beam: Option<DVec3>,
) -> Option<Extent> {
    let flat = |outline| Some(Extent::Flat { frame, at, outline });
    match &written.extent {
        written::Extent::Point => flat(Outline::Point),
        written::Extent::Disk { radius } => flat(Outline::Disk { radius: radius.0 }),
        written::Extent::Annulus { inner, outer } => flat(Outline::Annulus { inner: inner.0, outer: outer.0 }),
        written::Extent::Polygon { radius, sides } => flat(Outline::Polygon { radius: radius.0, sides: *sides }),
        written::Extent::Rectangle { width, height } => flat(Outline::Rectangle { width: width.0, height: height.0 }),
        written::Extent::Gaussian { waist } => flat(Outline::Gaussian { waist: waist.0 }),
        written::Extent::Node { name, side } => {
            let nodes = assembly.matching(name);
            if nodes.is_empty() {
                shop.nothing_matches(&format!("{path}.extent"), name, &assembly.names());
                return None;
            }
            let curved = |node: &&usize| assembly.nodes[**node].exact.iter().any(|declared| !declared.shape.is_flat());
            if let Some(&node) = nodes.iter().find(curved) {
                let problem = format!(
                    "light starts from the facets of `{}`, not from its exact surface",
                    assembly.nodes[node].name
                );
                shop.fault(&format!("{path}.extent"), Problem::warning(problem));
            }
            mesh(assembly, &nodes, *side, beam).or_else(|| {
                shop.fault(&format!("{path}.extent"), Problem::error(format!("no face of `{name}` can emit that way")));
                None
            })
        }
        written::Extent::Cover { nodes, margin } => cover(shop, assembly, path, nodes, *margin, frame, beam),
    }
}

/// Emitting triangles; a collimated beam leaves each in proportion to its projected area.
fn mesh(assembly: &Assembly, nodes: &[usize], side: written::Side, beam: Option<DVec3>) -> Option<Extent> {
    let mut mesh = Mesh { triangles: Vec::new(), cumulative: Vec::new() };
    let mut total = 0.0;
    for (id, corners) in nodes.iter().flat_map(|&node| assembly.triangles_of(node)) {
        let area = 0.5 * (corners[1] - corners[0]).cross(corners[2] - corners[0]);
        for front in [true, false] {
            let shines = match side {
                written::Side::Both => true,
                written::Side::Front => front,
                written::Side::Back => !front,
            };
            let outward = if front { area } else { -area };
            let weight = beam.map_or(outward.length(), |beam| outward.dot(beam));
            if shines && weight > 0.0 {
                total += weight;
                mesh.triangles.push((id, corners, front));
                mesh.cumulative.push(total);
            }
        }
    }
    (total > 0.0).then_some(Extent::Mesh(mesh))
}

/// The smallest disc about the nodes' projected centre, across the beam and ahead of everything, that lights them all.
fn cover(
    shop: &mut Shop,
    assembly: &Assembly,
    path: &str,
    globs: &[String],
    margin: f64,
    frame: Frame,
    beam: Option<DVec3>,
) -> Option<Extent> {
    let mut points = Vec::new();
    for (i, glob) in globs.iter().enumerate() {
        let nodes = assembly.matching(glob);
        if nodes.is_empty() {
            shop.nothing_matches(&format!("{path}.extent.nodes[{i}]"), glob, &assembly.names());
        }
        points.extend(nodes.iter().flat_map(|&node| assembly.triangles_of(node)).flat_map(|(_, c)| c));
    }
    let frame = beam.map_or(frame, |beam| Frame::from_z_x(beam, frame.x));
    let flat = |v: &DVec3| DVec2::new(frame.x.dot(*v), frame.y.dot(*v));
    let (low, high) =
        points.iter().map(flat).fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(l, h), p| (l.min(p), h.max(p)));
    let middle = 0.5 * (low + high);
    let radius = points.iter().map(|p| (flat(p) - middle).length()).fold(0.0, f64::max);
    // Ahead of everything: a thousandth of the scene before its first point along the beam.
    let ahead = -1.001 * assembly.radius;
    (radius > 0.0).then(|| {
        let at = middle.x * frame.x + middle.y * frame.y + ahead * frame.z;
        Extent::Flat { frame, at, outline: Outline::Disk { radius: margin * radius } }
    })
}

/// Total flux, W. Irradiance is on a plane across the beam: times the area of the extent as the beam sees it.
fn flux(
    shop: &mut Shop,
    path: &str,
    written: &written::Source,
    extent: &Extent,
    frame: &Frame,
    beam: Option<DVec3>,
) -> Option<f64> {
    if let Some(flux) = written.flux {
        return Some(flux.0);
    }
    let irradiance = written.irradiance?.0;
    let projected = match (extent, beam) {
        // Weights of a mesh are projected already.
        (Extent::Flat { frame, .. }, Some(beam)) => extent.area() * frame.z.dot(beam).abs(),
        (Extent::Flat { .. }, None) if written.angular.is_sky() => extent.area(),
        (Extent::Mesh(_), Some(_)) => extent.area(),
        _ => {
            let problem = Problem::error("irradiance is that of a beam: this pattern has none");
            shop.fault(&format!("{path}.irradiance"), problem.expecting("flux: \"1 W\" here, or a collimated source"));
            return None;
        }
    };
    let _ = frame;
    if projected > 0.0 {
        return Some(irradiance * projected);
    }
    let problem = Problem::error("irradiance needs an extent with an area across the beam");
    shop.fault(&format!("{path}.irradiance"), problem.expecting("flux: \"1 W\" for a point"));
    None
}

fn spectrum(written: &written::Spectrum) -> Spectrum {
    match written {
        written::Spectrum::Line(wavelength) => Spectrum::Line(wavelength.0),
        written::Spectrum::Lines(lines) => {
            Spectrum::lines(&lines.iter().map(|(wavelength, power)| (wavelength.0, *power)).collect::<Vec<_>>())
        }
        written::Spectrum::Band { from, to } => Spectrum::table(&[(from.0, 1.0), (to.0, 1.0)]),
        written::Spectrum::Table { wavelength, weight } => {
            Spectrum::table(&wavelength.iter().map(|w| w.0).zip(weight.iter().copied()).collect::<Vec<_>>())
        }
        written::Spectrum::BlackBody { temperature, from, to } => Spectrum::black_body(temperature.0, from.0, to.0),
    }
}

fn stokes(written: written::Polarization) -> Stokes {
    match written {
        written::Polarization::Unpolarized => Stokes::unpolarised(1.0),
        written::Polarization::Linear { angle } => Stokes::linear(1.0, angle.0),
        written::Polarization::Circular(written::Handedness::Right) => Stokes::circular(1.0, Hand::Right),
        written::Polarization::Circular(written::Handedness::Left) => Stokes::circular(1.0, Hand::Left),
    }
}

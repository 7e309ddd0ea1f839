//! The elements of a system as a sequence of surfaces, for first-order data.
//!
//! Lenses and mirrors follow each other in the order in which the system names them; each must stand on the common axis. A lens
//! behind an odd number of mirrors is met from behind. The stop is the aperture called "stop", else the first one with a hole.

use crate::prescription::{Aperture, Curve, Field, FieldPoint, Material, Prescription, Profile, Surface, Term};
use crate::system::document::{Body, Element, Form, Names};
use crate::system::units::Coefficient;
use glam::DVec3;

/// What stands on the axis at a height.
struct Station {
    surface: Surface,
    /// m
    z: f64,
}

/// A sequence of surfaces and where it begins.
#[derive(Clone, Debug)]
pub struct Sequence {
    pub lens: Prescription,
    /// World z of its first vertex, m.
    pub start: f64,
}

/// The sequence, or why there is none; `None` without a lens or mirror. `field`: the greatest angle (rad) of the sources to the
/// axis; `wavelength` m.
pub fn sequence(elements: &Names<Element>, field: f64, wavelength: f64) -> Result<Option<Sequence>, String> {
    let optical = |body: &Body| matches!(body, Body::Lens { .. } | Body::Mirror { .. });
    let Some((_, first)) = elements.iter().find(|(_, element)| optical(&element.body)) else {
        return Ok(None);
    };
    let (at, turn) = (first.at.0, first.rotate.0);
    let mut stations: Vec<Station> = Vec::new();
    let (mut stop, mut named) = (None, false);
    let mut backward = false;
    for (name, element) in elements.iter() {
        let along = element.at.0 - at;
        // The axis is z of the first element: only unturned systems are followed.
        if !(optical(&element.body) || matches!(element.body, Body::Aperture { .. })) {
            continue;
        }
        if turn != DVec3::ZERO || element.rotate.0 != DVec3::ZERO || along.truncate().length() > 1e-12 {
            if optical(&element.body) {
                return Err(format!("`{name}` is turned or stands beside the axis of the first element"));
            }
            continue;
        }
        match &element.body {
            Body::Lens { surfaces, thickness, media, diameter } => {
                let mut heights = vec![element.at.0.z];
                thickness.iter().for_each(|t| heights.push(heights[heights.len() - 1] + t.0));
                let mut order: Vec<usize> = (0..surfaces.len()).collect();
                if backward {
                    order.reverse();
                }
                for (place, &i) in order.iter().enumerate() {
                    // The glass behind: of index i when met from the front, i - 1 from behind.
                    let glass = if backward { i.checked_sub(1) } else { Some(i) };
                    let medium = glass.and_then(|g| media.get(g)).filter(|_| place + 1 < order.len());
                    let material = medium.map_or(Material::Air, |m| Material::Glass { name: m.clone(), maker: None });
                    let size = surfaces[i].semi_diameter.or(diameter.map(|d| crate::system::units::Length(0.5 * d.0)));
                    let profile =
                        profile(&surfaces[i].form).ok_or_else(|| format!("`{name}` is no surface of revolution"))?;
                    let surface = Surface {
                        label: name.to_owned(),
                        profile,
                        material,
                        semi_diameter: size.map(|s| s.0),
                        ..Surface::plane()
                    };
                    stations.push(Station { surface, z: heights[i] });
                }
            }
            Body::Mirror { form, diameter, .. } => {
                let profile = profile(form).ok_or_else(|| format!("`{name}` is no surface of revolution"))?;
                let surface = Surface {
                    label: name.to_owned(),
                    profile,
                    material: Material::Mirror,
                    semi_diameter: Some(0.5 * diameter.0),
                    ..Surface::plane()
                };
                stations.push(Station { surface, z: element.at.0.z });
                backward = !backward;
            }
            Body::Aperture { diameter, .. }
                if diameter.0 > 0.0 && (name.to_lowercase().contains("stop") || stop.is_none()) && !named =>
            {
                named = name.to_lowercase().contains("stop");
                let surface =
                    Surface { label: name.to_owned(), semi_diameter: Some(0.5 * diameter.0), ..Surface::plane() };
                if let Some(old) = stop.replace(stations.len()) {
                    stations.remove(old);
                    stop = Some(stations.len());
                }
                stations.push(Station { surface, z: element.at.0.z });
            }
            _ => {}
        }
    }
    let start = stations.first().map_or(0.0, |station| station.z);
    Ok(Some(Sequence { lens: assemble(stations, stop, field, wavelength), start }))
}

fn assemble(stations: Vec<Station>, stop: Option<usize>, field: f64, wavelength: f64) -> Prescription {
    // Without a stop the first mirror or surface limits the beam.
    let stop = stop.unwrap_or(0);
    let radius = stations[stop].surface.semi_diameter.unwrap_or(1e-3);
    let heights: Vec<f64> = stations.iter().map(|station| station.z).collect();
    let mut surfaces = vec![Surface { thickness: f64::INFINITY, ..Surface::plane() }];
    for (i, station) in stations.into_iter().enumerate() {
        let thickness = heights.get(i + 1).map_or(0.0, |next| next - heights[i]);
        surfaces.push(Surface { thickness, ..station.surface });
    }
    surfaces.push(Surface::plane());
    Prescription {
        name: String::new(),
        surfaces,
        stop: Some(stop + 1),
        aperture: Aperture::Stop(radius),
        fields: vec![Field { point: FieldPoint::ObjectAngle([0.0, field]), vignetting: Default::default() }],
        wavelengths: vec![(wavelength, 1.0)],
        primary: 0,
        notes: Vec::new(),
    }
}

/// A form as a surface of revolution.
fn profile(form: &Form) -> Option<Profile> {
    let curve = |radius: Option<f64>, conic: f64, terms: &[(u32, Coefficient)]| {
        let terms = terms.iter().map(|(power, a)| Term { power: *power, coefficient: a.value }).collect();
        Some(Profile::Revolved(Curve { curvature: radius.map_or(0.0, |r| 1.0 / r), conic, terms }))
    };
    match form {
        Form::Plane => curve(None, 0.0, &[]),
        Form::Sphere { radius } => curve(Some(radius.0), 0.0, &[]),
        Form::Conic { radius, conic } => curve(Some(radius.0), *conic, &[]),
        Form::Asphere { radius, conic, terms } => curve(radius.map(|r| r.0), *conic, terms),
        Form::Polynomial { .. } | Form::Toroid { .. } | Form::Cylinder { .. } => None,
    }
}

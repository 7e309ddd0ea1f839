//! First-order data of the lenses and mirrors that are written as elements.

use crate::prescription::Prescription;
use crate::prescription::paraxial::{FirstOrder, first_order};
use crate::scene::Scene;
use crate::source::angular::Pattern;
use crate::system::document::Document;
use crate::system::lens::sequence;

/// The elements as a sequence, and where its paraxial rays go.
#[derive(Clone, Debug)]
pub struct Optics {
    /// Surfaces in the order of the light; labels are names of elements.
    pub lens: Prescription,
    pub first_order: FirstOrder,
    /// World z of the first vertex, m.
    pub start: f64,
}

/// A field angle for systems whose sources say none, rad.
const FIELD: f64 = 1.0 / 180.0 * std::f64::consts::PI;

/// `None` if no lens or mirror is written here; else the data, or why there are none.
pub(super) fn optics(scene: &Scene, document: &Document) -> Option<Result<Optics, String>> {
    let elements = &document.system.elements;
    let wavelength = scene.sources.first().map_or(550e-9, |source| source.spectrum.range().iter().sum::<f64>() / 2.0);
    let lens = match sequence(elements, field(scene), wavelength) {
        Ok(Some(sequence)) => sequence,
        Ok(None) => return None,
        Err(why) => return Some(Err(why)),
    };
    let medium = |name: &str| scene.media.iter().position(|filling| filling.label == name);
    let outside = scene.index(scene.ambient, wavelength).re;
    let index = |material: &crate::prescription::Material, wavelength: f64| match material {
        crate::prescription::Material::Glass { name, .. } => {
            medium(name).map(|medium| scene.index(medium as u16, wavelength).re / outside)
        }
        _ => Some(1.0),
    };
    let first = first_order(&lens.lens, &index).map_err(|problem| problem.message);
    Some(first.map(|first_order| Optics { lens: lens.lens, first_order, start: lens.start }))
}

/// Greatest angle of the collimated sources to the axis, rad.
fn field(scene: &Scene) -> f64 {
    let beams = scene.sources.iter().filter(|source| matches!(source.angular.pattern, Pattern::Collimated));
    let axes = beams
        .filter_map(|source| source.angular.frame())
        .map(|frame| frame.z.truncate().length().atan2(frame.z.z.abs()));
    let most = axes.fold(0.0, f64::max);
    if most > 0.0 { most } else { FIELD }
}

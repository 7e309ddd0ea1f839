//! One coating of a system for itself: what it is made of on both sides, between the media of its faces.

use super::coatings::{self, Faces};
use super::{Shop, build, media};
use crate::error::{Error, Problem, Severity, did_you_mean};
use crate::scene::Scene;
use crate::system::document::Document;
use num_complex::Complex64;
use std::sync::Arc;

/// A coating and the media around it, front first.
#[derive(Debug)]
pub struct Coated {
    /// For light that arrives at the front and at the back.
    pub faces: Faces,
    /// Names of the media in front and behind.
    pub names: [String; 2],
    media: [Arc<dyn crate::medium::Medium>; 2],
    /// Shortest and longest vacuum wavelength of the sources, m.
    pub light: [f64; 2],
    /// Vacuum wavelengths at which all data hold, m; `None`: any.
    pub range: Option<[f64; 2]>,
    pub warnings: Vec<Problem>,
}

impl Coated {
    /// Complex indices in front and behind at a vacuum wavelength (m).
    pub fn index(&self, wavelength: f64) -> [Complex64; 2] {
        [0, 1].map(|side| self.media[side].index(wavelength))
    }
}

/// Coating `name` of a system, between two media: those named, or those of the first face that has it.
///
/// # Errors
/// What is wrong with the system; [`Error::Usage`] if it has no such coating or medium.
pub fn coated(document: &Document, name: &str, between: Option<&[String; 2]>) -> Result<Coated, Error> {
    let known: Vec<&str> = document.system.coatings.names().collect();
    if !known.contains(&name) {
        return Err(unknown("coating", name, &known));
    }
    let (compiled, _) = build(document)?;
    let scene = &compiled.scene;
    let label = |medium: u16| scene.media[medium as usize].label.clone();
    let names = match between {
        Some(names) => names.clone(),
        None => place(scene, name).unwrap_or([scene.ambient; 2]).map(label),
    };
    let labels: Vec<&str> = scene.media.iter().map(|filling| filling.label.as_str()).collect();
    if let Some(missing) = names.iter().find(|name| !labels.contains(&name.as_str())) {
        return Err(unknown("medium", missing, &labels));
    }
    let mut shop = Shop::new(document, Vec::new());
    let fillings = media::media(&mut shop);
    let faces = coatings::coatings(&mut shop, &fillings).remove(name);
    let Some(faces) = faces.filter(|_| !shop.problems.iter().any(|p| p.severity == Severity::Error)) else {
        return Err(Error::Input(shop.problems));
    };
    let media = names.clone().map(|name| {
        let filling = fillings.iter().find(|filling| filling.label == name);
        filling.unwrap_or(&fillings[0]).medium.clone()
    });
    let ranges = media.iter().filter_map(|medium| medium.range()).chain(faces[0].range());
    let range = ranges.reduce(|a, b| [a[0].max(b[0]), a[1].min(b[1])]);
    let lights = scene.sources.iter().map(|source| source.spectrum.range());
    let light = lights.reduce(|a, b| [a[0].min(b[0]), a[1].max(b[1])]).unwrap_or([550e-9; 2]);
    Ok(Coated { faces, names, media, light, range, warnings: compiled.warnings })
}

/// Media in front of and behind the first part with this coating.
fn place(scene: &Scene, name: &str) -> Option<[u16; 2]> {
    let (alone, more) = (format!("coating {name}"), format!("coating {name} + "));
    let has = |surface: u32| {
        let label = &scene.surfaces[surface as usize].label;
        *label == alone || label.starts_with(&more)
    };
    let part = scene.parts.iter().find(|part| part.surface[0].iter().any(|&surface| has(surface)))?;
    Some(scene.sides(part))
}

fn unknown(noun: &str, name: &str, known: &[&str]) -> Error {
    let hint = match did_you_mean(name, known.iter().copied()) {
        Some(close) => format!("did you mean {close:?}?"),
        None if known.is_empty() => "it has none".to_owned(),
        None => format!("expected one of {}", known.join(", ")),
    };
    Error::Usage(format!("the system has no {noun} {name:?}; {hint}"))
}

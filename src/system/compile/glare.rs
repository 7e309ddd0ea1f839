//! Fields with a black patch: two sources that only a study of glare lights.

use super::Shop;
use super::assembly::Assembly;
use super::lights;
use super::sweep::watched;
use crate::detector::Detector;
use crate::source::Source;

/// A field with a black patch.
#[derive(Clone, Debug)]
pub struct Glare {
    pub label: String,
    /// The field without the patch, and the patch alone, both of the radiance 1 W/m2/sr.
    pub sources: [Source; 2],
    /// Index of the detector within the image of the patch.
    pub detector: usize,
}

/// Every field of the document.
pub fn glare(shop: &mut Shop, assembly: &Assembly, detectors: &[(Detector, Vec<usize>)]) -> Vec<Glare> {
    let document = shop.document;
    let mut all = Vec::new();
    for (name, written) in document.system.glare.iter() {
        let path = format!("glare[{name:?}]");
        let Some(detector) = watched(shop, &path, written.detector.as_deref(), detectors) else { continue };
        let [field, patch] = written.sources();
        let source = |shop: &mut Shop, part: &str, written| {
            lights::source(shop, assembly, (&path, &format!("{name} {part}")), written)
        };
        let Some(field) = source(shop, "field", &field) else { continue };
        let Some(patch) = source(shop, "patch", &patch) else { continue };
        all.push(Glare { label: name.into(), sources: [field, patch], detector });
    }
    all
}

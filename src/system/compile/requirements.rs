//! What is required of the stray light on detectors.

use super::Shop;
use super::sweep::watched;
use crate::detector::Detector;
use crate::system::document::Limit;

/// A limit on the stray light of a detector.
#[derive(Clone, Debug)]
pub struct Requirement {
    pub label: String,
    /// Index of the detector.
    pub detector: usize,
    pub limit: Limit,
    /// One-sided probability with which a verdict holds.
    pub confidence: f64,
}

/// Every requirement of the document.
pub fn requirements(shop: &mut Shop, detectors: &[(Detector, Vec<usize>)]) -> Vec<Requirement> {
    let document = shop.document;
    let mut all = Vec::new();
    for (name, written) in document.system.requirements.iter() {
        let wanted = written.detector.as_deref();
        let detector = match written.limit {
            Limit::StrayIrradiance(_) => watched(shop, &format!("requirements[{name:?}]"), wanted, detectors),
            _ => detectors.iter().position(|(detector, _)| wanted.is_none_or(|name| name == detector.label)),
        };
        let Some(detector) = detector else { continue };
        all.push(Requirement { label: name.into(), detector, limit: written.limit, confidence: written.confidence });
    }
    all
}

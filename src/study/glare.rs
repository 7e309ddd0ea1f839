//! Veiling glare index: how much light lies where the image of a black patch should be black.
//!
//!     VGI = E_field / (E_field + E_patch)
//!
//! E_field is the mean irradiance over a detector within the image of the patch, with the patch black; with E_patch, what the patch adds
//! when it is as bright as the field. Each is traced by itself: their errors are independent.
//!
//! Left out: the patch lies in the middle of the field.
//! Source: ISO 9358:1994, veiling glare index by the extended-source (black patch) method.

use crate::math::rng::mix;
use crate::scene::Scene;
use crate::settings::Settings;
use crate::system::compile::Glare;
use crate::tally::results::{Estimate, Results};
use crate::transport::{self, summary};
use std::collections::BTreeMap;
use std::sync::atomic::AtomicBool;

/// What a field with a black patch comes to.
#[derive(Clone, Debug)]
pub struct Index {
    pub name: String,
    pub detector: String,
    /// 0..1.
    pub index: Estimate,
    /// Mean irradiance on the detector for a radiance of 1 W/m2/sr, by the field around the patch and by the patch, W/m2.
    pub field_w_m2: Estimate,
    pub patch_w_m2: Estimate,
    /// The index by class of the light: all add up to it.
    pub classes: BTreeMap<String, Estimate>,
    /// Part of the index (0..1) that is the image of the field itself: it must not reach the detector.
    pub image: f64,
    /// Reasons not to trust it, in words.
    pub warnings: Vec<String>,
    pub trusted: bool,
}

/// Traces a field and its patch, with the rays of `settings` each. `None` if it was stopped.
pub fn index(scene: &mut Scene, glare: &Glare, settings: &Settings, stop: &AtomicBool) -> Option<Index> {
    let [field, patch] = [0, 1].map(|part: usize| one(scene, glare, part, settings, stop));
    let (field, patch) = (field?, patch?);
    let detector = &scene.detectors[glare.detector];
    let bins = detector.grid.shape().iter().product();
    let area: f64 = (0..bins).map(|bin| detector.grid.extent(bin)).sum();
    let scaled = |flux: Estimate, by: f64| Estimate { mean: flux.mean / by, error: flux.error / by };
    let seen = [&field, &patch].map(|results| &results.detectors[&detector.label]);
    let [f, p] = seen.map(|seen| scaled(seen.flux_w, area));
    let all = f.mean + p.mean;
    let image = scene.image().label(scene.has_optics);
    let image = seen[0].classes.get(&image).map_or(0.0, |flux| flux.mean / seen[0].flux_w.mean);
    let warnings: Vec<String> = [&field, &patch].into_iter().flat_map(|results| results.warnings.clone()).collect();
    Some(Index {
        name: glare.label.clone(),
        detector: detector.label.clone(),
        index: Estimate { mean: f.mean / all, error: (p.mean * f.error).hypot(f.mean * p.error) / (all * all) },
        field_w_m2: f,
        patch_w_m2: p,
        classes: seen[0].classes.iter().map(|(class, flux)| (class.clone(), scaled(*flux, area * all))).collect(),
        image,
        trusted: field.trusted && patch.trusted,
        warnings,
    })
}

/// One of the two sources by itself.
fn one(scene: &mut Scene, glare: &Glare, part: usize, settings: &Settings, stop: &AtomicBool) -> Option<Results> {
    let seed = mix(settings.seed ^ mix(0x676c_6172_6521 + part as u64));
    let settings = Settings { seed, until: None, paths: 0, ..settings.clone() };
    let all = std::mem::replace(&mut scene.sources, vec![glare.sources[part].clone()]);
    let counts = transport::run::<1>(scene, &settings, stop, &|_| ());
    let results = (!counts.interrupted && counts.sums.batches > 1)
        .then(|| summary::results(scene, &settings, &counts, 0, BTreeMap::new(), Vec::new()));
    scene.sources = all;
    results
}

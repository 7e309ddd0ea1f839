//! From slots to maps, and what detectors count in their own units.

use super::Teller;
use crate::filter::Filter;
use crate::scene::Scene;
use crate::tally::results::*;
use std::collections::BTreeMap;

/// A map of a detector on which there is no light, in watts.
pub fn empty_map(scene: &Scene, detector: usize) -> MapResult {
    let detector = &scene.detectors[detector];
    let grid = &detector.grid;
    let bins = grid.shape().iter().product();
    MapResult {
        detector: detector.label.clone(),
        filter: None,
        kind: grid.kind(),
        shape: grid.shape(),
        axes: grid.axes(),
        unit: grid.unit(),
        mean: vec![0.0; bins],
        error: vec![0.0; bins],
        rays: vec![0; bins],
        upper: vec![0.0; bins],
        extent: (0..bins).map(|bin| grid.extent(bin)).collect(),
        origin: (grid.origin() + scene.shift).to_array(),
        column_direction: grid.frame().x.to_array(),
        row_direction: grid.frame().y.to_array(),
        stray: None,
        side: detector.side.label(),
    }
}

impl<const V: usize> Teller<'_, V> {
    /// What the detector counts where that is not all watts.
    pub(super) fn counted(&self, d: usize) -> Option<CountedResult> {
        let response = &self.scene.detectors[d].response;
        let total = self.estimate(self.counts.layout.counted(d));
        (!response.is_flux()).then(|| CountedResult { unit: response.unit().into(), total })
    }

    pub(super) fn regions(&self, d: usize) -> BTreeMap<String, Estimate> {
        let regions = self.scene.detectors[d].regions.iter().enumerate();
        regions.map(|(r, region)| (region.label.clone(), self.estimate(self.counts.layout.region(d, r)))).collect()
    }

    /// Most that a watt of any source may count as.
    fn most(&self, d: usize) -> f64 {
        let steps = (0..=1000).map(|i| f64::from(i) / 1000.0);
        let response = &self.scene.detectors[d].response;
        let lights = self.scene.sources.iter().flat_map(|source| steps.clone().map(|u| source.spectrum.wavelength(u)));
        lights.map(|wavelength| response.of(wavelength)).fold(0.0, f64::max)
    }

    /// Brightest bin of a detector whose bins have these slots.
    pub(super) fn peak(&self, d: usize, slot: &dyn Fn(usize) -> usize) -> Peak {
        let detector = &self.scene.detectors[d];
        let [_, columns] = detector.grid.shape();
        let value = |bin: usize| {
            let extent = detector.extent(bin);
            let estimate = self.estimate(slot(bin));
            if extent > 0.0 { [estimate.mean / extent, estimate.error / extent] } else { [0.0; 2] }
        };
        let bins = 0..self.counts.layout.bins(d);
        let best = bins.max_by(|&a, &b| value(a)[0].total_cmp(&value(b)[0]).then(b.cmp(&a)));
        best.map_or(Peak::default(), |bin| {
            let [mean, error] = value(bin);
            Peak { mean, error, pixel: [bin / columns, bin % columns] }
        })
    }

    /// What every filter means of the light on a detector.
    pub(super) fn filters(&self, d: usize) -> Vec<FilterResult> {
        let layout = &self.counts.layout;
        let total = self.estimate(layout.detector(d)).mean;
        let result = |(number, filter): (usize, &Filter)| {
            let flux_w = self.estimate(layout.filter(d, number));
            let rays = self.sums().rays(layout.filter(d, number));
            let slot = |bin: usize| layout.filter_bin(d, number, bin);
            FilterResult {
                filter: filter.label.clone(),
                expression: filter.text.clone(),
                detector: self.scene.detectors[d].label.clone(),
                flux_w,
                percent: if total > 0.0 { 100.0 * flux_w.mean / total } else { 0.0 },
                rays,
                upper_limit_w: (rays == 0).then(|| self.upper()),
                open_w: self.estimate(layout.filter_open(d, number)),
                peak_w_m2: self.peak(d, &slot),
                map: MapResult { filter: Some(filter.label.clone()), ..self.map(d, &slot) },
            }
        };
        self.scene.filters.iter().enumerate().map(result).collect()
    }

    /// Map of all light on a detector, with that of the stray light alone.
    pub(super) fn stray_and_all(&self, d: usize) -> MapResult {
        MapResult { stray: self.stray_map(d), ..self.map(d, &|bin| self.counts.layout.bin(d, bin)) }
    }

    /// Map of a detector whose bins have these slots.
    fn map(&self, d: usize, slot: &dyn Fn(usize) -> usize) -> MapResult {
        let detector = &self.scene.detectors[d];
        let upper = self.upper() * self.most(d);
        let mut map = MapResult { unit: detector.unit(), ..empty_map(self.scene, d) };
        map.extent = (0..map.mean.len()).map(|bin| detector.extent(bin)).collect();
        for bin in 0..map.mean.len() {
            let slot = slot(bin);
            let extent = map.extent[bin];
            map.rays[bin] = self.sums().rays(slot);
            if extent > 0.0 {
                let estimate = self.estimate(slot);
                map.mean[bin] = estimate.mean / extent;
                map.error[bin] = estimate.error / extent;
                map.upper[bin] = if map.rays[bin] == 0 { upper / extent } else { 0.0 };
            }
        }
        map
    }

    /// Mean and error of stray light alone in every bin, where it is counted apart.
    fn stray_map(&self, d: usize) -> Option<[Vec<f64>; 2]> {
        let detector = &self.scene.detectors[d];
        let value = |bin: usize| {
            let estimate = self.estimate(self.counts.layout.stray_bin(d, bin)?);
            let extent = detector.extent(bin);
            Some(if extent > 0.0 { [estimate.mean / extent, estimate.error / extent] } else { [0.0; 2] })
        };
        let bins: Option<Vec<[f64; 2]>> = (0..self.counts.layout.bins(d)).map(value).collect();
        bins.map(|bins| [0, 1].map(|k| bins.iter().map(|bin| bin[k]).collect()))
    }
}

//! From slots to the table of paths.

use super::{Teller, label, sequence};
use crate::tally::layout::PATH_GRID;
use crate::tally::results::*;
use crate::transport::book::coarse_cell;

impl<const V: usize> Teller<'_, V> {
    /// Rows of one detector, brightest first, and what had no row.
    pub(super) fn paths(&self, d: usize) -> Vec<PathResult> {
        let total = self.estimate(self.counts.layout.detector(d)).mean;
        let areas = self.cell_areas(d);
        let rows = self.counts.rows.rows.iter().enumerate().filter(|(_, row)| row.detector == d);
        let mut paths: Vec<PathResult> = rows.filter_map(|(index, _)| self.path(index, total, &areas)).collect();
        paths.sort_by(|a, b| b.flux_w.mean.total_cmp(&a.flux_w.mean).then(a.sequence.cmp(&b.sequence)));
        let slot = self.counts.layout.other(d);
        let flux_w = self.estimate(slot);
        if flux_w.mean != 0.0 {
            paths.push(PathResult {
                detector: self.scene.detectors[d].label.clone(),
                source: String::new(),
                sequence: "other".into(),
                class: "mixed".into(),
                rays: self.sums().rays(slot),
                flux_w,
                percent: 100.0 * flux_w.mean / total,
                ghost_order: 0,
                scatter_order: 0,
                reflectors: Vec::new(),
                last_scatter: String::new(),
                optical_path_m: 0.0,
                peak_w_m2: 0.0,
                cells: Vec::new(),
            });
        }
        paths
    }

    fn path(&self, index: usize, total: f64, areas: &[f64]) -> Option<PathResult> {
        let layout = &self.counts.layout;
        let row = &self.counts.rows.rows[index];
        let flux_w = self.estimate(layout.row(index));
        // Other variants may have light on a path that this one has not.
        if flux_w.mean == 0.0 {
            return None;
        }
        let rays = self.sums().rays(layout.row(index));
        let density = |(slot, area): (usize, &f64)| if *area > 0.0 { self.estimate(slot).mean / area } else { 0.0 };
        let cells: Vec<f64> = layout.row_cells(index).zip(areas).map(density).collect();
        let source = self.scene.sources[row.source].label.clone();
        Some(PathResult {
            detector: self.scene.detectors[row.detector].label.clone(),
            sequence: sequence(self.scene, row),
            source,
            class: row.class.label(self.scene.has_optics),
            rays,
            flux_w,
            percent: 100.0 * flux_w.mean / total,
            ghost_order: row.ghosts as u32,
            scatter_order: row.scatters as u32,
            reflectors: row
                .steps
                .iter()
                .filter(|step| step.is_ghost())
                .map(|step| label(self.scene, step).into())
                .collect(),
            last_scatter: row.last_scatter.map_or(String::new(), |step| label(self.scene, &step).into()),
            optical_path_m: self.estimate(layout.row_path(index)).mean / flux_w.mean,
            peak_w_m2: cells.iter().copied().fold(0.0, f64::max),
            cells,
        })
    }

    /// Size of each cell of the coarse path grid, m2 or sr.
    fn cell_areas(&self, d: usize) -> Vec<f64> {
        let grid = &self.scene.detectors[d].grid;
        let mut areas = vec![0.0; PATH_GRID * PATH_GRID];
        for bin in 0..self.counts.layout.bins(d) {
            areas[coarse_cell(bin, grid.shape())] += grid.extent(bin);
        }
        areas
    }
}

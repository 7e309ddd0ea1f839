//! ghosts.csv and matrix.csv: units in the column names; numbers read back to the same bits.

use super::views;
use crate::study::ghost::{Ghost, Ghosts};
use crate::tally::results::Estimate;
use std::io::{self, Write};

const COLUMNS: [&str; 23] = [
    "detector",
    "source",
    "order",
    "surfaces",
    "flux_w",
    "flux_error_w",
    "relative",
    "relative_error",
    "rays",
    "upper_limit_w",
    "peak_w_m2",
    "peak_error_w_m2",
    "bin_m2",
    "centroid_x_m",
    "centroid_x_error_m",
    "centroid_y_m",
    "centroid_y_error_m",
    "rms_radius_m",
    "rms_radius_error_m",
    "width_m",
    "height_m",
    "focus_m",
    "focus_error_m",
];

/// One row per sequence, the light without reflections first.
pub fn rows(out: &mut impl Write, ghosts: &Ghosts) -> io::Result<()> {
    let mut table = csv::Writer::from_writer(out);
    table.write_record(COLUMNS)?;
    for ghost in ghosts.signals.iter().chain(&ghosts.ghosts) {
        table.write_record(row(ghost))?;
    }
    table.flush()
}

fn row(ghost: &Ghost) -> Vec<String> {
    let both = |value: Option<Estimate>| [number(value.map(|v| v.mean)), number(value.map(|v| v.error))];
    let bin = ghost.map.extent.get(ghost.peak_w_m2.pixel[0] * ghost.map.shape[1] + ghost.peak_w_m2.pixel[1]);
    let [x, y] = [0, 1].map(|axis| both(ghost.centroid_m.map(|centroid| centroid[axis])));
    let size = [0, 1].map(|axis| number(ghost.size_m.map(|size| size[axis])));
    let peak = Estimate { mean: ghost.peak_w_m2.mean, error: ghost.peak_w_m2.error };
    let names = [&ghost.detector, &ghost.source, &ghost.surfaces.len().to_string(), &ghost.surfaces.join(" > ")];
    let mut row: Vec<String> = names.map(String::clone).to_vec();
    row.extend(both(Some(ghost.flux_w)));
    row.extend(both(ghost.relative));
    row.extend([ghost.rays.to_string(), number(ghost.upper_limit_w)]);
    row.extend(both(Some(peak)));
    row.push(number(bin.copied()));
    row.extend(x.into_iter().chain(y).chain(both(ghost.rms_radius_m)).chain(size).chain(both(ghost.focus_m)));
    row
}

/// Flux by first (rows) and second (columns) surface; empty where light never takes that way.
pub fn matrix(out: &mut impl Write, ghosts: &Ghosts) -> io::Result<()> {
    let mut table = csv::WriterBuilder::new().flexible(true).from_writer(out);
    for view in views(ghosts) {
        let [first, second] = view.sides(ghosts);
        let heading = ["detector", "source", "flux_w: first surface, then by second surface"];
        table.write_record(heading.into_iter().chain(second.iter().copied()))?;
        for one in first {
            let flux = |other: &&str| number(view.pair(one, other).map(|ghost| ghost.flux_w.mean));
            let names = [view.detector, view.source, one].map(str::to_owned);
            table.write_record(names.into_iter().chain(second.iter().map(flux)))?;
        }
    }
    table.flush()
}

/// Shortest text that reads back to the same double; nothing for nothing.
fn number(value: Option<f64>) -> String {
    value.map(|value| format!("{value:e}")).unwrap_or_default()
}

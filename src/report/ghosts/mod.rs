//! Ghosts written down.
//!
//! ```text
//! ghosts.html       start here: which pair of surfaces makes how much, the worst ones as maps
//! ghosts.json       every number; the same bits on any number of threads, but for how the run went
//! ghosts.csv        one row per sequence of reflections, also those that deliver nothing
//! matrix.csv        flux by first and second surface
//! NAME.npy, .png    the map of each ghost that arrives
//! ```

mod table;
mod text;

pub use text::ghosts as text;

use super::write::{Folder, WriteError};
use super::{html, name, npy, picture};
use crate::study::ghost::{Ghost, Ghosts};
use crate::tally::results::{Estimate, RunInfo};
use serde::Serialize;
use std::io::Write;
use std::path::{Path, PathBuf};

#[derive(Serialize)]
struct Written<'a> {
    results: &'a Ghosts,
    run: &'a RunInfo,
}

/// Ghosts of one source on one detector.
pub struct View<'a> {
    pub detector: &'a str,
    pub source: &'a str,
    pub signal: Option<&'a Ghost>,
    /// Those that arrive, by falling flux.
    pub lit: Vec<&'a Ghost>,
    /// Those of which nothing arrives.
    pub dark: Vec<&'a Ghost>,
}

/// By detector and source, in their order.
pub fn views(ghosts: &Ghosts) -> Vec<View<'_>> {
    let mut views: Vec<View> = Vec::new();
    for ghost in ghosts.signals.iter().chain(&ghosts.ghosts) {
        let (detector, source) = (ghost.detector.as_str(), ghost.source.as_str());
        let at = views.iter().position(|view| view.detector == detector && view.source == source);
        let at = at.unwrap_or_else(|| {
            views.push(View { detector, source, signal: None, lit: Vec::new(), dark: Vec::new() });
            views.len() - 1
        });
        let view = &mut views[at];
        match (ghost.surfaces.is_empty(), ghost.rays > 0) {
            (true, _) => view.signal = Some(ghost),
            (false, true) => view.lit.push(ghost),
            (false, false) => view.dark.push(ghost),
        }
    }
    views
}

impl View<'_> {
    /// Largest limit on what the dark ones may still deliver, W.
    pub fn limit(&self) -> Option<f64> {
        self.dark.iter().filter_map(|ghost| ghost.upper_limit_w).reduce(f64::max)
    }

    /// The pair of a first and a second surface.
    pub fn pair(&self, first: &str, second: &str) -> Option<&Ghost> {
        self.lit.iter().chain(&self.dark).copied().find(|ghost| ghost.surfaces == [first, second])
    }

    /// First and second surfaces of all pairs, in the order of the study.
    pub fn sides<'a>(&self, ghosts: &'a Ghosts) -> [Vec<&'a str>; 2] {
        let pairs = || self.lit.iter().chain(&self.dark).filter(|ghost| ghost.surfaces.len() == 2);
        [0, 1].map(|side| {
            let there = |name: &&String| pairs().any(|ghost| ghost.surfaces[side] == **name);
            ghosts.surfaces.iter().filter(there).map(String::as_str).collect()
        })
    }
}

/// Writes everything into `dir` (made if missing) and returns the paths; `ghosts.json` comes last.
///
/// # Errors
/// The first file that could not be written; those before it stay.
pub fn write(dir: &Path, ghosts: &Ghosts, run: &RunInfo) -> Result<Vec<PathBuf>, WriteError> {
    let mut folder = Folder::new(dir)?;
    let lit: Vec<&Ghost> = ghosts.ghosts.iter().filter(|ghost| ghost.rays > 0).collect();
    let names: Vec<String> = lit.iter().map(|ghost| map_name(ghost)).collect();
    for (ghost, stem) in lit.iter().zip(name::stems(names.iter().map(String::as_str))) {
        folder.file(&format!("{stem}.npy"), |out| npy::write(out, ghost.map.shape, &ghost.map.mean))?;
        folder.file(&format!("{stem}.png"), |out| out.write_all(&picture::png(&ghost.map, &ghosts.system)?))?;
    }
    folder.file("ghosts.csv", |out| table::rows(out, ghosts))?;
    folder.file("matrix.csv", |out| table::matrix(out, ghosts))?;
    folder.file("ghosts.html", |out| out.write_all(html::ghosts(ghosts, run).as_bytes()))?;
    folder.file("ghosts.json", |out| {
        serde_json::to_writer_pretty(&mut *out, &Written { results: ghosts, run })?;
        out.write_all(b"\n")
    })?;
    Ok(folder.written)
}

/// Errors below this part of a value are not shown: its rays are all alike.
const ALIKE: f64 = 1e-6;

/// A value times `factor`, as it is shown.
pub fn shown(value: Estimate, factor: f64) -> Estimate {
    let error = if value.error < ALIKE * value.mean.abs() { 0.0 } else { factor * value.error };
    Estimate { mean: factor * value.mean, error }
}

fn map_name(ghost: &Ghost) -> String {
    format!("{}_{}_{}", ghost.detector, ghost.source, ghost.surfaces.join("_"))
}

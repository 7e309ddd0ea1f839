//! Everything a run leaves in its folder.

use super::{atomic, fits, html, name, npy, paths, picture, summary};
use crate::tally::results::{MapResult, Results, RunInfo};
use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

/// A result that could not be written, and why.
#[derive(Debug, thiserror::Error)]
#[error("{}: {source}", path.display())]
pub struct WriteError {
    pub path: PathBuf,
    pub source: io::Error,
}

/// Writes all files into `dir` (made if missing) and returns their paths. Each file appears as a whole; `summary.json` comes last, so
/// where it is new, everything is.
///
/// # Errors
/// The first file that could not be written; those before it stay.
pub fn write(dir: &Path, results: &Results, run: &RunInfo) -> Result<Vec<PathBuf>, WriteError> {
    let mut folder = Folder::new(dir)?;
    let maps: Vec<&MapResult> = results.maps.iter().chain(results.filters.iter().map(|filter| &filter.map)).collect();
    let names: Vec<String> = maps.iter().map(|map| map_name(map)).collect();
    let stems = name::stems(names.iter().map(String::as_str));
    for (map, stem) in maps.into_iter().zip(&stems) {
        folder.map(map, stem, results, run)?;
    }
    folder.file("paths.csv", |out| paths::write(out, &results.paths))?;
    folder.file("report.html", |out| out.write_all(html::page(results, run).as_bytes()))?;
    folder.file("summary.json", |out| summary::write(out, results, run))?;
    atomic::settle(dir);
    Ok(folder.written)
}

/// What the files of a map are called after: its detector, and the filter whose light it is.
fn map_name(map: &MapResult) -> String {
    map.filter.iter().fold(map.detector.clone(), |name, filter| format!("{name}_{filter}"))
}

/// A folder that files are written into.
pub(super) struct Folder<'a> {
    dir: &'a Path,
    pub written: Vec<PathBuf>,
}

impl Folder<'_> {
    /// The folder; made if it is not there.
    pub fn new(dir: &Path) -> Result<Folder<'_>, WriteError> {
        std::fs::create_dir_all(dir).map_err(|source| WriteError { path: dir.into(), source })?;
        Ok(Folder { dir, written: Vec::new() })
    }

    fn map(&mut self, map: &MapResult, stem: &str, results: &Results, run: &RunInfo) -> Result<(), WriteError> {
        self.file(&format!("{stem}.fits"), |out| {
            whole(map)?;
            fits::write(out, map, results, run)
        })?;
        self.file(&format!("{stem}.npy"), |out| npy::write(out, map.shape, &map.mean))?;
        self.file(&format!("{stem}_error.npy"), |out| npy::write(out, map.shape, &map.error))?;
        self.file(&format!("{stem}.png"), |out| out.write_all(&picture::png(map, &results.system)?))
    }

    /// Writes one file, as a whole or not at all.
    pub fn file(
        &mut self,
        name: &str,
        content: impl FnOnce(&mut BufWriter<&File>) -> io::Result<()>,
    ) -> Result<(), WriteError> {
        let path = self.dir.join(name);
        atomic::create(&path, content).map_err(|source| WriteError { path: path.clone(), source })?;
        self.written.push(path);
        Ok(())
    }
}

/// A map whose parts differ in size would make a file that lies about its shape.
fn whole(map: &MapResult) -> io::Result<()> {
    let bins = map.shape[0] * map.shape[1];
    let parts = [map.mean.len(), map.error.len(), map.rays.len(), map.upper.len(), map.extent.len()];
    if bins > 0 && parts.iter().all(|&part| part == bins) {
        return Ok(());
    }
    let message = format!("map of {:?}: {bins} bins, but parts of {parts:?}", map.detector);
    Err(io::Error::new(io::ErrorKind::InvalidData, message))
}

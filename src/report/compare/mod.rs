//! A comparison written down.
//!
//! ```text
//! compare.html      start here: bars, verdicts, what changed most
//! compare.json      every number; the same bits on any number of threads, but for how the run went
//! compare.csv       one row per variant, detector and quantity
//! NAME/             the report of each variant alone, with its maps: see `write`
//! ```

mod table;
mod text;

use super::write::{Folder, WriteError, write};
use super::{html, name};
use crate::study::compare::Comparison;
use crate::tally::results::RunInfo;
use serde::Serialize;
use std::io::Write;
use std::path::{Path, PathBuf};

pub use text::comparison as text;

#[derive(Serialize)]
struct Written<'a> {
    results: &'a Comparison,
    run: &'a RunInfo,
}

/// Folder of each variant's own report, in their order.
pub fn folders(comparison: &Comparison) -> Vec<String> {
    name::stems(comparison.variants.iter().map(|variant| variant.name.as_str()))
}

/// Writes everything into `dir` (made if missing) and returns the paths of the comparison itself; `compare.json` comes last.
///
/// # Errors
/// The first file that could not be written; those before it stay.
pub fn comparison(dir: &Path, comparison: &Comparison, run: &RunInfo) -> Result<Vec<PathBuf>, WriteError> {
    for (variant, folder) in comparison.variants.iter().zip(folders(comparison)) {
        write(&dir.join(folder), &variant.results, run)?;
    }
    let mut folder = Folder::new(dir)?;
    folder.file("compare.csv", |out| table::write(out, comparison))?;
    folder.file("compare.html", |out| out.write_all(html::comparison(comparison, run).as_bytes()))?;
    folder.file("compare.json", |out| {
        serde_json::to_writer_pretty(&mut *out, &Written { results: comparison, run })?;
        out.write_all(b"\n")
    })?;
    Ok(folder.written)
}

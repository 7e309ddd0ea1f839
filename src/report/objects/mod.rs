//! Critical and illuminated objects written down.
//!
//! ```text
//! objects.html      start here: what is seen, what is lit, what is both, what glows
//! objects.json      every number; the same bits on any number of threads, but for how the run went
//! objects.csv       one row per detector (or the sources), object and quantity
//! ```

mod table;
mod text;

use super::html;
use super::write::{Folder, WriteError};
use crate::study::objects::{Objects, Way};
use crate::tally::results::RunInfo;
use serde::Serialize;
use std::io::Write;
use std::path::{Path, PathBuf};

pub use text::objects as text;

#[derive(Serialize)]
struct Written<'a> {
    results: &'a Objects,
    run: &'a RunInfo,
}

/// A way in the words of a heading.
pub(super) fn heading(way: Way) -> &'static str {
    match way {
        Way::Direct => "direct",
        Way::Optics => "through optics",
        Way::Specular => "via ghosts",
        Way::Scatter => "via one scatter",
    }
}

/// Writes everything into `dir` (made if missing) and returns the paths; `objects.json` comes last.
///
/// # Errors
/// The first file that could not be written; those before it stay.
pub fn write(dir: &Path, objects: &Objects, run: &RunInfo) -> Result<Vec<PathBuf>, WriteError> {
    let mut folder = Folder::new(dir)?;
    folder.file("objects.csv", |out| table::write(out, objects))?;
    folder.file("objects.html", |out| out.write_all(html::objects(objects, run).as_bytes()))?;
    folder.file("objects.json", |out| {
        serde_json::to_writer_pretty(&mut *out, &Written { results: objects, run })?;
        out.write_all(b"\n")
    })?;
    Ok(folder.written)
}

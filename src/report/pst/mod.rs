//! Curves of point source transmittance, written down.
//!
//! ```text
//! pst.json          every number with its error, and how the run went
//! pst.csv           a row per direction
//! pst_NAME.svg      the curve of a sweep, and pst_NAME_sky.svg its directions as they stand in the sky
//! pst.html          all of it on one self-contained page
//! ```

mod csv_rows;
mod text;

pub use text::text;

use super::{WriteError, atomic, html, name};
use crate::study::pst::Sweeps;
use serde::Serialize;
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

/// How it went: differs from machine to machine.
#[derive(Clone, Debug, Serialize)]
pub struct Went {
    pub version: String,
    pub threads: usize,
    pub seconds: f64,
    pub host: String,
    /// True if it was told to stop; the rounds that were finished are in the results.
    pub interrupted: bool,
    /// The command line to repeat it.
    pub command: String,
}

#[derive(Serialize)]
struct Summary<'a> {
    results: &'a Sweeps,
    run: &'a Went,
}

/// Writes all files into `dir` (made if missing) and returns their paths, the page last.
///
/// # Errors
/// The first file that could not be written; those before it stay.
pub fn write(dir: &Path, sweeps: &Sweeps, went: &Went) -> Result<Vec<PathBuf>, WriteError> {
    std::fs::create_dir_all(dir).map_err(|source| WriteError { path: dir.into(), source })?;
    let mut written = Vec::new();
    let mut file = |name: &str, content: &dyn Fn(&mut dyn Write) -> io::Result<()>| {
        let path = dir.join(name);
        let made = atomic::create(&path, |out: &mut BufWriter<&std::fs::File>| content(out));
        made.map_err(|source| WriteError { path: path.clone(), source })?;
        written.push(path);
        Ok(())
    };
    let stems = name::stems(sweeps.curves.iter().map(|curve| &*curve.sweep));
    for (curve, stem) in sweeps.curves.iter().zip(&stems) {
        file(&format!("pst_{stem}.svg"), &|out| out.write_all(html::curve_picture(curve).as_bytes()))?;
        if let Some(sky) = html::sky_picture(curve) {
            file(&format!("pst_{stem}_sky.svg"), &|out| out.write_all(sky.as_bytes()))?;
        }
    }
    file("pst.csv", &|out| csv_rows::write(out, &sweeps.curves))?;
    file("pst.json", &|out| {
        serde_json::to_writer_pretty(&mut *out, &Summary { results: sweeps, run: went })?;
        out.write_all(b"\n")
    })?;
    file("pst.html", &|out| out.write_all(html::pst_page(sweeps, went).as_bytes()))?;
    atomic::settle(dir);
    Ok(written)
}

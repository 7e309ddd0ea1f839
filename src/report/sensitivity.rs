//! Sensitivities written down: which surface to improve first.
//!
//! ```text
//! sensitivity.csv      every derivative, by part and by finish
//! sensitivity.json     the same, and how the run went
//! ```

use super::digest;
use super::measured::{grouped, measured};
use super::write::{Folder, WriteError};
use crate::study::sensitivity::{Lever, Quantity, Sensitivity};
use crate::tally::results::RunInfo;
use serde::Serialize;
use std::fmt::{self, Write as _};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

/// Rows of each table on the terminal.
const LISTED: usize = 12;

#[derive(Serialize)]
struct Written<'a> {
    results: &'a Sensitivity,
    run: &'a RunInfo,
}

/// Writes both files into `dir` (made if missing) and returns their paths.
///
/// # Errors
/// The first file that could not be written.
pub fn write(dir: &Path, found: &Sensitivity, run: &RunInfo) -> Result<Vec<PathBuf>, WriteError> {
    let mut folder = Folder::new(dir)?;
    folder.file("sensitivity.csv", |out| table(out, found))?;
    folder.file("sensitivity.json", |out| {
        serde_json::to_writer_pretty(&mut *out, &Written { results: found, run })?;
        out.write_all(b"\n")
    })?;
    Ok(folder.written)
}

fn table(out: &mut impl Write, found: &Sensitivity) -> io::Result<()> {
    let mut table = csv::Writer::from_writer(out);
    table.write_record(["detector", "kind", "subject", "quantity", "derivative", "derivative_error"])?;
    for (detector, levers) in &found.detectors {
        for (kind, levers) in [("part", &levers.parts), ("finish", &levers.finishes)] {
            for lever in levers {
                let Lever { subject, quantity, derivative } = lever;
                let [mean, error] = [derivative.mean, derivative.error].map(|value| format!("{value:e}"));
                table.write_record([detector.as_str(), kind, subject, quantity.label(), &mean, &error])?;
            }
        }
    }
    table.flush()
}

/// The ranked lists for the terminal. Ends with a newline.
#[must_use]
pub fn text(found: &Sensitivity, run: &RunInfo) -> String {
    let mut out = String::new();
    // Writing into a String cannot fail.
    let _ = whole(&mut out, found, run);
    out
}

fn whole(out: &mut String, found: &Sensitivity, run: &RunInfo) -> fmt::Result {
    writeln!(out, "{}", found.system)?;
    write!(out, "{} source rays in {} batches, seed {}", grouped(found.rays, " "), found.batches, found.seed)?;
    writeln!(out, "; {:.1} s on {} threads", run.seconds, run.threads)?;
    if found.interrupted {
        writeln!(out, "interrupted: what was finished is below")?;
    }
    writeln!(out, "per cent less stray light for one per cent less reflectance (at fixed transmittance) or scatter")?;
    for (detector, levers) in &found.detectors {
        writeln!(out, "\n{detector}: {} W of stray light", measured(levers.stray_w.mean, levers.stray_w.error))?;
        if levers.uncounted > 1e-6 {
            let share = digest::measured_percent(levers.uncounted);
            writeln!(out, "  {share} of it came by paths too long to be counted to their end")?;
        }
        listed(out, "surface to improve first", &levers.parts)?;
        listed(out, "finish to improve first", &levers.finishes)?;
    }
    Ok(())
}

fn listed(out: &mut String, title: &str, levers: &[Lever]) -> fmt::Result {
    writeln!(out, "  {title}:")?;
    // Nobody improves a surface by what it passes; that is in the files.
    for lever in levers.iter().filter(|lever| lever.quantity != Quantity::Transmittance).take(LISTED) {
        let Lever { subject, quantity, derivative } = lever;
        let amount = measured(derivative.mean, derivative.error);
        writeln!(out, "    {amount:>20} %  {:<11}  {subject}", quantity.label())?;
    }
    Ok(())
}

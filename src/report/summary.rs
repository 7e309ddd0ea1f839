//! summary.json: `results` is the same bits for the same system, seed and rays; `run` is how this run went.

use crate::tally::results::{Results, RunInfo};
use serde::Serialize;
use std::io::{self, Write};

#[derive(Serialize)]
struct Summary<'a> {
    results: &'a Results,
    run: &'a RunInfo,
}

/// Writes both, indented; what is not a finite number is written as null.
pub fn write(out: &mut impl Write, results: &Results, run: &RunInfo) -> io::Result<()> {
    serde_json::to_writer_pretty(&mut *out, &Summary { results, run })?;
    out.write_all(b"\n")
}

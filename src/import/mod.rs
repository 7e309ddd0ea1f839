//! Readers of lens-design files: Zemax `.zmx`, CODE V `.seq`, ray-optics `.roa`, each to a [`Prescription`].
//!
//! A reader translates what it knows, to SI units. What changes the optics and is not known is refused, with its line; what is
//! beside them (coatings, optimisation, drawing) is either on the reader's written list of harmless words or becomes
//! a [`Note`](crate::prescription::Note): nothing is dropped in silence.

// A problem is large because it says much; it is made once, and ends the reading.
#![allow(clippy::result_large_err)]

mod codev;
mod decentre;
mod rayoptics;
mod row;
mod text;
mod zemax;

use crate::error::Problem;
use crate::prescription::{Prescription, Profile};
use std::path::Path;

/// Reads a lens file; what it is is decided by its content, then by its name. Fails with everything wrong with it.
pub fn read(path: &Path) -> Result<Prescription, Vec<Problem>> {
    let placed = |problems: Vec<Problem>| problems.into_iter().map(|p| p.in_file(path)).collect::<Vec<_>>();
    let bytes =
        std::fs::read(path).map_err(|error| placed(vec![Problem::error(format!("cannot be read: {error}"))]))?;
    let name = path.file_name().map(|n| n.to_string_lossy().into_owned()).unwrap_or_default();
    parse(&bytes, &name).map_err(placed)
}

/// Reads the content of a lens file called `name`. Fails with everything wrong with it.
pub fn parse(bytes: &[u8], name: &str) -> Result<Prescription, Vec<Problem>> {
    let text = text::decode(bytes).map_err(|problem| vec![problem])?;
    let first = text.split_whitespace().next().unwrap_or_default().to_ascii_uppercase();
    let first = first.split(';').next().unwrap_or_default();
    let ends = |extension: &str| name.to_ascii_lowercase().ends_with(extension);
    let lens = if first.starts_with('{') || ends(".roa") {
        rayoptics::parse(&text)?
    } else if ["VERS", "MODE", "UNIT"].contains(&first) || ends(".zmx") {
        zemax::parse(&text)?
    } else if ["RDM", "LEN"].contains(&first) || ends(".seq") {
        codev::parse(&text)?
    } else {
        let expected = "a Zemax .zmx, CODE V .seq or ray-optics .roa file";
        return Err(vec![Problem::error("is no lens file that is known here").expecting(expected)]);
    };
    let problems = contradictions(&lens);
    if problems.is_empty() { Ok(lens) } else { Err(problems) }
}

/// What no lens can be, whoever wrote it.
fn contradictions(lens: &Prescription) -> Vec<Problem> {
    let last = lens.surfaces.len().saturating_sub(1);
    let mut problems = Vec::new();
    let mut wrong = |i: usize, message: &str, expected: &str| {
        problems.push(Problem::error(message).on(format!("surface {i}")).expecting(expected));
    };
    if last < 2 {
        wrong(last, "the lens has no surface between object and image", "three surfaces or more");
    }
    if lens.stop.is_some_and(|stop| !(1..last).contains(&stop)) {
        wrong(lens.stop.unwrap_or_default(), "the stop lies outside of the lens", "a surface between object and image");
    }
    for (i, surface) in lens.surfaces.iter().enumerate() {
        if !surface.thickness.is_finite() && (i > 0 || surface.thickness != f64::INFINITY) {
            wrong(i, "an infinite thickness", "a length; only the object may be at infinity");
        }
        let curvature = match &surface.profile {
            Profile::Revolved(curve) | Profile::Toroid { curve, .. } => curve.curvature,
            Profile::Thin { power } => *power,
        };
        if !curvature.is_finite() {
            wrong(i, "a surface without radius", "a radius that is not 0");
        }
    }
    problems
}

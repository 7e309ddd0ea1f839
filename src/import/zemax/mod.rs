//! Zemax / OpticStudio sequential lens files (`.zmx`).
//!
//! A line is a four-letter key and its values. Lines of the system come first (`UNIT MM`, `ENPD 20`), then `SURF n` with its lines
//! indented, then operands of the merit function, tolerances and configurations.
//!
//! *Solves and pickups* (`CURV` and `PARM` with further values, `PZUP`, `PPAR`, `MAZH`): the file holds their last values
//! beside them; these are used.
//!
//! *Coordinate breaks* decentre along x and y and then turn about x, y and z, right-handed, each about the axes the one before
//! led to; with order flag 1, they turn about z, y, x and then decentre.
//!
//! Refused: non-sequential mode, surface types other than those in [`surface`], tilts in a surface's properties. Noted: several
//! configurations (the one saved is read), coatings, telecentric object space, temperatures other than 20 C at 1 atm.
//!
//! No published description of the format exists; the meaning of the keys follows the program's manual (Ansys Zemax OpticStudio User
//! Guide 2024 R2; "Tilt/Decenter" for the sense of tilts) and files written by it.

mod surface;
mod system;

use super::row::{Row, words};
use crate::error::Problem;
use crate::prescription::{Note, Prescription};
use surface::Raw;
use system::System;

/// Lines of the system that say nothing about the optics: version, language, drawing, ray aiming, polarisation and
/// physical-optics settings, names of other files, margins, the texts of notes, weights, catalogue data.
const HARMLESS: &str =
    "VERS PFIL LANG GFAC RAIM PUSH SDMA OMMA ROPD HYPR PICB POLS GLRS GSTD NSCD COFN NOTE FWGN FWGT DBDT";

/// Reads the text of a file.
pub fn parse(text: &str) -> Result<Prescription, Vec<Problem>> {
    let mut file = File { unit: unit(text)?, system: System::default(), surfaces: Vec::new(), notes: Vec::new() };
    let mut problems: Vec<Problem> = rows(text).filter_map(|(row, indented)| file.take(&row, indented).err()).collect();
    let built: Vec<_> = file.surfaces.iter().map(|raw| raw.build(&file.system.catalogs)).collect();
    let mut surfaces = Vec::new();
    for one in built {
        match one {
            Ok((surface, notes)) => {
                surfaces.push(surface);
                file.notes.extend(notes);
            }
            Err(problem) => problems.push(problem),
        }
    }
    if problems.is_empty() && surfaces.len() < 2 {
        problems.push(Problem::error("the file has no lens").expecting("`SURF 0`, `SURF 1`, ... with their lines"));
    }
    if !problems.is_empty() {
        return Err(problems);
    }
    let stop = file.surfaces.iter().position(|raw| raw.stop);
    file.notes.sort_by_key(|note| note.line);
    file.system.prescription(surfaces, file.unit, stop, file.notes).map_err(|problem| vec![problem])
}

/// What has been read.
struct File {
    /// Length of the file's unit, m.
    unit: f64,
    system: System,
    surfaces: Vec<Raw>,
    notes: Vec<Note>,
}

impl File {
    fn take(&mut self, row: &Row, indented: bool) -> Result<(), Problem> {
        let key = row.key();
        if key == "SURF" {
            let number = row.count(1, "the number of the surface")?;
            if number != self.surfaces.len() {
                return Err(row
                    .problem(format!("found surface {number}"))
                    .expecting(format!("surface {}", self.surfaces.len())));
            }
            self.surfaces.push(Raw::new(row.line(), self.unit));
            return Ok(());
        }
        if let Some(surface) = self.surfaces.last_mut()
            && surface.take(&key, row)?
        {
            return Ok(());
        }
        if self.system.take(&key, row, self.unit, &mut self.notes)?
            || HARMLESS.split_whitespace().any(|word| word == key)
        {
            return Ok(());
        }
        // Behind the surfaces, lines that are not indented are operands: they optimise and tolerance, they do not describe.
        if indented || self.surfaces.is_empty() {
            self.notes.push(row.note("not known here, not translated"));
        }
        Ok(())
    }
}

/// The lines that are not empty, and whether they are indented.
fn rows(text: &str) -> impl Iterator<Item = (Row, bool)> {
    (1..).zip(text.lines()).filter_map(|(number, line)| {
        let (words, _) = words(line, number, 1, &['"'], &[]);
        (!words.is_empty()).then(|| (Row { words }, line.starts_with([' ', '\t'])))
    })
}

/// Length of the file's unit, m.
fn unit(text: &str) -> Result<f64, Vec<Problem>> {
    let Some((row, _)) = rows(text).find(|(row, _)| row.key() == "UNIT") else {
        return Err(vec![Problem::error("the file does not say its unit").expecting("a line `UNIT MM ...`")]);
    };
    match row.word(1).unwrap_or_default().to_ascii_uppercase().as_str() {
        "MM" => Ok(1e-3),
        "CM" => Ok(1e-2),
        "IN" | "INCH" => Ok(0.0254),
        "M" | "METER" => Ok(1.0),
        other => Err(vec![row.problem(format!("no unit {other:?}")).expecting("MM, CM, IN or METER")]),
    }
}

#[cfg(test)]
mod tests;

//! CODE V sequence files (`.seq`).
//!
//! Commands are parted by line ends and `;`; their first three letters count; `!` starts a comment, `&` at the end of a line joins it to
//! the next. `SO`, `S` ... `SI` list the surfaces (curvature, or radius after `RDM Y`; thickness; glass); what follows belongs to
//! the last one, or to the one it names (`CIR S3 5`). Lengths in `DIM` (mm if not said), wavelengths in nm, angles in deg.
//!
//! *Pickups* (`PIK`) of curvatures and thicknesses are evaluated. *Solves*: `PIM` keeps the distance that stands in the
//! file and is refused if none does; others are refused. Thicknesses of 1e10 and more are infinite.
//!
//! *Decentres*: along x, y, z, then alpha and beta (left-handed) about x and y, then gamma (right-handed) about z. Axes stay moved; `DAR` returns
//! them behind the surface, `BEN` tilts them once more, `REV` does it backwards.
//!
//! Refused: global decentres and returns, surface types other than sphere, conic and asphere, gratings. Noted: zoom positions
//! (the first is read), real image heights (taken as paraxial), words not known.
//!
//! The program's manual is not public: the commands are those met in files that it wrote, and the sense of tilts is that
//! which ray-optics takes in them.

mod command;
mod glass;
mod surface;
mod system;

use super::row::Row;
use crate::error::Problem;
use crate::prescription::{Note, Prescription};
use surface::Raw;
use system::System;

/// Commands that say nothing about the optics: file and session, drawing, weights of fields, derivatives, which values vary.
const HARMLESS: &str =
    "LEN INI GO WTF CLS DER SPH BAS CCY CCX THC KC GLC AC BC CC DC EC FC GC HC JC XDC YDC ZDC ADC BDC CDC CUC";

/// Commands that change the optics and are not known here.
const REFUSED: &str =
    "SPS SPL DIF DOE GRT GRO GRS HOE HCT CYL CYX CYY XTO YTO AAS ANA FRN FRZ UDS NSS GRN GLB RET SCO ZRN XYP";

/// Reads the text of a file.
pub fn parse(text: &str) -> Result<Prescription, Vec<Problem>> {
    let rows = command::rows(text);
    let unit = system::unit(&rows).map_err(|problem| vec![problem])?;
    let mut file = File { unit, system: System::default(), surfaces: Vec::new(), current: 0, notes: Vec::new() };
    let mut problems: Vec<Problem> = rows.iter().filter_map(|row| file.take(row).err()).collect();
    let mut surfaces = Vec::new();
    for raw in &file.surfaces {
        match raw.build(unit, &file.system.glasses) {
            Ok(surface) => surfaces.push(surface),
            Err(problem) => problems.push(problem),
        }
    }
    if problems.is_empty() && !file.surfaces.last().is_some_and(|raw| raw.image) {
        problems.push(Problem::error("the file ends before the image").expecting("`SO`, `S` ... and `SI`"));
    }
    if !problems.is_empty() {
        return Err(problems);
    }
    let stop = file.surfaces.iter().position(|raw| raw.stop);
    file.notes.sort_by_key(|note| note.line);
    file.system.prescription(surfaces, stop, unit, file.notes).map_err(|problem| vec![problem])
}

/// What has been read, surfaces in the file's unit.
struct File {
    /// m.
    unit: f64,
    system: System,
    surfaces: Vec<Raw>,
    /// The surface that commands without a surface belong to.
    current: usize,
    notes: Vec<Note>,
}

impl File {
    fn take(&mut self, row: &Row) -> Result<(), Problem> {
        let key = command::key(row);
        if self.system.in_private_glasses() {
            return self.system.private_glass(row);
        }
        if self.system.take(&key, row, self.unit, &mut self.notes)? {
            return Ok(());
        }
        if let Some(number) = surface::number(&key, self.surfaces.len()) {
            return self.begin(number, row);
        }
        if key == "PIK" {
            return self.pick_up(row);
        }
        if REFUSED.split_whitespace().any(|word| word == key) {
            let expected = "spheres, conics (CON), aspheres (ASP) and local decentres";
            return Err(row.problem(format!("{key} is not known here")).expecting(expected));
        }
        let target = row.word(1).and_then(|word| self.named(word));
        let at = target.unwrap_or(self.current);
        let known = match self.surfaces.get_mut(at) {
            Some(surface) => surface.take(&key, row, if target.is_some() { 2 } else { 1 }, &mut self.notes)?,
            None => false,
        };
        if !known && !HARMLESS.split_whitespace().any(|word| word == key) {
            self.notes.push(row.note("not known here, not translated"));
        }
        Ok(())
    }

    /// The surface that a word names: `SO`, `S3`, or `SI` for the last.
    fn named(&self, word: &str) -> Option<usize> {
        let (word, count) = (word.to_ascii_uppercase(), self.surfaces.len());
        let back = usize::from(word == "SI" && self.surfaces.last().is_some_and(|last| last.image));
        surface::number(&word, count).map(|n| n - back).filter(|n| *n < count)
    }

    /// `S curvature thickness glass`: a new surface, or new values of one.
    fn begin(&mut self, number: usize, row: &Row) -> Result<(), Problem> {
        if number > self.surfaces.len() {
            return Err(row.problem(format!("surface {number} follows surface {}", self.surfaces.len())));
        }
        if number == self.surfaces.len() {
            if self.surfaces.last().is_some_and(|last| last.image) {
                return Err(row.problem("a surface behind the image"));
            }
            self.surfaces.push(Raw::new(row));
        }
        self.current = number;
        self.surfaces[number].values(row, self.system.radii)
    }

    /// `PIK THI S3 Z1 THI S2 Z1 scale offset`
    fn pick_up(&mut self, row: &Row) -> Result<(), Problem> {
        let words: Vec<String> = row.words[1..].iter().map(|w| w.text.to_ascii_uppercase()).collect();
        let zoom =
            |word: &String| word.len() > 1 && word.starts_with('Z') && word[1..].chars().all(|c| c.is_ascii_digit());
        let words: Vec<&String> = words.iter().filter(|word| !zoom(word)).collect();
        let surface = |i: usize| words.get(i).and_then(|word| self.named(word));
        let (Some(to), Some(from)) = (surface(1), surface(3)) else {
            return Err(row.problem("a pickup without surfaces").expecting("`PIK THI S3 THI S2 -1`"));
        };
        let factor = |i: usize, default: f64| words.get(i).map_or(Some(default), |word| word.parse::<f64>().ok());
        let (Some(scale), Some(offset)) = (factor(4, 1.0), factor(5, 0.0)) else {
            return Err(row.problem("a pickup whose scale or offset is no number").expecting("`PIK THI S3 THI S2 -1`"));
        };
        match (words[0].as_str(), words[2].as_str()) {
            ("THI", "THI") => self.surfaces[to].thickness = scale * self.surfaces[from].thickness + offset,
            ("CUY", "CUY") => self.surfaces[to].curve.curvature = scale * self.surfaces[from].curve.curvature + offset,
            ("RDY", "RDY") => {
                let radius = scale / self.surfaces[from].curve.curvature + offset;
                self.surfaces[to].curve.curvature = 1.0 / radius;
            }
            _ => self.notes.push(row.note("the value that stands in the file is used")),
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests;

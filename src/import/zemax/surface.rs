//! One surface of a `.zmx` file.
//!
//! | `TYPE` | is | `PARM n` |
//! |---|---|---|
//! | `STANDARD` | conic | |
//! | `EVENASPH` | conic + sum of PARM n r^2n | 1 to 8 |
//! | `ODDASPHE` | conic + sum of PARM n r^n | 1 to 8 |
//! | `XASPHERE`, `XOSPHERE` | conic + sum of XDAT (n+2) (r/R)^2n or (r/R)^n, n up to XDAT 1, R = XDAT 2 | |
//! | `TOROIDAL` | the y-z curve, conic + sum of PARM n y^(2n-2), turned at PARM 1 (0: cylinder) | 2 to 8 |
//! | `PARAXIAL` | ideal thin lens of focal length PARM 1 | |
//! | `COORDBRK` | axes that move: decentre x, y (1, 2), tilt x, y, z in deg (3, 4, 5), order (6) | |
//!
//! Source: Ansys Zemax OpticStudio User Guide 2024 R2, "Standard", "Even Asphere", "Odd Asphere", "Extended Asphere", "Toroidal", "Paraxial",
//! "Coordinate Break".

use super::super::row::Row;
use crate::error::{Problem, Span};
use crate::prescription::{Curve, Material, Motion, Note, Opening, Outline, Profile, Role, Surface, Term};
use glam::{DMat3, DVec3};
use std::collections::BTreeMap;

/// Lines that say nothing about the optics: drawing, the substrate behind a mirror, names of surfaces, variables, solves and
/// pickups whose last values stand in their places, physical-optics settings, margins.
const HARMLESS: &str = "HIDE MIRR SLAB VDSZ VPAR VCON PPAR PZUP PKUP MAZH EDGE POPS FIMP OEMA SCOL";

const TYPES: &str = "STANDARD, EVENASPH, ODDASPHE, XASPHERE, XOSPHERE, TOROIDAL, PARAXIAL or COORDBRK";

/// A surface as it is written; lengths in m but for the numbered parameters.
pub struct Raw {
    line: u32,
    unit: f64,
    kind: String,
    curve: Curve,
    /// `PARM` and `XDAT` by their numbers.
    parameters: BTreeMap<usize, f64>,
    extra: BTreeMap<usize, f64>,
    glass: Option<Material>,
    surface: Surface,
    /// Centre of all openings, m.
    centre: [f64; 2],
    notes: Vec<Note>,
    pub stop: bool,
}

impl Raw {
    pub fn new(line: u32, unit: f64) -> Raw {
        Raw {
            line,
            unit,
            kind: "STANDARD".to_owned(),
            curve: Curve::default(),
            parameters: BTreeMap::new(),
            extra: BTreeMap::new(),
            glass: None,
            surface: Surface::plane(),
            centre: [0.0; 2],
            notes: Vec::new(),
            stop: false,
        }
    }

    /// Takes a line; false if it is none of a surface's.
    pub fn take(&mut self, key: &str, row: &Row) -> Result<bool, Problem> {
        match key {
            "TYPE" => self.kind = row.word(1).unwrap_or_default().to_ascii_uppercase(),
            "COMM" => self.surface.label = row.rest(),
            "CURV" => self.curve.curvature = row.number(1, "a curvature")? / self.unit,
            "CONI" => self.curve.conic = row.number(1, "a conic constant")?,
            "DISZ" => self.surface.thickness = self.distance(row)?,
            "GLAS" => self.glass = Some(glass(row, &mut self.notes)?),
            "STOP" => self.stop = true,
            "DIAM" => self.surface.semi_diameter = Some(self.length(row, 1)?).filter(|r| *r > 0.0),
            "PARM" => {
                self.parameters.insert(row.count(1, "the number of a parameter")?, row.number(2, "its value")?);
            }
            "XDAT" => {
                self.extra.insert(row.count(1, "the number of a parameter")?, row.number(2, "its value")?);
            }
            "SCBD" if (4..row.words.len()).all(|i| row.number(i, "").is_ok_and(|v| v == 0.0)) => (),
            "SCBD" => {
                let hint = "use coordinate breaks instead of tilts in the surface's properties".to_owned();
                return Err(row.problem("a tilt in the surface's properties").expecting("zeros").hinting(hint));
            }
            "COAT" | "UDAD" | "SPID" => self.notes.push(row.note("not translated")),
            "OBDC" => self.centre = [self.length(row, 1)?, self.length(row, 2)?],
            "MEMA" | "CLAP" | "FLAP" | "OBSC" | "SQAP" | "SQOB" | "ELAP" | "ELOB" => self.opening(key, row)?,
            "IGNR" if row.number_or_zero(1, "1 if the surface is ignored")? != 0.0 => {
                return Err(row.problem("an ignored surface").hinting("remove it in the design program".to_owned()));
            }
            "IGNR" => (),
            _ => return Ok(HARMLESS.split_whitespace().any(|word| word == key)),
        }
        Ok(true)
    }

    /// A length, m.
    fn length(&self, row: &Row, i: usize) -> Result<f64, Problem> {
        Ok(row.number(i, "a length")? * self.unit)
    }

    /// `DISZ 5` or `DISZ INFINITY`, m.
    fn distance(&self, row: &Row) -> Result<f64, Problem> {
        if row.word(1).is_some_and(|word| word.eq_ignore_ascii_case("INFINITY")) {
            return Ok(f64::INFINITY);
        }
        let written = row.number(1, "a distance, or INFINITY")?;
        Ok(if written >= 1e10 { f64::INFINITY } else { written * self.unit })
    }

    /// Rims and masks. A circle's two radii bound a ring.
    fn opening(&mut self, key: &str, row: &Row) -> Result<(), Problem> {
        let (a, b) = (self.length(row, 1)?, row.number_or_zero(2, "a length")? * self.unit);
        let mut add = |role, outline| self.surface.openings.push(Opening { role, outline, centre: [0.0; 2] });
        match key {
            "MEMA" if a > 0.0 => add(Role::Edge, Outline::Circle(a)),
            "MEMA" => (),
            "CLAP" | "FLAP" => {
                add(Role::Clear, Outline::Circle(b));
                if a > 0.0 {
                    add(Role::Obscured, Outline::Circle(a));
                }
            }
            "OBSC" if a == 0.0 => add(Role::Obscured, Outline::Circle(b)),
            "OBSC" => self.notes.push(row.note("a ring that is obscured is not translated")),
            "SQAP" => add(Role::Clear, Outline::Rectangle(a, b)),
            "SQOB" => add(Role::Obscured, Outline::Rectangle(a, b)),
            "ELAP" => add(Role::Clear, Outline::Ellipse(a, b)),
            _ => add(Role::Obscured, Outline::Ellipse(a, b)),
        }
        Ok(())
    }

    /// The surface and what of it was not translated. `catalogs` are those the file names; one alone is every glass's maker.
    pub fn build(&self, catalogs: &[String]) -> Result<(Surface, Vec<Note>), Problem> {
        let mut surface = self.surface.clone();
        surface.openings.iter_mut().filter(|o| o.role != Role::Edge).for_each(|opening| opening.centre = self.centre);
        surface.material = self.glass.clone().unwrap_or(Material::Air);
        if let (Material::Glass { maker, .. }, [one]) = (&mut surface.material, catalogs) {
            *maker = Some(one.clone());
        }
        // Row 2 of XDAT is a radius without meaning of its own.
        if !self.kind.ends_with("SPHERE") && self.extra.iter().any(|(n, value)| *n != 2 && *value != 0.0) {
            let problem = self.problem(format!("a surface {} with further terms (XDAT)", self.kind));
            return Err(problem.expecting(format!("{TYPES}; XDAT with XASPHERE and XOSPHERE only")));
        }
        let mut left = self.parameters.clone();
        let mut parameter = |n: usize| left.remove(&n).unwrap_or_default();
        surface.profile = match self.kind.as_str() {
            "STANDARD" => Profile::Revolved(self.curve.clone()),
            "EVENASPH" => Profile::Revolved(self.with_terms((1..=8).map(|n| (2 * n, parameter(n as usize))))),
            "ODDASPHE" => Profile::Revolved(self.with_terms((1..=8).map(|n| (n, parameter(n as usize))))),
            "XASPHERE" => Profile::Revolved(self.extended(2)?),
            "XOSPHERE" => Profile::Revolved(self.extended(1)?),
            "TOROIDAL" => {
                let radius = parameter(1) * self.unit;
                let curve = self.with_terms((2..=8).map(|n| (2 * n - 2, parameter(n as usize))));
                Profile::Toroid { curve, radius: if radius == 0.0 { f64::INFINITY } else { radius } }
            }
            "PARAXIAL" => {
                let power = 1.0 / (parameter(1) * self.unit);
                parameter(2); // how the program computes path lengths
                if !power.is_finite() {
                    return Err(self.problem("an ideal lens without focal length").expecting("`PARM 1` not 0"));
                }
                Profile::Thin { power }
            }
            "COORDBRK" => {
                surface.material = Material::Previous;
                surface.before = self.coordinate_break([1, 2, 3, 4, 5, 6].map(&mut parameter));
                Profile::sphere(0.0)
            }
            other => return Err(self.problem(format!("no surface type {other:?} here")).expecting(TYPES)),
        };
        let mut notes = self.notes.clone();
        let unused = left.iter().filter(|(_, value)| **value != 0.0);
        notes.extend(unused.map(|(n, value)| Note {
            line: Some(self.line),
            text: format!("PARM {n} {value}: the surface type {} has no such parameter", self.kind),
        }));
        Ok((surface, notes))
    }

    /// The curve with polynomial terms: powers and coefficients in powers of the file's unit.
    fn with_terms(&self, terms: impl Iterator<Item = (u32, f64)>) -> Curve {
        let scaled = terms
            .filter(|(_, a)| *a != 0.0)
            .map(|(power, coefficient)| Term { power, coefficient: coefficient * self.unit.powi(1 - power as i32) });
        Curve { terms: scaled.collect(), ..self.curve.clone() }
    }

    /// `XDAT`: number of terms, radius R, coefficients (lengths) of (r/R)^step, (r/R)^(2 step) ...
    fn extended(&self, step: u32) -> Result<Curve, Problem> {
        let value = |n: usize| self.extra.get(&n).copied().unwrap_or_default();
        let (count, radius) = (value(1), value(2));
        if !(0.0..=240.0).contains(&count) || (count > 0.0 && radius <= 0.0) {
            let expected = "up to 240 terms (XDAT 1) and a radius above 0 (XDAT 2)";
            return Err(self.problem(format!("{count} terms over a radius of {radius}")).expecting(expected));
        }
        let term = |n: u32| (n * step, value(n as usize + 2) / radius.powi((n * step) as i32));
        Ok(self.with_terms((1..=count as u32).map(term)))
    }

    fn coordinate_break(&self, [x, y, alpha, beta, gamma, order]: [f64; 6]) -> Motion {
        let shift = Motion::shift(DVec3::new(x, y, 0.0) * self.unit);
        let [alpha, beta, gamma] = [alpha, beta, gamma].map(f64::to_radians);
        if order == 0.0 {
            return shift.then(Motion::turn(DVec3::new(alpha, beta, gamma)));
        }
        let turn = DMat3::from_rotation_z(gamma) * DMat3::from_rotation_y(beta) * DMat3::from_rotation_x(alpha);
        Motion { shift: DVec3::ZERO, turn }.then(shift)
    }

    fn problem(&self, message: impl Into<String>) -> Problem {
        Problem::error(message).at(Span { line: self.line, column: 1, len: 0 })
    }
}

/// `GLAS name kind pickup nd vd ...`; kind 1 is a model glass.
fn glass(row: &Row, notes: &mut Vec<Note>) -> Result<Material, Problem> {
    let name = row.word(1).unwrap_or_default();
    if name.is_empty() {
        return Err(row.problem("a glass without name").expecting("`GLAS N-BK7 ...`"));
    }
    if name.eq_ignore_ascii_case("MIRROR") {
        return Ok(Material::Mirror);
    }
    let model = row.number_or_zero(2, "the kind of glass")? == 1.0 || name == "___BLANK";
    if !model {
        return Ok(Material::Glass { name: name.to_owned(), maker: None });
    }
    let (nd, vd) = (row.number(4, "an index")?, row.number_or_zero(5, "an Abbe number")?);
    if nd < 1.0 {
        return Err(row.problem(format!("an index of {nd}")).at(row.words[4].span).expecting("1 or more"));
    }
    if row.number_or_zero(6, "a partial dispersion")? != 0.0 {
        notes.push(row.note("the deviation of the partial dispersion is not translated"));
    }
    Ok(Material::Model { nd, vd: if vd == 0.0 { f64::INFINITY } else { vd } })
}

//! One surface of a sequence file.

use super::super::decentre::{self, Axes};
use super::super::row::Row;
use super::glass;
use crate::error::{Problem, Span};
use crate::prescription::{Curve, Note, Opening, Outline, Profile, Role, Surface, Term};

/// A surface as it is written, in the file's unit.
pub struct Raw {
    span: Span,
    label: String,
    pub curve: Curve,
    pub thickness: f64,
    glass: Option<String>,
    openings: Vec<Opening>,
    /// x, y, z; alpha, beta, gamma in deg.
    decentre: [f64; 6],
    axes: Axes,
    pub stop: bool,
    /// True for `SI`.
    pub image: bool,
    /// The distance behind it is solved for by the program.
    solved: bool,
}

/// The number of the surface that a word begins in a lens with `count` of them so far: `SO`, `S` and `SI` (the next), `S3`.
pub fn number(word: &str, count: usize) -> Option<usize> {
    match word {
        "SO" => Some(0),
        "S" | "SI" => Some(count),
        _ => word.strip_prefix('S').filter(|digits| digits.len() < 5)?.parse().ok(),
    }
}

impl Raw {
    pub fn new(row: &Row) -> Raw {
        Raw {
            span: row.words[0].span,
            label: String::new(),
            curve: Curve::default(),
            thickness: 0.0,
            glass: None,
            openings: Vec::new(),
            decentre: [0.0; 6],
            axes: Axes::Stay,
            stop: false,
            image: row.key() == "SI",
            solved: false,
        }
    }

    /// `S curvature thickness glass`; a radius instead if `radii`.
    pub fn values(&mut self, row: &Row, radii: bool) -> Result<(), Problem> {
        if row.words.len() > 1 {
            let value = row.number(1, "a curvature or radius")?;
            self.curve.curvature = if radii && value != 0.0 { 1.0 / value } else { value };
        }
        if row.words.len() > 2 {
            self.thickness = row.number(2, "a thickness")?;
        }
        if let Some(glass) = row.word(3) {
            self.glass = Some(glass.to_owned());
        }
        Ok(())
    }

    /// Takes a command whose value is word `i`; false if it is none of a surface's.
    pub fn take(&mut self, key: &str, row: &Row, i: usize, notes: &mut Vec<Note>) -> Result<bool, Problem> {
        let value = |what: &str| row.number(i, what);
        match key {
            "STO" => self.stop = true,
            "CON" | "ASP" => (),
            "K" => self.curve.conic = value("a conic constant")?,
            "A" | "B" | "C" | "D" | "E" | "F" | "G" | "H" | "J" => self.term(key, value("a coefficient")?),
            "CUY" => self.curve.curvature = value("a curvature (solves are not evaluated)")?,
            "RDY" => self.curve.curvature = reciprocal(value("a radius (solves are not evaluated)")?),
            "THI" => self.thickness = value("a thickness (solves are not evaluated)")?,
            "GLA" => self.glass = row.word(i).map(str::to_owned),
            "RMD" => self.glass = row.word(i).filter(|word| word.eq_ignore_ascii_case("REFL")).map(str::to_owned),
            "SLB" => self.label = row.word(i).unwrap_or_default().to_owned(),
            "PIM" => self.solved = true,
            "XDE" => self.decentre[0] = value("a decentre")?,
            "YDE" => self.decentre[1] = value("a decentre")?,
            "ZDE" => self.decentre[2] = value("a decentre")?,
            "ADE" => self.decentre[3] = value("a tilt")?,
            "BDE" => self.decentre[4] = value("a tilt")?,
            "CDE" => self.decentre[5] = value("a tilt")?,
            "DAR" => self.axes = Axes::Return,
            "BEN" => self.axes = Axes::Bend,
            "REV" => self.axes = Axes::Reverse,
            "CIR" | "REX" | "REY" | "ELX" | "ELY" | "ADX" | "ADY" => self.opening(key, row, i)?,
            "ARO" | "CUM" | "THM" => notes.push(row.note("not translated")),
            _ => return Ok(false),
        }
        Ok(true)
    }

    /// A r^4, B r^6 ... H r^18, J r^20.
    fn term(&mut self, key: &str, coefficient: f64) {
        let order = "ABCDEFGHJ".find(key).unwrap_or_default() as u32;
        self.curve.terms.retain(|term| term.power != 4 + 2 * order);
        self.curve.terms.push(Term { power: 4 + 2 * order, coefficient });
    }

    /// `CIR OBS L'A' 0.38`: what it bounds, a name that is left out, a length.
    fn opening(&mut self, key: &str, row: &Row, i: usize) -> Result<(), Problem> {
        let named = |word: &str| row.words[i..].iter().any(|w| w.text.eq_ignore_ascii_case(word));
        let role = match () {
            () if named("OBS") => Role::Obscured,
            () if named("HOL") => Role::Hole,
            () if named("EDG") => Role::Edge,
            () => Role::Clear,
        };
        let value = row.number((row.words.len() - 1).max(i), "a length")?;
        if let "ADX" | "ADY" = key {
            let last = self.openings.iter_mut().rfind(|o| o.role == role);
            let last = last
                .ok_or_else(|| row.problem("an offset without an opening").expecting("`CIR`, `REX` or `ELX` before"))?;
            last.centre[usize::from(key == "ADY")] = value;
            return Ok(());
        }
        let half = self.openings.iter_mut().rfind(|o| o.role == role).map(|o| &mut o.outline);
        match (key, half) {
            ("REY", Some(Outline::Rectangle(_, y))) | ("ELY", Some(Outline::Ellipse(_, y))) => *y = value,
            ("REX", Some(Outline::Rectangle(x, _))) | ("ELX", Some(Outline::Ellipse(x, _))) => *x = value,
            _ => {
                let outline = match key {
                    "CIR" => Outline::Circle(value),
                    "REX" | "REY" => Outline::Rectangle(value, value),
                    _ => Outline::Ellipse(value, value),
                };
                self.openings.push(Opening { role, outline, centre: [0.0; 2] });
            }
        }
        Ok(())
    }

    /// The surface in SI units; `private` are the file's own glasses.
    pub fn build(&self, unit: f64, private: &[(String, Vec<(f64, f64)>)]) -> Result<Surface, Problem> {
        if self.solved && self.thickness == 0.0 {
            return Err(self
                .problem("the image distance is left to a solve")
                .expecting("a distance")
                .hinting("write the distance that the design program found".to_owned()));
        }
        let mut surface = Surface { label: self.label.clone(), ..Surface::plane() };
        let mut curve = self.curve.clone();
        curve.curvature /= unit;
        curve.terms.iter_mut().for_each(|term| term.coefficient *= unit.powi(1 - term.power as i32));
        surface.profile = Profile::Revolved(curve);
        surface.thickness = if self.thickness >= 1e10 { f64::INFINITY } else { self.thickness * unit };
        if let Some(material) = self.glass.as_deref().and_then(|name| glass::named(name, private)) {
            surface.material = material;
        }
        surface.openings = self.openings.iter().map(|opening| scaled(opening, unit)).collect();
        surface.semi_diameter = surface.openings.iter().find_map(|opening| match opening {
            Opening { role: Role::Clear, outline: Outline::Circle(radius), centre: [0.0, 0.0] } => Some(*radius),
            _ => None,
        });
        let [x, y, z, tilt @ ..] = self.decentre;
        (surface.before, surface.after) = decentre::motions(self.axes, [x, y, z].map(|v| v * unit), tilt)
            .ok_or_else(|| self.problem("a bend about several axes").expecting("ADE or BDE alone with BEN"))?;
        Ok(surface)
    }

    fn problem(&self, message: &str) -> Problem {
        Problem::error(message).at(self.span)
    }
}

/// The curvature of a radius; a radius of 0 is a plane.
fn reciprocal(radius: f64) -> f64 {
    if radius == 0.0 { 0.0 } else { 1.0 / radius }
}

fn scaled(opening: &Opening, unit: f64) -> Opening {
    let outline = match opening.outline {
        Outline::Circle(r) => Outline::Circle(r * unit),
        Outline::Rectangle(x, y) => Outline::Rectangle(x * unit, y * unit),
        Outline::Ellipse(x, y) => Outline::Ellipse(x * unit, y * unit),
    };
    Opening { role: opening.role, outline, centre: opening.centre.map(|v| v * unit) }
}

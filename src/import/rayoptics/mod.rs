//! ray-optics model files (`.roa`): JSON.
//!
//! `optical_model` holds `seq_model` (surfaces `ifcs`, spaces `gaps`), `profile_dict` (their forms), `optical_spec` (wavelengths,
//! pupil, fields) and `system_spec` (title, unit). Lengths are in `_dimensions`, wavelengths in nm, angles in deg. Catalogue glasses carry their
//! coefficients; only their names are used.
//!
//! Left out without a note, because they are derived or drawn: the sections in `DERIVED`, colours, aim points. Refused: diffractive
//! elements, decentres with a pivot, profiles and media other than those in [`surface`] and [`glass`].
//!
//! Source: the attributes as ray-optics 0.9 writes them.

mod glass;
mod node;
mod surface;

use crate::error::{Problem, Span};
use crate::prescription::{Aperture, Field, FieldPoint, Note, Prescription, Surface, Vignetting};
use node::Node;

/// Sections that follow from the others.
const DERIVED: [&str; 7] =
    ["ro_version", "radius_mode", "specsheet", "parax_model", "ele_model", "part_tree", "parts_dict"];

const USED: [&str; 4] = ["system_spec", "seq_model", "optical_spec", "profile_dict"];

/// Reads the text of a file.
pub fn parse(text: &str) -> Result<Prescription, Vec<Problem>> {
    let value = serde_json::from_str(&without_infinities(text)).map_err(|error| {
        let span = Span { line: error.line() as u32, column: error.column() as u32, len: 0 };
        vec![
            Problem::error(format!("is no JSON: {error}"))
                .at((error.line() > 0).then_some(span))
                .expecting("a whole .roa file"),
        ]
    })?;
    lens(&Node::root(&value)).map_err(|problem| vec![problem])
}

/// JSON knows no infinity; Python writes it nonetheless. Places stay where they were.
fn without_infinities(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    let (mut quoted, mut rest) = (false, text);
    while let Some(c) = rest.chars().next() {
        let word = ["-Infinity", "Infinity", "NaN"].into_iter().find(|word| !quoted && rest.starts_with(word));
        let taken = match word {
            Some(word) => {
                out.push_str(&format!("{:<1$}", "null", word.len()));
                word.len()
            }
            None if quoted && c == '\\' => c.len_utf8() + rest[1..].chars().next().map_or(0, char::len_utf8),
            None => c.len_utf8(),
        };
        if word.is_none() {
            out.push_str(&rest[..taken]);
            quoted ^= c == '"';
        }
        rest = &rest[taken..];
    }
    out
}

fn lens(root: &Node) -> Result<Prescription, Problem> {
    let model = root.get("optical_model")?.attributes();
    let system = model.get("system_spec")?.attributes();
    let unit = unit(&system)?;
    let sequence = model.get("seq_model")?.attributes();
    let mut surfaces: Vec<Surface> = Vec::new();
    let gaps = sequence.get("gaps")?.list()?;
    for (i, interface) in sequence.get("ifcs")?.list()?.iter().enumerate() {
        surfaces.push(surface::read(interface, gaps.get(i), model.find("profile_dict").as_ref(), unit)?);
    }
    let stop = sequence.find("stop_surface").map(|stop| stop.count()).transpose()?;
    let spec = model.get("optical_spec")?.attributes();
    let (wavelengths, primary) = wavelengths(&spec.get("spectral_region")?.attributes())?;
    let aperture = aperture(&spec.get("pupil")?.attributes(), unit)?;
    let mut notes: Vec<Note> = Vec::new();
    let fields = fields(&spec.get("field_of_view")?.attributes(), unit, &mut notes)?;
    let unknown = model.names().into_iter().filter(|name| !DERIVED.contains(name) && !USED.contains(name));
    notes.extend(unknown.map(|name| Note { line: None, text: format!("{name}: not known here, not translated") }));
    let shift = spec.find("defocus").and_then(|defocus| defocus.attributes().find("focus_shift"));
    if shift.map_or(Ok(0.0), |shift| shift.number())? != 0.0 {
        notes.push(Note { line: None, text: "defocus: the focus shift is not translated".to_owned() });
    }
    let name = system.find("title").map(|title| title.text().map(str::to_owned)).transpose()?.unwrap_or_default();
    Ok(Prescription { name, surfaces, stop, aperture, fields, wavelengths, primary, notes })
}

/// Length of the file's unit, m.
fn unit(system: &Node) -> Result<f64, Problem> {
    let node = system.find("_dimensions").map_or_else(|| system.get("dimensions"), Ok)?;
    match node.text()?.to_ascii_lowercase().as_str() {
        "mm" => Ok(1e-3),
        "cm" => Ok(1e-2),
        "m" => Ok(1.0),
        "in" | "inches" => Ok(0.0254),
        "ft" | "feet" => Ok(0.3048),
        other => Err(node.problem(format!("no unit {other:?}")).expecting("mm, cm, m, in or ft")),
    }
}

/// Wavelengths (m) with weights, and the index of the reference.
fn wavelengths(spectrum: &Node) -> Result<(Vec<(f64, f64)>, usize), Problem> {
    let node = spectrum.get("wavelengths")?;
    let weights = spectrum.get("spectral_wts")?.numbers()?;
    let pairs: Vec<(f64, f64)> = node.numbers()?.into_iter().map(|nm| nm * 1e-9).zip(weights).collect();
    let primary = spectrum.get("reference_wvl")?.count()?;
    if primary >= pairs.len() || pairs.iter().any(|(w, _)| *w <= 0.0) {
        return Err(node.problem("the reference wavelength is not there").expecting("wavelengths in nm with weights"));
    }
    Ok((pairs, primary))
}

/// Where and what a pupil or field is stated: `["aperture", "object", "epd"]`, in older files without the first.
fn key<'a>(node: &Node<'a>) -> Result<(&'a str, &'a str), Problem> {
    let key = node.find("_key").map_or_else(|| node.get("key"), Ok)?;
    let words: Vec<&str> = key.list()?.iter().map(Node::text).collect::<Result<_, _>>()?;
    match words[..] {
        [.., place, what] => Ok((place, what)),
        _ => Err(key.problem("too short").expecting("where and what, as in [\"object\", \"epd\"]")),
    }
}

fn aperture(pupil: &Node, unit: f64) -> Result<Aperture, Problem> {
    let value = pupil.get("value")?.number()?;
    match key(pupil)? {
        ("object", "epd" | "pupil") => Ok(Aperture::EntrancePupil(value * unit)),
        ("object", "NA") => Ok(Aperture::ObjectNa(value)),
        ("image", "NA") => Ok(Aperture::ImageNa(value)),
        ("image", "f/#") => Ok(Aperture::WorkingFNumber(value)),
        (place, what) => Err(pupil.problem(format!("no {what} at the {place}")).expecting("epd, NA or f/#")),
    }
}

fn fields(view: &Node, unit: f64, notes: &mut Vec<Note>) -> Result<Vec<Field>, Problem> {
    let (place, what) = key(view)?;
    if what == "real height" {
        notes.push(Note { line: None, text: "real image heights are taken as paraxial ones".to_owned() });
    }
    let relative = view.find("is_relative").is_some_and(|flag| flag.is_true());
    let scale = if relative { view.get("value")?.number()? } else { 1.0 };
    let one = |node: &Node| {
        let field = node.attributes();
        let number = |name: &str| field.find(name).map_or(Ok(0.0), |node| node.number());
        let xy = [number("x")? * scale, number("y")? * scale];
        let point = match (place, what) {
            ("object", "angle") => FieldPoint::ObjectAngle(xy.map(f64::to_radians)),
            ("object", "height") => FieldPoint::ObjectHeight(xy.map(|h| h * unit)),
            ("image", "height" | "real height") => FieldPoint::ImageHeight(xy.map(|h| h * unit)),
            _ => return Err(view.problem(format!("no {what} at the {place}")).expecting("angle or height")),
        };
        let vignetting =
            Vignetting { left: number("vlx")?, right: number("vux")?, lower: number("vly")?, upper: number("vuy")? };
        Ok(Field { point, vignetting })
    };
    view.get("fields")?.list()?.iter().map(one).collect()
}

#[cfg(test)]
mod tests;

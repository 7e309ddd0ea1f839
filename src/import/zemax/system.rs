//! The lines of a `.zmx` file that concern the whole lens: aperture, fields, wavelengths.

use super::super::row::Row;
use crate::error::Problem;
use crate::prescription::{Aperture, Field, FieldPoint, Note, Prescription, Surface, Vignetting};

/// What the lines said, fields in the file's units.
#[derive(Default)]
pub struct System {
    name: String,
    aperture: Option<Width>,
    kind: Kind,
    field_count: Option<usize>,
    wavelength_count: Option<usize>,
    x: Vec<f64>,
    y: Vec<f64>,
    /// Vignetting: decentre and compression along x and y.
    vignetting: [Vec<f64>; 4],
    wavelengths: Vec<(f64, f64)>,
    primary: usize,
    /// Names of the glass catalogues.
    pub catalogs: Vec<String>,
}

/// The system's aperture; a floating one is the stop's own radius.
enum Width {
    Stated(Aperture),
    Floating,
}

/// What the field's numbers are.
#[derive(Clone, Copy, Default)]
enum Kind {
    #[default]
    Angle,
    ObjectHeight,
    ImageHeight,
}

impl System {
    /// Takes a line; false if it is none of the system's. `unit` in m.
    pub fn take(&mut self, key: &str, row: &Row, unit: f64, notes: &mut Vec<Note>) -> Result<bool, Problem> {
        match key {
            "UNIT" => (),
            "NAME" => self.name = row.rest(),
            "MODE" if row.word(1) == Some("SEQ") => (),
            "MODE" => return Err(row.problem("the file is not sequential").expecting("`MODE SEQ`")),
            "GCAT" => self.catalogs = row.words[1..].iter().map(|w| w.text.clone()).collect(),
            "ENPD" | "FNUM" | "OBNA" | "FLOA" => self.aperture = Some(aperture(key, row, unit)?),
            "ENVD" => standard_air(row, notes)?,
            "FTYP" => self.field_type(row, notes)?,
            "XFLN" | "XFLD" => self.x = row.numbers("fields")?,
            "YFLN" | "YFLD" => self.y = row.numbers("fields")?,
            "VDXN" => self.vignetting[0] = row.numbers("vignetting factors")?,
            "VDYN" => self.vignetting[1] = row.numbers("vignetting factors")?,
            "VCXN" => self.vignetting[2] = row.numbers("vignetting factors")?,
            "VCYN" => self.vignetting[3] = row.numbers("vignetting factors")?,
            "VANN" if row.numbers("vignetting angles")?.iter().all(|v| *v == 0.0) => (),
            "VANN" => notes.push(row.note("turned pupils are not translated")),
            "WAVM" => {
                let pair = (row.number(2, "a wavelength, um")? * 1e-6, row.number_or_zero(3, "its weight")?);
                self.wavelengths.push(pair);
            }
            "WAVL" => self.wavelengths = row.numbers("wavelengths, um")?.iter().map(|w| (w * 1e-6, 1.0)).collect(),
            "WWGT" => {
                let weights = row.numbers("weights")?;
                self.wavelengths.iter_mut().zip(weights).for_each(|(pair, weight)| pair.1 = weight);
            }
            "PWAV" => self.primary = row.count(1, "the number of the reference wavelength")?.saturating_sub(1),
            "MNUM" if row.number_or_zero(1, "the number of configurations")? <= 1.0 => (),
            "MNUM" => notes.push(row.note("several configurations; the one the file was saved in is read")),
            _ => return Ok(false),
        }
        Ok(true)
    }

    /// `FTYP kind telecentric fields wavelengths ...`
    fn field_type(&mut self, row: &Row, notes: &mut Vec<Note>) -> Result<(), Problem> {
        self.kind = match row.count(1, "the kind of field")? {
            0 => Kind::Angle,
            1 => Kind::ObjectHeight,
            2 => Kind::ImageHeight,
            3 => {
                notes.push(row.note("real image heights are taken as paraxial ones"));
                Kind::ImageHeight
            }
            other => {
                let expected = "0 (angles), 1 (object heights), 2 or 3 (image heights)";
                return Err(row.problem(format!("no field of kind {other}")).at(row.words[1].span).expecting(expected));
            }
        };
        if row.number_or_zero(2, "1 if the object space is telecentric")? != 0.0 {
            notes.push(row.note("a telecentric object space is not translated: chief rays go through the stop"));
        }
        let count = |i: usize, what: &str| row.words.get(i).map(|_| row.count(i, what)).transpose();
        self.field_count = count(3, "the number of fields")?;
        self.wavelength_count = count(4, "the number of wavelengths")?;
        Ok(())
    }

    /// The whole lens; `unit` in m.
    pub fn prescription(
        self,
        surfaces: Vec<Surface>,
        unit: f64,
        stop: Option<usize>,
        notes: Vec<Note>,
    ) -> Result<Prescription, Problem> {
        let aperture = match &self.aperture {
            Some(Width::Stated(aperture)) => *aperture,
            Some(Width::Floating) => {
                stop.and_then(|stop| surfaces[stop].semi_diameter).map(Aperture::Stop).ok_or_else(|| {
                    Problem::error("the aperture floats with a stop that has no radius").expecting("`DIAM`")
                })?
            }
            None => {
                return Err(Problem::error("the file gives no aperture").expecting("`ENPD`, `FNUM`, `OBNA` or `FLOA`"));
            }
        };
        let fields = self.fields(unit);
        let mut wavelengths = self.wavelengths;
        wavelengths.truncate(self.wavelength_count.unwrap_or(usize::MAX));
        if self.primary >= wavelengths.len() || wavelengths.iter().any(|(w, _)| *w <= 0.0) {
            return Err(
                Problem::error("the reference wavelength is not there").expecting("`WAVM 1 0.55 1` and `PWAV 1`")
            );
        }
        let (name, primary) = (self.name, self.primary);
        Ok(Prescription { name, surfaces, stop, aperture, fields, wavelengths, primary, notes })
    }

    fn fields(&self, unit: f64) -> Vec<Field> {
        let of = |values: &[f64], i: usize| values.get(i).copied().unwrap_or_default();
        let used = |values: &[f64]| values.iter().rposition(|v| *v != 0.0).map_or(1, |last| last + 1);
        let count = self.field_count.unwrap_or_else(|| used(&self.x).max(used(&self.y)));
        let one = |i: usize| {
            let xy = [of(&self.x, i), of(&self.y, i)];
            let point = match self.kind {
                Kind::Angle => FieldPoint::ObjectAngle(xy.map(f64::to_radians)),
                Kind::ObjectHeight => FieldPoint::ObjectHeight(xy.map(|h| h * unit)),
                Kind::ImageHeight => FieldPoint::ImageHeight(xy.map(|h| h * unit)),
            };
            let [dx, dy, cx, cy] = [0, 1, 2, 3].map(|k| of(&self.vignetting[k], i));
            // The pupil is pressed together by 1 - c about its shifted centre d.
            let vignetting = Vignetting { left: cx + dx, right: cx - dx, lower: cy + dy, upper: cy - dy };
            Field { point, vignetting }
        };
        (0..count.min(self.x.len().max(self.y.len()))).map(one).collect()
    }
}

/// `ENPD diameter`, `FNUM number working`, `OBNA value angle`, `FLOA`.
fn aperture(key: &str, row: &Row, unit: f64) -> Result<Width, Problem> {
    if key == "FLOA" {
        return Ok(Width::Floating);
    }
    let value = row.number(1, "the aperture")?;
    if value <= 0.0 {
        return Err(row.problem(format!("an aperture of {value}")).at(row.words[1].span).expecting("more than 0"));
    }
    let flag = row.number_or_zero(2, "a flag")? != 0.0;
    Ok(Width::Stated(match (key, flag) {
        ("ENPD", _) => Aperture::EntrancePupil(value * unit),
        ("FNUM", false) => Aperture::ImageFNumber(value),
        ("FNUM", true) => Aperture::WorkingFNumber(value),
        (_, false) => Aperture::ObjectNa(value),
        (_, true) => Aperture::ObjectNa(value.to_radians().sin()),
    }))
}

/// `ENVD temperature pressure ...`: 20 C and 1 atm is where glass catalogues are made.
fn standard_air(row: &Row, notes: &mut Vec<Note>) -> Result<(), Problem> {
    let (temperature, pressure) = (row.number(1, "a temperature, C")?, row.number(2, "a pressure, atm")?);
    if (temperature, pressure) != (20.0, 1.0) {
        notes.push(row.note("indices are not changed with temperature and pressure"));
    }
    Ok(())
}

//! The commands of a sequence file that concern the whole lens: aperture, fields, wavelengths, private glasses.

use super::super::row::Row;
use super::command::key;
use crate::error::Problem;
use crate::prescription::{Aperture, Field, FieldPoint, Note, Prescription, Surface, Vignetting};

/// What the commands said, fields in the file's units.
#[derive(Default)]
pub struct System {
    name: String,
    aperture: Option<Aperture>,
    /// The two letters behind X and Y in `XAN`, `YOB`, `YIM`.
    kind: Option<String>,
    x: Vec<f64>,
    y: Vec<f64>,
    /// Left, right, lower, upper.
    vignetting: [Vec<f64>; 4],
    /// m.
    wavelengths: Vec<f64>,
    weights: Vec<f64>,
    reference: Option<usize>,
    /// True after `RDM Y`.
    pub radii: bool,
    /// Names and indices (wavelength m, index) of `PRV` ... `END`.
    pub glasses: Vec<(String, Vec<(f64, f64)>)>,
    /// Wavelengths (m) of the private glasses between `PRV` and `END`.
    private: Option<Vec<f64>>,
}

/// Length of the file's unit, m: `DIM M`, `C` or `I`.
pub fn unit(rows: &[Row]) -> Result<f64, Problem> {
    let Some(row) = rows.iter().rfind(|row| key(row) == "DIM") else { return Ok(1e-3) };
    match row.word(1).unwrap_or_default().to_ascii_uppercase().as_str() {
        "M" | "MM" => Ok(1e-3),
        "C" | "CM" => Ok(1e-2),
        "I" | "IN" => Ok(0.0254),
        other => Err(row.problem(format!("no unit {other:?}")).expecting("M (mm), C (cm) or I (inch)")),
    }
}

impl System {
    /// Takes a command; false if it is none of the system's. `unit` in m.
    pub fn take(&mut self, key: &str, row: &Row, unit: f64, notes: &mut Vec<Note>) -> Result<bool, Problem> {
        match key {
            "DIM" => (),
            "TIT" => self.name = row.rest(),
            "RDM" => self.radii = !row.word(1).is_some_and(|word| word.eq_ignore_ascii_case("N")),
            "EPD" | "FNO" | "NA" | "NAO" => self.aperture = Some(aperture(key, row, unit)?),
            "WL" => self.wavelengths = row.numbers("wavelengths, nm")?.iter().map(|w| w * 1e-9).collect(),
            "WTW" => self.weights = row.numbers("weights")?,
            "REF" => self.reference = Some(row.count(1, "the number of the reference wavelength")?),
            "XAN" | "XOB" | "XIM" | "XRI" => (self.x, self.kind) = (row.numbers("fields")?, self.kind(row, notes)?),
            "YAN" | "YOB" | "YIM" | "YRI" => (self.y, self.kind) = (row.numbers("fields")?, self.kind(row, notes)?),
            "VLX" => self.vignetting[0] = row.numbers("vignetting factors")?,
            "VUX" => self.vignetting[1] = row.numbers("vignetting factors")?,
            "VLY" => self.vignetting[2] = row.numbers("vignetting factors")?,
            "VUY" => self.vignetting[3] = row.numbers("vignetting factors")?,
            "PRV" => self.private = Some(Vec::new()),
            "TEM" if row.number(1, "a temperature, C")? == 20.0 => (),
            "TEM" => notes.push(row.note("indices are not changed with temperature")),
            "ZOO" => notes.push(row.note("several zoom positions; the first is read")),
            _ => return Ok(false),
        }
        Ok(true)
    }

    pub fn in_private_glasses(&self) -> bool {
        self.private.is_some()
    }

    /// A line between `PRV` and `END`: `PWL wavelengths (nm)`, `'NAME' indices`.
    pub fn private_glass(&mut self, row: &Row) -> Result<(), Problem> {
        let Some(wavelengths) = &mut self.private else { return Ok(()) };
        match row.key().as_str() {
            "END" => self.private = None,
            "PWL" => *wavelengths = row.numbers("wavelengths, nm")?.iter().map(|w| w * 1e-9).collect(),
            _ => {
                let indices = row.numbers("indices")?;
                if indices.len() != wavelengths.len() || indices.is_empty() {
                    let expected = format!("an index for each of {} wavelengths of PWL", wavelengths.len());
                    return Err(row.problem(format!("found {} indices", indices.len())).expecting(expected));
                }
                let mut table: Vec<(f64, f64)> = wavelengths.iter().copied().zip(indices).collect();
                table.sort_by(|a, b| a.0.total_cmp(&b.0));
                self.glasses.push((row.words[0].text.clone(), table));
            }
        }
        Ok(())
    }

    /// The kind of field; all of a file are of one kind.
    fn kind(&self, row: &Row, notes: &mut Vec<Note>) -> Result<Option<String>, Problem> {
        let kind = row.key()[1..].to_owned();
        if kind == "RI" {
            notes.push(row.note("real image heights are taken as paraxial ones"));
        }
        match &self.kind {
            Some(before) if *before != kind => {
                Err(row.problem("fields of two kinds").expecting(format!("X{before} and Y{before} alone")))
            }
            _ => Ok(Some(kind)),
        }
    }

    /// The whole lens; `unit` in m.
    pub fn prescription(
        self,
        surfaces: Vec<Surface>,
        stop: Option<usize>,
        unit: f64,
        notes: Vec<Note>,
    ) -> Result<Prescription, Problem> {
        let Some(aperture) = self.aperture else {
            return Err(Problem::error("the file gives no aperture").expecting("`EPD`, `FNO`, `NA` or `NAO`"));
        };
        let count = self.wavelengths.len();
        let primary = self.reference.unwrap_or(count.div_ceil(2)).wrapping_sub(1);
        if primary >= count || self.wavelengths.iter().any(|w| *w <= 0.0) {
            return Err(
                Problem::error("the reference wavelength is not there").expecting("`WL 656 588 486` and `REF 2`")
            );
        }
        let weight = |i: usize| self.weights.get(i).copied().unwrap_or(1.0);
        let wavelengths = self.wavelengths.iter().enumerate().map(|(i, w)| (*w, weight(i))).collect();
        let fields = self.fields(unit);
        Ok(Prescription { name: self.name, surfaces, stop, aperture, fields, wavelengths, primary, notes })
    }

    fn fields(&self, unit: f64) -> Vec<Field> {
        let of = |values: &[f64], i: usize| values.get(i).copied().unwrap_or_default();
        let one = |i: usize| {
            let xy = [of(&self.x, i), of(&self.y, i)];
            let point = match self.kind.as_deref() {
                Some("OB") => FieldPoint::ObjectHeight(xy.map(|h| h * unit)),
                Some("IM" | "RI") => FieldPoint::ImageHeight(xy.map(|h| h * unit)),
                _ => FieldPoint::ObjectAngle(xy.map(f64::to_radians)),
            };
            let [left, right, lower, upper] = [0, 1, 2, 3].map(|k| of(&self.vignetting[k], i));
            Field { point, vignetting: Vignetting { left, right, lower, upper } }
        };
        (0..self.x.len().max(self.y.len())).map(one).collect()
    }
}

/// `EPD diameter`, `FNO number` and `NA` at the image, `NAO` at the object.
fn aperture(key: &str, row: &Row, unit: f64) -> Result<Aperture, Problem> {
    let value = row.number(1, "the aperture")?;
    if value <= 0.0 {
        return Err(row.problem(format!("an aperture of {value}")).at(row.words[1].span).expecting("more than 0"));
    }
    Ok(match key {
        "EPD" => Aperture::EntrancePupil(value * unit),
        "FNO" => Aperture::WorkingFNumber(value),
        "NA" => Aperture::ImageNa(value),
        _ => Aperture::ObjectNa(value),
    })
}

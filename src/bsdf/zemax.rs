//! Reader of Zemax OpticStudio `.bsdf` text files.
//!
//! By the public description "BSDF Data Interchange file format specification" (Ansys Zemax): comments begin with `#`; keys
//!
//!     Source, Symmetry (PlaneSymmetrical: azimuths 0 to 180 | ASymmetrical: 0 to 360), SpectralContent (Monochrome),
//!     ScatterType (BRDF | BTDF), and with a count and then that many angles in deg: SampleRotation, AngleOfIncidence,
//!     ScatterAzimuth, ScatterRadial
//!
//! then `DataBegin` and for each rotation of the sample and each angle of incidence a row `TIS number` and for each azimuth a row of values in 1/sr, one per radial angle;
//! `DataEnd`. Radial angles count from the specular ray (or the ray straight on, for BTDF), azimuths about it, from towards the normal.
//!
//! The stated TIS is what is scattered; the values are its shape. Where values that were not measured are extended, the TIS grows as
//! their integral does. Refused with a message: tristimulus data.
//!
//! *Rotation.* By the description it is the angle between the normal of the plane of incidence and the sample's axis x: at 0 the sample's
//! axis y lies in that plane. It is the lay; rotations are taken to count as azimuths of [`super::anisotropic`] do.

use super::reading::{Problem, Rows, Unmeasured, shorten};
use super::tabulated::{Beyond, Lobe, Pole, Table};
use std::f64::consts::TAU;

/// Reads the text of a file: a table for every rotation of the sample.
pub fn parse(text: &str, unmeasured: Unmeasured) -> Result<Vec<Table>, Vec<Problem>> {
    let mut file = Rows::new(text);
    match zemax(&mut file, unmeasured) {
        Ok(tables) => Ok(tables),
        Err(last) => Err(file.all(last)),
    }
}

/// Angles of the table, deg.
#[derive(Default)]
struct Axes {
    symmetric: bool,
    transmitted: bool,
    rotation: Vec<f64>,
    incidence: Vec<f64>,
    azimuth: Vec<f64>,
    radial: Vec<f64>,
}

fn zemax(file: &mut Rows, unmeasured: Unmeasured) -> Result<Vec<Table>, Problem> {
    let axes = axes(file)?;
    let mut tables = Vec::new();
    for rotation in &axes.rotation {
        tables.push(table(file, &axes, unmeasured)?.turned(rotation.to_radians()));
    }
    match file.problems.pop() {
        Some(last) => Err(last),
        None => Ok(tables),
    }
}

/// One rotation of the sample.
fn table(file: &mut Rows, axes: &Axes, unmeasured: Unmeasured) -> Result<Table, Problem> {
    let (mut lobes, mut tis) = (Vec::new(), Vec::new());
    for incidence in &axes.incidence {
        let (lobe, stated) = lobe(file, axes, incidence.to_radians(), unmeasured)?;
        lobes.push(lobe);
        tis.push(stated);
    }
    let table = Table::new(lobes, vec![(1e-6, 1.0)])
        .ok_or_else(|| file.problem("the table has no order", "rising angles of incidence below 90 deg"))?
        .scattering(tis);
    Ok(if axes.transmitted { table.transmitted() } else { table })
}

/// The keys, up to `DataBegin`.
fn axes(file: &mut Rows) -> Result<Axes, Problem> {
    let mut axes = Axes::default();
    loop {
        let row = file.significant("the keys of the file, and `DataBegin`")?;
        let (key, rest) = row.split_once(char::is_whitespace).map_or((row, ""), |(key, rest)| (key, rest.trim()));
        match (key, rest) {
            ("Source", _) | ("SpectralContent", "Monochrome") | ("Monochrome", "") => {}
            ("Symmetry", "PlaneSymmetrical") => axes.symmetric = true,
            ("Symmetry", "ASymmetrical") => axes.symmetric = false,
            ("ScatterType", "BRDF") => axes.transmitted = false,
            ("ScatterType", "BTDF") => axes.transmitted = true,
            ("SampleRotation", count) => axes.rotation = list(file, count, "rotations of the sample")?,
            ("AngleOfIncidence", count) => axes.incidence = list(file, count, "angles of incidence")?,
            ("ScatterAzimuth", count) => axes.azimuth = list(file, count, "azimuths")?,
            ("ScatterRadial", count) => axes.radial = list(file, count, "radial angles")?,
            ("DataBegin", _) => break,
            _ => {
                let expected = "Symmetry PlaneSymmetrical or ASymmetrical, SpectralContent Monochrome, ScatterType BRDF or BTDF, SampleRotation, \
                                AngleOfIncidence, ScatterAzimuth, ScatterRadial, DataBegin";
                return Err(file.problem(&format!("`{}` is not understood", shorten(row)), expected));
            }
        }
    }
    if axes.rotation.is_empty() {
        axes.rotation.push(0.0);
    }
    file.rising(&axes.rotation, "rotations of the sample", 0.0..360.0 + 1e-9)?;
    file.rising(&axes.incidence, "angles of incidence", 0.0..90.0)?;
    let around = if axes.symmetric { 180.0 } else { 360.0 };
    file.rising(&axes.azimuth, "azimuths", 0.0..around + 1e-9)?;
    if axes.azimuth.first() != Some(&0.0) || axes.azimuth.last() != Some(&around) {
        return Err(file.problem("the azimuths do not close", &format!("azimuths from 0 to {around} deg")));
    }
    file.rising(&axes.radial, "radial angles", 0.0..180.0)?;
    Ok(axes)
}

fn list(file: &mut Rows, count: &str, what: &str) -> Result<Vec<f64>, Problem> {
    let row = file.significant(what)?;
    let values = file.values(row, what)?;
    match count.parse::<usize>() {
        Ok(count) if count == values.len() => Ok(values),
        _ => Err(file.problem(&format!("found {} {what}", values.len()), count)),
    }
}

/// One angle of incidence: its lobe and its scattered share.
fn lobe(file: &mut Rows, axes: &Axes, incidence: f64, unmeasured: Unmeasured) -> Result<(Lobe, f64), Problem> {
    let row = file.significant("`TIS` and a number")?;
    let stated = row.strip_prefix("TIS").map(str::trim).and_then(|number| number.parse::<f64>().ok());
    let Some(stated) = stated.filter(|tis| (0.0..=1.0).contains(tis)) else {
        return Err(file.problem(&format!("found `{}`", shorten(row)), "`TIS` and a number from 0 to 1"));
    };
    let mut rows = Vec::new();
    for _ in &axes.azimuth {
        let what = "a value (1/sr) for every radial angle";
        let row = file.significant(what)?;
        let values = file.values(row, what)?;
        if values.len() != axes.radial.len() {
            let found = format!("found {} values", values.len());
            return Err(file.problem(&found, &format!("{}: {what}", axes.radial.len())));
        }
        file.check(&values)?;
        rows.push(values);
    }
    let build = |rows: &[Vec<f64>], beyond: Beyond| {
        let phi = azimuths(axes);
        let columns: Vec<&Vec<f64>> =
            (0..phi.len()).map(|j| &rows[if j < rows.len() { j } else { phi.len() - 1 - j }]).collect();
        let value = (0..axes.radial.len()).flat_map(|i| columns.iter().map(move |row| row[i])).collect();
        let radial = axes.radial.iter().map(|angle| angle.to_radians()).collect();
        Lobe::new(incidence, radial, phi, value).map(|lobe| lobe.about(Pole::Specular, beyond))
    };
    let measured = build(&rows, Beyond::Zero);
    let used = match unmeasured {
        Unmeasured::Zero => measured.clone(),
        Unmeasured::Hold => {
            rows.iter_mut().for_each(|row| hold(row));
            build(&rows, Beyond::Hold)
        }
    };
    let (Some(measured), Some(used)) = (measured, used) else {
        return Err(file.problem("the table has no shape", "two or more azimuths and radial angles"));
    };
    let integral = measured.tis();
    if integral <= 0.0 && stated > 0.0 {
        return Err(file.problem("every value is zero", "a value above zero"));
    }
    let tis = if integral > 0.0 { stated * used.tis() / integral } else { 0.0 };
    Ok((used, tis))
}

/// rad, from 0 to 2 pi; those of a symmetrical table and their mirror images.
fn azimuths(axes: &Axes) -> Vec<f64> {
    let given = axes.azimuth.iter().map(|angle| angle.to_radians());
    let mirrored = axes.azimuth.iter().rev().skip(1).map(|angle| TAU - angle.to_radians());
    let mut all: Vec<f64> = if axes.symmetric { given.chain(mirrored).collect() } else { given.collect() };
    if let Some(last) = all.last_mut() {
        *last = TAU;
    }
    all
}

/// Zeros at the end of a row become the last value before them.
pub(super) fn hold(row: &mut [f64]) {
    let Some(last) = row.iter().rposition(|value| *value > 0.0) else { return };
    let value = row[last];
    row[last + 1..].fill(value);
}

#[cfg(test)]
mod tests {
    use super::*;

    const SMALL: &str = "# a comment\nSource Measured\nSymmetry PlaneSymmetrical\nSpectralContent Monochrome\nScatterType BRDF\n\
        SampleRotation 1\n0\nAngleOfIncidence 1\n30\nScatterAzimuth 2\n0 180\nScatterRadial 3\n0 30 90\n\nMonochrome\nDataBegin\n\
        TIS 0.2\n1 0.5 0.1\n1 0.5 0\nDataEnd\n";

    fn first(from: &str, to: &str) -> Problem {
        let changed = SMALL.replacen(from, to, 1);
        assert_ne!(changed, SMALL, "nothing changed by {from:?}");
        parse(&changed, Unmeasured::Zero).expect_err("refused").remove(0)
    }

    #[test]
    fn the_stated_tis_is_scattered_and_grows_with_what_is_added() {
        let tis = |rule| {
            parse(&SMALL.replace('\n', "\r\n"), rule).expect("a table").remove(0).totals().next().expect("one").1[0]
        };
        assert_eq!(tis(Unmeasured::Zero), 0.2);
        assert!(tis(Unmeasured::Hold) > 0.2);
    }

    #[test]
    fn every_defect_is_named_with_its_line() {
        for (from, to, line, words) in [
            ("Monochrome\nScatterType", "XYZ\nScatterType", 4, "XYZ"),
            ("BRDF", "both", 5, "ScatterType both"),
            ("SampleRotation 1\n0", "SampleRotation 2\n0", 7, "found 1"),
            ("SampleRotation 1\n0", "SampleRotation 2\n90 0", 16, "rotations"),
            ("SampleRotation 1\n0", "SampleRotation 2\n0 90", 20, "DataEnd"),
            ("Incidence 1\n30", "Incidence 1\n95", 16, "incidence"),
            ("Azimuth 2\n0 180", "Azimuth 2\n0 170", 16, "180"),
            ("Radial 3", "Radial 4", 13, "found 3"),
            ("TIS 0.2", "TIS 2", 17, "TIS 2"),
            ("1 0.5 0.1", "1 0.5", 18, "2 values"),
            ("1 0.5 0.1", "1 0,5 0.1", 18, "0,5"),
            ("1 0.5 0.1", "1 -0.5 0.1", 18, "-0.5"),
            ("1 0.5 0\nDataEnd\n", "", 19, "ends here"),
        ] {
            let problem = first(from, to);
            assert!(problem.to_string().contains(words), "{to:?}: {problem}");
            assert_eq!(problem.line, line, "{to:?}: {problem}");
        }
    }
}

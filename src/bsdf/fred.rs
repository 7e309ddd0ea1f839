//! Reader of FRED tabulated BSDF text files.
//!
//! By the public description "Tabulated Data BSDF" (Photon Engineering, FRED help): `type bsdf_data`, `format angles=deg bsdf=value
//! scale=1`, then for each angle of incidence a row `theta phi` of the incident ray and rows `theta phi value` of scattered rays: angles
//! in deg from the normal, azimuths from the specular side, values in 1/sr times the scale. Places that are left out were not measured.
//!
//! Refused with a message: incident rays at several azimuths, logarithmic values, direction cosines.

use super::entries::{Entry, table};
use super::reading::{Problem, Rows, Unmeasured, shorten};
use super::tabulated::Table;

/// Reads the text of a file.
pub fn parse(text: &str, unmeasured: Unmeasured) -> Result<Table, Vec<Problem>> {
    let mut file = Rows::new(text);
    let read = fred(&mut file).and_then(|entries| table(&mut file, &entries, unmeasured));
    read.map_err(|last| file.all(last))
}

fn fred(file: &mut Rows) -> Result<Vec<Entry>, Problem> {
    let kind = file.significant("`type bsdf_data`")?;
    if !kind.split_whitespace().eq(["type", "bsdf_data"]) {
        return Err(file.problem(&format!("found `{}`", shorten(kind)), "`type bsdf_data`"));
    }
    let scale = scale(file)?;
    let mut entries: Vec<Entry> = Vec::new();
    let mut incidence = None;
    while let Ok(row) = file.significant("a row of the table") {
        let what = "`theta phi` of an incident ray, or `theta phi value`";
        match (file.values(row, what)?.as_slice(), incidence) {
            ([theta, phi], _) => {
                if !(0.0..90.0).contains(theta) || *phi != 0.0 {
                    let expected =
                        "theta from 0 to below 90 deg, and azimuth 0: a surface that is the same about its normal";
                    return Err(file.problem(&format!("an incident ray at {theta}, {phi} deg"), expected));
                }
                incidence = Some(*theta);
            }
            ([theta, phi, value], Some(incidence)) => {
                if !(0.0..=90.0).contains(theta) {
                    return Err(file.problem(&format!("a scattered ray at {theta} deg"), "theta from 0 to 90 deg"));
                }
                file.check(&[*value])?;
                entries.push(Entry {
                    incidence,
                    theta: *theta,
                    phi: Some(phi.rem_euclid(360.0)),
                    value: scale * value,
                });
            }
            (numbers, _) => return Err(file.problem(&format!("found {} numbers", numbers.len()), what)),
        }
    }
    Ok(entries)
}

/// The row `format ...`.
fn scale(file: &mut Rows) -> Result<f64, Problem> {
    let row = file.significant("`format angles=deg bsdf=value scale=1`")?;
    let mut scale = 1.0;
    for (at, word) in row.split_whitespace().enumerate() {
        match (at, word.split_once('=')) {
            (0, None) if word == "format" => {}
            (_, Some(("angles", "deg")) | Some(("bsdf", "value"))) => {}
            (_, Some(("scale", number))) if number.parse::<f64>().is_ok_and(|s| s.is_finite() && s > 0.0) => {
                scale = number.parse().unwrap_or(1.0);
            }
            _ => {
                let expected = "`format angles=deg bsdf=value scale=1`, the scale above 0";
                return Err(file.problem(&format!("`{}` is not understood", shorten(word)), expected));
            }
        }
    }
    Ok(scale)
}

#[cfg(test)]
mod tests {
    use super::*;

    const SMALL: &str = "type bsdf_data\r\nformat angles=deg bsdf=value scale=1\r\n20\t0\r\n0\t0\t0.1\r\n45\t0\t0.2\r\n45\t180\t0.05\r\n80\t0\t0.1\r\n";

    #[test]
    fn what_is_left_out_is_dark_or_held() {
        let tis = |rule| parse(SMALL, rule).expect("a table").totals().next().expect("one").1[0];
        assert!(tis(Unmeasured::Hold) > 1.02 * tis(Unmeasured::Zero));
        let full = SMALL.to_owned() + "45 90 0.1\n45 270 0.1\n";
        assert!(parse(&full, Unmeasured::Zero).is_ok());
    }

    #[test]
    fn every_defect_is_named_with_its_line() {
        for (from, to, line, words) in [
            ("bsdf=value", "bsdf=log10", 2, "log10"),
            ("20\t0\r", "20\t45\r", 3, "45"),
            ("0\t0\t0.1", "0\t0.1", 4, "0.1"),
            ("45\t0\t0.2", "95\t0\t0.2", 5, "95"),
            ("45\t0\t0.2", "45\t0\t-0.2", 5, "-0.2"),
            ("45\t180\t0.05", "45\t0\t0.05", 7, "twice"),
        ] {
            let changed = SMALL.replacen(from, to, 1);
            assert_ne!(changed, SMALL, "nothing changed by {from:?}");
            let problem = parse(&changed, Unmeasured::Zero).expect_err("refused").remove(0);
            assert!(problem.to_string().contains(words), "{to:?}: {problem}");
            assert!(problem.line.abs_diff(line) <= 1, "{to:?}: {problem}");
        }
    }
}

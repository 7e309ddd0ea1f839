//! A coating's table as comma-separated values.
//!
//! The first line names the columns, in any order: `wavelength_nm` or `wavelength_um`, `angle_deg` (else the same at all angles), and the
//! shares (0..1) `rs`, `rp`, `ts`, `tp`, or for both polarisations `reflectance`, `transmittance` (else nothing passes), or the same in
//! percent as `reflectance_percent`, `transmittance_percent`; and, if known, `phase_rs_deg`, `phase_rp_deg`, `phase_ts_deg`,
//! `phase_tp_deg`. Lines that begin with `#` are comments.

use super::{MIRROR, Row};
use crate::error::{Problem, Span};

const SHARES: [&str; 4] = ["rs", "rp", "ts", "tp"];
/// Columns for both polarisations, and the size of their unit.
const MEANS: [[(&str, f64); 2]; 2] =
    [[("reflectance", 1.0), ("reflectance_percent", 0.01)], [("transmittance", 1.0), ("transmittance_percent", 0.01)]];
const PHASES: [&str; 4] = ["phase_rs_deg", "phase_rp_deg", "phase_ts_deg", "phase_tp_deg"];
/// More faults of one file made one mistake many times.
const MOST: usize = 20;

/// Where each quantity stands in a line.
struct Columns {
    /// And the size of its unit, m.
    wavelength: (usize, f64),
    /// `None`: the same at all angles.
    angle: Option<usize>,
    /// And the size of its unit; `None`: nothing.
    shares: [Option<(usize, f64)>; 4],
    phases: [Option<usize>; 4],
}

/// The rows of a file; fails with what is wrong, each with its line.
pub fn parse(text: &str) -> Result<Vec<Row>, Vec<Problem>> {
    let mut reader = csv::ReaderBuilder::new().comment(Some(b'#')).trim(csv::Trim::All).from_reader(text.as_bytes());
    let columns = match reader.headers() {
        Ok(header) => columns(header).map_err(|problem| vec![problem.at(place(header.position()))])?,
        Err(error) => return Err(vec![unreadable(&error)]),
    };
    let (mut rows, mut problems) = (Vec::new(), Vec::new());
    for record in reader.records() {
        let outcome = match record {
            Ok(record) => row(&columns, &record).map_err(|problem| problem.at(place(record.position()))),
            Err(error) => Err(unreadable(&error)),
        };
        match outcome {
            Ok(row) => rows.push(row),
            Err(problem) if problems.len() < MOST => problems.push(problem),
            Err(_) => break,
        }
    }
    if problems.is_empty() { Ok(rows) } else { Err(problems) }
}

fn columns(header: &csv::StringRecord) -> Result<Columns, Problem> {
    let known = ["wavelength_nm", "wavelength_um", "angle_deg"].into_iter().chain(SHARES).chain(PHASES);
    let known: Vec<&str> = known.chain(MEANS.into_iter().flatten().map(|(name, _)| name)).collect();
    if let Some(name) = header.iter().find(|name| !known.contains(name)) {
        let problem = Problem::error(format!("there is no column {name:?}"));
        return Err(problem.expecting(format!("some of {}", known.join(", "))));
    }
    let find = |name: &str| header.iter().position(|column| column == name);
    let need = |name: &str| find(name).ok_or_else(|| Problem::error(format!("the column `{name}` is missing")));
    let wavelength = match find("wavelength_um") {
        Some(column) => (column, 1e6),
        None => (need("wavelength_nm")?, 1e9),
    };
    let [reflected, transmitted] =
        MEANS.map(|names| names.into_iter().find_map(|(name, unit)| find(name).map(|column| (column, unit))));
    let mut shares = [reflected, reflected, transmitted, transmitted];
    if reflected.is_none() && transmitted.is_none() {
        for (column, name) in shares.iter_mut().zip(SHARES) {
            *column = Some((need(name)?, 1.0));
        }
    } else if let Some(name) = SHARES.into_iter().find(|name| find(name).is_some()) {
        let problem = Problem::error(format!("the column `{name}` beside a mean of both polarisations"));
        return Err(problem.expecting("rs, rp, ts and tp, or reflectance and transmittance"));
    }
    Ok(Columns { wavelength, angle: find("angle_deg"), shares, phases: PHASES.map(find) })
}

fn row(columns: &Columns, record: &csv::StringRecord) -> Result<Row, Problem> {
    let number = |column: usize| {
        let text = record.get(column).unwrap_or_default();
        let number = text.parse().ok().filter(|x: &f64| x.is_finite());
        number.ok_or_else(|| Problem::error(format!("{text:?} is not a number")))
    };
    let within = |column: usize, most: f64, what: &str| {
        let value = number(column)?;
        let inside = (0.0..=most).contains(&value);
        inside.then_some(value).ok_or_else(|| Problem::error(format!("{value} is out of range")).expecting(what))
    };
    let mut row = Row { wavelength: 0.0, angle: 0.0, power: [0.0; 4], phase: MIRROR };
    row.wavelength = number(columns.wavelength.0)? / columns.wavelength.1;
    if row.wavelength <= 0.0 {
        return Err(Problem::error("a wavelength is above 0"));
    }
    if let Some(angle) = columns.angle {
        row.angle = within(angle, 90.0, "an angle from 0 to 90 deg")?.to_radians();
    }
    for k in 0..4 {
        if let Some((column, unit)) = columns.shares[k] {
            row.power[k] = unit * within(column, 1.0 / unit, "a share from 0 to 1, or to 100 percent")?;
        }
        if let Some(column) = columns.phases[k] {
            row.phase[k] = number(column)?.to_radians();
        }
    }
    Ok(row)
}

fn place(position: Option<&csv::Position>) -> Span {
    let line = position.map_or(1, |position| u32::try_from(position.line()).unwrap_or(u32::MAX));
    Span { line, column: 1, len: 0 }
}

fn unreadable(error: &csv::Error) -> Problem {
    let what = match error.kind() {
        csv::ErrorKind::UnequalLengths { expected_len, len, .. } => {
            format!("{len} values under {expected_len} columns")
        }
        _ => "this is no line of a table".to_owned(),
    };
    Problem::error(what).at(place(error.position()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_stand_in_any_order() {
        let rows = parse(
            "# a splitter\nangle_deg, wavelength_um, rs, rp, ts, tp, phase_rp_deg\n45, 0.55, 0.5, 0.4, 0.5, 0.6, 90\n",
        );
        let row = rows.expect("a row")[0];
        assert_eq!((row.wavelength, row.angle), (0.55e-6, 45f64.to_radians()));
        assert_eq!(row.power, [0.5, 0.4, 0.5, 0.6]);
        assert_eq!(row.phase, [MIRROR[0], 90f64.to_radians(), 0.0, 0.0]);
    }

    #[test]
    fn means_of_both_polarisations_and_percents_are_read() {
        let power = |text: &str| parse(text).expect("rows")[0].power;
        assert_eq!(power("wavelength_nm,reflectance\n400,0.9\n"), [0.9, 0.9, 0.0, 0.0]);
        assert_eq!(
            power("wavelength_nm,reflectance_percent,transmittance_percent\n400,50,25\n"),
            [0.5, 0.5, 0.25, 0.25]
        );
        for bad in ["400,inf", "400,-0.1", "400,90", "400,=1+1", "400,0,9"] {
            assert!(parse(&format!("wavelength_nm,reflectance\n{bad}\n")).is_err(), "{bad}");
        }
        assert!(parse("wavelength_nm;reflectance\n400;0,9\n").is_err());
        assert!(parse("wavelength_nm,reflectance,rs\n400,0.9,0.9\n").is_err());
    }

    #[test]
    fn every_wrong_line_is_told() {
        let lines = |text: &str| -> Vec<u32> {
            let problems = parse(text).expect_err("wrong");
            problems.iter().map(|problem| problem.span.map_or(0, |span| span.line)).collect()
        };
        let head = "wavelength_nm,angle_deg,rs,rp,ts,tp\n";
        assert_eq!(
            lines(&format!("{head}550,0,1,1,0,0\n550,95,1,1,0,0\n550,x,1,1,0,0\n550,0\n550,0,2,1,0,0\n")),
            [3, 4, 5, 6]
        );
        assert_eq!(lines("wavelength_nm,angle_deg,rs,rp,ts\n"), [1]);
        assert_eq!(lines("wavelength,angle_deg,rs,rp,ts,tp\n"), [1]);
    }
}

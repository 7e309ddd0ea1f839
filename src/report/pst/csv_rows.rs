//! pst.csv: one row per direction, units in the column names.

use crate::study::pst::{Curve, GROUPS, Point};
use std::io::{self, Write};

const COLUMNS: [&str; 16] = [
    "sweep",
    "detector",
    "angle_deg",
    "azimuth_deg",
    "pst",
    "pst_error",
    "upper_limit",
    "stray",
    "stray_error",
    "psrr",
    "psrr_error",
    "rays",
    "contributing",
    "limit",
    "margin",
    "verdict",
];

/// Writes all rows in the order of the sweeps. Numbers read back to the same bits; what is not there is empty.
pub fn write(out: &mut (impl Write + ?Sized), curves: &[Curve]) -> io::Result<()> {
    let mut table = csv::Writer::from_writer(out);
    let groups = GROUPS.iter().flat_map(|group| {
        let name = group.replace(' ', "_");
        [name.clone(), format!("{name}_error")]
    });
    table.write_record(COLUMNS.iter().map(|name| (*name).to_owned()).chain(groups))?;
    for curve in curves {
        for point in &curve.points {
            table.write_record(row(curve, point))?;
        }
    }
    table.flush()
}

fn row(curve: &Curve, point: &Point) -> Vec<String> {
    let known = |value: Option<f64>| value.map_or(String::new(), number);
    let verdict = point.required.map_or(String::new(), |required| required.verdict.to_string());
    let mut row = vec![
        curve.sweep.clone(),
        curve.detector.clone(),
        point.angle_deg.to_string(),
        point.azimuth_deg.to_string(),
        number(point.pst.mean),
        number(point.pst.error),
        known(point.upper_limit),
        number(point.stray.mean),
        number(point.stray.error),
        known(point.psrr.map(|ratio| ratio.mean)),
        known(point.psrr.map(|ratio| ratio.error)),
        point.rays.to_string(),
        point.contributing.to_string(),
        known(point.required.map(|required| required.limit)),
        known(point.required.map(|required| required.margin)),
        verdict,
    ];
    row.extend(point.groups.iter().flat_map(|part| [number(part.mean), number(part.error)]));
    row
}

/// Shortest text that reads back to the same double.
fn number(value: f64) -> String {
    format!("{value:e}")
}

//! paths.csv: one row per path and detector, units in the column names.

use crate::tally::results::PathResult;
use std::io::{self, Write};

const COLUMNS: [&str; 13] = [
    "detector",
    "source",
    "sequence",
    "class",
    "rays",
    "flux_w",
    "flux_error_w",
    "percent",
    "ghost_order",
    "scatter_order",
    "last_scatter",
    "optical_path_m",
    "peak_w_m2",
];

/// Writes all rows in the order given. Numbers are written so that they read back to the same bits.
pub fn write(out: &mut impl Write, paths: &[PathResult]) -> io::Result<()> {
    let mut table = csv::Writer::from_writer(out);
    table.write_record(COLUMNS)?;
    for path in paths {
        table.write_record(row(path))?;
    }
    table.flush()
}

fn row(path: &PathResult) -> [String; 13] {
    [
        path.detector.clone(),
        path.source.clone(),
        path.sequence.clone(),
        path.class.clone(),
        path.rays.to_string(),
        number(path.flux_w.mean),
        number(path.flux_w.error),
        number(path.percent),
        path.ghost_order.to_string(),
        path.scatter_order.to_string(),
        path.last_scatter.clone(),
        number(path.optical_path_m),
        number(path.peak_w_m2),
    ]
}

/// Shortest text that reads back to the same double.
fn number(value: f64) -> String {
    format!("{value:e}")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tally::results::Estimate;

    #[test]
    fn a_row_reads_back_to_the_same_bits() {
        let path = PathResult {
            detector: "fpa".into(),
            source: "sun, low".into(),
            sequence: "sun > \"L1\":T".into(),
            class: "signal".into(),
            rays: 7,
            flux_w: Estimate { mean: 0.1 + 0.2, error: 1e-300 },
            percent: 100.0 / 3.0,
            ghost_order: 0,
            scatter_order: 0,
            reflectors: Vec::new(),
            last_scatter: String::new(),
            optical_path_m: 0.123,
            peak_w_m2: 4.0,
            cells: Vec::new(),
        };
        let mut bytes = Vec::new();
        write(&mut bytes, &[path]).unwrap();
        let mut reader = csv::Reader::from_reader(&bytes[..]);
        assert_eq!(reader.headers().unwrap(), COLUMNS.as_slice());
        let row = reader.records().next().unwrap().unwrap();
        assert_eq!((&row[1], &row[2]), ("sun, low", "sun > \"L1\":T"));
        assert_eq!(row[5].parse::<f64>().unwrap().to_bits(), (0.1f64 + 0.2).to_bits());
    }
}

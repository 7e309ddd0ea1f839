//! compare.csv: one row per variant, detector and quantity, units in the column names.

use crate::study::compare::{Change, Comparison};
use std::io::{self, Write};

const COLUMNS: [&str; 11] = [
    "variant",
    "detector",
    "quantity",
    "flux_w",
    "flux_error_w",
    "difference_w",
    "difference_error_w",
    "ratio",
    "ratio_error",
    "sigma",
    "verdict",
];

/// Writes all rows; numbers read back to the same bits.
pub fn write(out: &mut impl Write, comparison: &Comparison) -> io::Result<()> {
    let mut table = csv::Writer::from_writer(out);
    table.write_record(COLUMNS)?;
    for variant in &comparison.variants {
        for (detector, change) in &variant.detectors {
            let quantities =
                [("flux", Some(&change.flux)), ("stray", Some(&change.stray)), ("signal", change.signal.as_ref())];
            for (quantity, change_of) in quantities {
                let Some(of) = change_of else { continue };
                let verdict = if quantity == "stray" { change.verdict.as_str() } else { "" };
                table.write_record(row([&variant.name, detector, quantity], of, verdict))?;
            }
        }
    }
    table.flush()
}

fn row([variant, detector, quantity]: [&str; 3], change: &Change, verdict: &str) -> [String; 11] {
    let number = |value: f64| format!("{value:e}");
    let part = |of: Option<f64>| of.map_or(String::new(), number);
    [
        variant.into(),
        detector.into(),
        quantity.into(),
        number(change.flux_w.mean),
        number(change.flux_w.error),
        number(change.difference_w.mean),
        number(change.difference_w.error),
        part(change.ratio.map(|ratio| ratio.mean)),
        part(change.ratio.map(|ratio| ratio.error)),
        number(change.sigma),
        verdict.into(),
    ]
}

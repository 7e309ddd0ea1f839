//! objects.csv: one row per view, object and quantity, units in a column.

use super::heading;
use crate::study::objects::{Objects, View, Ways};
use crate::tally::results::Estimate;
use std::io::{self, Write};

const COLUMNS: [&str; 6] = ["view", "object", "quantity", "unit", "mean", "error"];

/// Writes all rows; numbers read back to the same bits. What no ray came to has its upper limit for a quantity of its own.
pub fn write(out: &mut impl Write, objects: &Objects) -> io::Result<()> {
    let mut table = Table(csv::Writer::from_writer(out));
    table.0.write_record(COLUMNS)?;
    for view in &objects.views {
        seen(&mut table, view)?;
        for first in &view.first_order {
            table.row(&view.detector, &first.object, ("first order", "W"), first.flux_w)?;
        }
        for warm in view.thermal.iter().flat_map(|thermal| &thermal.objects) {
            table.row(&view.detector, &warm.object, ("thermal", "W"), warm.flux_w)?;
            table.row(&view.detector, &warm.object, ("thermal", "photons/s"), warm.photons_per_s)?;
            table.limit(&view.detector, &warm.object, ("thermal upper limit", "W"), warm.upper_limit_w)?;
        }
    }
    for lit in &objects.lit {
        table.ways("sources", &lit.object, ("lit", "W"), &lit.flux_w)?;
        table.limit("sources", &lit.object, ("lit upper limit", "W"), lit.upper_limit_w)?;
    }
    table.0.flush()
}

fn seen<W: Write>(table: &mut Table<W>, view: &View) -> io::Result<()> {
    for seen in &view.seen {
        table.ways(&view.detector, &seen.object, ("seen", "sr"), &seen.seen_sr)?;
        table.row(&view.detector, &seen.object, ("absorbed", "sr"), seen.absorbed_sr)?;
        table.limit(&view.detector, &seen.object, ("seen upper limit", "sr"), seen.upper_limit_sr)?;
    }
    table.ways(&view.detector, "sky", ("seen", "sr"), &view.sky_sr)
}

struct Table<W: Write>(csv::Writer<W>);

impl<W: Write> Table<W> {
    fn row(&mut self, view: &str, object: &str, (quantity, unit): (&str, &str), of: Estimate) -> io::Result<()> {
        let numbers = [of.mean, of.error].map(|value| format!("{value:e}"));
        Ok(self.0.write_record([view, object, quantity, unit, &numbers[0], &numbers[1]])?)
    }

    fn ways(&mut self, view: &str, object: &str, (quantity, unit): (&str, &str), ways: &Ways) -> io::Result<()> {
        ways.iter().try_for_each(|(way, amount)| {
            self.row(view, object, (&format!("{quantity} {}", heading(*way)), unit), *amount)
        })
    }

    fn limit(&mut self, view: &str, object: &str, what: (&str, &str), limit: Option<f64>) -> io::Result<()> {
        limit.map_or(Ok(()), |limit| self.row(view, object, what, Estimate { mean: limit, error: 0.0 }))
    }
}

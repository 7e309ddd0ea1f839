//! Maps as FITS: one file per detector, every plane in double precision, checksummed.
//!
//! ```text
//! primary   mean                         axis 1 = columns, axis 2 = rows; row 0 at the bottom, as viewers show it
//! ERROR     standard error of the mean   same unit
//! RAYS      contributing source rays     64-bit integers
//! UPPER     upper limit where no ray came, else 0
//! EXTENT    bin size, m2 or sr: the sum of mean x extent is the flux
//! ```
//!
//! Lengths are in mm, angles in deg, at bin centres. No date is written: the same results are the same bytes.
//! Source: FITS Standard 4.0 (IAU FWG, 2018); checksums by its appendix J.

mod card;
mod checksum;

use crate::tally::results::{Axis, MapKind, MapResult, Results, RunInfo};
use card::Header;
use checksum::Sum;
use std::io::{self, Write};

/// Length of a FITS record, bytes: headers and data are padded to it.
const RECORD: usize = 2880;

/// Writes the primary map and its four extensions.
pub fn write(out: &mut impl Write, map: &MapResult, results: &Results, run: &RunInfo) -> io::Result<()> {
    let size = if map.unit.ends_with("sr") { "sr" } else { "m2" };
    let mut primary = Header::primary(-64, map.shape);
    describe(&mut primary, "MEAN", map.unit, map);
    origin(&mut primary, map, results, run);
    plane(out, primary, Cells::Real(&map.mean))?;
    for (name, unit, values) in
        [("ERROR", map.unit, &map.error), ("UPPER", map.unit, &map.upper), ("EXTENT", size, &map.extent)]
    {
        if name == "UPPER" {
            plane(out, extension("RAYS", "", 64, map), Cells::Count(&map.rays))?;
        }
        plane(out, extension(name, unit, -64, map), Cells::Real(values))?;
    }
    Ok(())
}

fn extension(name: &str, unit: &str, bits: i32, map: &MapResult) -> Header {
    let mut header = Header::image(bits, map.shape);
    describe(&mut header, name, unit, map);
    header
}

/// Name, unit and linear axes: the same in every plane.
fn describe(header: &mut Header, name: &str, unit: &str, map: &MapResult) {
    header.text("EXTNAME", name, "name of this plane");
    if !unit.is_empty() {
        header.text("BUNIT", unit, "unit of the values");
    }
    header.text("DETECTOR", &map.detector, "name in the system file");
    if let Some(filter) = &map.filter {
        header.text("FILTER", filter, "only the light that it means");
    }
    for (index, axis) in map.axes.iter().flatten().enumerate() {
        linear(header, index + 1, axis);
    }
}

fn linear(header: &mut Header, number: usize, axis: &Axis) {
    let (unit, factor) = match axis.unit {
        "m" => ("mm", 1e3),
        "rad" => ("deg", 180.0 / std::f64::consts::PI),
        _ => ("", 1.0),
    };
    if !(axis.start.is_finite() && axis.step.is_finite() && axis.step != 0.0) {
        return; // no bin size, no axis
    }
    header.text(&format!("CTYPE{number}"), &axis_name(&axis.name), "linear axis");
    if !unit.is_empty() {
        header.text(&format!("CUNIT{number}"), unit, "unit of the axis");
    }
    header.real(&format!("CRPIX{number}"), 1.0, "first pixel");
    header.real(&format!("CRVAL{number}"), factor * (axis.start + 0.5 * axis.step), "centre of the first pixel");
    header.real(&format!("CDELT{number}"), factor * axis.step, "pixel to pixel");
}

/// Upper case, eight letters at most: a name that no convention reads as a projection.
fn axis_name(name: &str) -> String {
    name.chars().filter(char::is_ascii_alphanumeric).take(8).collect::<String>().to_ascii_uppercase()
}

/// Where the map comes from and how it lies in the world: in the primary header only.
fn origin(header: &mut Header, map: &MapResult, results: &Results, run: &RunInfo) {
    header.text("SYSTEM", &results.system, "system that was traced");
    header.text("CREATOR", &format!("straylight {}", run.version), "program and version");
    header.count("SEED", results.seed, "seed of the random numbers");
    header.count("NRAYS", results.rays, "source rays traced");
    header.count("NBATCH", results.batches, "batches behind the errors");
    header.text("BINS", kind(map.kind), "how the bins lie");
    header.text("SIDE", map.side, "side of the detector");
    if map.kind != MapKind::Triangles {
        let vectors =
            [("ORIG", map.origin.map(|x| 1e3 * x)), ("COLDIR", map.column_direction), ("ROWDIR", map.row_direction)];
        for (name, vector) in vectors {
            for (letter, value) in ["X", "Y", "Z"].into_iter().zip(vector) {
                header.real(
                    &format!("{name}{letter}"),
                    value,
                    if name == "ORIG" { "grid corner, mm, world" } else { "unit vector, world" },
                );
            }
        }
    }
}

fn kind(kind: MapKind) -> &'static str {
    match kind {
        MapKind::Plane => "plane",
        MapKind::Polar => "polar",
        MapKind::Projected => "projected",
        MapKind::Triangles => "triangles",
    }
}

/// The values of one plane.
#[derive(Clone, Copy)]
enum Cells<'a> {
    Real(&'a [f64]),
    Count(&'a [u64]),
}

impl Cells<'_> {
    /// Big-endian bytes of each value, in order.
    fn bytes(&self) -> Box<dyn Iterator<Item = [u8; 8]> + '_> {
        match self {
            Cells::Real(values) => Box::new(values.iter().map(|value| value.to_be_bytes())),
            Cells::Count(values) => {
                Box::new(values.iter().map(|&value| i64::try_from(value).unwrap_or(i64::MAX).to_be_bytes()))
            }
        }
    }

    fn len(&self) -> usize {
        match self {
            Cells::Real(values) => values.len(),
            Cells::Count(values) => values.len(),
        }
    }
}

/// Header with checksums, data, padding.
fn plane(out: &mut impl Write, header: Header, cells: Cells) -> io::Result<()> {
    let mut data = Sum::default();
    cells.bytes().for_each(|bytes| data.add(&bytes));
    out.write_all(&header.sealed(data))?;
    cells.bytes().try_for_each(|bytes| out.write_all(&bytes))?;
    out.write_all(&vec![0; (8 * cells.len()).next_multiple_of(RECORD) - 8 * cells.len()])
}

#[cfg(test)]
mod tests;

//! A table as a list of entries (incidence, scattering angle, azimuth, value), in any order: laid on a grid.

use super::reading::{Problem, Rows, Unmeasured};
use super::tabulated::{Beyond, Lobe, Pole, Table};
use std::f64::consts::TAU;

/// One entry.
#[derive(Clone, Copy, Debug)]
pub struct Entry {
    /// Angle of incidence, deg.
    pub incidence: f64,
    /// Scattering angle from the normal, deg.
    pub theta: f64,
    /// Azimuth from the specular side, deg, 0 to 360; `None`: all azimuths alike.
    pub phi: Option<f64>,
    /// 1/sr
    pub value: f64,
}

/// The table of these entries. Places of the grid without an entry, and angles beyond the last, are what `unmeasured` says; azimuths up
/// to 180 deg alone are mirrored.
pub fn table(file: &mut Rows, entries: &[Entry], unmeasured: Unmeasured) -> Result<Table, Problem> {
    if let Some(last) = file.problems.pop() {
        return Err(last);
    }
    let incidences = distinct(entries.iter().map(|entry| entry.incidence));
    let mut lobes = Vec::new();
    for incidence in incidences {
        let of: Vec<&Entry> = entries.iter().filter(|entry| entry.incidence == incidence).collect();
        lobes.push(lobe(file, incidence, &of, unmeasured)?);
    }
    if lobes.iter().all(|lobe| lobe.tis() <= 0.0) {
        return Err(file.problem("every value is zero", "a value above zero"));
    }
    let expected = "one angle of incidence or more, from 0 to below 90 deg";
    Table::new(lobes, vec![(1e-6, 1.0)]).ok_or_else(|| file.problem("the table has no order", expected))
}

fn distinct(values: impl Iterator<Item = f64>) -> Vec<f64> {
    let mut list: Vec<f64> = values.collect();
    list.sort_by(f64::total_cmp);
    list.dedup();
    list
}

fn lobe(file: &Rows, incidence: f64, entries: &[&Entry], unmeasured: Unmeasured) -> Result<Lobe, Problem> {
    let refuse = |what: &str, expected: &str| file.problem(&format!("incidence {incidence} deg: {what}"), expected);
    let theta = distinct(entries.iter().map(|entry| entry.theta));
    let mut phi = distinct(entries.iter().filter(|entry| entry.theta > 0.0).filter_map(|entry| entry.phi));
    if phi.is_empty() {
        phi = vec![0.0];
    }
    let column = |at: f64| phi.iter().position(|p| *p == at);
    let mut cells: Vec<Vec<Option<f64>>> = vec![vec![None; theta.len()]; phi.len()];
    for entry in entries {
        let row = theta.iter().position(|t| *t == entry.theta).unwrap_or(0);
        // At the pole, and where all azimuths are alike, one entry stands for all.
        let columns = match entry.phi {
            Some(at) if entry.theta > 0.0 => column(at).map_or(0..0, |j| j..j + 1),
            _ => 0..phi.len(),
        };
        for cell in cells[columns].iter_mut().map(|column| &mut column[row]) {
            if cell.replace(entry.value).is_some() {
                let place = format!("theta {} deg is given twice", entry.theta);
                return Err(refuse(&place, "one value for every direction"));
            }
        }
    }
    let filled: Vec<Vec<f64>> = cells.into_iter().map(|column| fill(column, unmeasured)).collect();
    let (phi, filled) = closed(phi, filled);
    let value = (0..theta.len()).flat_map(|i| filled.iter().map(move |column| column[i])).collect();
    let beyond = if unmeasured == Unmeasured::Hold { Beyond::Hold } else { Beyond::Zero };
    let rad = |angles: Vec<f64>| angles.into_iter().map(f64::to_radians).collect::<Vec<_>>();
    Lobe::new(incidence.to_radians(), rad(theta), phi, value)
        .map(|lobe| lobe.about(Pole::Normal, beyond))
        .ok_or_else(|| refuse("there are too few angles", "two or more scattering angles"))
}

/// One azimuth with its empty places filled.
fn fill(column: Vec<Option<f64>>, unmeasured: Unmeasured) -> Vec<f64> {
    let first = column.iter().flatten().next().copied().unwrap_or(0.0);
    let mut last = if unmeasured == Unmeasured::Hold { first } else { 0.0 };
    let place = |value: Option<f64>| {
        if unmeasured == Unmeasured::Hold {
            last = value.unwrap_or(last);
            last
        } else {
            value.unwrap_or(0.0)
        }
    };
    column.into_iter().map(place).collect()
}

/// Azimuths (rad) from 0 to 2 pi with their columns.
fn closed(phi: Vec<f64>, columns: Vec<Vec<f64>>) -> (Vec<f64>, Vec<Vec<f64>>) {
    let mut all: Vec<(f64, Vec<f64>)> = phi.into_iter().map(f64::to_radians).zip(columns).collect();
    let half = all.last().is_some_and(|(last, _)| *last <= 0.5 * TAU * (1.0 + 1e-9));
    if half && all.len() > 1 {
        let mirrored: Vec<_> = all.iter().rev().map(|(at, column)| (TAU - at, column.clone())).collect();
        let middle = all.last().is_some_and(|(last, _)| (last - 0.5 * TAU).abs() < 1e-9);
        all.extend(mirrored.into_iter().skip(middle.into()));
    }
    let first = all[0].1.clone();
    all.retain(|(at, _)| *at < TAU * (1.0 - 1e-12));
    if all[0].0 > 0.0 {
        all.insert(0, (0.0, first.clone()));
    }
    let first = all[0].1.clone();
    all.push((TAU, first));
    all.into_iter().unzip()
}

//! Reader of a table of scatter as CSV with a header.
//!
//!     theta_i_deg,theta_s_deg,phi_deg,bsdf_per_sr
//!
//! One row per direction, in any order: incidence and scattering angle from the normal, azimuth from the specular side. Without
//! `phi_deg` all azimuths are alike, which holds at normal incidence only: from there the lobe moves with the ray.

use super::entries::{Entry, table};
use super::reading::{Problem, Rows, Unmeasured, shorten};
use super::tabulated::Table;

const COLUMNS: [&str; 4] = ["theta_i_deg", "theta_s_deg", "phi_deg", "bsdf_per_sr"];

/// Reads the text of a file.
pub fn parse(text: &str, unmeasured: Unmeasured) -> Result<Table, Vec<Problem>> {
    let mut file = Rows::new(text);
    let read = entries(&mut file).and_then(|entries| table(&mut file, &entries, unmeasured));
    read.map_err(|last| file.all(last))
}

fn entries(file: &mut Rows) -> Result<Vec<Entry>, Problem> {
    let header = file.next("a header")?;
    let names: Vec<&str> = header.split(',').map(str::trim).collect();
    let place = |name: &str| names.iter().position(|n| *n == name);
    let unknown = names.iter().find(|name| !COLUMNS.contains(name));
    let (Some(incidence), Some(theta), Some(value), None) =
        (place(COLUMNS[0]), place(COLUMNS[1]), place(COLUMNS[3]), unknown)
    else {
        return Err(file.problem(&format!("found the header `{}`", shorten(header)), &COLUMNS.join(",")));
    };
    let phi = place(COLUMNS[2]);
    let mut list: Vec<Entry> = Vec::new();
    while let Ok(row) = file.significant("a row") {
        let numbers = file.values(&row.replace(',', " "), "numbers separated by commas")?;
        if numbers.len() != names.len() || row.matches(',').count() + 1 != names.len() {
            return Err(file.problem(&format!("found {} numbers", numbers.len()), &format!("{} of them", names.len())));
        }
        let entry = Entry {
            incidence: numbers[incidence],
            theta: numbers[theta],
            phi: phi.map(|at| numbers[at].rem_euclid(360.0)),
            value: numbers[value],
        };
        if !(0.0..90.0).contains(&entry.incidence) || !(0.0..=90.0).contains(&entry.theta) {
            return Err(
                file.problem("an angle is out of range", "theta_i from 0 to below 90 deg, theta_s from 0 to 90 deg")
            );
        }
        if phi.is_none() && entry.incidence > 0.0 {
            return Err(file.problem("a slanting ray without an azimuth", "a column phi_deg, or normal incidence only"));
        }
        file.check(&[entry.value])?;
        list.push(entry);
    }
    if list.is_empty() {
        return Err(file.problem("there are no rows", "at least two directions"));
    }
    Ok(list)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_table_is_read_and_its_defects_are_named() {
        let good = "\u{feff}theta_i_deg,theta_s_deg,bsdf_per_sr\r\n0,0,0.3\r\n0,90,0.1\r\n";
        let tis = parse(good, Unmeasured::Zero).expect("a table").totals().next().expect("one").1[0];
        assert!(tis > 0.0, "{tis}");
        for (from, to, words) in [
            ("0.3", "-1", "-1"),
            ("0.3", "inf", "inf"),
            ("0,0,0.3", "0;0;0,3", "0;0;0"),
            ("0,0,0.3", "10,0,0.3", "azimuth"),
            ("0,0,0.3", "0,90,0.3", "twice"),
            ("0,0,0.3\r\n0,90,0.1", "", "no rows"),
            ("0.3\r\n0,90,0.1", "0\r\n0,90,0", "zero"),
            ("theta_s_deg", "theta", "header"),
        ] {
            let changed = good.replacen(from, to, 1);
            assert_ne!(changed, good, "nothing changed by {from:?}");
            let problems = parse(&changed, Unmeasured::Zero).expect_err("refused");
            assert!(problems[0].to_string().contains(words), "{to:?}: {problems:?}");
        }
    }
}

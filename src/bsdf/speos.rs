//! Reader of `.anisotropicbsdf` text files (OPTIS / Ansys Speos), reflection only.
//!
//! Rows, by the public description "Structure of Anisotropic BSDF Files" (Ansys Speos help):
//!
//!     1  header               2  0: text                     3  comment
//!     4  characters of the description, 5 the description (may span lines)
//!     6  anisotropy vector    7  has reflection, has transmission (0/1)
//!     8  1: values are proportional to the BSDF              9, 10  number of anisotropy angles, the angles (deg)
//!     11, 12  number of angles of incidence, the angles (deg)
//!     13  theta and phi (deg) at which the spectrum was measured; 14 description of the spectrum
//!     15  number of wavelengths, then rows: wavelength (nm), scattered fraction (%)
//!     then for every incidence: numbers of theta and phi, a row of phi (deg), rows of theta (deg) and one value per phi
//!
//! Values are pi x BRDF up to a factor; the factor is set, as the description says, so that the TIS at the incidence of row
//! 13 is the percentage of the spectrum. The specular direction is at phi = 0, theta = angle of incidence.
//!
//! Refused with a message: binary files, transmission, intensity values, several anisotropy angles.

use super::reading::{Problem, Rows, shorten};
use super::tabulated::{Lobe, Table};
use crate::math::table::linear;
use std::f64::consts::{FRAC_1_PI, TAU};

/// Reads the text of a file.
pub fn parse(text: &str) -> Result<Table, Vec<Problem>> {
    let mut file = Rows::new(text);
    file.speos().map_err(|last| file.all(last))
}

impl Rows<'_> {
    fn speos(&mut self) -> Result<Table, Problem> {
        self.header()?;
        let incidence = self.incidence()?;
        let reference = self.numbers("the angles (deg) of the spectrum", 2)?[0].to_radians();
        self.next("a description of the spectrum (may be empty)")?;
        let percent = self.spectrum()?;
        let mut lobes = Vec::new();
        for &theta in &incidence {
            lobes.push(self.lobe(theta)?);
        }
        if let Some(last) = self.problems.pop() {
            return Err(last);
        }
        let at = linear(&incidence, &lobes.iter().map(Lobe::tis).collect::<Vec<_>>(), reference);
        if at <= 0.0 {
            return Err(self.problem("the table is zero at the incidence of its spectrum", "a BRDF above zero"));
        }
        let spectrum = percent.into_iter().map(|[nm, p]| (nm * 1e-9, p / 100.0 / at)).collect();
        Table::new(lobes, spectrum)
            .ok_or_else(|| self.problem("the tables have no order", "rising angles and wavelengths"))
    }

    /// Rows 1 to 10.
    fn header(&mut self) -> Result<(), Problem> {
        let first = self.next("the header")?;
        if !first.starts_with("OPTIS - Anisotropic BSDF") {
            return Err(
                self.problem(&format!("found `{}`", shorten(first)), "`OPTIS - Anisotropic BSDF surface file v8.0`")
            );
        }
        self.choice("the mode", &["0"], "0 (text; a binary file can be saved as text in the Speos editor)")?;
        self.next("a comment")?;
        let length = self.count("the number of characters of the description")?;
        let mut read = self.next("the description")?.chars().count();
        while read < length {
            read += 1 + self.next("more of the description")?.chars().count();
        }
        self.numbers("the anisotropy vector", 3)?;
        self.choice("reflection and transmission", &["1", "0"], "`1 0`: reflection, no transmission")?;
        self.choice("the kind of values", &["1"], "1: proportional to the BSDF")?;
        self.choice("the number of anisotropy angles", &["1"], "1: isotropic about the normal")?;
        self.numbers("the anisotropy angle (deg)", 1)?;
        Ok(())
    }

    /// Rows 11 and 12, rad.
    fn incidence(&mut self) -> Result<Vec<f64>, Problem> {
        let count = self.count("the number of angles of incidence")?;
        let angles = self.numbers("the angles of incidence (deg)", count)?;
        self.rising(&angles, "angles of incidence", 0.0..90.0)?;
        Ok(angles.iter().map(|a| a.to_radians()).collect())
    }

    /// Row 15 and on: \[wavelength nm, percent\].
    fn spectrum(&mut self) -> Result<Vec<[f64; 2]>, Problem> {
        let count = self.count("the number of wavelengths")?;
        if count == 0 {
            return Err(self.problem("the spectrum is empty", "at least one wavelength"));
        }
        let mut rows: Vec<[f64; 2]> = Vec::new();
        for _ in 0..count {
            let row = self.numbers("a wavelength (nm) and a percentage", 2)?;
            let rises = rows.last().is_none_or(|last| last[0] < row[0]);
            if !(rises && row[0] > 0.0 && (0.0..=100.0).contains(&row[1])) {
                return Err(
                    self.problem(&format!("found {} nm, {} %", row[0], row[1]), "rising wavelengths and 0 to 100 %")
                );
            }
            rows.push([row[0], row[1]]);
        }
        Ok(rows)
    }

    /// One table.
    fn lobe(&mut self, incidence: f64) -> Result<Lobe, Problem> {
        let size = self.numbers("the numbers of theta and phi", 2)?;
        let count = |n: f64| (n.fract() == 0.0 && (2.0..1e6).contains(&n)).then_some(n as usize);
        let (Some(rows), Some(columns)) = (count(size[0]), count(size[1])) else {
            return Err(self.problem(&format!("found {} x {}", size[0], size[1]), "two whole numbers above 1"));
        };
        let phi = self.numbers("the azimuths (deg)", columns)?;
        self.rising(&phi, "azimuths", 0.0..360.0 + 1e-9)?;
        if phi[0] != 0.0 || phi[columns - 1] != 360.0 {
            return Err(self.problem("the azimuths do not close", "azimuths from 0 to 360 deg"));
        }
        let (mut theta, mut value) = (Vec::new(), Vec::new());
        for _ in 0..rows {
            let row = self.numbers("theta (deg) and a value for every azimuth", columns + 1)?;
            theta.push(row[0]);
            self.check(&row[1..])?;
            value.extend(row[1..].iter().map(|v| v * FRAC_1_PI));
        }
        self.rising(&theta, "scattering angles", 0.0..90.0 + 1e-9)?;
        let rad = |a: Vec<f64>| a.into_iter().map(f64::to_radians).collect::<Vec<_>>();
        let (theta, mut phi) = (rad(theta), rad(phi));
        phi[columns - 1] = TAU;
        Lobe::new(incidence, theta, phi, value).ok_or_else(|| self.problem("the table has no shape", "rising angles"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The smallest file: one incidence, 2 x 2 values of BRDF 1/pi.
    const SMALL: &str = "OPTIS - Anisotropic BSDF surface file v8.0\n0\nComment\n4\nDesc\n0\t1\t0\n1\t0\n1\n1\n0.0\n1\n30\n30 0\n\n\
                         1\n550 50\n2 2\n\t0 360\n0 1 1\n90 1 1\nEnd of file\n";

    /// The first problem of a changed file.
    fn first(from: &str, to: &str) -> Problem {
        let changed = SMALL.replacen(from, to, 1);
        assert_ne!(changed, SMALL, "nothing changed by {from:?}");
        parse(&changed).expect_err("refused").remove(0)
    }

    #[test]
    fn windows_line_ends_and_a_byte_order_mark_are_read() {
        assert!(parse(SMALL).is_ok());
        assert!(parse(&format!("\u{feff}{}", SMALL.replace('\n', "\r\n"))).is_ok());
    }

    #[test]
    fn every_defect_is_named_with_its_line() {
        for (from, to, line, words) in [
            ("OPTIS", "PRITS", 1, "PRITS"),
            ("v8.0\n0", "v8.0\n1", 2, "binary"),
            ("0\t1\t0\n1\t0", "0\t1\t0\n0\t1", 7, "reflection"),
            ("30\n30 0", "95\n30 0", 12, "incidence"),
            ("550 50", "550 150", 16, "150 %"),
            ("1\n550 50\n", "0\n", 15, "wavelength"),
            ("0 360", "0 180", 18, "360"),
            ("0 1 1\n", "0 1\n", 19, "2 numbers"),
            ("0 1 1\n", "0 1 NaN\n", 19, "NaN"),
            ("0 1 1\n", "0 1 -1\n", 19, "-1"),
            ("90 1 1\nEnd of file\n", "", 20, "ends here"),
            ("\n90 1 1", "\n0 1 1", 20, "rise"),
        ] {
            let problem = first(from, to);
            assert!(problem.to_string().contains(words), "{to:?}: {problem}");
            assert_eq!(problem.line, line, "{to:?}: {problem}");
        }
    }

    #[test]
    fn all_bad_rows_are_reported_at_once() {
        let bad = SMALL.replace("0 1 1\n", "0 1 -1\n");
        assert_eq!(parse(&bad).expect_err("two bad rows").len(), 2);
    }

    #[test]
    fn garbage_is_refused() {
        for text in ["", "\n\n", "OPTIS - Anisotropic BSDF", "\u{0}\u{1}"] {
            assert!(parse(text).is_err());
        }
    }
}

//! Reader of `.anisotropicbsdf` text files (OPTIS / Ansys Speos), of reflection, transmission or both.
//!
//! Rows, by the public description "Structure of Anisotropic BSDF Files" (Ansys Speos help):
//!
//!     1  header               2  0: text                     3  comment
//!     4  characters of the description, 5 the description (may span lines)
//!     6  anisotropy vector    7  has reflection, has transmission (0/1)
//!     8  values are proportional to 1: the BSDF, 0: BSDF x cos(theta)     9, 10  number of anisotropy angles, the angles (deg)
//!     11, 12  for every anisotropy angle: number of angles of incidence, the angles (deg)
//!     13  theta and phi (deg) at which the spectrum was measured; 14 description of the spectrum
//!     15  number of wavelengths, then rows: wavelength (nm), scattered fraction (%)
//!     then for every anisotropy angle and incidence: numbers of theta and phi, a row of phi (deg), rows of theta (deg) and one value per phi
//!
//! A file of both has rows 9 to 12 for reflection and again for transmission, rows 13 to 15 with the wavelengths likewise, then all tables
//! of reflection and all of transmission. So are the files that Ansys writes; the description does not say it (`tests/assets/Gaussian
//! Fresnel 10 deg.anisotropicbsdf` of github.com/ansys/pyspeos, format v11, where 4 % are reflected and 95 % transmitted).
//!
//! Values are pi x BRDF up to a factor; the factor is set, as the description says, so that the TIS at the incidence of row
//! 13 is the percentage of the spectrum. The specular direction is at phi = 0, theta = angle of incidence; of transmitted light theta
//! counts from either normal (0 to 90 or 90 to 180 deg). An anisotropy angle is that from the anisotropy vector to the projection of the
//! ray on the surface. The vector itself (row 6) is not used: a surface says its own lay.
//!
//! Lobes at 90 deg incidence, where no light arrives, are passed over. Refused with a message: binary files.

use super::reading::{Problem, Rows, shorten};
use super::tabulated::{Lobe, Table};
use crate::math::table::linear;
use std::f64::consts::{FRAC_1_PI, FRAC_PI_2, TAU};

/// Incidence (rad) above which there is no light: 90 deg to the rounding of decimals.
const GRAZING: f64 = FRAC_PI_2 - 1e-9;

/// Reads the text of a file: a table for every anisotropy angle, first of reflection, then of transmission.
pub fn parse(text: &str) -> Result<Vec<Table>, Vec<Problem>> {
    let mut file = Rows::new(text);
    file.speos().map_err(|last| file.all(last))
}

/// What the values of a file are.
#[derive(Clone, Copy)]
struct Kind {
    transmitted: bool,
    /// Proportional to BSDF x cos(theta), not to the BSDF.
    intensity: bool,
}

/// Rows 9 to 12: anisotropy angles, deg, and for each the angles of incidence, rad.
struct Angles {
    azimuths: Vec<f64>,
    incidences: Vec<Vec<f64>>,
}

/// Rows 13 to 15: theta and phi, deg, at which the spectrum was measured, and its rows \[wavelength nm, percent\].
struct Spectrum {
    reference: Vec<f64>,
    percent: Vec<[f64; 2]>,
}

impl Rows<'_> {
    fn speos(&mut self) -> Result<Vec<Table>, Problem> {
        let kinds = self.header()?;
        let angles = kinds.iter().map(|_| self.angles()).collect::<Result<Vec<Angles>, Problem>>()?;
        let spectra = kinds.iter().map(|_| self.spectrum()).collect::<Result<Vec<Spectrum>, Problem>>()?;
        let mut tables = Vec::new();
        for ((kind, angles), spectrum) in kinds.into_iter().zip(angles).zip(spectra) {
            tables.extend(self.tables(kind, &angles, spectrum)?);
        }
        self.problems.pop().map_or(Ok(tables), Err)
    }

    /// The tables of light that goes one way; none if a bad number was among them.
    fn tables(&mut self, kind: Kind, angles: &Angles, spectrum: Spectrum) -> Result<Vec<Table>, Problem> {
        let mut all = Vec::new();
        for incidence in &angles.incidences {
            all.push(incidence.iter().map(|&theta| self.lobe(theta, kind)).collect::<Result<Vec<Lobe>, Problem>>()?);
        }
        if !self.problems.is_empty() {
            return Ok(Vec::new());
        }
        all.iter_mut().for_each(|lobes| lobes.retain(|lobe| lobe.incidence() < GRAZING));
        let tis = |lobes: &Vec<Lobe>| {
            let (incidence, tis): (Vec<f64>, Vec<f64>) =
                lobes.iter().map(|lobe| (lobe.incidence(), lobe.tis())).unzip();
            linear(&incidence, &tis, spectrum.reference[0].to_radians())
        };
        let at = linear(&angles.azimuths, &all.iter().map(tis).collect::<Vec<_>>(), spectrum.reference[1]);
        if at <= 0.0 {
            return Err(self.problem("the table is zero at the incidence of its spectrum", "a BSDF above zero"));
        }
        let factors: Vec<(f64, f64)> =
            spectrum.percent.into_iter().map(|[nm, p]| (nm * 1e-9, p / 100.0 / at)).collect();
        let table = |(lobes, azimuth): (Vec<Lobe>, &f64)| {
            let table = Table::new(lobes, factors.clone())?.turned(azimuth.to_radians());
            Some(if kind.transmitted { table.transmitted() } else { table })
        };
        let tables: Option<Vec<Table>> = all.into_iter().zip(&angles.azimuths).map(table).collect();
        tables.ok_or_else(|| self.problem("the tables have no order", "rising angles and wavelengths"))
    }

    /// Rows 1 to 8: the ways that the light of the file goes.
    fn header(&mut self) -> Result<Vec<Kind>, Problem> {
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
        let sides = self.next("reflection and transmission")?.split_whitespace().collect::<Vec<_>>();
        let sides: &[bool] = match sides[..] {
            ["1", "0"] => &[false],
            ["0", "1"] => &[true],
            ["1", "1"] => &[false, true],
            _ => {
                let found = format!("reflection and transmission: found `{}`", shorten(&sides.join(" ")));
                return Err(self.problem(&found, "`1 0`, `0 1` or `1 1`"));
            }
        };
        let intensity = match self.count("the kind of values: 1 (BSDF) or 0 (intensity)")? {
            0 => true,
            1 => false,
            other => return Err(self.problem(&format!("the kind of values is {other}"), "1 (BSDF) or 0 (intensity)")),
        };
        Ok(sides.iter().map(|&transmitted| Kind { transmitted, intensity }).collect())
    }

    /// Rows 9 to 12.
    fn angles(&mut self) -> Result<Angles, Problem> {
        let count = self.count("the number of anisotropy angles")?;
        let azimuths = self.numbers("the anisotropy angles (deg)", count)?;
        self.rising(&azimuths, "anisotropy angles", 0.0..360.0 + 1e-9)?;
        let incidences = azimuths.iter().map(|_| self.incidence()).collect::<Result<_, Problem>>()?;
        Ok(Angles { azimuths, incidences })
    }

    /// Rows 11 and 12, rad.
    fn incidence(&mut self) -> Result<Vec<f64>, Problem> {
        let count = self.count("the number of angles of incidence")?;
        let angles = self.numbers("the angles of incidence (deg)", count)?;
        self.rising(&angles, "angles of incidence", 0.0..90.0 + 1e-9)?;
        if angles[0].to_radians() >= GRAZING {
            return Err(self.problem("no light arrives at 90 deg alone", "an angle of incidence below 90 deg"));
        }
        Ok(angles.iter().map(|a| a.to_radians()).collect())
    }

    /// Rows 13 to 15 and on.
    fn spectrum(&mut self) -> Result<Spectrum, Problem> {
        let reference = self.numbers("the angles (deg) of the spectrum", 2)?;
        self.next("a description of the spectrum (may be empty)")?;
        let count = self.count("the number of wavelengths")?;
        if count == 0 {
            return Err(self.problem("the spectrum is empty", "at least one wavelength"));
        }
        let mut percent: Vec<[f64; 2]> = Vec::new();
        for _ in 0..count {
            let row = self.numbers("a wavelength (nm) and a percentage", 2)?;
            let rises = percent.last().is_none_or(|last| last[0] < row[0]);
            if !(rises && row[0] > 0.0 && (0.0..=100.0).contains(&row[1])) {
                return Err(
                    self.problem(&format!("found {} nm, {} %", row[0], row[1]), "rising wavelengths and 0 to 100 %")
                );
            }
            percent.push([row[0], row[1]]);
        }
        Ok(Spectrum { reference, percent })
    }

    /// One table.
    fn lobe(&mut self, incidence: f64, kind: Kind) -> Result<Lobe, Problem> {
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
        let mut table: Vec<Vec<f64>> = Vec::new();
        for _ in 0..rows {
            let row = self.numbers("theta (deg) and a value for every azimuth", columns + 1)?;
            self.check(&row[1..])?;
            table.push(row);
        }
        let theta: Vec<f64> = table.iter().map(|row| row[0]).collect();
        let beyond = kind.transmitted && theta[0] >= 90.0;
        self.rising(&theta, "scattering angles", if beyond { 90.0..180.0 + 1e-9 } else { 0.0..90.0 + 1e-9 })?;
        if beyond {
            table.iter_mut().for_each(|row| row[0] = 180.0 - row[0]);
            table.reverse();
        }
        if kind.intensity {
            without_cosine(&mut table);
        }
        let theta = table.iter().map(|row| row[0]).collect();
        let value = table.iter().flat_map(|row| row[1..].iter().map(|v| v * FRAC_1_PI)).collect();
        let rad = |a: Vec<f64>| a.into_iter().map(f64::to_radians).collect::<Vec<_>>();
        let (theta, mut phi) = (rad(theta), rad(phi));
        phi[columns - 1] = TAU;
        Lobe::new(incidence, theta, phi, value).ok_or_else(|| self.problem("the table has no shape", "rising angles"))
    }
}

/// Rows of theta (deg) and values, each divided by cos(theta); at the horizon, where nothing is left to divide, the row before.
fn without_cosine(table: &mut [Vec<f64>]) {
    const HORIZON: f64 = 1e-9;
    for at in 0..table.len() {
        let cos = table[at][0].to_radians().cos();
        if cos > HORIZON {
            table[at][1..].iter_mut().for_each(|v| *v /= cos);
        } else if at > 0 {
            let before = table[at - 1][1..].to_vec();
            table[at][1..].copy_from_slice(&before);
        }
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
            ("0\t1\t0\n1\t0", "0\t1\t0\n0\t0", 7, "reflection"),
            ("0\n1\n1\n0.0", "0\n2\n1\n0.0", 8, "kind"),
            ("1\n0.0\n", "2\n90 0\n", 10, "anisotropy"),
            ("1\n0.0\n", "2\n0 90\n", 13, "angles of incidence"),
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

    /// Two anisotropy angles, of which the second scatters twice as much: a mean of both at 45 deg.
    #[test]
    fn several_anisotropy_angles_share_one_factor() {
        let two = SMALL
            .replace("1\n0.0\n1\n30\n30 0", "2\n0 90\n1\n30\n1\n30\n30 45")
            .replace("End of file", "2 2\n\t0 360\n0 2 2\n90 2 2\nEnd of file");
        let tables = parse(&two).expect("two tables");
        let tis: Vec<f64> = tables.iter().map(|table| table.totals().next().expect("one").1[0]).collect();
        assert!((tis[1] / tis[0] - 2.0).abs() < 1e-12);
        assert_eq!(tables.iter().map(|table| table.azimuth().to_degrees().round()).collect::<Vec<_>>(), [0.0, 90.0]);
        let brightest = crate::bsdf::Anisotropic::new(tables, 2.0).expect_err("4/3 x 50 % x 2").tis;
        assert!((brightest - 4.0 / 3.0).abs() < 1e-9, "{brightest}");
    }

    /// The same lobe as BSDF and as intensity, of transmitted light from either normal.
    #[test]
    fn intensities_and_angles_from_the_other_normal_are_the_same_table() {
        let rows = |rows: &str, kind: &str| {
            SMALL
                .replace("1\t0\n1\n1\n0.0", &format!("0\t1\n{kind}\n1\n0.0"))
                .replace("2 2\n\t0 360\n0 1 1\n90 1 1", rows)
        };
        let plain = rows("3 2\n0 360\n0 1 1\n60 3 3\n90 3 3", "1");
        for text in
            [rows("3 2\n0 360\n0 1 1\n60 1.5 1.5\n90 0 0", "0"), rows("3 2\n0 360\n90 3 3\n120 3 3\n180 1 1", "1")]
        {
            let [a, b] = [&plain, &text].map(|text| {
                let table = parse(text).expect("a table").remove(0);
                let model = crate::bsdf::Tabulated::new(table, 1.0).expect("below 100 %");
                let at = crate::optics::Incidence::in_air(0.5, 550e-9);
                crate::bsdf::Bsdf::eval(&model, &at, glam::DVec3::new(0.48, -0.36, -0.8))
            });
            assert!(a > 0.0 && (a / b - 1.0).abs() < 1e-9, "{a} {b}");
        }
    }

    /// As Ansys writes it: angles of both, spectra of both, tables of both; incidence goes up to 90 deg.
    #[test]
    fn reflection_and_transmission_follow_each_other() {
        let angles = "1\n0.0\n2\n30 90\n";
        let lobes = |theta: [u8; 2], value: u8| {
            format!("2 2\n\t0 360\n{} {value} {value}\n{} {value} {value}\n", theta[0], theta[1])
        };
        let tables = [lobes([0, 90], 1), lobes([0, 90], 0), lobes([90, 180], 3), lobes([90, 180], 0)].concat();
        let spectra = "30 0\nreflection\n1\n550 4\n30 0\ntransmission\n1\n550 95\n";
        let head = "OPTIS - Anisotropic BSDF surface file v11\n0\n\n0\n\n1\t0\t0\n1\t1\n1\n";
        let text = format!("{head}{angles}{angles}{spectra}{tables}End of file\n");
        let tables = parse(&text).expect("two tables");
        let at = crate::optics::Incidence::in_air(0.5, 550e-9);
        let model = |table: &Table| crate::bsdf::Tabulated::new(table.clone(), 1.0).expect("below 100 %");
        let albedo = |table: &Table| crate::bsdf::Bsdf::albedo(&model(table), &at);
        assert_eq!(tables.iter().map(Table::is_transmitted).collect::<Vec<_>>(), [false, true]);
        assert!((albedo(&tables[0]) - 0.04).abs() < 1e-12 && (albedo(&tables[1]) - 0.95).abs() < 1e-12);
        assert!(parse(&text.replace("30 90", "90")).is_err());
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

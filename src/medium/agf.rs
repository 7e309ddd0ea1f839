//! AGF glass catalogues: one glass after the other, each on lines that begin with two letters.
//!
//! | line | content |
//! |---|---|
//! | `NM` | name, number of the dispersion formula, six-digit code, n_d, V_d, ... |
//! | `CD` | coefficients of the formula, up to ten |
//! | `LD` | shortest and longest wavelength, um |
//! | `TD` | D0 D1 D2 E0 E1 ltk T: thermal dispersion and reference temperature, C (20 if missing) |
//! | `IT` | wavelength um, internal transmittance 0..1, thickness mm; a line for each wavelength |
//!
//! Formulas, l the wavelength in um, with a, b, c, .. the coefficients in their order:
//!
//! | number | n |
//! |---|---|
//! | 1 Schott | n^2 = a + b l^2 + c l^-2 + d l^-4 + e l^-6 + f l^-8 |
//! | 2, 6, 11 Sellmeier 1, 3, 5 | n^2 - 1 = a l^2 / (l^2 - b) + c l^2 / (l^2 - d) + ...: 3, 4 and 5 terms |
//! | 3 Herzberger | [`Herzberger`] |
//! | 4 Sellmeier 2 | n^2 - 1 = a + b l^2 / (l^2 - c^2) + d / (l^2 - e^2) |
//! | 5 Conrady | n = a + b / l + c / l^3.5 |
//! | 7 Handbook 1 | n^2 = a + b / (l^2 - c) - d l^2 |
//! | 8 Handbook 2 | n^2 = a + b l^2 / (l^2 - c) - d l^2 |
//! | 9 Sellmeier 4 | n^2 = a + b l^2 / (l^2 - c) + d l^2 / (l^2 - e) |
//! | 10 Extended 1 | n^2 = a + b l^2 + c l^-2 + d l^-4 + e l^-6 + f l^-8 + g l^-10 + h l^-12 |
//! | 12 Extended 2 | n^2 = a + b l^2 + c l^-2 + d l^-4 + e l^-6 + f l^-8 + g l^4 + h l^6 |
//! | 13 Extended 3 | n^2 = a + b l^2 + c l^4 + d l^-2 + e l^-4 + f l^-6 + g l^-8 + h l^-10 + i l^-12 |
//!
//! Index and wavelengths are relative to air of the reference temperature and one atmosphere. *Absorption*: tau = exp(-alpha d), so
//! alpha = -ln(tau) / d, linear as k between the wavelengths; of several thicknesses the thickest through which light is seen
//! counts. Where tau is printed as 0 through all of them, it is taken as [`DARKEST`]: the absorption is then a lower bound.
//! Other lines are not read: expansion, density, costs, stress.
//!
//! No catalogue is shipped (their licences forbid it); built from the format's public description, not from a maker's file.
//! Source: Ansys Zemax OpticStudio Help, "Glass catalogs: file format" and "Glass catalog formulas".

use super::air::ICE;
use super::catalogued::{Catalogued, Stated};
use super::dispersion::{Cauchy, Fraction, Fractions, Herzberger, Polynomial, Sellmeier};
use super::{Air, MICROMETRES, Medium, Tabulated, extinction};
use crate::error::{Problem, Span, did_you_mean};

/// Half of the last digit of a transmittance printed with three, dimensionless.
pub const DARKEST: f64 = 5e-4;

/// One line of the catalogue with its number, from 1.
#[derive(Clone, Copy)]
struct Line<'a> {
    number: usize,
    text: &'a str,
}

/// Text of a catalogue from its bytes: UTF-16 with a byte-order mark, else 8-bit, of which only ASCII matters.
pub fn decode(bytes: &[u8]) -> String {
    let wide = |unit: fn([u8; 2]) -> u16| {
        let units: Vec<u16> = bytes[2..].chunks_exact(2).map(|pair| unit([pair[0], pair[1]])).collect();
        String::from_utf16_lossy(&units)
    };
    match bytes {
        [0xff, 0xfe, ..] => wide(u16::from_le_bytes),
        [0xfe, 0xff, ..] => wide(u16::from_be_bytes),
        _ => String::from_utf8_lossy(bytes).trim_start_matches('\u{feff}').to_owned(),
    }
}

/// Reads one glass of a catalogue. `origin`: what reports call the catalogue.
pub fn parse(text: &str, glass: &str, origin: &str) -> Result<Stated, Problem> {
    let lines = section(text, glass)?;
    let head = lines[0];
    let fields: Vec<&str> = head.text.split_whitespace().collect();
    let stated = |index: usize| fields.get(index).and_then(|word| word.parse().ok()).filter(|x: &f64| *x > 0.0);
    // Some catalogues write the number as 2.0.
    let number = stated(2).filter(|x| x.fract() == 0.0).ok_or_else(|| {
        head.fault("the number of the dispersion formula is missing").expecting("`NM name formula ..`, formula 1 to 13")
    })?;
    let (coefficients, at) = one(&lines, "CD", head)?;
    let index = formula(number as u32, &coefficients).map_err(|problem| problem.at(at.place()))?;
    let (range, at) = one(&lines, "LD", head)?;
    let range = match range[..] {
        [low, high, ..] if 0.0 < low && low < high => [low / MICROMETRES, high / MICROMETRES],
        _ => return Err(at.fault("this is no range").expecting("`LD shortest longest`, um")),
    };
    let air = Air::at(temperature(&lines)?);
    let medium = Catalogued {
        origin: format!("{origin}, {glass}"),
        index,
        extinction: absorption(&lines)?,
        range,
        relative_to: Some(air),
        wavelengths_in: Some(air),
    };
    match medium.gap() {
        Some(gap) => Err(head.fault(&format!("`{glass}` has no index at {:.6} um", gap * MICROMETRES))),
        None => Ok(Stated { medium, n_d: stated(4), abbe: stated(5) }),
    }
}

/// The lines of a glass, `NM` first.
fn section<'a>(text: &'a str, glass: &str) -> Result<Vec<Line<'a>>, Problem> {
    let all = text.lines().enumerate().map(|(index, text)| Line { number: index + 1, text: text.trim() });
    let mut names = Vec::new();
    let mut found: Vec<Line> = Vec::new();
    let mut inside = false;
    for line in all {
        if line.key() == "NM" {
            let name = line.text.split_whitespace().nth(1).unwrap_or_default();
            inside = name.eq_ignore_ascii_case(glass);
            if inside && !found.is_empty() {
                let first = found[0].number;
                return Err(line
                    .fault(&format!("`{name}` is given again after line {first}"))
                    .expecting("each glass once"));
            }
            names.push(name);
        }
        if inside {
            found.push(line);
        }
    }
    if !found.is_empty() {
        return Ok(found);
    }
    if names.is_empty() {
        return Err(Problem::error("this is no AGF catalogue").expecting("lines `NM name formula ..` for its glasses"));
    }
    let problem = Problem::error(format!("none of its {} glasses is called {glass:?}", names.len()));
    Err(match did_you_mean(glass, names.iter().copied()) {
        Some(close) => problem.hinting(format!("did you mean {close:?}?")),
        None => problem.expecting(format!("one of {}", listed(&names))),
    })
}

fn listed(names: &[&str]) -> String {
    let more = if names.len() > 8 { ", ..." } else { "" };
    names.iter().take(8).copied().collect::<Vec<_>>().join(", ") + more
}

impl<'a> Line<'a> {
    fn key(self) -> &'a str {
        self.text.split_whitespace().next().unwrap_or_default()
    }

    fn place(self) -> Span {
        Span { line: self.number as u32, column: 1, len: 0 }
    }

    fn fault(self, what: &str) -> Problem {
        Problem::error(what).at(self.place())
    }

    /// The numbers after the key, all finite.
    fn numbers(self) -> Result<Vec<f64>, Problem> {
        let number = |word: &str| word.parse().ok().filter(|x: &f64| x.is_finite());
        let words = self.text.split_whitespace().skip(1);
        words.map(|word| number(word).ok_or_else(|| self.fault(&format!("{word:?} is not a number")))).collect()
    }
}

/// Numbers of the only line with this key.
fn one<'a>(lines: &[Line<'a>], key: &str, head: Line<'a>) -> Result<(Vec<f64>, Line<'a>), Problem> {
    let line = lines.iter().find(|line| line.key() == key);
    let line = line.ok_or_else(|| head.fault(&format!("this glass has no line `{key}`")))?;
    Ok((line.numbers()?, *line))
}

/// Reference temperature, K.
fn temperature(lines: &[Line]) -> Result<f64, Problem> {
    let Some(line) = lines.iter().find(|line| line.key() == "TD") else { return Ok(super::air::ROOM) };
    // Makers that give no thermal data leave the line empty or write underscores.
    let celsius: f64 = line.text.split_whitespace().nth(7).and_then(|word| word.parse().ok()).unwrap_or(20.0);
    if !(-200.0..1000.0).contains(&celsius) {
        return Err(line
            .fault(&format!("a reference temperature of {celsius} C"))
            .expecting("degrees Celsius, as in 20"));
    }
    Ok(celsius + ICE)
}

/// Extinction of the internal transmittances; `None` without any.
fn absorption(lines: &[Line]) -> Result<Option<Tabulated>, Problem> {
    // Wavelength um, tau, thickness mm.
    let mut rows: Vec<[f64; 3]> = Vec::new();
    for line in lines.iter().filter(|line| line.key() == "IT") {
        match line.numbers()?[..] {
            // An empty line stands where a glass has no data.
            [] => {}
            [wavelength, tau, thickness, ..] if wavelength > 0.0 && (0.0..=1.0).contains(&tau) && thickness > 0.0 => {
                rows.push([wavelength, tau, thickness]);
            }
            _ => {
                let expected = "`IT wavelength transmittance thickness`: um, 0 to 1, mm";
                return Err(line.fault("this is no internal transmittance").expecting(expected));
            }
        }
    }
    // First of one wavelength comes the thickest that light is seen through, else the thinnest.
    rows.sort_by(|a, b| {
        let seen = |row: &[f64; 3]| row[1] > 0.0;
        let rank = |row: &[f64; 3]| if seen(row) { -row[2] } else { row[2] };
        a[0].total_cmp(&b[0]).then(seen(b).cmp(&seen(a))).then(rank(a).total_cmp(&rank(b)))
    });
    rows.dedup_by_key(|row| row[0]);
    let wavelengths: Vec<f64> = rows.iter().map(|row| row[0] / MICROMETRES).collect();
    let of = |row: &[f64; 3]| extinction(-row[1].max(DARKEST).ln() / (row[2] * 1e-3), row[0] / MICROMETRES);
    let k: Vec<f64> = rows.iter().map(of).collect();
    Ok(Tabulated::new(wavelengths, &vec![0.0; k.len()], &k))
}

/// Formula `number` with its coefficients; those left out at the end are 0.
fn formula(number: u32, given: &[f64]) -> Result<Box<dyn Medium>, Problem> {
    let c: [f64; 10] = std::array::from_fn(|index| given.get(index).copied().unwrap_or(0.0));
    let powers = |exponents: &[i32]| -> Box<dyn Medium> {
        Box::new(Polynomial { terms: c.iter().zip(exponents).map(|(c, e)| (*c, f64::from(*e))).collect() })
    };
    let sellmeier = |constant: f64, pairs: &[f64]| -> Box<dyn Medium> {
        let resonance = |pair: &[f64]| (pair[0], pair[1] / (MICROMETRES * MICROMETRES));
        let terms = std::iter::once((constant, 0.0)).chain(pairs.chunks_exact(2).map(resonance)).collect();
        Box::new(Sellmeier { terms, range: None })
    };
    let fractions = |fractions: &[(f64, f64, f64)], terms: Vec<(f64, f64)>| -> Box<dyn Medium> {
        let fraction = |&(strength, power, pole): &(f64, f64, f64)| Fraction { strength, power, pole };
        Box::new(Fractions { fractions: fractions.iter().map(fraction).collect(), terms })
    };
    Ok(match number {
        1 => powers(&[0, 2, -2, -4, -6, -8]),
        2 => sellmeier(0.0, &c[..6]),
        3 => Box::new(Herzberger { coefficients: std::array::from_fn(|index| c[index]) }),
        4 => fractions(&[(c[1], 2.0, c[2] * c[2]), (c[3], 0.0, c[4] * c[4])], vec![(1.0 + c[0], 0.0)]),
        5 => Box::new(Cauchy { terms: vec![(c[0], 0.0), (c[1], -1.0), (c[2], -3.5)] }),
        6 => sellmeier(0.0, &c[..8]),
        7 => fractions(&[(c[1], 0.0, c[2])], vec![(c[0], 0.0), (-c[3], 2.0)]),
        8 => fractions(&[(c[1], 2.0, c[2])], vec![(c[0], 0.0), (-c[3], 2.0)]),
        9 => sellmeier(c[0] - 1.0, &c[1..5]),
        10 => powers(&[0, 2, -2, -4, -6, -8, -10, -12]),
        11 => sellmeier(0.0, &c),
        12 => powers(&[0, 2, -2, -4, -6, -8, 4, 6]),
        13 => powers(&[0, 2, 4, -2, -4, -6, -8, -10, -12]),
        _ => {
            return Err(Problem::error(format!("there is no dispersion formula {number}")).expecting("1 to 13"));
        }
    })
}

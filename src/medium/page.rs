//! Pages of refractiveindex.info: YAML files with an index by formula or table, an absorption by table, and conditions.
//!
//! Wavelengths in um. `DATA` holds at most one block that gives n and one that gives k:
//!
//! | type | n or k |
//! |---|---|
//! | formula 1 | Sellmeier, n^2 - 1 = c1 + c2 l^2 / (l^2 - c3^2) + ... ([`Sellmeier`]) |
//! | formula 2 | Sellmeier-2, n^2 - 1 = c1 + c2 l^2 / (l^2 - c3) + ... ([`Sellmeier`]) |
//! | formula 3 | polynomial, n^2 = c1 + c2 l^c3 + ... ([`Polynomial`]) |
//! | formula 4 | n^2 = c1 + c2 l^c3 / (l^2 - c4^c5) + c6 l^c7 / (l^2 - c8^c9) + c10 l^c11 + ... ([`Fractions`]) |
//! | formula 5 | Cauchy, n = c1 + c2 l^c3 + ... ([`Cauchy`]) |
//! | formula 6 | gases, n - 1 = c1 + c2 / (c3 - l^-2) + ... ([`Gas`]) |
//! | formula 7 | [`Herzberger`] |
//! | formula 8 | [`Retro`] |
//! | formula 9 | [`Exotic`] |
//! | tabulated nk, n, k | rows of wavelength and values, linear between ([`Tabulated`]) |
//!
//! Coefficients left out at the end are 0. *Air or vacuum*: `n_is_absolute` and `wavelength_is_vacuum` under `CONDITIONS`
//! say it. Where a page does not, a glass of a catalogue (a page that states nd and Vd) is relative to air of its temperature
//! (20 C if not stated) and one atmosphere, its wavelengths too; anything else is absolute.
//!
//! Left out: thermal dispersion and all other properties.
//! Source: M. Polyanskiy, Refractiveindex.info database of optical constants, Sci. Data 11, 94 (2024), and its "Dispersion formulas".

use super::air::{ICE, ROOM};
use super::catalogued::{Catalogued, Stated};
use super::dispersion::{Cauchy, Exotic, Fraction, Fractions, Gas, Herzberger, Polynomial, Retro, Sellmeier};
use super::{Air, MICROMETRES, Medium, Tabulated};
use crate::error::{Problem, Span};
use serde::Deserialize;
use serde_saphyr::{Location, Spanned};

/// A page as written.
#[derive(Deserialize)]
struct Written {
    #[serde(rename = "DATA")]
    data: Vec<Spanned<Block>>,
    #[serde(rename = "CONDITIONS", alias = "SPECS", default)]
    conditions: Option<Conditions>,
    #[serde(rename = "PROPERTIES", default)]
    properties: Option<Properties>,
}

#[derive(Deserialize)]
struct Block {
    #[serde(rename = "type")]
    kind: String,
    wavelength_range: Option<String>,
    coefficients: Option<String>,
    data: Option<String>,
}

#[derive(Deserialize, Default)]
struct Conditions {
    n_is_absolute: Option<bool>,
    wavelength_is_vacuum: Option<bool>,
    temperature: Option<String>,
}

#[derive(Deserialize, Default)]
struct Properties {
    nd: Option<f64>,
    #[serde(rename = "Vd")]
    abbe: Option<f64>,
}

/// What the blocks of a page give.
#[derive(Default)]
struct Given {
    index: Option<(Box<dyn Medium>, [f64; 2])>,
    extinction: Option<Tabulated>,
}

/// Reads a page. `origin`: what reports call it. Fails with the first thing that is wrong, with its line.
pub fn parse(text: &str, origin: &str) -> Result<Stated, Problem> {
    let options = serde_saphyr::options! { with_snippet: false };
    let written: Written = serde_saphyr::from_str_with_options(text, options).map_err(|fault| {
        let place = fault.location().and_then(place);
        let what = fault.to_string();
        let what = what.lines().next().unwrap_or_default();
        Problem::error(format!("this is not a page of refractiveindex.info: {what}"))
            .at(place)
            .expecting("YAML with a list `DATA`")
    })?;
    let mut given = Given::default();
    for block in &written.data {
        given.add(&block.value).map_err(|problem| problem.at(place(block.referenced)))?;
    }
    let Some((index, range)) = given.index else {
        return Err(Problem::error("this page gives no refractive index").expecting("a formula, or a table of n"));
    };
    let Properties { nd: n_d, abbe } = written.properties.unwrap_or_default();
    let conditions = written.conditions.unwrap_or_default();
    let catalogue = n_d.is_some() && abbe.is_some();
    let air = Air::at(conditions.kelvin()?);
    let in_air = |vacuum: Option<bool>| (!vacuum.unwrap_or(!catalogue)).then_some(air);
    let medium = Catalogued {
        origin: origin.to_owned(),
        index,
        extinction: given.extinction,
        range,
        relative_to: in_air(conditions.n_is_absolute),
        wavelengths_in: in_air(conditions.wavelength_is_vacuum.or(conditions.n_is_absolute)),
    };
    match medium.gap() {
        Some(at) => Err(Problem::error(format!("there is no index at {:.6} um", at * MICROMETRES))
            .expecting("n above 0 and k of 0 or more in the whole range")),
        None => Ok(Stated { medium, n_d, abbe }),
    }
}

fn place(location: Location) -> Option<Span> {
    let [line, column] = [location.line(), location.column()].map(|number| u32::try_from(number).ok());
    Some(Span { line: line.filter(|line| *line > 0)?, column: column?, len: 0 })
}

impl Conditions {
    /// Temperature, K: a number of kelvin, or of degrees with "C".
    fn kelvin(&self) -> Result<f64, Problem> {
        let Some(text) = &self.temperature else { return Ok(ROOM) };
        let celsius = text.trim_end().strip_suffix('C').map(|number| number.trim_end_matches(['°', ' ']));
        let kelvin = match celsius {
            Some(number) => number.trim().parse().map(|t: f64| t + ICE),
            None => text.trim().trim_end_matches([' ', 'K']).parse(),
        };
        kelvin.ok().filter(|t: &f64| *t > 100.0 && *t < 2000.0).ok_or_else(|| {
            Problem::error(format!("the temperature is {text:?}")).expecting("kelvin, as in 293, or \"20 °C\"")
        })
    }
}

impl Given {
    fn add(&mut self, block: &Block) -> Result<(), Problem> {
        let twice = |what: &str| Problem::error(format!("{what} is given twice")).expecting("one block for each");
        let rows = |columns| table(block.data.as_deref().unwrap_or_default(), &block.kind, columns);
        match block.kind.as_str() {
            "tabulated k" => {
                let [wavelength, k, _] = rows(2)?;
                let table = Tabulated::new(wavelength, &vec![0.0; k.len()], &k).ok_or_else(|| unsorted(&block.kind))?;
                self.extinction.replace(table).map_or(Ok(()), |_| Err(twice("the absorption")))
            }
            "tabulated nk" | "tabulated n" => {
                let [wavelength, n, k] = rows(if block.kind.ends_with('k') { 3 } else { 2 })?;
                let table = Tabulated::new(wavelength, &n, &k).ok_or_else(|| unsorted(&block.kind))?;
                let range = table.range().unwrap_or_default();
                self.index.replace((Box::new(table), range)).map_or(Ok(()), |_| Err(twice("the index")))
            }
            kind => {
                let number = kind.strip_prefix("formula ").and_then(|number| number.trim().parse().ok());
                let known = number.filter(|number| (1..=9).contains(number)).ok_or_else(|| {
                    Problem::error(format!("there is no data of type {kind:?}"))
                        .expecting("`formula 1` to `formula 9`, `tabulated nk`, `tabulated n` or `tabulated k`")
                })?;
                let c = numbers(block.coefficients.as_deref().unwrap_or_default(), "`coefficients`")?;
                let range = range(block.wavelength_range.as_deref().unwrap_or_default())?;
                let medium = formula(known, &c)?;
                self.index.replace((medium, range)).map_or(Ok(()), |_| Err(twice("the index")))
            }
        }
    }
}

fn unsorted(kind: &str) -> Problem {
    Problem::error(format!("the wavelengths of `{kind}` do not increase")).expecting("increasing wavelengths in um")
}

/// Numbers between blanks, all finite.
fn numbers(text: &str, what: &str) -> Result<Vec<f64>, Problem> {
    let number = |word: &str| word.parse().ok().filter(|x: &f64| x.is_finite());
    text.split_whitespace()
        .map(|word| {
            let shown: String = word.chars().take(40).collect();
            number(word).ok_or_else(|| Problem::error(format!("{what}: {shown:?} is not a number")))
        })
        .collect()
}

fn range(text: &str) -> Result<[f64; 2], Problem> {
    match numbers(text, "`wavelength_range`")?[..] {
        [low, high] if 0.0 < low && low < high => Ok([low / MICROMETRES, high / MICROMETRES]),
        _ => {
            Err(Problem::error("`wavelength_range` is missing or no range")
                .expecting("two increasing wavelengths in um"))
        }
    }
}

/// Columns of a table: wavelengths (m), and one or two of values; the last one is 0 if `columns` is 2. Rows of one
/// wavelength, as rounding makes them, count as their mean.
fn table(text: &str, kind: &str, columns: usize) -> Result<[Vec<f64>; 3], Problem> {
    let mut rows: Vec<Vec<f64>> = Vec::new();
    for (index, line) in text.lines().filter(|line| !line.trim().is_empty()).enumerate() {
        let what = format!("row {} of `{kind}`", index + 1);
        let row = numbers(line, &what)?;
        let negative = row.iter().any(|x| *x < 0.0) || row.first() == Some(&0.0);
        if row.len() != columns || negative {
            let fault = if negative { "holds a negative value".into() } else { format!("has {} values", row.len()) };
            let expected = format!("{columns} values: a wavelength in um, then what `{kind}` says");
            return Err(Problem::error(format!("{what} {fault}")).expecting(expected));
        }
        rows.push(row);
    }
    if rows.is_empty() {
        return Err(Problem::error(format!("`{kind}` has no rows")).expecting("a row for each wavelength"));
    }
    let mut table: [Vec<f64>; 3] = Default::default();
    for same in rows.chunk_by(|a, b| a[0] == b[0]) {
        let mean = |column: usize| same.iter().filter_map(|row| row.get(column)).sum::<f64>() / same.len() as f64;
        table[0].push(same[0][0] / MICROMETRES);
        table[1].push(mean(1));
        table[2].push(mean(2));
    }
    Ok(table)
}

/// Formula `number` (1..9) with its coefficients.
fn formula(number: u32, c: &[f64]) -> Result<Box<dyn Medium>, Problem> {
    let most = [17, 17, 17, 17, 11, 11, 6, 4, 6][number as usize - 1];
    let paired = !matches!(number, 7..=9) && c.len().is_multiple_of(2) && !(number == 4 && c.len() < 9);
    if c.is_empty() || c.len() > most || paired {
        let expected = if number < 7 { format!("an odd number, up to {most}") } else { format!("{most}") };
        return Err(Problem::error(format!("formula {number} has {} coefficients", c.len())).expecting(expected));
    }
    let at = |index: usize| c.get(index).copied().unwrap_or(0.0);
    let pairs = |from: usize| -> Vec<(f64, f64)> {
        let rest = c.get(from..).unwrap_or_default();
        rest.chunks_exact(2).map(|pair| (pair[0], pair[1])).collect()
    };
    let powers = |from: usize| -> Vec<(f64, f64)> { std::iter::once((c[0], 0.0)).chain(pairs(from)).collect() };
    let sellmeier = |square: fn(f64) -> f64| -> Box<dyn Medium> {
        let resonances = pairs(1).into_iter().map(|(b, c)| (b, square(c) / (MICROMETRES * MICROMETRES)));
        Box::new(Sellmeier { terms: std::iter::once((c[0], 0.0)).chain(resonances).collect(), range: None })
    };
    Ok(match number {
        1 => sellmeier(|c| c * c),
        2 => sellmeier(|c| c),
        3 => Box::new(Polynomial { terms: powers(1) }),
        4 => {
            // A fraction of strength 0 is not there, whatever its pole.
            let fraction = |i: usize| Fraction { strength: at(i), power: at(i + 1), pole: at(i + 2).powf(at(i + 3)) };
            let fractions = [1, 5].map(fraction).into_iter().filter(|f| f.strength != 0.0).collect();
            Box::new(Fractions { fractions, terms: powers(9) })
        }
        5 => Box::new(Cauchy { terms: powers(1) }),
        6 => Box::new(Gas { constant: c[0], terms: pairs(1) }),
        7 => Box::new(Herzberger { coefficients: std::array::from_fn(at) }),
        8 => Box::new(Retro { coefficients: std::array::from_fn(at) }),
        _ => Box::new(Exotic { coefficients: std::array::from_fn(at) }),
    })
}

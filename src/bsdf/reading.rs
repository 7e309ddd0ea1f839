//! Tables of scatter in files: which format, and what all readers share.
//!
//! | format | known by | reader |
//! |---|---|---|
//! | Ansys Speos `.anisotropicbsdf` | `OPTIS` in the first line | [`super::speos`] |
//! | Zemax `.bsdf` | the key `ScatterAzimuth` | [`super::zemax`] |
//! | FRED tabulated BSDF | `type bsdf_data` | [`super::fred`] |
//! | CSV | a header with `bsdf_per_sr` | [`super::csv_table`] |

use super::tabulated::Table;
use super::{csv_table, fred, speos, zemax};
use std::fmt;

/// What is wrong with a file, and where.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Problem {
    /// 1-based.
    pub line: usize,
    pub message: String,
    pub expected: String,
}

impl fmt::Display for Problem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "line {}: {}; expected {}", self.line, self.message, self.expected)
    }
}

impl std::error::Error for Problem {}

/// What a zero, or an empty place, of a measured table means where it stands for "not measured".
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Unmeasured {
    /// No light.
    #[default]
    Zero,
    /// What was measured last on the way out from the specular direction, or from the normal if angles count from there.
    Hold,
}

/// Reads the text of a file in any of the formats: one table, or one for each of several azimuths of the sample. All bad numbers are reported (the first twenty); anything that makes the rest
/// unreadable stops.
pub fn parse(text: &str, unmeasured: Unmeasured) -> Result<Vec<Table>, Vec<Problem>> {
    let text = text.trim_start_matches('\u{feff}');
    let head = |word: &str| text.lines().take(200).any(|line| line.trim_start().starts_with(word));
    if text.starts_with("OPTIS") {
        speos::parse(text)
    } else if head("type bsdf_data") {
        fred::parse(text, unmeasured).map(|table| vec![table])
    } else if head("ScatterAzimuth") {
        zemax::parse(text, unmeasured)
    } else if text.lines().next().is_some_and(|line| line.contains("bsdf_per_sr")) {
        csv_table::parse(text, unmeasured).map(|table| vec![table])
    } else if head("<?xml") || head("<WindowElement") {
        let expected = "a text table here; XML of a window is read by `Klems(file: ..)`".into();
        Err(vec![Problem { line: 1, message: "this is XML".into(), expected }])
    } else {
        let known =
            "a Speos .anisotropicbsdf, a Zemax .bsdf, a FRED table (`type bsdf_data`), or a CSV with `bsdf_per_sr`";
        Err(vec![Problem { line: 1, message: "no table of scatter that is known here".into(), expected: known.into() }])
    }
}

/// Problems collected before giving up.
pub(super) const ENOUGH: usize = 20;

/// The lines of a file, with what was wrong so far.
pub(super) struct Rows<'a> {
    lines: std::str::Lines<'a>,
    /// 1-based; 0 before the first.
    line: usize,
    pub problems: Vec<Problem>,
}

impl<'a> Rows<'a> {
    pub fn new(text: &'a str) -> Rows<'a> {
        Rows { lines: text.trim_start_matches('\u{feff}').lines(), line: 0, problems: Vec::new() }
    }

    /// All problems, the last one being what stopped the reading.
    pub fn all(mut self, last: Problem) -> Vec<Problem> {
        self.problems.push(last);
        self.problems
    }

    /// Values must be BRDF; every bad row is noted, reading goes on.
    pub fn check(&mut self, values: &[f64]) -> Result<(), Problem> {
        if let Some(bad) = values.iter().find(|v| **v < 0.0) {
            let problem = self.problem(&format!("found a BRDF of {bad}"), "values >= 0");
            if self.problems.len() + 1 >= ENOUGH {
                return Err(problem);
            }
            self.problems.push(problem);
        }
        Ok(())
    }

    pub fn rising(&self, values: &[f64], name: &str, range: std::ops::Range<f64>) -> Result<(), Problem> {
        let good =
            !values.is_empty() && values.windows(2).all(|w| w[0] < w[1]) && values.iter().all(|v| range.contains(v));
        if good {
            return Ok(());
        }
        let expected = format!("at least one, rising, from {} to {} deg", range.start, range.end.round());
        Err(self.problem(&format!("the {name} do not rise or leave their range"), &expected))
    }

    pub fn next(&mut self, expected: &str) -> Result<&'a str, Problem> {
        self.line += 1;
        self.lines.next().ok_or_else(|| self.problem("the file ends here", expected))
    }

    /// The next line that is not empty and no comment.
    pub fn significant(&mut self, expected: &str) -> Result<&'a str, Problem> {
        loop {
            let row = self.next(expected)?.trim();
            if !row.is_empty() && !row.starts_with(['#', '!']) {
                return Ok(row);
            }
        }
    }

    /// Finite numbers separated by blanks, exactly `count` of them.
    pub fn numbers(&mut self, what: &str, count: usize) -> Result<Vec<f64>, Problem> {
        let row = self.next(what)?;
        let values = self.values(row, what)?;
        if values.len() == count {
            return Ok(values);
        }
        Err(self.problem(&format!("found {} numbers", values.len()), &format!("{count}: {what}")))
    }

    /// The finite numbers of a row.
    pub fn values(&self, row: &str, what: &str) -> Result<Vec<f64>, Problem> {
        let number = |word: &str| match word.parse::<f64>() {
            Ok(value) if value.is_finite() => Ok(value),
            _ => Err(self.problem(&format!("`{}` is no number", shorten(word)), what)),
        };
        row.split_whitespace().map(number).collect()
    }

    pub fn count(&mut self, what: &str) -> Result<usize, Problem> {
        let row = self.next(what)?;
        row.trim().parse().map_err(|_| self.problem(&format!("found `{}`", shorten(row)), what))
    }

    pub fn choice(&mut self, what: &str, allowed: &[&str], expected: &str) -> Result<(), Problem> {
        let row = self.next(what)?;
        if row.split_whitespace().eq(allowed.iter().copied()) {
            return Ok(());
        }
        Err(self.problem(&format!("{what}: found `{}`", shorten(row)), expected))
    }

    pub fn problem(&self, message: &str, expected: &str) -> Problem {
        Problem { line: self.line, message: message.to_string(), expected: expected.to_string() }
    }
}

/// The beginning of a text, for a message.
pub(super) fn shorten(text: &str) -> String {
    text.chars().take(40).collect()
}

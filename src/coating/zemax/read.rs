//! From the lines of a COATING.DAT file to one of its coatings.

use super::{Entry, Film, Found, Thickness};
use crate::coating::tabulated::{MIRROR, Row};
use crate::error::{Problem, Span, did_you_mean};
use crate::medium::Tabulated;

/// Micrometres per metre.
const MICROMETRES: f64 = 1e6;

/// Words that begin a section.
const SECTIONS: [&str; 7] = ["MATE", "COAT", "TABLE", "IDEAL", "IDEAL2", "TAPR", "ENCRYPTED"];

/// A line without its comment, and its number, from 1.
#[derive(Clone, Copy)]
struct Line<'a> {
    number: usize,
    text: &'a str,
}

/// A section: its first line and its rows.
struct Section<'a> {
    head: Line<'a>,
    rows: Vec<Line<'a>>,
}

impl<'a> Line<'a> {
    fn words(self) -> impl Iterator<Item = &'a str> {
        self.text.split_whitespace()
    }

    fn word(self, index: usize) -> &'a str {
        self.words().nth(index).unwrap_or_default()
    }

    fn fault(self, what: impl Into<String>) -> Problem {
        let line = u32::try_from(self.number).unwrap_or(u32::MAX);
        Problem::error(what).at(Span { line, column: 1, len: 0 })
    }

    /// The numbers from word `from` on.
    fn numbers(self, from: usize) -> Result<Vec<f64>, Problem> {
        let number = |word: &str| word.parse().ok().filter(|x: &f64| x.is_finite());
        let numbers = self.words().skip(from);
        numbers.map(|word| number(word).ok_or_else(|| self.fault(format!("{word:?} is not a number")))).collect()
    }
}

impl Section<'_> {
    fn is(&self, kind: &str, name: &str) -> bool {
        self.kind() == kind && self.head.word(1).eq_ignore_ascii_case(name)
    }

    fn kind(&self) -> String {
        self.head.word(0).to_ascii_uppercase()
    }
}

/// Reads one coating of a file.
pub fn parse(text: &str, coating: &str) -> Result<Found, Problem> {
    let sections = sections(text);
    if sections.is_empty() {
        return Err(Problem::error("this is no coating file").expecting("lines `MATE name` and `COAT name`"));
    }
    let found = sections.iter().find(|section| {
        !["MATE", "TAPR"].contains(&section.kind().as_str()) && section.head.word(1).eq_ignore_ascii_case(coating)
    });
    let plain = |entry| Found { entry, warnings: Vec::new() };
    let Some(section) = found else {
        return ideal_by_name(coating).map(plain).ok_or_else(|| unknown(&sections, coating));
    };
    match section.kind().as_str() {
        "COAT" => match ideal_by_name(section.head.word(1)).filter(|_| section.rows.is_empty()) {
            Some(ideal) => Ok(plain(ideal)),
            None => films(&sections, section).map(plain),
        },
        "IDEAL" => ideal(section.head).map(plain),
        "TABLE" => table(section),
        "IDEAL2" => Err(section.head.fault("coatings given as Jones matrices (IDEAL2) are not read")),
        _ => Err(section
            .head
            .fault(format!("`{coating}` is encrypted: only the program of its maker can read it"))
            .hinting("ask its maker for R and T over angle and wavelength, and give them as a Table".to_owned())),
    }
}

fn sections(text: &str) -> Vec<Section<'_>> {
    let mut sections: Vec<Section> = Vec::new();
    for (index, text) in text.lines().enumerate() {
        let text = text.split('!').next().unwrap_or_default().trim();
        let line = Line { number: index + 1, text };
        let first = line.word(0).to_ascii_uppercase();
        if SECTIONS.contains(&first.as_str()) {
            sections.push(Section { head: line, rows: Vec::new() });
        } else if let Some(section) = sections.last_mut().filter(|_| !text.is_empty()) {
            section.rows.push(line);
        }
    }
    sections
}

/// `I.0.95`: what passes is the number after the first point.
fn ideal_by_name(name: &str) -> Option<Entry> {
    let rest = name.strip_prefix("I.").or_else(|| name.strip_prefix("i."))?;
    let transmittance: f64 = rest.parse().ok().filter(|t| (0.0..=1.0).contains(t))?;
    Some(Entry::Ideal { reflectance: 1.0 - transmittance, transmittance })
}

fn unknown(sections: &[Section], coating: &str) -> Problem {
    let coatings = sections.iter().filter(|section| !["MATE", "TAPR"].contains(&section.kind().as_str()));
    let names: Vec<&str> = coatings.map(|section| section.head.word(1)).collect();
    let problem = Problem::error(format!("none of its {} coatings is called {coating:?}", names.len()));
    match did_you_mean(coating, names.iter().copied()) {
        Some(close) => problem.hinting(format!("did you mean {close:?}?")),
        None => problem.expecting(format!("one of {}", names.iter().take(8).copied().collect::<Vec<_>>().join(", "))),
    }
}

fn ideal(head: Line) -> Result<Entry, Problem> {
    let numbers = head.numbers(2)?;
    let (transmittance, reflectance) = match numbers[..] {
        [t] => (t, 1.0 - t),
        [t, r, ..] => (t, r),
        [] => return Err(head.fault("this coating has no transmittance").expecting("`IDEAL name T R`")),
    };
    let holds = transmittance >= 0.0 && reflectance >= 0.0 && transmittance + reflectance <= 1.0 + 1e-9;
    let fault = || head.fault("T and R are shares of the light").expecting("both 0 or more, at most 1 together");
    holds.then_some(Entry::Ideal { reflectance, transmittance }).ok_or_else(fault)
}

fn films(sections: &[Section], section: &Section) -> Result<Entry, Problem> {
    section.rows.iter().map(|row| film(sections, *row)).collect::<Result<Vec<Film>, Problem>>().map(Entry::Films)
}

fn film(sections: &[Section], row: Line) -> Result<Film, Problem> {
    // The fifth word would be the name of a taper.
    if row.words().count() > 4 {
        return Err(row.fault("tapers of layers are not read"));
    }
    let thickness = match row.numbers(1)?[..] {
        [thickness] | [thickness, 0.0] | [thickness, 0.0, 0.0] => Thickness::Waves(thickness),
        [thickness, _] | [thickness, _, 0.0] => Thickness::Length(thickness / MICROMETRES),
        [] => return Err(row.fault("this layer has no thickness").expecting("`material thickness is_absolute`")),
        _ => return Err(row.fault("loops of layers are not read")),
    };
    let (Thickness::Waves(size) | Thickness::Length(size)) = thickness;
    if size < 0.0 {
        return Err(row.fault("a thickness is not negative"));
    }
    Ok(Film { material: material(named(sections, row)?)?, thickness })
}

/// The material that a layer names.
fn named<'a, 'b>(sections: &'b [Section<'a>], row: Line) -> Result<&'b Section<'a>, Problem> {
    let name = row.word(0);
    sections.iter().find(|section| section.is("MATE", name)).ok_or_else(|| {
        let names = sections.iter().filter(|section| section.kind() == "MATE").map(|section| section.head.word(1));
        let problem = row.fault(format!("no material {name:?}"));
        match did_you_mean(name, names) {
            Some(close) => problem.hinting(format!("did you mean {close:?}?")),
            None => problem.expecting("a name that a line `MATE name` of this file gives"),
        }
    })
}

fn material(section: &Section) -> Result<Tabulated, Problem> {
    let mut rows: Vec<[f64; 3]> = Vec::new();
    for row in &section.rows {
        match row.numbers(0)?[..] {
            [wavelength, n, ref rest @ ..] if wavelength > 0.0 && n > 0.0 => {
                let k = rest.first().copied().unwrap_or(0.0);
                if k > 0.0 {
                    let problem = row.fault(format!("an extinction of +{k} amplifies light"));
                    return Err(problem.expecting("a negative number: these files write n - ik"));
                }
                rows.push([wavelength / MICROMETRES, n, -k]);
            }
            _ => return Err(row.fault("this is no index").expecting("`wavelength_um n k`, both above 0, k not")),
        }
    }
    rows.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let column = |k: usize| -> Vec<f64> { rows.iter().map(|row| row[k]).collect() };
    Tabulated::new(column(0), &column(1), &column(2))
        .ok_or_else(|| section.head.fault("the wavelengths of this material are missing or given twice"))
}

fn table(section: &Section) -> Result<Found, Problem> {
    let (mut rows, mut angle, mut phases) = (Vec::new(), None, false);
    for line in &section.rows {
        let numbers = line.numbers(1)?;
        match (line.word(0).to_ascii_uppercase().as_str(), &numbers[..]) {
            ("ANGL", [degrees, ..]) if (0.0..=90.0).contains(degrees) => angle = Some(degrees.to_radians()),
            ("WAVE", [wavelength, rs, rp, ts, tp, rest @ ..]) if *wavelength > 0.0 => {
                let Some(angle) = angle else {
                    return Err(line.fault("these shares are of no angle").expecting("a line `ANGL degrees` before"));
                };
                let power = [*rs, *rp, *ts, *tp];
                if let Some(share) = power.iter().find(|share| !(0.0..=1.0).contains(*share)) {
                    return Err(line.fault(format!("{share} is out of range")).expecting("a share from 0 to 1"));
                }
                phases |= rest.iter().any(|phase| *phase != 0.0);
                rows.push(Row { wavelength: wavelength / MICROMETRES, angle, power, phase: MIRROR });
            }
            _ => {
                let expected = "`ANGL degrees`, 0 to 90, or `WAVE um Rs Rp Ts Tp`";
                return Err(line.fault("this is no line of a table").expecting(expected));
            }
        }
    }
    let name = section.head.word(1);
    let what = format!("the phases of the table {name:?} are not used: s and p keep those of a mirror");
    let warnings = if phases { vec![Problem::warning(what)] } else { Vec::new() };
    Ok(Found { entry: Entry::Table(rows), warnings })
}

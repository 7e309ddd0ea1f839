//! What failed, where, what was expected and what to do about it.
//!
//! A [`Problem`] is one thing wrong with an input: it names the place (file, line, column, path inside the document
//! or glTF node), the thing, what was expected, and what the author may have meant. An [`Error`] is why a verb gave
//! up; it carries *all* problems found at once, and knows its exit code.

use std::fmt;
use std::path::{Path, PathBuf};

/// Whether a problem stops the run.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Severity {
    /// The input cannot be used.
    Error,
    /// The input can be used, and the author should look at it.
    Warning,
}

/// A stretch of one line of a text file.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Span {
    /// Line, counted from 1.
    pub line: u32,
    /// Column, counted from 1 in characters (not bytes).
    pub column: u32,
    /// Length in characters, 0 if only the place is known.
    pub len: u32,
}

/// One thing that is wrong with an input.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Problem {
    /// Whether it stops the run.
    pub severity: Severity,
    /// The file it was found in, if it was found in one.
    pub file: Option<PathBuf>,
    /// Where in the text of that file.
    pub span: Option<Span>,
    /// Path inside the file: `surfaces[3].scatter`, or a glTF node `root/child`; empty if none.
    pub path: String,
    /// What is wrong, naming the thing.
    pub message: String,
    /// What was expected instead.
    pub expected: Option<String>,
    /// What to do: `did you mean "black"?`
    pub hint: Option<String>,
}

impl Problem {
    /// A problem that stops the run.
    pub fn error(message: impl Into<String>) -> Problem {
        Problem::new(Severity::Error, message.into())
    }

    /// A problem that the author should know of.
    pub fn warning(message: impl Into<String>) -> Problem {
        Problem::new(Severity::Warning, message.into())
    }

    fn new(severity: Severity, message: String) -> Problem {
        Problem { severity, file: None, span: None, path: String::new(), message, expected: None, hint: None }
    }

    /// The same problem, found in this file.
    pub fn in_file(mut self, file: impl AsRef<Path>) -> Problem {
        self.file = Some(file.as_ref().to_path_buf());
        self
    }

    /// The same problem, found at this place of the text; `None` leaves the place unknown.
    pub fn at(mut self, span: impl Into<Option<Span>>) -> Problem {
        self.span = span.into();
        self
    }

    /// The same problem, found on this path inside the document (`surfaces[3].scatter`) or scene (`root/child`).
    pub fn on(mut self, path: impl Into<String>) -> Problem {
        self.path = path.into();
        self
    }

    /// The same problem, saying what was expected.
    pub fn expecting(mut self, expected: impl Into<String>) -> Problem {
        self.expected = Some(expected.into());
        self
    }

    /// The same problem, saying what to do; `None` leaves it without a hint.
    pub fn hinting(mut self, hint: impl Into<Option<String>>) -> Problem {
        self.hint = hint.into();
        self
    }

    /// True if this problem stops the run.
    pub fn is_error(&self) -> bool {
        self.severity == Severity::Error
    }
}

/// `telescope.ron:41:9: surfaces[3].scatter: no scatter model "blak"; did you mean "black"?` on one line.
impl fmt::Display for Problem {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut line = String::new();
        if let Some(file) = &self.file {
            line.push_str(&one_line(&file.display().to_string()));
            if let Some(span) = self.span {
                line.push_str(&format!(":{}:{}", span.line, span.column));
            }
            line.push_str(": ");
        } else if let Some(span) = self.span {
            line.push_str(&format!("line {}, column {}: ", span.line, span.column));
        }
        if self.severity == Severity::Warning {
            line.push_str("warning: ");
        }
        if !self.path.is_empty() {
            line.push_str(&format!("{}: ", printable(&self.path)));
        }
        line.push_str(&printable(&self.message));
        if let Some(expected) = &self.expected {
            line.push_str(&format!("; expected {}", printable(expected)));
        }
        if let Some(hint) = &self.hint {
            line.push_str(&format!("; {}", printable(hint)));
        }
        out.write_str(&line)
    }
}

/// The text with line breaks and other control characters made visible.
fn one_line(text: &str) -> String {
    text.chars().flat_map(|c| if c.is_control() { c.escape_default().collect() } else { vec![c] }).collect()
}

/// Longest message, expectation or hint, characters.
const LONGEST: usize = 400;

/// The text on one line, without what would command a terminal; the middle of a very long one (a name of a megabyte,
/// say) is left out.
pub fn printable(text: &str) -> String {
    let count = text.chars().count();
    if count <= LONGEST {
        return one_line(text);
    }
    let (first, last) = (3 * LONGEST / 4, LONGEST / 4);
    let end = |skip: usize, take: usize| one_line(&text.chars().skip(skip).take(take).collect::<String>());
    format!("{}...{}", end(0, first), end(count - last, last))
}

/// Why a verb gave up. Every variant has its exit code (sysexits.h where one exists).
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// An input was read and is wrong.
    #[error("{}", summary(.0))]
    Input(Vec<Problem>),
    /// An input is not there or cannot be opened.
    #[error("{}", summary(.0))]
    Missing(Vec<Problem>),
    /// The command line asks for something that does not exist.
    #[error("{0}")]
    Usage(String),
    /// A defect of this program.
    #[error("internal error: {0}")]
    Internal(String),
    /// A result could not be written.
    #[error("{}: {source}", path.display())]
    Io {
        /// The file or directory concerned.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
}

impl Error {
    /// The exit code of the process: 64 usage, 65 bad input, 66 missing input, 70 internal, 74 input/output.
    pub fn exit_code(&self) -> u8 {
        match self {
            Error::Usage(_) => 64,
            Error::Input(_) => 65,
            Error::Missing(_) => 66,
            Error::Internal(_) => 70,
            Error::Io { .. } => 74,
        }
    }

    /// The problems of the input, if it is the input that is wrong; empty otherwise.
    pub fn problems(&self) -> &[Problem] {
        match self {
            Error::Input(problems) | Error::Missing(problems) => problems,
            Error::Usage(_) | Error::Internal(_) | Error::Io { .. } => &[],
        }
    }
}

/// The candidate that was most likely meant by a name that does not exist: a few letters away, case aside.
pub fn did_you_mean<'a>(name: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let lower = name.to_lowercase();
    let letters = lower.chars().count();
    // A long text is not a name; comparing it would take its length squared.
    if letters > 64 {
        return None;
    }
    let distance = |candidate: &str| strsim::osa_distance(&lower, &candidate.to_lowercase());
    let (steps, nearest) =
        candidates.into_iter().filter(|c| c.len() <= 256).map(|c| (distance(c), c)).min_by_key(|(steps, _)| *steps)?;
    // One slip in a short word, one slip per three letters in a long one.
    (steps <= (letters / 3).max(1) && steps < letters).then_some(nearest)
}

/// The first error among the problems on one line, and how many follow.
pub fn summary(problems: &[Problem]) -> String {
    let errors = problems.iter().filter(|p| p.is_error()).count();
    match problems.iter().find(|p| p.is_error()).or(problems.first()) {
        None => "the input is not usable".to_owned(),
        Some(problem) if errors > 1 => format!("{problem} (and {} more)", errors - 1),
        Some(problem) => problem.to_string(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_problem_reads_place_thing_expectation_hint_on_one_line() {
        let problem = Problem::error("no scatter model \"blak\"")
            .in_file("telescope.ron")
            .at(Span { line: 41, column: 9, len: 6 })
            .on("surfaces[3].scatter")
            .hinting("did you mean \"black\"?".to_owned());
        let line = "telescope.ron:41:9: surfaces[3].scatter: no scatter model \"blak\"; did you mean \"black\"?";
        assert_eq!(problem.to_string(), line);
    }

    #[test]
    fn a_message_stays_on_one_line_whatever_it_quotes() {
        assert_eq!(Problem::warning("node \"a\nb\u{1b}[2J\"").to_string(), "warning: node \"a\\nb\\u{1b}[2J\"");
    }

    #[test]
    fn a_slip_of_the_pen_is_recognised() {
        let names = ["black", "mirror", "N-BK7"];
        assert_eq!(did_you_mean("blak", names), Some("black"));
        assert_eq!(did_you_mean("n-bk7", names), Some("N-BK7"));
        assert_eq!(did_you_mean("gold", names), None);
        assert_eq!(did_you_mean("x", ["y"]), None);
    }

    #[test]
    fn an_error_counts_what_it_does_not_show() {
        let error = Error::Input(vec![Problem::warning("w"), Problem::error("a"), Problem::error("b")]);
        assert_eq!(error.to_string(), "a (and 1 more)");
        assert_eq!(error.exit_code(), 65);
    }
}

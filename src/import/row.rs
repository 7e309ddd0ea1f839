//! One line or command of a text file as words with their place.

use crate::error::{Problem, Span};
use crate::prescription::Note;

/// A word and where it stands.
#[derive(Clone, Debug)]
pub struct Word {
    /// As written, without quotation marks.
    pub text: String,
    /// Line and column, counted from 1.
    pub span: Span,
}

/// The words of one command; the first is its key. Never empty.
#[derive(Clone, Debug)]
pub struct Row {
    pub words: Vec<Word>,
}

impl Row {
    /// The first word in capitals.
    pub fn key(&self) -> String {
        self.words[0].text.to_ascii_uppercase()
    }

    pub fn line(&self) -> u32 {
        self.words[0].span.line
    }

    /// Word `i` as written, if there is one.
    pub fn word(&self, i: usize) -> Option<&str> {
        self.words.get(i).map(|w| w.text.as_str())
    }

    /// The words behind the key, as one text.
    pub fn rest(&self) -> String {
        let words: Vec<&str> = self.words[1..].iter().map(|w| w.text.as_str()).collect();
        words.join(" ")
    }

    /// Word `i` as a finite number; `what` it should be.
    pub fn number(&self, i: usize, what: &str) -> Result<f64, Problem> {
        let Some(word) = self.words.get(i) else {
            return Err(self.problem(format!("{} ends too early", self.key())).expecting(what));
        };
        let number = word.text.parse::<f64>().ok().filter(|v| v.is_finite());
        number.ok_or_else(|| {
            Problem::error(format!("{:?} is no number", word.text)).at(word.span).on(self.key()).expecting(what)
        })
    }

    /// Word `i` as a number, 0 if the row ends before it.
    pub fn number_or_zero(&self, i: usize, what: &str) -> Result<f64, Problem> {
        if i < self.words.len() { self.number(i, what) } else { Ok(0.0) }
    }

    /// Word `i` as a count below a thousand.
    pub fn count(&self, i: usize, what: &str) -> Result<usize, Problem> {
        let value = self.number(i, what)?;
        if value.fract() == 0.0 && (0.0..1000.0).contains(&value) {
            return Ok(value as usize);
        }
        Err(self.problem(format!("{value} is no count")).at(self.words[i].span).expecting(what))
    }

    /// All words behind the key as numbers.
    pub fn numbers(&self, what: &str) -> Result<Vec<f64>, Problem> {
        (1..self.words.len()).map(|i| self.number(i, what)).collect()
    }

    /// Something wrong with this row.
    pub fn problem(&self, message: impl Into<String>) -> Problem {
        Problem::error(message).at(self.words[0].span)
    }

    /// Something in this row that is not translated: what it says, then `fate`.
    pub fn note(&self, fate: &str) -> Note {
        let text: Vec<&str> = self.words.iter().map(|w| w.text.as_str()).collect();
        Note { line: Some(self.line()), text: format!("{}: {fate}", text.join(" ")) }
    }
}

/// Words of a line, counted from 1, parted by blanks; text between quotation marks of one kind is one word. `stop` ends the line
/// where it is met outside of quotation marks; what follows is given back.
pub fn words(
    text: &str,
    line: u32,
    first_column: u32,
    quotes: &[char],
    stop: &[char],
) -> (Vec<Word>, Option<(char, usize)>) {
    let mut words: Vec<Word> = Vec::new();
    let mut open: Option<char> = None;
    let mut within = false;
    for (column, (at, c)) in (first_column..).zip(text.char_indices()) {
        match open {
            Some(quote) if c == quote => (open, within) = (None, false),
            None if stop.contains(&c) => return (words, Some((c, at))),
            None if c.is_whitespace() || c == '\0' => within = false,
            _ => {
                let opens = open.is_none() && quotes.contains(&c);
                if !within {
                    let span = Span { line, column, len: 0 };
                    words.push(Word { text: String::new(), span });
                    within = true;
                }
                if opens {
                    open = Some(c);
                } else if let Some(word) = words.last_mut() {
                    word.span.len += 1;
                    word.text.push(c);
                }
            }
        }
    }
    (words, None)
}

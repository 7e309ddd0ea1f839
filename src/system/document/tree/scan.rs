//! From text to tree, by recursive descent.

use super::{Fault, Field, Node, Shape};

/// Deeper nesting is refused; it is also what ron allows.
const DEEPEST: u32 = 100;

/// The value of the text, which holds nothing else.
pub fn read(text: &str) -> Result<Node, Fault> {
    read_from(text, 0)
}

/// The value of the text from byte `start` on, which holds nothing else.
pub fn read_from(text: &str, start: usize) -> Result<Node, Fault> {
    let mut scanner = Scanner { text, at: start, depth: 0 };
    scanner.skip_attributes()?;
    let node = scanner.value()?;
    scanner.skip_space()?;
    match scanner.peek() {
        None => Ok(node),
        Some(_) => Err(scanner.fault("there is more text after the end of the system", None)),
    }
}

/// Reads a text from left to right.
struct Scanner<'a> {
    text: &'a str,
    at: usize,
    depth: u32,
}

impl<'a> Scanner<'a> {
    fn rest(&self) -> &'a str {
        &self.text[self.at..]
    }

    fn peek(&self) -> Option<char> {
        self.rest().chars().next()
    }

    fn fault(&self, message: impl Into<String>, expected: Option<&'static str>) -> Fault {
        Fault { at: self.at, message: message.into(), expected, open: None }
    }

    /// What stands here, for a message.
    fn found(&self) -> String {
        self.peek().map_or("the end of the file".to_owned(), |c| format!("`{c}`"))
    }

    /// Moves past a character if it stands here.
    fn take(&mut self, c: char) -> bool {
        let there = self.peek() == Some(c);
        if there {
            self.at += c.len_utf8();
        }
        there
    }

    /// Moves past white space and comments.
    fn skip_space(&mut self) -> Result<(), Fault> {
        loop {
            self.at = self.text.len() - self.rest().trim_start().len();
            if self.rest().starts_with("//") {
                self.at += self.rest().find('\n').unwrap_or(self.rest().len());
            } else if self.rest().starts_with("/*") {
                self.at +=
                    block_comment(self.rest()).ok_or_else(|| self.fault("this comment is never closed", None))?;
            } else {
                return Ok(());
            }
        }
    }

    /// Moves past `#![enable(..)]`; the program enables what it needs.
    fn skip_attributes(&mut self) -> Result<(), Fault> {
        self.skip_space()?;
        while self.rest().starts_with("#!") {
            let length = self.rest().find(']').ok_or_else(|| self.fault("this attribute is never closed", None))?;
            self.at += length + 1;
            self.skip_space()?;
        }
        Ok(())
    }

    fn value(&mut self) -> Result<Node, Fault> {
        self.skip_space()?;
        self.depth += 1;
        if self.depth > DEEPEST {
            return Err(self.fault(format!("values are nested more than {DEEPEST} deep"), None));
        }
        let start = self.at;
        let (name, shape) = match self.peek() {
            Some('[') => (None, Shape::List(self.list(']', "`,` or `]`")?)),
            Some('{') => (None, self.entries()?),
            Some('(') => (None, self.parenthesis()?),
            Some('"') => (None, Shape::Text(self.string(0)?)),
            Some('\'') => (None, self.character()?),
            Some('r') if raw_hashes(&self.rest()[1..]).is_some() => (None, Shape::Text(self.string(1)?)),
            _ => self.word_or_variant()?,
        };
        self.depth -= 1;
        let end = self.at;
        Ok(Node { start, end, name, shape })
    }

    /// A number, a word, or a word with its content: `Disk(..)`.
    fn word_or_variant(&mut self) -> Result<(Option<String>, Shape), Fault> {
        let start = self.at;
        let word = self.word();
        if word.is_empty() {
            return Err(self.fault(format!("found {} where a value should be", self.found()), None));
        }
        if !word.starts_with(|c: char| c.is_alphabetic() || c == '_') {
            return Ok((None, Shape::Atom));
        }
        let end = self.at;
        self.skip_space()?;
        if self.peek() == Some('(') {
            return Ok((Some(word.to_owned()), self.parenthesis()?));
        }
        self.at = end;
        if self.peek() == Some('"') {
            self.at = start;
            return Err(self.fault(format!("found `{word}` before a text"), None));
        }
        Ok((Some(word.to_owned()), Shape::Atom))
    }

    /// The letters, digits and signs that follow.
    fn word(&mut self) -> &'a str {
        let rest = self.rest();
        let raw = if rest.starts_with("r#") { 2 } else { 0 };
        let letter = |c: char| c.is_alphanumeric() || matches!(c, '_' | '.' | '+' | '-');
        let length = raw + rest[raw..].find(|c| !letter(c)).unwrap_or(rest.len() - raw);
        self.at += length;
        &rest[raw.min(length)..length]
    }

    /// `(field: value, ..)` or `(value, ..)`.
    fn parenthesis(&mut self) -> Result<Shape, Fault> {
        let open = self.at;
        self.at += 1;
        self.skip_space()?;
        let first = self.at;
        let word = self.word();
        self.skip_space()?;
        let named = !word.is_empty() && self.peek() == Some(':');
        self.at = open;
        if named { Ok(Shape::Fields(self.fields()?)) } else { self.at_items(first) }
    }

    fn at_items(&mut self, first: usize) -> Result<Shape, Fault> {
        // `()` has neither fields nor items: it reads as no fields, which every struct with defaults accepts.
        if self.text[first..].starts_with(')') {
            self.at = first + 1;
            return Ok(Shape::Fields(Vec::new()));
        }
        Ok(Shape::Items(self.list(')', "`,` or `)`")?))
    }

    fn list(&mut self, close: char, expected: &'static str) -> Result<Vec<Node>, Fault> {
        let mut items = Vec::new();
        let open = self.open();
        while !self.closed(open, close)? {
            items.push(self.value()?);
            self.comma(open, close, expected)?;
        }
        Ok(items)
    }

    fn fields(&mut self) -> Result<Vec<Field>, Fault> {
        let mut fields = Vec::new();
        let open = self.open();
        while !self.closed(open, ')')? {
            let start = self.at;
            let name = self.word().to_owned();
            if name.is_empty() {
                return Err(self.fault(format!("found {} where a field should be", self.found()), None));
            }
            self.colon(&name)?;
            let value = self.value()?;
            self.comma(open, ')', "`,` or `)`")?;
            fields.push(Field { name, start, next: self.at, value });
        }
        Ok(fields)
    }

    fn entries(&mut self) -> Result<Shape, Fault> {
        let mut entries = Vec::new();
        let open = self.open();
        while !self.closed(open, '}')? {
            let key = self.value()?;
            let name = self.text[key.start..key.end].to_owned();
            self.colon(&name)?;
            let value = self.value()?;
            self.comma(open, '}', "`,` or `}`")?;
            entries.push((key, value));
        }
        Ok(Shape::Entries(entries))
    }

    /// Moves past the opening bracket and says where it was.
    fn open(&mut self) -> usize {
        self.at += 1;
        self.at - 1
    }

    /// Moves past the closing bracket if it is what follows.
    fn closed(&mut self, open: usize, close: char) -> Result<bool, Fault> {
        self.skip_space()?;
        if self.peek().is_none() { Err(self.unclosed(open)) } else { Ok(self.take(close)) }
    }

    fn unclosed(&self, open: usize) -> Fault {
        let message = format!("this `{}` is never closed", &self.text[open..=open]);
        Fault { at: open, message, expected: None, open: None }
    }

    fn colon(&mut self, name: &str) -> Result<(), Fault> {
        self.skip_space()?;
        if self.take(':') {
            return Ok(());
        }
        Err(self.fault(format!("found {} after `{name}`", self.found()), Some("`:` and a value")))
    }

    /// Moves past a comma; there must be one unless the bracket closes. A comma is left where it is before the bracket.
    fn comma(&mut self, open: usize, close: char, expected: &'static str) -> Result<(), Fault> {
        let end = self.at;
        self.skip_space()?;
        match self.peek() {
            Some(',') => {
                self.at += 1;
                Ok(())
            }
            Some(c) if c == close => Ok(()),
            None => Err(self.unclosed(open)),
            Some(_) => {
                let found = self.found();
                self.at = end;
                let fault = self.fault(format!("found {found} after a value"), Some(expected));
                Err(Fault { open: Some(open), ..fault })
            }
        }
    }

    /// A text in quotes, with `skip` letters before them.
    fn string(&mut self, skip: usize) -> Result<String, Fault> {
        let rest = self.rest();
        let length = match raw_hashes(&rest[skip..]) {
            Some(hashes) if skip > 0 => {
                let close = format!("\"{}", "#".repeat(hashes));
                let body = skip + hashes + 1;
                rest[body..].find(&close).map(|at| body + at + close.len())
            }
            _ => quoted(rest),
        };
        let length = length.ok_or_else(|| self.fault("this text is never closed", Some("a closing `\"`")))?;
        let decoded = ron::from_str(&rest[..length]).map_err(|e| self.fault(e.code.to_string(), None))?;
        self.at += length;
        Ok(decoded)
    }

    fn character(&mut self) -> Result<Shape, Fault> {
        let body = &self.rest()[1..];
        let escaped = usize::from(body.starts_with('\\'));
        let close = body.char_indices().skip(1 + escaped).find(|(_, c)| *c == '\'').map(|(at, _)| at);
        self.at += 2 + close.ok_or_else(|| self.fault("this `'` is never closed", Some("text in double quotes")))?;
        Ok(Shape::Atom)
    }
}

/// Bytes of the comment that starts here; comments nest. None if it is never closed.
fn block_comment(text: &str) -> Option<usize> {
    let (mut depth, mut at) = (0_usize, 0);
    loop {
        let rest = text.get(at..)?;
        let next = rest.find("/*").unwrap_or(usize::MAX);
        let close = rest.find("*/")?;
        if next < close {
            depth += 1;
            at += next + 2;
        } else {
            depth -= 1;
            at += close + 2;
        }
        if depth == 0 {
            return Some(at);
        }
    }
}

/// Bytes of the text in quotes that starts here. None if it is never closed.
pub fn quoted(text: &str) -> Option<usize> {
    let mut escaped = false;
    for (at, c) in text.char_indices().skip(1) {
        match c {
            _ if escaped => escaped = false,
            '\\' => escaped = true,
            '"' => return Some(at + 1),
            _ => {}
        }
    }
    None
}

/// How many `#` stand before the quote of a raw text; None if it is not one.
fn raw_hashes(text: &str) -> Option<usize> {
    let hashes = text.len() - text.trim_start_matches('#').len();
    text[hashes..].starts_with('"').then_some(hashes)
}

//! The text of a document as a tree with places, so that every value can be pointed at.
//!
//! This is the syntax of RON and nothing else: `[a, b]`, `{"key": value}`, `Name(field: value)`, `Name(a, b)`, text,
//! words and numbers, comments. What the values mean is read by serde, entry by entry.

mod scan;

use crate::error::Span;

pub use scan::{quoted, read, read_from};

/// A value and where it stands, in bytes.
#[derive(Debug, Clone)]
pub struct Node {
    /// First byte.
    pub start: usize,
    /// One past the last byte.
    pub end: usize,
    /// The word before the parenthesis, or the word itself: `Disk` of `Disk(radius: "1 mm")`.
    pub name: Option<String>,
    /// What it is made of.
    pub shape: Shape,
}

/// What a value is made of.
#[derive(Debug, Clone)]
pub enum Shape {
    /// `(field: value, ..)`.
    Fields(Vec<Field>),
    /// `(value, ..)`.
    Items(Vec<Node>),
    /// `[value, ..]`.
    List(Vec<Node>),
    /// `{key: value, ..}`.
    Entries(Vec<(Node, Node)>),
    /// `"text"`, decoded.
    Text(String),
    /// A number, a word, a character.
    Atom,
}

/// `field: value,`
#[derive(Debug, Clone)]
pub struct Field {
    /// Its name.
    pub name: String,
    /// First byte of its name.
    pub start: usize,
    /// Its value.
    pub value: Node,
    /// One past the comma that follows, or past the value.
    pub next: usize,
}

/// A fault of syntax.
#[derive(Debug, Clone)]
pub struct Fault {
    /// Where, in bytes.
    pub at: usize,
    /// What is wrong.
    pub message: String,
    /// What was expected.
    pub expected: Option<&'static str>,
    /// The bracket it happened in, in bytes.
    pub open: Option<usize>,
}

/// One step on the way to a value.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Step {
    /// A field of a struct, or an entry of a map.
    Name(String),
    /// An item of a list.
    Index(usize),
    /// The content of an enum's variant.
    Variant(String),
}

/// Line, column and length in characters of a stretch of bytes, as far as it stands on its first line.
pub fn place(text: &str, start: usize, end: usize) -> Span {
    let start = floor(text, start);
    let line_start = text[..start].rfind('\n').map_or(0, |at| at + 1);
    let stretch = &text[start..floor(text, end).max(start)];
    let count = |n: usize| u32::try_from(n).unwrap_or(u32::MAX);
    Span {
        line: count(text[..start].matches('\n').count()).saturating_add(1),
        column: count(text[line_start..start].chars().count()).saturating_add(1),
        len: count(stretch.lines().next().unwrap_or("").trim_end().chars().count()),
    }
}

/// The last boundary of a character at or before `at`.
fn floor(text: &str, at: usize) -> usize {
    (0..=at.min(text.len())).rev().find(|&at| text.is_char_boundary(at)).unwrap_or(0)
}

impl Node {
    /// The value at the end of the steps.
    pub fn find(&self, steps: &[Step]) -> Option<&Node> {
        let Some((step, rest)) = steps.split_first() else { return Some(self) };
        let next = match step {
            Step::Variant(name) => {
                let same = self.name.as_deref() == Some(name);
                if !same { None } else { Some(self.content().unwrap_or(self)) }
            }
            Step::Name(name) => self.child(name).or_else(|| self.content()?.child(name)),
            Step::Index(index) => match &self.shape {
                Shape::List(items) => items.get(*index),
                Shape::Items(items) if self.content().is_none() => items.get(*index),
                _ => return self.content()?.find(steps),
            },
        };
        next?.find(rest)
    }

    /// The field or entry of this name.
    pub fn child(&self, name: &str) -> Option<&Node> {
        match &self.shape {
            Shape::Fields(fields) => fields.iter().find(|field| field.name == name).map(|field| &field.value),
            Shape::Entries(entries) => entries.iter().find(|(key, _)| key.text() == Some(name)).map(|(_, value)| value),
            _ => None,
        }
    }

    /// The key of this name in a map.
    pub fn key(&self, name: &str) -> Option<&Node> {
        let Shape::Entries(entries) = &self.shape else { return None };
        entries.iter().map(|(key, _)| key).find(|key| key.text() == Some(name))
    }

    /// What a variant with one unnamed value holds: `[..]` of `Sum([..])`.
    pub fn content(&self) -> Option<&Node> {
        match (&self.name, &self.shape) {
            (Some(_), Shape::Items(items)) if items.len() == 1 => items.first(),
            _ => None,
        }
    }

    /// The text, if it is one.
    pub fn text(&self) -> Option<&str> {
        if let Shape::Text(text) = &self.shape { Some(text) } else { None }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str =
        "// a comment\n(a: Sum([X(b: 1), /* in /* side */ */ Y(\"1)\\\"\")]), m: {\"k 1\": (2, 3),}, r: r#\"a\"b\"#)\n";

    fn slice(steps: &[Step]) -> &'static str {
        let tree = read(TEXT).expect("valid");
        let node = tree.find(steps).expect("there");
        &TEXT[node.start..node.end]
    }

    fn name(text: &str) -> Step {
        Step::Name(text.to_owned())
    }

    #[test]
    fn every_value_can_be_pointed_at() {
        assert_eq!(slice(&[name("a"), Step::Index(0), name("b")]), "1");
        assert_eq!(
            slice(&[name("a"), Step::Variant("Sum".into()), Step::Index(1), Step::Variant("Y".into())]),
            "\"1)\\\"\""
        );
        assert_eq!(slice(&[name("m"), name("k 1"), Step::Index(1)]), "3");
        assert_eq!(slice(&[name("r")]), "r#\"a\"b\"#");
    }

    #[test]
    fn columns_count_characters_and_lines_count_from_one() {
        let text = "(é: 1,\r\n  b: \"µm\")";
        let at = text.find("\"µ").unwrap_or(0);
        assert_eq!(place(text, at, text.len() - 1), Span { line: 2, column: 6, len: 4 });
        assert_eq!(place(text, 0, 3), Span { line: 1, column: 1, len: 2 });
        assert_eq!(place(text, 0, text.len()).len, 6);
    }

    #[test]
    fn broken_syntax_is_refused_without_panic() {
        for text in [
            "", "(", "(a", "(a:", "(a: 1", "(a: \"", "[1 2]", "{1}", "(a: 1) x", "/*", "'", "(a: ')", "#!", "r#",
            "(,)", "é(", "r\"", "b\"x\"", "'\\", "}",
        ] {
            assert!(read(text).is_err(), "{text:?} was accepted");
        }
        let deep = "[".repeat(100_000);
        assert!(read(&deep).is_err());
        for end in 0..TEXT.trim_end().len() {
            assert!(read(&TEXT[..end]).is_err(), "{:?} was accepted", &TEXT[..end]);
        }
    }
}

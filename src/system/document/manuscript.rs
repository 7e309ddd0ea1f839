//! The texts of a document laid end to end: the system file, then what it includes. A place is a number of bytes from the
//! beginning; every place belongs to one file.
//!
//! A value may be read as another text than was written: an expression as its value, the name of a file beside an included
//! file as seen from the system file.

use super::tree;
use crate::error::{Problem, Span};
use std::collections::BTreeMap;
use std::ops::Range;
use std::path::{Path, PathBuf};

/// One file of a document.
#[derive(Debug, Clone)]
pub struct Page {
    /// Where it was read from.
    pub path: PathBuf,
    /// Its name as seen from the folder of the system file.
    pub name: PathBuf,
    /// SHA-256 of its bytes, in lower-case hexadecimal.
    pub sha256: String,
    /// First byte.
    pub start: usize,
}

/// What is read where something else is written.
#[derive(Debug, Clone)]
struct Reading {
    end: usize,
    /// RON; `None` for an expression that is wrong, which is told.
    ron: Option<String>,
}

/// All texts of a document.
#[derive(Debug, Clone, Default)]
pub struct Manuscript {
    text: String,
    /// In the order of their first bytes; the system file is the first.
    pub pages: Vec<Page>,
    readings: BTreeMap<usize, Reading>,
}

impl Manuscript {
    /// Appends a file; the tree of its text.
    pub fn append(&mut self, text: &str, page: Page) -> Result<tree::Node, tree::Fault> {
        let page = Page { start: self.text.len(), ..page };
        let start = page.start;
        self.text.push_str(text);
        self.pages.push(page);
        tree::read_from(&self.text, start)
    }

    /// What is written there.
    pub fn written(&self, range: Range<usize>) -> &str {
        &self.text[range]
    }

    /// What is to be read there.
    pub fn read(&self, range: Range<usize>) -> String {
        let mut text = String::new();
        let mut at = range.start;
        for (&start, reading) in self.readings.range(range.clone()) {
            if let Some(ron) = &reading.ron {
                text.push_str(&self.text[at..start]);
                text.push_str(ron);
                at = reading.end;
            }
        }
        text + &self.text[at..range.end]
    }

    /// Reads something else there; `None` if nothing sensible can be read.
    pub fn replace(&mut self, range: Range<usize>, ron: Option<String>) {
        self.readings.insert(range.start, Reading { end: range.end, ron });
    }

    /// True if the value there is an expression that is wrong.
    pub fn is_spoilt(&self, start: usize) -> bool {
        self.readings.get(&start).is_some_and(|reading| reading.ron.is_none())
    }

    /// What is read at a place instead of what is written, if that differs.
    pub fn reading(&self, start: usize) -> Option<&str> {
        self.readings.get(&start)?.ron.as_deref()
    }

    /// The file that a place is in.
    pub fn page(&self, at: usize) -> &Page {
        &self.pages[self.pages.partition_point(|page| page.start <= at).saturating_sub(1)]
    }

    /// Line and column of a place in its file.
    pub fn span(&self, range: Range<usize>) -> Span {
        let start = self.page(range.start).start;
        tree::place(&self.text[start..], range.start - start, range.end - start)
    }

    /// The problem with file and place.
    pub fn locate(&self, problem: Problem, range: Range<usize>) -> Problem {
        problem.in_file(&self.page(range.start).path).at(self.span(range))
    }

    /// Which of the files this is, from 0; for sorting.
    pub fn order(&self, file: Option<&Path>) -> usize {
        self.pages.iter().position(|page| Some(page.path.as_path()) == file).unwrap_or(0)
    }
}

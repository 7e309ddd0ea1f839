//! Files that a system includes: their sections are laid under its own.
//!
//! Lists begin with what is included, so that the including file overrides. Names of maps are given once; only a parameter
//! may be given again by the file that includes it. Anything else replaces what is included.

use super::manuscript::{Manuscript, Page};
use super::tree::{Field, Node, Shape};
use super::{Opener, digest, not_utf8, syntax};
use crate::error::{Error, Problem};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// Files of one document at most.
const MOST: usize = 1000;

/// Reads the files of a document.
pub struct Gatherer<'a> {
    pub script: Manuscript,
    /// What is wrong with the includes, with file and place.
    pub problems: Vec<Problem>,
    /// Reads a file; `None`: includes are not followed.
    pub open: Option<&'a Opener>,
    /// The files being read, each included by the one before.
    stack: Vec<PathBuf>,
}

impl<'a> Gatherer<'a> {
    /// A gatherer that has read nothing yet.
    pub fn new(open: Option<&'a Opener>) -> Gatherer<'a> {
        Gatherer { script: Manuscript::default(), problems: Vec::new(), open, stack: Vec::new() }
    }

    /// The sections of a file and of everything that it includes. Fails if the file is no text or not well-formed.
    pub fn file(&mut self, path: &Path, name: &Path, bytes: &[u8]) -> Result<Node, Error> {
        let refuse = |problem: Problem| Error::Input(vec![problem]);
        let text = std::str::from_utf8(bytes).map_err(|e| refuse(not_utf8(bytes, e.valid_up_to()).in_file(path)))?;
        let page = Page { path: path.into(), name: name.into(), sha256: digest(bytes), start: 0 };
        let text = text.strip_prefix('\u{feff}').unwrap_or(text);
        let mut own = self.script.append(text, page).map_err(|fault| refuse(syntax(&self.script, &fault)))?;
        self.stack.push(identity(path));
        self.rebase(&own, name.parent().unwrap_or(Path::new("")), false);
        let mut below: Option<Node> = None;
        for include in own.child("include").into_iter().flat_map(items) {
            if let Some(included) = self.include(include, path, name)? {
                below = Some(match below.take() {
                    None => included,
                    Some(earlier) => merge(earlier, included, false),
                });
            }
        }
        self.stack.pop();
        if let Some(below) = below {
            own = merge(below, own, true);
        }
        Ok(own)
    }

    /// The sections of an included file; `None` if there is nothing to add.
    fn include(&mut self, include: &Node, from: &Path, name: &Path) -> Result<Option<Node>, Error> {
        let (Some(open), Some(written)) = (self.open, include.text()) else { return Ok(None) };
        let beside = |file: &Path| file.parent().unwrap_or(Path::new("")).join(written);
        let (path, name) = (beside(from), beside(name));
        let here = identity(&path);
        if self.stack.contains(&here) {
            let around: Vec<String> = self.stack.iter().map(|file| file_name(file)).collect();
            let problem = Problem::error(format!("{written:?} includes itself: {}", around.join(" > ")));
            self.fault(problem, include);
            return Ok(None);
        }
        // What two files include is there once.
        if self.script.pages.iter().any(|page| identity(&page.path) == here) {
            return Ok(None);
        }
        if self.script.pages.len() >= MOST {
            self.fault(Problem::error(format!("more than {MOST} files are included")), include);
            return Ok(None);
        }
        match open(&path) {
            Err(Error::Missing(problems)) => {
                let what = problems.first().map_or(String::new(), |problem| format!(": {}", problem.message));
                let problem = Problem::error(format!("{written:?} cannot be included{what}"));
                let problem = problem.hinting("included files are relative to the file that includes them".to_owned());
                Err(Error::Missing(vec![self.located(problem, include)]))
            }
            Err(error) => Err(error),
            Ok(bytes) => {
                let start = self.script.pages.len();
                let node = self.file(&path, &name, &bytes)?;
                if matches!(node.shape, Shape::Fields(_)) && node.name.as_deref().is_none_or(|name| name == "System") {
                    return Ok(Some(node));
                }
                let place = self.script.pages[start].start.max(node.start);
                let problem = Problem::error("this is not a system").expecting("`System(..)`");
                self.problems.push(self.script.locate(problem, place..node.end));
                Ok(None)
            }
        }
    }

    fn fault(&mut self, problem: Problem, include: &Node) {
        let problem = self.located(problem, include);
        self.problems.push(problem);
    }

    fn located(&self, problem: Problem, include: &Node) -> Problem {
        self.script.locate(problem.on("include"), include.start..include.end)
    }

    /// Names of files that an included file in another folder names, as seen from the system file: they are fields called `file`.
    fn rebase(&mut self, node: &Node, folder: &Path, is_file: bool) {
        if folder.as_os_str().is_empty() {
            return;
        }
        match &node.shape {
            Shape::Text(text) if is_file => {
                let seen = folder.join(text).display().to_string();
                self.script.replace(node.start..node.end, Some(format!("{seen:?}")));
            }
            Shape::Text(_) | Shape::Atom => {}
            Shape::Fields(fields) => fields.iter().for_each(|f| self.rebase(&f.value, folder, f.name == "file")),
            Shape::Items(items) | Shape::List(items) => items.iter().for_each(|item| self.rebase(item, folder, false)),
            Shape::Entries(entries) => entries.iter().for_each(|(_, value)| self.rebase(value, folder, false)),
        }
    }
}

fn items(node: &Node) -> &[Node] {
    if let Shape::List(items) = &node.shape { items } else { &[] }
}

/// What tells a file from others, however it is named.
fn identity(path: &Path) -> PathBuf {
    std::fs::canonicalize(path).unwrap_or_else(|_| path.to_owned())
}

fn file_name(path: &Path) -> String {
    path.file_name().map_or(String::new(), |name| name.to_string_lossy().into_owned())
}

/// The sections of two files in one; `above` includes `below` if `over`, else it stands after it.
fn merge(below: Node, mut above: Node, over: bool) -> Node {
    let (Shape::Fields(lower), Shape::Fields(upper)) = (below.shape, &mut above.shape) else { return above };
    let mut seen = BTreeSet::new();
    for field in lower.into_iter().filter(|field| field.name != "include") {
        // A section that one file gives twice stays twice: the reader refuses it.
        let first = seen.insert(field.name.clone());
        match upper.iter_mut().find(|known| known.name == field.name).filter(|_| first) {
            None => upper.push(field),
            Some(known) => join(field, known, over),
        }
    }
    above
}

/// Puts what a section of an included file holds before what is in the same section of the file above it.
fn join(below: Field, above: &mut Field, over: bool) {
    match (below.value.shape, &mut above.value.shape) {
        (Shape::List(mut first), Shape::List(last)) => {
            first.append(last);
            *last = first;
        }
        (Shape::Entries(mut first), Shape::Entries(last)) => {
            if over && above.name == "parameters" {
                first.retain(|(key, _)| !last.iter().any(|(known, _)| known.text() == key.text()));
            }
            first.append(last);
            *last = first;
        }
        _ => {}
    }
}

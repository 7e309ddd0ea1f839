//! The sections of a document, entry by entry.

use super::entry::{self, Fault};
use super::manuscript::Manuscript;
use super::names::Names;
use super::tree::{self, Node, Shape, Step};
use super::variant::Level;
use super::{Indices, System};
use crate::error::{Problem, Span, did_you_mean};
use serde::de::{DeserializeOwned, IgnoredAny};
use std::collections::BTreeMap;
use std::ops::Range;

/// What a system is made of, as one reads it.
pub const SECTIONS: &[&str] = &[
    "name",
    "include",
    "parameters",
    "configurations",
    "variants",
    "geometry",
    "elements",
    "aliases",
    "configure",
    "ambient",
    "media",
    "coatings",
    "scatter",
    "surfaces",
    "default",
    "sources",
    "sweeps",
    "glare",
    "detectors",
    "filters",
    "targets",
    "run",
];

/// Problems taken down; finding the place of each takes time.
const MOST: usize = 500;

/// Reads entries and collects what is wrong with them.
pub struct Reader<'a> {
    /// The texts of the document.
    pub script: &'a Manuscript,
    /// What is wrong so far, with file and place.
    pub problems: Vec<Problem>,
    /// Paths of values that were replaced by stand-ins.
    pub mended: Vec<String>,
}

impl<'a> Reader<'a> {
    /// A reader that has found nothing yet.
    pub fn new(script: &'a Manuscript) -> Reader<'a> {
        Reader { script, problems: Vec::new(), mended: Vec::new() }
    }

    /// The system, as far as it can be read.
    pub fn system(&mut self, root: &Node) -> (System, Indices) {
        self.sections(root);
        // Expressions are worked out before this; names are read here.
        let _: Names<IgnoredAny> = self.map(root, "parameters");
        let _: Names<BTreeMap<String, IgnoredAny>> = self.map(root, "configurations");
        self.variants(root);
        let (geometry, geometry_at) = self.list(root, "geometry");
        let (configure, configure_at) = self.list(root, "configure");
        let (surfaces, surfaces_at) = self.list(root, "surfaces");
        let system = System {
            name: self.single(root, "name"),
            include: self.list(root, "include").0,
            geometry,
            elements: self.map(root, "elements"),
            aliases: self.map(root, "aliases"),
            configure,
            ambient: self.single(root, "ambient").unwrap_or_else(|| "vacuum".to_owned()),
            media: self.map(root, "media"),
            coatings: self.map(root, "coatings"),
            scatter: self.map(root, "scatter"),
            surfaces,
            default: self.single(root, "default"),
            sources: self.map(root, "sources"),
            sweeps: self.map(root, "sweeps"),
            glare: self.map(root, "glare"),
            detectors: self.map(root, "detectors"),
            filters: self.map(root, "filters"),
            targets: self.map(root, "targets"),
            run: self.single(root, "run").unwrap_or_default(),
            level: Level::default(),
        };
        let outlines = Vec::new();
        (system, Indices { geometry: geometry_at, configure: configure_at, surfaces: surfaces_at, outlines })
    }

    /// Refuses what is not a system, and sections that are unknown or given twice.
    fn sections(&mut self, root: &Node) {
        let named = root.name.as_deref().is_none_or(|name| name == "System");
        let Shape::Fields(fields) = &root.shape else {
            return self.push(
                root.start..root.end,
                "",
                Problem::error("this is not a system").expecting("`System(..)`"),
            );
        };
        if !named {
            let name = root.name.clone().unwrap_or_default();
            self.push(
                root.start..root.start + name.len(),
                "",
                Problem::error(format!("this is a `{name}`")).expecting("`System(..)`"),
            );
        }
        for (index, field) in fields.iter().enumerate() {
            let place = field.start..field.start + field.name.len();
            if fields[..index].iter().any(|earlier| earlier.name == field.name) {
                self.push(place, &field.name, Problem::error(format!("section `{}` is given twice", field.name)));
            } else if !SECTIONS.contains(&field.name.as_str()) {
                self.push(place, &field.name, unknown_section(&field.name));
            }
        }
    }

    /// A section that is one value.
    fn single<T: DeserializeOwned>(&mut self, root: &Node, section: &str) -> Option<T> {
        root.child(section).and_then(|node| self.entry(node, section))
    }

    /// A section that is a list, and where in the list what could be read stands.
    fn list<T: DeserializeOwned>(&mut self, root: &Node, section: &str) -> (Vec<T>, Vec<usize>) {
        let Some(node) = root.child(section) else { return Default::default() };
        let Shape::List(items) = &node.shape else {
            self.wrong_shape(node, section, "a list in brackets, `[(..), ..]`");
            return Default::default();
        };
        let read = |(at, item)| Some((self.entry(item, &format!("{section}[{at}]"))?, at));
        items.iter().enumerate().filter_map(read).unzip()
    }

    /// A section that is a map from names.
    fn map<T: DeserializeOwned>(&mut self, root: &Node, section: &str) -> Names<T> {
        let Some(node) = root.child(section) else { return Names::default() };
        let entries = match &node.shape {
            Shape::Entries(entries) => entries,
            _ => {
                self.wrong_shape(node, section, "named entries in braces, `{\"name\": .., ..}`");
                return Names::default();
            }
        };
        let mut things: Vec<(String, T)> = Vec::new();
        let mut seen: BTreeMap<&str, usize> = BTreeMap::new();
        for (key, value) in entries {
            let Some(name) = key.text() else {
                self.push(
                    key.start..key.end,
                    section,
                    Problem::error("a name must be text").expecting("a name in double quotes"),
                );
                continue;
            };
            let path = format!("{section}[{name:?}]");
            if let Some(&first) = seen.get(name) {
                let problem = Problem::error(format!("the name {name:?} is given twice"));
                self.push(key.start..key.end, section, problem.hinting(self.elsewhere(first, key.start)));
                continue;
            }
            seen.insert(name, key.start);
            if let Some(thing) = self.entry(value, &path) {
                things.push((name.to_owned(), thing));
            }
        }
        things.into_iter().collect()
    }

    /// Where the first of two things is, if not in the file of the second.
    fn elsewhere(&self, first: usize, second: usize) -> Option<String> {
        let page = self.script.page(first);
        let Span { line, column, .. } = self.script.span(first..first);
        let apart = page.start != self.script.page(second).start;
        apart.then(|| format!("the other is in {}:{line}:{column}", page.name.display()))
    }

    /// A section that is neither list nor map as it should be.
    pub fn wrong_shape(&mut self, node: &Node, section: &str, expected: &str) {
        let problem = Problem::error(format!("section `{section}` has the wrong form")).expecting(expected);
        self.push(node.start..node.end, section, problem);
    }

    /// One entry of the document.
    pub fn entry<T: DeserializeOwned>(&mut self, node: &Node, path: &str) -> Option<T> {
        let entry = entry::read(&self.script.read(node.start..node.end));
        for fault in &entry.faults {
            self.fault(node, path, fault);
        }
        entry.value
    }

    fn fault(&mut self, node: &Node, path: &str, fault: &Fault) {
        let range = fault.range(node);
        let mut path = format!("{path}{}", written(&fault.steps));
        if let Some(field) = &fault.field
            && fault.steps.last() != Some(&Step::Name(field.clone()))
        {
            path = format!("{path}.{field}");
        }
        // What is wrong with an expression has been told.
        if !self.script.is_spoilt(range.start) {
            let problem = fault.problem(&self.script.read(range.clone()));
            let hint = self.script.reading(range.start).filter(|_| problem.hint.is_none());
            let hint = hint.map(|read| format!("{} is {read} here", self.script.written(range.clone())));
            let problem = if hint.is_some() { problem.hinting(hint) } else { problem };
            self.push(range, &path, problem);
        }
        self.mended.push(path);
    }

    /// Takes a problem down.
    pub fn push(&mut self, range: Range<usize>, path: &str, problem: Problem) {
        if self.problems.len() >= MOST {
            return;
        }
        self.problems.push(self.script.locate(problem.on(path), range));
    }
}

fn unknown_section(name: &str) -> Problem {
    let problem = Problem::error(format!("a system has no section `{name}`"));
    match did_you_mean(name, SECTIONS.iter().copied()) {
        Some(close) => problem.hinting(format!("did you mean `{close}`?")),
        None => problem.expecting(format!("one of {}", SECTIONS.join(", "))),
    }
}

/// True if a problem may be about a stand-in: at its path, below it, beside it in one list, or where it is compared
/// with its neighbours.
pub fn is_mended(mended: &[String], problem: &Problem) -> bool {
    mended.iter().any(|mended| {
        let list = mended.trim_end_matches(|c: char| c.is_ascii_digit() || matches!(c, '[' | ']'));
        let base = if list.contains('.') { list } else { mended };
        let below = problem.path.strip_prefix(base);
        let parent = mended.rfind('.').map(|dot| &mended[..dot]);
        below.is_some_and(|rest| rest.is_empty() || rest.starts_with(['.', '['])) || parent == Some(&problem.path)
    })
}

/// Steps as one writes them: `.extent.radius`, `[0].a`.
fn written(steps: &[Step]) -> String {
    steps
        .iter()
        .map(|step| match step {
            Step::Name(name) => format!(".{name}"),
            Step::Index(index) => format!("[{index}]"),
            Step::Variant(_) => String::new(),
        })
        .collect()
}

/// The steps of a path as one writes it: `surfaces[3].scatter`, `sources["sun"].extent.radius`.
pub fn steps(path: &str) -> Option<Vec<Step>> {
    let mut steps = Vec::new();
    let mut rest = path;
    while !rest.is_empty() {
        let (step, after) = if rest.starts_with("[\"") {
            // Names are written with Rust's escapes; ron reads them.
            let end = tree::quoted(&rest[1..])?;
            let name = ron::from_str(&rest[1..=end]).ok()?;
            (Step::Name(name), rest[end + 1..].strip_prefix(']')?)
        } else if let Some(inside) = rest.strip_prefix('[') {
            let (index, after) = inside.split_once(']')?;
            (Step::Index(index.parse().ok()?), after)
        } else {
            let word = rest.strip_prefix('.').unwrap_or(rest);
            let end = word.find(['.', '[']).unwrap_or(word.len());
            (Step::Name(word[..end].to_owned()), &word[end..])
        };
        steps.push(step);
        rest = after;
    }
    Some(steps)
}

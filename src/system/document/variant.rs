//! Variants: what is said of a system otherwise than it stands, which is the baseline that they are compared with.
//!
//! A variant is laid over the sections of the file as a file over what it includes: names replace names, `surfaces` come last and so
//! override. All documents of a comparison know the surfaces that any of them tells apart, so their parts have the same names.

use super::read::Reader;
use super::tree::{Field, Node, Shape};
use crate::error::{Error, Problem, did_you_mean};
use serde::Deserialize;
use std::collections::BTreeSet;
use std::ops::Range;

/// Sections that a variant may have.
const SECTIONS: [&str; 6] = ["parameters", "media", "coatings", "scatter", "surfaces", "default"];

/// Low and high scatter beside that of the file: `"walls": Bracket` are the variants `walls low` and `walls high`.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Bracket {
    /// Factor on the BSDF at the low end, >= 0.
    pub low: f64,
    /// Factor at the high end, >= 0.
    pub high: f64,
    /// Names in `scatter`; all if none is given. Facets of a rough interface have no level and stay as they are.
    pub of: Vec<String>,
}

impl Default for Bracket {
    fn default() -> Bracket {
        Bracket { low: 0.5, high: 2.0, of: Vec::new() }
    }
}

/// A factor on scatter.
#[derive(Debug, Clone, PartialEq)]
pub struct Level {
    /// On the BSDF, dimensionless.
    pub factor: f64,
    /// Names in `scatter`; empty: all.
    pub of: Vec<String>,
}

impl Default for Level {
    fn default() -> Level {
        Level { factor: 1.0, of: Vec::new() }
    }
}

impl Level {
    /// Factor on the BSDF of the scatter model `name`, dimensionless.
    pub fn of(&self, name: &str) -> f64 {
        if self.of.is_empty() || self.of.iter().any(|known| known == name) { self.factor } else { 1.0 }
    }
}

/// What a document is read as.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Role<'a> {
    /// By itself.
    Alone,
    /// What others are compared with.
    Baseline,
    Variant(&'a str),
}

/// A variant as the file has it.
#[derive(Debug, Clone)]
struct Actor<'a> {
    name: String,
    /// Its name in the file.
    key: &'a str,
    node: &'a Node,
    /// The end of a bracket that it is.
    end: Option<End>,
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum End {
    Low,
    High,
}

/// A document ready to be read in its role.
pub struct Cast {
    pub tree: Node,
    /// Places in `surfaces` of what other variants say: it tells triangles apart and says nothing of them.
    pub foreign: Range<usize>,
    pub own: Range<usize>,
}

/// Names of all variants in the order of the text.
pub fn names(root: &Node) -> Vec<String> {
    actors(root).into_iter().map(|actor| actor.name).collect()
}

fn actors<'a>(root: &'a Node) -> Vec<Actor<'a>> {
    let Some(Shape::Entries(entries)) = root.child("variants").map(|node| &node.shape) else { return Vec::new() };
    let actor = |(key, node): &'a (Node, Node)| {
        let key = key.text()?;
        let one = |name: String, end| Actor { name, key, node, end };
        Some(if node.name.as_deref() == Some("Bracket") {
            vec![one(format!("{key} low"), Some(End::Low)), one(format!("{key} high"), Some(End::High))]
        } else {
            vec![one(key.to_owned(), None)]
        })
    };
    entries.iter().filter_map(actor).flatten().collect()
}

/// The sections of a file in a role.
///
/// # Errors
/// [`Error::Usage`] if there is no such variant.
pub fn cast(root: Node, role: Role) -> Result<Cast, Error> {
    let all = actors(&root);
    let chosen = match role {
        Role::Alone => return Ok(Cast { tree: root, foreign: 0..0, own: 0..0 }),
        Role::Baseline => None,
        Role::Variant(name) => Some(all.iter().find(|actor| actor.name == name).ok_or_else(|| unknown(name, &all))?),
    };
    let mut tree = root.clone();
    let said = chosen.filter(|actor| actor.end.is_none());
    if let Some(Shape::Fields(sections)) = said.map(|actor| &actor.node.shape) {
        sections.iter().filter(|section| section.name != "surfaces").for_each(|section| lay(&mut tree, section));
    }
    let first = items(root.child("surfaces")).len();
    let (mut next, mut own, mut added) = (first, 0..0, Vec::new());
    for actor in all.iter().filter(|actor| actor.end != Some(End::High)) {
        let surfaces = items(actor.node.child("surfaces"));
        if chosen.is_some_and(|chosen| chosen.key == actor.key) {
            own = next..next + surfaces.len();
        }
        next += surfaces.len();
        added.extend_from_slice(surfaces);
    }
    append(&mut tree, &root, added);
    Ok(Cast { tree, foreign: first..next, own })
}

fn unknown(name: &str, all: &[Actor]) -> Error {
    let what = format!("no variant {name:?}");
    Error::Usage(match did_you_mean(name, all.iter().map(|actor| actor.name.as_str())) {
        Some(close) => format!("{what}; did you mean {close:?}?"),
        None if all.is_empty() => format!("{what}; the system has none"),
        None => {
            let names: Vec<&str> = all.iter().map(|actor| actor.name.as_str()).collect();
            format!("{what}; there are: {}", names.join(", "))
        }
    })
}

fn items(node: Option<&Node>) -> &[Node] {
    match node.map(|node| &node.shape) {
        Some(Shape::List(items)) => items,
        _ => &[],
    }
}

/// Lays a section of a variant over that of the system.
fn lay(tree: &mut Node, section: &Field) {
    let Shape::Fields(sections) = &mut tree.shape else { return };
    if section.name == "parameters" {
        // A variant holds whatever configuration is chosen.
        let set: BTreeSet<&str> = entries(&section.value).iter().filter_map(|(key, _)| key.text()).collect();
        let configurations = sections.iter_mut().filter(|known| known.name == "configurations");
        for configuration in configurations.flat_map(|known| entries_mut(&mut known.value)) {
            if let Shape::Entries(values) = &mut configuration.1.shape {
                values.retain(|(key, _)| !key.text().is_some_and(|name| set.contains(name)));
            }
        }
    }
    let Some(known) = sections.iter_mut().find(|known| known.name == section.name) else {
        return sections.push(section.clone());
    };
    match (&mut known.value.shape, &section.value.shape) {
        (Shape::Entries(below), Shape::Entries(above)) => {
            above.iter().for_each(|pair| match below.iter_mut().find(|(key, _)| key.text() == pair.0.text()) {
                Some(same) => *same = pair.clone(),
                None => below.push(pair.clone()),
            })
        }
        _ => known.value = section.value.clone(),
    }
}

/// Puts surfaces after those of the system.
fn append(tree: &mut Node, root: &Node, surfaces: Vec<Node>) {
    let Shape::Fields(sections) = &mut tree.shape else { return };
    if surfaces.is_empty() {
        return;
    }
    let place = root.child("variants").map_or(root.start, |node| node.start);
    match sections.iter_mut().find(|known| known.name == "surfaces").map(|known| &mut known.value.shape) {
        Some(Shape::List(known)) => known.extend(surfaces),
        Some(_) => {}
        None => {
            let value = Node { start: place, end: place + 1, name: None, shape: Shape::List(surfaces) };
            sections.push(Field { name: "surfaces".into(), start: place, value, next: place + 1 });
        }
    }
}

fn entries(node: &Node) -> &[(Node, Node)] {
    if let Shape::Entries(entries) = &node.shape { entries } else { &[] }
}

fn entries_mut(node: &mut Node) -> &mut [(Node, Node)] {
    if let Shape::Entries(entries) = &mut node.shape { entries } else { &mut [] }
}

impl Reader<'_> {
    /// Refuses what is no variant; what the sections hold is judged where the variant is read.
    pub fn variants(&mut self, root: &Node) {
        let Some(section) = root.child("variants") else { return };
        let Shape::Entries(all) = &section.shape else {
            return self.wrong_shape(section, "variants", "named variants in braces, `{\"name\": (..), ..}`");
        };
        for (key, node) in all {
            let path = format!("variants[{:?}]", key.text().unwrap_or_default());
            match &node.shape {
                _ if key.text().is_none() => {
                    let problem = Problem::error("a name must be text").expecting("a name in double quotes");
                    self.push(key.start..key.end, "variants", problem);
                }
                _ if node.name.as_deref() == Some("Bracket") => self.bracket(root, node, &path),
                Shape::Fields(fields) if node.name.is_none() => self.sections_of(root, fields, &path),
                Shape::Items(items) if node.name.is_none() && items.is_empty() => {}
                _ => {
                    let problem = Problem::error("this is no variant");
                    let expected = "sections in parentheses, `(coatings: {..}, surfaces: [..])`, or `Bracket`";
                    self.push(node.start..node.end, &path, problem.expecting(expected));
                }
            }
        }
        for (at, name) in names(root).iter().enumerate() {
            if names(root)[..at].contains(name) || name == "baseline" {
                let what = if name == "baseline" { "is the system as it stands" } else { "is given twice" };
                self.push(section.start..section.end, "variants", Problem::error(format!("the name {name:?} {what}")));
            }
        }
    }

    fn sections_of(&mut self, root: &Node, fields: &[Field], path: &str) {
        for field in fields {
            let place = field.start..field.start + field.name.len();
            let path = format!("{path}.{}", field.name);
            if !SECTIONS.contains(&field.name.as_str()) {
                let problem = Problem::error(format!("a variant has no section `{}`", field.name));
                let problem = match did_you_mean(&field.name, SECTIONS) {
                    Some(close) => problem.hinting(format!("did you mean `{close}`?")),
                    None => problem.expecting(format!("one of {}", SECTIONS.join(", "))),
                };
                self.push(place, &path, problem);
                continue;
            }
            let listed = matches!(field.value.shape, Shape::List(_));
            let mapped = matches!(field.value.shape, Shape::Entries(_));
            match field.name.as_str() {
                "surfaces" if !listed => self.wrong_shape(&field.value, &path, "a list in brackets, `[(..), ..]`"),
                "surfaces" | "default" => {}
                _ if !mapped => {
                    self.wrong_shape(&field.value, &path, "named entries in braces, `{\"name\": .., ..}`");
                }
                _ => self.names_of(root, field, &path),
            }
        }
    }

    /// Every name once, and only parameters that the system has.
    fn names_of(&mut self, root: &Node, field: &Field, path: &str) {
        let known = |name: &str| root.child("parameters").is_some_and(|node| node.key(name).is_some());
        let mut seen = BTreeSet::new();
        for (key, _) in entries(&field.value) {
            let Some(name) = key.text() else { continue };
            if !seen.insert(name) {
                self.push(key.start..key.end, path, Problem::error(format!("the name {name:?} is given twice")));
            }
            if field.name == "parameters" && !known(name) {
                let problem = Problem::error(format!("no parameter `{name}`"));
                let problem = problem.expecting("a parameter of the system, which the variant gives another value");
                self.push(key.start..key.end, path, problem);
            }
        }
    }

    fn bracket(&mut self, root: &Node, node: &Node, path: &str) {
        let Some(bracket) = self.bracketed(node, path) else { return };
        let positive = |value: f64| value >= 0.0 && value.is_finite();
        if !(positive(bracket.low) && positive(bracket.high)) {
            let problem = Problem::error("a factor on scatter is not negative").expecting("numbers such as 0.5 and 2");
            self.push(node.start..node.end, path, problem);
        }
        let models: Vec<&str> =
            root.child("scatter").map_or(&[][..], entries).iter().filter_map(|(key, _)| key.text()).collect();
        for name in bracket.of.iter().filter(|name| !models.contains(&name.as_str())) {
            let problem = Problem::error(format!("no scatter model {name:?}"));
            let problem = match did_you_mean(name, models.iter().copied()) {
                Some(close) => problem.hinting(format!("did you mean {close:?}?")),
                None => problem.expecting(format!("one of {}", models.join(", "))),
            };
            self.push(node.start..node.end, path, problem);
        }
    }

    fn bracketed(&mut self, node: &Node, path: &str) -> Option<Bracket> {
        if matches!(node.shape, Shape::Atom) { Some(Bracket::default()) } else { self.entry(node, path) }
    }

    /// The factor on scatter in a role.
    pub fn level(&mut self, root: &Node, role: Role) -> Level {
        let Role::Variant(name) = role else { return Level::default() };
        let Some(actor) = actors(root).into_iter().find(|actor| actor.name == name) else { return Level::default() };
        let Some(end) = actor.end else { return Level::default() };
        let bracket = self.bracketed(actor.node, &format!("variants[{:?}]", actor.key)).unwrap_or_default();
        Level { factor: if end == End::Low { bracket.low } else { bracket.high }, of: bracket.of }
    }
}

/// Every text in the variants of a file: names that only a variant uses are used.
pub fn mentioned(root: &Node) -> BTreeSet<String> {
    let mut found = BTreeSet::new();
    if let Some(node) = root.child("variants") {
        gather(node, &mut found);
    }
    found
}

fn gather(node: &Node, found: &mut BTreeSet<String>) {
    match &node.shape {
        Shape::Text(text) => {
            found.insert(text.clone());
        }
        Shape::Atom => {}
        Shape::Fields(fields) => fields.iter().for_each(|field| gather(&field.value, found)),
        Shape::Items(all) | Shape::List(all) => all.iter().for_each(|one| gather(one, found)),
        Shape::Entries(all) => all.iter().for_each(|(_, value)| gather(value, found)),
    }
}

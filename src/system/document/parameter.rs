//! Parameters: named quantities, and the expressions of the document that use them.
//!
//! A text that begins with `=` is an expression. Its value is read in its place: a number, `"0.12 m"`, `"(0, 0, 0.12) m"`. Doubles
//! are written so that the same double is read again; a parameter that is a plain quantity is read as it is written.

use super::manuscript::Manuscript;
use super::names::Names;
use super::tree::{Field, Node, Shape};
use super::variant::Role;
use crate::error::{Error, Problem, did_you_mean};
use crate::system::expression::{Quantity, Value, evaluate, is_name};
use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;

/// Parameters that refer to each other in a longer chain are refused.
const LONGEST: usize = 50;

/// What is chosen of a system from outside: by default nothing.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Choice {
    /// A name in `configurations`.
    pub configuration: Option<String>,
    /// Parameters and their expressions, over those of the configuration and of the variant.
    pub set: Vec<(String, String)>,
    /// One of `variants`.
    pub variant: Option<String>,
}

/// Where a parameter gets its value.
#[derive(Debug, Clone)]
enum Origin {
    /// A value of the document.
    Page { range: Range<usize>, path: String },
    /// What is set from outside, by its name.
    Choice(String),
}

#[derive(Debug, Clone)]
struct Definition {
    expression: String,
    origin: Origin,
}

#[derive(Debug, Clone)]
enum State {
    Waiting,
    Working,
    /// `None`: wrong, and told.
    Known(Option<Quantity>),
}

/// The parameters of a document while they are worked out.
struct Workshop<'a> {
    script: &'a Manuscript,
    definitions: BTreeMap<String, Definition>,
    states: BTreeMap<String, State>,
    used: BTreeSet<String>,
    depth: usize,
    problems: Vec<Problem>,
    /// What is wrong with the choice.
    refused: Option<String>,
}

/// What became of the parameters.
pub struct Outcome {
    /// In the order of the text.
    pub values: Names<String>,
    /// What is wrong with expressions.
    pub problems: Vec<Problem>,
    /// Parameters that nothing refers to: worth a word if nothing is wrong.
    pub unused: Vec<Problem>,
}

/// Works out all parameters; values take the place of expressions in the manuscript.
///
/// # Errors
/// [`Error::Usage`] if the choice names what is not there, or sets a parameter to what is no expression.
pub fn substitute(script: &mut Manuscript, root: &Node, choice: &Choice, role: Role) -> Result<Outcome, Error> {
    let mut workshop = Workshop {
        script,
        definitions: BTreeMap::new(),
        states: BTreeMap::new(),
        used: BTreeSet::new(),
        depth: 0,
        problems: Vec::new(),
        refused: None,
    };
    let names = workshop.define(root);
    workshop.configure(root, choice.configuration.as_deref())?;
    workshop.set(&choice.set)?;
    let mut readings = Vec::new();
    if let Shape::Fields(sections) = &root.shape {
        let reserved = ["include", "parameters", "configurations"];
        // What a role takes of the variants stands in its other sections.
        let taken = |section: &&Field| role != Role::Alone && section.name == "variants";
        for section in sections.iter().filter(|s| !reserved.contains(&s.name.as_str()) && !taken(s)) {
            workshop.walk(&section.value, &section.name, &mut readings);
        }
    }
    let value = |name: &String| Some((name.clone(), workshop.value(name)?.text()));
    let values = names.iter().filter_map(value).collect();
    let unused = if role == Role::Alone { workshop.unused(&names) } else { Vec::new() };
    let Workshop { problems, refused, .. } = workshop;
    if let Some(what) = refused {
        return Err(Error::Usage(what));
    }
    readings.into_iter().for_each(|(range, ron)| script.replace(range, ron));
    Ok(Outcome { values, problems, unused })
}

impl Workshop<'_> {
    /// Takes down the section `parameters`; names in the order of the text.
    fn define(&mut self, root: &Node) -> Vec<String> {
        let mut names = Vec::new();
        for (key, value) in entries(root.child("parameters")) {
            let Some(name) = key.text() else { continue };
            let path = format!("parameters[{name:?}]");
            if !is_name(name) {
                let problem = Problem::error(format!("{name:?} cannot name a parameter"));
                let expected = "letters, digits, `_` and `.`, a letter first, and no unit or function";
                self.fault(problem.expecting(expected), &path, key.start..key.end);
            }
            // The reader refuses a name that is given twice.
            if let Some(definition) = self.definition(value, path).filter(|_| !self.definitions.contains_key(name)) {
                self.definitions.insert(name.to_owned(), definition);
                self.states.insert(name.to_owned(), State::Waiting);
                names.push(name.to_owned());
            }
        }
        names
    }

    fn definition(&mut self, value: &Node, path: String) -> Option<Definition> {
        let expression = match &value.shape {
            Shape::Text(text) => text.trim_start().strip_prefix('=').unwrap_or(text).to_owned(),
            Shape::Atom if value.name.is_none() => self.script.written(value.start..value.end).replace('_', ""),
            _ => {
                let problem =
                    Problem::error("this is no quantity").expecting("a quantity or an expression, such as \"12.7 mm\"");
                self.fault(problem, &path, value.start..value.end);
                return None;
            }
        };
        Some(Definition { expression, origin: Origin::Page { range: value.start..value.end, path } })
    }

    /// Lays the chosen configuration over the parameters; all configurations must know their names.
    fn configure(&mut self, root: &Node, chosen: Option<&str>) -> Result<(), Error> {
        let configurations = root.child("configurations");
        let names: Vec<&str> = entries(configurations).iter().filter_map(|(key, _)| key.text()).collect();
        if let Some(chosen) = chosen.filter(|chosen| !names.contains(chosen)) {
            let what = format!("--configuration {chosen:?}: no such configuration");
            return Err(Error::Usage(what + &advice(chosen, &names)));
        }
        for (key, overrides) in entries(configurations) {
            let Some(configuration) = key.text() else { continue };
            for (key, value) in entries(Some(overrides)) {
                let Some(name) = key.text() else { continue };
                let path = format!("configurations[{configuration:?}][{name:?}]");
                if !self.definitions.contains_key(name) {
                    let problem = self.unknown(name);
                    self.fault(problem, &path, key.start..key.end);
                } else if chosen == Some(configuration)
                    && let Some(definition) = self.definition(value, path)
                {
                    self.definitions.insert(name.to_owned(), definition);
                }
            }
        }
        Ok(())
    }

    fn set(&mut self, set: &[(String, String)]) -> Result<(), Error> {
        for (name, expression) in set {
            if !self.definitions.contains_key(name) {
                let names: Vec<&str> = self.definitions.keys().map(String::as_str).collect();
                let what = format!("--set {name:?}: no such parameter");
                return Err(Error::Usage(what + &advice(name, &names)));
            }
            let definition = Definition { expression: expression.clone(), origin: Origin::Choice(name.clone()) };
            self.definitions.insert(name.clone(), definition);
        }
        Ok(())
    }

    fn unknown(&self, name: &str) -> Problem {
        let problem = Problem::error(format!("no parameter `{name}`"));
        match did_you_mean(name, self.definitions.keys().map(String::as_str)) {
            Some(close) => problem.hinting(format!("did you mean `{close}`?")),
            None if self.definitions.is_empty() => problem.hinting("`parameters` defines none".to_owned()),
            None => {
                let names: Vec<String> = self.definitions.keys().take(12).map(|name| format!("`{name}`")).collect();
                problem.expecting(format!("one of {}", names.join(", ")))
            }
        }
    }

    fn fault(&mut self, problem: Problem, path: &str, range: Range<usize>) {
        let problem = self.script.locate(problem.on(path), range);
        self.problems.push(problem);
    }

    /// The value of a parameter that is defined; `None` if it is wrong.
    fn value(&mut self, name: &str) -> Option<Quantity> {
        match self.states.get(name)? {
            State::Known(known) => return known.clone(),
            State::Working | State::Waiting => self.states.insert(name.to_owned(), State::Working),
        };
        let Definition { expression, origin } = self.definitions.get(name)?.clone();
        let value = match self.evaluate(&expression, &origin) {
            Some(Value::Scalar(quantity)) => Some(quantity),
            Some(Value::Triple(_)) => {
                let problem = Problem::error(format!("parameter `{name}` is three values"));
                self.tell(problem.expecting("one value; put three together where they are used"), &origin, None);
                None
            }
            None => None,
        };
        self.states.insert(name.to_owned(), State::Known(value.clone()));
        value
    }

    /// The value of an expression; what is wrong is told.
    fn evaluate(&mut self, expression: &str, origin: &Origin) -> Option<Value> {
        self.depth += 1;
        let value = evaluate(expression, &mut |name| self.refer(name));
        self.depth -= 1;
        value.map_err(|fault| fault.problem.map(|problem| self.tell(problem, origin, Some(fault.range)))).ok()
    }

    /// The value of a parameter that an expression names.
    fn refer(&mut self, name: &str) -> Result<Quantity, Option<Problem>> {
        self.used.insert(name.to_owned());
        match self.states.get(name) {
            None => Err(Some(self.unknown(name))),
            Some(State::Working) => Err(Some(Problem::error(format!("parameter `{name}` depends on itself")))),
            _ if self.depth > LONGEST => {
                Err(Some(Problem::error(format!("more than {LONGEST} parameters depend on each other in a row"))))
            }
            _ => self.value(name).ok_or(None),
        }
    }

    /// Notes what is wrong in an expression, within it if its text is written plainly.
    fn tell(&mut self, problem: Problem, origin: &Origin, within: Option<Range<usize>>) {
        match origin {
            Origin::Choice(name) => self.refused = self.refused.take().or(Some(format!("--set {name:?}: {problem}"))),
            Origin::Page { range, path } => {
                let written = self.script.written(range.clone());
                let inner = within.map(|within| {
                    let skip = written.find('=').map_or_else(|| usize::from(written.starts_with('"')), |at| at + 1);
                    range.start + skip + within.start..(range.start + skip + within.end).min(range.end)
                });
                let plain = written.len() < 2 || !written.starts_with('r') && !written.contains('\\');
                let place = inner.filter(|inner| plain && inner.start < inner.end).unwrap_or(range.clone());
                self.fault(problem, path, place);
            }
        }
    }

    /// Every expression below a node, with what is to be read in its place.
    fn walk(&mut self, node: &Node, path: &str, readings: &mut Vec<(Range<usize>, Option<String>)>) {
        match &node.shape {
            Shape::Text(text) => {
                let Some(expression) = text.trim_start().strip_prefix('=') else { return };
                let range = node.start..node.end;
                let origin = Origin::Page { range: range.clone(), path: path.to_owned() };
                readings.push((range, self.evaluate(expression, &origin).map(|value| value.ron())));
            }
            Shape::Atom => {}
            Shape::Fields(fields) => {
                fields.iter().for_each(|field| self.walk(&field.value, &format!("{path}.{}", field.name), readings));
            }
            Shape::Items(items) if node.content().is_some() => self.walk(&items[0], path, readings),
            Shape::Items(items) | Shape::List(items) => {
                items.iter().enumerate().for_each(|(at, item)| self.walk(item, &format!("{path}[{at}]"), readings));
            }
            Shape::Entries(entries) => {
                for (key, value) in entries {
                    self.walk(value, &format!("{path}[{:?}]", key.text().unwrap_or_default()), readings);
                }
            }
        }
    }

    fn unused(&self, names: &[String]) -> Vec<Problem> {
        let told = |name: &String| match &self.definitions.get(name)?.origin {
            Origin::Page { range, path } => {
                let problem = Problem::warning(format!("parameter `{name}` is never used")).on(path);
                Some(self.script.locate(problem, range.clone()))
            }
            Origin::Choice(_) => None,
        };
        names.iter().filter(|name| !self.used.contains(*name)).filter_map(told).collect()
    }
}

/// The entries of a section that is a map.
fn entries(section: Option<&Node>) -> &[(Node, Node)] {
    match section.map(|node| &node.shape) {
        Some(Shape::Entries(entries)) => entries,
        _ => &[],
    }
}

/// What may have been meant on the command line.
fn advice(name: &str, names: &[&str]) -> String {
    match did_you_mean(name, names.iter().copied()) {
        Some(close) => format!("; did you mean {close:?}?"),
        None if names.is_empty() => "; the system has none".to_owned(),
        None => format!("; there are: {}", names.join(", ")),
    }
}

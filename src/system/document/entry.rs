//! One entry of the document, from its text to its type, with everything that is wrong with it.
//!
//! serde stops at the first fault. So that all of them are reported at once, a fault is mended in a copy of the text
//! (an unknown field is left out, a bad value is replaced by the first stand-in that its field accepts) and the copy is
//! read again. What was mended is remembered, so that a stand-in is never judged.

use super::tree::{self, Node, Shape, Step};
use crate::error::{Problem, did_you_mean};
use crate::system::units::{BARE_NUMBER, EXPECTED};
use ron::extensions::Extensions;
use serde::de::DeserializeOwned;
use serde_path_to_error::Segment;
use std::ops::Range;

/// Faults reported per entry; who made more than these made one mistake many times.
const MOST: usize = 50;

/// Bytes read again per entry while mending, divided by the number of stand-ins: a long table is not mended 50 times.
const EFFORT: usize = 1 << 20;

/// Values that stand in for one that cannot be read: one per type of the document.
const STAND_INS: &[&str] = &[
    "1",
    "0.5",
    "\"1 um\"",
    "\"1 um2\"",
    "\"1 /mm\"",
    "\"1 deg\"",
    "\"1 W\"",
    "\"1 W/m2\"",
    "\"1 K\"",
    "\"1 Pa\"",
    "\"(0, 0, 1) mm\"",
    "\"(0, 0, 1) deg\"",
    "\"(0, 0, 1)\"",
    "\"m\"",
    "\"1 % on x\"",
];

/// An entry as read.
pub struct Entry<T> {
    /// The value; `None` if it could not be read even after mending.
    pub value: Option<T>,
    /// What is wrong; places are steps from the entry.
    pub faults: Vec<Fault>,
}

/// Something wrong with an entry.
#[derive(Debug, Clone)]
pub struct Fault {
    /// Steps from the entry to the value (without variants that only unwrap).
    pub steps: Vec<Step>,
    /// The field that is wrong by its name, not by its value.
    pub field: Option<String>,
    code: ron::Error,
}

/// Reads the text of one entry.
pub fn read<T: DeserializeOwned>(text: &str) -> Entry<T> {
    let mut text = text.to_owned();
    let most = (EFFORT / text.len().max(1)).clamp(1, MOST);
    let mut faults: Vec<Fault> = Vec::new();
    loop {
        let fault = match parse::<T>(&text) {
            Ok(value) => return Entry { value: Some(value), faults },
            Err(fault) => with_options::<T>(&text, fault),
        };
        let mended = if faults.len() < most { mend::<T>(&text, &fault) } else { None };
        faults.push(fault);
        match mended {
            Some(better) => text = better,
            None => return Entry { value: None, faults },
        }
    }
}

/// Reads a text as one value, without mending.
fn parse<T: DeserializeOwned>(text: &str) -> Result<T, Fault> {
    let extensions = Extensions::IMPLICIT_SOME | Extensions::UNWRAP_NEWTYPES | Extensions::UNWRAP_VARIANT_NEWTYPES;
    let options = ron::Options::default().with_default_extension(extensions);
    let at_start = |code| Fault { steps: Vec::new(), field: None, code };
    let mut ron = ron::de::Deserializer::from_str_with_options(text, &options).map_err(|e| at_start(e.code))?;
    let value = serde_path_to_error::deserialize(&mut ron).map_err(|error| {
        let steps = error.path().iter().map(step).collect();
        let code = error.into_inner();
        let field = match &code {
            ron::Error::NoSuchStructField { found, .. } => Some(found.clone()),
            ron::Error::DuplicateStructField { field, .. } => Some((*field).to_owned()),
            _ => None,
        };
        Fault { steps, field, code }
    })?;
    ron.end().map_err(at_start)?;
    Ok(value)
}

fn step(segment: &Segment) -> Step {
    match segment {
        Segment::Seq { index } => Step::Index(*index),
        Segment::Map { key } => Step::Name(key.clone()),
        Segment::Enum { variant } => Step::Variant(variant.clone()),
        Segment::Unknown => Step::Name(String::new()),
    }
}

/// The fault with the options of the enum, if anything but a word stands where one is wanted.
fn with_options<T: DeserializeOwned>(text: &str, fault: Fault) -> Fault {
    let tree = tree::read(text).ok();
    let Some(node) = tree.as_ref().and_then(|tree| tree.find(&fault.steps)) else { return fault };
    if fault.code != ron::Error::ExpectedIdentifier {
        return fault;
    }
    match parse::<T>(&spliced(text, node.start..node.end, "Zzz")) {
        Err(Fault { steps, code: ron::Error::NoSuchEnumVariant { expected, outer, .. }, .. })
            if steps == fault.steps =>
        {
            let found = brief(&text[node.start..node.end]);
            Fault { code: ron::Error::NoSuchEnumVariant { expected, found, outer }, ..fault }
        }
        _ => fault,
    }
}

/// The text with the fault replaced by something harmless; `None` if that cannot be done.
fn mend<T: DeserializeOwned>(text: &str, fault: &Fault) -> Option<String> {
    let tree = tree::read(text).ok()?;
    if let Some(name) = &fault.field {
        let holder = holder(&tree, fault)?;
        let range = field_range(holder, name)?;
        return Some(match fault.close().filter(|close| holder.child(close).is_none()) {
            Some(close) => spliced(text, range.start..range.start + name.len(), close),
            None => spliced(text, range, ""),
        });
    }
    if matches!(fault.code, ron::Error::MissingStructField { .. }) {
        return None;
    }
    let node = tree.find(&fault.steps)?;
    let better = |text: &String| parse::<T>(text).err().is_none_or(|next| next.is_beyond(fault));
    if let (Some(close), Some(name)) = (fault.close(), &node.name) {
        return Some(spliced(text, node.start..node.start + name.len(), close)).filter(better);
    }
    let replaced = STAND_INS.iter().map(|value| spliced(text, node.start..node.end, value)).find(better);
    replaced.or_else(|| without_field::<T>(text, &tree, fault))
}

/// The text without the field that holds the fault, if the field may be left out.
fn without_field<T: DeserializeOwned>(text: &str, tree: &Node, fault: &Fault) -> Option<String> {
    let last = fault.steps.iter().rposition(|step| matches!(step, Step::Name(_)))?;
    let Step::Name(name) = &fault.steps[last] else { return None };
    let text = spliced(text, field_range(tree.find(&fault.steps[..last])?, name)?, "");
    match parse::<T>(&text) {
        Err(Fault { code: ron::Error::MissingStructField { .. }, .. }) => None,
        _ => Some(text),
    }
}

/// The last field of this name and the comma after it, in bytes.
fn field_range(node: &Node, name: &str) -> Option<Range<usize>> {
    match &node.shape {
        Shape::Fields(fields) => fields.iter().rfind(|field| field.name == name).map(|field| field.start..field.next),
        _ => None,
    }
}

/// The struct whose field has a wrong name.
fn holder<'a>(tree: &'a Node, fault: &Fault) -> Option<&'a Node> {
    let named = fault.field.as_deref()?;
    // The path of serde may or may not end with the field itself.
    let inner = tree.find(&fault.steps).filter(|node| field_range(node, named).is_some());
    inner.or_else(|| tree.find(&fault.steps[..fault.steps.len().saturating_sub(1)]))
}

fn spliced(text: &str, range: Range<usize>, with: &str) -> String {
    let mut text = text.to_owned();
    text.replace_range(range, with);
    text
}

impl Fault {
    /// The known name that was most likely meant by an unknown field or option.
    fn close(&self) -> Option<&'static str> {
        match &self.code {
            ron::Error::NoSuchStructField { expected, found, .. } => did_you_mean(found, expected.iter().copied()),
            ron::Error::NoSuchEnumVariant { expected, found, .. } => did_you_mean(found, expected.iter().copied()),
            _ => None,
        }
    }

    /// True if this fault is not the other one again: it is elsewhere, or about the fields of what holds both.
    fn is_beyond(&self, other: &Fault) -> bool {
        let fields = self.field.is_some() || matches!(self.code, ron::Error::MissingStructField { .. });
        let path = |fault: &Fault| -> Vec<Step> {
            fault.steps.iter().filter(|step| !matches!(step, Step::Variant(_))).cloned().collect()
        };
        let (here, there) = (path(self), path(other));
        let inside = matches!(other.code, ron::Error::NoSuchEnumVariant { .. }) && self.code != other.code;
        let related = here.starts_with(&there) || there.starts_with(&here);
        !related || (fields && here.len() < there.len()) || (inside && self.steps.len() > other.steps.len())
    }

    /// Where the fault is in the tree of the entry, in bytes of the text the tree was read from.
    pub fn range(&self, entry: &Node) -> Range<usize> {
        if let (Some(holder), Some(name)) = (holder(entry, self), &self.field)
            && let Some(range) = field_range(holder, name)
        {
            return range.start..range.start + name.len();
        }
        let node = (0..=self.steps.len()).rev().find_map(|n| entry.find(&self.steps[..n])).unwrap_or(entry);
        let name = node.name.as_ref().map_or(1, String::len);
        match &self.code {
            ron::Error::NoSuchEnumVariant { found, .. } if node.name.as_ref() == Some(found) => {
                node.start..node.start + name
            }
            ron::Error::MissingStructField { .. } | ron::Error::ExpectedDifferentStructName { .. } => {
                node.start..node.start + name
            }
            _ => node.start..node.end,
        }
    }

    /// What is wrong, what was expected, and a hint; `written` is the text of the value.
    pub fn problem(&self, written: &str) -> Problem {
        let quoted = brief(written);
        let missing = |what: &str| Problem::error(format!("`{quoted}` is not {what}"));
        match &self.code {
            ron::Error::NoSuchStructField { expected, found, outer } => {
                let of = outer.as_ref().map(|outer| format!("{outer} has ")).unwrap_or_default();
                unknown(format!("{of}no field `{found}`"), found, expected)
            }
            ron::Error::NoSuchEnumVariant { expected, found, .. } => {
                unknown(format!("there is no `{found}` here"), found, expected)
            }
            ron::Error::MissingStructField { field, outer } => {
                let of = outer.as_ref().map(|outer| format!(" of {outer}")).unwrap_or_default();
                Problem::error(format!("field `{field}`{of} is missing"))
            }
            ron::Error::DuplicateStructField { field, .. } => Problem::error(format!("field `{field}` is given twice")),
            ron::Error::Message(text) => match text.split_once(EXPECTED) {
                Some((BARE_NUMBER, expected)) => {
                    Problem::error(format!("`{quoted}` is a bare number")).expecting(expected)
                }
                Some((what, expected)) => Problem::error(what).expecting(expected),
                None => Problem::error(text.clone()),
            },
            ron::Error::InvalidValueForType { expected, .. } => missing(plain(expected)),
            ron::Error::ExpectedFloat => missing("a number"),
            ron::Error::ExpectedInteger => missing("a whole number"),
            ron::Error::InvalidIntegerDigit { .. } => missing("a whole number"),
            ron::Error::IntegerOutOfBounds => Problem::error(format!("`{quoted}` is out of range"))
                .expecting("a whole number, not negative, not too large"),
            ron::Error::ExpectedBoolean => missing("true or false"),
            ron::Error::ExpectedString | ron::Error::ExpectedStringEnd => missing("text in double quotes"),
            ron::Error::ExpectedArray => missing("a list in brackets, [..]"),
            ron::Error::ExpectedStructLike | ron::Error::ExpectedNamedStructLike(_) => {
                Problem::error(format!("`{quoted}` lacks its parentheses")).expecting("values in parentheses, `(..)`")
            }
            ron::Error::ExpectedStructLikeEnd => Problem::error(format!("`{quoted}` holds too many values")),
            ron::Error::ExpectedDifferentStructName { expected, found } => {
                Problem::error(format!("this is a `{found}`"))
                    .expecting(format!("a `{expected}`, which needs no name: `(..)`"))
            }
            ron::Error::ExpectedDifferentLength { expected, found } => {
                Problem::error(format!("`{quoted}` holds {found} values")).expecting(expected.clone())
            }
            ron::Error::ExpectedIdentifier => missing("a word"),
            other => Problem::error(format!("`{quoted}` cannot be read: {other}")),
        }
    }
}

/// A name that is not on the list: what was meant, or what the list is.
fn unknown(message: String, found: &str, list: &[&str]) -> Problem {
    let names: Vec<String> = list.iter().map(|name| format!("`{name}`")).collect();
    let problem = Problem::error(message).expecting(format!("one of {}", names.join(", ")));
    match did_you_mean(found, list.iter().copied()) {
        Some(name) => problem.hinting(format!("did you mean `{name}`?")),
        None => problem,
    }
}

/// The words of serde for types, in the user's.
fn plain(expected: &str) -> &str {
    match expected {
        "f64" | "f32" => "a number",
        "u64" | "u32" | "i32" => "a whole number",
        "a string" | "path string" => "text in double quotes",
        "a sequence" => "a list in brackets, [..]",
        other => other,
    }
}

/// The text of a value, on one line and not too long.
fn brief(written: &str) -> String {
    let line: String = written.split_whitespace().collect::<Vec<_>>().join(" ");
    if line.chars().count() <= 40 { line } else { line.chars().take(37).chain("...".chars()).collect() }
}

//! Which light is meant: one readable expression over the names and events of its path.
//!
//! ```text
//! sun > L1.front:T > Barrel*:S > ... > fpa     from the sun, through L1.front, scattered at a barrel, and so on to fpa
//! ... > Barrel*:S > ...                        the same as `Barrel*:S`: anywhere on the way
//! scatters == 1 and not Baffle*                scattered once, and met no baffle
//! ghost(L2.rear, L1.front)                     not scattered; reflected where nobody asked for it at L2.rear, then at L1.front
//! ```
//!
//! ```text
//! expression  term or term or ..
//! term        factor and factor and ..
//! factor      not factor, (expression), or one of
//!   word      signal  direct  ghost  scatter: the class of the light;  stray: all that is not meant to arrive
//!   number    scatters  ghosts  reflections  events, compared by == != < <= > >= with a whole number
//!   ghost(..) the parts of all unintended reflections in the order in which light meets them
//!   chain     source > step > .. > detector: the whole way, `...` for any number of steps
//!   step      what is met anywhere: a part or medium, or else a source or detector
//! step        name, or name:EVENTS with letters R reflect, T transmit, S scatter, V scatter in a medium
//! name        as path tables write it, `*` for any text and `?` for one character; "in quotes" if it has other signs in it
//! ```
//!
//! A path of more steps than are spelled out ([`LONGEST_PATH`](crate::packet::LONGEST_PATH)) may leave it open whether it is meant: the
//! answer is then neither yes nor no.

mod chain;
mod glob;
mod lexer;
mod parse;
#[cfg(test)]
mod tests;

pub use glob::matches;

use crate::error::Problem;
use crate::packet::{Ancestry, Class, Event, Step};
use chain::Chain;

/// What a filter may name, by number: all that a path passes.
#[derive(Clone, Debug)]
pub struct Names {
    pub sources: Vec<String>,
    pub parts: Vec<String>,
    pub media: Vec<String>,
    pub detectors: Vec<String>,
    /// The class of the light that is meant to arrive.
    pub image: Class,
}

/// A choice of paths.
#[derive(Clone, Debug)]
pub struct Filter {
    /// What reports call it.
    pub label: String,
    /// The expression as written.
    pub text: String,
    rule: Rule,
}

impl Filter {
    /// The filter that `text` writes, or everything that is wrong with it.
    pub fn parse(label: &str, text: &str, names: &Names) -> Result<Filter, Vec<Problem>> {
        let rule = parse::rule(text, names)?;
        Ok(Filter { label: label.into(), text: text.into(), rule })
    }

    /// Whether light on this path is meant once it has come to a detector that sees it so ([`Ancestry::ending`]). `None`: what is
    /// spelled out of the path does not tell.
    pub fn accepts(&self, detector: usize, path: &Ancestry) -> Option<bool> {
        self.rule.holds(detector, path)
    }
}

/// An expression.
#[derive(Clone, Debug)]
enum Rule {
    Or(Vec<Rule>),
    And(Vec<Rule>),
    Not(Box<Rule>),
    Class(Word, Class),
    Count(Count, Comparison, u32),
    /// Parts by number, per unintended reflection.
    Ghost(Vec<Vec<bool>>),
    Chain(Chain),
    Met(Met),
}

/// Classes of light by name; stray is what is not the class that comes with the word.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Word {
    Signal,
    Direct,
    Ghost,
    Scatter,
    Stray,
}

/// What is counted along a path.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Count {
    Scatters,
    Ghosts,
    Reflections,
    Events,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Comparison {
    Equal,
    Unequal,
    Less,
    AtMost,
    More,
    AtLeast,
}

/// Something met anywhere: a step, or the end of the path.
#[derive(Clone, Debug)]
struct Met {
    steps: Steps,
    /// By number; none if empty.
    sources: Vec<bool>,
    detectors: Vec<bool>,
}

/// Steps by what acts, and by what it does (indexed by [`Event`]).
#[derive(Clone, Debug)]
struct Steps {
    /// By number; none if empty.
    parts: Vec<bool>,
    media: Vec<bool>,
    events: [bool; 4],
}

impl Steps {
    fn has(&self, step: Step) -> bool {
        let named = if step.event() == Event::Bulk { &self.media } else { &self.parts };
        self.events[step.event() as usize] && has(named, step.number() as usize)
    }

    /// Whether there may be such a step in what is not spelled out of a path.
    fn may_follow(&self, path: &Ancestry) -> bool {
        let unspelled = path.unspelled();
        [Event::Reflect, Event::Transmit, Event::Scatter, Event::Bulk].into_iter().any(|event| {
            let named = if event == Event::Bulk { &self.media } else { &self.parts };
            self.events[event as usize] && unspelled[event as usize] && named.contains(&true)
        })
    }
}

fn has(marked: &[bool], number: usize) -> bool {
    marked.get(number).is_some_and(|&marked| marked)
}

impl Rule {
    /// Kleene's logic: what is open stays open unless the rest decides.
    fn holds(&self, detector: usize, path: &Ancestry) -> Option<bool> {
        match self {
            Rule::Or(rules) => any(rules.iter().map(|rule| rule.holds(detector, path))),
            Rule::And(rules) => any(rules.iter().map(|rule| rule.holds(detector, path).map(|yes| !yes))).map(|no| !no),
            Rule::Not(rule) => rule.holds(detector, path).map(|yes| !yes),
            Rule::Class(word, image) => Some(word.names(path.class(), *image)),
            Rule::Count(count, comparison, number) => Some(comparison.holds(count.of(path), *number)),
            // What is not spelled out of a path that was found from its end is its beginning.
            Rule::Ghost(_) | Rule::Chain(_) if !path.is_spelled() && path.key == 0 => None,
            Rule::Ghost(parts) => ghost(parts, path),
            Rule::Chain(chain) => chain.holds(detector, path),
            Rule::Met(met) => met.holds(detector, path),
        }
    }
}

/// Yes if any says so, open if none does but one is open.
fn any(answers: impl Iterator<Item = Option<bool>>) -> Option<bool> {
    let mut open = false;
    for answer in answers {
        match answer {
            Some(true) => return Some(true),
            Some(false) => {}
            None => open = true,
        }
    }
    (!open).then_some(false)
}

impl Word {
    fn names(self, class: Class, image: Class) -> bool {
        match self {
            Word::Signal => class == Class::Signal,
            Word::Direct => class == Class::Direct,
            Word::Ghost => matches!(class, Class::Ghost(_)),
            Word::Scatter => matches!(class, Class::Scatter(_)),
            Word::Stray => class != image,
        }
    }
}

impl Count {
    fn of(self, path: &Ancestry) -> u32 {
        match self {
            Count::Scatters => path.scatters.into(),
            Count::Ghosts => path.ghosts.into(),
            Count::Reflections => path.reflections,
            Count::Events => path.events,
        }
    }
}

impl Comparison {
    fn holds(self, value: u32, number: u32) -> bool {
        match self {
            Comparison::Equal => value == number,
            Comparison::Unequal => value != number,
            Comparison::Less => value < number,
            Comparison::AtMost => value <= number,
            Comparison::More => value > number,
            Comparison::AtLeast => value >= number,
        }
    }
}

fn ghost(parts: &[Vec<bool>], path: &Ancestry) -> Option<bool> {
    if path.scatters > 0 || path.ghosts as usize != parts.len() {
        return Some(false);
    }
    let met: Vec<_> = path.reflected.iter().filter(|step| step.is_ghost()).collect();
    if !met.iter().zip(parts).all(|(step, parts)| has(parts, step.number() as usize)) {
        return Some(false);
    }
    (met.len() == parts.len()).then_some(true)
}

impl Met {
    fn holds(&self, detector: usize, path: &Ancestry) -> Option<bool> {
        let met = has(&self.sources, path.source.into())
            || has(&self.detectors, detector)
            || path.steps.iter().any(|step| self.steps.has(*step));
        let open = !met && self.steps.may_follow(path);
        (!open).then_some(met)
    }
}

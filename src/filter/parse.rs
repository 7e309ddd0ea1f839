//! Reads an expression.

#![allow(clippy::result_large_err, reason = "one problem ends the reading")]

use super::chain::{Chain, Link};
use super::lexer::{Token, What, tokens};
use super::{Comparison, Count, Met, Names, Rule, Steps, Word, matches};
use crate::error::{Problem, Span, did_you_mean};
use crate::packet::Event;

/// Brackets and `not` within each other; more is no filter that anybody wrote.
const DEEPEST: usize = 64;

const EVENTS: [Event; 4] = [Event::Reflect, Event::Transmit, Event::Scatter, Event::Bulk];

const WORDS: [(&str, Word); 5] = [
    ("signal", Word::Signal),
    ("direct", Word::Direct),
    ("ghost", Word::Ghost),
    ("scatter", Word::Scatter),
    ("stray", Word::Stray),
];

const COUNTS: [(&str, Count); 4] = [
    ("scatters", Count::Scatters),
    ("ghosts", Count::Ghosts),
    ("reflections", Count::Reflections),
    ("events", Count::Events),
];

const COMPARISONS: [(&str, Comparison); 6] = [
    ("==", Comparison::Equal),
    ("!=", Comparison::Unequal),
    ("<", Comparison::Less),
    ("<=", Comparison::AtMost),
    (">", Comparison::More),
    (">=", Comparison::AtLeast),
];

/// The rule that a text writes: a fault of grammar ends the reading, unknown names are told together.
pub fn rule(text: &str, names: &Names) -> Result<Rule, Vec<Problem>> {
    let tokens = tokens(text).map_err(|problem| vec![problem])?;
    let mut reader = Reader { tokens, at: 0, depth: 0, names, unknown: Vec::new() };
    let read = reader.expression().and_then(|rule| match reader.peek() {
        What::End => Ok(rule),
        _ => Err(reader.unexpected("`and`, `or`, `>` or the end")),
    });
    match read {
        Ok(rule) if reader.unknown.is_empty() => Ok(rule),
        Ok(_) => Err(reader.unknown),
        Err(problem) => Err(reader.unknown.into_iter().chain([problem]).collect()),
    }
}

struct Reader<'a> {
    tokens: Vec<Token>,
    at: usize,
    depth: usize,
    names: &'a Names,
    unknown: Vec<Problem>,
}

/// A name with the events written behind it.
struct Item {
    name: String,
    events: Option<[bool; 4]>,
    place: Span,
}

/// What stands between two `>`, as written.
enum Written {
    Gap,
    Item(Item),
}

type Read<T> = Result<T, Problem>;

impl Reader<'_> {
    fn expression(&mut self) -> Read<Rule> {
        let mut rules = vec![self.term()?];
        while self.take_word("or") {
            rules.push(self.term()?);
        }
        Ok(Rule::Or(rules))
    }

    fn term(&mut self) -> Read<Rule> {
        let mut rules = vec![self.factor()?];
        while self.take_word("and") {
            rules.push(self.factor()?);
        }
        Ok(Rule::And(rules))
    }

    fn factor(&mut self) -> Read<Rule> {
        if self.depth >= DEEPEST {
            return Err(Problem::error(format!("more than {DEEPEST} brackets within each other")).at(self.place()));
        }
        self.depth += 1;
        let rule = if self.take_word("not") {
            Rule::Not(Box::new(self.factor()?))
        } else if self.take_sign("(") {
            let inside = self.expression()?;
            self.sign(")")?;
            inside
        } else {
            self.statement()?
        };
        self.depth -= 1;
        Ok(rule)
    }

    /// A class, a count, ghosts, or a chain.
    fn statement(&mut self) -> Read<Rule> {
        let What::Word(word) = self.peek().clone() else { return self.chain() };
        let after = self.tokens.get(self.at + 1).map_or(&What::End, |token| &token.what);
        if let Some((_, count)) = COUNTS.iter().find(|(name, _)| *name == word)
            && let What::Sign(sign) = after
            && let Some((_, comparison)) = COMPARISONS.iter().find(|(written, _)| written == sign)
        {
            self.at += 2;
            return Ok(Rule::Count(*count, *comparison, self.number()?));
        }
        if word == "ghost" && *after == What::Sign("(") {
            self.at += 2;
            return self.ghost();
        }
        match WORDS.iter().find(|(name, _)| *name == word) {
            Some((_, class)) if !matches!(after, What::Sign(":" | ">")) => {
                self.at += 1;
                Ok(Rule::Class(*class, self.names.image))
            }
            _ => self.chain(),
        }
    }

    fn number(&mut self) -> Read<u32> {
        let number = match self.peek() {
            What::Word(word) => word.parse().ok(),
            _ => None,
        };
        let number = number.ok_or_else(|| self.unexpected("a whole number"))?;
        self.at += 1;
        Ok(number)
    }

    /// The parts between the brackets of `ghost(..)`.
    fn ghost(&mut self) -> Read<Rule> {
        let mut reflections = Vec::new();
        loop {
            let (name, place) = self.name("the name of a part")?;
            let item = Item { name, events: None, place };
            reflections.push(self.marked(&item, &[Kind::Part]).remove(0));
            if !self.take_sign(",") {
                self.sign(")")?;
                return Ok(Rule::Ghost(reflections));
            }
        }
    }

    fn chain(&mut self) -> Read<Rule> {
        let begin = self.place();
        let mut links = vec![self.link()?];
        while self.take_sign(">") {
            links.push(self.link()?);
        }
        let last = links.len() - 1;
        if last >= Chain::MOST {
            return Err(Problem::error(format!("a chain of more than {} links", Chain::MOST)).at(begin));
        }
        if last == 0 {
            return match links.remove(0) {
                Written::Item(item) => Ok(Rule::Met(self.met(&item))),
                Written::Gap => Err(Problem::error("`...` alone says nothing")
                    .at(begin)
                    .expecting("a chain such as `... > Barrel*:S > ...`")),
            };
        }
        let resolve = |(at, link)| match link {
            Written::Gap => Link::Gap,
            Written::Item(item) if at == 0 => self.end(&item, Kind::Source),
            Written::Item(item) if at == last => self.end(&item, Kind::Detector),
            Written::Item(item) => Link::Steps(self.steps(&item)),
        };
        Ok(Rule::Chain(Chain::new(links.into_iter().enumerate().map(resolve).collect())))
    }

    fn link(&mut self) -> Read<Written> {
        if *self.peek() == What::Gap {
            self.at += 1;
            return Ok(Written::Gap);
        }
        let (name, place) = self.name("the name of a source, part, medium or detector, or `...`")?;
        let events = if self.take_sign(":") { Some(self.events()?) } else { None };
        Ok(Written::Item(Item { name, events, place }))
    }

    fn events(&mut self) -> Read<[bool; 4]> {
        let expected = "letters of R (reflect), T (transmit), S (scatter) and V (scatter in a medium)";
        let What::Word(letters) = self.peek().clone() else { return Err(self.unexpected(expected)) };
        let mut events = [false; 4];
        for letter in letters.chars() {
            let event = EVENTS.into_iter().find(|event| event.letter() == letter);
            let event = event.ok_or_else(|| self.unexpected(expected))?;
            events[event as usize] = true;
        }
        self.at += 1;
        Ok(events)
    }

    /// The source that a chain begins with, or the detector that it ends on.
    fn end(&mut self, item: &Item, kind: Kind) -> Link {
        let source = kind == Kind::Source;
        if item.events.is_some() {
            let [which, how] = if source { ["first", "begin with `... >`"] } else { ["last", "end with `> ...`"] };
            let problem = Problem::error(format!("the {which} of a chain is a {}, which has no events", kind.label()));
            self.unknown.push(problem.at(item.place).hinting(how.to_owned()));
            return Link::Gap;
        }
        let found = self.marked(item, &[kind]).remove(0);
        if source { Link::Source(found) } else { Link::Detector(found) }
    }

    fn steps(&mut self, item: &Item) -> Steps {
        let events = item.events.unwrap_or([true; 4]);
        let acts = |bulk: bool| EVENTS.iter().any(|&event| events[event as usize] && (event == Event::Bulk) == bulk);
        let kinds: &[Kind] = match [acts(false), acts(true)] {
            [true, false] => &[Kind::Part],
            [false, true] => &[Kind::Medium],
            _ => &[Kind::Part, Kind::Medium],
        };
        let mut steps = Steps { parts: Vec::new(), media: Vec::new(), events };
        for (kind, marked) in kinds.iter().zip(self.marked(item, kinds)) {
            *(if *kind == Kind::Medium { &mut steps.media } else { &mut steps.parts }) = marked;
        }
        steps
    }

    fn met(&mut self, item: &Item) -> Met {
        if item.events.is_some() {
            return Met { steps: self.steps(item), sources: Vec::new(), detectors: Vec::new() };
        }
        let kinds = [Kind::Part, Kind::Medium, Kind::Source, Kind::Detector];
        let mut found = self.marked(item, &kinds).into_iter();
        let mut next = || found.next().unwrap_or_default();
        let steps = Steps { parts: next(), media: next(), events: [true; 4] };
        Met { steps, sources: next(), detectors: next() }
    }

    /// Which of each kind have the name; one that none has is taken down.
    fn marked(&mut self, item: &Item, kinds: &[Kind]) -> Vec<Vec<bool>> {
        let all: Vec<&[String]> = kinds.iter().map(|kind| kind.of(self.names)).collect();
        let marked = |names: &&[String]| names.iter().map(|name| matches(&item.name, name)).collect::<Vec<bool>>();
        let found: Vec<Vec<bool>> = all.iter().map(marked).collect();
        if !found.iter().flatten().any(|&found| found) {
            let kinds: Vec<&str> = kinds.iter().map(|kind| kind.label()).collect();
            let problem = Problem::error(format!("no {} is called {:?}", kinds.join(" or "), item.name)).at(item.place);
            let names = || all.iter().flat_map(|names| names.iter().map(String::as_str));
            self.unknown.push(match did_you_mean(&item.name, names()) {
                Some(name) => problem.hinting(format!("did you mean {name:?}?")),
                None => problem.expecting(some(names().collect())),
            });
        }
        found
    }

    fn name(&mut self, expected: &str) -> Read<(String, Span)> {
        let reserved = ["and", "or", "not"];
        let name = match self.peek() {
            What::Word(word) if !reserved.contains(&word.as_str()) => word.clone(),
            What::Quoted(name) => name.clone(),
            _ => return Err(self.unexpected(expected)),
        };
        let place = self.place();
        self.at += 1;
        Ok((name, place))
    }

    fn sign(&mut self, sign: &'static str) -> Read<()> {
        if self.take_sign(sign) { Ok(()) } else { Err(self.unexpected(&format!("`{sign}`"))) }
    }

    fn take_sign(&mut self, sign: &'static str) -> bool {
        self.take(&What::Sign(sign))
    }

    fn take_word(&mut self, word: &str) -> bool {
        self.take(&What::Word(word.into()))
    }

    fn take(&mut self, what: &What) -> bool {
        let there = self.peek() == what;
        self.at += there as usize;
        there
    }

    fn peek(&self) -> &What {
        self.tokens.get(self.at).map_or(&What::End, |token| &token.what)
    }

    fn place(&self) -> Span {
        let token = self.tokens.get(self.at).or(self.tokens.last());
        token.map_or(Span { line: 1, column: 1, len: 0 }, |token| Span {
            line: 1,
            column: token.column,
            len: token.length,
        })
    }

    fn unexpected(&self, expected: &str) -> Problem {
        let found = match self.peek() {
            What::Word(word) => format!("`{word}`"),
            What::Quoted(name) => format!("{name:?}"),
            What::Gap => "`...`".into(),
            What::Sign(sign) => format!("`{sign}`"),
            What::End => "the end".into(),
        };
        Problem::error(format!("{found} is not understood here")).at(self.place()).expecting(expected)
    }
}

/// What a name may be the name of.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Kind {
    Part,
    Medium,
    Source,
    Detector,
}

impl Kind {
    fn label(self) -> &'static str {
        ["part", "medium", "source", "detector"][self as usize]
    }

    fn of(self, names: &Names) -> &[String] {
        [&names.parts, &names.media, &names.sources, &names.detectors][self as usize]
    }
}

/// At most eight names of a list.
fn some(names: Vec<&str>) -> String {
    let shown: Vec<String> = names.iter().take(8).map(|name| format!("{name:?}")).collect();
    let more = if names.len() > 8 { format!(" and {} more", names.len() - 8) } else { String::new() };
    format!("one of {}{more}", shown.join(", "))
}

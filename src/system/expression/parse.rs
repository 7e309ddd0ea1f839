//! From text to value by recursive descent.

use super::{Quantity, Value};
use crate::error::{Problem, did_you_mean};
use crate::system::units::{Powers, is_unit, measured, split_number};
use std::f64::consts::PI;
use std::ops::Range;

/// Names with arguments.
const FUNCTIONS: [&str; 10] = ["sqrt", "sin", "cos", "tan", "asin", "acos", "atan", "abs", "min", "max"];

/// Deeper parentheses are refused.
const DEEPEST: usize = 50;

const ANGLE: Powers = [0, 1, 0, 0, 0];
const NUMBER: Powers = [0; 5];

/// Something wrong with an expression.
#[derive(Clone, Debug)]
pub struct Fault {
    /// Bytes of the text.
    pub range: Range<usize>,
    /// What; `None` if a parameter that it names is wrong, which is told there.
    pub problem: Option<Problem>,
}

/// The value of an expression; `lookup` gives that of a parameter, or what is wrong with it (nothing, if that is told already).
///
/// # Errors
/// The first thing that is wrong, with its place.
pub fn evaluate(text: &str, lookup: &mut Lookup) -> Result<Value, Fault> {
    let mut parser = Parser { text, at: 0, depth: 0, lookup };
    let value = parser.whole()?;
    parser.skip_space();
    if parser.at < text.len() {
        let unit = is_unit(&parser.word()) && !text[..parser.at].trim_end().ends_with(|c: char| c.is_ascii_digit());
        let problem = Problem::error(format!("found `{}` after the end of the expression", parser.rest().trim_end()));
        let hint = "a unit stands right after a number, such as `2 mm`; elsewhere multiply by `1 mm`";
        return Err(parser.fault(parser.at..text.len(), problem.hinting(unit.then(|| hint.to_owned()))));
    }
    Ok(value)
}

/// The value of a parameter by its name.
pub type Lookup<'a> = dyn FnMut(&str) -> Result<Quantity, Option<Problem>> + 'a;

/// True if a parameter may be called so: letters, digits, `_` and `.`, a letter first, neither a unit nor a function.
pub fn is_name(text: &str) -> bool {
    text.starts_with(char::is_alphabetic)
        && text.chars().all(is_part)
        && !FUNCTIONS.contains(&text)
        && text != "pi"
        && !is_unit(text)
}

fn is_part(c: char) -> bool {
    c.is_alphanumeric() || matches!(c, '_' | '.')
}

struct Parser<'a, 'b> {
    text: &'a str,
    at: usize,
    depth: usize,
    lookup: &'b mut Lookup<'b>,
}

type Read = Result<Quantity, Fault>;

impl<'a> Parser<'a, '_> {
    fn rest(&self) -> &'a str {
        &self.text[self.at..]
    }

    fn fault(&self, range: Range<usize>, problem: Problem) -> Fault {
        Fault { range, problem: Some(problem) }
    }

    fn skip_space(&mut self) {
        self.at = self.text.len() - self.rest().trim_start().len();
    }

    /// Moves past a character if it comes next.
    fn take(&mut self, c: char) -> bool {
        self.skip_space();
        let there = self.rest().starts_with(c);
        self.at += if there { c.len_utf8() } else { 0 };
        there
    }

    fn expect(&mut self, c: char) -> Result<(), Fault> {
        if self.take(c) { Ok(()) } else { Err(self.unexpected(&format!("`{c}`"))) }
    }

    fn unexpected(&self, expected: &str) -> Fault {
        let next = self.rest().chars().next();
        let found = next.map_or("the expression ends".to_owned(), |c| format!("found `{c}`"));
        let end = self.at + next.map_or(0, char::len_utf8);
        self.fault(self.at..end, Problem::error(format!("{found} here")).expecting(expected))
    }

    /// The name that comes next, without moving.
    fn word(&self) -> String {
        self.rest().chars().take_while(|c| is_part(*c)).collect()
    }

    /// A sum, or three in parentheses.
    fn whole(&mut self) -> Result<Value, Fault> {
        let start = self.at;
        if self.take('(') {
            let first = self.sum()?;
            if self.take(',') {
                let second = self.sum()?;
                self.expect(',')?;
                let third = self.sum()?;
                self.expect(')')?;
                return self.triple([first, second, third]);
            }
            self.at = start;
        }
        self.sum().map(Value::Scalar)
    }

    /// Three of one kind; a bare 0 is of any.
    fn triple(&self, three: [Quantity; 3]) -> Result<Value, Fault> {
        let mut kinds = three.iter().filter(|one| one.value != 0.0 || one.powers != NUMBER);
        let first = kinds.next();
        match first.and_then(|first| kinds.find(|other| other.powers != first.powers).map(|other| (first, other))) {
            Some((first, other)) => Err(self.mixed(0..self.at, first, other)),
            None => Ok(Value::Triple(three)),
        }
    }

    fn mixed(&self, range: Range<usize>, one: &Quantity, other: &Quantity) -> Fault {
        let message = format!("`{}` is {} and `{}` {}", one.text(), one.kind(), other.text(), other.kind());
        self.fault(range, Problem::error(message).expecting("quantities of one kind"))
    }

    fn sum(&mut self) -> Read {
        self.skip_space();
        let start = self.at;
        let mut left = self.product()?;
        loop {
            let sign = if self.take('+') {
                1.0
            } else if self.take('-') {
                -1.0
            } else {
                return Ok(left);
            };
            let right = self.product()?;
            if left.powers != right.powers {
                return Err(self.mixed(start..self.at, &left, &right));
            }
            left = self.finite(start, left.value + sign * right.value, left.powers)?;
        }
    }

    fn product(&mut self) -> Read {
        self.skip_space();
        let start = self.at;
        let mut left = self.factor()?;
        loop {
            let times = if self.take('*') {
                1
            } else if self.take('/') {
                -1
            } else {
                return Ok(left);
            };
            let right = self.factor()?;
            let mut powers = left.powers;
            for (power, other) in powers.iter_mut().zip(right.powers) {
                let sum = power.checked_add(times * other).filter(|power| power.abs() <= 64);
                *power =
                    sum.ok_or_else(|| self.fault(start..self.at, Problem::error("this power of a unit is too high")))?;
            }
            let value = if times > 0 { left.value * right.value } else { left.value / right.value };
            left = self.finite(start, value, powers)?;
        }
    }

    fn finite(&self, start: usize, value: f64, powers: Powers) -> Read {
        if value.is_finite() {
            return Ok(Quantity::computed(value, powers));
        }
        let problem = Problem::error(format!("`{}` is not a finite number", self.text[start..self.at].trim()));
        Err(self.fault(start..self.at, problem))
    }

    fn factor(&mut self) -> Read {
        self.depth += 1;
        if self.depth > DEEPEST {
            let problem = Problem::error(format!("this is nested more than {DEEPEST} deep"));
            return Err(self.fault(self.at..self.at, problem));
        }
        let factor = if self.take('-') {
            self.factor().map(|of| Quantity {
                value: -of.value,
                written: of.written.filter(|text| !text.starts_with(['-', '+'])).map(|text| format!("-{text}")),
                ..of
            })
        } else if self.take('(') {
            self.sum().and_then(|sum| self.expect(')').map(|()| sum))
        } else {
            self.atom()
        };
        self.depth -= 1;
        factor
    }

    /// A number with or without unit, a name, a function.
    fn atom(&mut self) -> Read {
        let unsigned = !self.rest().starts_with(['+', '-']);
        if let Some((number, _)) = split_number(self.rest()).filter(|_| unsigned) {
            return self.number(number);
        }
        let (start, name) = (self.at, self.word());
        if name.is_empty() || !name.starts_with(char::is_alphabetic) {
            return Err(self.unexpected("a number, a parameter or a function"));
        }
        self.at += name.len();
        if self.take('(') {
            return self.function(start, &name);
        }
        self.at = start + name.len();
        if name == "pi" {
            return Ok(Quantity::plain(PI));
        }
        (self.lookup)(&name).map_err(|problem| Fault { range: start..self.at, problem })
    }

    /// The number and the longest unit after it.
    fn number(&mut self, number: &str) -> Read {
        let start = self.at;
        self.at += number.len();
        let end = self.at;
        self.skip_space();
        for length in unit_ends(self.rest()) {
            if let Some(found) = measured(number, &self.rest()[..length]) {
                self.at += length;
                let written = Some(self.text[start..self.at].to_owned());
                let quantity = found.map(|(value, powers)| Quantity { value, powers, written });
                return quantity.map_err(|what| self.fault(start..self.at, Problem::error(what)));
            }
        }
        let word = self.word();
        if word.starts_with(char::is_alphabetic) {
            let problem = Problem::error(format!("no such unit: `{word}`")).expecting("a unit, or `*` before a name");
            return Err(self.fault(self.at..self.at + word.len(), problem));
        }
        self.at = end;
        let value = number.parse::<f64>().unwrap_or(f64::NAN);
        self.finite(start, value, NUMBER).map(|plain| Quantity { written: Some(number.to_owned()), ..plain })
    }

    fn function(&mut self, start: usize, name: &str) -> Read {
        let mut arguments = vec![self.sum()?];
        while self.take(',') {
            arguments.push(self.sum()?);
        }
        self.expect(')')?;
        let here = start..self.at;
        if !FUNCTIONS.contains(&name) {
            let problem = Problem::error(format!("there is no function `{name}`"));
            let close = did_you_mean(name, FUNCTIONS).map(|close| format!("did you mean `{close}`?"));
            return Err(self.fault(here, problem.expecting(format!("one of {}", FUNCTIONS.join(", "))).hinting(close)));
        }
        let [first, others @ ..] = &arguments[..] else { return Err(self.unexpected("an argument")) };
        let several = matches!(name, "min" | "max");
        if several == others.is_empty() {
            let problem = Problem::error(format!("`{name}` is given {} arguments", arguments.len()));
            return Err(self.fault(here, problem.expecting(if several { "two or more" } else { "one" })));
        }
        if let Some(other) = others.iter().find(|other| other.powers != first.powers) {
            return Err(self.mixed(here, first, other));
        }
        let [wants, gives] = match name {
            "sin" | "cos" | "tan" => [ANGLE, NUMBER],
            "asin" | "acos" | "atan" => [NUMBER, ANGLE],
            "sqrt" => [first.powers, first.powers.map(|power| power / 2)],
            _ => [first.powers; 2],
        };
        if wants != first.powers || (name == "sqrt" && first.powers.iter().any(|power| power % 2 != 0)) {
            let expected = match name {
                "sqrt" => "a square, such as a length times a length",
                "sin" | "cos" | "tan" => "an angle, such as `30 deg`",
                _ => "a number without unit",
            };
            let problem = Problem::error(format!("`{name}` of `{}`, which is {}", first.text(), first.kind()));
            return Err(self.fault(here, problem.expecting(expected)));
        }
        self.finite(start, applied(name, &arguments), gives)
    }
}

/// A function of values in SI.
fn applied(name: &str, arguments: &[Quantity]) -> f64 {
    let x = arguments[0].value;
    let all = arguments.iter().map(|argument| argument.value);
    match name {
        "sqrt" => x.sqrt(),
        "sin" => x.sin(),
        "cos" => x.cos(),
        "tan" => x.tan(),
        "asin" => x.asin(),
        "acos" => x.acos(),
        "atan" => x.atan(),
        "abs" => x.abs(),
        "min" => all.fold(f64::INFINITY, f64::min),
        _ => all.fold(f64::NEG_INFINITY, f64::max),
    }
}

/// Where a unit at the start of the text may end, the longest first: `/mm`, `W/m2`, `mm^-3`, `deg`.
fn unit_ends(text: &str) -> Vec<usize> {
    let word = |from: usize| {
        let stop = text[from..].find(|c: char| !(c.is_alphanumeric() || matches!(c, '°' | 'µ' | '²')));
        from + stop.unwrap_or(text.len() - from)
    };
    let power = |from: usize| {
        let sign = usize::from(text[from..].starts_with('-'));
        let digits = text[from + sign..].bytes().take_while(u8::is_ascii_digit).count();
        if digits > 0 { from + sign + digits } else { from }
    };
    let raised = |end: usize| if text[end..].starts_with('^') { power(end + 1) } else { end };
    let slash = usize::from(text.starts_with('/'));
    let first = word(slash);
    let mut ends = vec![first, raised(first)];
    if slash == 0 && text[first..].starts_with('/') {
        ends.push(word(first + 1));
        ends.push(raised(word(first + 1)));
    }
    ends.retain(|end| *end > slash);
    ends.sort_unstable_by(|a, b| b.cmp(a));
    ends.dedup();
    ends
}

//! The words and signs of an expression.

#![allow(clippy::result_large_err, reason = "one problem ends the reading")]

use crate::error::{Problem, Span};

/// One word or sign, and its place: column from 1, length in characters.
#[derive(Clone, Debug, PartialEq)]
pub struct Token {
    pub what: What,
    pub column: u32,
    pub length: u32,
}

#[derive(Clone, Debug, PartialEq)]
pub enum What {
    /// Letters, digits and `_ . - / * ?`.
    Word(String),
    /// A name in double quotes.
    Quoted(String),
    /// `...`
    Gap,
    /// `( ) , : > < >= <= == !=`
    Sign(&'static str),
    End,
}

/// Longer ones first.
const SIGNS: [&str; 10] = ["==", "!=", "<=", ">=", ">", "<", "(", ")", ",", ":"];

/// The tokens of a text, the last of which is its end.
pub fn tokens(text: &str) -> Result<Vec<Token>, Problem> {
    let mut tokens = Vec::new();
    let (mut rest, mut column) = (text, 1);
    loop {
        let trimmed = rest.trim_start();
        column += count(&rest[..rest.len() - trimmed.len()]);
        rest = trimmed;
        let (what, length) = first(rest).map_err(|problem| problem.at(Span { line: 1, column, len: 1 }))?;
        let characters = count(&rest[..length]);
        let ends = what == What::End;
        tokens.push(Token { what, column, length: characters });
        if ends {
            return Ok(tokens);
        }
        (rest, column) = (&rest[length..], column + characters);
    }
}

/// The first token of a text that does not begin with space, and its length in bytes.
fn first(rest: &str) -> Result<(What, usize), Problem> {
    let Some(letter) = rest.chars().next() else { return Ok((What::End, 0)) };
    if let Some(inside) = rest.strip_prefix('"') {
        let end = inside.find('"');
        let end = end.ok_or_else(|| Problem::error("a name in quotes is not closed").expecting("`\"`"))?;
        return Ok((What::Quoted(inside[..end].into()), end + 2));
    }
    if let Some(after) = rest.strip_prefix("...")
        && !after.starts_with(is_word)
    {
        return Ok((What::Gap, 3));
    }
    if let Some(sign) = SIGNS.into_iter().find(|sign| rest.starts_with(sign)) {
        return Ok((What::Sign(sign), sign.len()));
    }
    match rest.find(|c| !is_word(c)).unwrap_or(rest.len()) {
        0 => {
            let problem = Problem::error(format!("`{letter}` has no meaning here"));
            Err(problem
                .hinting("names with other signs than letters, digits and _ . - / stand in double quotes".to_owned()))
        }
        length => Ok((What::Word(rest[..length].into()), length)),
    }
}

fn is_word(c: char) -> bool {
    c.is_alphanumeric() || "_.-/*?".contains(c)
}

fn count(text: &str) -> u32 {
    u32::try_from(text.chars().count()).unwrap_or(u32::MAX)
}

//! Lines to commands.

use super::super::row::{Row, Word, words};

/// The command of a row: three letters say it, more may be written.
pub fn key(row: &Row) -> String {
    let key = row.key();
    if key.len() > 3 && key.chars().all(|c| c.is_ascii_alphabetic()) { key[..3].to_owned() } else { key }
}

/// The commands of a file, none empty.
pub fn rows(text: &str) -> Vec<Row> {
    let mut rows = Vec::new();
    let mut open: Vec<Word> = Vec::new();
    for (line, mut rest) in (1..).zip(text.lines()) {
        let mut column = 1;
        loop {
            let (mut found, stop) = words(rest, line, column, &['\'', '"'], &[';', '!', '&']);
            open.append(&mut found);
            if stop.is_none_or(|(mark, _)| mark != '&') && !open.is_empty() {
                rows.push(Row { words: std::mem::take(&mut open) });
            }
            let Some((';', at)) = stop else { break };
            column += rest[..=at].chars().count() as u32;
            rest = &rest[at + 1..];
        }
    }
    if !open.is_empty() {
        rows.push(Row { words: open });
    }
    rows
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn commands_end_with_lines_and_semicolons() {
        let rows = rows("epd 1; wl &\n 555 ! green; no\n\ntit 'a; b!'\n");
        let read: Vec<Vec<&str>> = rows.iter().map(|r| r.words.iter().map(|w| w.text.as_str()).collect()).collect();
        assert_eq!(read, [vec!["epd", "1"], vec!["wl", "555"], vec!["tit", "a; b!"]]);
        let span = rows[1].words[1].span;
        assert_eq!((span.line, span.column), (2, 2));
        assert_eq!(rows[1].words[0].span.column, 8);
    }
}

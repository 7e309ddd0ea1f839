//! Problems of an input as text: the first one on one line, then each with the line of the file it is in.

use crate::error::{Problem, Severity, Span, printable, summary};
use annotate_snippets::renderer::DecorStyle;
use annotate_snippets::{AnnotationKind, Group, Level, Origin, Renderer, Snippet};
use std::collections::BTreeMap;
use std::ops::Range;
use std::path::{Path, PathBuf};

/// Problems shown in full; whoever made more reads these first.
const MOST: usize = 100;

/// Where the text of an input comes from; `None` if there is none to show.
pub type Sources<'a> = &'a dyn Fn(&Path) -> Option<String>;

/// The problems as text without colours, ending in a line break; empty if there are none. The first line says it all in
/// one line; errors come before warnings.
pub fn render(problems: &[Problem], sources: Sources) -> String {
    if problems.is_empty() {
        return String::new();
    }
    let mut sorted: Vec<&Problem> = problems.iter().collect();
    sorted.sort_by_key(|problem| problem.severity);
    let mut texts: BTreeMap<PathBuf, Option<String>> = BTreeMap::new();
    let mut out = format!("{}\n", summary(problems));
    for problem in sorted.iter().take(MOST) {
        let text = problem
            .file
            .as_ref()
            .and_then(|file| texts.entry(file.clone()).or_insert_with(|| sources(file).map(without_mark)).as_deref());
        out.push_str(&format!("\n{}\n", snippet(problem, text)));
    }
    if sorted.len() > MOST {
        out.push_str(&format!("\n{} more are not shown\n", sorted.len() - MOST));
    }
    out
}

/// One problem with the line it is in.
fn snippet(problem: &Problem, text: Option<&str>) -> String {
    let level = if problem.severity == Severity::Error { Level::ERROR } else { Level::WARNING };
    let file = problem.file.as_ref().map(|file| printable(&file.display().to_string()));
    let expected = problem.expected.as_ref().map(|expected| format!("expected {}", printable(expected)));
    let title = if problem.path.is_empty() {
        printable(&problem.message)
    } else {
        format!("{}: {}", printable(&problem.path), printable(&problem.message))
    };
    let mut group = Group::with_title(level.primary_title(title));
    let line = problem.span.and_then(|span| Some((span, line(text?, span)?)));
    if let Some((span, line)) = line {
        let mark = AnnotationKind::Primary.span(range(line, span)).label(expected);
        group =
            group.element(Snippet::source(line).line_start(span.line as usize).path(file).fold(false).annotation(mark));
    } else {
        if let Some(file) = file {
            let place =
                |span: Span| Origin::path(file.clone()).line(span.line as usize).char_column(span.column as usize);
            group = group.element(problem.span.map_or_else(|| Origin::path(file.clone()), place));
        }
        if let Some(expected) = expected {
            group = group.element(Level::NOTE.message(expected));
        }
    }
    if let Some(hint) = &problem.hint {
        group = group.element(Level::HELP.message(printable(hint)));
    }
    Renderer::plain().decor_style(DecorStyle::Ascii).render(&[group])
}

/// The line of the text that a span is in.
fn line(text: &str, span: Span) -> Option<&str> {
    text.lines().nth((span.line as usize).checked_sub(1)?)
}

/// The bytes of a line that a span covers; at least one character where there is one.
fn range(line: &str, span: Span) -> Range<usize> {
    let byte = |character: usize| line.char_indices().nth(character).map_or(line.len(), |(at, _)| at);
    let first = (span.column as usize).saturating_sub(1);
    byte(first)..byte(first + (span.len as usize).max(1))
}

/// A text without its byte-order mark, which is not part of the first column.
fn without_mark(text: String) -> String {
    text.strip_prefix('\u{feff}').map(str::to_owned).unwrap_or(text)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_line_says_it_all_and_the_place_is_marked() {
        let text = "System(\n    surfaces: [(on: Tag(\"µ\"), scatter: \"blak\")],\n)\n";
        let problem = Problem::error("no scatter model \"blak\"")
            .in_file("a.ron")
            .at(Span { line: 2, column: 40, len: 6 })
            .on("surfaces[0].scatter")
            .hinting("did you mean \"black\"?".to_owned());
        let shown = render(&[problem], &|_| Some(text.to_owned()));
        let wanted = r#"a.ron:2:40: surfaces[0].scatter: no scatter model "blak"; did you mean "black"?

error: surfaces[0].scatter: no scatter model "blak"
 --> a.ron:2:40
  |
2 |     surfaces: [(on: Tag("µ"), scatter: "blak")],
  |                                        ^^^^^^
  |
  = help: did you mean "black"?
"#;
        assert_eq!(shown, wanted);
    }

    #[test]
    fn a_place_outside_the_text_is_shown_without_it() {
        let far = Problem::warning("w").in_file("a.ron").at(Span { line: 9, column: 900, len: 3 }).expecting("x");
        let shown = render(std::slice::from_ref(&far), &|_| Some("short".to_owned()));
        assert!(shown.contains("--> a.ron:9:900") && shown.contains("note: expected x"), "{shown}");
        assert!(render(&[far], &|_| None).contains("a.ron:9:900"));
        let end = Problem::error("e").in_file("a.ron").at(Span { line: 1, column: 90, len: 3 });
        assert!(render(&[end], &|_| Some("short".to_owned())).contains("1 | short"));
    }
}

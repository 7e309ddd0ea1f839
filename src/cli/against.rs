//! `straylight check --against`: what changed since an older state of the geometry.

use super::table::{Table, digits, millimetres};
use std::path::Path;
use straylight::error::Error;
use straylight::system::compile::against::{Comparison, Difference, Fate, compare};
use straylight::system::document::Document;

/// Rows of a table that are printed; of more, the first.
const MOST: usize = 200;

/// Everything that differs, and the lines that keep the assignments.
pub fn against(document: &Document, older: &Path) -> Result<String, Error> {
    let found = compare(document, older)?;
    Ok([
        format!("Against {}\n", older.display()),
        differences("Nodes that differ", &found.nodes),
        differences("Faces that differ", &found.faces),
        selected(document, &found),
        aliases(&found),
    ]
    .concat())
}

fn differences(title: &str, all: &[Difference]) -> String {
    if all.is_empty() {
        return format!("{title}\n  none\n\n");
    }
    let mut table =
        Table::new(["", "node", "material", "before", "area mm2", "centroid mm", "moved mm", "selected by"], &[4]);
    for one in all.iter().take(MOST) {
        let (fate, by) = match one.fate {
            Fate::Same => ("same", None),
            Fate::Renamed => ("renamed", None),
            Fate::Moved(by) => ("moved", Some(by)),
            Fate::RenamedAndMoved(by) => ("renamed, moved", Some(by)),
            Fate::Changed => ("changed", None),
            Fate::Lost => ("lost", None),
            Fate::New => ("new", None),
        };
        let entries: Vec<String> = one.entries.iter().map(|entry| format!("surfaces[{entry}]")).collect();
        let dash = |text: String| if text.is_empty() { "-".to_owned() } else { text };
        table.row([
            fate.into(),
            one.node.clone(),
            dash(one.face.clone().unwrap_or_default()),
            dash(one.was.clone().unwrap_or_default()),
            digits(1e6 * one.shape.area, 5),
            millimetres(one.shape.centroid),
            by.map_or("-".into(), millimetres),
            if entries.is_empty() { "no entry".into() } else { entries.join(", ") },
        ]);
    }
    let more = all.len().saturating_sub(MOST);
    let more = if more > 0 { format!("  and {more} more\n") } else { String::new() };
    format!("{title}\n{}{more}\n", table.text())
}

/// What each entry of `surfaces` selected then, and selects now.
fn selected(document: &Document, found: &Comparison) -> String {
    let mut table =
        Table::new(["entry", "line", "triangles then", "now", "area mm2 then", "now", ""], &[1, 2, 3, 4, 5]);
    for (entry, one) in found.selected.iter().enumerate().take(MOST) {
        let path = format!("surfaces[{entry}]");
        let line = document.span(&path).map_or(String::new(), |span| span.line.to_string());
        let [then, now] = one.area;
        let note = match one.triangles {
            [0, 0] => "selects nothing",
            [_, 0] => "selects nothing any more",
            _ if (then - now).abs() > 0.01 * then.max(now) => "changed by more than 1 %",
            _ => "",
        };
        let [before, after] = one.triangles.map(|count| count.to_string());
        table.row([path, line, before, after, digits(1e6 * then, 5), digits(1e6 * now, 5), note.into()]);
    }
    format!("What the entries of `surfaces` select\n{}\n", table.text())
}

fn aliases(found: &Comparison) -> String {
    if found.aliases.is_empty() {
        return String::new();
    }
    let lines: Vec<String> = found.aliases.iter().map(|(new, old)| format!("        {new:?}: {old:?},\n")).collect();
    format!("To keep the assignments, say in the system:\n\n    aliases: {{\n{}    }},\n\n", lines.concat())
}

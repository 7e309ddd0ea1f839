//! Filters of the document, over the names of the scene.

use super::Shop;
use crate::error::Problem;
use crate::filter::Filter;
use crate::scene::Scene;

/// Every filter that can be read.
pub fn filters(shop: &mut Shop, scene: &Scene) -> Vec<Filter> {
    let (document, names) = (shop.document, scene.names());
    let mut all = Vec::new();
    // Without parts, something else is wrong, and no name could be right.
    if scene.parts.is_empty() {
        return all;
    }
    for (label, text) in document.system.filters.iter() {
        match Filter::parse(label, text, &names) {
            Ok(filter) => all.push(filter),
            Err(problems) => {
                let path = format!("filters[{label:?}]");
                problems.into_iter().for_each(|problem| shop.fault(&path, inside(problem)));
            }
        }
    }
    all
}

/// A problem with its place in the expression in words: the place in the file is that of the expression.
fn inside(problem: Problem) -> Problem {
    let column = problem.span.map(|span| format!("column {} of the filter: ", span.column)).unwrap_or_default();
    Problem { message: column + &problem.message, span: None, ..problem }
}

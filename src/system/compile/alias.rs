//! Nodes and materials that the geometry calls otherwise than the system does: the names of the system hold.

use super::assembly::Assembly;
use super::{Shop, listed};
use crate::error::{Problem, did_you_mean};

/// Gives nodes and materials the names by which the system knows them.
pub fn rename(shop: &mut Shop, assembly: &mut Assembly) {
    for (new, known) in shop.document.system.aliases.iter() {
        let path = format!("aliases[{new:?}]");
        let names = names(assembly);
        if !names.iter().any(|name| name == new) {
            let problem = Problem::error(format!("no node or material is called `{new}`"));
            let close =
                did_you_mean(new, names.iter().map(String::as_str)).map(|name| format!("did you mean `{name}`?"));
            let problem =
                if close.is_some() { problem } else { problem.expecting(format!("one of {}", listed(&names))) };
            shop.fault(&path, problem.hinting(close));
        } else if names.contains(known) {
            let problem = Problem::error(format!("the geometry has a `{known}` of its own"));
            shop.fault(&path, problem.expecting("a name that the geometry has not"));
        } else {
            apply(assembly, new, known);
        }
    }
}

/// All names of nodes and materials, sorted.
fn names(assembly: &Assembly) -> Vec<String> {
    let paths = assembly.landmarks.iter().flat_map(|mark| mark.path.split('/'));
    let own = assembly.nodes.iter().flat_map(|node| node.tags.iter().chain([&node.name]).map(String::as_str));
    let mut names: Vec<String> = paths.chain(own).filter(|name| !name.is_empty()).map(str::to_owned).collect();
    names.sort();
    names.dedup();
    names
}

fn apply(assembly: &mut Assembly, new: &str, known: &str) {
    let swap = |name: &mut String| {
        if name == new {
            known.clone_into(name);
        }
    };
    let swap_path = |path: &mut String| {
        let names: Vec<&str> = path.split('/').map(|name| if name == new { known } else { name }).collect();
        *path = names.join("/");
    };
    for node in &mut assembly.nodes {
        swap(&mut node.name);
        swap_path(&mut node.path);
        node.tags.iter_mut().for_each(swap);
    }
    assembly.landmarks.iter_mut().for_each(|mark| swap_path(&mut mark.path));
}

//! Who tests what: every case of the verification set has a test that bears its name, or waits for its model.

use crate::lab::all_cases;
use std::collections::BTreeSet;
use std::path::Path;

/// What waits, and for what.
const WAITING: &[(&str, &[&str])] = &[];

fn waits(id: &str) -> bool {
    let matches = |pattern: &&str| pattern.strip_suffix('*').map_or(id == *pattern, |prefix| id.starts_with(prefix));
    WAITING.iter().flat_map(|(_, ids)| ids.iter()).any(matches)
}

/// Words of all tests without their comments.
fn words(folder: &Path, into: &mut BTreeSet<String>) {
    for entry in std::fs::read_dir(folder).expect("a folder of sources") {
        let path = entry.expect("an entry").path();
        if path.is_dir() {
            words(&path, into);
        } else if path.extension().is_some_and(|e| e == "rs") && !path.ends_with("exactness/cases.rs") {
            let text = std::fs::read_to_string(&path).expect("a source");
            let code = text.lines().filter(|line| !line.trim_start().starts_with("//"));
            let split = |line: &str| {
                let parts = line.split(|c: char| !c.is_ascii_alphanumeric() && c != '_' && c != '-');
                parts.map(str::to_owned).collect::<Vec<_>>()
            };
            into.extend(code.flat_map(split));
        }
    }
}

#[test]
fn every_case_has_a_test() {
    let mut found = BTreeSet::new();
    words(&Path::new(env!("CARGO_MANIFEST_DIR")).join("tests"), &mut found);
    let ids: Vec<String> = all_cases().iter().map(|case| case["id"].as_str().expect("id").to_owned()).collect();
    let tested = |id: &String| {
        // By name in code ("RAD-03x"), or as the name of a test: rad_03x, rad_03x_cos_to_the_fourth.
        let name = id.replace('-', "_").to_lowercase();
        let longer = format!("{name}_");
        found.contains(id) || found.contains(&name) || found.iter().any(|word| word.starts_with(&longer))
    };
    let missing: Vec<&String> = ids.iter().filter(|id| !waits(id) && !tested(id)).collect();
    let waiting = ids.iter().filter(|id| waits(id)).count();
    println!("{} cases, {waiting} waiting", ids.len());
    assert!(missing.is_empty(), "no test bears the name of {missing:?}");
    for (_, patterns) in WAITING {
        for pattern in *patterns {
            let known = |id: &String| id.starts_with(pattern.trim_end_matches('*'));
            assert!(ids.iter().any(known), "{pattern} is no case of the set");
        }
    }
}

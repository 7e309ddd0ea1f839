//! File names for detectors: a name is the user's, a file name the file system's.

use std::collections::BTreeSet;

/// Longest stem, bytes: leaves room for endings below the 255 bytes of common file systems.
const LONGEST: usize = 120;

/// One file stem per name, in order. Letters, digits, `-`, `_` and inner dots stay; anything else becomes `_`. No two stems, nor the
/// files made of them, are equal even where the file system ignores case.
pub fn stems<'a>(names: impl IntoIterator<Item = &'a str>) -> Vec<String> {
    let mut taken = BTreeSet::from(["paths".to_owned(), "report".to_owned(), "summary".to_owned()]);
    names.into_iter().map(|name| free(&clean(name), &mut taken)).collect()
}

fn free(stem: &str, taken: &mut BTreeSet<String>) -> String {
    let mut candidate = stem.to_owned();
    let mut count = 2u32;
    loop {
        let key = candidate.to_lowercase();
        let error = format!("{key}_error"); // NAME_error.npy stands beside NAME.npy
        if !taken.contains(&key) && !taken.contains(&error) {
            taken.extend([key, error]);
            return candidate;
        }
        candidate = format!("{stem}-{count}");
        count += 1;
    }
}

fn clean(name: &str) -> String {
    let keep = |c: char| if c.is_alphanumeric() || "-_.".contains(c) { c } else { '_' };
    let mut stem: String = name.trim().chars().map(keep).collect();
    while stem.len() > LONGEST {
        stem.pop();
    }
    let first = if stem.starts_with(['.', '-']) || stem.is_empty() || reserved(&stem) { "_" } else { "" };
    format!("{first}{}", stem.trim_end_matches('.'))
}

/// Device names of Windows, with or without an ending.
fn reserved(stem: &str) -> bool {
    let device = stem.split('.').next().unwrap_or_default().to_ascii_lowercase();
    let numbered = device.len() == 4
        && (device.starts_with("com") || device.starts_with("lpt"))
        && device.ends_with(|c: char| c.is_ascii_digit());
    numbered || ["con", "prn", "aux", "nul"].contains(&device.as_str())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_cannot_leave_the_folder() {
        assert_eq!(
            stems(["../../etc/passwd", "a/b", "", ".", "NUL"]),
            ["_.._.._etc_passwd", "a_b", "_", "_-2", "_NUL"]
        );
    }

    #[test]
    fn no_two_detectors_share_a_file() {
        assert_eq!(stems(["fpa", "FPA", "fpa_error", "fpa/"]), ["fpa", "FPA-2", "fpa_error-2", "fpa_"]);
        assert_eq!(stems(["report"]), ["report-2"]);
    }

    #[test]
    fn a_long_name_is_cut_between_characters() {
        let stem = &stems([&*"ä".repeat(300)])[0];
        assert!(stem.len() <= LONGEST && stem.chars().all(|c| c == 'ä'));
    }
}

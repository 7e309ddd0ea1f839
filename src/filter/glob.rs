//! Names by pattern.

/// Whether `pattern` with `*` and `?` covers the whole of `text`. At worst the product of their lengths.
pub fn matches(pattern: &str, text: &str) -> bool {
    let (mut rest, mut pattern) = (text.chars(), pattern.chars());
    // After the last star: the pattern behind it, and the text it has to match there or further on.
    let mut star = None;
    loop {
        let before = rest.clone();
        match (pattern.next(), rest.next()) {
            (None, None) => return true,
            (Some('*'), _) => {
                rest = before;
                star = Some((pattern.clone(), rest.clone()));
            }
            (Some(want), Some(have)) if want == '?' || want == have => {}
            _ => {
                let Some((behind, from)) = &mut star else { return false };
                if from.next().is_none() {
                    return false;
                }
                (pattern, rest) = (behind.clone(), from.clone());
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn patterns_match_stars_and_question_marks_and_nothing_else() {
        for (pattern, text) in [
            ("*", ""),
            ("a*", "a"),
            ("*b", "aab"),
            ("a?c", "abc"),
            ("a*b*c", "a__b_b_c"),
            ("Lens_*", "Lens_1"),
            ("é?", "éü"),
            ("**", "x"),
        ] {
            assert!(matches(pattern, text), "{pattern} covers {text}");
        }
        for (pattern, text) in
            [("", "a"), ("a?", "a"), ("lens_*", "Lens_1"), ("*b", "ba"), ("a*b", "acbd"), ("[a]", "a")]
        {
            assert!(!matches(pattern, text), "{pattern} does not cover {text}");
        }
        let text = "a".repeat(5000);
        assert!(!matches(&format!("{}b", "a*".repeat(50)), &text), "no exponential search");
    }
}

//! A filter is what it says, for every path.

use super::*;
use crate::packet::LONGEST_PATH;

/// Part 2 is a mirror, part 4 a barrel.
fn names() -> Names {
    let list = |names: &[&str]| names.iter().map(|&name| name.to_owned()).collect();
    Names {
        sources: list(&["sun", "lamp"]),
        parts: list(&["L1.front", "L1.rear", "M1", "front spacer", "Barrel_1"]),
        media: list(&["air", "haze"]),
        detectors: list(&["fpa", "screen"]),
        image: Class::Signal,
    }
}

fn path(source: u16, steps: &[(u32, Event)]) -> Ancestry {
    let mut path = Ancestry::born(source, 0);
    steps.iter().for_each(|&(number, event)| path.step(number, event, number == 2));
    path
}

/// What a filter says to a path to the detector "fpa".
fn says(text: &str, path: &Ancestry) -> Option<bool> {
    let filter = Filter::parse("f", text, &names());
    filter.unwrap_or_else(|problems| panic!("{text}: {}", problems[0])).accepts(0, path)
}

use Event::{Bulk, Reflect, Scatter, Transmit};

/// sun > L1.front:T > L1.rear:R > L1.front:R > L1.rear:T > fpa
const GHOST: [(u32, Event); 4] = [(0, Transmit), (1, Reflect), (0, Reflect), (1, Transmit)];
/// sun > L1.front:T > L1.rear:T > M1:R > Barrel_1:S > fpa
const BARREL: [(u32, Event); 4] = [(0, Transmit), (1, Transmit), (2, Reflect), (4, Scatter)];

#[test]
fn words_and_counts_are_those_of_the_path() {
    let (signal, ghost, barrel) = (path(0, &[(0, Transmit), (2, Reflect)]), path(0, &GHOST), path(0, &BARREL));
    for (text, wanted) in [
        ("signal", [true, false, false]),
        ("ghost", [false, true, false]),
        ("scatter", [false, false, true]),
        ("stray", [false, true, true]),
        ("direct", [false, false, false]),
        ("scatters == 1", [false, false, true]),
        ("ghosts >= 1", [false, true, false]),
        ("reflections != 1", [false, true, false]),
        ("events < 4 or scatters > 0", [true, false, true]),
        ("not (ghost or signal)", [false, false, true]),
        ("stray and not scatter", [false, true, false]),
        ("ghost and scatter or signal", [true, false, false]),
    ] {
        assert_eq!([&signal, &ghost, &barrel].map(|path| says(text, path)), wanted.map(Some), "{text}");
    }
}

#[test]
fn a_chain_is_the_whole_way_in_order() {
    let barrel = path(0, &BARREL);
    for (text, wanted) in [
        ("sun > L1.front:T > L1.rear:T > M1:R > Barrel*:S > fpa", true),
        ("sun > ... > Barrel*:S > fpa", true),
        ("... > Barrel*:S > ...", true),
        ("sun > L1.*:T > ... > *:SR > fpa", true),
        ("s* > ... > M1 > ... > f?a", true),
        ("sun > ... > ... > fpa", true),
        ("Barrel*:S", true),
        ("sun", true),
        ("lamp", false),
        ("lamp > ...", false),
        ("... > screen", false),
        ("Barrel*:T", false),
        ("\"front spacer\"", false),
        ("sun > L1.front:T > fpa", false),
        ("sun > Barrel*:S > ...", false),
        ("... > Barrel*:S > ... > M1:R > ...", false),
    ] {
        assert_eq!(says(text, &barrel), Some(wanted), "{text}");
    }
    let haze = path(1, &[(1, Bulk), (1, Transmit)]);
    assert_eq!(
        ["haze", "haze:V", "L1.rear:V or M1", "L1.rear:TV"]
            .map(|text| { Filter::parse("f", text, &names()).ok().and_then(|filter| filter.accepts(0, &haze)) }),
        [Some(true), Some(true), None, Some(true)]
    );
}

#[test]
fn a_ghost_is_its_unintended_reflections_in_the_order_of_the_light() {
    let ghost = path(0, &GHOST);
    let mirrored = path(0, &[&[(2, Reflect)], GHOST.as_slice()].concat());
    let scattered = path(0, &[GHOST.as_slice(), &[(4, Scatter)]].concat());
    for (text, wanted) in [
        ("ghost(\"L1.rear\", \"L1.front\")", [true, true, false]),
        ("ghost(L1.*, *)", [true, true, false]),
        ("ghost(L1.front, L1.rear)", [false; 3]),
        ("ghost(L1.rear)", [false; 3]),
        ("ghost(L1.rear, L1.front, M1)", [false; 3]),
    ] {
        assert_eq!([&ghost, &mirrored, &scattered].map(|path| says(text, path)), wanted.map(Some), "{text}");
    }
}

#[test]
fn a_path_too_long_to_be_spelled_is_judged_by_what_is_known_of_it() {
    let steps = [[(0, Transmit), (4, Scatter)]; LONGEST_PATH].concat();
    let long = path(0, &steps);
    for (text, answer) in [
        ("scatters > 3", Some(true)),
        ("sun > ... > Barrel*:S > ...", Some(true)),
        ("sun > ... > Barrel*:S > ... > fpa", Some(true)),
        ("... > screen", Some(false)),
        ("lamp > ...", Some(false)),
        ("sun > L1.rear > ...", Some(false)),
        ("... > M1 > ...", None),
        ("... > Barrel*:S > fpa", None),
        ("M1", None),
        ("not M1", None),
        ("M1 or sun", Some(true)),
        ("M1 and lamp", Some(false)),
        // Nothing was reflected, so neither was what is not spelled out.
        ("M1:R", Some(false)),
        ("... > M1:R > ...", Some(false)),
        ("M1:RS", None),
        ("ghost(M1, M1)", Some(false)),
    ] {
        assert_eq!(says(text, &long), answer, "{text}");
    }
    // Few reflections are spelled out however long the path is; of many, the last are not.
    let trapped = path(0, &[[(0, Transmit); LONGEST_PATH].as_slice(), &[(1, Reflect), (0, Reflect)]].concat());
    assert_eq!(["ghost(L1.rear, *)", "ghost(*, L1.rear)"].map(|text| says(text, &trapped)), [Some(true), Some(false)]);
    let mirrored = path(0, &[[(2, Reflect); LONGEST_PATH].as_slice(), &[(1, Reflect), (0, Reflect)]].concat());
    assert_eq!(["ghost(*, *)", "ghosts == 2"].map(|text| says(text, &mirrored)), [None, Some(true)]);
}

#[test]
fn what_is_wrong_is_told_with_its_place_and_its_remedy() {
    for (text, message) in [
        ("Barel_1:S", "line 1, column 1: no part is called \"Barel_1\"; did you mean \"Barrel_1\"?"),
        ("sun > ... > fps", "line 1, column 13: no detector is called \"fps\"; did you mean \"fpa\"?"),
        ("suns > ...", "line 1, column 1: no source is called \"suns\"; did you mean \"sun\"?"),
        ("ghost(L1.rear L1.front)", "line 1, column 15: `L1.front` is not understood here; expected `)`"),
        (
            "scatters = 1",
            "line 1, column 10: `=` has no meaning here; names with other signs than letters, digits and _ . - / stand in double quotes",
        ),
        ("scatters > 1.5", "line 1, column 12: `1.5` is not understood here; expected a whole number"),
        ("signal ghost", "line 1, column 8: `ghost` is not understood here; expected `and`, `or`, `>` or the end"),
        ("(signal", "line 1, column 8: the end is not understood here; expected `)`"),
        (
            "M1:X",
            "line 1, column 4: `X` is not understood here; expected letters of R (reflect), T (transmit), S (scatter) and V (scatter in a medium)",
        ),
        ("...", "line 1, column 1: `...` alone says nothing; expected a chain such as `... > Barrel*:S > ...`"),
        (
            "L1.front:T > ...",
            "line 1, column 1: the first of a chain is a source, which has no events; begin with `... >`",
        ),
        ("\"front", "line 1, column 1: a name in quotes is not closed; expected `\"`"),
    ] {
        let problems = Filter::parse("f", text, &names()).expect_err(text);
        assert_eq!(problems[0].to_string(), message);
    }
    let all = Filter::parse("f", "Barel* or suns > M9 > fps", &names()).expect_err("four wrong names");
    assert_eq!(all.len(), 4, "{all:?}");
    assert!(Filter::parse("f", &"(".repeat(100_000), &names()).is_err());
    assert!(Filter::parse("f", &["..."; 99].join(" > "), &names()).is_err());
}

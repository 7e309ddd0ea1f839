//! A file typed from the format's public description, and what is wrong with others.

use super::*;
use crate::medium::Medium;
use crate::medium::agf::decode;

const FILE: &str = "\
! typed from the description
MATE MGF2
0.40 1.384 0
0.70 1.376
mate al
0.5876 1.37 -7.62   ! n - ik
COAT AR
MGF2 0.25
COAT thick
MGF2 0.1 1
AL   0.02 1 0
COAT I.0.95
IDEAL half 0.5 0.4
IDEAL most 0.9
IDEAL2 jones 1 0 1 0 0 0 0 0
TAPR dome
0 0 1
COAT tapered
MGF2 0.25 0 0 dome
COAT looped
MGF2 0.25 0 1
COAT typo
MGF3 0.25
ENCRYPTED secret.zec
TABLE split
ANGL 0
WAVE 0.5 0.4 0.4 0.6 0.6
WAVE 0.6 0.5 0.5 0.5 0.5 0 0 0 0
ANGL 45.0
WAVE 0.5 0.5 0.3 0.5 0.7 180 0 0 0
WAVE 0.6 0.6 0.4 0.4 0.6
";

fn entry(name: &str) -> Entry {
    parse(FILE, name).unwrap_or_else(|problem| panic!("{}", problem.message)).entry
}

fn refused(name: &str) -> (u32, String) {
    let problem = parse(FILE, name).expect_err("refused");
    (problem.span.map_or(0, |span| span.line), problem.message)
}

#[test]
fn layers_stand_from_the_air_to_the_substrate() {
    let Entry::Films(films) = entry("THICK") else { panic!("no films") };
    assert_eq!(
        films.iter().map(|film| film.thickness).collect::<Vec<_>>(),
        [0.1, 0.02].map(|um| Thickness::Length(um / 1e6))
    );
    let aluminium = films[1].material.index(587.6e-9);
    assert_eq!((aluminium.re, aluminium.im), (1.37, 7.62));
    let Entry::Films(films) = entry("AR") else { panic!("no films") };
    assert_eq!(films[0].thickness, Thickness::Waves(0.25));
    assert!((films[0].material.index(0.55e-6).re - 1.38).abs() < 1e-15);
}

#[test]
fn ideal_coatings_are_two_numbers() {
    let ideal = |name: &str| match entry(name) {
        Entry::Ideal { reflectance, transmittance } => [reflectance, transmittance],
        other => panic!("{other:?}"),
    };
    assert_eq!(ideal("I.0.95"), [1.0 - 0.95, 0.95]);
    assert_eq!(ideal("I.0.5"), [0.5, 0.5]);
    assert_eq!(ideal("half"), [0.4, 0.5]);
    assert_eq!(ideal("MOST"), [1.0 - 0.9, 0.9]);
}

#[test]
fn tables_keep_shares_and_leave_phases() {
    let found = parse(FILE, "split").expect("a table");
    let Entry::Table(rows) = found.entry else { panic!("no table") };
    assert_eq!(rows.len(), 4);
    assert_eq!((rows[3].wavelength, rows[3].angle), (0.6 / 1e6, 45f64.to_radians()));
    assert_eq!(rows[2].power, [0.5, 0.3, 0.5, 0.7]);
    assert_eq!(found.warnings.len(), 1);
}

#[test]
fn what_cannot_be_read_is_refused_with_its_line() {
    assert_eq!(refused("jones").0, 15);
    assert_eq!(refused("tapered").0, 19);
    assert_eq!(refused("looped").0, 21);
    assert_eq!(refused("typo").0, 23);
    let (line, message) = refused("secret.zec");
    assert!(line == 24 && message.contains("encrypted"), "{line} {message}");
    assert!(refused("AF").1.contains("none of its"));
    assert!(parse("nothing", "AR").is_err());
    assert!(parse("MATE X\n0.5 1.4 0.1\nCOAT C\nX 1 1\n", "C").expect_err("gain").message.contains("amplifies"));
}

#[test]
fn files_are_wide_or_narrow() {
    let wide: Vec<u8> = std::iter::once(0xfeff).chain(FILE.encode_utf16()).flat_map(u16::to_le_bytes).collect();
    for bytes in [FILE.as_bytes().to_vec(), wide, FILE.replace('\n', "\r\n").into_bytes()] {
        assert!(matches!(parse(&decode(&bytes), "ar").expect("a coating").entry, Entry::Films(_)));
    }
}

//! Catalogue media in whole systems: files, ranges, conventions, messages; and damaged files.

mod bricks;

use std::sync::atomic::AtomicBool;
use straylight::error::Error;
use straylight::medium::{Medium, agf, page};
use straylight::system::compile::{Compiled, compile};
use straylight::system::document::Document;
use straylight::transport::{self, summary};

/// A catalogue typed from the format's description: one glass for each formula, coefficients of no real glass.
const AGF: &str = include_str!("data/agf/typed.agf");

/// The page of a medium by formula 1, with absorption.
const PAGE: &str = "REFERENCES: |\n    nobody\nDATA:\n  - type: formula 1\n    wavelength_range: 0.4 0.8\n    \
                    coefficients: 0 1.2 0.1\n  - type: tabulated k\n    data: |\n        0.4 1e-8\n        0.6 3E-8\n";

/// A glass brick lit by `spectrum`; `media` defines "glass". Beside the system lie `typed.agf`, `page.yml` and `files`.
fn system(media: &str, spectrum: &str, coating: &str) -> Result<Compiled, Error> {
    let folder = tempfile::tempdir().expect("folder");
    let brick = ("brick", [-0.1, -0.1, 0.0], [0.1, 0.1, 0.005]);
    std::fs::write(folder.path().join("bricks.gltf"), bricks::gltf(&[brick])).expect("geometry");
    std::fs::write(folder.path().join("typed.agf"), AGF).expect("catalogue");
    std::fs::write(folder.path().join("page.yml"), PAGE).expect("page");
    let text = format!(
        r#"System(
            geometry: [(file: "bricks.gltf")],
            media: {{"glass": {media}}},
            {coating}
            surfaces: [(on: Node("brick"), medium: "glass")],
            sources: {{"beam": (flux: "1 W", extent: Disk(radius: "1 mm"), at: "(0, 0, -9) mm",
                angular: Collimated(direction: "(0, 0, 1)"), spectrum: {spectrum})}},
            run: (rays: 4096, splits: 20, max_events: 10000),
        )"#
    );
    std::fs::write(folder.path().join("system.ron"), text).expect("system");
    compile(&Document::read(&folder.path().join("system.ron"))?)
}

/// What is said of a system, without the folder it lies in.
fn said(media: &str, spectrum: &str) -> String {
    let error = system(media, spectrum, "").map(|_| ()).expect_err("refused").to_string();
    error.split_once("system.ron:").map_or(error.clone(), |(_, rest)| rest.to_owned())
}

const GREEN: &str = r#"Line("550 nm")"#;

#[test]
fn light_outside_the_data_is_refused_with_the_range() {
    assert_eq!(
        said(r#"Glass("N-BK7")"#, r#"Line("250 nm")"#),
        "3:21: media[\"glass\"]: the data of `glass` do not cover the light of `beam`: 250 nm to 250 nm; \
         expected wavelengths from 300 nm to 2500 nm"
    );
    let ends =
        said(r#"RefractiveIndexInfo(file: "page.yml")"#, r#"Table(wavelength: ["500 nm", "900 nm"], weight: [1, 1])"#);
    assert!(ends.ends_with("500 nm to 900 nm; expected wavelengths from 400 nm to 800 nm"), "{ends}");
    assert!(said(r#"Agf(file: "typed.agf", glass: "SCHOTT1")"#, r#"Line("3 um")"#).ends_with("from 400 nm to 2000 nm"));
    // A coating's medium is held to its data, too.
    let coated = r#"coatings: {"mirror": Opaque(medium: "Au")},
        default: (coating: "mirror"),"#;
    let error = system(r#"Constant(n: 1.5), "Au": Metal("Au")"#, r#"Line("3 um")"#, coated).expect_err("refused");
    assert!(error.to_string().contains("the data of `Au` do not cover"), "{error}");
}

#[test]
fn absorption_held_beyond_its_table_is_said() {
    let compiled = system(r#"RefractiveIndexInfo(file: "page.yml")"#, r#"Line("700 nm")"#, "").expect("compiles");
    let warnings: Vec<&str> = compiled.warnings.iter().map(|w| w.message.as_str()).collect();
    assert_eq!(
        warnings[1..],
        ["the absorption of `glass` is not known for all of the light of `beam`: 700 nm to 700 nm"]
    );
    let index = compiled.scene.index(1, 700e-9);
    assert_eq!(index.im, 3e-8);
}

#[test]
fn files_lie_beside_the_system_and_are_named_in_what_goes_wrong() {
    let compiled = system(r#"RefractiveIndexInfo(file: "page.yml")"#, GREEN, "").expect("compiles");
    assert!(compiled.inputs.contains_key("page.yml"), "{:?}", compiled.inputs);
    // n^2 = 1 + 1.2 l^2 / (l^2 - 0.01) at 0.55 um, absolute: the page is no catalogue's.
    let wanted = (1.0 + 1.2 * 0.3025 / 0.2925f64).sqrt();
    assert!((compiled.scene.index(1, 550e-9).re - wanted).abs() < 1e-14);
    let said = |media: &str| said(media, GREEN);
    assert_eq!(
        said(r#"RefractiveIndexInfo(file: "none.yml")"#),
        "3:56: media[\"glass\"].file: \"none.yml\" does not exist; files are relative to the system file"
    );
    let agf = said(r#"RefractiveIndexInfo(file: "typed.agf")"#);
    assert!(agf.contains("typed.agf:") && agf.contains("this is not a page of refractiveindex.info"), "{agf}");
    let other = said(r#"Agf(file: "typed.agf", glass: "SCHOT1")"#);
    assert_eq!(
        other,
        "3:21: media[\"glass\"]: \"typed.agf\": none of its 15 glasses is called \"SCHOT1\"; did you mean \"SCHOTT1\"?"
    );
    let empty = said(r#"Agf(file: "page.yml", glass: "A")"#);
    assert!(
        empty.ends_with("this is no AGF catalogue; expected lines `NM name formula ..` for its glasses"),
        "{empty}"
    );
    assert!(said(r#"Glass("N-BK-7")"#).ends_with("no glass \"N-BK-7\"; did you mean \"N-BK7\"?"));
    assert!(said("Air(temperature: \"20 K\")").contains("\"20 K\" is out of range; expected 233 K to 373 K"));
}

/// In air of the catalogue's temperature a glass refracts by the catalogue's index.
#[test]
fn ambient_air_gives_the_catalogues_ratio() {
    let media = r#"Glass("N-BK7"), "air": Air(temperature: "293 K")"#;
    let compiled = system(media, GREEN, r#"ambient: "air","#).expect("compiles");
    let scene = &compiled.scene;
    let [glass, air] = [1, scene.ambient].map(|medium| scene.index(medium, 550e-9).re);
    // Sellmeier of N-BK7 at 550 nm / 1.000273 = 549.850 nm in air.
    let l2: f64 = (0.55 / air) * (0.55 / air);
    let terms = [(1.03961212, 0.00600069867), (0.231792344, 0.0200179144), (1.01046945, 103.560653)];
    let relative = (1.0 + terms.iter().map(|(b, c)| b * l2 / (l2 - c)).sum::<f64>()).sqrt();
    assert!((glass / air - relative).abs() < 1e-12);
    assert!((air - 1.000273).abs() < 1e-6, "{air}");
}

/// What leaves a plate that absorbs on both sides, all internal orders: r + (1-r)^2 t (1 + r t) / (1 - r^2 t^2), with r from the ratio
/// of the indices and t the internal transmittance of 5 mm.
#[test]
fn a_plate_of_catalogue_glass_in_air_loses_what_its_absorption_says() {
    let sections = r#"ambient: "air",
        detectors: {"far": (on: FarField(axis: "(0, 0, -1)"), quantity: Intensity, pixels: (8, 8))},"#;
    let compiled = system(r#"Glass("N-SF11"), "air": Air()"#, GREEN, sections).expect("compiles");
    let (scene, settings) = (&compiled.scene, &compiled.settings);
    let counts = transport::run::<1>(scene, settings, &AtomicBool::new(false), &|_| {});
    let results = summary::results(scene, settings, &counts, 0, compiled.inputs.clone(), Vec::new());
    let [glass, air] = [1, scene.ambient].map(|medium| scene.index(medium, 550e-9));
    let ratio = glass.re / air.re;
    let r = f64::powi((ratio - 1.0) / (ratio + 1.0), 2);
    let t = (-straylight::medium::absorption(glass, 550e-9) * 5e-3_f64).exp();
    assert!(t < 0.9999 && (ratio - 1.7919).abs() < 1e-3, "absorbs: {t}; Schott's n_e = 1.79190: {ratio}");
    let wanted = r + (1.0 - r) * (1.0 - r) * t * (1.0 + r * t) / (1.0 - r * r * t * t);
    let got = results.detectors["far"].flux_w.mean;
    // The faces lie at f32 coordinates, so that the thickness is 5 mm within 6e-8.
    assert!((got - wanted).abs() < 1e-10, "{got}, closed form {wanted}");
}

/// Each formula at 0.5 um in air (l^2 = 0.25, l^-2 = 4), by hand from the coefficients of the typed catalogue.
#[test]
fn each_agf_formula_gives_its_value_by_hand() {
    let l = 1.0 / 0.222;
    let squares = [
        ("SCHOTT1", 2.25 + 0.25 * -0.01 + 4.0 * 0.01 + 16.0 * 1e-3 + 64.0 * 1e-4 + 256.0 * 1e-5),
        ("SELLMEIER1", 1.0 + 0.25 * (1.0 / 0.24 + 0.2 / 0.23 + 0.9 / (0.25 - 100.0))),
        ("HERZBERGER3", f64::powi(1.5 + 0.01 * l + 1e-3 * l * l - 0.25e-3 + 0.0625e-4 - 1e-5 / 64.0, 2)),
        ("SELLMEIER2", 1.0 + 0.5 + 0.8 * 0.25 / (0.25 - 0.01) + 0.05 / (0.25 - 0.04)),
        ("CONRADY5", f64::powi(1.5 + 0.01 * 2.0 + 1e-3 * 2f64.powf(3.5), 2)),
        ("SELLMEIER3", 1.0 + 0.25 * (1.0 / 0.24 + 0.2 / 0.23 + 0.9 / (0.25 - 100.0) + 0.1 / (0.25 - 50.0))),
        ("HANDBOOK1", 2.2 + 0.02 / (0.25 - 0.05) - 0.01 * 0.25),
        ("HANDBOOK2", 1.2 + 1.1 * 0.25 / (0.25 - 0.05) - 0.01 * 0.25),
        ("SELLMEIER4", 1.3 + 0.25 * (1.0 / 0.24 + 0.5 / (0.25 - 100.0))),
        ("EXTENDED1", 2.25 - 0.0025 + 0.04 + 0.016 + 0.0064 + 0.00256 + 1e-6 * 1024.0 + 1e-7 * 4096.0),
        ("SELLMEIER5", 1.0 + 0.25 * (0.5 / 0.24 + 0.2 / 0.23 + 0.4 / 0.22 + 0.1 / 0.21 + 0.9 / (0.25 - 100.0))),
        ("EXTENDED2", 2.25 - 0.0025 + 0.04 + 0.016 + 0.0064 + 0.00256 + 1e-3 / 16.0 + 1e-4 / 64.0),
        ("EXTENDED3", 2.25 - 0.0025 + 1e-3 / 16.0 + 0.04 + 0.016 + 0.0064 + 0.00256 + 1024e-6 + 4096e-7),
    ];
    for (name, square) in squares {
        let glass = agf::parse(AGF, name, "typed.agf").unwrap_or_else(|problem| panic!("{name}: {problem}"));
        let n = glass.medium.printed(0.5e-6).re;
        assert!((n * n - square).abs() < 1e-12, "{name}: {}, by hand {square}", n * n);
        assert!(glass.medium.relative_to.is_some() && glass.medium.wavelengths_in.is_some());
    }
}

/// The same glass by AGF and by its page: index, reference temperature, absorption from tau (25 mm) = 0.992 at 400 nm.
#[test]
fn internal_transmittance_becomes_absorption() {
    let glass = agf::parse(AGF, "n-bk7", "typed.agf").expect("the glass");
    assert_eq!((glass.n_d, glass.abbe), (Some(1.5168), Some(64.17)));
    let index = glass.medium.printed(587.5618e-9);
    assert!((index.re - 1.5168).abs() < 5e-8);
    assert_eq!(glass.medium.relative_to.map(|air| air.temperature()), Some(293.15));
    let tau = |nm: f64, mm: f64| {
        (-straylight::medium::absorption(glass.medium.printed(nm * 1e-9), nm * 1e-9) * mm * 1e-3).exp()
    };
    // Of 10 mm (0.997) and 25 mm (0.992) the thicker counts; at 310 nm only 10 mm lets light through.
    assert!((tau(400.0, 25.0) - 0.992).abs() < 1e-12);
    assert!((tau(310.0, 10.0) - 0.574).abs() < 1e-12);
    // Dark through every thickness: at least as dark as half of the last digit.
    assert!((tau(290.0, 10.0) - agf::DARKEST).abs() < 1e-12);
    assert_eq!(glass.medium.absorption_range(), Some([0.29e-6, 2.5e-6]));
    assert_eq!(agf::parse(AGF, "SCHOTT1", "typed.agf").expect("a glass").medium.absorption_range(), None);
}

#[test]
fn an_agf_catalogue_may_be_utf_16() {
    let wide: Vec<u8> = std::iter::once(0xfeff).chain(AGF.encode_utf16()).flat_map(u16::to_le_bytes).collect();
    assert_eq!(agf::decode(&wide), AGF);
    assert_eq!(agf::decode(format!("\u{feff}{AGF}").as_bytes()), AGF);
    assert_eq!(agf::decode(&[0xff]), "\u{fffd}");
}

#[test]
fn a_page_says_what_is_relative_to_air() {
    let with = |more: &str| page::parse(&format!("{PAGE}{more}"), "page").expect("a page").medium;
    let flags = |more: &str| (with(more).relative_to.is_some(), with(more).wavelengths_in.is_some());
    assert_eq!(flags(""), (false, false));
    assert_eq!(flags("PROPERTIES:\n    nd: 1.5\n    Vd: 60\n"), (true, true));
    assert_eq!(flags("CONDITIONS: {n_is_absolute: true}\nPROPERTIES: {nd: 1.5, Vd: 60}\n"), (false, false));
    assert_eq!(flags("SPECS: {n_is_absolute: false, wavelength_is_vacuum: true}\n"), (true, false));
    let kelvin = |text: &str| {
        with(&format!("CONDITIONS: {{n_is_absolute: false, temperature: {text}}}")).relative_to.map(|a| a.temperature())
    };
    assert_eq!(["297", "\"25.0 °C\"", "22 C", "300 K"].map(kelvin), [297.0, 298.15, 295.15, 300.0].map(Some));
}

/// Every page formula through its text; the formulas themselves are tested by hand beside them.
#[test]
fn each_page_formula_reads_its_coefficients_in_order() {
    let square = |formula: &str, coefficients: &str| {
        let text = format!("DATA:\n- type: {formula}\n  wavelength_range: 0.4 0.8\n  coefficients: {coefficients}\n");
        let n =
            page::parse(&text, "page").unwrap_or_else(|problem| panic!("{formula}: {problem}")).medium.index(0.5e-6).re;
        n * n
    };
    let close = |got: f64, wanted: f64| assert!((got - wanted).abs() < 1e-12, "{got} for {wanted}");
    close(square("formula 1", "0.1 1.2 0.1 0.5 10"), 1.1 + 0.3 / 0.24 + 0.125 / (0.25 - 100.0));
    close(square("formula 2", "0.1 1.2 0.01 0.5 100"), 1.1 + 0.3 / 0.24 + 0.125 / (0.25 - 100.0));
    close(square("formula 3", "2 0.1 2 0.01 -2"), 2.0 + 0.025 + 0.04);
    close(square("formula 4", "2 0.3 2 0.1 2 0.02 0 0.05 1 0.4 2 0.01 -2"), 2.0 + 0.075 / 0.24 + 0.1 + 0.1 + 0.04);
    close(square("formula 4", "2 0.3 2 0.1 2"), 2.0 + 0.075 / 0.24);
    close(square("formula 5", "1.5 0.01 -2"), 1.54 * 1.54);
    close(square("formula 6", "0.1 0.5 204"), f64::powi(1.1025, 2));
    close(square("formula 7", "1.5 0 0 0.04"), 1.51 * 1.51);
    close(square("formula 8", "0.2 0.1 0.05 0.1"), 1.7 / 0.65);
    close(square("formula 9", "2 0.12 0.01 0.5 0.1 0.04"), 3.5);
}

#[test]
fn damaged_pages_are_refused_in_a_line() {
    let cases = [
        (
            ("formula 1", "formula 10"),
            "there is no data of type \"formula 10\"; expected `formula 1` to `formula 9`, \
          `tabulated nk`, `tabulated n` or `tabulated k`",
        ),
        (("0 1.2 0.1", "0 1.2"), "formula 1 has 2 coefficients; expected an odd number, up to 17"),
        (("0 1.2 0.1", "0 NaN 0.1"), "`coefficients`: \"NaN\" is not a number"),
        (
            ("0.4 0.8", "0.8 0.4"),
            "`wavelength_range` is missing or no range; expected two increasing wavelengths in um",
        ),
        (
            ("0.6 3E-8", "0.6 -3E-8"),
            "row 2 of `tabulated k` holds a negative value; expected 2 values: a wavelength in um, \
          then what `tabulated k` says",
        ),
        (
            ("0.6 3E-8", "0.3 3E-8"),
            "the wavelengths of `tabulated k` do not increase; expected increasing wavelengths in um",
        ),
        (
            ("0 1.2 0.1", "0 1.2 0.5"),
            "there is no index at 0.400000 um; expected n above 0 and k of 0 or more in the whole range",
        ),
        (("formula 1", "tabulated n"), "`tabulated n` has no rows; expected a row for each wavelength"),
    ];
    for ((old, new), wanted) in cases {
        let problem = page::parse(&PAGE.replacen(old, new, 1), "page").expect_err(new).to_string();
        let (_, said) = problem.split_once(": ").unwrap_or_default();
        assert!(problem.ends_with(wanted), "{problem}\nwanted {wanted}\n{said}");
    }
    let only_k =
        PAGE.replacen("  - type: formula 1\n    wavelength_range: 0.4 0.8\n    coefficients: 0 1.2 0.1\n", "", 1);
    let problem = page::parse(&only_k, "page").expect_err("no index").to_string();
    assert_eq!(problem, "this page gives no refractive index; expected a formula, or a table of n");
}

/// Cut anywhere, stuffed with odd numbers, nested or repeated without end: an answer, and soon.
#[test]
fn no_damage_makes_a_reader_panic() {
    let names = ["SCHOTT1", "N-BK7", "EXTENDED3"];
    let odd = ["NaN", "inf", "-1", "0", "1e308", "1e-320", "4294967296", "99999999999999999999", "", "é", "0x1", "- -"];
    let try_agf = |text: &str| names.iter().for_each(|name| drop(agf::parse(text, name, "typed.agf")));
    for end in (0..AGF.len()).step_by(3).filter(|end| AGF.is_char_boundary(*end)) {
        try_agf(&AGF[..end]);
    }
    (0..PAGE.len()).for_each(|end| drop(page::parse(&PAGE[..end], "page")));
    for text in [AGF, PAGE] {
        let words: Vec<&str> = text.split(' ').collect();
        for at in (0..words.len()).step_by(5) {
            for word in odd {
                let mut words = words.clone();
                words[at] = word;
                let text = words.join(" ");
                try_agf(&text);
                drop(page::parse(&text, "page"));
            }
        }
    }
    let bomb: String = (0..40).map(|i| format!("a{}: &a{} [*a{i}, *a{i}]\n", i + 1, i + 1)).collect();
    for text in ["[".repeat(100_000), format!("a0: &a0 [1]\n{bomb}"), "DATA:\n- ".repeat(50_000), "\0".repeat(1000)] {
        assert!(page::parse(&text, "page").is_err());
    }
}

#[test]
fn a_folder_is_no_page() {
    let error = system(r#"RefractiveIndexInfo(file: ".")"#, GREEN, "").expect_err("a folder").to_string();
    assert!(error.ends_with("\".\" is not a file; files are relative to the system file"), "{error}");
}

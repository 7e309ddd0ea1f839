//! Named quantities, expressions, and what the command line sets.

use super::*;
use straylight::system::document::Body;

#[test]
fn an_expression_is_read_where_a_quantity_stands() {
    let folder = folder(&[("system.ron", HOOD)]);
    let document = read(folder.path(), &[]).expect("a good system");
    let hood = document.system.elements.get("hood").expect("the hood");
    assert_eq!(hood.at.0.to_array(), [0.0, 0.0, -0.1]);
    assert!(matches!(hood.body, Body::Tube { length, .. } if length.0 == 0.08));
    let values: Vec<(&str, &str)> = document.parameters.iter().map(|(name, value)| (name, value.as_str())).collect();
    assert_eq!(values, [("hood.length", "80 mm"), ("n", "1.5"), ("gap", "0.02 m"), ("power", "1 W")]);
    assert_eq!(document.warnings, []);
}

/// The same bits as if the value stood in the place of the expression, in every unit.
#[test]
fn a_parameter_gives_what_its_text_gives() {
    for value in ["120 mm", "0.1 in", "1e-7 km", "-33.3 um", "4.7 inch", "550 nm", "1.1cm"] {
        let place = |text: &str| {
            let system =
                HOOD.replace("\"= (0, 0, -hood.length - gap)\"", text).replace("outer: \"60 mm\"", "outer: \"= gap\"");
            let document = Document::parse(Path::new("a.ron"), system.as_bytes()).expect("a good system");
            document.system.elements.get("hood").expect("the hood").at.0
        };
        let (number, unit) = value.split_at(value.find(|c: char| c.is_alphabetic() && c != 'e').expect("a unit"));
        let written = place(&format!("\"({number}, 0, 0) {unit}\""));
        let by_name =
            HOOD.replace("80 mm", value).replace("-hood.length - gap)", "0)").replace("= (0,", "= (hood.length,");
        let document = Document::parse(Path::new("a.ron"), by_name.as_bytes());
        let document = document.unwrap_or_else(|error| panic!("{:#?}", error.problems()));
        let hood = document.system.elements.get("hood").expect("the hood");
        assert_eq!(hood.at.0.to_array().map(f64::to_bits), written.to_array().map(f64::to_bits), "{value}");
        let Body::Tube { length, .. } = hood.body else { panic!("a tube") };
        assert_eq!(length.0.to_bits(), written.x.to_bits(), "{value}");
    }
}

#[test]
fn what_is_set_is_what_the_edited_file_says() {
    let (original, edited) =
        (folder(&[("system.ron", HOOD)]), folder(&[("system.ron", &HOOD.replace("80 mm", "120 mm"))]));
    let mut was = results(original.path(), &[]);
    let mut set = results(original.path(), &["--set", "hood.length=120 mm"]);
    let mut is = results(edited.path(), &[]);
    assert_eq!(set["parameters"]["hood.length"], "120 mm");
    assert_eq!(set["parameters"]["gap"], "0.03 m");
    assert_eq!(was["parameters"]["hood.length"], "80 mm");
    assert_ne!(set["inputs"], is["inputs"]);
    [&mut was, &mut set, &mut is].into_iter().for_each(|results| {
        results["inputs"].take();
        results["system"].take();
    });
    assert_eq!(set, is);
    assert_ne!(set["ledger_w"], was["ledger_w"], "a longer hood shades more");
    let report = std::fs::read_to_string(original.path().join("out/report.html")).expect("a report");
    assert!(report.contains("<td>hood.length</td><td>120 mm</td>"));
    assert!(report.contains("--set hood.length=&quot;120 mm&quot;"), "the command repeats the run");
}

#[test]
fn a_configuration_is_a_named_set_of_values() {
    let system = HOOD.replace(
        "    elements",
        "    configurations: { \"long\": { \"hood.length\": \"120 mm\", \"n\": 1.6 } },\n    elements",
    );
    let folder = folder(&[("system.ron", &system)]);
    let chosen = results(folder.path(), &["--configuration", "long"]);
    let set = results(folder.path(), &["--set", "hood.length=120 mm", "--set", "n=1.6"]);
    assert_eq!(chosen, set);
    let both = results(folder.path(), &["--configuration", "long", "--set", "n=1.7"]);
    assert_eq!((&both["parameters"]["n"], &both["parameters"]["hood.length"]), (&"1.7".into(), &"120 mm".into()));
}

#[test]
fn what_cannot_be_chosen_is_a_usage_error() {
    let folder = folder(&[("system.ron", HOOD)]);
    for (arguments, wanted) in [
        (["--set", "hood.lenth=1 mm"], "--set \"hood.lenth\": no such parameter; did you mean \"hood.length\"?"),
        (["--set", "hood.length=1 mmm"], "--set \"hood.length\": no such unit: `mmm`"),
        (["--set", "hood.length"], "expected NAME=VALUE"),
        (["--configuration", "long"], "--configuration \"long\": no such configuration; the system has none"),
    ] {
        for verb in
            [&["check", "system.ron"][..], &["run", "system.ron", "-o", "out"], &["export", "system.ron", "a.glb"]]
        {
            let (code, output) = program(folder.path(), &[verb, &arguments].concat());
            let said = text(&output.stderr);
            assert!(code == 64 && said.contains(wanted), "{code} {said}");
        }
    }
    let (code, output) = program(folder.path(), &["check", "system.ron", "--set", "hood.length=9 cm"]);
    assert!(code == 0 && text(&output.stdout).contains("hood.length  9 cm"), "{}", text(&output.stdout));
}

#[test]
fn what_is_wrong_with_an_expression_is_told_where_it_stands() {
    let cases = [
        (
            "= hood.length\"",
            "= hood.lenth\"",
            r#"system.ron:9:72: elements["hood"].body.length: no parameter `hood.lenth`; did you mean `hood.length`?"#,
        ),
        (
            "hood.length / 4",
            "hood.length / 4 + 1 deg",
            r#"system.ron:5:17: parameters["gap"]: `0.02 m` is a length and `1 deg` an angle; expected quantities of one kind"#,
        ),
        (
            "\"80 mm\"",
            "\"4 * gap\"",
            r#"system.ron:5:17: parameters["gap"]: parameter `hood.length` depends on itself"#,
        ),
        (
            "\"= n\"",
            "\"= gap\"",
            r#"system.ron:14:35: media["glass"].n: `"0.02 m"` is not a number; "= gap" is "0.02 m" here"#,
        ),
        (
            "\"= power\"",
            "\"= power * 1 m\"",
            r#"system.ron:16:30: sources["sun"].flux: "1 m*W": no such unit here: "m*W"; one of W, mW, uW, nW, pW, kW; expected a flux with its unit, such as "1 W"; "= power * 1 m" is "1 m*W" here"#,
        ),
        (
            "\"n\": 1.5",
            "\"n\": -1.5",
            r#"system.ron:14:35: media["glass"].n: -1.5 is out of range; expected a value above 0"#,
        ),
        (
            "\"n\": 1.5",
            "\"n\": (1, 2)",
            r#"system.ron:4:14: parameters["n"]: this is no quantity; expected a quantity or an expression, such as "12.7 mm""#,
        ),
        (
            "\"power\": \"1 W\"",
            "\"power\": \"1 W\", \"mm\": 3",
            r#"system.ron:6:25: parameters["mm"]: "mm" cannot name a parameter; expected letters, digits, `_` and `.`, a letter first, and no unit or function"#,
        ),
        (
            "\"power\": \"1 W\"",
            "\"power\": \"1 W\", \"power\": \"2 W\"",
            r#"system.ron:6:25: parameters: the name "power" is given twice"#,
        ),
        (
            "\"power\": \"1 W\"",
            "\"power\": \"1 W\", \"spare\": \"2 W\"",
            r#"system.ron:6:34: warning: parameters["spare"]: parameter `spare` is never used"#,
        ),
        (
            "    elements",
            "    configurations: { \"long\": { \"hod.length\": \"120 mm\" } },\n    elements",
            r#"system.ron:8:33: configurations["long"]["hod.length"]: no parameter `hod.length`; did you mean `hood.length`?"#,
        ),
    ];
    let first = |(old, new, _): &(&str, &str, &str)| after(HOOD, old, new).first().cloned().unwrap_or_default();
    let said_first: Vec<String> = cases.iter().map(first).collect();
    assert_eq!(said_first, cases.map(|case| case.2));
    // What depends on a wrong parameter is not told again, and the rest is.
    let wrong = HOOD.replace("hood.length / 4", "hood.length / 4 deg / x").replace("28 mm", "28");
    assert_eq!(said(&[("system.ron", &wrong)]).len(), 2, "{:#?}", said(&[("system.ron", &wrong)]));
}

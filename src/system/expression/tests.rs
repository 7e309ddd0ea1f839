use super::{Quantity, evaluate};
use crate::error::Problem;

fn lookup(name: &str) -> Result<Quantity, Option<Problem>> {
    match name {
        "hood.length" => Ok(Quantity { value: 0.12, powers: [1, 0, 0, 0, 0], written: Some("120 mm".into()) }),
        _ => Err(Some(Problem::error(format!("no parameter `{name}`")))),
    }
}

fn ron(text: &str) -> String {
    match evaluate(text, &mut lookup) {
        Ok(value) => value.ron(),
        Err(fault) => format!("{:?}: {}", fault.range, fault.problem.map(|p| p.to_string()).unwrap_or_default()),
    }
}

#[test]
fn quantities_are_computed_in_si() {
    for (text, value) in [
        ("hood.length", "\"120 mm\""),
        ("-hood.length", "\"-120 mm\""),
        ("hood.length / 2", "\"0.06 m\""),
        ("0.5 * hood.length + 2 mm", "\"0.062 m\""),
        ("2 * 3 + 4", "10"),
        ("2 - 3 - 4", "-5"),
        ("8 / 4 / 2", "1"),
        ("-(1 - 3) * 2", "4"),
        ("(1 + 1) * 2", "4"),
        ("1.50", "1.50"),
        ("sqrt(9 mm * 4 mm)", "\"0.006 m\""),
        ("cos(0 deg)", "1"),
        ("atan(1)", "\"0.7853981633974483 rad\""),
        ("min(3 mm, 1 mm, 2 mm)", "\"0.001 m\""),
        ("max(1, abs(-5))", "5"),
        ("(0, 0, hood.length)", "\"(0, 0, 0.12) m\""),
        ("(0, 0, 1)", "\"(0, 0, 1)\""),
        ("5 W / (10 mm * 10 mm)", "\"50000 W/m2\""),
        ("3 W/m2", "\"3 W/m2\""),
        ("0.1 /mm", "\"0.1 /mm\""),
        ("2 * 1e-5 mm^-3", "\"20000 m^-3\""),
        ("1 mm * 1 mm", "\"1e-6 m^2\""),
        ("30° + 1 deg", "\"0.5410520681182421 rad\""),
        ("1 / (4 mm)", "\"250 m^-1\""),
        ("tan(pi / 4 * 1 rad) - 1 < 1", "24..27: found `< 1` after the end of the expression"),
    ] {
        assert_eq!(ron(text), value, "{text}");
    }
}

#[test]
fn what_makes_no_sense_is_refused_where_it_stands() {
    for (text, said) in [
        ("1 mm + 2 deg", "0..12: `1 mm` is a length and `2 deg` an angle; expected quantities of one kind"),
        ("(0, 1 mm, 2 deg)", "0..16: `1 mm` is a length and `2 deg` an angle; expected quantities of one kind"),
        ("sin(30)", "0..7: `sin` of `30`, which is a number; expected an angle, such as `30 deg`"),
        (
            "sqrt(2 mm)",
            "0..10: `sqrt` of `2 mm`, which is a length; expected a square, such as a length times a length",
        ),
        ("hood.lenth", "0..10: no parameter `hood.lenth`"),
        ("2 * x", "4..5: no parameter `x`"),
        ("1 / 0", "0..5: `1 / 0` is not a finite number"),
        ("sqrt(-1)", "0..8: `sqrt(-1)` is not a finite number"),
        ("(1 + 2", "6..6: the expression ends here; expected `)`"),
        ("", "0..0: the expression ends here; expected a number, a parameter or a function"),
        ("2 furlongs", "2..10: no such unit: `furlongs`; expected a unit, or `*` before a name"),
        ("min(1)", "0..6: `min` is given 1 arguments; expected two or more"),
    ] {
        assert_eq!(ron(text), said, "{text}");
    }
    assert!(ron("sinn(1 deg)").contains("did you mean `sin`?"));
    assert!(ron("hood.length mm").contains("multiply by `1 mm`"));
    assert!(ron(&"(".repeat(100_000)).contains("nested more than 50 deep"));
    assert!(ron(&"-".repeat(100_000)).contains("nested more than 50 deep"));
}

//! The reference cases, by id.

use serde_json::Value;

/// One case of the verification set.
pub fn case(id: &str) -> Value {
    let text = include_str!("../data/verification/public.json");
    let all: Value = serde_json::from_str(text).expect("the verification set is JSON");
    all["cases"].as_array().expect("cases").iter().find(|c| c["id"] == id).expect(id).clone()
}

/// Its list of reference values.
pub fn values(case: &Value) -> Vec<Value> {
    case["reference"]["values"].as_array().expect("values").clone()
}

/// A number by name.
pub fn number(value: &Value, name: &str) -> f64 {
    value[name].as_f64().unwrap_or_else(|| panic!("{name} in {value}"))
}

#[track_caller]
pub fn close(got: f64, wanted: f64, tolerance: f64, what: &str) {
    assert!((got - wanted).abs() <= tolerance, "{what}: {got:e}, reference {wanted:e}, off by {:e}", got - wanted);
}

//! The reference cases, by id.

use serde_json::Value;

/// One case of the verification set.
pub struct Case {
    pub id: String,
    value: Value,
}

impl Case {
    /// Panics if there is no such case.
    pub fn load(id: &str) -> Case {
        let text = include_str!("../data/verification/public.json");
        let all: Value = serde_json::from_str(text).expect("the verification set is JSON");
        let value = all["cases"].as_array().expect("cases").iter().find(|c| c["id"] == id);
        Case { id: id.into(), value: value.unwrap_or_else(|| panic!("no case {id}")).clone() }
    }

    /// Something of the setup, by JSON pointer: "/source/radius".
    pub fn setup(&self, pointer: &str) -> &Value {
        self.value["setup"].pointer(pointer).unwrap_or_else(|| panic!("{}: no setup{pointer}", self.id))
    }

    /// A number of the setup.
    pub fn given(&self, pointer: &str) -> f64 {
        self.setup(pointer).as_f64().unwrap_or_else(|| panic!("{}: setup{pointer} is no number", self.id))
    }

    /// A list of numbers of the setup.
    pub fn list(&self, pointer: &str) -> Vec<f64> {
        let list = self.setup(pointer).as_array().unwrap_or_else(|| panic!("{}: setup{pointer} is no list", self.id));
        list.iter().map(|v| v.as_f64().expect("a list of numbers")).collect()
    }

    /// The reference values.
    pub fn values(&self) -> Vec<Value> {
        self.value["reference"]["values"].as_array().expect("values").clone()
    }

    /// The reference called `name`: the field "value" of the entry with that name.
    pub fn named(&self, name: &str) -> f64 {
        let values = self.values();
        let entry = values.iter().find(|v| v["name"] == name).unwrap_or_else(|| panic!("{}: no {name}", self.id));
        number(entry, "value")
    }

    /// Source rays at full size.
    pub fn rays(&self) -> Option<u64> {
        self.value["tolerance"]["N_rays"].as_u64()
    }

    /// What the model of the case may differ from its reference by, in the unit of the reference.
    pub fn sys(&self) -> f64 {
        self.value["tolerance"]["sys_abs"].as_f64().unwrap_or(0.0)
    }

    /// Any number of the tolerance: "rel", "abs".
    pub fn tolerance(&self, name: &str) -> f64 {
        number(&self.value["tolerance"], name)
    }
}

/// A field of a reference value.
pub fn number(value: &Value, name: &str) -> f64 {
    value[name].as_f64().unwrap_or_else(|| panic!("{name} in {value}"))
}

//! A place in a JSON document, with the path that leads there.

use crate::error::Problem;
use serde_json::Value;

/// A value and its path.
#[derive(Clone)]
pub struct Node<'a> {
    value: &'a Value,
    path: String,
}

impl<'a> Node<'a> {
    pub fn root(value: &'a Value) -> Node<'a> {
        Node { value, path: String::new() }
    }

    /// The member `name`, unless it is missing or null.
    pub fn find(&self, name: &str) -> Option<Node<'a>> {
        let value = self.value.get(name).filter(|value| !value.is_null())?;
        let dot = if self.path.is_empty() { "" } else { "." };
        Some(Node { value, path: format!("{}{dot}{name}", self.path) })
    }

    pub fn get(&self, name: &str) -> Result<Node<'a>, Problem> {
        self.find(name).ok_or_else(|| self.problem(format!("has no {name:?}")).expecting("a ray-optics model"))
    }

    /// The members of an object are below `attributes`, its class beside them.
    pub fn attributes(&self) -> Node<'a> {
        self.find("attributes").unwrap_or_else(|| self.clone())
    }

    /// Name of the object's class, without its module.
    pub fn class(&self) -> &'a str {
        self.value.get("__instance_type__").and_then(|class| class.get(1)).and_then(Value::as_str).unwrap_or_default()
    }

    /// Names of the members.
    pub fn names(&self) -> Vec<&'a str> {
        self.value.as_object().map(|members| members.keys().map(String::as_str).collect()).unwrap_or_default()
    }

    /// The elements of a list, or of an array of numpy.
    pub fn list(&self) -> Result<Vec<Node<'a>>, Problem> {
        let value = self.value.get("__ndarray__").unwrap_or(self.value);
        let list = value.as_array().ok_or_else(|| self.problem("is no list").expecting("a list"))?;
        Ok(list.iter().enumerate().map(|(i, value)| Node { value, path: format!("{}[{i}]", self.path) }).collect())
    }

    pub fn numbers(&self) -> Result<Vec<f64>, Problem> {
        self.list()?.iter().map(Node::number).collect()
    }

    pub fn number(&self) -> Result<f64, Problem> {
        let number = self.value.as_f64().filter(|v| v.is_finite());
        number.ok_or_else(|| self.problem("is no number").expecting("a number"))
    }

    pub fn count(&self) -> Result<usize, Problem> {
        let count = self.value.as_u64().and_then(|count| usize::try_from(count).ok());
        count.ok_or_else(|| self.problem("is no count").expecting("a whole number"))
    }

    pub fn text(&self) -> Result<&'a str, Problem> {
        self.value.as_str().ok_or_else(|| self.problem("is no text").expecting("a text"))
    }

    pub fn is_true(&self) -> bool {
        self.value.as_bool() == Some(true)
    }

    pub fn problem(&self, message: impl Into<String>) -> Problem {
        Problem::error(message).on(self.path.clone())
    }
}

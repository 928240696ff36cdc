//! A JSON schema of a file, and what it says about a key.

use super::valid;
use schemars::JsonSchema;
use schemars::generate::SchemaSettings;
use serde_json::{Map, Value};

/// The schema of a file, as editors read it: draft 7, which Taplo knows, and without JSON's null, which TOML does not have.
pub struct Schema(pub Value);

/// What stands at a key.
#[derive(Clone, Copy, PartialEq)]
pub enum Shape {
    /// A value in the line of its key.
    Value,
    /// One table.
    Table,
    /// A list of tables.
    List,
    /// Tables by a name that the user chooses.
    Named,
}

impl Schema {
    pub fn of<T: JsonSchema>(title: &str) -> Self {
        let mut root = SchemaSettings::draft07().into_generator().into_root_schema_for::<T>().to_value();
        tidy(&mut root);
        root["title"] = title.into();
        Schema(root)
    }

    /// The node with references followed. What is said beside a reference, such as a description, is not in it.
    pub fn followed<'a>(&'a self, node: &'a Value) -> &'a Value {
        if let Some(one) = node.get("allOf") {
            return self.followed(&one[0]);
        }
        match node.get("$ref").and_then(Value::as_str) {
            Some(path) => self.followed(self.0.pointer(&path[1..]).expect("a definition")),
            None => node,
        }
    }

    /// What stands at a key, and the node that describes one of its tables, or the value.
    pub fn shape<'a>(&'a self, node: &'a Value) -> (Shape, &'a Value) {
        let node = self.followed(node);
        let table = |node: &Value| node.get("properties").is_some();
        for (inside, shape) in [("items", Shape::List), ("additionalProperties", Shape::Named)] {
            if let Some(inner) = node.get(inside).map(|inner| self.followed(inner)).filter(|inner| table(inner)) {
                return (shape, inner);
            }
        }
        (if table(node) { Shape::Table } else { Shape::Value }, node)
    }

    /// What is not valid in a value at `path`, by a node of this schema.
    pub fn faults(&self, node: &Value, value: &toml::Value, path: &str) -> Vec<String> {
        let value = serde_json::to_value(value).expect("TOML has nothing that JSON has not, but for dates");
        valid::faults(&self.0, node, &value, path)
    }

    /// The node of a field that a study names by its path, `boundaries.gate.opening`, or of an element of a list, `boundaries.gate`.
    pub fn at_path(&self, path: &str) -> Option<&Value> {
        let mut node = &self.0;
        let mut words = path.split('.');
        while let Some(word) = words.next() {
            node = self.shape(node).1.get("properties")?.get(word)?;
            if let (Shape::List | Shape::Named, inner) = self.shape(node)
                && words.next().is_some()
            {
                node = inner;
            }
        }
        Some(node)
    }
}

/// The words that are allowed at a key, and what each means.
pub fn words(node: &Value) -> Vec<(String, String)> {
    let word = |one: &Value| Some((one.get("const")?.as_str()?.to_owned(), plain(one)));
    node.get("oneOf").and_then(Value::as_array).into_iter().flatten().filter_map(word).collect()
}

/// The description of a node in one line.
pub fn plain(node: &Value) -> String {
    let text = node.get("description").and_then(Value::as_str).unwrap_or_default();
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// Takes out null, which TOML does not have, and Rust's names of number formats.
fn tidy(node: &mut Value) {
    match node {
        Value::Object(object) => {
            object.values_mut().for_each(tidy);
            tidy_object(object);
        }
        Value::Array(list) => list.iter_mut().for_each(tidy),
        _ => {}
    }
}

fn tidy_object(object: &mut Map<String, Value>) {
    if object.get("default").is_some_and(Value::is_null) {
        object.shift_remove("default");
    }
    if object.get("format").is_some_and(Value::is_string) {
        object.shift_remove("format");
    }
    if let Some(Value::Array(types)) = object.get_mut("type") {
        types.retain(|one| one != "null");
        if let [one] = &types[..] {
            let one = one.clone();
            object.insert("type".to_owned(), one);
        }
    }
    if let Some(Value::Array(mut either)) = object.shift_remove("anyOf") {
        either.retain(|one| one.get("type").is_none_or(|of| of != "null"));
        object.insert("allOf".to_owned(), Value::Array(either));
    }
}

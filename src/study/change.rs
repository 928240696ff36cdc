//! Changes of a case's text, field by field.

use serde::Deserialize;
use toml::{Table, Value};

/// What is changed in a case. Fields are named by their path, `materials.sand.young_pa`; an element of a list is found by its
/// `name`, `boundaries.gate.opening`.
#[derive(Debug, Clone, PartialEq, Default, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields, default)]
pub struct Change {
    /// Fields and their new values. Default: none. Allowed: paths in the case, quoted, and values as in a case file.
    /// Example: `{ "materials.sand.young_pa" = 2.0e6 }`.
    #[cfg_attr(test, schemars(with = "serde_json::Map<String, serde_json::Value>"))]
    pub set: Table,
    /// Fields that are taken out. Default: none. Allowed: paths of fields that stand in the case. Example:
    /// `["bodies.sand.mass_kg"]`.
    pub unset: Vec<String>,
    /// Lists and the elements that are added to them. Default: none. Allowed: paths of lists, quoted, and lists of
    /// values. Example: `{ "gauges.stations_m" = [0.9] }`.
    #[cfg_attr(test, schemars(with = "serde_json::Map<String, serde_json::Value>"))]
    pub append: Table,
}

impl Change {
    /// One field.
    pub fn field(path: &str, value: impl Into<Value>) -> Self {
        Self { set: Table::from_iter([(path.to_string(), value.into())]), ..Self::default() }
    }

    /// Makes the change.
    ///
    /// # Errors
    /// What is wrong with a path, in words.
    pub fn apply(&self, case: &mut Table) -> Result<(), String> {
        for path in &self.unset {
            let (parent, key) = parent_of(case, path)?;
            if parent.remove(key).is_none() {
                return Err(format!("`{path}` is to be taken out, but it is not there"));
            }
        }
        for (path, value) in &self.set {
            let (parent, key) = parent_of(case, path)?;
            parent.insert(key.to_string(), value.clone());
        }
        for (path, values) in &self.append {
            let Value::Array(values) = values else {
                return Err(format!("append.{path} is not a list"));
            };
            let (parent, key) = parent_of(case, path)?;
            match parent.entry(key).or_insert_with(|| Value::Array(Vec::new())) {
                Value::Array(list) => list.extend(values.iter().cloned()),
                _ => return Err(format!("`{path}` is not a list that could be added to")),
            }
        }
        Ok(())
    }
}

/// The table that holds the last key of a path; tables on the way are made where they are missing.
fn parent_of<'a>(case: &'a mut Table, path: &'a str) -> Result<(&'a mut Table, &'a str), String> {
    let (way, key) = path.rsplit_once('.').map_or(("", path), |(way, key)| (way, key));
    let mut table = case;
    let mut parts = way.split('.').filter(|p| !p.is_empty());
    while let Some(part) = parts.next() {
        let next = table.entry(part).or_insert_with(|| Value::Table(Table::new()));
        table = match next {
            Value::Table(table) => table,
            Value::Array(list) => {
                let name =
                    parts.next().ok_or_else(|| format!("`{path}`: {part} is a list, name one of its elements"))?;
                let names: Vec<String> = list.iter().filter_map(name_of).map(str::to_string).collect();
                let found = list.iter_mut().find(|v| name_of(v) == Some(name)).and_then(Value::as_table_mut);
                found.ok_or_else(|| {
                    format!("`{path}`: no element of {part} is named `{name}`; there are {}", names.join(", "))
                })?
            }
            _ => return Err(format!("`{path}`: {part} is a value and has no fields")),
        };
    }
    Ok((table, key))
}

fn name_of(value: &Value) -> Option<&str> {
    value.get("name").and_then(Value::as_str)
}

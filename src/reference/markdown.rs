//! The reference as a page.

use super::schema::{Schema, Shape, plain, words};
use serde_json::Value;
use std::fmt::Write as _;

/// Units by the end of a key, the longest first.
const UNITS: [(&str, &str); 16] = [
    ("_m_per_s2", "m/s²"),
    ("_kg_per_m3", "kg/m³"),
    ("_m_per_s", "m/s"),
    ("_per_s", "1/s"),
    ("_deg", "degrees"),
    ("_cells", "cells"),
    ("_pa", "Pa"),
    ("_kg", "kg"),
    ("_hz", "Hz"),
    ("_n_m", "N m"),
    ("_n_s", "N s"),
    ("_n", "N"),
    ("_j", "J"),
    ("_1", "1"),
    ("_s", "s"),
    ("_m", "m"),
];

/// A table of a file.
pub struct Section {
    /// As it would be written: `[gravity]`, `[[bodies]]`; empty for the top of the file.
    pub header: String,
    pub meaning: String,
    pub fields: Vec<Field>,
}

/// A key of a table.
pub struct Field {
    pub key: String,
    pub shape: Shape,
    pub kind: String,
    pub unit: &'static str,
    pub required: bool,
    /// What the schema has, from serde.
    pub default: Option<Value>,
    /// What the doc comment says.
    pub stated_default: String,
    pub allowed: String,
    pub meaning: String,
    pub example: String,
    pub words: Vec<(String, String)>,
    /// Where it stands in the schema.
    pub node: Value,
}

/// All tables of a file, in the order in which they are declared.
pub fn sections(schema: &Schema) -> Vec<Section> {
    let mut all = Vec::new();
    collect(schema, &schema.0, "", "", &mut all);
    all
}

fn collect(schema: &Schema, table: &Value, path: &str, header: &str, all: &mut Vec<Section>) {
    let required = |key: &String| table["required"].as_array().is_some_and(|keys| keys.iter().any(|k| k == key));
    let properties = table["properties"].as_object().expect("a table has keys");
    let fields = properties.iter().map(|(key, node)| field(schema, key, node, required(key))).collect();
    all.push(Section { header: header.to_owned(), meaning: plain(table), fields });
    for (key, node) in properties {
        let dot = if path.is_empty() { "" } else { "." };
        let path = format!("{path}{dot}{key}");
        let (path, header) = match schema.shape(node).0 {
            Shape::Value => continue,
            Shape::Table => (path.clone(), format!("[{path}]")),
            Shape::List => (path.clone(), format!("[[{path}]]")),
            Shape::Named => (format!("{path}.NAME"), format!("[{path}.NAME]")),
        };
        collect(schema, schema.shape(node).1, &path, &header, all);
    }
}

fn field(schema: &Schema, key: &str, node: &Value, required: bool) -> Field {
    let (shape, inner) = schema.shape(node);
    let (shape, kind) = match shape {
        Shape::Value => (shape, kind(schema, inner)),
        Shape::Table => (shape, "table".to_owned()),
        Shape::List => (shape, "list of tables".to_owned()),
        Shape::Named => (shape, "tables by name".to_owned()),
    };
    let text = plain(node);
    let (text, example) = split(&text, " Example: ");
    let (text, allowed) = split(text, " Allowed: ");
    let (meaning, stated_default) = split(text, " Default: ");
    let unit = if kind.contains("number") { unit(key) } else { "" };
    let listed = |words: &[(String, String)]| words.iter().map(|w| format!("`\"{}\"`", w.0)).collect::<Vec<_>>();
    let words = words(inner);
    let mut allowed = sentence(allowed);
    if !words.is_empty() {
        let list = listed(&words).join(", ");
        allowed = if allowed.is_empty() { list } else { format!("{list}; {allowed}") };
    } else if kind == "true or false" && allowed.is_empty() {
        allowed = "`true` or `false`".to_owned();
    }
    let stated_default = sentence(stated_default);
    let mut example = sentence(example).trim_matches('`').to_owned();
    if example.is_empty() {
        example = stated_default.trim_matches('`').to_owned();
    }
    let default = node.get("default").cloned();
    let (key, meaning) = (key.to_owned(), meaning.to_owned());
    Field {
        key,
        shape,
        kind,
        unit,
        required,
        default,
        stated_default,
        allowed,
        meaning,
        example,
        words,
        node: node.clone(),
    }
}

/// A text up to a label, and what follows it.
fn split<'a>(text: &'a str, label: &str) -> (&'a str, &'a str) {
    text.split_once(label).unwrap_or((text, ""))
}

fn sentence(text: &str) -> String {
    text.trim().trim_end_matches('.').to_owned()
}

fn kind(schema: &Schema, node: &Value) -> String {
    if node.get("oneOf").is_some() {
        return "text".to_owned();
    }
    match node.get("type").and_then(Value::as_str) {
        Some("string") => "text",
        Some("number") => "number",
        Some("integer") => "whole number",
        Some("boolean") => "true or false",
        Some("object") => "table",
        Some("array") => {
            let item = kind(schema, schema.followed(&node["items"]));
            let items = if item.starts_with("list") { item.replacen("list", "lists", 1) } else { format!("{item}s") };
            return match node.get("minItems") {
                Some(count) => format!("list of {count} {items}"),
                None if item == "any value" => "list".to_owned(),
                None => format!("list of {items}"),
            };
        }
        _ => "any value",
    }
    .to_owned()
}

/// The unit of a number, from the end of its name.
pub fn unit(key: &str) -> &'static str {
    UNITS.iter().find(|(end, _)| key.ends_with(end)).map_or("–", |(_, unit)| unit)
}

impl Field {
    fn default_text(&self) -> String {
        match (self.required, self.stated_default.is_empty(), self.shape) {
            (true, ..) => "required".to_owned(),
            (false, false, _) => self.stated_default.clone(),
            (false, true, _) => "none".to_owned(),
        }
    }
}

/// The page: `head`, then a table for each table of the file.
pub fn page(schema: &Schema, head: &str) -> String {
    let mut page = head.to_owned();
    for section in sections(schema) {
        let title = if section.header.is_empty() { "Top of the file" } else { &section.header };
        let code = if section.header.is_empty() { "" } else { "`" };
        write!(page, "\n## {code}{title}{code}\n\n{}\n", section.meaning).expect("a text grows");
        page += "\n| Key | Type | Unit | Default | Allowed | Meaning | Example |\n|---|---|---|---|---|---|---|\n";
        for f in &section.fields {
            let is_value = f.shape == Shape::Value;
            let example = if is_value { format!("`{} = {}`", f.key, f.example) } else { String::new() };
            let default = if is_value || f.required { f.default_text() } else { "may be left out".to_owned() };
            let row = [&format!("`{}`", f.key), &f.kind, f.unit, &default, &f.allowed, &f.meaning, &example];
            writeln!(page, "| {} |", row.map(|cell| cell.replace('|', "\\|")).join(" | ")).expect("a text grows");
        }
        for f in section.fields.iter().filter(|f| !f.words.is_empty()) {
            write!(page, "\n`{}` is one of\n\n", f.key).expect("a text grows");
            for (word, meaning) in &f.words {
                writeln!(page, "- `\"{word}\"`: {meaning}").expect("a text grows");
            }
        }
    }
    page
}

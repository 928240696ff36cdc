//! The reference is complete, true, and what is committed.

use super::markdown::{Field, Section, page, sections};
use super::schema::{Schema, Shape};
use crate::case::{self, Case};
use crate::study::Study;
use std::path::Path;

const CASE_HEAD: &str = "\
# Keys of a case file

All keys of a case, with their meanings. `checkdam check CASE.toml` says what is wrong with a file, and on which line.

The unit of a number is the end of its key. Every number must be finite. A key that is not on this page is refused.
[`examples/wall.toml`](../../examples/wall.toml) is a short case, [`validation/flume/40deg.toml`](../../validation/flume/40deg.toml) a long one.

Editors that know Taplo (Even Better TOML in VS Code, for one) complete and explain these keys when the first line of the file
names the [schema](case.schema.json), relative to the file: `#:schema ../../docs/reference/case.schema.json`.

This page is made from the doc comments in `src/case`; `cargo reference` writes it anew.
";

const STUDY_HEAD: &str = "\
# Keys of a study file

All keys of a study: many runs that differ in a few fields of a [case](case.md). `checkdam study STUDY.toml` works them off.

Fields of a case are named by their paths: `materials.sand.young_pa`. An element of a list is found by its name:
`boundaries.gate.opening`. All of `[[axis]]`, `[[variant]]` and `[sample]` may be given: their runs are added up.

Editors that know Taplo (Even Better TOML in VS Code, for one) complete and explain these keys when the first line of the file
names the [schema](study.schema.json), relative to the file: `#:schema ../../../docs/reference/study.schema.json`.

This page is made from the doc comments in `src/study`; `cargo reference` writes it anew.
";

pub fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

pub fn case_schema() -> Schema {
    Schema::of::<Case>("checkdam case")
}

pub fn study_schema() -> Schema {
    Schema::of::<Study>("checkdam study")
}

fn both() -> [(&'static str, Schema, &'static str); 2] {
    [("case", case_schema(), CASE_HEAD), ("study", study_schema(), STUDY_HEAD)]
}

fn values(sections: &[Section]) -> impl Iterator<Item = (&Section, &Field)> {
    sections.iter().flat_map(|s| s.fields.iter().filter(|f| f.shape == Shape::Value).map(move |f| (s, f)))
}

/// A value as it would be written in a file; `None` if the text is none.
fn literal(text: &str) -> Option<toml::Value> {
    toml::from_str::<toml::Table>(&format!("value = {text}")).ok()?.remove("value")
}

/// The default that a doc comment states as a value: the first words in backticks, if they are one.
fn stated(field: &Field) -> Option<toml::Value> {
    literal(field.stated_default.strip_prefix('`')?.split_once('`')?.0)
}

/// Numbers are equal if their values are: 4 and 4.0.
fn same(a: &toml::Value, b: &toml::Value) -> bool {
    use toml::Value::{Array, Float, Integer};
    match (a, b) {
        (Integer(a), Float(b)) | (Float(b), Integer(a)) => *a as f64 == *b,
        (Array(a), Array(b)) => a.len() == b.len() && a.iter().zip(b).all(|(a, b)| same(a, b)),
        _ => a == b,
    }
}

#[test]
fn what_is_committed_is_what_the_doc_comments_say() {
    for (name, schema, head) in both() {
        let json = serde_json::to_string_pretty(&schema.0).expect("JSON") + "\n";
        check_committed(&format!("{name}.md"), &page(&schema, head));
        check_committed(&format!("{name}.schema.json"), &json);
    }
}

/// A file of the reference is committed with this text; `cargo reference` writes it first.
pub fn check_committed(file: &str, text: &str) {
    let path = root().join("docs/reference").join(file);
    if std::env::var_os("CHECKDAM_REPORTS").is_some() {
        std::fs::write(&path, text).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    }
    let committed = std::fs::read_to_string(&path).unwrap_or_default();
    let line = committed.lines().zip(text.lines()).position(|(a, b)| a != b).unwrap_or(0) + 1;
    assert!(committed == text, "docs/reference/{file}, line {line}, is not up to date: `cargo reference` writes it");
}

#[test]
fn every_key_is_explained() {
    for (name, schema, head) in both() {
        let page = page(&schema, head);
        let sections = sections(&schema);
        assert!(sections.iter().map(|s| s.fields.len()).sum::<usize>() > 35, "{name}");
        for section in &sections {
            assert!(!section.meaning.is_empty(), "{name}: the table {} has no meaning", section.header);
            assert!(page.contains(&section.header));
            for field in &section.fields {
                let what = format!("{name}: {} {}", section.header, field.key);
                assert!(page.contains(&format!("| `{}` |", field.key)), "{what} is not on the page");
                assert!(field.meaning.len() > 3 && field.meaning.ends_with('.'), "{what}: {}", field.meaning);
                let rust = ["[`", "::", "\\["];
                assert!(!rust.iter().any(|r| field.meaning.contains(r)), "{what}: {}", field.meaning);
            }
        }
        for (section, field) in values(&sections) {
            let what = format!("{name}: {} {}", section.header, field.key);
            assert!(!field.allowed.is_empty(), "{what} does not say what is allowed");
            assert!(field.required || !field.stated_default.is_empty(), "{what} does not say what it is when left out");
            assert!(!field.required || field.stated_default.is_empty(), "{what} is required and states a default");
            for (word, meaning) in &field.words {
                assert!(!meaning.is_empty(), "{what}: {word} has no meaning");
            }
        }
    }
}

#[test]
fn every_example_is_a_value_of_its_key() {
    for (name, schema, _) in both() {
        for (section, field) in values(&sections(&schema)) {
            let what = format!("{name}: {} {} = {}", section.header, field.key, field.example);
            let value = literal(&field.example).unwrap_or_else(|| panic!("{what} is not TOML"));
            assert_eq!(schema.faults(&field.node, &value, &what), Vec::<String>::new());
        }
    }
}

/// Everything that has a default, and nothing else, but where another key requires it.
pub const SMALL: &str = r#"
    title = "defaults"
    gravity = { inclination_deg = 10 }
    grid = { spacing_m = 0.1, thickness_m = 1 }
    domain = { x_m = [0, 2], y_m = [0, 1] }
    materials.sand = { law = "drucker_prager", density_kg_per_m3 = 2000, young_pa = 1e8, poisson = 0.2, friction_angle_deg = 30 }
    materials.stone = { law = "linear_elastic", density_kg_per_m3 = 2600, young_pa = 1e8, poisson = 0.2 }
    bodies = [{ name = "a", material = "stone", x_m = [0, 1], y_m = [0, 0.5] }, { name = "b", material = "stone", foot_m = [1, 0], height_m = 0.5, thickness_m = 1 }, { name = "c", material = "sand", x_m = [0, 1], y_m = [0.5, 1] }]
    boundaries = [{ name = "gate", kind = "gate", foot_m = [2, 0], height_m = 1, contact = "rough" }]
    contacts = [{ bodies = ["a", "b"], friction = 0.1 }, { bodies = ["a", "c"], friction = 0.1, gap = "positions" }, { bodies = ["b", "c"], friction = 0.1 }]
    stages.settle = { damping_per_s = 60, residual = 1e-4, max_time_s = 5 }
    stages.run = { end_time_s = 1 }
"#;

#[test]
fn stated_defaults_are_those_in_force() {
    // What no case has together with the rest has one of its own.
    let [small, entering] = [SMALL, crate::scaffold::INFLOW].map(|text| {
        let loaded = case::parse(text, "small.toml").unwrap_or_else(|e| panic!("{e}"));
        let written: toml::Value = toml::from_str(text).expect("TOML");
        (toml::Value::try_from(&loaded.case).expect("TOML"), written)
    });
    for (name, schema, _) in both() {
        for (section, field) in values(&sections(&schema)) {
            let Some(stated) = stated(field) else { continue };
            let what = format!("{name}: {} {} = {stated} by default", section.header, field.key);
            // Serde's own.
            if let Some(default) = &field.default {
                let default = literal(&default.to_string()).unwrap_or_else(|| panic!("{what}: {default}"));
                assert!(same(&default, &stated), "{what}, but serde has {default}");
            } else {
                assert_eq!(name, "case", "{what}, and nothing says so");
            }
            // What a case has that leaves the key out.
            if name == "case" {
                let header = section.header.trim_matches(['[', ']']).replace("NAME", "sand");
                let (resolved, written) = if header == "inflows" { &entering } else { &small };
                let all = |value| tables(value, &header);
                let left_out = all(resolved).into_iter().zip(all_or_empty(written, &header, all(resolved).len()));
                let found: Vec<_> = left_out
                    .filter(|(_, written)| written.is_none_or(|table| table.get(&field.key).is_none()))
                    .filter_map(|(table, _)| table.get(&field.key))
                    .collect();
                assert!(!found.is_empty(), "{what}, and no case shows it");
                found.iter().for_each(|value| assert!(same(value, &stated), "{what}, but it is {value}"));
            }
        }
    }
}

/// The tables under a header: one, or the elements of a list.
fn tables<'a>(value: &'a toml::Value, header: &str) -> Vec<&'a toml::Value> {
    let mut now = vec![value];
    for word in header.split('.').filter(|word| !word.is_empty()) {
        now = now.into_iter().filter_map(|v| v.get(word)).collect();
        now = now.into_iter().flat_map(|v| v.as_array().map_or(vec![v], |list| list.iter().collect())).collect();
    }
    now
}

/// The same of a file that may leave a table out.
fn all_or_empty<'a>(value: &'a toml::Value, header: &str, count: usize) -> Vec<Option<&'a toml::Value>> {
    let mut found: Vec<_> = tables(value, header).into_iter().map(Some).collect();
    found.resize(count, None);
    found
}

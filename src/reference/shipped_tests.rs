//! Every case and every study of the project is valid by the schema that editors read, and schema and reader refuse the same.

use super::schema::Schema;
use super::tests::{SMALL, case_schema, root, study_schema};
use crate::case::{self, Case};
use crate::study::Study;
use serde::Deserialize;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use toml::Value;

/// Folders with case files and study files.
const FOLDERS: [&str; 4] = ["examples", "src/scaffold", "validation", "verification"];
/// Pages whose blocks `toml case` and `toml study` are cases and studies.
const PAGES: [&str; 5] = ["README.md", "CONTRIBUTING.md", "docs", "validation", "verification"];

/// A case or a study of the project.
struct Shipped {
    /// Where it stands.
    place: String,
    text: String,
    value: Value,
    is_study: bool,
}

impl Shipped {
    fn new(place: String, text: &str) -> Self {
        let value: Value = toml::from_str(text).unwrap_or_else(|e| panic!("{place}: {e}"));
        Self { place, text: text.to_owned(), is_study: value.get("cases").is_some(), value }
    }

    /// Whether the reader takes a value for such a file, before it asks whether its numbers make sense.
    fn is_read(&self, value: &Value) -> bool {
        let value = value.clone();
        if self.is_study { Study::deserialize(value).is_ok() } else { Case::deserialize(value).is_ok() }
    }
}

/// Files of this kind in a folder and below it, or the file itself.
fn files(path: &Path, kind: &str) -> Vec<PathBuf> {
    if path.is_file() {
        let wanted = path.extension().is_some_and(|end| end == kind) && !path.ends_with("Cargo.toml");
        return if wanted { vec![path.to_owned()] } else { Vec::new() };
    }
    let entries = std::fs::read_dir(path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    let mut found: Vec<PathBuf> = entries.flat_map(|e| files(&e.expect("an entry").path(), kind)).collect();
    found.sort();
    found
}

/// The cases and studies that a page prints.
fn blocks(page: &str) -> Vec<String> {
    let mut lines = page.lines();
    let mut found = Vec::new();
    while let Some(line) = lines.next() {
        let Some(kind) = line.strip_prefix("```") else { continue };
        let block: Vec<&str> = lines.by_ref().take_while(|line| *line != "```").collect();
        if ["toml case", "toml study"].contains(&kind) {
            found.push(block.join("\n"));
        }
    }
    found
}

fn shipped() -> Vec<Shipped> {
    let read = |file: &Path| std::fs::read_to_string(file).unwrap_or_else(|e| panic!("{}: {e}", file.display()));
    let below = |places: &[&str], kind: &str| -> Vec<PathBuf> {
        places.iter().flat_map(|place| files(&root().join(place), kind)).collect()
    };
    let mut all = Vec::new();
    for file in below(&FOLDERS, "toml") {
        all.push(Shipped::new(file.display().to_string(), &read(&file)));
    }
    for page in below(&PAGES, "md") {
        let printed = blocks(&read(&page)).into_iter().enumerate();
        all.extend(printed.map(|(k, text)| Shipped::new(format!("{}, block {}", page.display(), k + 1), &text)));
    }
    all
}

/// The schemas of cases and of studies.
struct Schemas {
    case: Schema,
    study: Schema,
}

impl Schemas {
    fn new() -> Self {
        Self { case: case_schema(), study: study_schema() }
    }

    /// What the schema of such a file refuses in a value.
    fn faults(&self, of: &Shipped, value: &Value) -> Vec<String> {
        let schema = if of.is_study { &self.study } else { &self.case };
        schema.faults(&schema.0, value, &of.place)
    }
}

#[test]
fn every_case_and_study_is_valid_by_its_schema() {
    let (schemas, all) = (Schemas::new(), shipped());
    let own = ["examples", "src/scaffold"].map(|folder| root().join(folder).display().to_string());
    for one in &all {
        assert_eq!(schemas.faults(one, &one.value), [""; 0]);
        // Those of other folders are run by the suites.
        if !one.is_study && own.iter().any(|folder| one.place.starts_with(folder)) {
            let loaded = case::parse(&one.text, &one.place).unwrap_or_else(|e| panic!("{e}"));
            assert_eq!(loaded.warnings, Vec::<String>::new());
        }
    }
    let studies = all.iter().filter(|one| one.is_study).count();
    assert!(studies >= 20 && all.len() - studies >= 20, "{} files, {studies} of them studies", all.len());
    for folder in FOLDERS.iter().chain(&["README.md", "docs"]) {
        let below = root().join(folder).display().to_string();
        assert!(all.iter().any(|one| one.place.starts_with(&below)), "nothing below {folder}");
    }
}

/// What a study sets in its cases is valid there.
#[test]
fn every_field_of_a_study_is_one_of_a_case() {
    let (schema, mut paths) = (case_schema(), BTreeSet::new());
    for one in shipped().iter().filter(|one| one.is_study) {
        let study = Study::parse(&one.text, &one.place).unwrap_or_else(|e| panic!("{e}"));
        let node = |path: &str| {
            let place = &one.place;
            schema.at_path(path).unwrap_or_else(|| panic!("{place}: no case has `{path}`"))
        };
        for (path, value) in set_by(&study) {
            assert_eq!(schema.faults(node(&path), &value, &format!("{}: {path}", one.place)), [""; 0]);
            paths.insert(path);
        }
        for path in unset_by(&study) {
            node(&path);
        }
    }
    assert!(paths.len() >= 40, "{paths:?}");
}

/// Every path in a case to which a study gives a value, and the value.
fn set_by(study: &Study) -> Vec<(String, Value)> {
    let mut tables = vec![&study.base.set, &study.base.append];
    tables.extend(study.variants.iter().flat_map(|variant| [&variant.set, &variant.append]));
    tables.extend(study.axes.iter().flat_map(|axis| &axis.levels).map(|level| &level.set));
    let sample = || study.sample.iter();
    tables.extend(sample().flat_map(|s| &s.choices).flat_map(|choice| &choice.options).map(|option| &option.set));
    let mut found: Vec<(String, Value)> = Vec::new();
    for axis in &study.axes {
        found.extend(axis.fields.iter().flat_map(|field| axis.values.iter().map(move |v| (field.clone(), v.clone()))));
    }
    for range in sample().flat_map(|s| &s.ranges) {
        let ends = [range.low, range.high].map(Value::Float);
        found.extend(range.fields.iter().flat_map(|field| ends.iter().map(move |v| (field.clone(), v.clone()))));
    }
    found.extend(tables.into_iter().flatten().map(|(path, value)| (path.clone(), value.clone())));
    found
}

/// Every path in a case that a study takes out.
fn unset_by(study: &Study) -> Vec<String> {
    let mut paths = study.base.unset.clone();
    paths.extend(study.variants.iter().flat_map(|variant| variant.unset.clone()));
    paths.extend(study.axes.iter().flat_map(|axis| &axis.levels).flat_map(|level| level.unset.clone()));
    let options = study.sample.iter().flat_map(|s| &s.choices).flat_map(|choice| &choice.options);
    paths.extend(options.flat_map(|option| option.unset.clone()));
    paths
}

/// A place in a file: keys, and numbers in lists.
type Place = Vec<String>;

/// All tables of a value, and all other values that stand at a key.
fn places(value: &Value, at: &Place, tables: &mut Vec<Place>, leaves: &mut Vec<Place>) {
    let below = |key: &str| at.iter().cloned().chain([key.to_owned()]).collect::<Place>();
    match value {
        Value::Table(table) => {
            tables.push(at.clone());
            table.iter().for_each(|(key, value)| places(value, &below(key), tables, leaves));
        }
        Value::Array(list) if list.iter().any(Value::is_table) => {
            list.iter().enumerate().for_each(|(k, value)| places(value, &below(&k.to_string()), tables, leaves));
        }
        _ => leaves.push(at.clone()),
    }
}

fn at<'a>(value: &'a mut Value, place: &[String]) -> &'a mut Value {
    place.iter().fold(value, |value, key| match value {
        Value::Array(list) => &mut list[key.parse::<usize>().expect("a number in a list")],
        other => other.get_mut(key.as_str()).expect("a key"),
    })
}

/// A key too many in any table, a key too few, a value of another kind: the schema refuses what the reader refuses, and takes what it
/// takes.
#[test]
fn schema_and_reader_refuse_the_same() {
    let (schemas, mut refused, mut taken) = (Schemas::new(), 0, 0);
    for one in shipped() {
        let mut tried = |value: &Value, what: String| {
            let (faults, read) = (schemas.faults(&one, value), one.is_read(value));
            assert_eq!(faults.is_empty(), read, "{}, {what}: the reader says {read}, the schema {faults:?}", one.place);
            *(if read { &mut taken } else { &mut refused }) += 1;
            read
        };
        let (mut tables, mut leaves) = (Vec::new(), Vec::new());
        places(&one.value, &Vec::new(), &mut tables, &mut leaves);
        for place in &tables {
            let mut wrong = one.value.clone();
            let table = at(&mut wrong, place).as_table_mut().expect("a table");
            let keys: Vec<String> = table.keys().cloned().collect();
            table.insert("no_such_key".into(), Value::Boolean(true));
            let read = tried(&wrong, format!("a wrong key in {place:?}"));
            let free = place.iter().any(|key| ["set", "append"].contains(&key.as_str()));
            assert_eq!(read, free, "{}: a wrong key in {place:?}", one.place);
            for key in keys {
                let mut less = one.value.clone();
                at(&mut less, place).as_table_mut().expect("a table").remove(&key);
                tried(&less, format!("{place:?} without {key}"));
            }
        }
        for place in &leaves {
            let other = [
                Value::Boolean(true),
                Value::String("other".into()),
                Value::Integer(-1),
                Value::Float(0.5),
                Value::Array(Vec::new()),
                Value::Table(toml::Table::new()),
            ];
            for other in other {
                let mut wrong = one.value.clone();
                *at(&mut wrong, place) = other.clone();
                tried(&wrong, format!("{place:?} = {other}"));
            }
        }
    }
    assert!(refused > 1000 && taken > 1000, "{refused} refused, {taken} taken");
}

#[test]
fn a_file_that_does_not_fit_is_found_out() {
    let schema = case_schema();
    let faults = |text: &str| schema.faults(&schema.0, &toml::from_str(text).expect("TOML"), "file");
    assert_eq!(faults(SMALL), [""; 0]);
    for (right, wrong) in [
        ("title =", "titel ="),
        ("spacing_m", "spacing"),
        ("\"linear_elastic\"", "\"x\""),
        ("x_m = [0, 2]", "x_m = [1]"),
        ("height_m = 1,", "height_m = \"1\","),
    ] {
        let text = SMALL.replacen(right, wrong, 1);
        assert!(text != SMALL && !faults(&text).is_empty(), "{wrong}");
    }
    assert!(case::parse(SMALL, "small.toml").is_ok());
    assert!(schema.at_path("boundaries.gate.opening").is_some() && schema.at_path("boundaries.gate.open").is_none());
    assert_eq!(schema.0["required"].as_array().map(Vec::len), Some(6), "{}", schema.0["required"]);
    assert!(!schema.0.to_string().contains("\"null\""));
}

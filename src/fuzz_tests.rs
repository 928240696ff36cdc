//! Case files with one value made absurd: each is refused with its line and a way out, or it runs.

use crate::case;
use crate::run::Experiment;
use crate::study::Study;
use std::fs;
use std::path::{Path, PathBuf};
use toml::Value;

/// Larger cases are not stepped.
const MOST_POINTS: f64 = 2.0e4;
const STEPS: usize = 3;

/// Case files, and study files: those of `src/scaffold` and `examples`.
fn files() -> [Vec<PathBuf>; 2] {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let found =
        ["src/scaffold", "examples"].iter().flat_map(|folder| fs::read_dir(root.join(folder)).expect("a folder"));
    let paths =
        found.map(|entry| entry.expect("an entry").path()).filter(|p| p.extension().is_some_and(|e| e == "toml"));
    let (mut cases, mut studies): (Vec<_>, Vec<_>) = paths.partition(|p| !p.ends_with("study.toml"));
    cases.sort();
    studies.sort();
    [cases, studies]
}

/// Ways to every value that is neither table nor list, and to every list: keys and indices.
fn leaves(value: &Value, at: &[String], found: &mut Vec<Vec<String>>) {
    let below = |key: String| [at, &[key]].concat();
    match value {
        Value::Table(table) => table.iter().for_each(|(key, value)| leaves(value, &below(key.clone()), found)),
        Value::Array(list) => {
            found.push(at.to_vec());
            list.iter().enumerate().for_each(|(k, value)| leaves(value, &below(k.to_string()), found));
        }
        _ => found.push(at.to_vec()),
    }
}

fn at<'a>(value: &'a mut Value, way: &[String]) -> &'a mut Value {
    way.iter().fold(value, |value, key| match value {
        Value::Table(table) => table.get_mut(key).expect("a key"),
        Value::Array(list) => &mut list[key.parse::<usize>().expect("an index")],
        _ => panic!("no way to {way:?}"),
    })
}

/// What one value of a document may be mistyped as, with the words of it; the last takes it out.
fn mutants(document: &Value, way: &[String]) -> Vec<(String, String)> {
    let of = |change: &dyn Fn(&mut Value)| {
        let mut changed = document.clone();
        change(at(&mut changed, way));
        toml::to_string(&changed).expect("TOML")
    };
    let mut all: Vec<(String, String)> = [
        Value::Float(0.0),
        Value::Integer(0),
        Value::Float(-1.0),
        Value::Integer(-3),
        Value::Float(f64::NAN),
        Value::Float(f64::INFINITY),
        Value::Float(1e308),
        Value::Float(-1e308),
        Value::Float(1e15),
        Value::Float(1e-308),
        Value::Integer(i64::MAX),
        Value::String("a \u{1b}[31m".into()),
        Value::String(String::new()),
        Value::Boolean(true),
        Value::Array(Vec::new()),
        Value::Table(toml::Table::new()),
    ]
    .into_iter()
    .map(|v| (v.to_string(), of(&|place| *place = v.clone())))
    .collect();
    all.push((
        "negative".into(),
        of(&|place| {
            if let Value::Float(x) = place {
                *x = -*x
            }
            if let Value::Integer(x) = place {
                *x = -*x
            }
        }),
    ));
    all.push(("in a list".into(), of(&|place| *place = Value::Array(vec![place.clone()]))));
    if let Some((key, parent)) = way.split_last() {
        let mut changed = document.clone();
        match at(&mut changed, parent) {
            Value::Table(table) => drop(table.remove(key)),
            Value::Array(list) => drop(list.remove(key.parse::<usize>().expect("an index"))),
            _ => {}
        }
        all.push(("missing".into(), toml::to_string(&changed).expect("TOML")));
    }
    all
}

fn document(path: &Path) -> Value {
    Value::Table(fs::read_to_string(path).expect("a file").parse().expect("TOML"))
}

/// A report names the file, a line where there is one, and a way out.
fn is_told(report: &str) -> bool {
    let placed = report.contains("mutant.toml:") || report.contains(" is missing");
    placed && report.contains("error: ") && report.contains(" = fix: ") && !report.contains('\u{1b}')
}

#[test]
fn a_case_with_one_absurd_value_is_refused_or_runs() {
    let [cases, _] = files();
    assert!(cases.len() >= 3, "{cases:?}");
    let (mut refused, mut ran) = (0, 0);
    for path in &cases {
        let document = document(path);
        let mut ways = Vec::new();
        leaves(&document, &[], &mut ways);
        // Half of those that are accepted: the cases share most of their keys.
        for (k, way) in ways.iter().enumerate() {
            for (m, (what, text)) in mutants(&document, way).into_iter().enumerate() {
                match case::parse(&text, "mutant.toml") {
                    Err(error) => {
                        refused += 1;
                        assert!(is_told(&error.to_string()), "{}: {way:?} = {what}\n{error}", path.display());
                    }
                    Ok(loaded) if (k + m).is_multiple_of(2) && loaded.case.particle_count_estimate() <= MOST_POINTS => {
                        ran += 1;
                        println!("{}: {way:?} = {what}", path.display());
                        let mut experiment = Experiment::new(&loaded.case);
                        let stopped = (0..STEPS).find_map(|_| experiment.step().err());
                        assert!(stopped.is_none_or(|error| !error.to_string().is_empty()));
                    }
                    Ok(_) => {}
                }
            }
        }
    }
    println!("{refused} refused, {ran} ran");
    assert!(refused > 3000 && ran > 200, "{refused} refused, {ran} ran");
}

#[test]
fn a_study_with_one_absurd_value_is_refused_or_planned() {
    let [_, studies] = files();
    assert!(!studies.is_empty());
    let mut refused = 0;
    for path in &studies {
        let document = document(path);
        let mut ways = Vec::new();
        leaves(&document, &[], &mut ways);
        for way in ways.iter().take(60) {
            for (what, text) in mutants(&document, way) {
                if let Err(error) = Study::parse(&text, "mutant.toml") {
                    refused += 1;
                    assert!(is_told(&error.to_string()), "{}: {way:?} = {what}\n{error}", path.display());
                }
            }
        }
    }
    assert!(refused > 300, "{refused}");
}

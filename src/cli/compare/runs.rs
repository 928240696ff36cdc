//! Two runs: their summaries, and their tables over time.

use super::judge::Line;
use super::series::{Common, is_series, scale_of};
use super::{Comparison, Wanted};
use crate::folder::{Leaf, Run};
use checkdam::check::brief;
use checkdam::output::Table;
use std::collections::BTreeSet;

/// Texts with numbers in them, and what names the program: told, and never counted.
const TOLD: [&str; 3] = ["checkdam_version", "reasons", "warnings"];

/// Numbers that are what is left of larger ones, as shares of these: differences count as such shares.
pub const SHARES: [&str; 6] = [
    "settle_residual",
    "residual_end_1",
    "energy_residual_1",
    "residual_of_released_1",
    "momentum_closure_1",
    "imbalance_1",
];

/// Other numbers that are what is left of larger ones, and these.
const LEFT_OF: [(&str, &str); 2] =
    [("equilibrium_residual_n", "weight_along_n"), ("static_force_drift_n", "static_force_n")];

/// Compares two runs.
pub fn compare(runs: [&Run; 2], wanted: &Wanted, tolerance: f64) -> Result<Comparison, String> {
    let mut found = Comparison::default();
    inputs(runs, &mut found);
    summaries(runs, wanted, &mut found);
    let names = [runs[0].tables()?, runs[1].tables()?];
    let all: BTreeSet<_> = names.iter().flatten().map(|name| (name != "history.csv", name.clone())).collect();
    for (_, name) in all {
        let there = [0, 1].map(|side| names[side].contains(&name));
        if let Some(side) = there.iter().position(|there| !there) {
            if wanted.everything() {
                found.lines.push(Line::missing(name, "a table", side));
            }
            continue;
        }
        let tables = [runs[0].table(&name)?, runs[1].table(&name)?];
        let tables = [&tables[0], &tables[1]];
        if !tables.iter().all(|table| is_series(table)) {
            whole(runs, &name, wanted, tolerance, &mut found)?;
            continue;
        }
        over_time(&name, tables, wanted, &mut found);
    }
    Ok(found)
}

/// What the cases have that differs.
fn inputs(runs: [&Run; 2], found: &mut Comparison) {
    let [a, b] = runs.map(Run::case);
    let fields = merged([&a, &b]);
    for field in fields {
        let values = [&a, &b].map(|case| case.iter().find(|(path, _)| *path == field).map(|(_, leaf)| leaf));
        if values[0] != values[1] {
            let [a, b] = values.map(|leaf| leaf.map_or_else(|| "not there".to_owned(), ToString::to_string));
            found.inputs.push(format!("{field}: {a}, {b}"));
        }
    }
}

/// The paths of both, in the order of the first with those of the second alone behind.
fn merged(lists: [&[(String, Leaf)]; 2]) -> Vec<String> {
    let mut seen = BTreeSet::new();
    let all = lists.into_iter().flatten().map(|(path, _)| path.clone());
    all.filter(|path| seen.insert(path.clone())).collect()
}

fn summaries(runs: [&Run; 2], wanted: &Wanted, found: &mut Comparison) {
    let results = runs.map(Run::results);
    for path in merged([&results[0], &results[1]]) {
        let of = |side: usize, path: &str| results[side].iter().find(|(other, _)| other == path).map(|(_, leaf)| leaf);
        let told = TOLD.iter().any(|name| path.split(['.', '[']).next() == Some(*name));
        if told {
            if of(0, &path) != of(1, &path) {
                let [a, b] = [0, 1].map(|side| of(side, &path).map_or("-".into(), ToString::to_string));
                found.told.push(format!("{path}\n    A: {a}\n    B: {b}"));
            }
            continue;
        }
        let (above, name) = path.rsplit_once('.').unwrap_or(("", &path));
        if !wanted.has(&[&path, name]) {
            continue;
        }
        found.lines.push(match [of(0, &path), of(1, &path)] {
            [Some(Leaf::Number(a)), Some(Leaf::Number(b))] => {
                let sibling = LEFT_OF.iter().find(|(left, _)| *left == name).map(|(_, of)| *of);
                let beside = sibling.and_then(|of_name| match of(0, &format!("{above}.{of_name}")) {
                    Some(Leaf::Number(size)) => Some((*size, of_name)),
                    _ => None,
                });
                match beside {
                    _ if SHARES.contains(&name) => Line::scaled(&path, [*a, *b], 1.0).noted("of the whole"),
                    Some((size, of)) => Line::scaled(&path, [*a, *b], size).noted(format!("of {of}")),
                    None => Line::numbers(&path, [*a, *b]),
                }
            }
            [Some(a), Some(b)] => Line::texts(&path, [&a.to_string(), &b.to_string()]),
            [Some(a), None] => Line::missing(&path, a.to_string(), 1),
            [None, Some(b)] => Line::missing(&path, b.to_string(), 0),
            [None, None] => continue,
        });
    }
}

/// A table that has not one row a time: the same bytes or not. It counts where nothing may differ.
fn whole(runs: [&Run; 2], name: &str, wanted: &Wanted, tolerance: f64, found: &mut Comparison) -> Result<(), String> {
    let read =
        |run: &Run| std::fs::read(run.path.join(name)).map_err(|error| format!("{name} cannot be read: {error}"));
    let same = read(runs[0])? == read(runs[1])?;
    match () {
        () if !wanted.everything() || same => {}
        () if tolerance == 0.0 => {
            found.lines.push(Line::texts(name, ["a table", "another"]).noted("not the same bytes"))
        }
        () => found.told.push(format!("{name} differs and is not compared: it has not one row a time")),
    }
    Ok(())
}

/// Every column of a table over time.
fn over_time(name: &str, tables: [&Table; 2], wanted: &Wanted, found: &mut Comparison) {
    let mut columns: Vec<&String> = Vec::new();
    for column in tables.iter().flat_map(|table| table.names()) {
        if column != "time_s" && !columns.contains(&column) {
            columns.push(column);
        }
    }
    columns.retain(|column| wanted.has(&[&format!("{name}:{column}"), column]));
    if columns.is_empty() {
        return;
    }
    let Some(common) = Common::of(tables) else {
        found.lines.push(Line::numbers(name, [f64::NAN; 2]).noted("no times in common"));
        return;
    };
    if !common.note.is_empty() {
        found.told.push(format!("{name}: {}; compared where both have times", common.note));
    }
    for column in columns {
        found.lines.push(common.line(format!("{name}:{column}"), column, tables, whole_of(column, tables)));
    }
}

/// What a residual is what is left of: the widest range of the other columns of its unit. None for columns that are no residuals.
fn whole_of(column: &str, tables: [&Table; 2]) -> Option<f64> {
    if column == "imbalance" {
        return Some(1.0);
    }
    let unit = column.strip_prefix("residual")?.trim_start_matches("_x").trim_start_matches("_y");
    let others = tables[0].names().iter().filter(|name| name.ends_with(unit) && !name.starts_with("residual"));
    let ranges = others.filter_map(|name| Some(scale_of([tables[0].column(name).ok()?, tables[1].column(name).ok()?])));
    Some(ranges.fold(0.0, f64::max))
}

/// The end of a run in a few words, for the head of the comparison.
pub fn described(run: &Run) -> String {
    let text = |key: &str| {
        run.summary.get(key).map_or_else(String::new, |value| match value.as_str() {
            Some(text) => text.to_owned(),
            None => value.to_string(),
        })
    };
    let title = run.summary.get("case").and_then(|case| case.get("title")).and_then(toml::Value::as_str);
    let end = run.summary.get("stepping").and_then(|s| s.get("end_s")).and_then(toml::Value::as_float);
    format!(
        "{} ({}; {}; ends at {} s; trusted = {})",
        run.path.display(),
        title.unwrap_or_default(),
        text("status"),
        end.map_or_else(|| "?".into(), brief),
        text("trusted")
    )
}

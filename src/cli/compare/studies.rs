//! Two studies: their rows by what was varied.

use super::judge::{Finding, Line, relative};
use super::runs::SHARES;
use super::{Comparison, Wanted};
use checkdam::output::Table;
use std::collections::BTreeMap;

/// The column that ends what names a row; it is made of all inputs of the run.
const KEY: &str = "key";
/// Columns of text behind it.
const TEXTS: [&str; 2] = ["ended", "trusted"];

/// The names of rows, and where they stand.
type Rows = BTreeMap<Vec<String>, usize>;

/// Compares two tables of studies.
pub fn compare(tables: [&Table; 2], wanted: &Wanted) -> Result<Comparison, String> {
    let mut found = Comparison::default();
    let named = [naming(tables[0])?, naming(tables[1])?];
    if named[0] != named[1] {
        return Err(format!(
            "the studies do not vary the same: A has {}, B has {}\n  = fix: compare studies with the same axes and ranges",
            named[0].join(", "),
            named[1].join(", ")
        ));
    }
    let order = cells(tables[0], named[0])?;
    let rows = [by_name(tables[0], named[0])?, by_name(tables[1], named[0])?];
    let mut pairs: Vec<(String, [usize; 2])> = Vec::new();
    for name in order {
        match rows[1].get(&name) {
            Some(b) => pairs.push((shown(named[0], &name), [rows[0][&name], *b])),
            None => found.lines.push(Line::missing(shown(named[0], &name), "a run", 1)),
        }
    }
    for name in rows[1].keys().filter(|name| !rows[0].contains_key(*name)) {
        found.lines.push(Line::missing(shown(named[0], name), "a run", 0));
    }
    if pairs.is_empty() {
        found.lines.push(Line::numbers("runs", [f64::NAN; 2]).noted("no run in common"));
        return Ok(found);
    }
    let keys = [text(tables[0], KEY)?, text(tables[1], KEY)?];
    let changed = pairs.iter().filter(|(_, [a, b])| keys[0][*a] != keys[1][*b]).count();
    if changed > 0 {
        found
            .inputs
            .push(format!("inputs of {changed} of {} runs, by their keys; a run of its own says which", pairs.len()));
    }
    for column in TEXTS {
        let cells = [text(tables[0], column)?, text(tables[1], column)?];
        for (run, [a, b]) in pairs.iter().filter(|(_, [a, b])| cells[0][*a] != cells[1][*b]) {
            found.lines.push(Line::texts(column, [&cells[0][*a], &cells[1][*b]]).noted(run));
        }
    }
    numbers(tables, &pairs, wanted, &mut found)?;
    Ok(found)
}

/// The columns that name a row: those before its key.
fn naming(table: &Table) -> Result<&[String], String> {
    let end = table.names().iter().position(|name| name == KEY);
    let end =
        end.ok_or_else(|| format!("{} is no table of a study: it has no column `{KEY}`", table.path().display()))?;
    Ok(&table.names()[..end])
}

fn text(table: &Table, column: &str) -> Result<Vec<String>, String> {
    table.cells(column).map_err(|error| error.to_string())
}

/// The names of all rows, in order.
fn cells(table: &Table, named: &[String]) -> Result<Vec<Vec<String>>, String> {
    let columns = named.iter().map(|name| text(table, name)).collect::<Result<Vec<_>, _>>()?;
    Ok((0..table.rows()).map(|row| columns.iter().map(|column| column[row].clone()).collect()).collect())
}

fn by_name(table: &Table, named: &[String]) -> Result<Rows, String> {
    let mut rows = Rows::new();
    for (row, name) in cells(table, named)?.into_iter().enumerate() {
        if rows.insert(name.clone(), row).is_some() {
            return Err(format!("{} has two rows of {}", table.path().display(), shown(named, &name)));
        }
    }
    Ok(rows)
}

/// A row by what it varies.
fn shown(named: &[String], name: &[String]) -> String {
    let parts = named.iter().zip(name).filter(|(_, value)| !value.is_empty());
    parts.map(|(column, value)| format!("{column} {value}")).collect::<Vec<_>>().join(", ")
}

/// Every column of numbers: the row in which it differs most.
fn numbers(
    tables: [&Table; 2],
    pairs: &[(String, [usize; 2])],
    wanted: &Wanted,
    found: &mut Comparison,
) -> Result<(), String> {
    let mut columns: Vec<&String> = Vec::new();
    for table in tables {
        let named = naming(table)?.len() + 1;
        let measured = table.names()[named..].iter().filter(|name| !TEXTS.contains(&name.as_str()));
        for column in measured {
            if !columns.contains(&column) {
                columns.push(column);
            }
        }
    }
    for column in columns.into_iter().filter(|column| wanted.has(&[column])) {
        let there = tables.map(|table| table.names().contains(column));
        if let Some(side) = there.iter().position(|there| !there) {
            found.lines.push(Line::missing(column, "a column", side));
            continue;
        }
        let read = |table: &Table| table.column(column).map(<[f64]>::to_vec).map_err(|error| error.to_string());
        let values = [read(tables[0])?, read(tables[1])?];
        let mut worst: Option<Line> = None;
        let mut neither = 0;
        for (run, [a, b]) in pairs {
            let pair = [values[0][*a], values[1][*b]];
            if pair.iter().all(|value| value.is_nan()) {
                neither += 1;
                continue;
            }
            let scale = if SHARES.contains(&column.as_str()) { 1.0 } else { pair[0] };
            let line = match relative(pair[0], pair[1], scale) {
                Some(_) => Line::scaled(column, pair, scale),
                None if pair[0].is_nan() => Line::missing(column, pair[1].to_string(), 0),
                None => Line::missing(column, pair[0].to_string(), 1),
            };
            if worst.as_ref().is_none_or(|worst| size(&line) > size(worst)) {
                worst = Some(line.noted(run));
            }
        }
        let empty = if neither > 0 { format!("empty on both sides in {neither} runs") } else { String::new() };
        found.lines.push(match worst {
            None => Line::texts(column, ["no value", "no value"]).noted("nothing to compare: empty on both sides"),
            Some(line) => {
                let run = if size(&line) == 0.0 { "" } else { &line.note };
                let note = [run, &empty].into_iter().filter(|part| !part.is_empty()).collect::<Vec<_>>().join("; ");
                line.noted(note)
            }
        });
    }
    Ok(())
}

/// How much a line differs; what cannot be compared differs most.
fn size(line: &Line) -> f64 {
    match line.finding {
        Finding::Relative(difference) => difference.abs(),
        _ => f64::INFINITY,
    }
}

//! The table of an experiment, `published.csv`, read cell by cell so that what is wrong is named with its line.

use super::number::{Number, Reduction};
use super::{ExperimentError, Row};
use crate::data::{Datum, KINDS};
use checkdam::study::PlannedRun;
use std::collections::BTreeSet;

/// Columns that a table must have; `note`, `angle_deg` and `reduction` may be left out.
const NEEDED: [&str; 10] = ["case", "quantity", "value", "unit", "kind", "uncertainty", "where", "how", "id", "ours"];

/// What is wrong, and what to do.
type Wrong = [String; 2];

/// The rows of a table.
///
/// # Errors
/// The first line that is not as it should be.
pub fn rows(text: &str, path: &str, plan: &[PlannedRun]) -> Result<Vec<Row>, ExperimentError> {
    let fail = |line: Option<u64>, [what, fix]: Wrong| ExperimentError::Table { path: path.into(), line, what, fix };
    let mut reader = csv::Reader::from_reader(text.as_bytes());
    let header: Vec<String> =
        reader.headers().map(|h| h.iter().map(String::from).collect()).map_err(|e| fail(Some(1), unreadable(&e)))?;
    if let Some(missing) = NEEDED.iter().find(|c| !header.iter().any(|h| h == *c)) {
        let fix = format!("the first line names at least {}", NEEDED.join(","));
        return Err(fail(Some(1), [format!("there is no column `{missing}`"), fix]));
    }
    let (mut rows, mut names) = (Vec::new(), BTreeSet::new());
    for record in reader.into_records() {
        let record = record.map_err(|e| fail(e.position().map(csv::Position::line), unreadable(&e)))?;
        let line = record.position().map(csv::Position::line);
        let cell = |name: &str| header.iter().position(|h| h == name).and_then(|k| record.get(k)).unwrap_or_default();
        let row = row(&cell, plan).map_err(|wrong| fail(line, wrong))?;
        if !names.insert(row.datum.id.clone()) {
            let wrong = [format!("the id `{}` stands twice", row.datum.id), "give every row a name of its own".into()];
            return Err(fail(line, wrong));
        }
        rows.push(row);
    }
    if rows.iter().all(|r| r.number.is_none()) {
        let fix = "say in `ours` where our number stands, in at least one row".into();
        return Err(fail(None, ["nothing in it has a counterpart".into(), fix]));
    }
    Ok(rows)
}

fn unreadable(error: &csv::Error) -> Wrong {
    [
        format!("it cannot be read: {error}"),
        "every line has as many cells as the first; a cell with a comma stands in double quotes".into(),
    ]
}

/// A row from its cells.
fn row<'a>(cell: &dyn Fn(&str) -> &'a str, plan: &[PlannedRun]) -> Result<Row, Wrong> {
    let number = |name: &str| {
        let text = cell(name);
        let wrong =
            || [format!("`{name}` is `{text}`, which is no number"), "write it like 0.0474, without its unit".into()];
        text.trim().parse::<f64>().ok().filter(|x| x.is_finite()).ok_or_else(wrong)
    };
    for name in ["case", "quantity", "unit", "where", "how", "id"] {
        if cell(name).trim().is_empty() {
            let fix = match name {
                "where" => "say where the number stands: authors, year, page or figure",
                "how" => "say how it was read and how its uncertainty was estimated",
                "unit" => "give its unit; 1 where it has none",
                _ => "fill it in",
            };
            return Err([format!("`{name}` is empty"), fix.into()]);
        }
    }
    let (value, uncertainty) = (number("value")?, number("uncertainty")?);
    if uncertainty <= 0.0 {
        let fix =
            "give the half width of the interval in which the number lies, at least half a unit of its last digit";
        return Err([format!("`uncertainty` is `{}`", cell("uncertainty")), fix.into()]);
    }
    if !KINDS.contains(&cell("kind")) {
        return Err([format!("`kind` is `{}`", cell("kind")), format!("write one of {}", KINDS.join(", "))]);
    }
    let angle_deg = if cell("angle_deg").is_empty() { None } else { Some(number("angle_deg")?) };
    let ours = cell("ours");
    let counterpart = if ours.is_empty() { None } else { Some(Number::parse(ours, cell("reduction"))?) };
    if let Some(counterpart) = &counterpart {
        let own: Vec<&PlannedRun> = plan.iter().filter(|r| r.case_name == cell("case")).collect();
        if own.is_empty() {
            let known: BTreeSet<&str> = plan.iter().map(|r| r.case_name.as_str()).collect();
            let known = known.into_iter().collect::<Vec<_>>().join(", ");
            let what = format!("the study runs no case `{}`", cell("case"));
            return Err([what, format!("write the name of a case file without .toml: {known}; or leave `ours` empty")]);
        }
        own.iter().try_for_each(|run| recorded(counterpart, run))?;
    }
    let text = |name: &str| cell(name).to_string();
    let datum = Datum {
        case: text("case"),
        quantity: text("quantity"),
        value,
        unit: text("unit"),
        kind: text("kind"),
        uncertainty,
        angle_deg,
        place: text("where"),
        how: text("how"),
        note: text("note"),
        id: text("id"),
        ours: None,
    };
    Ok(Row { datum, number: counterpart })
}

/// Whether a run records what a row asks for, as far as its case says so.
fn recorded(number: &Number, run: &PlannedRun) -> Result<(), Wrong> {
    let Number::Recorded { table, reduction: Reduction { only, .. }, .. } = number else { return Ok(()) };
    let gauges = &run.case.gauges;
    let unset = |what: &str, fix: String| Err([format!("{} records no {what}", run.what), fix]);
    match (table.as_str(), only) {
        ("stations", None) if gauges.stations_m.is_empty() => {
            unset("stations", "set gauges.stations_m in the case file".into())
        }
        ("stations", Some((column, x)))
            if column == "x_m" && !gauges.stations_m.iter().any(|s| (s - x).abs() <= 1e-9 * x.abs().max(1e-3)) =>
        {
            unset(&format!("station at x = {x} m"), format!("add {x} to gauges.stations_m in the case file"))
        }
        ("pressure_profile" | "barrier" | "barrier_profile" | "barrier_profile_at_peak", _)
            if gauges.barrier_names().next().is_none() =>
        {
            unset(&format!("table `{table}`"), "name the barrier in gauges.barrier of the case file".into())
        }
        ("barrier" | "barrier_profile" | "barrier_profile_at_peak", _)
            if !gauges.barrier_names().any(|name| run.case.bodies.iter().any(|b| b.name == name)) =>
        {
            let fix = "name a body in gauges.barrier of the case file, or read history or pressure_profile".into();
            unset(&format!("table `{table}`, since its barrier is a boundary"), fix)
        }
        ("pressure_profile" | "barrier_profile", _) if run.case.output.vtk_interval_s == 0.0 => {
            unset(&format!("row of `{table}`"), "set output.vtk_interval_s in the case file".into())
        }
        ("contact", _) if run.case.contacts.is_empty() => {
            unset("table `contact`", "it is that of two bodies in [[contacts]]".into())
        }
        ("field", _) if gauges.field_times_s.is_empty() => {
            unset("field", "set gauges.field_times_s in the case file".into())
        }
        _ => Ok(()),
    }
}

//! The tidy table of a study: a row per run.

use super::plan::PlannedRun;
use super::quantities::QUANTITIES;
use crate::check::significant;
use crate::seeded::{self, Seed};
use std::collections::{BTreeMap, BTreeSet};

/// Significant digits of the quantities.
const DIGITS: usize = 9;
/// Columns before those of what varies.
const FIRST: [&str; 4] = ["case", "factor", "label", "replicate"];
/// Columns between what varies and the quantities.
const MIDDLE: [&str; 3] = ["key", "ended", TRUSTED];
/// What `ended` begins with in a run that failed.
const FAILED: &str = "failed";
/// Whether the numbers of a run are to be trusted: true, false, or empty where it failed.
pub const TRUSTED: &str = "trusted";

/// A finished run: how it ended and what was measured.
#[derive(Debug, Clone, PartialEq)]
pub struct Row {
    /// "at rest", "end time", or why it failed.
    pub ended: String,
    /// "true" or "false": whether its numbers are to be trusted; empty if it failed.
    pub trusted: String,
    /// Values of [`QUANTITIES`], as text; empty cells where there is none.
    pub values: Vec<String>,
}

impl Row {
    /// Of numbers.
    pub fn new(ended: &str, trusted: bool, numbers: &[f64]) -> Self {
        let digits = if seeded::is(Seed::StudyDigits) { 2 } else { DIGITS };
        let text = |x: &f64| if x.is_finite() { significant(*x, digits) } else { String::new() };
        Self { ended: ended.into(), trusted: trusted.to_string(), values: numbers.iter().map(text).collect() }
    }

    /// Of a run that failed.
    pub fn failed(reason: &str) -> Self {
        let reason = reason.split_whitespace().collect::<Vec<_>>().join(" ");
        let values = vec![String::new(); QUANTITIES.len()];
        Self { ended: format!("{FAILED}: {reason}"), trusted: String::new(), values }
    }

    /// Whether the run came to its end.
    pub fn is_complete(&self) -> bool {
        !self.ended.starts_with(FAILED)
    }
}

/// Finished runs by key, and the table that they make.
#[derive(Debug, Clone)]
pub struct Runs {
    columns: Vec<String>,
    rows: BTreeMap<String, Row>,
}

impl Runs {
    /// None yet, of a study with these columns.
    pub fn new(columns: &[&str]) -> Self {
        Self { columns: columns.iter().map(ToString::to_string).collect(), rows: BTreeMap::new() }
    }

    /// Columns of the table with those quantities that are `used`.
    fn header(&self, used: &[bool]) -> Vec<String> {
        let first = FIRST.iter().map(ToString::to_string).chain(self.columns.iter().cloned());
        let measured = QUANTITIES.iter().zip(used).filter(|(_, used)| **used).map(|(q, _)| q.name.to_string());
        first.chain(MIDDLE.iter().map(ToString::to_string)).chain(measured).collect()
    }

    /// The row of a run, if it is finished.
    pub fn get(&self, run: &PlannedRun) -> Option<&Row> {
        self.rows.get(&run.key)
    }

    /// Adds a row.
    pub fn insert(&mut self, run: &PlannedRun, row: Row) {
        self.rows.insert(run.key.clone(), row);
    }

    /// Runs that failed are as if they had not been tried: they are tried again.
    pub fn forget_failed(&mut self) {
        self.rows.retain(|_, row| row.is_complete());
    }

    /// The table of the runs that are finished, in the order of the plan.
    pub fn csv(&self, plan: &[PlannedRun]) -> String {
        // Quantities that no run has, as those of a bending barrier where there is none, are left out.
        let rows: Vec<&Row> = plan.iter().filter_map(|run| self.get(run)).collect();
        let used: Vec<bool> = (0..QUANTITIES.len())
            .map(|k| rows.iter().any(|r| r.values.get(k).is_some_and(|v| !v.is_empty())))
            .collect();
        written(|writer| {
            writer.write_record(self.header(&used))?;
            for run in plan {
                let Some(row) = self.get(run) else { continue };
                let replicate = run.replicate.to_string();
                let first = [&run.case_name, &run.factor, &run.label, &replicate].map(String::as_str);
                let values = run.values.iter().map(String::as_str);
                let middle = [run.key.as_str(), row.ended.as_str(), row.trusted.as_str()];
                let measured = row.values.iter().zip(&used).filter(|(_, used)| **used).map(|(v, _)| v.as_str());
                writer.write_record(first.into_iter().chain(values).chain(middle).chain(measured))?;
            }
            Ok(())
        })
    }

    /// The table of all runs that a plan asks for: number from 1, key, what varies, and the `build` that is to run them.
    pub fn manifest(&self, plan: &[PlannedRun], build: &str) -> String {
        written(|writer| {
            let columns = self.columns.iter().map(String::as_str);
            writer.write_record(["number", "key"].into_iter().chain(FIRST).chain(columns).chain(["build"]))?;
            for run in plan {
                let (number, replicate) = ((run.number + 1).to_string(), run.replicate.to_string());
                let first =
                    [&number, &run.key, &run.case_name, &run.factor, &run.label, &replicate].map(String::as_str);
                writer.write_record(first.into_iter().chain(run.values.iter().map(String::as_str)).chain([build]))?;
            }
            Ok(())
        })
    }
}

fn written(write: impl FnOnce(&mut csv::Writer<Vec<u8>>) -> csv::Result<()>) -> String {
    let mut writer = csv::Writer::from_writer(Vec::new());
    let written = write(&mut writer);
    // Writing to memory fails only if rows differ in length, which the types above exclude.
    debug_assert!(written.is_ok(), "{written:?}");
    writer.into_inner().ok().and_then(|bytes| String::from_utf8(bytes).ok()).unwrap_or_default()
}

/// Whether a table had something that the one in its place has not: a row, or a number in it. Runs that failed do not count; what is no
/// table of a study does.
pub fn has_lost(before: &[u8], now: &str) -> bool {
    if before.is_empty() {
        return false;
    }
    match (cells(before), cells(now.as_bytes())) {
        (Some(before), Some(now)) => !before.iter().all(|row| is_failed(row) || now.contains(row)),
        _ => true,
    }
}

/// A row as cells that are not empty, by their columns.
type Cells = BTreeMap<String, String>;

fn is_failed(row: &Cells) -> bool {
    row.get("ended").is_some_and(|ended| ended.starts_with(FAILED))
}

/// The rows of a table of a study; none if it is something else.
fn cells(table: &[u8]) -> Option<BTreeSet<Cells>> {
    let mut reader = csv::Reader::from_reader(table);
    let header = reader.headers().ok()?.clone();
    if !FIRST.iter().chain(&MIDDLE).all(|name| header.iter().any(|h| h == *name)) {
        return None;
    }
    let row = |record: csv::StringRecord| {
        let named = header.iter().zip(&record).filter(|(_, cell)| !cell.is_empty());
        named.map(|(name, cell)| (name.to_string(), cell.to_string())).collect()
    };
    reader.records().map(|record| record.ok().map(row)).collect()
}

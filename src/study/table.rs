//! The tidy table of a study: a row per run.

use super::plan::{PlannedRun, fingerprint};
use super::quantities::QUANTITIES;
use crate::check::significant;
use crate::output::{OutputError, write_text};
use crate::seeded::{self, Seed};
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

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

/// Finished runs by key; they are kept on disk as the table of the study.
#[derive(Debug)]
pub struct Runs {
    /// Where they are kept; nowhere if in memory only.
    path: Option<PathBuf>,
    columns: Vec<String>,
    rows: BTreeMap<String, Row>,
    /// What stood there, until the first save.
    before: String,
    /// Where what stood there was put, if the table lost rows of it.
    aside: Option<PathBuf>,
}

impl Runs {
    /// None yet, and none kept on disk.
    pub fn in_memory(columns: &[&str]) -> Self {
        let columns = columns.iter().map(ToString::to_string).collect();
        Self { path: None, columns, rows: BTreeMap::new(), before: String::new(), aside: None }
    }

    /// What an earlier run of a study with these columns left at `path`; nothing if there is no such table, or if another
    /// build of the program made it. Runs that failed are forgotten: they are tried again. A table of which rows would be lost is put
    /// beside the new one ([`Self::aside`]).
    pub fn open(path: &Path, columns: &[&str]) -> Self {
        let before = std::fs::read_to_string(path).unwrap_or_default();
        let mut runs = Self { path: Some(path.to_path_buf()), before, ..Self::in_memory(columns) };
        if !std::fs::read_to_string(program_file(path)).is_ok_and(|text| text == program()) {
            return runs;
        }
        let text = runs.before.clone();
        let mut reader = csv::Reader::from_reader(text.as_bytes());
        let Ok(header) = reader.headers().cloned() else { return runs };
        if header.iter().take(FIRST.len() + runs.columns.len() + MIDDLE.len()).eq(runs.header(&[]).iter()) {
            let at = FIRST.len() + runs.columns.len();
            let places: Vec<_> = QUANTITIES.iter().map(|q| header.iter().position(|h| h == q.name)).collect();
            for record in reader.records().filter_map(Result::ok) {
                let value = |place: &Option<usize>| place.and_then(|k| record.get(k)).unwrap_or_default().to_string();
                let values = places.iter().map(value).collect();
                let row = Row { ended: record[at + 1].to_string(), trusted: record[at + 2].to_string(), values };
                if row.is_complete() {
                    runs.rows.insert(record[at].to_string(), row);
                }
            }
        }
        runs
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

    /// The table of the runs that are finished, in the order of the plan.
    pub fn csv(&self, plan: &[PlannedRun]) -> String {
        let mut writer = csv::Writer::from_writer(Vec::new());
        // Quantities that no run has, as those of a bending barrier where there is none, are left out.
        let rows: Vec<&Row> = plan.iter().filter_map(|run| self.get(run)).collect();
        let used: Vec<bool> = (0..QUANTITIES.len())
            .map(|k| rows.iter().any(|r| r.values.get(k).is_some_and(|v| !v.is_empty())))
            .collect();
        let written = (|| -> csv::Result<()> {
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
        })();
        // Writing to memory fails only if rows differ in length, which the types above exclude.
        debug_assert!(written.is_ok(), "{written:?}");
        writer.into_inner().ok().and_then(|bytes| String::from_utf8(bytes).ok()).unwrap_or_default()
    }

    /// Puts the table in its place, whole. What stood there is kept beside it if it has finished runs that the new one has not.
    ///
    /// # Errors
    /// The table cannot be written; what stood there is unchanged.
    pub fn save(&mut self, plan: &[PlannedRun]) -> Result<(), OutputError> {
        let Some(path) = &self.path else { return Ok(()) };
        let kept: BTreeSet<&str> = plan.iter().filter(|r| self.get(r).is_some()).map(|r| r.key.as_str()).collect();
        if finished(&self.before).iter().any(|key| !kept.contains(key.as_str())) {
            let aside = free_place(path);
            write_text(&aside, &self.before)?;
            self.aside = Some(aside);
        }
        self.before = String::new();
        write_text(program_file(path), program())?;
        write_text(path, &self.csv(plan))
    }

    /// Where the table was put that stood in the place of this one, if this one has not all of its runs.
    pub fn aside(&self) -> Option<&Path> {
        self.aside.as_deref()
    }
}

/// Keys of the runs in a table that did not fail.
fn finished(table: &str) -> Vec<String> {
    let mut reader = csv::Reader::from_reader(table.as_bytes());
    let header = reader.headers().cloned().unwrap_or_default();
    let [key, ended] = ["key", "ended"].map(|name| header.iter().position(|h| h == name));
    let (Some(key), Some(ended)) = (key, ended) else { return Vec::new() };
    let done = reader.records().filter_map(Result::ok).filter(|r| r.get(ended).is_some_and(|e| !e.starts_with(FAILED)));
    done.filter_map(|r| r.get(key).map(str::to_string)).collect()
}

/// A name beside `path` that no file has: `runs_before_1.csv`.
fn free_place(path: &Path) -> PathBuf {
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    let place = |k: u32| path.with_file_name(format!("{stem}_before_{k}.csv"));
    (1..).map(place).find(|p| !p.exists()).unwrap_or_else(|| place(0))
}

/// Says which build made the table at `path`.
fn program_file(path: &Path) -> PathBuf {
    path.with_extension("program")
}

/// Fingerprint of this program: what another build computed may be something else.
fn program() -> &'static str {
    static PROGRAM: OnceLock<String> = OnceLock::new();
    PROGRAM.get_or_init(|| {
        let bytes = std::env::current_exe().and_then(std::fs::read).unwrap_or_default();
        format!("{:016x}\n", fingerprint(&bytes))
    })
}

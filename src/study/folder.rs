//! The folder of a study: a result for each run, and what is made of them.
//!
//! Results lie in `results/BUILD/KEY.toml`: by the build of the program and by the fingerprint of the case. Nobody deletes one, so
//! that a study that was changed and changed back finds all its runs, and so that any number of processes on any number of
//! machines may add to them. `runs.csv`, `manifest.csv` and `status.toml` are made of them and of the plan.
//!
//! Elsewhere: a content-addressed store of results.

use super::plan::PlannedRun;
use super::result::{self, build};
use super::table::{Row, Runs, has_lost};
use crate::output::{LOCK, Lock, OutputError, write_bytes, write_text};
use std::fs;
use std::path::{Path, PathBuf};
use std::time::Duration;

/// Says which build of the program worked here last; also, that the folder is one of a study.
const PROGRAM: &str = "runs.program";
/// Held while one of several processes writes what they share.
const TABLE_LOCK: &str = ".checkdam-table";
const RESULTS: &str = "results";
const TABLE: &str = "runs.csv";
const STUDY: &str = "study.toml";
const FIGURE: &str = "figure.svg";
const MANIFEST: &str = "manifest.csv";
const STATUS: &str = "status.toml";
/// So often, and after such a time, one asks again for what another process needs for a moment.
const ATTEMPTS: usize = 3000;
const PAUSE: Duration = Duration::from_millis(20);

/// How far the runs of a folder are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Status {
    /// They are listed, for others to run.
    Listed,
    /// They are being run, or the process that ran them was killed.
    Running,
    /// Nobody here goes on with them.
    Ended,
}

/// The folder of a study, while this process works in it.
#[derive(Debug)]
pub struct Folder {
    at: PathBuf,
    lock: Lock,
}

impl Folder {
    /// For this process alone.
    ///
    /// # Errors
    /// Another process works there, the folder is somebody else's, or it cannot be written.
    pub fn alone(at: &Path) -> Result<Self, OutputError> {
        Self::open(at, Lock::alone)
    }

    /// Together with others that do the same.
    ///
    /// # Errors
    /// As [`Self::alone`].
    pub fn shared(at: &Path) -> Result<Self, OutputError> {
        Self::open(at, Lock::shared)
    }

    fn open(at: &Path, lock: fn(PathBuf) -> Result<Lock, OutputError>) -> Result<Self, OutputError> {
        // What is not to be touched is not even locked.
        if !at.join(LOCK).exists() {
            refuse_foreign(at)?;
        }
        let results = at.join(RESULTS).join(build());
        let make = |path: &Path| {
            fs::create_dir_all(path).map_err(|source| OutputError::Create { path: path.to_path_buf(), source })
        };
        make(at)?;
        let folder = Self { at: at.to_path_buf(), lock: lock(at.join(LOCK))? };
        refuse_foreign(at)?;
        make(&results)?;
        let program = format!("{}\n", build());
        if fs::read_to_string(at.join(PROGRAM)).ok().as_ref() != Some(&program) {
            let _turn = folder.turn()?;
            write_text(at.join(PROGRAM), &program)?;
        }
        Ok(folder)
    }

    /// Where the table is.
    pub fn table(&self) -> PathBuf {
        self.at.join(TABLE)
    }

    /// Where the figure is.
    pub fn figure(&self) -> PathBuf {
        self.at.join(FIGURE)
    }

    /// The one of several processes that writes what they share.
    fn turn(&self) -> Result<Lock, OutputError> {
        let mut attempts = 0;
        loop {
            match Lock::if_possible(self.at.join(TABLE_LOCK)) {
                Err(OutputError::InUse { .. }) if attempts < ATTEMPTS => attempts += 1,
                other => return other,
            }
            std::thread::sleep(PAUSE);
        }
    }

    fn place(&self, run: &PlannedRun, kind: &str) -> PathBuf {
        self.at.join(RESULTS).join(build()).join(format!("{}.{kind}", run.key))
    }

    /// A run for this process alone, until the lock is dropped.
    ///
    /// # Errors
    /// [`OutputError::InUse`] if another process makes it.
    pub fn claim(&self, run: &PlannedRun) -> Result<Lock, OutputError> {
        self.lock.check()?;
        Lock::if_possible(self.place(run, "lock"))
    }

    /// The result of a run, if there is one; `Err` with the reason if it is not whole.
    pub fn result(&self, run: &PlannedRun) -> Option<Result<Row, String>> {
        let path = self.place(run, "toml");
        let text = match fs::read(&path) {
            Ok(bytes) => String::from_utf8(bytes).map_err(|_| "it is not text".to_string()),
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => return None,
            Err(error) => Err(error.to_string()),
        };
        Some(text.and_then(|text| result::read(run, &text)).map_err(|what| format!("{}: {what}", path.display())))
    }

    /// Puts the result of a run in its place, whole.
    ///
    /// # Errors
    /// It cannot be written, or the folder is gone.
    pub fn keep(&self, run: &PlannedRun, row: &Row) -> Result<(), OutputError> {
        self.lock.check()?;
        write_text(self.place(run, "toml"), &result::text(run, row))
    }

    /// All results of a plan, also of runs that failed. Those that are not whole are named in `notes`, and are left out.
    pub fn results(&self, plan: &[PlannedRun], columns: &[&str], notes: &mut Vec<String>) -> Runs {
        let mut runs = Runs::new(columns);
        for run in plan {
            match self.result(run) {
                _ if runs.get(run).is_some() => {}
                Some(Ok(row)) => runs.insert(run, row),
                Some(Err(what)) => notes.push(format!("a result is not taken: {what}; the run is to be made again")),
                None => {}
            }
        }
        runs
    }

    /// Says in the folder what is asked and what there is of it. What stood there and is no part of it is kept beside it, and named in
    /// `notes`.
    ///
    /// # Errors
    /// A file cannot be written; what stood there is unchanged.
    pub fn begin(
        &self,
        plan: &[PlannedRun],
        runs: &Runs,
        study: &str,
        status: Status,
        notes: &mut Vec<String>,
    ) -> Result<(), OutputError> {
        let _turn = self.turn()?;
        let at = |name: &str| self.at.join(name);
        let [old_table, old_study] = [there(&at(TABLE))?, there(&at(STUDY))?];
        let loses = has_lost(&old_table, &runs.csv(plan));
        let mut kept = Vec::new();
        let number =
            (1..).find(|k| [TABLE, STUDY, FIGURE].iter().all(|name| !at(&before(name, *k)).exists())).unwrap_or(0);
        let differs = !old_study.is_empty() && old_study != study.as_bytes();
        for (name, moves) in [(TABLE, loses), (FIGURE, loses), (STUDY, differs)] {
            if moves && at(name).exists() {
                let aside = before(name, number);
                write_bytes(at(&aside), &there(&at(name))?)?;
                kept.push(aside);
            }
        }
        if !kept.is_empty() {
            let what = if loses { "a table that the new one does not contain" } else { "another text of the study" };
            notes.push(format!("{what} stood in {}: kept as {}", self.at.display(), kept.join(", ")));
        }
        if old_study != study.as_bytes() {
            write_text(at(STUDY), study)?;
        }
        write_text(at(MANIFEST), &runs.manifest(plan, build()))?;
        self.write_status(plan, runs, status)?;
        self.write_table(plan, runs)
    }

    /// Puts the table of what there is in its place, whole.
    ///
    /// # Errors
    /// It cannot be written, or the folder is gone.
    pub fn save(&self, plan: &[PlannedRun], runs: &Runs) -> Result<(), OutputError> {
        self.lock.check()?;
        self.write_table(plan, runs)
    }

    /// The last word on what there is.
    ///
    /// # Errors
    /// As [`Self::save`].
    pub fn end(&self, plan: &[PlannedRun], runs: &Runs) -> Result<(), OutputError> {
        self.lock.check()?;
        let _turn = self.turn()?;
        self.write_status(plan, runs, Status::Ended)
    }

    fn write_table(&self, plan: &[PlannedRun], runs: &Runs) -> Result<(), OutputError> {
        let text = runs.csv(plan);
        // A table that is already there is not touched.
        if fs::read(self.table()).is_ok_and(|there| there == text.as_bytes()) {
            return Ok(());
        }
        write_text(self.table(), &text)
    }

    fn write_status(&self, plan: &[PlannedRun], runs: &Runs, status: Status) -> Result<(), OutputError> {
        let count = |of: &dyn Fn(&Row) -> bool| plan.iter().filter(|run| runs.get(run).is_some_and(of)).count();
        let (rows, failed) = (count(&|_| true), count(&|row| !row.is_complete()));
        let word = match status {
            Status::Listed => "listed",
            Status::Running => "running",
            Status::Ended if rows == plan.len() => "complete",
            Status::Ended => "incomplete",
        };
        let text = format!("status = \"{word}\"\nruns = {}\nrows = {rows}\nfailed = {failed}\n", plan.len());
        write_text(self.at.join(STATUS), &text)
    }

    /// The key that the manifest has for the run of this number, from 1; none if there is no manifest.
    pub fn listed(&self, number: usize) -> Option<String> {
        let text = fs::read_to_string(self.at.join(MANIFEST)).ok()?;
        let mut reader = csv::Reader::from_reader(text.as_bytes());
        let row = reader.records().nth(number.checked_sub(1)?);
        Some(row.and_then(Result::ok).and_then(|r| r.get(1).map(str::to_string)).unwrap_or_default())
    }
}

/// What stands in a file; nothing if there is none.
fn there(path: &Path) -> Result<Vec<u8>, OutputError> {
    match fs::read(path) {
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => Ok(Vec::new()),
        read => read.map_err(|source| OutputError::Open { path: path.to_path_buf(), source }),
    }
}

/// A name for what stood there before: `runs_before_1.csv`.
fn before(name: &str, number: u32) -> String {
    let (stem, kind) = name.rsplit_once('.').unwrap_or((name, ""));
    format!("{stem}_before_{number}.{kind}")
}

/// A folder that is not empty has to be one of a study.
fn refuse_foreign(at: &Path) -> Result<(), OutputError> {
    if at.join(PROGRAM).exists() {
        return Ok(());
    }
    // What a process that shares the folder makes before it says whose it is.
    let first = [LOCK, TABLE_LOCK, RESULTS, "runs.program.tmp"];
    let entries = fs::read_dir(at).into_iter().flatten().filter_map(Result::ok);
    let foreign = entries.into_iter().find(|entry| first.iter().all(|name| entry.file_name() != *name));
    match foreign {
        Some(_) if !at.join(PROGRAM).exists() => Err(OutputError::Foreign { path: at.to_path_buf() }),
        _ => Ok(()),
    }
}

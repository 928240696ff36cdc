//! Works off the runs of a study.
//!
//! Elsewhere: an embarrassingly parallel job queue with restart.

use super::file::Study;
use super::folder::{Folder, Status};
use super::plan::PlannedRun;
use super::quantities::measure;
use super::table::{Row, Runs};
use crate::output::OutputError;
use crate::run;
use std::collections::BTreeSet;
use std::num::NonZero;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};

/// How far a study is.
#[derive(Debug, Clone, Copy)]
pub struct Progress<'a> {
    /// Runs finished, now or in an earlier attempt.
    pub finished: usize,
    /// Of them, those of an earlier attempt.
    pub earlier: usize,
    /// Runs of the study.
    pub total: usize,
    /// The run that is spoken of.
    pub run: &'a PlannedRun,
    /// Its progress; none when it has just ended.
    pub inside: Option<&'a run::Progress>,
    /// How it ended; none while it runs.
    pub ended: Option<&'a str>,
}

/// How a study ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Finished {
    /// Runs with a row in the table.
    pub rows: usize,
    /// Of them, those that failed.
    pub failed: usize,
    /// Runs of the study.
    pub total: usize,
}

impl Finished {
    /// Whether every run has a row.
    pub fn is_complete(&self) -> bool {
        self.rows == self.total
    }
}

/// Runs what is not there yet, one run a thread. With a `folder` each result is kept there, and the table is saved after each.
/// `progress` is called from several threads, one at a time; when it answers `false`, the runs that are on the way are dropped and the
/// study ends.
///
/// # Errors
/// A result or the table could not be written; runs on the way are dropped.
pub fn run(
    plan: &[PlannedRun],
    runs: &mut Runs,
    folder: Option<&Folder>,
    threads: NonZero<usize>,
    progress: &mut (dyn FnMut(&Progress) -> bool + Send),
) -> Result<Finished, OutputError> {
    // A case that stands twice in the plan is run once.
    let mut seen = BTreeSet::new();
    let waiting: Vec<_> = plan.iter().filter(|run| runs.get(run).is_none() && seen.insert(&run.key)).collect();
    let count = |runs: &Runs| plan.iter().filter(|r| runs.get(r).is_some()).count();
    let earlier = count(runs);
    let next = AtomicUsize::new(0);
    let shared = Mutex::new((progress, runs, true, None::<OutputError>, earlier));
    let lock = || shared.lock().unwrap_or_else(PoisonError::into_inner);
    std::thread::scope(|scope| {
        for _ in 0..threads.get().min(waiting.len()) {
            scope.spawn(|| {
                while lock().2
                    && let Some(&run) = waiting.get(next.fetch_add(1, Ordering::Relaxed))
                {
                    let mut inside = |p: &run::Progress| {
                        let (progress, _, go_on, _, finished) = &mut *lock();
                        let (finished, total) = (*finished, plan.len());
                        *go_on &= progress(&Progress { finished, earlier, total, run, inside: Some(p), ended: None });
                        *go_on
                    };
                    let made = attempt(run, folder, &mut inside);
                    let (progress, runs, go_on, failure, finished) = &mut *lock();
                    let kept = made.and_then(|row| {
                        let Some(row) = row else { return Ok(None) };
                        let ended = row.ended.clone();
                        runs.insert(run, row);
                        folder.map_or(Ok(()), |folder| folder.save(plan, runs)).map(|()| Some(ended))
                    });
                    let ended = match kept {
                        Ok(Some(ended)) => ended,
                        Ok(None) => return,
                        Err(error) => {
                            *go_on = false;
                            failure.get_or_insert(error);
                            return;
                        }
                    };
                    *finished = count(runs);
                    let (finished, total) = (*finished, plan.len());
                    *go_on &= progress(&Progress { finished, earlier, total, run, inside: None, ended: Some(&ended) });
                }
            });
        }
    });
    let (_, runs, _, failure, rows) = shared.into_inner().unwrap_or_else(PoisonError::into_inner);
    match failure {
        Some(error) => Err(error),
        None => Ok(Finished { rows, ..finished(plan, runs) }),
    }
}

/// How far a plan is with these runs.
pub fn finished(plan: &[PlannedRun], runs: &Runs) -> Finished {
    let rows: Vec<_> = plan.iter().filter_map(|run| runs.get(run)).collect();
    let failed = rows.iter().filter(|row| !row.is_complete()).count();
    Finished { rows: rows.len(), failed, total: plan.len() }
}

/// Makes a run, unless the `folder` has its result already, and keeps the result there. None if `progress` has stopped it. A run that
/// failed is tried again.
///
/// # Errors
/// [`OutputError::InUse`] if another process makes the same run; else the result could not be written.
pub fn attempt(
    run: &PlannedRun,
    folder: Option<&Folder>,
    progress: &mut run::ProgressFn,
) -> Result<Option<Row>, OutputError> {
    let _claim = folder.map(|folder| folder.claim(run)).transpose()?;
    if let Some(Ok(row)) = folder.and_then(|folder| folder.result(run))
        && row.is_complete()
    {
        return Ok(Some(row));
    }
    let mut stopped = false;
    let row = one(run, &mut |p| {
        let go_on = progress(p);
        stopped |= !go_on;
        go_on
    });
    if stopped {
        return Ok(None);
    }
    folder.map_or(Ok(()), |folder| folder.keep(run, &row))?;
    Ok(Some(row))
}

/// Runs a case on this thread alone: many runs side by side use the processors better than many threads on one. A run that breaks
/// the program itself has failed.
pub fn one(run: &PlannedRun, progress: &mut run::ProgressFn) -> Row {
    let made = catch_unwind(AssertUnwindSafe(|| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().map_err(|e| e.to_string())?;
        let ended = pool.install(|| run::run_in_memory(&run.case, progress));
        ended.map(|(_, _, summary)| summary).map_err(|e| e.to_string())
    }));
    match made {
        Ok(Ok(summary)) => {
            let trusted = summary.trusted && crate::seeded::active().is_none();
            Row::new(summary.status.trim_start_matches("completed: "), trusted, &measure(&summary))
        }
        Ok(Err(error)) => Row::failed(&error),
        Err(panic) => {
            let text = panic.downcast_ref::<String>().map(String::as_str);
            let text = text.or_else(|| panic.downcast_ref::<&str>().copied()).unwrap_or("without a word");
            Row::failed(&format!("the program broke down: {text}"))
        }
    }
}

/// Works off a study in its folder: takes over what is there, runs the rest, and says in `notes` what deserves a word. `text` is the
/// text of the study.
///
/// # Errors
/// The folder belongs to somebody else, or cannot be written; results that are there stay.
pub fn work_off(
    plan: &[PlannedRun],
    study: (&Study, &str),
    at: &Path,
    threads: NonZero<usize>,
    progress: &mut (dyn FnMut(&Progress) -> bool + Send),
    notes: &mut Vec<String>,
) -> Result<(Runs, Finished), OutputError> {
    let (study, text) = study;
    let folder = Folder::alone(at)?;
    let mut runs = folder.results(plan, &study.columns(), notes);
    runs.forget_failed();
    folder.begin(plan, &runs, text, Status::Running, notes)?;
    let ended = run(plan, &mut runs, Some(&folder), threads, progress);
    let said = folder.end(plan, &runs);
    let ended = ended?;
    said?;
    Ok((runs, ended))
}

//! Works off the runs of a study.
//!
//! Elsewhere: an embarrassingly parallel job queue with restart.

use super::plan::PlannedRun;
use super::quantities::measure;
use super::table::{Row, Runs};
use crate::output::OutputError;
use crate::run;
use std::num::NonZero;
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

/// Runs what is not in the table yet, one run a thread, and saves the table after each. `progress` is called from several
/// threads, one at a time; when it answers `false`, the runs that are on the way are dropped and the study ends.
///
/// # Errors
/// The table could not be written; runs on the way are dropped.
pub fn run(
    plan: &[PlannedRun],
    runs: &mut Runs,
    threads: NonZero<usize>,
    progress: &mut (dyn FnMut(&Progress) -> bool + Send),
) -> Result<Finished, OutputError> {
    // A case that stands twice in the plan is run once.
    let mut waiting: Vec<&PlannedRun> = Vec::new();
    for run in plan {
        if runs.get(run).is_none() && waiting.iter().all(|w| w.key != run.key) {
            waiting.push(run);
        }
    }
    let count = |runs: &Runs| plan.iter().filter(|r| runs.get(r).is_some()).count();
    let earlier = count(runs);
    runs.save(plan)?;
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
                    let row = one(run, &mut inside);
                    let (progress, runs, go_on, failure, finished) = &mut *lock();
                    if !*go_on {
                        return;
                    }
                    let ended = row.ended.clone();
                    runs.insert(run, row);
                    if let Err(error) = runs.save(plan) {
                        (*go_on, *failure) = (false, Some(error));
                        return;
                    }
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
        None => {
            let failed = plan.iter().filter(|r| runs.get(r).is_some_and(|row| !row.is_complete())).count();
            Ok(Finished { rows, failed, total: plan.len() })
        }
    }
}

/// Runs a case on this thread alone: many runs side by side use the processors better than many threads on one.
pub fn one(run: &PlannedRun, progress: &mut run::ProgressFn) -> Row {
    let pool = match rayon::ThreadPoolBuilder::new().num_threads(1).build() {
        Ok(pool) => pool,
        Err(error) => return Row::failed(&error.to_string()),
    };
    match pool.install(|| run::run_in_memory(&run.case, progress)) {
        Ok((_, _, summary)) => {
            let trusted = summary.trusted && crate::seeded::active().is_none();
            Row::new(summary.status.trim_start_matches("completed: "), trusted, &measure(&summary))
        }
        Err(error) => Row::failed(&error.to_string()),
    }
}

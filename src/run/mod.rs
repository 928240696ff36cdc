//! Runs a case: settle, tilt, release, record.
//!
//! [`Experiment`] drives a simulation through its stages and reads the `gauges`; [`records`] says what is recorded, [`columns`]
//! what stands in each column of a table; [`files`]
//! writes it down; `summary` draws the conclusions.

mod balances;
mod barrier;
mod barrier_tables;
mod claim;
mod clock;
mod columns;
mod deposit;
mod entered;
mod experiment;
mod figures;
pub mod files;
mod filling;
mod gauges;
pub mod inflow;
#[cfg(test)]
mod invariance_tests;
mod means;
mod note;
mod outlines;
mod passage;
pub mod records;
mod rest;
mod scales;
pub mod scene;
mod settle;
mod stage;
pub mod structure;
pub(crate) mod summary;
mod table;
mod verdict;

pub use columns::columns;
pub use experiment::Experiment;
pub use note::{Kind as NoteKind, Note};
pub use records::{Recorder, Records};
pub use scales::Scales;
pub use stage::{Progress, RunError, Stage};
pub use summary::Summary;
pub use table::{ColumnText, TableText};

use crate::case::Case;
use std::path::Path;

/// Runs a case to its end, writing into `out` (which must exist and be empty) if given.
///
/// `progress` is called every few steps; the run ends early, with everything written, when it returns `false`.
///
/// # Errors
/// What stopped the run. Files written until then are complete up to that moment and the summary says what happened.
pub fn run(case: &Case, out: Option<&Path>, progress: &mut ProgressFn) -> Result<Summary, RunError> {
    // On a thread of the pool: steps are short, and waking the pool from outside for each part of one costs more than it.
    rayon::scope(|_| match out {
        None => run_in_memory(case, progress).map(|(_, _, summary)| summary),
        Some(directory) => files::run_into(case, directory, progress).map(|(_, _, summary)| summary),
    })
}

/// Runs a case to its end, into a folder that this process has claimed.
///
/// # Errors
/// As [`run`].
pub fn run_claimed(case: &Case, claim: files::Claim, progress: &mut ProgressFn) -> Result<Summary, RunError> {
    rayon::scope(|_| files::run_claimed(case, claim, progress).map(|(_, _, summary)| summary))
}

/// Runs a case without writing anything and returns what was recorded.
///
/// # Errors
/// What stopped the run.
pub fn run_in_memory(case: &Case, progress: &mut ProgressFn) -> Result<(Experiment, Records, Summary), RunError> {
    rayon::scope(|_| {
        let mut records = Records::default();
        let mut experiment = Experiment::new(case);
        let end = experiment.run(&mut records, progress)?;
        let summary = Summary::new(case, &experiment, &records, end);
        Ok((experiment, records, summary))
    })
}

/// Is told how far a run is; the run ends early, in order, when it answers `false`.
pub type ProgressFn<'a> = dyn FnMut(&Progress) -> bool + Send + 'a;

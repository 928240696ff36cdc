//! Runs a case: settle, tilt, release, record.
//!
//! [`Experiment`] drives a simulation through its stages and reads the gauges; [`records`] says what is recorded; [`files`]
//! writes it down; [`summary`] draws the conclusions.

mod experiment;
pub mod files;
pub mod records;
pub mod scene;
pub mod summary;

pub use experiment::{Experiment, Progress, RunError, Stage};
pub use records::{Recorder, Records};
pub use summary::Summary;

use crate::case::Case;
use std::path::Path;

/// Runs a case to its end, writing into `out` (which must exist and be empty) if given.
///
/// `progress` is called every few steps; the run ends early, with everything written, when it returns `false`.
///
/// # Errors
/// What stopped the run. Files written until then are complete up to that moment and the summary says what happened.
pub fn run(case: &Case, out: Option<&Path>, progress: &mut dyn FnMut(&Progress) -> bool) -> Result<Summary, RunError> {
    match out {
        None => {
            let mut records = Records::default();
            let mut experiment = Experiment::new(case);
            let end = experiment.run(&mut records, progress)?;
            Ok(Summary::new(case, &experiment, &records, end))
        }
        Some(directory) => files::run_into(case, directory, progress),
    }
}

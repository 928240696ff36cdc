//! Are we solving the right equations? Experiments and published computations, with the uncertainty of their numbers and of
//! ours.
//!
//! A validation is a module and a line in [`VALIDATIONS`]. It leaves tables and draws its figures from them; what must hold
//! whatever the source says (balances, bounds, sampling noise) is judged, what the source says stands beside it. Studies of
//! many runs are recorded in `runs/*.csv` of their folder; from the record, their analysis takes seconds, and
//! [`Context::studies`] makes the record anew.
//!
//! An experiment that needs no analysis of its own is a folder of data, which [`experiment`] runs; those of the project stand in
//! `experiments/`.
//!
//! Elsewhere: validation in the sense of V&V, comparison with experiments.

pub mod balances;
pub mod barrier;
mod case_run;
pub mod column;
pub mod counterpart;
pub mod data;
#[cfg(test)]
mod errata;
pub mod experiment;
pub mod flume;
pub mod index;
pub mod record;
pub mod runs;
pub mod scatter;
pub mod verdict;
pub mod watch;

use checkdam::output::OutputError;
use checkdam::plot::PlotError;
use checkdam::run::RunError;
use checkdam::simulation::StepFailure;
use checkdam::study::StudyError;
use checkdam_verification::report::files;
use checkdam_verification::{Fault, FaultKind, Outcome, RungFailure};
use std::path::Path;

/// One validation.
#[derive(Debug, Clone, Copy)]
pub struct Validation {
    /// Name, also of its tables and figures, which begin with it.
    pub name: &'static str,
    /// What it shows, in a line.
    pub title: &'static str,
    /// What its record is made of, and how long that takes on two processors; empty if it keeps none.
    pub study: &'static str,
    /// Runs it.
    pub run: fn(&mut Context) -> Result<Outcome, Failure>,
    /// Draws its figures from the tables in a folder, into the folder; their names.
    pub draw: fn(&Path) -> Result<Vec<String>, PlotError>,
    /// Faults that it claims to catch, with their factors f; 2 - f is tried as well.
    pub covers: &'static [(FaultKind, f64)],
}

/// What a validation is given.
pub struct Context<'a> {
    /// What is wrong on purpose.
    pub fault: Fault,
    /// Where it may leave whole runs, and where studies go on.
    pub folder: &'a Path,
    /// Whether studies are run, instead of read from the record.
    pub studies: bool,
    /// Is told how far it is, in words; it ends early when this answers `false`.
    pub progress: &'a mut watch::WordsFn<'a>,
}

/// Why a validation could not be run to its end.
#[derive(Debug, thiserror::Error)]
pub enum Failure {
    /// A run failed.
    #[error(transparent)]
    Run(#[from] RunError),
    /// A simulation failed.
    #[error("the simulation failed: {0}")]
    Step(Box<StepFailure>),
    /// A study failed.
    #[error(transparent)]
    Study(#[from] StudyError),
    /// A file could not be written.
    #[error(transparent)]
    Output(#[from] OutputError),
    /// A figure could not be drawn.
    #[error(transparent)]
    Plot(#[from] PlotError),
    /// The user stopped it.
    #[error("stopped; studies go on from here when they are asked for again")]
    Stopped,
    /// A file of the project is not as it should be.
    #[error("{0}")]
    Record(String),
}

impl From<StepFailure> for Failure {
    fn from(failure: StepFailure) -> Self {
        Failure::Step(Box::new(failure))
    }
}

impl From<RungFailure> for Failure {
    fn from(failure: RungFailure) -> Self {
        match failure {
            RungFailure::Step(failure) => Failure::Step(failure),
            RungFailure::Files(what) => Failure::Record(what),
        }
    }
}

/// All validations.
pub const VALIDATIONS: &[Validation] = &[
    flume::VALIDATION,
    flume::noise::VALIDATION,
    flume::baseline::VALIDATION,
    flume::sensitivity::VALIDATION,
    flume::at_rest::VALIDATION,
    flume::shaken::VALIDATION,
    flume::step_length::VALIDATION,
    flume::calibration::VALIDATION,
    flume::verdict::VALIDATION,
    barrier::beam::VALIDATION,
    barrier::rigid::VALIDATION,
    barrier::impact::VALIDATION,
    barrier::rigidity::VALIDATION,
    barrier::grids::VALIDATION,
    barrier::steps::VALIDATION,
    barrier::kinematics::VALIDATION,
    barrier::density::VALIDATION,
    barrier::weight::VALIDATION,
    barrier::close_up::VALIDATION,
    barrier::claims::VALIDATION,
    column::LEVEL,
    column::SLOPE,
];

/// Gives the runs of a study that is on record.
pub type RecordedRows = fn() -> Result<Vec<record::RecordedRun>, Failure>;

/// All studies that are on record, by the names of their files below `validation`.
pub const STUDIES: &[(&str, RecordedRows)] = &[
    ("flume/runs/baseline.csv", || flume::baseline::RECORD.rows()),
    ("flume/runs/finest.csv", || flume::baseline::FINEST.rows()),
    ("flume/runs/sensitivity.csv", || flume::sensitivity::RECORD.rows()),
    ("flume/runs/step_length.csv", || flume::step_length::RECORD.rows()),
    ("flume/runs/at_rest.csv", || flume::at_rest::RECORD.rows()),
    ("flume/runs/calibration.csv", || flume::calibration::SAMPLE.rows()),
    ("flume/runs/refined.csv", || flume::calibration::REFINED.rows()),
    ("barrier/runs/rigidity.csv", || barrier::records::RIGIDITY.record.rows()),
    ("barrier/runs/scatter.csv", || barrier::records::SCATTER.record.rows()),
    ("barrier/runs/grids.csv", || barrier::records::GRIDS.record.rows()),
    ("barrier/runs/fine.csv", || barrier::records::FINE.record.rows()),
    ("barrier/runs/rigid.csv", || barrier::records::RIGID.record.rows()),
    ("barrier/runs/integration.csv", || barrier::records::INTEGRATION.record.rows()),
    ("barrier/runs/short_steps.csv", || barrier::records::SHORT_STEPS.record.rows()),
    ("barrier/runs/kinematics.csv", || barrier::records::KINEMATICS.record.rows()),
    ("barrier/runs/density.csv", || barrier::records::DENSITY.record.rows()),
    ("barrier/runs/weight.csv", || barrier::records::WEIGHT.record.rows()),
    ("barrier/runs/scatter_calibrated.csv", || barrier::records::SCATTER_CALIBRATED.record.rows()),
    ("column/runs/columns.csv", column::rows),
];

/// Writes tables and figures of an outcome into `folder`, which is created; returns their names.
///
/// # Errors
/// The first file that could not be written.
pub fn write(validation: &Validation, outcome: &Outcome, folder: &Path) -> Result<Vec<String>, PlotError> {
    std::fs::create_dir_all(folder).map_err(|source| OutputError::Create { path: folder.to_path_buf(), source })?;
    let mut written = Vec::new();
    for (stem, text) in files(validation.name, outcome) {
        written.push(format!("{stem}.csv"));
        checkdam::output::write_text(folder.join(format!("{stem}.csv")), &text)?;
    }
    written.extend((validation.draw)(folder)?);
    Ok(written)
}

//! Studies: many runs of one or more cases that differ in a few fields, ending in one tidy table.
//!
//! A study is a TOML file ([`Study`]) that names cases and says what is varied: every combination of some values, one thing at a
//! time, or a space-filling sample. [`plan`] turns it into runs. [`attempt`] makes one of them and keeps its result in the
//! [`Folder`] of the study; [`work_off`] makes all that are missing, one processor each, and any number of other processes may do so
//! one by one. A row of the table is one run: what was set, how it ended, and the [`quantities`] that were measured.
//!
//! Elsewhere: parameter sweeps, sensitivity analysis, design of experiments.

mod change;
mod check;
mod engine;
mod figure;
mod file;
mod folder;
#[cfg(test)]
mod folder_tests;
mod plan;
pub mod quantities;
mod read;
mod result;
mod sampling;
mod table;
#[cfg(test)]
mod tests;

pub use change::Change;
pub use engine::{Finished, Progress, attempt, finished, one, run, work_off};
pub use figure::draw;
pub use file::{Axis, Choice, Figure, Option_ as ChoiceOption, Range, Replicates, Sample, Study, StudyError, Variant};
pub use folder::{Folder, Status};
pub use plan::{PlannedRun, plan};
pub use table::{Row, Runs, TRUSTED};

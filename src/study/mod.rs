//! Studies: many runs of one or more cases that differ in a few fields, ending in one tidy table.
//!
//! A study is a TOML file ([`Study`]) that names cases and says what is varied: every combination of some values, one thing at a
//! time, or a space-filling sample. [`plan`] turns it into runs, [`run`] works them off, one processor each, and goes on
//! where an earlier, interrupted run of the same study stopped. A row of the table is one run: what was set, how it ended,
//! and the [`quantities`] that were measured.
//!
//! Elsewhere: parameter sweeps, sensitivity analysis, design of experiments.

mod change;
mod check;
mod engine;
mod figure;
mod file;
mod plan;
pub mod quantities;
mod read;
mod sampling;
mod table;
#[cfg(test)]
mod tests;

pub use change::Change;
pub use engine::{Finished, Progress, one, run};
pub use figure::draw;
pub use file::{Axis, Choice, Figure, Option_ as ChoiceOption, Range, Replicates, Sample, Study, StudyError, Variant};
pub use plan::{PlannedRun, plan};
pub use table::{Row, Runs, TRUSTED};

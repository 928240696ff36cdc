//! Are we solving the equations right? A ladder of rungs, each a set of checks against closed forms, exact fields, conservation
//! laws and observed orders.
//!
//! The ladder is part of the library so that `cargo test` and the command run the same thing. A rung is one file and one line
//! in [`RUNGS`]. Every rung runs under a [`Fault`], which perturbs the physics given to the solver and not the closed form:
//! a rung that does not notice a few percent of wrong friction where it claims to, proves nothing.

pub mod cantilever;
pub mod celerity;
#[cfg(test)]
mod climb;
pub mod collapse;
pub mod contact;
pub mod convergence;
pub mod drucker_prager_point;
pub mod earth_pressure;
pub mod energy;
pub mod exactness;
pub mod fault;
pub mod figures;
pub mod manufactured;
pub mod neo_hookean;
pub mod release;
pub mod report;
pub mod scene;
pub mod self_weight;
pub mod sliding_block;
pub mod wall_pressure;

pub use fault::{Fault, FaultKind};

use checkdam::check::{Check, Verdict};
use checkdam::simulation::StepFailure;
use figures::FIGURES;
use std::path::Path;

/// Why a rung could not be run to its end.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum RungFailure {
    /// The solver gave up.
    #[error(transparent)]
    Step(Box<StepFailure>),
}

impl From<StepFailure> for RungFailure {
    fn from(failure: StepFailure) -> Self {
        RungFailure::Step(Box::new(failure))
    }
}

/// One rung of the ladder.
#[derive(Debug, Clone, Copy)]
pub struct Rung {
    /// Name, also of its report.
    pub name: &'static str,
    /// What it shows, in a line.
    pub title: &'static str,
    /// Runs it.
    pub run: fn(&Fault) -> Result<Outcome, RungFailure>,
    /// Faults that it claims to catch, with their factors f; 2 - f is tried as well.
    pub covers: &'static [(FaultKind, f64)],
    /// What of it runs under a fault, where a part is enough to notice; "all" otherwise.
    pub under_fault: &'static str,
}

/// What a rung found.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Outcome {
    /// Checks.
    pub checks: Vec<Check>,
    /// Tables that show more: name without extension, and CSV text.
    pub tables: Vec<(String, String)>,
}

impl Outcome {
    /// Adds a check.
    pub fn check(&mut self, check: Check) {
        self.checks.push(check);
    }

    /// Adds what another part of the rung found.
    pub fn merge(&mut self, other: Outcome) {
        self.checks.extend(other.checks);
        self.tables.extend(other.tables);
    }

    /// The outcome as a verdict of the rung `name`, whose tables and figures are in `folder`.
    pub fn verdict(&self, name: &str, folder: &Path) -> Verdict {
        let tables = std::iter::once(name).chain(self.tables.iter().map(|t| t.0.as_str())).map(|n| format!("{n}.csv"));
        let figures = FIGURES.iter().filter(|f| f.rung == name).map(|f| format!("{}.svg", f.name));
        let path = |file: String| folder.join(file).display().to_string();
        Verdict { name: name.into(), checks: self.checks.clone(), artefacts: figures.chain(tables).map(path).collect() }
    }
}

/// The ladder, from the bottom.
pub const RUNGS: &[Rung] = &[
    exactness::RUNG,
    self_weight::RUNG,
    sliding_block::RUNG,
    drucker_prager_point::RUNG,
    celerity::RUNG,
    energy::RUNG,
    earth_pressure::RUNG,
    manufactured::RUNG,
    cantilever::RUNG,
    neo_hookean::RUNG,
    contact::RUNG,
    wall_pressure::RUNG,
    collapse::RUNG,
    convergence::RUNG,
];

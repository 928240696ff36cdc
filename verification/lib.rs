//! Are we solving the equations right? A ladder of rungs, each a set of checks against closed forms, exact fields, conservation
//! laws and observed orders.
//!
//! The ladder is a library so that `cargo test` and the command run the same thing. A rung is one file, and its name twice in
//! this one. Every rung runs under a [`Fault`], which perturbs the physics given to the solver and not the closed form:
//! a rung that does not notice a few percent of wrong friction where it claims to, proves nothing.
//!
//! Elsewhere: code verification, benchmark suite, method of manufactured solutions (MMS).

pub mod bagnold;
pub mod cantilever;
pub mod celerity;
pub mod collapse;
pub mod contact;
pub mod convergence;
pub mod drucker_prager_point;
pub mod earth_pressure;
pub mod energy;
pub mod exactness;
pub mod fall;
pub mod fault;
pub mod figure;
pub mod files_body;
pub mod files_rigid;
pub mod from_file;
pub mod inflow;
pub mod invariance;
pub mod law_points;
pub mod manufactured;
pub mod neo_hookean;
pub mod other_codes;
pub mod outflow;
pub mod part;
pub mod release;
pub mod report;
pub mod scene;
pub mod self_weight;
pub mod sliding_block;
pub mod slip;
pub mod softening_layer;
pub mod terrain;
pub mod wall_place;
pub mod wall_pressure;

pub use fault::{Fault, FaultKind};
pub use figure::Figure;

use checkdam::check::{Check, Verdict};
use checkdam::simulation::StepFailure;
use std::path::Path;

/// Why a rung could not be run to its end.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum RungFailure {
    /// The solver gave up.
    #[error(transparent)]
    Step(Box<StepFailure>),
    /// A case could not be run from its text to its files.
    #[error("{0}")]
    Files(String),
}

impl From<StepFailure> for RungFailure {
    fn from(failure: StepFailure) -> Self {
        RungFailure::Step(Box::new(failure))
    }
}

/// One rung of the ladder.
#[derive(Debug, Clone, Copy)]
pub struct Rung {
    /// Name, also of its module and its report.
    pub name: &'static str,
    /// What it runs, in a line.
    pub title: &'static str,
    /// What it is for: what must come out.
    pub goal: &'static str,
    /// Where that comes from.
    pub source: &'static str,
    /// The scene in five lines of text.
    pub sketch: &'static str,
    /// Runs it.
    pub run: fn(&Fault) -> Result<Outcome, RungFailure>,
    /// Faults that it claims to catch, with their factors f; 2 - f is tried as well.
    pub covers: &'static [(FaultKind, f64)],
    /// What of it runs under a fault, where a part is enough to notice; "all" otherwise.
    pub under_fault: &'static str,
    /// What is drawn of its tables; at least one.
    pub figures: &'static [Figure],
}

/// The name of a rung from the path of its module: the last part.
pub(crate) const fn of_module(path: &'static str) -> &'static str {
    let bytes = path.as_bytes();
    let mut start = bytes.len();
    while start > 0 && bytes[start - 1] != b':' {
        start -= 1;
    }
    path.split_at(start).1
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
        let figures =
            RUNGS.iter().filter(|r| r.name == name).flat_map(|r| r.figures).map(|f| format!("{}.svg", f.name));
        let path = |file: String| folder.join(file).display().to_string();
        Verdict { name: name.into(), checks: self.checks.clone(), artefacts: figures.chain(tables).map(path).collect() }
    }
}

/// Makes the list of rungs, and a macro that hands their names to another one, so that each is a test of its own.
macro_rules! ladder {
    ($dollar:tt $($rung:ident),* $(,)?) => {
        /// The ladder, from the bottom.
        pub const RUNGS: &[Rung] = &[$($rung::RUNG),*];

        /// Calls a macro with the names of all rungs, from the bottom.
        #[macro_export]
        macro_rules! each_rung {
            ($dollar call:ident) => { $dollar call! { $($rung),* } };
        }
    };
}

ladder! { $
    exactness,
    self_weight,
    sliding_block,
    slip,
    wall_place,
    drucker_prager_point,
    law_points,
    celerity,
    softening_layer,
    energy,
    earth_pressure,
    manufactured,
    cantilever,
    neo_hookean,
    contact,
    other_codes,
    wall_pressure,
    files_body,
    fall,
    collapse,
    outflow,
    terrain,
    bagnold,
    inflow,
    files_rigid,
    invariance,
    convergence,
}

#[cfg(test)]
mod climb;

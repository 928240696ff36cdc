//! Peak force, impact coefficient and deflection of the barrier against its rigidity (Fig. 6 of the paper), with the scatter of runs that
//! should be alike, and where "rigid" ends.

mod analysis;
mod checks;
mod figures;
mod table;
mod threshold;

pub use analysis::{Analysis, Point, analyse, front};
pub use threshold::{crossing, negligible, plateau};

use super::records::RIGIDITY;
use crate::validation::{Context, Failure, Validation};
use crate::verification::Outcome;

/// The analysis of the recorded runs.
pub const VALIDATION: Validation = Validation {
    name: "barrier_rigidity",
    title: "Twelve rigidities of the barrier: impact coefficient, deflection, and where rigid ends",
    study: "100 runs, about 25 minutes",
    run,
    draw: figures::draw,
    covers: &[],
};

fn run(context: &mut Context) -> Result<Outcome, Failure> {
    let analysis = analyse(context)?;
    let cell = RIGIDITY.first_case()?.grid.spacing_m;
    let mut outcome = Outcome { checks: checks::checks(&analysis, cell), ..Outcome::default() };
    outcome.tables.push(("barrier_rigidity_runs".into(), table::table(&analysis)?));
    outcome.tables.push(("barrier_rigidity_threshold".into(), threshold::table(&analysis)?));
    Ok(outcome)
}

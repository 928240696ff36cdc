//! Peak force, impact coefficient and deflection of the barrier against its rigidity (Fig. 6 of the paper), with the scatter of runs that
//! should be alike, and where "rigid" ends.

mod analysis;
mod checks;
mod figures;
mod table;
mod threshold;

pub use analysis::{Analysis, Point, analyse, front};
pub use threshold::{crossing, negligible, plateau};

use super::records::{RIGIDITY, SCATTER_CALIBRATED};
use crate::balances::Balances;
use crate::{Context, Failure, Validation};
use checkdam_verification::Outcome;

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
    // Those of the literal release are judged with the grids.
    let repeated = SCATTER_CALIBRATED.rows(context)?;
    let moved = Balances::over(repeated.iter(), |r| r.set["cell_m"].parse().unwrap_or(f64::NAN));
    outcome.checks.extend(moved.checks("calibrated, moved grids: ", "ledgers and gauges of all runs"));
    outcome.tables.push(("barrier_rigidity_runs".into(), table::table(&analysis)?));
    outcome.tables.push(("barrier_rigidity_threshold".into(), threshold::table(&analysis)?));
    Ok(outcome)
}

//! What a run says of its inflows.

use super::experiment::Experiment;
use serde::Serialize;

/// What has entered through the sections of inflows.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct InflowResults {
    /// Mass that entered, kg: behind that of a continuous flow by less than a column of points.
    pub entered_kg: f64,
    /// Momentum along x that came in with it, N s.
    pub momentum_x_n_s: f64,
    /// Impulse along x of what pushed behind the sections, N s.
    pub push_x_n_s: f64,
    /// Energy that came in with it, and the work of what pushed, J.
    pub given_j: f64,
    /// Names of the inflows that had not ended.
    pub unfinished: Vec<String>,
    /// Least velocity of the material in the first depth beyond a section over the velocity at which it entered, while it did. Far below 1, the
    /// section was drowned: what followed was pushed into a deposit.
    pub velocity_beyond_1: f64,
}

/// Those of a case that has any.
pub(super) fn results(experiment: &Experiment) -> Option<InflowResults> {
    let (sim, case) = (experiment.simulation(), experiment.case());
    if case.inflows.is_empty() {
        return None;
    }
    let ledger = sim.ledger();
    let balance = sim.energy_balance(&sim.stock(), experiment.datum());
    let unfinished = sim.unfinished_inflows().map(|body| sim.bodies()[body].name.clone()).collect();
    Some(InflowResults {
        entered_kg: ledger.entered_mass,
        momentum_x_n_s: ledger.entered_momentum[0],
        push_x_n_s: ledger.inflow_impulse[0],
        given_j: balance.inflow,
        unfinished,
        velocity_beyond_1: experiment.velocity_beyond,
    })
}

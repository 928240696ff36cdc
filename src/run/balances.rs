//! What a run says of energy and momentum.

use super::records::{MomentumRow, Records};
use crate::ledger::EnergyBalance;
use crate::seeded::{self, Seed};
use serde::Serialize;

/// Energy at the end, as shares of the energy at release; with inflows, of that and of all that they have given. Its level of zero is the barrier's foot, or the lowest corner of what flows as it is
/// drawn, if that is lower or there is no barrier.
#[derive(Debug, Clone, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct EnergyResults {
    /// Kinetic, gravitational (above that level) and elastic energy of everything at release, J.
    pub initial_j: f64,
    /// Most energy that had been released by any time: what was kinetic and elastic at release, and what gravity has given since, J. It
    /// depends on no level.
    pub released_j: f64,
    /// Kinetic energy.
    pub kinetic_1: f64,
    /// Gravitational energy.
    pub gravitational_1: f64,
    /// Elastic energy.
    pub elastic_1: f64,
    /// Dissipated by plastic work.
    pub plastic_1: f64,
    /// Dissipated by friction on boundaries and between bodies.
    pub friction_1: f64,
    /// Lost in normal impact on boundaries and between bodies.
    pub impact_1: f64,
    /// Taken by the PIC share of the velocity update.
    pub pic_1: f64,
    /// Dissipated by friction on the side walls.
    pub side_walls_1: f64,
    /// Carried out of the domain.
    pub outflow_1: f64,
    /// Not accounted for, at the end.
    pub residual_end_1: f64,
    /// Not accounted for, largest magnitude at any time.
    pub energy_residual_1: f64,
    /// Not accounted for, largest magnitude at any time, over `released_j` instead of the energy at release.
    pub residual_of_released_1: f64,
    /// Largest kinetic share at any time.
    pub kinetic_max_1: f64,
}

/// Momentum at the end.
#[derive(Debug, Clone, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct MomentumResults {
    /// Sum of the magnitudes along the axes of the impulses of contacts, gravity and boundaries, N s.
    pub impulse_scale_n_s: f64,
    /// Largest residual at any time over that scale.
    pub momentum_closure_1: f64,
    /// Mass that left the domain, kg.
    pub outflow_kg: f64,
    /// Deepest that any point lay inside a boundary, or inside a barrier that is a body, m.
    pub penetration_m: f64,
}

/// Of the records of a run; zeros without one.
pub(super) fn energy(records: &Records) -> EnergyResults {
    let mut results = EnergyResults {
        initial_j: 0.0,
        released_j: 0.0,
        residual_of_released_1: 0.0,
        kinetic_1: 0.0,
        gravitational_1: 0.0,
        elastic_1: 0.0,
        plastic_1: 0.0,
        friction_1: 0.0,
        impact_1: 0.0,
        pic_1: 0.0,
        side_walls_1: 0.0,
        outflow_1: 0.0,
        residual_end_1: 0.0,
        energy_residual_1: 0.0,
        kinetic_max_1: 0.0,
    };
    let Some(last) = records.energy.last() else { return results };
    let e = &last.balance;
    results.initial_j = e.initial;
    let released = records.energy.iter().map(|r| r.balance.released()).fold(0.0, f64::max);
    results.released_j = seeded::times(Seed::RunReleased, released);
    if results.released_j > 0.0 {
        let residuals = records.energy.iter().map(|r| r.balance.residual.abs());
        results.residual_of_released_1 = residuals.fold(0.0, f64::max) / results.released_j;
    }
    // With inflows, of all that was there at release or has come in since.
    let all = e.given();
    if all == 0.0 {
        return results;
    }
    let share = |x: f64| x / all;
    results.kinetic_1 = share(e.kinetic);
    results.gravitational_1 = share(e.gravitational);
    results.elastic_1 = share(e.elastic);
    results.plastic_1 = share(e.plastic);
    let lost = [&e.friction, &e.contact].map(|by| share(by.iter().sum()));
    [results.friction_1, results.impact_1] = seeded::exchanged(Seed::RunShares, lost);
    results.pic_1 = seeded::times(Seed::RunPicShare, share(e.pic));
    results.side_walls_1 = share(e.side_walls);
    results.outflow_1 = share(e.outflow);
    results.residual_end_1 = share(e.residual);
    let largest = |value: fn(&EnergyBalance) -> f64| {
        records.energy.iter().map(|r| share(value(&r.balance)).abs()).fold(0.0, f64::max)
    };
    results.energy_residual_1 = largest(|b| b.residual);
    results.kinetic_max_1 = largest(|b| b.kinetic);
    results
}

/// Of the records of a run; zeros without one.
pub(super) fn momentum(records: &Records) -> MomentumResults {
    let last = records.momentum.last();
    MomentumResults {
        impulse_scale_n_s: last.map_or(0.0, |r| r.ledger.impulse_scale),
        momentum_closure_1: records
            .momentum
            .iter()
            .filter(|r| r.ledger.impulse_scale > 0.0)
            .map(MomentumRow::closure)
            .fold(0.0, f64::max),
        outflow_kg: last.map_or(0.0, |r| r.ledger.departed_mass),
        penetration_m: records.history.iter().map(|r| r.penetration).fold(0.0, f64::max),
    }
}

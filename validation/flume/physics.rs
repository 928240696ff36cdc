//! What any run of the flume must satisfy, whatever the paper says.

use crate::case_run::{CaseRun, base_friction};
use checkdam::check::{Check, Expected, Kind, Tolerance};
use checkdam::theory::sliding_block::acceleration_from_rest;

/// The checks.
pub fn checks(flume: &CaseRun) -> Vec<Check> {
    let CaseRun { name, experiment, records, summary } = flume;
    let case = &summary.case;
    let (Some(barrier), Some(deposit), Some(gauge), Some(last)) =
        (&summary.barrier, &summary.deposit, experiment.barrier().and_then(|g| g.boundary()), records.momentum.last())
    else {
        let none = Check::value(format!("{name}: barrier and base are measured"), 0.0, 1.0, "1");
        return vec![none.because("there is nothing to judge otherwise").from(Kind::Conservation, "case file")];
    };
    let exact = |what: &str, measured: f64, bound: f64, reason: &str| {
        Check::at_most(format!("{name}: {what}"), measured, bound, "1")
            .because(reason)
            .from(Kind::Conservation, "balance of the ledger")
    };
    let mut checks = vec![
        exact(
            "momentum residual / sum of impulses",
            summary.momentum.momentum_closure_1,
            1e-10,
            "every impulse is booked where it acts: only round-off over 25,000 steps remains",
        ),
        exact(
            "energy residual / largest kinetic energy",
            summary.energy.energy_residual_1 / summary.energy.kinetic_max_1,
            0.01,
            "second-order terms of the transfers are booked nowhere; the force of an impact goes with the kinetic energy, of which a percent may",
        ),
        exact(
            "|mass in the domain + mass that left - mass released| / mass",
            (experiment.simulation().stock().mass + summary.momentum.outflow_kg - summary.stepping.mass_kg).abs()
                / summary.stepping.mass_kg,
            1e-12,
            "a grain may be thrown over the barrier, but it is counted; round-off of 4000 summands",
        ),
        exact(
            "deepest penetration / cell size",
            summary.momentum.penetration_m / case.grid.spacing_m,
            1.0,
            "a wall acts on its nodes; a point within one cell behind them is still pushed back",
        ),
    ];

    // Samples are means over their intervals, so they must add up to the impulse in the momentum ledger.
    let boundary = &experiment.simulation().boundaries()[gauge];
    let [px, py] = last.ledger.boundaries[gauge].impulse;
    let ledger = boundary.normal.x * px + boundary.normal.y * py;
    let mut before = 0.0;
    let mut sampled = 0.0;
    for row in records.history.iter().filter(|r| r.time <= last.time) {
        sampled += row.normal * (row.time - before);
        before = row.time;
    }
    checks.push(
        Check::value(format!("{name}: impulse of the sampled force"), sampled, ledger, "N s")
            .within(Tolerance::Relative(1e-9), "the same sums in another order")
            .from(Kind::Conservation, "impulse of the barrier in the momentum ledger"),
    );

    let weight = deposit.weight_along_n;
    checks.push(
        Check::at_most(
            format!("{name}: |weight + base friction - other walls| / weight"),
            deposit.equilibrium_residual_n.abs() / weight,
            0.01,
            "1",
        )
        .because("at rest, with less than 1e-4 of the energy kinetic; means over 0.3 s")
        .from(Kind::Conservation, "equilibrium along the flume"),
    );
    let [low, high] = deposit.equilibrium_limits_n.unwrap_or([f64::NAN; 2]);
    checks.push(
        Check::new(format!("{name}: static force"), barrier.static_force_n, Expected::Within(low, high), "N")
            .because("Coulomb's law bounds the base friction by mu N either way")
            .from(Kind::Analytic, "limit equilibrium, m g sin -/+ mu N"),
    );

    // A front cannot be slower than a block from rest at the gate: pressure from behind only adds.
    let angle = case.gravity.inclination_deg.to_radians();
    let g = case.gravity.magnitude_m_per_s2;
    for passage in summary.front.iter().take(case.gauges.stations_m.len()) {
        let block = (2.0 * acceleration_from_rest(g, angle, base_friction(case)) * passage.x_m).sqrt();
        checks.push(
            Check::new(
                format!("{name}: front velocity at {} m", passage.x_m),
                passage.velocity_m_per_s,
                Expected::Within(block, (2.0 * g * (passage.x_m * angle.sin() + 0.5 * angle.cos())).sqrt()),
                "m/s",
            )
            .because("faster than a frictional block, slower than free fall from the top of the container")
            .from(Kind::Analytic, "energy of a block with and without friction"),
        );
    }
    checks
}

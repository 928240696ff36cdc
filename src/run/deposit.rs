//! What a run says of the deposit at its end.

use super::experiment::Experiment;
use super::means::{STATIC_WINDOW, late_mean};
use super::records::{MomentumRow, Records};
use crate::boundary::Friction;
use crate::seeded::{self, Seed};
use serde::Serialize;

/// Share of the weight that what is neither base nor barrier may hold for the limits of equilibrium to be given: the hundredth to which
/// equilibrium at rest is judged. The limits are those of all but the base together, and the barrier's differ by no more than that.
const OTHERS: f64 = 0.01;

/// Equilibrium at the end along the first base, positive where the flow runs: weight, base friction, side walls, barrier.
#[derive(Debug, Clone, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct DepositResults {
    /// m g sin of what lies on the base, N.
    pub weight_along_n: f64,
    /// m g (sin - mu cos): base friction fully mobilised up the flume, nothing on the barrier's face, N.
    pub theoretical_static_force_n: f64,
    /// Mean normal force of the base over the last 0.3 s, N.
    pub base_normal_n: f64,
    /// Mean friction of the base on the material, N; negative: up the flume.
    pub base_friction_n: f64,
    /// Mean force of the side walls on the material along the base, N; negative: up the flume.
    pub side_walls_n: f64,
    /// Friction that the base could give, mu N, N.
    pub friction_limit_n: f64,
    /// Share of it that is mobilised, -1 (up the flume, relieving the barrier) to 1 (down the flume, loading it).
    pub mobilised_1: f64,
    /// Least and greatest force along the flume that equilibrium allows on the barrier: m g sin -/+ mu N. Absent where other bases, walls,
    /// gates or side walls hold a part: then this base alone sets no limit.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub equilibrium_limits_n: Option<[f64; 2]>,
    /// Mean force that the material exerts along the flume on all boundaries but the base over the last 0.3 s, N.
    pub held_along_flume_n: f64,
    /// Weight plus friction of base and side walls less what is held, N: zero at rest.
    pub equilibrium_residual_n: f64,
}

/// A base that is not the first.
#[derive(Debug, Clone, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct FurtherBase {
    /// Its name in the case.
    pub name: String,
    /// Mean normal force on the material over the last 0.3 s, N.
    pub base_normal_n: f64,
    /// Mean friction on the material over the last 0.3 s, N; negative: up the flume.
    pub base_friction_n: f64,
}

fn minus(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    [a[0] - b[0], a[1] - b[1]]
}

/// Those after the first, of which there are samples.
pub(super) fn further_bases(experiment: &Experiment, records: &Records) -> Vec<FurtherBase> {
    let with_samples = experiment.bases().iter().skip(1).zip(&records.further_bases);
    let results = with_samples.map(|(b, samples)| {
        let normal = late_mean(samples, 0.0, 1.0, |r| r.base.normal);
        let friction = late_mean(samples, 0.0, 1.0, |r| r.base.friction);
        let [base_normal_n, base_friction_n] = seeded::exchanged(Seed::RunFurther, [normal, friction]);
        FurtherBase { name: b.name.clone(), base_normal_n, base_friction_n }
    });
    results.collect()
}

/// `None` without a base that has friction, or without a sample.
pub(super) fn results(experiment: &Experiment, records: &Records) -> Option<DepositResults> {
    let sim = experiment.simulation();
    let base = &sim.boundaries()[experiment.base()?];
    let Friction::Coulomb(mu) = base.friction else { return None };
    records.history.last()?;
    let g = sim.gravity();
    let way = experiment.scales().along(base);
    let along = way * (g[0] * base.tangent.x + g[1] * base.tangent.y);
    let across = -(g[0] * base.normal.x + g[1] * base.normal.y);
    // What lies behind the barrier rests on the base, too, but does not push.
    let structures = experiment.structures();
    let behind = experiment.barriers().first().map_or(0.0, |b| b.behind(sim));
    let mass = sim.mass() - sim.stock_of(|b| structures.contains(&b)).mass - behind;
    let base_normal = late_mean(&records.history, 0.0, 1.0, |r| r.base.normal);
    let base_friction = late_mean(&records.history, 0.0, 1.0, |r| r.base.friction);
    let weight = seeded::times(Seed::RunWeight, mass * along);
    let limit = seeded::times(Seed::RunLimit, base.slip.map_or(mu, |s| s.peak) * base_normal);
    // What the other boundaries and bodies take, from the ledger: the barrier, and whatever else the deposit leans on. What clamps
    // do to a barrier that is a body is no concern of the deposit.
    let end = records.momentum.last()?;
    let start = records.momentum.iter().find(|r| r.time >= end.time - STATIC_WINDOW)?;
    let base_index = experiment.base()?;
    let clamps = |bodies: &[usize]| !bodies.is_empty() && bodies.iter().all(|b| structures.contains(b));
    let own = |b: usize| b == base_index || clamps(&sim.boundaries()[b].bodies);
    let along_base = |p: [f64; 2]| way * (p[0] * base.tangent.x + p[1] * base.tangent.y);
    let push = |row: &MomentumRow| -> f64 {
        let others = row.ledger.boundaries.iter().enumerate().filter(|(b, _)| !own(*b));
        let contacts = row.ledger.contacts.iter().zip(sim.contacts()).map(|(tally, rule)| {
            let sign = rule.bodies.map(|b| f64::from(u8::from(structures.contains(&b))));
            (sign[0] - sign[1]) * along_base(tally.exchange.impulse)
        });
        others.map(|(_, t)| along_base(t.impulse)).sum::<f64>() + contacts.sum::<f64>()
    };
    let duration = (end.time - start.time).max(f64::MIN_POSITIVE);
    let held = seeded::times(Seed::RunHeld, -(push(end) - push(start)) / duration);
    let side_walls = along_base(minus(end.ledger.side_walls.impulse, start.ledger.side_walls.impulse)) / duration;
    let side_walls = if seeded::is(Seed::RunSides) { 0.0 } else { side_walls };
    // Who else holds the deposit: walls, gates and further bases, and the side walls.
    let barriers: Vec<usize> = experiment.barriers().iter().filter_map(|b| b.force().boundary()).collect();
    let others = (0..sim.boundaries().len()).filter(|b| !own(*b) && !barriers.contains(b));
    let force = |p: [f64; 2]| p[0].hypot(p[1]) / duration;
    let impulse = |row: &MomentumRow, b: usize| row.ledger.boundaries[b].impulse;
    let others = others.map(|b| force(minus(impulse(end, b), impulse(start, b)))).sum::<f64>()
        + force(minus(end.ledger.side_walls.impulse, start.ledger.side_walls.impulse));
    let alone = others <= OTHERS * mass * g[0].hypot(g[1]);
    Some(DepositResults {
        weight_along_n: weight,
        theoretical_static_force_n: mass * (along - mu * across),
        base_normal_n: base_normal,
        base_friction_n: base_friction,
        side_walls_n: side_walls,
        friction_limit_n: limit,
        mobilised_1: if limit > 0.0 { base_friction / limit } else { 0.0 },
        equilibrium_limits_n: alone.then_some([weight - limit, weight + limit]),
        held_along_flume_n: held,
        equilibrium_residual_n: weight + base_friction + side_walls - held,
    })
}

//! What a run says: inputs resolved, results, ledgers, warnings.

use super::barrier;
pub use super::barrier::BarrierResults;
use super::experiment::{End, Experiment};
use super::means::{STATIC_WINDOW, arrival, late_mean};
use super::records::{HistoryRow, MomentumRow, Records};
use super::structure::{self, StructureResults};
use crate::boundary::Friction;
use crate::case::Case;
use serde::Serialize;

/// Everything worth knowing about a run; written as `summary.toml`.
#[derive(Debug, Clone, Serialize)]
pub struct Summary {
    /// How the run ended.
    pub status: String,
    /// Version of checkdam.
    pub checkdam_version: String,
    /// What deserves a second look.
    pub warnings: Vec<String>,
    /// Discretisation and stepping.
    pub stepping: Stepping,
    /// Forces on the barrier.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub barrier: Option<BarrierResults>,
    /// How a barrier that is a body took it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub structure: Option<StructureResults>,
    /// The barriers after the first.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub further_barriers: Vec<FurtherBarrier>,
    /// Equilibrium of the deposit at the end.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub deposit: Option<DepositResults>,
    /// Energy at the end.
    pub energy: EnergyResults,
    /// Momentum at the end.
    pub momentum: MomentumResults,
    /// The front as it passes the stations and reaches the barrier.
    pub front: Vec<FrontPassage>,
    /// The case with every default filled in.
    pub case: Case,
}

/// Discretisation and stepping.
#[derive(Debug, Clone, Serialize)]
pub struct Stepping {
    /// Material points at the start.
    pub particles: usize,
    /// Mass at the start, kg.
    pub mass_kg: f64,
    /// Time spent settling and tilting, s.
    pub settle_time_s: f64,
    /// Steps spent settling and tilting.
    pub settle_steps: u64,
    /// Residual at release: rms speed / sqrt(g x height).
    pub settle_residual: f64,
    /// End of the run, s after release.
    pub end_time_s: f64,
    /// Steps after release.
    pub run_steps: u64,
    /// Shortest time step after release, s.
    pub time_step_min_s: f64,
    /// Longest time step after release, s.
    pub time_step_max_s: f64,
    /// What limited the shortest time step.
    pub time_step_limited_by: String,
    /// The most sweeps over the nodes in contact that a step needed until bodies in implicit steps and contact agreed.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub contact_sweeps_max: Option<usize>,
}

/// A barrier that is not the first.
#[derive(Debug, Clone, Serialize)]
pub struct FurtherBarrier {
    /// Its name in the case.
    pub name: String,
    /// Forces on it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub barrier: Option<BarrierResults>,
    /// How it took it, if it is a body.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub structure: Option<StructureResults>,
}

/// Equilibrium along the flume at the end: weight, base friction, barrier.
#[derive(Debug, Clone, Serialize)]
pub struct DepositResults {
    /// m g sin of what lies on the base, N.
    pub weight_along_flume_n: f64,
    /// m g (sin - mu cos): base friction fully mobilised up the flume, nothing on the barrier's face, N.
    pub theoretical_static_force_n: f64,
    /// Mean normal force of the base over the last 0.3 s, N.
    pub base_normal_n: f64,
    /// Mean friction of the base on the material, N; negative: up the flume.
    pub base_friction_n: f64,
    /// Friction that the base could give, mu N, N.
    pub base_friction_limit_n: f64,
    /// Share of it that is mobilised, -1 (up the flume, relieving the barrier) to 1 (down the flume, loading it).
    pub mobilised_share: f64,
    /// Least and greatest force along the flume that equilibrium allows: m g sin -/+ mu N.
    pub friction_limits_n: [f64; 2],
    /// Mean force that the material exerts along the flume on all boundaries but the base over the last 0.3 s, N.
    pub held_along_flume_n: f64,
    /// Weight plus base friction less what is held, N: zero at rest.
    pub equilibrium_residual_n: f64,
}

/// Energy at the end, as shares of the energy at release.
#[derive(Debug, Clone, Serialize)]
pub struct EnergyResults {
    /// Kinetic, gravitational (above the barrier's foot) and elastic energy at release, J.
    pub initial_j: f64,
    /// Kinetic.
    pub kinetic: f64,
    /// Gravitational.
    pub gravitational: f64,
    /// Elastic.
    pub elastic: f64,
    /// Plastic.
    pub plastic: f64,
    /// Friction on the boundaries.
    pub friction: f64,
    /// Normal impact on the boundaries.
    pub contact: f64,
    /// PIC share of the velocity update.
    pub pic: f64,
    /// Side walls.
    pub side_walls: f64,
    /// Carried out of the domain.
    pub outflow: f64,
    /// Not accounted for, at the end.
    pub residual: f64,
    /// Not accounted for, largest magnitude at any time.
    pub residual_max: f64,
    /// Largest kinetic share at any time.
    pub kinetic_max: f64,
}

/// Momentum at the end.
#[derive(Debug, Clone, Serialize)]
pub struct MomentumResults {
    /// Sum of the magnitudes of all impulses, N s.
    pub impulse_scale_n_s: f64,
    /// Largest residual at any time over that scale.
    pub closure_max: f64,
    /// Mass that left the domain, kg.
    pub outflow_kg: f64,
    /// Deepest that any point lay inside a boundary, or inside a barrier that is a body, m.
    pub penetration_max_m: f64,
}

/// The front at a place.
#[derive(Debug, Clone, Serialize)]
pub struct FrontPassage {
    /// Where, m.
    pub x_m: f64,
    /// When, s.
    pub time_s: f64,
    /// Velocity of its first 0.05 m, m/s.
    pub velocity_m_per_s: f64,
    /// Largest depth in its first 0.1 m, m.
    pub depth_m: f64,
    /// velocity / sqrt(g depth cos).
    pub froude: f64,
}

impl Summary {
    /// Of a run that ended.
    pub fn new(case: &Case, experiment: &Experiment, records: &Records, end: End) -> Self {
        let status = match end {
            End::Rest => "completed: at rest",
            End::Time => "completed: end time reached before rest",
            End::Stopped => "stopped by the user; everything computed until then is here",
        };
        let mut summary = Self::build(case, experiment, records, status.into());
        if end != End::Rest {
            let text =
                "the material was not seen to come to rest: static values are means over the last 0.3 s, no more";
            summary.warnings.push(text.into());
        }
        summary
    }

    /// Of a run that failed.
    pub fn failed(case: &Case, experiment: &Experiment, records: &Records, error: &str) -> Self {
        Self::build(case, experiment, records, format!("failed: {error}"))
    }

    fn build(case: &Case, experiment: &Experiment, records: &Records, status: String) -> Self {
        let mut summary = Self {
            status,
            checkdam_version: env!("CARGO_PKG_VERSION").into(),
            warnings: Vec::new(),
            stepping: stepping(experiment),
            barrier: experiment.barrier().and_then(|gauge| barrier::results(gauge, &records.history)),
            structure: experiment.barriers().first().and_then(|b| structure::results(b, records, &records.energy)),
            further_barriers: further_barriers(experiment, records),
            deposit: deposit(experiment, records),
            energy: energy(records),
            momentum: momentum(records),
            front: passages(case, records),
            case: case.clone(),
        };
        summary.warn(experiment);
        summary
    }

    /// As a TOML document.
    pub fn to_toml(&self) -> String {
        // Every type here maps to TOML; a failure would be a programming error, shown in place.
        toml::to_string(self)
            .unwrap_or_else(|e| format!("status = {:?}\n# the summary could not be written: {e}\n", self.status))
    }

    fn warn(&mut self, experiment: &Experiment) {
        let sim = experiment.simulation();
        let h = sim.spacing();
        let mut warn = |text: String| self.warnings.push(text);
        if self.energy.residual_max.abs() > 0.02 {
            warn(format!(
                "energy does not close: {:.2} % of E0 is not accounted for",
                100.0 * self.energy.residual_max
            ));
        }
        if self.momentum.closure_max > 1e-10 {
            warn(format!("momentum does not close: {:.1e} of all impulses", self.momentum.closure_max));
        }
        if self.momentum.penetration_max_m > h {
            warn(format!(
                "material lay {:.1} cells deep inside a boundary or the barrier",
                self.momentum.penetration_max_m / h
            ));
        }
        if self.momentum.outflow_kg > 0.0 {
            warn(format!("{:.4} kg left the domain", self.momentum.outflow_kg));
        }
        if let Some(b) = &self.barrier {
            b.warn("the barrier", &mut warn);
        }
        if let Some([most, allowed]) = sim.contact_sweeps()
            && most >= allowed
        {
            warn(format!("contact with a body in implicit steps was not settled after {allowed} sweeps of a step"));
        }
        if let Some(s) = &self.structure {
            s.warn("the barrier", &mut warn);
        }
        for further in &self.further_barriers {
            let name = format!("barrier `{}`", further.name);
            further.barrier.iter().for_each(|b| b.warn(&name, &mut warn));
            further.structure.iter().for_each(|s| s.warn(&name, &mut warn));
        }
        if let Some(d) = &self.deposit
            && d.mobilised_share.abs() < 0.9
        {
            warn(format!(
                "the base mobilises {:.0} % of its friction at rest: any force between {:.1} and {:.1} N is in equilibrium, \
                 and which one it is depends on the history",
                100.0 * d.mobilised_share,
                d.friction_limits_n[0],
                d.friction_limits_n[1]
            ));
        }
    }
}

fn stepping(experiment: &Experiment) -> Stepping {
    let (sim, facts) = (experiment.simulation(), experiment.facts());
    let opening = sim.opening();
    Stepping {
        particles: facts.particles,
        mass_kg: opening.mass,
        settle_time_s: facts.settle_time,
        settle_steps: facts.settle_steps,
        settle_residual: facts.settle_residual,
        end_time_s: facts.end_time.max(sim.time()),
        run_steps: facts.run_steps,
        time_step_min_s: if facts.run_steps > 0 { facts.time_step[0] } else { 0.0 },
        time_step_max_s: facts.time_step[1],
        time_step_limited_by: facts.shortest.map_or_else(|| "no step was made".into(), |s| sim.describe_limit(&s)),
        contact_sweeps_max: sim.contact_sweeps().map(|[most, _]| most),
    }
}

fn further_barriers(experiment: &Experiment, records: &Records) -> Vec<FurtherBarrier> {
    let with_records = experiment.barriers().iter().skip(1).zip(&records.further);
    let results = with_records.map(|(b, own)| FurtherBarrier {
        name: b.name().into(),
        barrier: barrier::results(b.force(), &own.history),
        structure: structure::results(b, own, &records.energy),
    });
    results.collect()
}

fn deposit(experiment: &Experiment, records: &Records) -> Option<DepositResults> {
    let sim = experiment.simulation();
    let base = &sim.boundaries()[experiment.base()?];
    let Friction::Coulomb(mu) = base.friction else { return None };
    let last = records.history.last()?;
    let g = sim.gravity();
    let along = g[0] * base.tangent.x + g[1] * base.tangent.y;
    let across = -(g[0] * base.normal.x + g[1] * base.normal.y);
    // What lies behind the barrier rests on the base, too, but does not push.
    let structures = experiment.structures();
    let barrier = experiment.barrier()?.boundary();
    let departed = barrier.map_or(sim.ledger().departed_mass, |b| sim.ledger().departed_behind[b]);
    let mass = sim.mass() - sim.stock_of(|b| structures.contains(&b)).mass - (last.overtopped - departed);
    let base_normal = late_mean(&records.history, 0.0, 1.0, |r| r.base_normal);
    let base_friction = late_mean(&records.history, 0.0, 1.0, |r| r.base_friction);
    let weight = mass * along;
    let limit = mu * base_normal;
    // What the other boundaries and bodies take, from the ledger: the barrier, and whatever else the deposit leans on. What clamps
    // do to a barrier that is a body is no concern of the deposit.
    let end = records.momentum.last()?;
    let start = records.momentum.iter().find(|r| r.time >= end.time - STATIC_WINDOW)?;
    let base_index = experiment.base()?;
    let own = |b: usize| b == base_index || structures.iter().any(|s| sim.boundaries()[b].bodies == [*s]);
    let push = |row: &MomentumRow| -> f64 {
        let along = |p: [f64; 2]| p[0] * base.tangent.x + p[1] * base.tangent.y;
        let others = row.ledger.boundaries.iter().enumerate().filter(|(b, _)| !own(*b));
        let contacts = row.ledger.contacts.iter().zip(sim.contacts()).map(|(tally, rule)| {
            let sign = rule.bodies.map(|b| f64::from(u8::from(structures.contains(&b))));
            (sign[0] - sign[1]) * along(tally.exchange.impulse)
        });
        others.map(|(_, t)| along(t.impulse)).sum::<f64>() + contacts.sum::<f64>()
    };
    let held = -(push(end) - push(start)) / (end.time - start.time).max(f64::MIN_POSITIVE);
    Some(DepositResults {
        weight_along_flume_n: weight,
        theoretical_static_force_n: mass * (along - mu * across),
        base_normal_n: base_normal,
        base_friction_n: base_friction,
        base_friction_limit_n: limit,
        mobilised_share: if limit > 0.0 { base_friction / limit } else { 0.0 },
        friction_limits_n: [weight - limit, weight + limit],
        held_along_flume_n: held,
        equilibrium_residual_n: weight + base_friction - held,
    })
}

fn energy(records: &Records) -> EnergyResults {
    let mut results = EnergyResults {
        initial_j: 0.0,
        kinetic: 0.0,
        gravitational: 0.0,
        elastic: 0.0,
        plastic: 0.0,
        friction: 0.0,
        contact: 0.0,
        pic: 0.0,
        side_walls: 0.0,
        outflow: 0.0,
        residual: 0.0,
        residual_max: 0.0,
        kinetic_max: 0.0,
    };
    let Some(last) = records.energy.last() else { return results };
    let e = &last.balance;
    results.initial_j = e.initial;
    if e.initial == 0.0 {
        return results;
    }
    let share = |x: f64| x / e.initial;
    results.kinetic = share(e.kinetic);
    results.gravitational = share(e.gravitational);
    results.elastic = share(e.elastic);
    results.plastic = share(e.plastic);
    results.friction = share(e.friction.iter().sum());
    results.contact = share(e.contact.iter().sum());
    results.pic = share(e.pic);
    results.side_walls = share(e.side_walls);
    results.outflow = share(e.outflow);
    results.residual = share(e.residual);
    let largest = |value: fn(&crate::ledger::EnergyBalance) -> f64| {
        records.energy.iter().map(|r| share(value(&r.balance)).abs()).fold(0.0, f64::max)
    };
    results.residual_max = largest(|b| b.residual);
    results.kinetic_max = largest(|b| b.kinetic);
    results
}

fn momentum(records: &Records) -> MomentumResults {
    let last = records.momentum.last();
    MomentumResults {
        impulse_scale_n_s: last.map_or(0.0, |r| r.ledger.impulse_scale),
        closure_max: records
            .momentum
            .iter()
            .filter(|r| r.ledger.impulse_scale > 0.0)
            .map(super::records::MomentumRow::closure)
            .fold(0.0, f64::max),
        outflow_kg: last.map_or(0.0, |r| r.ledger.departed_mass),
        penetration_max_m: records.history.iter().map(|r| r.penetration).fold(0.0, f64::max),
    }
}

fn passages(case: &Case, records: &Records) -> Vec<FrontPassage> {
    let g = case.gravity.magnitude_m_per_s2 * libm::cos(case.gravity.inclination_deg.to_radians());
    let at = |row: &HistoryRow, x: f64| FrontPassage {
        x_m: x,
        time_s: row.time,
        velocity_m_per_s: row.front.velocity,
        depth_m: row.front.depth,
        froude: row.front.velocity / (g * row.front.depth).sqrt(),
    };
    let stations = case.gauges.stations_m.iter();
    let mut passages: Vec<_> =
        stations.filter_map(|&x| records.history.iter().find(|r| r.front.x >= x).map(|row| at(row, x))).collect();
    // Just before the barrier is touched.
    if let Some(k) = records.history.iter().position(|r| Some(r.time) == arrival(&records.history))
        && k > 0
    {
        let row = &records.history[k - 1];
        passages.push(at(row, row.front.x));
    }
    passages
}

//! What a run says: inputs resolved, results, ledgers, warnings.

pub use super::balances::{EnergyResults, MomentumResults};
pub use super::barrier::BarrierResults;
pub use super::deposit::{DepositResults, FurtherBase};
use super::experiment::Experiment;
use super::means::arrival;
use super::records::{HistoryRow, Records};
use super::scales::Scales;
use super::stage::End;
use super::structure::{self, StructureResults};
use super::{balances, barrier, deposit, verdict};
use crate::case::Case;
use serde::Serialize;

/// Everything worth knowing about a run; written as `summary.toml`. A number that a study's `runs.csv` has as well has the same name there.
#[derive(Debug, Clone, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct Summary {
    /// Whether the numbers are to be trusted: false if there is a reason not to.
    pub trusted: bool,
    /// Why not, with numbers; empty if they are.
    pub reasons: Vec<String>,
    /// How the run ended.
    pub status: String,
    /// Version of checkdam.
    pub checkdam_version: String,
    /// What else deserves a second look, and takes nothing from the numbers.
    pub warnings: Vec<String>,
    /// Discretisation and stepping.
    pub stepping: Stepping,
    /// What the flow was measured by.
    pub scales: Scales,
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
    /// The bases after the first.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub further_bases: Vec<FurtherBase>,
    /// Energy at the end.
    pub energy: EnergyResults,
    /// Momentum at the end.
    pub momentum: MomentumResults,
    /// The front as it passes the stations and reaches the barrier.
    pub front: Vec<FrontPassage>,
    /// The case with every default filled in; its keys are those of a case file.
    pub case: Case,
}

/// Discretisation and stepping.
#[derive(Debug, Clone, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct Stepping {
    /// Material points at the start.
    pub particles: usize,
    /// Mass at the start, kg.
    pub mass_kg: f64,
    /// Time spent settling and tilting, s.
    pub settle_time_s: f64,
    /// Steps spent settling and tilting.
    pub settle_steps: u64,
    /// Residual at release: rms speed / sqrt(g x height) of what flows.
    pub settle_residual: f64,
    /// End of the run, s after release.
    pub end_s: f64,
    /// Steps after release.
    pub run_steps: u64,
    /// Shortest time step after release, s.
    pub time_step_min_s: f64,
    /// Longest time step after release, s.
    pub time_step_max_s: f64,
    /// What limited the shortest time step.
    pub time_step_limited_by: String,
    /// The most sweeps over the nodes in contact that a step needed until bodies in implicit steps or total-Lagrangian kinematics and contact
    /// agreed.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub contact_sweeps_max: Option<usize>,
}

/// A barrier that is not the first.
#[derive(Debug, Clone, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
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

/// The front at a place.
#[derive(Debug, Clone, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct FrontPassage {
    /// Where, m.
    pub x_m: f64,
    /// When 1 % of the mass that flows had passed it, s.
    pub time_s: f64,
    /// When the edge, the foremost point, passed it, s.
    pub edge_time_s: f64,
    /// Velocity of its first `front_length_m` of `[scales]`, m/s.
    pub velocity_m_per_s: f64,
    /// Largest depth in twice that length, m.
    pub depth_m: f64,
    /// velocity / sqrt(g depth cos).
    pub froude_1: f64,
}

impl Summary {
    /// Of a run that ended.
    pub fn new(case: &Case, experiment: &Experiment, records: &Records, end: End) -> Self {
        let status = match end {
            End::Rest => "completed: at rest",
            End::Time => "completed: end time reached before rest",
            End::Stopped => "stopped by the user; everything computed until then is here",
        };
        Self::build(case, experiment, records, status.into(), Some(end))
    }

    /// Of a run that failed.
    pub fn failed(case: &Case, experiment: &Experiment, records: &Records, error: &str) -> Self {
        Self::build(case, experiment, records, format!("failed: {error}"), None)
    }

    fn build(case: &Case, experiment: &Experiment, records: &Records, status: String, end: Option<End>) -> Self {
        let scales = *experiment.scales();
        let front = passages(case, records, &scales);
        let barrier = experiment.barrier().and_then(|gauge| barrier::results(gauge, &records.history, &scales));
        let barrier = arrived(barrier, experiment, front.last());
        let structure = |b| structure::results(b, records, &records.energy, &scales);
        let mut summary = Self {
            trusted: false,
            reasons: Vec::new(),
            status,
            checkdam_version: env!("CARGO_PKG_VERSION").into(),
            warnings: Vec::new(),
            stepping: stepping(experiment),
            scales,
            barrier,
            structure: experiment.barriers().first().and_then(structure),
            further_barriers: further_barriers(experiment, records, front.last()),
            deposit: deposit::results(experiment, records),
            further_bases: deposit::further_bases(experiment, records),
            energy: balances::energy(records),
            momentum: balances::momentum(records),
            front,
            case: case.clone(),
        };
        let (reasons, warnings): (Vec<_>, Vec<_>) =
            verdict::notes(&summary, experiment, records, end).into_iter().partition(|note| note.kind.doubts());
        summary.trusted = reasons.is_empty();
        summary.reasons = reasons.into_iter().map(|note| note.text).collect();
        summary.warnings = warnings.into_iter().map(|note| note.text).collect();
        summary
    }

    /// As a TOML document.
    pub fn to_toml(&self) -> String {
        // Every type here maps to TOML; a failure would be a programming error, shown in place.
        toml::to_string(self)
            .unwrap_or_else(|e| format!("status = {:?}\n# the summary could not be written: {e}\n", self.status))
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
        end_s: facts.end_time.max(sim.time()),
        run_steps: facts.run_steps,
        time_step_min_s: if facts.run_steps > 0 { facts.time_step[0] } else { 0.0 },
        time_step_max_s: facts.time_step[1],
        time_step_limited_by: facts.shortest.map_or_else(|| "no step was made".into(), |s| sim.describe_limit(&s)),
        contact_sweeps_max: sim.contact_sweeps().map(|[most, _]| most),
    }
}

fn further_barriers(experiment: &Experiment, records: &Records, front: Option<&FrontPassage>) -> Vec<FurtherBarrier> {
    let with_records = experiment.barriers().iter().skip(1).zip(&records.further);
    let results = with_records.map(|(b, own)| FurtherBarrier {
        name: b.name().into(),
        barrier: arrived(barrier::results(b.force(), &own.history, experiment.scales()), experiment, front),
        structure: structure::results(b, own, &records.energy, experiment.scales()),
    });
    results.collect()
}

/// The results of a barrier, held against the front if one arrived.
fn arrived(
    mut results: Option<BarrierResults>,
    experiment: &Experiment,
    front: Option<&FrontPassage>,
) -> Option<BarrierResults> {
    if let (Some(barrier), Some(front)) = (results.as_mut().filter(|b| b.arrival_s.is_some()), front) {
        barrier.compare(front, experiment.scales(), experiment.simulation().thickness());
    }
    results
}

fn passages(case: &Case, records: &Records, scales: &Scales) -> Vec<FrontPassage> {
    let g = case.gravity.magnitude_m_per_s2 * libm::cos(case.gravity.inclination_deg.to_radians());
    let way = scales.flow_direction_1;
    let first = |x: f64, place: fn(&HistoryRow) -> f64| records.history.iter().find(|r| way * place(r) >= way * x);
    let at = |row: &HistoryRow, x: f64| FrontPassage {
        x_m: x,
        time_s: row.time,
        edge_time_s: first(x, |r| r.front.edge).map_or(row.time, |r| r.time),
        velocity_m_per_s: row.front.velocity,
        depth_m: row.front.depth,
        froude_1: row.front.velocity / (g * row.front.depth).sqrt(),
    };
    let stations = case.gauges.stations_m.iter();
    let mut passages: Vec<_> = stations.filter_map(|&x| first(x, |r| r.front.x).map(|row| at(row, x))).collect();
    // Just before the barrier is touched.
    let arrived = arrival(&records.history, scales.arrival_force_n);
    if let Some(k) = records.history.iter().position(|r| Some(r.time) == arrived)
        && k > 0
    {
        let row = &records.history[k - 1];
        passages.push(at(row, row.front.x));
    }
    passages
}

//! What a run says: inputs resolved, results, ledgers. Its verdict is made in `verdict`.

pub use super::balances::{EnergyResults, MomentumResults};
pub use super::barrier::BarrierResults;
pub use super::deposit::{DepositResults, FurtherBase};
pub use super::entered::InflowResults;
use super::experiment::Experiment;
use super::means::arrival;
pub use super::passage::FrontPassage;
use super::records::{HistoryRow, Records};
use super::scales::Scales;
use super::structure::{self, StructureResults};
use super::{balances, barrier, deposit, entered};
use crate::case::Case;
use crate::seeded::{self, Seed};
use serde::Serialize;

/// Everything worth knowing about a run; written as `summary.toml`. A number that a study's `runs.csv` has as well has the same name there.
#[derive(Debug, Clone, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct Summary {
    /// Whether the numbers are to be trusted: false if there is a reason not to.
    pub trusted: bool,
    /// Why not, with numbers; empty if they are.
    pub reasons: Vec<String>,
    /// How the run ended; `running` until then, also in what a run leaves that was killed.
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
    /// What has entered with inflows.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub inflow: Option<InflowResults>,
    /// Energy at the end.
    pub energy: EnergyResults,
    /// Momentum at the end.
    pub momentum: MomentumResults,
    /// The front as it passes the stations and reaches the barrier.
    pub front: Vec<FrontPassage>,
    /// Which of these is the one that reached the first barrier; none if nothing did, or if material lay there from the start.
    #[serde(skip)]
    pub arriving: Option<usize>,
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

impl Summary {
    /// Without its verdict.
    pub(super) fn build(case: &Case, experiment: &Experiment, records: &Records, status: String) -> Self {
        let scales = *experiment.scales();
        let mut front = at_stations(case, records, &scales);
        let barrier = experiment.barrier().and_then(|gauge| barrier::results(gauge, &records.history, &scales));
        let barrier = arrived(barrier, experiment, records);
        let before = before_arrival(case, records, &scales, arrival(&records.history, scales.arrival_force_n));
        let arriving = before.is_some().then_some(front.len());
        front.extend(before);
        let structure = |b| structure::results(b, records, &records.energy, &scales);
        Self {
            trusted: false,
            reasons: Vec::new(),
            status,
            checkdam_version: env!("CARGO_PKG_VERSION").into(),
            warnings: Vec::new(),
            stepping: stepping(experiment),
            scales,
            barrier,
            structure: experiment.barriers().first().and_then(structure),
            further_barriers: further_barriers(experiment, records),
            deposit: deposit::results(experiment, records),
            further_bases: deposit::further_bases(experiment, records),
            inflow: entered::results(experiment),
            energy: balances::energy(records),
            momentum: balances::momentum(records),
            front,
            arriving,
            case: case.clone(),
        }
    }

    /// What stands in `summary.toml` until the run ends: its inputs, and no number.
    pub fn running(case: &Case) -> String {
        let reasons = ["the run is not at its end: it goes on, or was killed"];
        let version = env!("CARGO_PKG_VERSION");
        written(&Running { trusted: false, reasons, status: RUNNING, checkdam_version: version, case }, RUNNING)
    }

    /// The front just before it reached the first barrier.
    pub fn arriving_front(&self) -> Option<&FrontPassage> {
        self.front.get(self.arriving?)
    }

    /// Mass at the start and of what has entered, kg.
    pub(super) fn mass_kg(&self) -> f64 {
        self.stepping.mass_kg + self.inflow.as_ref().map_or(0.0, |i| i.entered_kg)
    }

    /// As a TOML document.
    pub fn to_toml(&self) -> String {
        written(self, &self.status)
    }
}

/// What `status` says of a run that is not at its end.
pub const RUNNING: &str = "running";

/// The keys of a summary that are known from the start.
#[derive(Serialize)]
struct Running<'a> {
    trusted: bool,
    reasons: [&'static str; 1],
    status: &'static str,
    checkdam_version: &'static str,
    case: &'a Case,
}

fn written<T: Serialize>(summary: &T, status: &str) -> String {
    // Every type here maps to TOML; a failure would be a programming error, shown in place.
    let text = toml::to_string(summary)
        .unwrap_or_else(|e| format!("status = {status:?}\n# the summary could not be written: {e}\n"));
    match seeded::active() {
        Some(fault) => format!("# WRONG ON PURPOSE ({}): no number here is to be trusted\n{text}", fault.name),
        None => text,
    }
}

fn stepping(experiment: &Experiment) -> Stepping {
    let (sim, facts) = (experiment.simulation(), experiment.facts());
    let opening = sim.opening();
    Stepping {
        particles: facts.particles,
        mass_kg: seeded::times(Seed::RunMass, opening.mass),
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

fn further_barriers(experiment: &Experiment, records: &Records) -> Vec<FurtherBarrier> {
    let with_records = experiment.barriers().iter().skip(1).zip(&records.further);
    let results = with_records.map(|(b, own)| FurtherBarrier {
        name: b.name().into(),
        barrier: arrived(barrier::results(b.force(), &own.history, experiment.scales()), experiment, records),
        structure: structure::results(b, own, &records.energy, experiment.scales()),
    });
    results.collect()
}

/// The results of a barrier, held against the front if one arrived.
fn arrived(mut results: Option<BarrierResults>, experiment: &Experiment, records: &Records) -> Option<BarrierResults> {
    let scales = experiment.scales();
    if let Some(barrier) = &mut results
        && let Some(front) = before_arrival(experiment.case(), records, scales, barrier.arrival_s)
    {
        barrier.compare(&front, scales, experiment.simulation().thickness());
    }
    results
}

/// The front as it was in a row, as it passes `x` (m).
fn passage(case: &Case, records: &Records, scales: &Scales, row: &HistoryRow, x: f64) -> FrontPassage {
    let angle = if seeded::is(Seed::RunFroude) { 0.0 } else { case.gravity.inclination_deg.to_radians() };
    let g = case.gravity.magnitude_m_per_s2 * libm::cos(angle);
    FrontPassage {
        x_m: x,
        time_s: row.time,
        edge_time_s: match first_at(records, scales, x, |r| r.front.edge) {
            Some(edge) if !seeded::is(Seed::RunPassage) => edge.time,
            _ => row.time,
        },
        velocity_m_per_s: row.front.velocity,
        depth_m: row.front.depth,
        froude_1: row.front.velocity / (g * row.front.depth).sqrt(),
    }
}

/// The first row in which a place has reached `x` (m).
fn first_at<'a>(
    records: &'a Records,
    scales: &Scales,
    x: f64,
    place: fn(&HistoryRow) -> f64,
) -> Option<&'a HistoryRow> {
    let way = scales.flow_direction_1;
    records.history.iter().find(|r| way * place(r) >= way * x)
}

fn at_stations(case: &Case, records: &Records, scales: &Scales) -> Vec<FrontPassage> {
    let stations = case.gauges.stations_m.iter();
    let passed = |&x: &f64| Some(passage(case, records, scales, first_at(records, scales, x, |r| r.front.x)?, x));
    stations.filter_map(passed).collect()
}

/// The front just before a barrier is touched, `arrived` s after the release. Where the first row finds material there, nothing was seen to
/// arrive.
fn before_arrival(case: &Case, records: &Records, scales: &Scales, arrived: Option<f64>) -> Option<FrontPassage> {
    let arrived = arrived?;
    let k = records.history.iter().position(|r| r.time == arrived)?;
    let row = &records.history[k.checked_sub(1)?];
    Some(passage(case, records, scales, row, row.front.x))
}

#[cfg(test)]
#[path = "passages_tests.rs"]
mod passages_tests;

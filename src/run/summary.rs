//! What a run says: inputs resolved, results, ledgers, warnings.

pub use super::balances::{EnergyResults, MomentumResults};
pub use super::barrier::BarrierResults;
pub use super::deposit::{DepositResults, FurtherBase};
use super::experiment::Experiment;
use super::means::arrival;
use super::records::{HistoryRow, Records};
use super::stage::End;
use super::structure::{self, StructureResults};
use super::{balances, barrier, deposit};
use crate::case::Case;
use serde::Serialize;

/// Everything worth knowing about a run; written as `summary.toml`. A number that a study's `runs.csv` has as well has the same name there.
#[derive(Debug, Clone, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
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
    /// Residual at release: rms speed / sqrt(g x height).
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
    /// When, s.
    pub time_s: f64,
    /// Velocity of its first 0.05 m, m/s.
    pub velocity_m_per_s: f64,
    /// Largest depth in its first 0.1 m, m.
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
            deposit: deposit::results(experiment, records),
            further_bases: deposit::further_bases(experiment, records),
            energy: balances::energy(records),
            momentum: balances::momentum(records),
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
        if self.energy.energy_residual_1.abs() > 0.02 {
            warn(format!(
                "energy does not close: {:.2} % of E0 is not accounted for",
                100.0 * self.energy.energy_residual_1
            ));
        }
        if self.momentum.momentum_closure_1 > 1e-10 {
            warn(format!("momentum does not close: {:.1e} of all impulses", self.momentum.momentum_closure_1));
        }
        if self.momentum.penetration_m > h {
            warn(format!(
                "material lay {:.1} cells deep inside a boundary or the barrier",
                self.momentum.penetration_m / h
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
            warn(format!("contact with a structure was not settled after {allowed} sweeps of a step"));
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
            && d.mobilised_1.abs() < 0.9
        {
            warn(format!(
                "the base mobilises {:.0} % of its friction at rest: any force between {:.1} and {:.1} N is in equilibrium, \
                 and which one it is depends on the history",
                100.0 * d.mobilised_1,
                d.equilibrium_limits_n[0],
                d.equilibrium_limits_n[1]
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
        barrier: barrier::results(b.force(), &own.history),
        structure: structure::results(b, own, &records.energy),
    });
    results.collect()
}

fn passages(case: &Case, records: &Records) -> Vec<FrontPassage> {
    let g = case.gravity.magnitude_m_per_s2 * libm::cos(case.gravity.inclination_deg.to_radians());
    let at = |row: &HistoryRow, x: f64| FrontPassage {
        x_m: x,
        time_s: row.time,
        velocity_m_per_s: row.front.velocity,
        depth_m: row.front.depth,
        froude_1: row.front.velocity / (g * row.front.depth).sqrt(),
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

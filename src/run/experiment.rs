//! The stages of a run and the gauges that are read in it.

use super::ProgressFn;
use super::records::{EnergyRow, HistoryRow, MomentumRow, Recorder};
use super::rest::RestWatch;
use super::scene;
use crate::case::Case;
use crate::gauge::structure::ProfilePoint;
use crate::gauge::{BarrierGauge, StructureGauge, flow, layers};
use crate::output::OutputError;
use crate::plot::PlotError;
use crate::simulation::{Simulation, StepFailure};
use crate::timestep::TimeStep;

/// Steps between calls of the progress function and looks at the residual.
const STEPS_PER_LOOK: u64 = 25;
/// Samples per row of the ledgers and stations.
const SAMPLES_PER_LEDGER: u64 = 10;

/// A stage of the run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stage {
    /// Coming to rest behind the gate.
    Settle,
    /// The flume is being tilted.
    Tilt,
    /// The gate is open.
    Run,
}

impl Stage {
    /// In one word.
    pub fn name(self) -> &'static str {
        match self {
            Stage::Settle => "settle",
            Stage::Tilt => "tilt",
            Stage::Run => "run",
        }
    }
}

/// How far a run is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Progress {
    /// Stage.
    pub stage: Stage,
    /// Time within the stage, s.
    pub time: f64,
    /// Longest the stage can last, s.
    pub end: f64,
    /// Steps since the start of the first stage.
    pub steps: u64,
    /// Material points.
    pub particles: usize,
    /// Normal force on the barrier now, N.
    pub force: f64,
    /// Settling: residual; run: kinetic energy over the energy at release.
    pub residual: f64,
}

/// Why a run ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum End {
    /// The material came to rest.
    Rest,
    /// The end time was reached.
    Time,
    /// The user stopped it.
    Stopped,
}

/// What can go wrong in a run.
#[derive(Debug, thiserror::Error)]
pub enum RunError {
    /// The simulation failed.
    #[error("the simulation failed: {0}")]
    Step(Box<StepFailure>),
    /// The material did not settle.
    #[error(
        "the material did not settle: after {time} s the residual is {residual:.3e}, wanted {wanted:.3e}\n  \
         raise stages.settle.max_time_s or stages.settle.damping_per_s, or accept a larger stages.settle.residual"
    )]
    Unsettled {
        /// Time allowed, s.
        time: f64,
        /// Residual reached.
        residual: f64,
        /// Residual wanted.
        wanted: f64,
    },
    /// A file could not be written.
    #[error(transparent)]
    Output(#[from] OutputError),
    /// A figure could not be drawn.
    #[error(transparent)]
    Plot(#[from] PlotError),
}

impl From<StepFailure> for RunError {
    fn from(failure: StepFailure) -> Self {
        RunError::Step(Box::new(failure))
    }
}

/// Facts of the stages before the release, and of the stepping.
#[derive(Debug, Clone, Copy, Default)]
pub struct StageFacts {
    /// Material points at release.
    pub particles: usize,
    /// Time spent settling and tilting, s.
    pub settle_time: f64,
    /// Steps spent settling and tilting.
    pub settle_steps: u64,
    /// Residual at release.
    pub settle_residual: f64,
    /// Shortest and longest time step after release, s.
    pub time_step: [f64; 2],
    /// Steps after release.
    pub run_steps: u64,
    /// What limited the shortest time step.
    pub shortest: Option<TimeStep>,
    /// Time at the end, s after release.
    pub end_time: f64,
}

/// A simulation with its stages and gauges.
#[derive(Debug)]
pub struct Experiment {
    case: Case,
    simulation: Simulation,
    barrier: Option<BarrierGauge>,
    /// The same barrier, if it is a body.
    structure: Option<StructureGauge>,
    peak: PeakProfile,
    base: Option<usize>,
    base_impulse: [f64; 2],
    facts: StageFacts,
    stopped: bool,
    scratch_front: flow::FrontScratch,
    scratch_speed: Vec<f64>,
}

impl Experiment {
    /// Sets up a case that has passed validation.
    pub fn new(case: &Case) -> Self {
        let simulation = Simulation::new(scene::build(case));
        let find = |name: &Option<String>| name.as_ref().and_then(|n| simulation.boundary_index(n));
        let structure = case.gauges.barrier.as_ref().and_then(|name| structure(case, &simulation, name));
        let barrier = match &structure {
            Some(s) => Some(BarrierGauge::on_body(&simulation, s.body(), s.face().clone())),
            None => find(&case.gauges.barrier).map(|b| BarrierGauge::new(&simulation, b)),
        };
        let base = find(&case.gauges.base);
        Self {
            case: case.clone(),
            simulation,
            barrier,
            structure,
            peak: PeakProfile::default(),
            base,
            base_impulse: [0.0; 2],
            facts: StageFacts::default(),
            stopped: false,
            scratch_front: flow::FrontScratch::default(),
            scratch_speed: Vec::new(),
        }
    }

    /// The simulation.
    pub fn simulation(&self) -> &Simulation {
        &self.simulation
    }

    /// The gauge on the barrier.
    pub fn barrier(&self) -> Option<&BarrierGauge> {
        self.barrier.as_ref()
    }

    /// The gauge on a barrier that is a body.
    pub fn structure(&self) -> Option<&StructureGauge> {
        self.structure.as_ref()
    }

    /// How a barrier that is a body was bent when the mean force of a sample was largest.
    pub fn peak_profile(&self) -> &PeakProfile {
        &self.peak
    }

    /// Index of the body that is the barrier: what is said of the flow leaves it out.
    fn barrier_body(&self) -> Option<usize> {
        self.structure.as_ref().map(StructureGauge::body)
    }

    /// Index of the base.
    pub fn base(&self) -> Option<usize> {
        self.base
    }

    /// Gauges of the case.
    pub fn gauges(&self) -> &crate::case::Gauges {
        &self.case.gauges
    }

    /// Time between VTK frames, s; 0 for none.
    pub fn vtk_interval(&self) -> f64 {
        self.case.output.vtk_interval_s
    }

    /// Facts of the stages.
    pub fn facts(&self) -> &StageFacts {
        &self.facts
    }

    /// Level at which gravitational energy is zero: the barrier's foot, else the origin.
    pub fn datum(&self) -> [f64; 2] {
        self.barrier.as_ref().map_or([0.0; 2], |g| g.face(&self.simulation).foot().into())
    }

    /// All stages.
    pub fn run(&mut self, recorder: &mut dyn Recorder, progress: &mut ProgressFn) -> Result<End, RunError> {
        self.prepare(progress)?;
        self.release();
        if self.stopped { Ok(End::Stopped) } else { self.flow(recorder, progress) }
    }

    /// Settles and tilts.
    pub fn prepare(&mut self, progress: &mut ProgressFn) -> Result<(), RunError> {
        let Some(settle) = self.case.stages.settle.clone() else { return Ok(()) };
        self.simulation.set_damping(settle.damping_per_s);
        self.settle(progress)?;
        if let Some(tilt) = self.case.stages.tilt.clone() {
            let from = self.case.gravity.settle_inclination_or_default_deg();
            let to = self.case.gravity.inclination_deg;
            let start = self.simulation.time();
            while !self.stopped && self.simulation.time() < start + tilt.duration_s {
                let share = (self.simulation.time() - start) / tilt.duration_s;
                self.simulation.set_gravity(scene::gravity(&self.case, from + share * (to - from)));
                self.simulation.step()?;
                self.look(Stage::Tilt, start, tilt.duration_s, 0.0, progress);
            }
            self.simulation.set_gravity(scene::gravity(&self.case, to));
            self.settle(progress)?;
        }
        self.simulation.set_damping(0.0);
        Ok(())
    }

    /// Steps until the residual has stayed below its limit for one period of the body's slowest oscillation.
    fn settle(&mut self, progress: &mut ProgressFn) -> Result<(), RunError> {
        let Some(settle) = self.case.stages.settle.clone() else { return Ok(()) };
        let height = self.case.bodies.iter().map(|b| b.size_m()[1]).fold(0.0, f64::max);
        let slowest = self.simulation.bodies().iter().map(|b| b.p_wave_speed()).fold(f64::INFINITY, f64::min);
        let period = 4.0 * height / slowest;
        let scale = (self.case.gravity.magnitude_m_per_s2 * height).sqrt();
        let start = self.simulation.time();
        let mut last_above = start;
        let mut residual = f64::INFINITY;
        while !self.stopped && self.simulation.time() - last_above < period {
            self.simulation.step()?;
            if self.simulation.steps().is_multiple_of(STEPS_PER_LOOK) {
                // Structures are as good as at rest, and would make light of what the material does.
                let (sim, barrier) = (&self.simulation, self.barrier_body());
                let motion = flow::motion(sim, |b| Some(b) != barrier && !sim.bodies()[b].weightless);
                residual = (2.0 * motion.kinetic / motion.mass.max(f64::MIN_POSITIVE)).sqrt() / scale;
                if residual > settle.residual {
                    last_above = self.simulation.time();
                }
            }
            if self.simulation.time() - start > settle.max_time_s && residual > settle.residual {
                return Err(RunError::Unsettled { time: settle.max_time_s, residual, wanted: settle.residual });
            }
            self.look(Stage::Settle, start, settle.max_time_s, residual, progress);
        }
        self.facts.settle_residual = residual;
        Ok(())
    }

    fn look(&mut self, stage: Stage, start: f64, end: f64, residual: f64, progress: &mut ProgressFn) {
        let sim = &self.simulation;
        if !sim.steps().is_multiple_of(STEPS_PER_LOOK) {
            return;
        }
        let force = self.barrier.as_ref().map_or(0.0, |g| g.step_force(sim));
        let (time, steps, particles) = (sim.time() - start, sim.steps(), sim.particle_count());
        let go_on = progress(&Progress { stage, time, end, steps, particles, force, residual });
        self.stopped |= !go_on;
    }

    /// Opens the gates and the ledger, and starts the clock.
    pub fn release(&mut self) -> &Simulation {
        self.facts.settle_time = self.simulation.time();
        self.facts.settle_steps = self.simulation.steps();
        self.facts.particles = self.simulation.particle_count();
        self.simulation.set_time(0.0);
        self.simulation.open_ledger();
        self.simulation.release_gates();
        if let Some(structure) = &mut self.structure {
            structure.open(&self.simulation);
        }
        &self.simulation
    }

    fn flow(&mut self, recorder: &mut dyn Recorder, progress: &mut ProgressFn) -> Result<End, RunError> {
        let run = self.case.stages.run.clone();
        let energy = self.simulation.energy_balance(self.simulation.opening(), self.datum());
        let released = energy.initial.abs().max(f64::MIN_POSITIVE);
        let interval = 1.0 / self.case.gauges.sample_rate_hz;
        let frames = self.case.output.vtk_interval_s;
        let mut fields = self.case.gauges.field_times_s.clone().into_iter().peekable();
        let mut rest = RestWatch::default();
        let (mut samples, mut frame) = (0u64, 0u64);
        self.facts.time_step = [f64::INFINITY, 0.0];
        self.record_ledgers(recorder)?;
        loop {
            let time = self.simulation.time();
            while fields.next_if(|t| time >= *t).is_some() {
                self.record_field(time, recorder)?;
            }
            if frames > 0.0 && time >= frame as f64 * frames {
                recorder.frame(&self.simulation)?;
                self.record_profile(time, recorder)?;
                frame = (time / frames) as u64 + 1;
            }
            if time >= run.end_time_s || self.stopped || (run.stop_at_rest && rest.at_rest) {
                self.facts.end_time = time;
                if fields.peek().is_some() {
                    self.record_field(time, recorder)?;
                }
                return Ok(match () {
                    () if self.stopped => End::Stopped,
                    () if rest.at_rest => End::Rest,
                    () => End::Time,
                });
            }
            self.simulation.step()?;
            self.read_step();
            recorder.step(&self.simulation)?;
            if self.simulation.time() >= (samples + 1) as f64 * interval {
                samples = (self.simulation.time() / interval) as u64;
                let barrier = self.barrier_body();
                let motion = flow::motion(&self.simulation, |b| Some(b) != barrier);
                let row = self.sample(&motion, recorder)?;
                recorder.history(&row)?;
                let weight = motion.mass * self.case.gravity.magnitude_m_per_s2;
                rest.watch(&row, motion.momentum, interval, released, weight);
                if samples.is_multiple_of(SAMPLES_PER_LEDGER) {
                    self.record_ledgers(recorder)?;
                }
            }
            let share = rest.kinetic / released;
            self.look(Stage::Run, 0.0, run.end_time_s, share, progress);
        }
    }

    fn read_step(&mut self) {
        let sim = &self.simulation;
        let step = sim.time_step();
        self.facts.run_steps += 1;
        self.facts.time_step[1] = self.facts.time_step[1].max(step.dt);
        if step.dt < self.facts.time_step[0] {
            self.facts.time_step[0] = step.dt;
            self.facts.shortest = Some(step);
        }
        if let Some(gauge) = &mut self.barrier {
            gauge.after_step(sim);
        }
        if let Some(gauge) = &mut self.structure {
            gauge.after_step(sim);
        }
        if let Some(base) = self.base {
            let (b, t) = (&sim.boundaries()[base], &sim.step_tallies()[base]);
            self.base_impulse[0] += t.impulse[0] * b.normal.x + t.impulse[1] * b.normal.y;
            self.base_impulse[1] += t.impulse[0] * b.tangent.x + t.impulse[1] * b.tangent.y;
        }
    }

    fn sample(&mut self, motion: &flow::Motion, recorder: &mut dyn Recorder) -> Result<HistoryRow, OutputError> {
        let sim = &self.simulation;
        let barrier = self.barrier_body();
        let mut row = HistoryRow {
            time: sim.time(),
            kinetic: motion.kinetic,
            time_step: sim.time_step().dt,
            front: flow::front(sim, barrier, &mut self.scratch_front),
            penetration: flow::penetration(sim).0,
            ..HistoryRow::default()
        };
        if let Some(gauge) = &mut self.barrier {
            let force = gauge.sample();
            row.normal = force.normal;
            row.tangential = force.tangential;
            row.moment = force.moment;
            row.normal_max = force.normal_max;
            if let Some(boundary) = gauge.boundary() {
                row.layers = layers::normal_force(sim, boundary);
                let wall = flow::wall_state(sim, boundary);
                row.run_up = wall.run_up;
                row.overtopped = wall.overtopped;
            }
            if self.base.is_some() && force.duration > 0.0 {
                row.base_normal = self.base_impulse[0] / force.duration;
                row.base_friction = self.base_impulse[1] / force.duration;
                self.base_impulse = [0.0; 2];
            }
        }
        if let Some(gauge) = &mut self.structure {
            let sample = gauge.sample(sim);
            row.layers = sample.survey.layers;
            row.run_up = sample.survey.run_up;
            row.overtopped = sample.survey.overtopped;
            row.penetration = row.penetration.max(sample.survey.penetration);
            if row.normal > self.peak.force {
                self.peak = PeakProfile { force: row.normal, time: row.time, points: gauge.profile() };
            }
            recorder.structure(row.time, &sample)?;
        }
        if let (Some(x), Some(y)) = (self.case.gauges.window_x_m, self.case.gauges.window_y_m) {
            let speed = flow::window_speed(sim, barrier, &flow::Window { x, y }, &mut self.scratch_speed);
            row.window_speed = [speed.0, speed.1];
        }
        Ok(row)
    }

    fn record_ledgers(&mut self, recorder: &mut dyn Recorder) -> Result<(), OutputError> {
        let sim = &self.simulation;
        let now = sim.stock();
        let balance = sim.energy_balance(&now, self.datum());
        recorder.energy(&EnergyRow { time: sim.time(), balance })?;
        recorder.momentum(&MomentumRow::new(sim.time(), sim.ledger(), sim.opening(), &now))?;
        let at = &self.case.gauges.stations_m;
        if !at.is_empty() {
            let rows = flow::stations(sim, self.barrier_body(), at);
            let rows: Vec<_> = at.iter().zip(rows).map(|(&x, (depth, velocity))| (x, depth, velocity)).collect();
            recorder.stations(sim.time(), &rows)?;
        }
        Ok(())
    }

    fn record_field(&self, time: f64, recorder: &mut dyn Recorder) -> Result<(), OutputError> {
        recorder.field(time, &flow::velocity_field(&self.simulation, self.barrier_body()))?;
        self.structure.as_ref().map_or(Ok(()), |s| recorder.outline(time, &s.outline()))
    }

    fn record_profile(&mut self, time: f64, recorder: &mut dyn Recorder) -> Result<(), OutputError> {
        let thickness = self.simulation.thickness();
        if let Some(gauge) = self.structure.as_ref().filter(|_| time > 0.0) {
            recorder.bending(time, &gauge.profile())?;
        }
        match &mut self.barrier {
            Some(gauge) if time > 0.0 => recorder.profile(time, &gauge.profile(thickness)),
            _ => Ok(()),
        }
    }
}

/// How a barrier was bent at its largest force.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct PeakProfile {
    /// Mean normal force of the sample, N.
    pub force: f64,
    /// End of the sample, s.
    pub time: f64,
    /// The points of its face.
    pub points: Vec<ProfilePoint>,
}

/// The gauge on the body of this name; `None` if a boundary has it.
fn structure(case: &Case, simulation: &Simulation, name: &str) -> Option<StructureGauge> {
    let (body, face) = (scene::index(case, name)?, scene::barrier_face(case, name)?);
    let b = &case.bodies[body];
    let counts = b.particle_counts(&case.grid).map(|n| n as usize);
    Some(StructureGauge::new(simulation, body, face, counts, b.rotation_deg.to_radians()))
}

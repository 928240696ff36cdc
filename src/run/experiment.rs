//! The stages of a run and the gauges that are read in it.
//!
//! Elsewhere: the driver; stages are load steps.

use super::ProgressFn;
use super::gauges::{Barrier, Gauges, Named, of_barrier};
use super::records::{EnergyRow, HistoryRow, MomentumRow, Recorder};
use super::rest::RestWatch;
use super::scene;
use super::stage::{End, Progress, RunError, Stage, StageFacts};
use crate::case::Case;
use crate::gauge::{BarrierGauge, BaseGauge, StructureGauge, WindowGauge, flow, velocity_field};
use crate::output::OutputError;
use crate::simulation::Simulation;

/// Steps between calls of the progress function and looks at the residual.
const STEPS_PER_LOOK: u64 = 25;
/// Samples per row of the ledgers and stations.
const SAMPLES_PER_LEDGER: u64 = 10;

/// A simulation with its stages and gauges.
#[derive(Debug)]
pub struct Experiment {
    case: Case,
    simulation: Simulation,
    gauges: Gauges,
    facts: StageFacts,
    stopped: bool,
}

impl Experiment {
    /// Sets up a case that has passed validation.
    pub fn new(case: &Case) -> Self {
        let simulation = Simulation::new(scene::build(case));
        let gauges = Gauges::new(case, &simulation);
        Self { case: case.clone(), simulation, gauges, facts: StageFacts::default(), stopped: false }
    }

    /// The simulation.
    pub fn simulation(&self) -> &Simulation {
        &self.simulation
    }

    /// The barriers, in the order of the case. The first is what is meant by the barrier.
    pub fn barriers(&self) -> &[Barrier] {
        &self.gauges.barriers
    }

    /// The gauge on the barrier.
    pub fn barrier(&self) -> Option<&BarrierGauge> {
        self.barriers().first().map(Barrier::force)
    }

    /// The gauge on the barrier, if it is a body.
    pub fn structure(&self) -> Option<&StructureGauge> {
        self.barriers().first().and_then(Barrier::structure)
    }

    /// Indices of the bodies that are barriers.
    pub(super) fn structures(&self) -> &[usize] {
        &self.gauges.structures
    }

    /// Index of the base.
    pub fn base(&self) -> Option<usize> {
        self.bases().first().map(|b| b.gauge.boundary())
    }

    /// The bases, in the order of the case. The first is what is meant by the base.
    pub(super) fn bases(&self) -> &[Named<BaseGauge>] {
        &self.gauges.bases
    }

    /// The windows with names, in the order of the case.
    pub(super) fn windows(&self) -> &[Named<WindowGauge>] {
        &self.gauges.windows
    }

    /// One step, as at the start of a run.
    #[cfg(test)]
    pub(crate) fn step_for_tests(&mut self) -> Result<(), RunError> {
        self.simulation.step()?;
        self.read_step();
        Ok(())
    }

    /// The case.
    pub(super) fn case(&self) -> &Case {
        &self.case
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
        self.barrier().map_or([0.0; 2], |g| g.face(&self.simulation).foot().into())
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
                let (sim, structures) = (&self.simulation, self.structures());
                let motion = flow::motion(sim, |b| !structures.contains(&b) && !sim.bodies()[b].weightless);
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
        let force = self.barrier().map_or(0.0, |g| g.step_force(sim));
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
        self.gauges.open(&self.simulation);
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
                let motion = flow::motion(&self.simulation, |b| !self.structures().contains(&b));
                let row = self.gauges.sample(&self.simulation, recorder)?;
                let row = HistoryRow { kinetic: motion.kinetic, ..row };
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
        self.gauges.after_step(sim);
    }

    fn record_ledgers(&mut self, recorder: &mut dyn Recorder) -> Result<(), OutputError> {
        let sim = &self.simulation;
        let now = sim.stock();
        let balance = sim.energy_balance(&now, self.datum());
        recorder.energy(&EnergyRow { time: sim.time(), balance })?;
        recorder.momentum(&MomentumRow::new(sim.time(), sim.ledger(), sim.opening(), &now))?;
        self.gauges.sample_stations(sim, recorder)
    }

    fn record_field(&self, time: f64, recorder: &mut dyn Recorder) -> Result<(), OutputError> {
        recorder.field(time, &velocity_field(&self.simulation, self.structures()))?;
        for (k, barrier) in self.barriers().iter().enumerate() {
            if let (Some(structure), Some(recorder)) = (barrier.structure(), of_barrier(recorder, k)) {
                recorder.outline(time, &structure.outline())?;
            }
        }
        let sim = &self.simulation;
        recorder.contact(time, sim.time_step().dt, sim.contact_points())
    }

    fn record_profile(&mut self, time: f64, recorder: &mut dyn Recorder) -> Result<(), OutputError> {
        if time <= 0.0 {
            return Ok(());
        }
        for (k, barrier) in self.gauges.barriers.iter_mut().enumerate() {
            let Some(recorder) = of_barrier(recorder, k) else { continue };
            if let Some(structure) = barrier.structure() {
                recorder.bending(time, &structure.profile())?;
            }
            recorder.profile(time, &barrier.pressure(&self.simulation))?;
        }
        Ok(())
    }
}

//! The stages of a run and the gauges that are read in it.
//!
//! Elsewhere: the driver; stages are load steps.

use super::ProgressFn;
use super::clock::{Clock, METER_HZ};
use super::gauges::{Barrier, Gauges, Named, of_barrier};
use super::inflow;
use super::records::{EnergyRow, HistoryRow, MomentumRow, Recorder, Rows};
use super::rest::RestWatch;
use super::scales::Scales;
use super::scene;
use super::stage::{End, RunError, Stage, StageFacts};
use crate::case::Case;
use crate::gauge::flow::{self, Motion};
use crate::gauge::{BarrierGauge, BaseGauge, StructureGauge, WindowGauge, velocity_beyond, velocity_field};
use crate::output::OutputError;
use crate::seeded::{self, Seed};
use crate::simulation::Simulation;

/// A simulation with its stages and gauges.
#[derive(Debug)]
pub struct Experiment {
    pub(super) case: Case,
    pub(super) simulation: Simulation,
    gauges: Gauges,
    pub(super) facts: StageFacts,
    pub(super) stopped: bool,
    /// Most energy that had been released by any row of the ledgers that numbers with a name come from, J.
    pub(super) released: f64,
    /// Least velocity beyond the section of an inflow over that at which it enters; 1 without one.
    pub(super) velocity_beyond: f64,
}

/// Gauges of tables that are read at another rate than the numbers with a name come from.
struct Tables {
    gauges: Gauges,
    clock: Clock,
}

impl Experiment {
    /// Sets up a case that has passed validation.
    pub fn new(case: &Case) -> Self {
        let simulation = inflow::simulation(case);
        let gauges = Gauges::new(case, &simulation);
        Self {
            case: case.clone(),
            simulation,
            gauges,
            facts: StageFacts::default(),
            stopped: false,
            released: 0.0,
            velocity_beyond: 1.0,
        }
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
    pub fn structures(&self) -> &[usize] {
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

    /// One step of the run stage, read by the gauges: for those who drive it themselves, after [`prepare`](Self::prepare) and
    /// [`release`](Self::release). Nothing is recorded.
    ///
    /// # Errors
    /// The step fails.
    pub fn step(&mut self) -> Result<(), RunError> {
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

    /// What the flow is measured by.
    pub fn scales(&self) -> &Scales {
        &self.gauges.scales
    }

    /// A place at the level at which gravitational energy is zero: the barrier's foot, or the lowest corner of what flows as it is drawn,
    /// if that is lower or there is no barrier. So shares of the energy at release do not know where the origin is.
    pub fn datum(&self) -> [f64; 2] {
        let angle = self.case.gravity.inclination_deg.to_radians();
        let (sin, cos) = (libm::sin(angle), libm::cos(angle));
        let level = |x: &[f64; 2]| x[1] * cos - x[0] * sin;
        let flows = |name: &str| scene::index(&self.case, name).is_none_or(|k| !self.structures().contains(&k));
        let bodies = self.case.bodies.iter().filter(|b| !b.weightless && flows(&b.name));
        let down = [sin, -cos];
        let corners = bodies.filter_map(|b| Some(b.drawing()?.farthest_m(down)));
        let corners = corners.chain(self.case.inflows.iter().map(|i| i.foot_m));
        let foot = self.barrier().map(|g| g.face(&self.simulation).foot().into());
        let lower = |a: [f64; 2], b: [f64; 2]| if level(&b) < level(&a) { b } else { a };
        let found = foot.into_iter().chain(corners).reduce(lower).filter(|_| !seeded::is(Seed::RunDatum));
        found.unwrap_or_default()
    }

    /// All stages.
    pub fn run(&mut self, recorder: &mut dyn Recorder, progress: &mut ProgressFn) -> Result<End, RunError> {
        if let Err(error) = self.prepare(progress) {
            self.note_settling();
            if matches!(error, RunError::Unsettled { .. }) {
                let cells = velocity_field(&self.simulation, self.structures());
                recorder.unsettled(self.simulation.time(), &cells)?;
            }
            return Err(error);
        }
        self.release();
        if self.stopped { Ok(End::Stopped) } else { self.flow(recorder, progress) }
    }

    /// Opens the gates and the ledger, and starts the clock.
    pub fn release(&mut self) -> &Simulation {
        self.note_settling();
        self.simulation.set_time(0.0);
        self.simulation.open_ledger();
        self.simulation.release_gates();
        self.simulation.open_inflows();
        self.gauges.open(&self.simulation);
        &self.simulation
    }

    fn note_settling(&mut self) {
        self.facts.settle_time = self.simulation.time();
        self.facts.settle_steps = self.simulation.steps();
        self.facts.particles = self.simulation.particle_count();
    }

    fn flow(&mut self, recorder: &mut dyn Recorder, progress: &mut ProgressFn) -> Result<End, RunError> {
        let run = self.case.stages.run.clone();
        let initial = self.simulation.energy_balance(self.simulation.opening(), self.datum()).initial.abs();
        let frames = self.case.output.vtk_interval_s;
        let mut fields = self.case.gauges.field_times_s.clone().into_iter().peekable();
        let mut rest = RestWatch::default();
        let mut frame = 0u64;
        self.facts.time_step = [f64::INFINITY, 0.0];
        // What has a name comes from rows at a rate of its own; tables have theirs.
        let (mut meter, rate) = (Clock::new(METER_HZ), self.case.gauges.sample_rate_hz);
        let apart = recorder.has_tables() && rate != METER_HZ;
        let mut tables = apart.then(|| Tables { gauges: self.gauges.clone(), clock: Clock::new(rate) });
        self.record_ledgers(Rows::All, recorder)?;
        recorder.turn(if apart { Rows::Kept } else { Rows::All });
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
                if meter.is_silent() && self.facts.run_steps > 0 {
                    // A run that is shorter than a row is one.
                    self.sample(recorder)?;
                    self.record_ledgers(Rows::Kept, recorder)?;
                }
                return Ok(match () {
                    () if self.stopped => End::Stopped,
                    () if rest.at_rest => End::Rest,
                    () => End::Time,
                });
            }
            self.step()?;
            rest.gate |= self.is_gated() || self.simulation.is_entering();
            recorder.step(&self.simulation)?;
            if meter.strikes(self.simulation.time()) {
                let (row, motion) = self.sample(recorder)?;
                self.look_beyond();
                let weight = motion.mass * self.case.gravity.magnitude_m_per_s2;
                rest.watch(&row, motion.momentum, initial.max(self.released).max(f64::MIN_POSITIVE), weight);
                if meter.strikes_ten() {
                    self.record_ledgers(Rows::Kept, recorder)?;
                }
            }
            if let Some(tables) = &mut tables {
                tables.gauges.after_step(&self.simulation);
                if tables.clock.strikes(self.simulation.time()) {
                    recorder.turn(Rows::Written);
                    // As the others, for as long as it takes to read them.
                    std::mem::swap(&mut self.gauges, &mut tables.gauges);
                    let read = self.sample(recorder);
                    let due = tables.clock.strikes_ten();
                    let ledgers = if due { self.record_ledgers(Rows::Written, recorder) } else { Ok(()) };
                    std::mem::swap(&mut self.gauges, &mut tables.gauges);
                    recorder.turn(Rows::Kept);
                    read?;
                    ledgers?;
                }
            }
            let share = rest.kinetic / initial.max(self.released).max(f64::MIN_POSITIVE);
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

    /// How the flow moves beyond the sections of inflows that have filled that length.
    fn look_beyond(&mut self) {
        let sim = &self.simulation;
        for (inflow, own) in sim.inflows().zip(&self.case.inflows) {
            let (time, [_, end], length) = (sim.time(), inflow.way.span(), own.deepest_m());
            let speed = inflow.way.speed(time);
            // Twice that length: the wedge of a front is not the flow.
            if time > end || speed <= 0.0 || inflow.way.travel(time) < 2.0 * length + own.wedge_m() {
                continue;
            }
            if let Some(beyond) = velocity_beyond(sim, inflow, length) {
                self.velocity_beyond = self.velocity_beyond.min(beyond / speed);
            }
        }
    }

    /// Whether a gate that is still opening held material in the last step.
    fn is_gated(&self) -> bool {
        let gates = self.simulation.boundaries().iter().zip(self.simulation.step_tallies());
        gates.filter(|(b, _)| b.is_opening()).any(|(_, tally)| tally.impulse != [0.0; 2])
    }

    /// Reads the gauges into a row.
    fn sample(&mut self, recorder: &mut dyn Recorder) -> Result<(HistoryRow, Motion), OutputError> {
        let motion = flow::motion(&self.simulation, |b| !self.structures().contains(&b));
        let row = self.gauges.sample(&self.simulation, recorder)?;
        let row = HistoryRow { kinetic: motion.kinetic, ..row };
        recorder.history(&row)?;
        Ok((row, motion))
    }

    fn record_ledgers(&mut self, rows: Rows, recorder: &mut dyn Recorder) -> Result<(), OutputError> {
        let sim = &self.simulation;
        let now = sim.stock();
        let balance = sim.energy_balance(&now, self.datum());
        // Rest is judged by it, so rows that only stand in tables do not count.
        if rows.are_kept() {
            self.released = self.released.max(balance.released());
        }
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

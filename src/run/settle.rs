//! Settling and tilting, before the release.
//!
//! Elsewhere: dynamic relaxation, gravity loading.

use super::ProgressFn;
use super::experiment::Experiment;
use super::scene;
use super::stage::{RunError, Stage};
use crate::case::SettleScale;
use crate::gauge::flow;
use crate::seeded::{self, Seed};

/// Steps between calls of the progress function and looks at the residual.
const STEPS_PER_LOOK: u64 = 25;
/// Looks in a row at which the residual has to be below its limit: a thin body swings through rest between two of them.
const LOOKS: u32 = 4;

impl Experiment {
    /// Settles and tilts.
    ///
    /// # Errors
    /// A step fails, or the material does not settle.
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
            let to = if seeded::is(Seed::RunTilt) { from } else { to };
            self.simulation.set_gravity(scene::gravity(&self.case, to));
            self.settle(progress)?;
        }
        self.simulation.set_damping(if seeded::is(Seed::RunDamping) { settle.damping_per_s } else { 0.0 });
        Ok(())
    }

    /// Steps until the residual has stayed below its limit for one period of the slowest oscillation, and at some looks in a row.
    fn settle(&mut self, progress: &mut ProgressFn) -> Result<(), RunError> {
        let Some(settle) = self.case.stages.settle.clone() else { return Ok(()) };
        let (height, slowest) = self.settling(settle.scale);
        let period = 4.0 * height / slowest;
        let scale = (self.case.gravity.magnitude_m_per_s2 * height).sqrt();
        let start = self.simulation.time();
        let (mut last_above, mut below) = (start, 0);
        let mut residual = f64::INFINITY;
        while !self.stopped && (below < LOOKS || self.simulation.time() - last_above < period) {
            self.simulation.step()?;
            if self.simulation.steps().is_multiple_of(STEPS_PER_LOOK) {
                // Structures are as good as at rest, and would make light of what the material does.
                let (sim, structures) = (&self.simulation, self.structures());
                let motion = flow::motion(sim, |b| !structures.contains(&b) && !sim.bodies()[b].weightless);
                residual = (2.0 * motion.kinetic / motion.mass.max(f64::MIN_POSITIVE)).sqrt() / scale;
                below += 1;
                if residual > settle.residual {
                    (last_above, below) = (sim.time(), 0);
                    if sim.time() - start > settle.max_time_s {
                        self.facts.settle_residual = residual;
                        let (time, wanted) = (settle.max_time_s, settle.residual);
                        return Err(RunError::Unsettled { time, residual, wanted });
                    }
                }
            }
            self.look(Stage::Settle, start, settle.max_time_s, residual, progress);
        }
        self.facts.settle_residual = residual;
        Ok(())
    }

    /// Height by which settling is judged, m, and the slowest P-wave in it, m/s.
    fn settling(&self, scale: SettleScale) -> (f64, f64) {
        let (bodies, structures) = (&self.case.bodies, self.structures());
        let flows = |k: usize| !structures.contains(&k) && !bodies[k].weightless;
        // Without anything that flows, what is there is judged.
        let any = (0..bodies.len()).any(flows);
        let judged = |k: &usize| scale == SettleScale::TallestBody || !any || flows(*k);
        let chosen = || (0..bodies.len()).filter(judged);
        let slowest = chosen().map(|k| self.simulation.bodies()[k].p_wave_speed()).fold(f64::INFINITY, f64::min);
        let height = match scale {
            SettleScale::TallestBody => chosen().map(|k| bodies[k].size_m()[1]).fold(0.0, f64::max),
            SettleScale::Flow => {
                // Against the gravity in which it settles first, whichever way the axes lie.
                let down = self.case.gravity.settle_inclination_or_default_deg().to_radians();
                let up = [-libm::sin(down), libm::cos(down)];
                let extents = || chosen().filter_map(|k| Some(bodies[k].drawing()?.extent_m(up)));
                let [low, high] = [0, 1].map(|end| extents().map(move |e| e[end]));
                high.fold(f64::NEG_INFINITY, f64::max) - low.fold(f64::INFINITY, f64::min)
            }
        };
        (height, slowest)
    }

    /// Tells how far a stage is, now and then.
    pub(super) fn look(&mut self, stage: Stage, start: f64, end: f64, residual: f64, progress: &mut ProgressFn) {
        let sim = &self.simulation;
        if !sim.steps().is_multiple_of(STEPS_PER_LOOK) {
            return;
        }
        let force = self.barrier().map_or(0.0, |g| g.step_force(sim));
        let (time, steps, particles) = (sim.time() - start, sim.steps(), sim.particle_count());
        let go_on = progress(&super::stage::Progress { stage, time, end, steps, particles, force, residual });
        self.stopped |= !go_on;
    }
}

//! When a step goes wrong: what, which particle, where, and what limited the time step.

use super::Simulation;
use super::structure::Structure;
use crate::body::Particle;
use crate::timestep::{TimeStep, TimeStepLimit};

/// Why a step failed. The state is that of the failure, for inspection.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error(
    "{what} at t = {time:.6e} s (step {step}): particle {id} of body `{body}` at x = {x:.6} m, y = {y:.6} m\n  \
         speed {speed:.4e} m/s, volume ratio {volume_ratio:.4e}, mean stress {mean_stress:.4e} Pa\n  \
         the time step of {dt:.4e} s was limited by {limit}; a smaller `cfl` or a coarser grid may help"
)]
pub struct StepFailure {
    /// What went wrong.
    pub what: &'static str,
    /// Time at the failure, s.
    pub time: f64,
    /// Steps done.
    pub step: u64,
    /// Name of the body.
    pub body: Box<str>,
    /// Number of the point in its body.
    pub id: u32,
    /// Position, m.
    pub x: f64,
    /// Position, m.
    pub y: f64,
    /// Speed, m/s.
    pub speed: f64,
    /// Current over reference volume.
    pub volume_ratio: f64,
    /// Mean stress, Pa.
    pub mean_stress: f64,
    /// Time step, s.
    pub dt: f64,
    /// What limited the time step, in words.
    pub limit: Box<str>,
}

/// Volume ratio below which a point counts as inverted.
pub(super) const CRUSHED: f64 = 0.05;
/// What an implicit step of a mesh says that has no solution.
pub(super) const LOST: &str = "the implicit step of a body with a mesh has no solution";

impl Simulation {
    /// The failure, with the first point that shows it.
    pub(super) fn failure(&self, what: &'static str) -> StepFailure {
        let broken = |p: &Particle| {
            let numbers = [p.x[0], p.x[1], p.v[0], p.v[1], p.volume_ratio];
            numbers.iter().any(|x| !x.is_finite())
                || p.volume_ratio <= CRUSHED
                || p.speed() * self.time_step.dt > self.lattice.spacing
        };
        // A mesh fails between its points, or as a whole: the point of it that is compressed most stands for it.
        let meshes = self.structures.iter().filter_map(Structure::lagrangian);
        let failed = meshes.filter(|m| if what == LOST { m.is_lost() } else { m.smallest() <= CRUSHED });
        let in_mesh = failed.flat_map(|m| self.fields[m.field].particles());
        let found = self.particles().find(|(_, p)| broken(p));
        let found = found.or_else(|| in_mesh.min_by(|a, b| a.1.volume_ratio.total_cmp(&b.1.volume_ratio)));
        let found = found.or_else(|| self.particles().next());
        let (body, p) = found.map_or((0, Particle::default()), |(b, p)| (b, p));
        StepFailure {
            what,
            time: self.time,
            step: self.steps,
            body: self.bodies.get(body).map_or("", |b| &b.name).into(),
            id: p.id,
            x: p.x[0],
            y: p.x[1],
            speed: p.speed(),
            volume_ratio: p.volume_ratio,
            mean_stress: p.state.stress.mean(),
            dt: self.time_step.dt,
            limit: self.describe_limit(&self.time_step).into(),
        }
    }

    /// What limited a time step, in words.
    pub fn describe_limit(&self, step: &TimeStep) -> String {
        match step.limit {
            TimeStepLimit::Wave(b) => {
                format!(
                    "the P-wave of body `{}` ({:.4} m/s; its points reach {:.3} m/s)",
                    self.bodies[b].name, step.wave_speed, step.particle_speed
                )
            }
            TimeStepLimit::Speed(b) => {
                format!("the particle speed in body `{}` ({:.4} m/s)", self.bodies[b].name, step.particle_speed)
            }
            TimeStepLimit::Maximum => "the largest time step allowed".into(),
        }
    }
}

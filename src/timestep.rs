//! The stable time step, and what limits it.

use crate::body::Body;

/// What kept the time step from being longer.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TimeStepLimit {
    /// The P-wave of a body, by index.
    Wave(usize),
    /// Particle speed exceeds the wave speed of the limiting body, by index.
    Speed(usize),
    /// The largest step that the user allows.
    Maximum,
}

/// A time step with its reason.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TimeStep {
    /// Length, s.
    pub dt: f64,
    /// What limited it.
    pub limit: TimeStepLimit,
    /// P-wave speed of the limiting body, m/s.
    pub wave_speed: f64,
    /// Largest velocity component among its points, m/s.
    pub particle_speed: f64,
}

/// `cfl` h / (c + |v|) with the P-wave speed c of each body and the largest velocity component of its points; the smallest
/// over the bodies, or `maximum` if that is shorter.
///
/// `speeds` is parallel to `bodies`.
pub fn stable_time_step(bodies: &[Body], speeds: &[f64], spacing: f64, cfl: f64, maximum: f64) -> TimeStep {
    let mut best = TimeStep { dt: maximum, limit: TimeStepLimit::Maximum, wave_speed: 0.0, particle_speed: 0.0 };
    for (index, (body, &speed)) in bodies.iter().zip(speeds).enumerate() {
        let c = body.p_wave_speed();
        let dt = cfl * spacing / (c + speed);
        if dt < best.dt {
            let limit = if speed > c { TimeStepLimit::Speed(index) } else { TimeStepLimit::Wave(index) };
            best = TimeStep { dt, limit, wave_speed: c, particle_speed: speed };
        }
    }
    best
}

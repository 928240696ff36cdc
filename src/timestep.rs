//! The stable time step, and what limits it.
//!
//! Elsewhere: the Courant or CFL condition, the critical time step of explicit integration.

use crate::body::Body;
use crate::seeded::{self, Seed};

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
/// over the bodies in explicit steps, or `maximum` if that is shorter. Of a body with a mesh the larger of both speeds counts.
///
/// `speeds` is parallel to `bodies`.
pub fn stable_time_step(bodies: &[Body], speeds: &[f64], spacing: f64, cfl: f64, maximum: f64) -> TimeStep {
    let mut best = TimeStep { dt: maximum, limit: TimeStepLimit::Maximum, wave_speed: 0.0, particle_speed: 0.0 };
    for (index, (body, &speed)) in bodies.iter().zip(speeds).enumerate().filter(|(_, (body, _))| !body.implicit) {
        let c = body.p_wave_speed();
        // Nothing flows through the elements of a mesh: the speed counts where points would leave a cell.
        let fastest = if body.mesh.is_some() { c.max(speed) } else { c + speed };
        let fastest = if seeded::is(Seed::TimestepSpeed) { c } else { fastest };
        let dt = seeded::times(Seed::TimestepWave, cfl * spacing / fastest);
        if dt < best.dt {
            let limit = if speed > c { TimeStepLimit::Speed(index) } else { TimeStepLimit::Wave(index) };
            best = TimeStep { dt, limit, wave_speed: c, particle_speed: speed };
        }
    }
    best
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::constitutive::{AnyLaw, LinearElastic};

    /// A body with a P-wave speed of `c` m/s.
    fn body(c: f64) -> Body {
        Body {
            name: "body".into(),
            law: AnyLaw::LinearElastic(LinearElastic { bulk: c * c, shear: 0.0 }),
            point_mass: 2.0,
            point_volume: 2.0,
            points_per_direction: 1,
            point_spacing: 1.0,
            weightless: false,
            between_side_walls: true,
            implicit: false,
            mesh: None,
        }
    }

    #[test]
    fn nothing_outruns_a_share_of_a_cell_in_a_step() {
        let bodies = [body(3.0), body(8.0), body(5.0)];
        let step = |speeds: [f64; 3], maximum| stable_time_step(&bodies, &speeds, 0.5, 0.4, maximum);
        let expected = |dt, limit, wave_speed, particle_speed| TimeStep { dt, limit, wave_speed, particle_speed };
        assert_eq!(step([0.0, 2.0, 0.0], 1.0), expected(0.02, TimeStepLimit::Wave(1), 8.0, 2.0));
        assert_eq!(step([0.0, 0.0, 15.0], 1.0), expected(0.01, TimeStepLimit::Speed(2), 5.0, 15.0));
        assert_eq!(step([0.0, 8.0, 0.0], 1.0), expected(0.0125, TimeStepLimit::Wave(1), 8.0, 8.0));
        assert_eq!(step([0.0, 2.0, 0.0], 0.015), expected(0.015, TimeStepLimit::Maximum, 0.0, 0.0));
        // Of equals the first is named, and the maximum before all.
        assert_eq!(step([7.0, 2.0, 5.0], 1.0).limit, TimeStepLimit::Speed(0));
        assert_eq!(step([0.0, 2.0, 0.0], 0.02).limit, TimeStepLimit::Maximum);
        assert_eq!(stable_time_step(&[], &[], 0.5, 0.4, 0.3), expected(0.3, TimeStepLimit::Maximum, 0.0, 0.0));
    }
}

//! Force and moment that one thing puts on another, from the impulses of single steps: on a clamp from the structure that it
//! holds, on a structure from the material that strikes it.
//!
//! The clamp carries the load less the inertia of the structure, so during an impact its reaction lags behind the contact
//! force and overshoots it; at rest both are equal.

use super::peak::Peak;
use crate::simulation::Simulation;

/// Means over a sampling interval.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Reaction {
    /// Force x and y, N.
    pub force: [f64; 2],
    /// Moment about the reference point, counter-clockwise, N m.
    pub moment: f64,
    /// Length of the interval, s.
    pub duration: f64,
}

/// Sums impulses step by step.
#[derive(Debug, Clone, Default)]
pub struct ReactionGauge {
    impulse: [f64; 2],
    moment: f64,
    duration: f64,
    total: [f64; 2],
    peak_force: Peak,
    peak_moment: Peak,
}

impl ReactionGauge {
    /// A gauge that has seen nothing.
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds a step of `dt` (s) that ended at `time` (s): impulse (N s) and its moment (N m s).
    pub fn add(&mut self, impulse: [f64; 2], moment: f64, dt: f64, time: f64) {
        for (d, p) in impulse.into_iter().enumerate() {
            self.impulse[d] += p;
            self.total[d] += p;
        }
        self.moment += moment;
        self.duration += dt;
        let force = (impulse[0] * impulse[0] + impulse[1] * impulse[1]).sqrt() / dt;
        if force > self.peak_force.value {
            self.peak_force = Peak { value: force, time };
        }
        if moment.abs() / dt > self.peak_moment.value.abs() {
            self.peak_moment = Peak { value: moment / dt, time };
        }
    }

    /// Reads the last step of the boundary with index `boundary`: what the material puts on it, about its foot.
    pub fn after_step(&mut self, simulation: &Simulation, boundary: usize) {
        let tally = &simulation.step_tallies()[boundary];
        self.add(tally.impulse.map(|p| -p), -tally.moment, simulation.time_step().dt, simulation.time());
    }

    /// Means since the last call.
    pub fn sample(&mut self) -> Reaction {
        let per = if self.duration > 0.0 { 1.0 / self.duration } else { 0.0 };
        let reaction =
            Reaction { force: self.impulse.map(|p| p * per), moment: self.moment * per, duration: self.duration };
        self.impulse = [0.0; 2];
        self.moment = 0.0;
        self.duration = 0.0;
        reaction
    }

    /// Length of the interval so far, s.
    #[cfg(test)]
    pub fn sampled_duration(&self) -> f64 {
        self.duration
    }

    /// Impulse since the start, N s.
    pub fn total_impulse(&self) -> [f64; 2] {
        self.total
    }

    /// Largest force of a single step, N, and when.
    pub fn peak_force(&self) -> Peak {
        self.peak_force
    }

    /// Moment of largest size of a single step, with its sign, N m, and when.
    pub fn peak_moment(&self) -> Peak {
        self.peak_moment
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::boundary::{Boundary, Friction};
    use crate::scaffold::{Brick, THICKNESS, elastic, run_until, scene};
    use nalgebra::Vector2;

    #[test]
    fn means_totals_and_peaks() {
        let mut gauge = ReactionGauge::new();
        gauge.add([3.0, 4.0], -2.0, 0.5, 0.5);
        gauge.add([1.0, 0.0], 1.0, 0.5, 1.0);
        assert_eq!(gauge.peak_force(), Peak { value: 10.0, time: 0.5 });
        assert_eq!(gauge.peak_moment(), Peak { value: -4.0, time: 0.5 });
        assert_eq!(gauge.sample(), Reaction { force: [4.0, 4.0], moment: -1.0, duration: 1.0 });
        assert_eq!(gauge.sample(), Reaction::default());
        assert_eq!(gauge.total_impulse(), [4.0, 4.0]);
    }

    #[test]
    fn the_first_of_equal_peaks_counts() {
        let mut gauge = ReactionGauge::new();
        gauge.add([3.0, 4.0], -2.0, 0.25, 1.0);
        gauge.add([4.0, -3.0], 2.0, 0.25, 2.0);
        assert_eq!(
            (gauge.peak_force(), gauge.peak_moment()),
            (Peak { value: 20.0, time: 1.0 }, Peak { value: -8.0, time: 1.0 })
        );
        // The same impulses in a shorter step are larger forces.
        gauge.add([3.0, 4.0], 2.0, 0.125, 3.0);
        assert_eq!(
            (gauge.peak_force(), gauge.peak_moment()),
            (Peak { value: 40.0, time: 3.0 }, Peak { value: 16.0, time: 3.0 })
        );
    }

    #[test]
    fn a_clamp_carries_weight_and_moment() {
        // A beam pushed across by a body force equal to a tenth of its weight.
        let (law, density, h) = (elastic(1e6, 0.0), 1000.0, 0.025);
        let brick = Brick::new([0.0, -2.0 * h], [4, 22], h);
        let clamp = Boundary::plane("clamp", Vector2::new(0.05, 0.0), Vector2::new(0.0, 1.0), Friction::Bonded);
        let mut scene = scene(&brick, law, density, brick.points(), vec![clamp]);
        scene.gravity = [0.1, -1.0];
        scene.numerics.pic = crate::simulation::PicShare::Fraction(0.02);
        let mut simulation = crate::simulation::Simulation::new(scene);
        simulation.set_damping(25.0);
        run_until(&mut simulation, 2.5).expect("it runs");
        let mut gauge = ReactionGauge::new();
        for _ in 0..500 {
            simulation.step().expect("a step");
            gauge.after_step(&simulation, 0);
        }
        let found = gauge.sample();
        // The nodes on the plane hold the part of the beam inside the clamp and take the weight of that, too.
        let mass = density * 0.1 * 22.0 * h * THICKNESS;
        assert!((found.force[0] / (0.1 * mass) - 1.0).abs() < 1e-3, "{found:?}");
        assert!((found.force[1] / -mass - 1.0).abs() < 1e-3, "{found:?}");
        // Weights times arms as the beam hangs over; clockwise.
        let m = simulation.bodies()[0].point_mass;
        let moment: f64 = simulation.particles().map(|(_, p)| m * (-(p.x[0] - 0.05) - 0.1 * p.x[1])).sum();
        assert!(moment < 0.0 && (found.moment / moment - 1.0).abs() < 1e-3, "{found:?} {moment}");
    }
}

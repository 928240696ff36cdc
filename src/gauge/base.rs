//! Force of a boundary on what lies on it: the base that holds a deposit.

use crate::simulation::Simulation;

/// Means over a sampling interval, of what the boundary gives to the material.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct BaseSample {
    /// Force along its normal, N; positive when it carries.
    pub normal: f64,
    /// Force along its tangent, N; positive down the flume.
    pub friction: f64,
}

/// Sums impulses of a boundary step by step.
#[derive(Debug, Clone)]
pub struct BaseGauge {
    boundary: usize,
    impulse: [f64; 2],
    duration: f64,
}

impl BaseGauge {
    /// A gauge on the boundary with this index.
    pub fn new(boundary: usize) -> Self {
        Self { boundary, impulse: [0.0; 2], duration: 0.0 }
    }

    /// Index of the boundary.
    pub fn boundary(&self) -> usize {
        self.boundary
    }

    /// Reads the last step.
    pub fn after_step(&mut self, simulation: &Simulation) {
        let (b, t) = (&simulation.boundaries()[self.boundary], &simulation.step_tallies()[self.boundary]);
        self.impulse[0] += t.impulse[0] * b.normal.x + t.impulse[1] * b.normal.y;
        self.impulse[1] += t.impulse[0] * b.tangent.x + t.impulse[1] * b.tangent.y;
        self.duration += simulation.time_step().dt;
    }

    /// Means since the last call.
    pub fn sample(&mut self) -> BaseSample {
        if self.duration <= 0.0 {
            return BaseSample::default();
        }
        let sample = BaseSample { normal: self.impulse[0] / self.duration, friction: self.impulse[1] / self.duration };
        (self.impulse, self.duration) = ([0.0; 2], 0.0);
        sample
    }
}

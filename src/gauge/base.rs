//! Force of a boundary on what lies on it: the base that holds a deposit.

use crate::seeded::{self, Seed};
use crate::simulation::Simulation;

/// Means over a sampling interval, of what the boundary gives to the material.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct BaseSample {
    /// Force along its normal, N; positive when it carries.
    pub normal: f64,
    /// Force along it, N; positive where the flow runs.
    pub friction: f64,
}

/// Sums impulses of a boundary step by step.
#[derive(Debug, Clone)]
pub struct BaseGauge {
    boundary: usize,
    /// 1 if its tangent points where the flow runs, else -1.
    along: f64,
    impulse: [f64; 2],
    duration: f64,
}

impl BaseGauge {
    /// A gauge on the boundary with this index, along which the flow runs with its tangent (`along` = 1) or against it (-1).
    pub fn new(boundary: usize, along: f64) -> Self {
        Self { boundary, along, impulse: [0.0; 2], duration: 0.0 }
    }

    /// Index of the boundary.
    pub fn boundary(&self) -> usize {
        self.boundary
    }

    /// Reads the last step.
    pub fn after_step(&mut self, simulation: &Simulation) {
        let (b, t) = (&simulation.boundaries()[self.boundary], &simulation.step_tallies()[self.boundary]);
        let (normal, along) = (t.impulse[0] * b.normal.x + t.impulse[1] * b.normal.y, self.along);
        self.impulse[0] += seeded::times(Seed::GaugeBaseNormal, normal);
        self.impulse[1] +=
            seeded::times(Seed::GaugeBase, along) * (t.impulse[0] * b.tangent.x + t.impulse[1] * b.tangent.y);
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

//! What forces that act throughout the material did in a step.

/// Impulse and work of a distributed force on the material in one step.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Drag {
    /// N s.
    pub impulse: [f64; 2],
    /// J, negative when it dissipates.
    pub work: f64,
}

impl Drag {
    /// Adds an impulse (N s) on what moves at `mean` (m/s), the mean of its velocities before and after.
    pub fn add(&mut self, impulse: [f64; 2], mean: [f64; 2]) {
        self.impulse[0] += impulse[0];
        self.impulse[1] += impulse[1];
        self.work += impulse[0] * mean[0] + impulse[1] * mean[1];
    }

    /// Adds another drag.
    pub fn merge(&mut self, other: &Drag) {
        self.impulse[0] += other.impulse[0];
        self.impulse[1] += other.impulse[1];
        self.work += other.work;
    }
}

/// Impulse and work of everything that acts throughout the material but gravity.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Distributed {
    /// Mass-proportional damping.
    pub damping: Drag,
    /// Side-wall friction.
    pub side_walls: Drag,
    /// A field of accelerations, where one is set.
    pub field: Drag,
}

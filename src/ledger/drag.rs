//! What forces that act throughout the material did in a step.
//!
//! Elsewhere: dissipative body forces, such as damping in proportion to mass (Rayleigh).

use crate::seeded::{self, Seed};
use crate::space::{dot, plus};

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
        self.impulse = plus(self.impulse, impulse);
        self.work += seeded::times(Seed::LedgerWork, dot(impulse, mean));
    }

    /// Adds another drag.
    pub fn merge(&mut self, other: &Drag) {
        self.impulse = plus(self.impulse, other.impulse);
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

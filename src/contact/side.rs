//! What a node knows of one of the bodies that meet there.

use super::Vector;
use crate::space::mean;

/// One body at a node.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Side {
    /// Mass, kg, above zero.
    pub mass: f64,
    /// Velocity before the step, m/s.
    pub old: Vector,
    /// Velocity after the momentum balance, m/s; contact replaces it.
    pub velocity: Vector,
    /// Whether a clamp prescribes the velocity: contact leaves it alone, and the impulse goes into the clamp.
    pub fixed: bool,
    /// Whether other boundaries act on the body.
    pub held: bool,
}

impl Side {
    /// Velocity per impulse, 1/kg.
    #[inline(always)]
    pub(super) fn mobility(&self) -> f64 {
        if self.fixed { 0.0 } else { 1.0 / self.mass }
    }

    /// Mean of the velocities before and after the step, m/s.
    #[inline(always)]
    pub fn mean(&self) -> Vector {
        mean(self.old, self.velocity)
    }
}

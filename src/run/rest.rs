//! When the material counts as at rest.
//!
//! Elsewhere: a criterion of quasi-static equilibrium (steady state).

use super::records::HistoryRow;

/// Kinetic energy over the energy released, below which the material counts as at rest.
const REST_ENERGY: f64 = 1e-4;
/// Largest change of the mean force between two windows at rest, as a share of it.
const REST_FORCE: f64 = 0.01;
/// Largest mean unbalanced force in a window at rest, as a share of the weight.
const REST_IMBALANCE: f64 = 2e-3;
/// Length of these windows, s; three of them give the static force.
const REST_WINDOW: f64 = 0.1;
/// Time after release before which nothing counts as rest, s.
const REST_NOT_BEFORE: f64 = 0.5;

/// Decides whether the material is at rest: little kinetic energy, balanced forces, and a force that no longer changes.
#[derive(Debug, Default)]
pub(super) struct RestWatch {
    /// Kinetic energy at the last sample, J.
    pub kinetic: f64,
    window: Vec<f64>,
    last_mean: Option<f64>,
    momentum: [f64; 2],
    quiet: usize,
    /// Whether it is.
    pub at_rest: bool,
}

impl RestWatch {
    /// Takes a sample.
    pub fn watch(&mut self, row: &HistoryRow, momentum: [f64; 2], interval: f64, released: f64, weight: f64) {
        self.kinetic = row.kinetic;
        self.window.push(row.normal);
        let length = self.window.len() as f64 * interval;
        if length < REST_WINDOW {
            return;
        }
        let mean = self.window.iter().sum::<f64>() / self.window.len() as f64;
        self.window.clear();
        let steady = self.last_mean.is_some_and(|last| (mean - last).abs() <= REST_FORCE * mean.abs().max(1e-9));
        let change = (momentum[0] - self.momentum[0]).hypot(momentum[1] - self.momentum[1]);
        let balanced = change <= REST_IMBALANCE * weight * length;
        self.last_mean = Some(mean);
        self.momentum = momentum;
        let slow = row.kinetic <= REST_ENERGY * released;
        self.quiet = if slow && balanced && steady && row.time >= REST_NOT_BEFORE { self.quiet + 1 } else { 0 };
        self.at_rest = self.quiet >= 3;
    }
}

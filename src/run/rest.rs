//! When the material counts as at rest.
//!
//! Elsewhere: a criterion of quasi-static equilibrium (steady state).

use super::clock::METER_S;
use super::records::HistoryRow;
use crate::seeded::{self, Seed};

/// Kinetic energy over the energy at release or released since, below which the material counts as at rest.
const REST_ENERGY: f64 = 1e-4;
/// Largest change of the mean force between two windows at rest, as a share of it.
const REST_FORCE: f64 = 0.01;
/// Largest mean unbalanced force in a window at rest, as a share of the weight.
const REST_IMBALANCE: f64 = 2e-3;
/// Length of these windows, s; three of them give the static force.
const REST_WINDOW: f64 = 0.1;
/// Time after release before which nothing counts as rest, s.
const REST_NOT_BEFORE: f64 = 0.5;

/// Decides whether the material is at rest: little kinetic energy, balanced forces, a force that no longer changes, no gate that is
/// still opening and holds it, and no inflow that has not ended.
#[derive(Debug, Default)]
pub(super) struct RestWatch {
    /// Kinetic energy at the last sample, J.
    pub kinetic: f64,
    /// Whether a gate that is still opening held material since the last window, or an inflow had not ended.
    pub gate: bool,
    window: Vec<f64>,
    /// When the last window ended, s.
    since: f64,
    last_mean: Option<f64>,
    momentum: [f64; 2],
    quiet: usize,
    /// Whether it is.
    pub at_rest: bool,
}

impl RestWatch {
    /// Takes a sample: momentum (N s), energy at release or released since (J) and weight (N) of all but barriers.
    pub fn watch(&mut self, row: &HistoryRow, momentum: [f64; 2], released: f64, weight: f64) {
        self.kinetic = row.kinetic;
        self.window.push(row.normal);
        // Rows end with steps: so many of them are that long but for a step, or longer where steps are.
        let length = (self.window.len() as f64 * METER_S).max(row.time - self.since - METER_S);
        if length < REST_WINDOW {
            return;
        }
        let mean = self.window.iter().sum::<f64>() / self.window.len() as f64;
        self.window.clear();
        self.since = row.time;
        let held = std::mem::take(&mut self.gate);
        let steady = self.last_mean.is_some_and(|last| (mean - last).abs() <= REST_FORCE * mean.abs().max(1e-9));
        let change = (momentum[0] - self.momentum[0]).hypot(momentum[1] - self.momentum[1]);
        let balanced = change <= REST_IMBALANCE * weight * length;
        self.last_mean = Some(mean);
        self.momentum = momentum;
        let slow = row.kinetic <= REST_ENERGY * released;
        self.quiet =
            if slow && balanced && steady && !held && row.time >= REST_NOT_BEFORE { self.quiet + 1 } else { 0 };
        self.at_rest = self.quiet >= if seeded::is(Seed::RunRest) { 1 } else { 3 };
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// When material that has stopped moving counts as at rest, with rows of `interval` (s) and a gate that holds it until `opened` (s).
    fn rest(interval: f64, opened: f64) -> Option<f64> {
        let mut watch = RestWatch::default();
        let times = (1..).map(|k| f64::from(k) * interval).take_while(|t| *t < 3.0);
        times.into_iter().find(|&time| {
            watch.gate |= time < opened;
            watch.watch(&HistoryRow { time, normal: 10.0, ..HistoryRow::default() }, [0.0; 2], 1.0, 1.0);
            watch.at_rest
        })
    }

    #[test]
    fn rest_takes_windows_of_time_and_waits_for_gates() {
        // Four windows of 0.1 s pass before anything counts; the fifth is the first of three. Each may be longer by a row.
        let near = |found: Option<f64>, time: f64, row: f64| found.is_some_and(|t| (t - time).abs() < 15.0 * row);
        for row in [1e-3, 2e-3, 5e-3] {
            assert!(near(rest(row, 0.0), 0.7, row), "{row}: {:?}", rest(row, 0.0));
            assert!(near(rest(row, 1.05), 1.4, row), "{row}: {:?}", rest(row, 1.05));
        }
        assert_eq!(rest(1e-3, 9.0), None);
    }

    /// Whether material is at rest after two seconds of windows of 0.1 s: kinetic energy over that released, growth of the force from
    /// window to window, change of the momentum in each over that allowed.
    fn rests(kinetic: f64, growth: f64, unbalanced: f64) -> bool {
        let (mut watch, weight, released) = (RestWatch::default(), 300.0, 50.0);
        for k in 1..=2000 {
            let window = f64::from((k - 1) / 100);
            let normal = 10.0 * (window * libm::log(1.0 + growth)).exp();
            let row =
                HistoryRow { time: f64::from(k) * 1e-3, normal, kinetic: kinetic * released, ..HistoryRow::default() };
            // 0.1 s times the weight times the share that counts as balanced.
            let momentum = unbalanced * (window + 1.0) * 0.1 * 2e-3 * weight;
            watch.watch(&row, [0.6 * momentum, -0.8 * momentum], released, weight);
        }
        watch.at_rest
    }

    #[test]
    fn each_condition_of_rest_holds_to_three_percent() {
        assert!(rests(0.97e-4, 0.0, 0.0) && !rests(1.03e-4, 0.0, 0.0));
        assert!(rests(0.0, 0.0, 0.97) && !rests(0.0, 0.0, 1.03));
        // A growth of g is g / (1 + g) of the mean it is held against.
        let growth = |share: f64| share / (1.0 - share);
        assert!(rests(0.0, growth(0.0097), 0.0) && !rests(0.0, growth(0.0103), 0.0));
        assert!(!rests(f64::NAN, 0.0, 0.0));
    }
}

//! The largest mean of a force over a length of time, from steps of whatever lengths.
//!
//! Elsewhere: a moving average, a boxcar (low-pass) filter.

use super::peak::Peak;
use crate::seeded::{self, Seed};
use std::collections::VecDeque;

/// Follows the mean over the last `window` seconds, which ends with a step and begins within one: there its force counts for the part
/// of its length.
#[derive(Debug, Clone)]
pub struct RunningMean {
    window: f64,
    /// End (s) of each step that reaches into the window and impulse (N s) until then, with that before them.
    steps: VecDeque<[f64; 2]>,
    peak: Peak,
}

impl RunningMean {
    /// Over `window` (s), before the first step.
    pub fn new(window: f64) -> Self {
        Self { window, steps: VecDeque::new(), peak: Peak::default() }
    }

    /// Adds a step of `dt` (s) that ended at `time` (s) with this impulse (N s).
    pub fn add(&mut self, impulse: f64, dt: f64, time: f64) {
        if self.steps.is_empty() {
            self.steps.push_back([time - dt, 0.0]);
        }
        let before = self.steps.back().map_or(0.0, |s| s[1]);
        self.steps.push_back([time, before + impulse]);
        let start = time - self.window;
        while self.steps.len() > 2 && self.steps[1][0] <= start {
            self.steps.pop_front();
        }
        let ([t0, p0], [t1, p1]) = (self.steps[0], self.steps[1]);
        // Round-off of the first step's start is no reason to have seen less than a window.
        if t0 > start + 1e-9 * self.window {
            return;
        }
        let share = ((start - t0) / (t1 - t0)).clamp(0.0, 1.0);
        let mean = (before + impulse - (p0 + share * (p1 - p0))) / seeded::times(Seed::GaugeRunning, self.window);
        if mean > self.peak.value {
            self.peak = Peak { value: mean, time: time - 0.5 * self.window };
        }
    }

    /// Largest mean so far, N, and the middle of its window; zero before a window has passed.
    pub fn peak(&self) -> Peak {
        self.peak
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Largest mean over 20 ms of a pulse that grows and falls in a straight line over 10 ms each, with steps of `dt`.
    fn of_pulse(dt: f64) -> Peak {
        let impulse = |t: f64| {
            let rise = |t: f64| 0.5 * t * t / 0.01;
            let s = (t - 0.03).clamp(0.0, 0.02);
            1e3 * if s < 0.01 { rise(s) } else { 0.01 - rise(0.02 - s) }
        };
        let mut mean = RunningMean::new(0.02);
        let steps = (1..).map(|k| f64::from(k) * dt).take_while(|t| *t < 0.1);
        steps.for_each(|t| mean.add(impulse(t) - impulse(t - dt), dt, t));
        mean.peak()
    }

    #[test]
    fn the_mean_over_a_window_is_exact_for_steps_of_any_length() {
        // All of the pulse is in the window from 30 to 50 ms: half of its height.
        for dt in [1e-4, 0.77e-3, 1.5e-3, 6e-3, 15e-3, 20e-3] {
            let peak = of_pulse(dt);
            // A window ends with a step: it may miss as much as the pulse gives at its end in half a step.
            let missed = (0.25e3 * dt * dt / 0.01 / 0.02).min(500.0);
            assert!(peak.value <= 500.0 + 1e-9 && peak.value >= 500.0 - missed - 1e-9, "{dt}: {peak:?}");
        }
        assert!((of_pulse(1e-3).value - 500.0).abs() < 1e-9 && (of_pulse(1e-3).time - 0.04).abs() < 1e-9);
    }

    /// The largest mean over 20 ms of steps that end at these times (s) with these forces (N).
    fn of_steps(steps: &[(f64, f64)]) -> Peak {
        let (mut mean, mut before) = (RunningMean::new(0.02), 0.0);
        for &(time, force) in steps {
            mean.add(force * (time - before), time - before, time);
            before = time;
        }
        mean.peak()
    }

    #[test]
    fn unequal_steps_count_by_their_length_in_the_window() {
        let is = |steps: &[(f64, f64)], value: f64, time: f64| {
            let peak = of_steps(steps);
            assert!((peak.value - value).abs() < 1e-12 && (peak.time - time).abs() < 1e-12, "{steps:?}: {peak:?}");
        };
        // Half of the first step of 16 ms, and all of the next of 12 ms: 8 and 12 of 20.
        is(&[(0.016, 5.0), (0.028, 10.0)], 8.0, 0.018);
        // One step that is longer than the window; a pulse at the end; less than a window, and nothing.
        is(&[(0.05, 3.0)], 3.0, 0.04);
        is(&[(0.03, 0.0), (0.031, 40.0)], 2.0, 0.021);
        is(&[(0.019, 3.0)], 0.0, 0.0);
        is(&[], 0.0, 0.0);
    }

    #[test]
    fn a_steady_force_is_its_mean_and_less_than_a_window_is_none() {
        let mut mean = RunningMean::new(0.02);
        let mut time = 0.0;
        for k in 0..40 {
            let dt = if k % 3 == 0 { 0.4e-3 } else { 0.7e-3 };
            time += dt;
            mean.add(3.0 * dt, dt, time);
            assert_eq!(mean.peak().value > 0.0, time >= 0.02, "{time}");
        }
        assert!((mean.peak().value - 3.0).abs() < 1e-12);
    }
}

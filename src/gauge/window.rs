//! Speed of the flow in a rectangle.

use super::flow::flowing_blocks;
use crate::simulation::Simulation;

/// Speeds of the points in a window now, m/s; zero where it is empty.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct WindowSample {
    /// Their mean.
    pub mean: f64,
    /// Their 95th percentile.
    pub p95: f64,
}

/// A rectangle in which speeds are read, its edges with it.
#[derive(Debug, Clone, Default)]
pub struct WindowGauge {
    x: [f64; 2],
    y: [f64; 2],
    /// Memory to work in.
    speeds: Vec<f64>,
}

impl WindowGauge {
    /// A window with these extents along x and y, m.
    pub fn new(x: [f64; 2], y: [f64; 2]) -> Self {
        Self { x, y, speeds: Vec::new() }
    }

    /// How fast what flows in it is now (see [`flowing`](super::flow::flowing)): of all bodies but `barriers`, by index.
    pub fn sample(&mut self, simulation: &Simulation, barriers: &[usize]) -> WindowSample {
        let Self { x: [left, right], y: [low, high], speeds } = self;
        speeds.clear();
        flowing_blocks(simulation, barriers).for_each(|(_, block, n)| {
            let inside = |&l: &usize| {
                let [x, y] = [block.x[0][l], block.x[1][l]];
                x >= *left && x <= *right && y >= *low && y <= *high
            };
            speeds.extend((0..n).filter(inside).map(|l| block.get(l, 0).speed()));
        });
        if speeds.is_empty() {
            return WindowSample::default();
        }
        let mean = speeds.iter().sum::<f64>() / speeds.len() as f64;
        let rank = ((speeds.len() - 1) as f64 * 0.95).round() as usize;
        WindowSample { mean, p95: *speeds.select_nth_unstable_by(rank, f64::total_cmp).1 }
    }
}

#[cfg(test)]
#[path = "window_tests.rs"]
mod tests;

//! Speed of the flow in a rectangle.

use super::flow::flowing_extents;
use crate::lanes::LANES;
use crate::seeded::{self, Seed};
use crate::simulation::{Extent, Simulation};

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
    /// A speed that is less than the 95th percentile, if that is about what it was, m/s.
    least: f64,
    /// Memory to work in: all speeds, and the fast ones.
    speeds: Vec<f64>,
    fast: Vec<f64>,
}

/// How much the 95th percentile is taken to fall between two samples.
const FALL: f64 = 0.8;

impl WindowGauge {
    /// A window with these extents along x and y, m.
    pub fn new(x: [f64; 2], y: [f64; 2]) -> Self {
        Self { x, y, ..Self::default() }
    }

    /// How fast what flows in it is now (see `flow::flowing`): of all bodies but `barriers`, by index.
    pub fn sample(&mut self, simulation: &Simulation, barriers: &[usize]) -> WindowSample {
        let Self { x: [left, right], y: [low, high], least, speeds, fast } = self;
        speeds.clear();
        let outside = |e: &Extent| e.high[0] < *left || e.low[0] > *right || e.high[1] < *low || e.low[1] > *high;
        flowing_extents(simulation, barriers).filter(|e| !outside(e)).for_each(|e| {
            let all = e.low[0] >= *left && e.high[0] <= *right && e.low[1] >= *low && e.high[1] <= *high;
            for (block, points) in simulation.blocks_in(e) {
                let speed = |l: usize| (block.v[0][l] * block.v[0][l] + block.v[1][l] * block.v[1][l]).sqrt();
                if all && points == LANES {
                    speeds.extend_from_slice(&std::array::from_fn::<f64, LANES, _>(speed));
                    continue;
                }
                let inside = |&l: &usize| {
                    let [x, y] = [block.x[0][l], block.x[1][l]];
                    x >= *left && x <= *right && y >= *low && y <= *high
                };
                speeds.extend((0..points).filter(inside).map(speed));
            }
        });
        if speeds.is_empty() {
            return WindowSample::default();
        }
        let few = if seeded::is(Seed::GaugeWindow) { 1.0 } else { 0.0 };
        let mean = speeds.iter().sum::<f64>() / (speeds.len() as f64 - few);
        let rank = ((speeds.len() - 1) as f64 * 0.95).round() as usize;
        // The percentile is among the fast ones, or anywhere.
        fast.clear();
        fast.extend(speeds.iter().filter(|speed| **speed >= *least));
        let slow = speeds.len() - fast.len();
        let (rank, among) = if rank >= slow { (rank - slow, fast) } else { (rank, speeds) };
        let p95 = *among.select_nth_unstable_by(rank, f64::total_cmp).1;
        *least = FALL * p95;
        WindowSample { mean, p95 }
    }
}

#[cfg(test)]
#[path = "window_tests.rs"]
mod tests;

//! Depth and velocity of the flow at a place.

use super::flow::{MAX_VOLUME_RATIO, flowing_blocks};
use crate::simulation::Simulation;

/// The flow at a station now.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct StationSample {
    /// Where, m.
    pub x: f64,
    /// Flow depth in a strip two cells wide around it, m.
    pub depth: f64,
    /// Mean velocity along x in that strip, m/s; zero where it is empty.
    pub velocity: f64,
}

/// A place along the flume.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StationGauge {
    x: f64,
}

impl StationGauge {
    /// A station at `x`, m.
    pub fn new(x: f64) -> Self {
        Self { x }
    }

    /// What flows there now (see [`flowing`](super::flow::flowing)): of all bodies but `barriers`, by index.
    pub fn sample(&self, simulation: &Simulation, barriers: &[usize]) -> StationSample {
        let h = simulation.spacing();
        let (mut volume, mut mass, mut momentum) = (0.0, 0.0, 0.0);
        flowing_blocks(simulation, barriers).for_each(|(body, block, n)| {
            let body = &simulation.bodies()[body];
            for l in (0..n).filter(|&l| (block.x[0][l] - self.x).abs() <= h) {
                volume += body.point_volume * block.volume_ratio[l].min(MAX_VOLUME_RATIO);
                mass += body.point_mass;
                momentum += body.point_mass * block.v[0][l];
            }
        });
        let area = 2.0 * h * simulation.thickness();
        let velocity = if mass > 0.0 { momentum / mass } else { 0.0 };
        StationSample { x: self.x, depth: volume / area, velocity }
    }
}

#[cfg(test)]
#[path = "station_tests.rs"]
mod tests;

//! Depth and velocity of the flow at a place.

use super::flow::{MAX_VOLUME_RATIO, flowing_extents};
use crate::seeded::{self, Seed};
use crate::simulation::{Extent, Simulation};

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

    /// What flows there now (see `flow::flowing`): of all bodies but `barriers`, by index.
    pub fn sample(&self, simulation: &Simulation, barriers: &[usize]) -> StationSample {
        let h = simulation.spacing();
        let (mut volume, mut mass, mut momentum) = (0.0, 0.0, 0.0);
        let near = |e: &&Extent| !(e.low[0] - self.x > h || self.x - e.high[0] > h);
        flowing_extents(simulation, barriers).filter(near).for_each(|e| {
            let body = &simulation.bodies()[e.body];
            for (block, points) in simulation.blocks_in(e) {
                for l in (0..points).filter(|&l| (block.x[0][l] - self.x).abs() <= h) {
                    volume += body.point_volume * block.volume_ratio[l].min(MAX_VOLUME_RATIO);
                    mass += body.point_mass;
                    momentum += body.point_mass * block.v[0][l];
                }
            }
        });
        let area = seeded::times(Seed::GaugeStation, 2.0 * h) * simulation.thickness();
        let velocity = if mass > 0.0 { momentum / mass } else { 0.0 };
        StationSample { x: self.x, depth: volume / area, velocity }
    }
}

#[cfg(test)]
#[path = "station_tests.rs"]
mod tests;

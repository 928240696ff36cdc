//! Means in the grid cells: a field of velocity and stress.

use super::flow::{MAX_VOLUME_RATIO, flowing};
use crate::simulation::Simulation;

/// One grid cell of a velocity field.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FieldCell {
    /// Centre, m.
    pub x: [f64; 2],
    /// Share of the cell's volume filled with material.
    pub fill: f64,
    /// Mass-weighted mean velocity, m/s.
    pub v: [f64; 2],
    /// Mass-weighted mean of the pressure (a third of the trace of the stress, positive in compression), Pa.
    pub pressure: f64,
    /// Mass-weighted mean of the equivalent plastic shear strain since the start.
    pub plastic_shear: f64,
}

/// Means in the grid cells that hold material, column by column.
pub fn velocity_field(simulation: &Simulation, barriers: &[usize]) -> Vec<FieldCell> {
    let h = simulation.spacing();
    let mut points: Vec<_> = flowing(simulation, barriers)
        .map(|(b, p)| {
            let body = &simulation.bodies()[b];
            let cell = ((p.x[0] / h).floor() as i64, (p.x[1] / h).floor() as i64);
            (cell, body.point_mass, body.point_volume * p.volume_ratio.min(MAX_VOLUME_RATIO), p)
        })
        .collect();
    points.sort_by_key(|p| p.0);
    points
        .chunk_by(|a, b| a.0 == b.0)
        .map(|cell| {
            let (mut mass, mut volume, mut momentum, mut pressure, mut shear) = (0.0, 0.0, [0.0; 2], 0.0, 0.0);
            for (_, m, v, p) in cell {
                mass += m;
                volume += v;
                momentum[0] += m * p.v[0];
                momentum[1] += m * p.v[1];
                pressure -= m * p.state.stress.mean();
                shear += m * p.state.plastic_shear;
            }
            let (i, j) = cell[0].0;
            FieldCell {
                x: [(i as f64 + 0.5) * h, (j as f64 + 0.5) * h],
                fill: volume / (h * h * simulation.thickness()),
                v: [momentum[0] / mass, momentum[1] / mass],
                pressure: pressure / mass,
                plastic_shear: shear / mass,
            }
        })
        .collect()
}

#[cfg(test)]
#[path = "field_tests.rs"]
mod tests;

//! Means in the grid cells: a field of velocity and stress.
//!
//! Elsewhere: coarse graining, a projection of particles onto cells.

use super::flow::{MAX_VOLUME_RATIO, flowing_blocks};
use crate::body::{Block, Body};
use crate::constitutive::Stress;
use crate::seeded::{self, Seed};
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

/// Means in the cells of the grid that hold material, column by column.
pub fn velocity_field(simulation: &Simulation, barriers: &[usize]) -> Vec<FieldCell> {
    let h = simulation.spacing();
    let origin = if seeded::is(Seed::GaugeFieldOrigin) { [0.0; 2] } else { simulation.origin() };
    let mut points: Vec<((i64, i64), &Block, usize, &Body)> = Vec::new();
    flowing_blocks(simulation, barriers).for_each(|(b, block, n)| {
        let cell = |l: usize| {
            let [i, j] = [0, 1].map(|d| ((block.x[d][l] - origin[d]) / h).floor() as i64);
            (i, j)
        };
        points.extend((0..n).map(|l| (cell(l), block, l, &simulation.bodies()[b])));
    });
    points.sort_by_key(|p| p.0);
    points
        .chunk_by(|a, b| a.0 == b.0)
        .map(|cell| {
            let (mut mass, mut volume, mut momentum, mut pressure, mut shear) = (0.0, 0.0, [0.0; 2], 0.0, 0.0);
            for &(_, block, l, body) in cell {
                let (m, [xx, yy, zz, xy]) = (body.point_mass, [0, 1, 2, 3].map(|k| block.stress[k][l]));
                mass += m;
                volume += body.point_volume * block.volume_ratio[l].min(MAX_VOLUME_RATIO);
                momentum[0] += m * block.v[0][l];
                momentum[1] += m * block.v[1][l];
                pressure -= m * Stress { xx, yy, zz, xy }.mean();
                shear += m * block.plastic_shear[l];
            }
            let (i, j) = cell[0].0;
            let middle = if seeded::is(Seed::GaugeField) { 0.0 } else { 0.5 };
            FieldCell {
                x: [origin[0] + (i as f64 + middle) * h, origin[1] + (j as f64 + 0.5) * h],
                fill: volume / (h * h * simulation.thickness()),
                v: [momentum[0] / mass, momentum[1] / mass],
                pressure: seeded::times(Seed::GaugeFieldPressure, pressure / mass),
                plastic_shear: shear / mass,
            }
        })
        .collect()
}

#[cfg(test)]
#[path = "field_tests.rs"]
mod tests;

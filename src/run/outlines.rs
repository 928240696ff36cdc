//! Outlines of the boundaries, for whoever draws them.

use super::columns;
use super::table::{Names, OpenTable};
use crate::boundary::{Boundary, Solid};
use crate::output::{self, OutputError, Polyline};
use crate::seeded::{self, Seed};
use crate::simulation::Simulation;
use std::path::Path;

/// Outlines of the boundaries that stay, planes cut to a strip two cells thick along the domain.
pub fn outlines(simulation: &Simulation) -> Vec<(usize, Vec<[f64; 2]>)> {
    let fixed = |b: &&Boundary| b.opening.is_none();
    simulation
        .boundaries()
        .iter()
        .enumerate()
        .filter(|(_, b)| fixed(b))
        .map(|(index, b)| {
            let (foot, n, t) = (b.foot(), b.normal, b.tangent);
            let corners = match b.solid {
                Solid::HalfSpace { .. } => {
                    let depth = 2.0 * simulation.spacing();
                    let [xs, ys] = simulation.domain();
                    let along: Vec<f64> = [[xs[0], ys[0]], [xs[1], ys[0]], [xs[0], ys[1]], [xs[1], ys[1]]]
                        .iter()
                        .filter(|c| b.depth(**c) >= 0.0)
                        .map(|c| b.face_coordinates(*c).1)
                        .collect();
                    let low = along.iter().fold(f64::INFINITY, |a, s| a.min(*s));
                    let high = along.iter().fold(f64::NEG_INFINITY, |a, s| a.max(*s));
                    if low >= high {
                        return (index, Vec::new());
                    }
                    vec![foot + t * low, foot + t * high, foot + t * high - n * depth, foot + t * low - n * depth]
                }
                Solid::Slab { height, thickness, .. } => {
                    let thickness = seeded::times(Seed::TablesGeometry, thickness);
                    vec![foot, foot + t * height, foot + t * height - n * thickness, foot - n * thickness]
                }
            };
            (index, corners.into_iter().map(Into::into).collect())
        })
        .filter(|(_, corners): &(usize, Vec<[f64; 2]>)| !corners.is_empty())
        .collect()
}

/// Writes their corners as `geometry.csv`.
pub(super) fn write_geometry_table(directory: &Path, simulation: &Simulation) -> Result<(), OutputError> {
    let mut table = OpenTable::create(&columns::GEOMETRY, &directory.join("geometry.csv"), Names::default())?;
    for (index, corners) in outlines(simulation) {
        for c in corners {
            table.row(&[index as f64, c[0], c[1]])?;
        }
    }
    table.finish()
}

/// Writes them for ParaView, where the frames are.
pub(super) fn write_geometry_vtk(directory: &Path, simulation: &Simulation) -> Result<(), OutputError> {
    let outlines = outlines(simulation);
    let lines: Vec<Polyline> = outlines
        .iter()
        .map(|(index, corners)| Polyline { boundary: *index as i64, points_m: corners, closed: true })
        .collect();
    output::write_polylines(directory.join("vtk").join("boundaries.vtp"), &lines)
}

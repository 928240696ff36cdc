//! Outlines of the boundaries, for whoever draws them.

use super::columns;
use super::table::{Names, OpenTable};
use crate::boundary::{Boundary, Chain, Solid};
use crate::output::{self, OutputError, Polyline};
use crate::seeded::{self, Seed};
use crate::simulation::Simulation;
use nalgebra::Vector2;
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
            let corners = match &b.solid {
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
                    let thickness = seeded::times(Seed::TablesGeometry, *thickness);
                    vec![foot, foot + t * *height, foot + t * *height - n * thickness, foot - n * thickness]
                }
                Solid::Terrain { chain } => strip(chain, simulation),
            };
            (index, corners.into_iter().map(Into::into).collect())
        })
        .filter(|(_, corners): &(usize, Vec<[f64; 2]>)| !corners.is_empty())
        .collect()
}

/// The pieces of a terrain, its ends prolonged to the edge of the domain, and back two cells behind them.
fn strip(chain: &Chain, simulation: &Simulation) -> Vec<Vector2<f64>> {
    let [xs, ys] = simulation.domain();
    let beyond = |from: Vector2<f64>, way: Vector2<f64>| -> f64 {
        let to_edge = |d: usize, [low, high]: [f64; 2]| match way[d] {
            w if w > 0.0 => (high - from[d]) / w,
            w if w < 0.0 => (low - from[d]) / w,
            _ => f64::INFINITY,
        };
        to_edge(0, xs).min(to_edge(1, ys)).max(0.0)
    };
    let pieces = chain.pieces();
    let [Some(first), Some(last)] = [pieces.first(), pieces.last()] else { return Vec::new() };
    let mut points: Vec<Vector2<f64>> = chain.points().iter().map(|p| Vector2::from(*p)).collect();
    let end = points.len() - 1;
    let [before, after] = [beyond(points[0], -first.tangent), beyond(points[end], last.tangent)];
    points[0] -= first.tangent * before;
    points[end] += last.tangent * after;
    let depth = 2.0 * simulation.spacing();
    let behind: Vec<Vector2<f64>> = (0..points.len())
        .map(|k| {
            let (a, b) = (pieces[k.saturating_sub(1)].normal, pieces[k.min(pieces.len() - 1)].normal);
            // Along the middle of the two, to as far behind both; at a fold no farther than twice that.
            let middle = (a + b).normalize();
            points[k] - middle * (depth / middle.dot(&a).max(0.5))
        })
        .collect();
    points.into_iter().chain(behind.into_iter().rev()).collect()
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

//! Opened volume, bounded by the volume that the material occupies.
//!
//! Material that comes apart tracks by how much, as the opened volumetric strain, and closes it before pressure builds up. The strain
//! that the grid sees misses part of it: points that fly alone stretch nothing, and points that land between others bring the
//! opening of where they were. Left to itself, sand that falls apart and comes together again stands a third too high. What the
//! points occupy, seen from the grid, bounds the opened strain from both sides.
//!
//! The share of a node's volume that is filled is phi_i = sum_p N_i(x_p) V_p exp(-opened) / integral of N_i outside of boundaries, with
//! linear N: one in dense material, whatever its pressure. With phi and its gradient at a point, the voids of the material around
//! it are
//! - at most 1 - phi, were they spread evenly: opened <= -ln(phi);
//! - at least what a flat surface of dense material would not explain: opened >= -ln(phi + 0.7 h^2 |grad phi|^2). At the outermost points
//!   of dense material, a quarter of a cell below its surface, the mean over all places of the grid of phi is 0.66 and that of
//!   h |grad phi| is 0.69, so that nothing is to be closed there.
//!
//! Points that are not open are left alone, so material that never came apart does not feel this. Open points carry no pressure, so
//! neither energy nor force changes (with cohesion, the little shear stress that they may keep acts on another volume).
//!
//! Elsewhere: a bound on the volume fraction from the grid, as in unilateral incompressibility of granular media (Narain, Golas and
//! Lin 2010; Daviet and Bertails-Descoubes 2016); volume correction of material that separated (Tampubolon et al. 2017).

use super::VelocityField;
use crate::boundary::{Boundary, Friction};
use crate::grid::ActiveGrid;
use std::collections::HashMap;

/// Weight of h^2 |grad phi|^2: (1 - 0.66) / 0.69^2.
const SURFACE: f64 = 0.7;
/// Where part of a node's support is outside of boundaries is found by this many samples in each direction.
const SAMPLES: usize = 16;
/// Least share that counts as outside.
const SLIVER: f64 = 0.02;

/// The occupied volume on the grid of one velocity field at a time.
#[derive(Debug, Clone, Default)]
pub(super) struct Occupied {
    filled: Vec<f64>,
    /// Share of the support of nodes near boundaries that lies outside of these, by field, column and row.
    outside: HashMap<(usize, i64, i64), f64>,
}

impl Occupied {
    /// Forgets where boundaries are.
    pub fn forget_boundaries(&mut self) {
        self.outside.clear();
    }

    /// Bounds the opened strain of the points of field `k`, which has just been sorted. `thickness` in m.
    pub fn bound(&mut self, fields: &mut [VelocityField], k: usize, boundaries: &[Boundary], thickness: f64) {
        let open = |f: &VelocityField| f.blocks().any(|(_, block, n)| block.opened.iter().take(n).any(|&o| o > 0.0));
        if !open(&fields[k]) {
            return;
        }
        if boundaries.iter().any(|b| b.velocity.norm_squared() > 0.0 || (b.released && !b.is_gone())) {
            self.forget_boundaries();
        }
        self.fill(fields, k);
        self.share(&fields[k], k, boundaries, thickness);
        let VelocityField { grid, bands, .. } = &mut fields[k];
        for points in bands.iter_mut().flat_map(|b| &mut b.points) {
            for b in 0..points.block_count() {
                let n = points.points_in(b);
                let Some(block) = points.blocks_mut().0.get_mut(b) else { continue };
                for l in 0..n {
                    if block.opened[l] <= 0.0 {
                        continue;
                    }
                    let Some([least, most]) = limits(&self.filled, grid, [block.x[0][l], block.x[1][l]]) else {
                        continue;
                    };
                    let opened = block.opened[l].clamp(least, most);
                    block.volume_ratio[l] *= libm::exp(opened - block.opened[l]);
                    block.opened[l] = opened;
                }
            }
            points.pad();
        }
    }

    /// Volume of the material at each node of the grid of field `k`, m3, its openings left out.
    fn fill(&mut self, fields: &[VelocityField], k: usize) {
        let grid = &fields[k].grid;
        self.filled.clear();
        self.filled.resize(grid.len(), 0.0);
        for field in fields {
            let bodies = &field.bodies;
            let own: Vec<_> = field.members.iter().zip(bodies).collect();
            for (body, block, n) in field.blocks() {
                let Some((_, b)) = own.iter().find(|(m, _)| **m == body) else { continue };
                for l in 0..n {
                    let Some((nodes, [u, v])) = cell(grid, [block.x[0][l], block.x[1][l]]) else { continue };
                    let volume = b.point_volume * block.volume_ratio[l] * libm::exp(-block.opened[l]);
                    for (node, share) in nodes.into_iter().zip(hats(u, v)) {
                        self.filled[node] += share * volume;
                    }
                }
            }
        }
    }

    /// Turns volumes into shares of what is outside of boundaries.
    fn share(&mut self, field: &VelocityField, k: usize, boundaries: &[Boundary], thickness: f64) {
        let grid = &field.grid;
        let h = grid.spacing;
        let solid: Vec<&Boundary> = boundaries
            .iter()
            .filter(|b| !b.is_gone() && b.friction != Friction::Bonded && b.acts_on(&field.members))
            .collect();
        let whole = 1.0 / (h * h * thickness);
        for (c, column) in grid.columns.iter().enumerate() {
            for r in 0..column.rows {
                let filled = &mut self.filled[(column.start + r) as usize];
                if *filled <= 0.0 {
                    continue;
                }
                let row = i64::from(column.row) + i64::from(r);
                let place = (k, grid.first[0] + c as i64, grid.first[1] + row);
                let x = [grid.corner[0] + c as f64 * h, grid.corner[1] + row as f64 * h];
                let outside = self.outside.entry(place).or_insert_with(|| outside(&solid, x, h));
                *filled *= whole / *outside;
            }
        }
    }
}

/// The least and the most that a point at `x` may be open.
fn limits(filled: &[f64], grid: &ActiveGrid, x: [f64; 2]) -> Option<[f64; 2]> {
    let (nodes, [u, v]) = cell(grid, x)?;
    let phi = nodes.map(|n| filled[n]);
    let here: f64 = hats(u, v).iter().zip(phi).map(|(w, p)| w * p).sum();
    let across = (1.0 - v) * (phi[2] - phi[0]) + v * (phi[3] - phi[1]);
    let up = (1.0 - u) * (phi[1] - phi[0]) + u * (phi[3] - phi[2]);
    let void = |filled: f64| -libm::log(filled.clamp(f64::MIN_POSITIVE, 1.0));
    Some([void(here + SURFACE * (across * across + up * up)), void(here)])
}

/// The four nodes around a place, column by column, and where it lies between them; `None` where one is not active.
fn cell(grid: &ActiveGrid, x: [f64; 2]) -> Option<([usize; 4], [f64; 2])> {
    let [u, v] = [0, 1].map(|d| (x[d] - grid.corner[d]) * grid.inverse_spacing);
    let (column, row) = (u.floor(), v.floor());
    if !(0.0..grid.columns.len() as f64 - 1.0).contains(&column) {
        return None;
    }
    let node = |c: usize| {
        let column = &grid.columns[c];
        let row = row - f64::from(column.row);
        (row >= 0.0 && row + 1.0 < f64::from(column.rows)).then(|| column.start as usize + row as usize)
    };
    let [left, right] = [node(column as usize)?, node(column as usize + 1)?];
    Some(([left, left + 1, right, right + 1], [u - column, v - row]))
}

/// Linear shape functions of the four nodes.
fn hats(u: f64, v: f64) -> [f64; 4] {
    [(1.0 - u) * (1.0 - v), (1.0 - u) * v, u * (1.0 - v), u * v]
}

/// Share of the support of a node at `x` that lies outside of all boundaries, weighted by its shape function.
fn outside(boundaries: &[&Boundary], x: [f64; 2], h: f64) -> f64 {
    let near = |b: &&&Boundary| b.depth(x) > -1.5 * h;
    let near: Vec<&&Boundary> = boundaries.iter().filter(near).collect();
    if near.is_empty() {
        return 1.0;
    }
    let at = |k: usize| (k as f64 + 0.5) * 2.0 / SAMPLES as f64 - 1.0;
    let mut share = 0.0;
    for a in (0..SAMPLES).map(at) {
        for b in (0..SAMPLES).map(at) {
            let place = [x[0] + a * h, x[1] + b * h];
            if near.iter().all(|s| s.depth(place) <= 0.0) {
                share += (1.0 - a.abs()) * (1.0 - b.abs());
            }
        }
    }
    (share * 4.0 / (SAMPLES * SAMPLES) as f64).max(SLIVER)
}

//! Visits the points that given nodes see.

use crate::contact::Vector;
use crate::grid::ActiveGrid;
use crate::lanes::floor_to_int;
use crate::shape::{AveragedHat, Hat, STENCIL, Shape1d, ShapeFunction};
use crate::simulation::field::VelocityField;

/// Marks nodes of a grid, and the places where the stencils of points start that see them.
#[derive(Debug, Clone, Default)]
pub(super) struct Marks {
    /// For each node of the grid, the number it was marked with, or -1.
    numbers: Vec<i32>,
    /// Whether a stencil that starts here sees a marked node.
    near: Vec<bool>,
    marked: Vec<u32>,
    starts: Vec<u32>,
}

/// A point that marked nodes see.
#[derive(Debug, Clone, Copy)]
pub(super) struct Near {
    /// Position, m.
    pub x: Vector,
    /// Where its stencil starts in the grid, and its place from there in cells.
    start: [i32; 2],
    rest: [f64; 2],
    half_width: f64,
}

/// What a node sees of a point.
#[derive(Debug, Clone, Copy)]
pub(super) struct Seen {
    /// Weight of the node.
    pub weight: f64,
    /// Gradient of the weight at the point, 1/m.
    pub gradient: Vector,
}

impl Marks {
    /// Follows a new grid, with room for `nodes` marks.
    pub fn rebuild(&mut self, grid: &ActiveGrid, nodes: usize) {
        self.numbers.clear();
        self.numbers.resize(grid.len(), -1);
        self.near.clear();
        self.near.resize(grid.len(), false);
        self.marked.clear();
        self.starts.clear();
        self.marked.reserve(nodes);
        self.starts.reserve(nodes * STENCIL * STENCIL);
    }

    /// Forgets all marks.
    pub fn clear(&mut self) {
        self.marked.iter().for_each(|&n| self.numbers[n as usize] = -1);
        self.starts.iter().for_each(|&n| self.near[n as usize] = false);
        self.marked.clear();
        self.starts.clear();
    }

    /// Marks a node at `place` (column and row of its grid) with a number.
    pub fn set(&mut self, grid: &ActiveGrid, place: [i32; 2], number: usize) {
        let node = (grid.row_zero[place[0] as usize] + place[1]) as usize;
        self.numbers[node] = number as i32;
        self.marked.push(node as u32);
        for i in 0..STENCIL as i32 {
            let column = (place[0] - i) as usize;
            let Some(&row_zero) = grid.row_zero.get(column) else { continue };
            for j in 0..STENCIL as i32 {
                let start = (row_zero + place[1] - j) as usize;
                if let Some(near) = self.near.get_mut(start)
                    && !*near
                {
                    *near = true;
                    self.starts.push(start as u32);
                }
            }
        }
    }

    /// Calls `visit` with each point that marked nodes see, in their order: its place, its number within its body, and its current
    /// over reference volume.
    pub fn points(&self, field: &VelocityField, shape: ShapeFunction, mut visit: impl FnMut(&Near, u32, f64)) {
        let grid = &field.grid;
        let (Some(&low), Some(&high)) = (self.starts.iter().min(), self.starts.iter().max()) else { return };
        for band in &field.bands {
            // A point has drifted by at most a column since the sort, within the reach of its band.
            if band.first_node > high as usize || band.first_node + band.reach <= low as usize {
                continue;
            }
            for (body, points) in field.bodies.iter().zip(&band.points) {
                let half_width = shape.half_width(body.points_per_direction);
                for ((block, n), ids) in points.blocks().zip(points.ids()) {
                    for (l, &id) in ids[..n].iter().enumerate() {
                        let x = [block.x[0][l], block.x[1][l]];
                        let at =
                            [0, 1].map(|d| floor_to_int((x[d] - grid.corner[d]) * grid.inverse_spacing - half_width));
                        let (start, rest) = (at.map(|(i, _)| i), at.map(|(_, r)| r));
                        if self.near[(grid.row_zero[start[0] as usize] + start[1]) as usize] {
                            visit(&Near { x, start, rest, half_width }, id, block.volume_ratio[l]);
                        }
                    }
                }
            }
        }
    }

    /// Calls `visit` with the number of each marked node that sees a point, and what it sees.
    pub fn nodes(&self, grid: &ActiveGrid, point: &Near, mut visit: impl FnMut(usize, &Seen)) {
        let [(wx, gx), (wy, gy)] = point.rest.map(|r| weights(point.half_width, r));
        for a in 0..STENCIL {
            let first = grid.row_zero[point.start[0] as usize + a] + point.start[1];
            for b in 0..STENCIL {
                let number = self.numbers[first as usize + b];
                let weight = wx[a] * wy[b];
                if number >= 0 && weight > 0.0 {
                    let per = grid.inverse_spacing;
                    let gradient = [gx[a] * wy[b] * per, wx[a] * gy[b] * per];
                    visit(number as usize, &Seen { weight, gradient });
                }
            }
        }
    }
}

fn weights(half_width: f64, r: f64) -> ([f64; STENCIL], [f64; STENCIL]) {
    if half_width > 0.0 { AveragedHat::new(half_width).eval(r) } else { Hat.eval(r) }
}

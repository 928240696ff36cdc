//! Visits the points that given nodes see.

use crate::contact::Vector;
use crate::grid::ActiveGrid;
use crate::shape::stencil::Stencil;
use crate::shape::{STENCIL, ShapeFunction};
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
    stencil: Stencil,
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
        let node = grid.node(place[0] as usize, place[1]) as usize;
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
                        let stencil = Stencil::new(x, grid.corner, grid.inverse_spacing, half_width);
                        let [column, row] = stencil.start;
                        if self.near[grid.node(column as usize, row) as usize] {
                            visit(&Near { x, stencil }, id, block.volume_ratio[l]);
                        }
                    }
                }
            }
        }
    }

    /// Calls `visit` with the number of each marked node that sees a point, and what it sees.
    pub fn nodes(&self, grid: &ActiveGrid, point: &Near, mut visit: impl FnMut(usize, &Seen)) {
        let [column, row] = point.stencil.start;
        point.stencil.nodes(|[a, b], weight, gradient| {
            let number = self.numbers[grid.node(column as usize + a, row + b as i32) as usize];
            if number >= 0 {
                visit(number as usize, &Seen { weight, gradient });
            }
        });
    }
}

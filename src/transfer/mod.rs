//! Transfers between material points and grid nodes.
//!
//! Each transfer is one loop over the blocks of a band: weights of eight points at a time, then the nodes of one point after
//! the other. `kernels.rs` holds the loops, `dispatch.rs` runs them with the widest vectors the processor has.
//!
//! Elsewhere: P2G (scatter, projection) and G2P (gather, interpolation), as in particle-in-cell methods (PIC, FLIP).

mod dispatch;
mod kernels;

pub use dispatch::{VectorUnit, limit_vector_unit, vector_unit};

use crate::body::Block;
use crate::grid::ActiveGrid;
use crate::shape::stencil::Stencils;
use crate::shape::{STENCIL, Shape1d};

/// What a scatter adds to the grid.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Scatter {
    /// Mass, momentum and internal force, for an update with the stress of the step's start (USL, MUSL).
    All,
    /// Mass and momentum only, before the stress is updated (USF).
    Inertia,
    /// Internal force only, after the stress was updated (USF).
    Force,
}

/// Properties of a body that the loops need.
#[derive(Debug, Clone, Copy)]
pub struct PointConstants {
    /// Mass of a point, kg.
    pub mass: f64,
    /// Reference volume of a point, m3.
    pub volume: f64,
    /// Side-wall friction: force per volume and out-of-plane pressure, 2 mu / width, 1/m.
    pub side_friction: f64,
}

/// What all transfers between the points of a body and the nodes of a band have in common.
#[derive(Debug, Clone, Copy)]
pub struct Transfer<'a> {
    /// Half-width of the shape function's averaging box in cells, 0 for linear shape functions.
    pub half_width: f64,
    /// Where the nodal fields of the band are.
    pub map: NodeMap<'a>,
    /// Properties of the body.
    pub constants: PointConstants,
}

/// How the velocity of the points follows the grid.
#[derive(Debug, Clone, Copy)]
pub struct VelocityUpdate {
    /// Time step, s.
    pub dt: f64,
    /// Share of PIC, 0 to 1.
    pub pic: f64,
    /// Whether the new velocities are mapped back to the grid (MUSL).
    pub remap: bool,
    /// Whether points move at once (USF) or after their stress update.
    pub move_now: bool,
}

/// How the stress follows the grid.
#[derive(Debug, Clone, Copy)]
pub struct StressUpdate {
    /// Time step, s.
    pub dt: f64,
    /// Whether points then move by their displacement of the step.
    pub move_after: bool,
}

/// Where the nodal fields of a band are in memory.
#[derive(Debug, Clone, Copy)]
pub struct NodeMap<'a> {
    rows: &'a [i32],
    corner: [f64; 2],
    inverse_spacing: f64,
    first_node: i32,
}

impl<'a> NodeMap<'a> {
    /// The map for a band whose fields start at `first_node` of the grid.
    pub fn new(grid: &'a ActiveGrid, first_node: usize) -> Self {
        Self {
            rows: &grid.row_zero,
            corner: grid.corner,
            inverse_spacing: grid.inverse_spacing,
            first_node: first_node as i32,
        }
    }

    /// Follows the points of a block.
    #[inline(always)]
    fn stencils<S: Shape1d>(&self, stencils: &mut Stencils, shape: S, block: &Block) {
        stencils.evaluate(shape, &block.x, self.corner, self.inverse_spacing, |i, j| self.columns(i, j));
    }

    /// Indices of the nodes at row `j` of column `i` and of the columns after it, both counted from the grid's corner.
    #[inline(always)]
    fn columns(&self, i: i32, j: i32) -> [usize; STENCIL] {
        let rows: &[i32; STENCIL] = self.rows[i as usize..]
            .first_chunk()
            .expect("sorting gives the grid every column that a stencil can reach until the next sort");
        rows.map(|row| (row + j - self.first_node) as usize)
    }
}

#[cfg(test)]
mod tests;

//! The stencil of a material point: which nodes see it, with which weights and gradients.
//!
//! A stencil is three columns of three nodes. It starts at the node whose column and row, counted from a corner of the grid, are the
//! integer parts of where the point lies in cells, less the shift of the shape function; what is left over decides the weights.
//! [`Stencils`] are those of a block of points, for the hot loops; [`Stencil`] is that of one point, for everything else.

#![expect(clippy::needless_range_loop, reason = "loops over lanes and nodes index several parallel arrays")]

use super::{AveragedHat, Hat, STENCIL, Shape1d};
use crate::lanes::{LANES, Lane, floor_to_int};

const ZERO: Lane = [0.0; LANES];

/// Where the stencil of a point starts in one direction, and how far from there the point lies, less `shift`: both in cells, as is
/// the coordinate `u` of the point, which is not negative.
#[inline(always)]
pub fn start(u: f64, shift: f64) -> (i32, f64) {
    floor_to_int(u - shift)
}

/// Stencils of eight points: first node of each column, weights and gradients in each direction.
pub struct Stencils {
    /// Indices of the first node of each column.
    pub first: [[usize; LANES]; STENCIL],
    /// Equal for points that touch the same nodes.
    pub key: [i64; LANES],
    /// Weights in x and in y.
    pub w: [[Lane; STENCIL]; 2],
    /// Derivatives of the weights in x and in y, 1/m.
    pub g: [[Lane; STENCIL]; 2],
}

impl Stencils {
    /// Made once a loop, since filling it with zeros costs as much as a tenth of the work on a block.
    pub const EMPTY: Self =
        Self { first: [[0; LANES]; STENCIL], key: [0; LANES], w: [[ZERO; STENCIL]; 2], g: [[ZERO; STENCIL]; 2] };

    /// Follows eight points at `x` (m) on a grid with this corner (m) and one over this spacing (1/m). `columns` gives the index of
    /// the node at a column and row, and of those beside it in the next columns.
    #[inline(always)]
    pub fn evaluate<S: Shape1d>(
        &mut self,
        shape: S,
        x: &[Lane; 2],
        corner: [f64; 2],
        inverse_spacing: f64,
        columns: impl Fn(i32, i32) -> [usize; STENCIL],
    ) {
        let s = self;
        let mut node = [[0; LANES]; 2];
        for d in 0..2 {
            for l in 0..LANES {
                let (b, r) = start((x[d][l] - corner[d]) * inverse_spacing, shape.shift());
                let (w, g) = shape.eval(r);
                node[d][l] = b;
                for k in 0..STENCIL {
                    s.w[d][k][l] = w[k];
                    s.g[d][k][l] = g[k] * inverse_spacing;
                }
            }
        }
        for l in 0..LANES {
            s.key[l] = (i64::from(node[0][l]) << 32) ^ i64::from(node[1][l]);
        }
        for l in 0..LANES {
            let first = columns(node[0][l], node[1][l]);
            for i in 0..STENCIL {
                s.first[i][l] = first[i];
            }
        }
    }
}

/// The stencil of one point.
#[derive(Debug, Clone, Copy)]
pub struct Stencil {
    /// Column and row of its first node, counted from the corner of the grid.
    pub start: [i32; 2],
    /// Place of the point from there, less the shift of the shape function, in cells.
    rest: [f64; 2],
    half_width: f64,
    inverse_spacing: f64,
}

impl Stencil {
    /// Of a point at `x` on a grid with this corner (m) and one over this spacing (1/m). `half_width` (in cells) says which shape
    /// function it is, see [`super::ShapeFunction::half_width`].
    #[inline]
    pub fn new(x: [f64; 2], corner: [f64; 2], inverse_spacing: f64, half_width: f64) -> Self {
        let at = [0, 1].map(|d| start((x[d] - corner[d]) * inverse_spacing, half_width));
        Self { start: at.map(|(i, _)| i), rest: at.map(|(_, r)| r), half_width, inverse_spacing }
    }

    /// Calls `visit` with every node that has a weight, column by column: its column and row, counted from the first node; its weight;
    /// the gradient of the weight at the point, 1/m.
    #[inline]
    pub fn nodes(&self, mut visit: impl FnMut([usize; 2], f64, [f64; 2])) {
        let [(wx, gx), (wy, gy)] = self.rest.map(|r| weights(self.half_width, r));
        for a in 0..STENCIL {
            for b in 0..STENCIL {
                let weight = wx[a] * wy[b];
                if weight > 0.0 {
                    let per = self.inverse_spacing;
                    visit([a, b], weight, [gx[a] * wy[b] * per, wx[a] * gy[b] * per]);
                }
            }
        }
    }
}

fn weights(half_width: f64, r: f64) -> ([f64; STENCIL], [f64; STENCIL]) {
    if half_width > 0.0 { AveragedHat::new(half_width).eval(r) } else { Hat.eval(r) }
}

#[cfg(test)]
mod tests {
    use super::*;

    const CORNER: [f64; 2] = [-3.0, 2.0];
    const SPACING: f64 = 0.5;

    /// Eight points between -1 and 1 m of the node at (0, 4).
    fn points() -> [[f64; 2]; LANES] {
        std::array::from_fn(|l| [0.9 - 0.23 * l as f64, 3.3 + 0.19 * l as f64])
    }

    #[test]
    fn weights_add_up_to_one_and_gradients_find_a_slope() {
        for half_width in [0.0, 0.25, 0.5] {
            for x in points() {
                let stencil = Stencil::new(x, CORNER, 1.0 / SPACING, half_width);
                let (mut sum, mut place, mut slope) = (0.0, [0.0; 2], [[0.0; 2]; 2]);
                stencil.nodes(|at, weight, gradient| {
                    sum += weight;
                    for d in 0..2 {
                        let node = CORNER[d] + (f64::from(stencil.start[d]) + at[d] as f64) * SPACING;
                        place[d] += weight * node;
                        slope[d] = [0, 1].map(|e| slope[d][e] + gradient[e] * node);
                    }
                });
                assert!((sum - 1.0).abs() < 1e-14, "{sum}");
                assert!((0..2).all(|d| (place[d] - x[d]).abs() < 1e-14), "{place:?} for {x:?}");
                for (d, e) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
                    assert!((slope[d][e] - f64::from(u8::from(d == e))).abs() < 1e-13, "{slope:?}");
                }
            }
        }
    }

    #[test]
    fn eight_points_see_what_one_sees() {
        let points = points();
        let x = [0, 1].map(|d| std::array::from_fn(|l| points[l][d]));
        let mut eight = Stencils::EMPTY;
        let columns = |i: i32, j: i32| [0, 1, 2].map(|k| (100 * (i + k) + j) as usize);
        eight.evaluate(AveragedHat::new(0.25), &x, CORNER, 1.0 / SPACING, columns);
        for (l, &point) in points.iter().enumerate() {
            let one = Stencil::new(point, CORNER, 1.0 / SPACING, 0.25);
            let mut seen = 0;
            one.nodes(|[a, b], weight, gradient| {
                seen += 1;
                let [i, j] = [one.start[0] as usize + a, one.start[1] as usize + b];
                assert_eq!(eight.first[a][l] + b, 100 * i + j);
                assert_eq!(weight, eight.w[0][a][l] * eight.w[1][b][l]);
                let [gx, gy] = [eight.g[0][a][l] * eight.w[1][b][l], eight.w[0][a][l] * eight.g[1][b][l]];
                assert!((gradient[0] - gx).abs() < 1e-14 && (gradient[1] - gy).abs() < 1e-14);
            });
            assert!(seen >= 4, "{seen} nodes");
            let same = points.iter().map(|&p| Stencil::new(p, CORNER, 1.0 / SPACING, 0.25).start == one.start);
            assert!(same.zip(eight.key).all(|(same, key)| same == (key == eight.key[l])), "keys tell stencils apart");
        }
    }
}

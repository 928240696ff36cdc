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
//! - at least what a flat surface of dense material would not explain: opened >= -ln(phi + 0.7 h^2 |grad phi|^2). The outermost points of
//!   dense material lie a quarter of a cell below its surface. There the mean over all places of the grid of phi is 0.66 and that of h
//!   |grad phi| is 0.69, so that nothing is to be closed. At single places of the grid up to a quarter is.
//!
//! Points that are not open are left alone, so material that never came apart does not feel this. Open points carry no pressure, so
//! neither energy nor force changes (with cohesion, the little shear stress that they may keep acts on another volume).
//!
//! Elsewhere: a bound on the volume fraction from the grid, as in unilateral incompressibility of granular media (Narain, Golas and
//! Lin 2010; Daviet and Bertails-Descoubes 2016); volume correction of material that separated (Tampubolon et al. 2017).

use super::VelocityField;
use crate::boundary::{Boundary, Friction};
use crate::grid::ActiveGrid;
use crate::seeded::{self, Seed};
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
        if boundaries.iter().any(|b| b.velocity.norm_squared() > 0.0) {
            self.forget_boundaries();
        }
        // A gate has no back, and clamps hold what lies in them.
        let members = &fields[k].members;
        let solid: Vec<&Boundary> = boundaries
            .iter()
            .filter(|b| b.opening.is_none() || !b.released)
            .filter(|b| b.friction != Friction::Bonded && b.acts_on(members))
            .collect();
        self.fill(fields, k, &solid);
        self.share(&fields[k], k, &solid, thickness);
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
                    let opened = block.opened[l].min(most).max(least);
                    block.volume_ratio[l] *= libm::exp(opened - block.opened[l]);
                    block.opened[l] = opened;
                }
            }
            points.pad();
        }
    }

    /// Volume of the material at each node of the grid of field `k`, m3, its openings left out.
    fn fill(&mut self, fields: &[VelocityField], k: usize, solid: &[&Boundary]) {
        let grid = &fields[k].grid;
        self.filled.clear();
        self.filled.resize(grid.len(), 0.0);
        for (f, field) in fields.iter().enumerate() {
            let bodies = &field.bodies;
            let own: Vec<_> = field.members.iter().zip(bodies).collect();
            // Others may lie in what is solid to this one.
            let buried = |x: [f64; 2]| f != k && solid.iter().any(|s| s.depth(x) > 0.0);
            for (body, block, n) in field.blocks() {
                let Some((_, b)) = own.iter().find(|(m, _)| **m == body) else { continue };
                for l in 0..n {
                    let x = [block.x[0][l], block.x[1][l]];
                    let Some((nodes, [u, v])) = cell(grid, x).filter(|_| !buried(x)) else { continue };
                    let volume = b.point_volume * block.volume_ratio[l] * libm::exp(-block.opened[l]);
                    for (node, share) in nodes.into_iter().zip(hats(u, v)) {
                        self.filled[node] += share * volume;
                    }
                }
            }
        }
    }

    /// Turns volumes into shares of what is outside of boundaries.
    fn share(&mut self, field: &VelocityField, k: usize, solid: &[&Boundary], thickness: f64) {
        let grid = &field.grid;
        let h = grid.spacing;
        let whole = 1.0 / (seeded::times(Seed::SimulationOccupied, h * h) * thickness);
        for (c, column) in grid.columns.iter().enumerate() {
            for r in 0..column.rows {
                let filled = &mut self.filled[(column.start + r) as usize];
                if *filled <= 0.0 {
                    continue;
                }
                let row = i64::from(column.row) + i64::from(r);
                let place = (k, grid.first[0] + c as i64, grid.first[1] + row);
                let x = [grid.corner[0] + c as f64 * h, grid.corner[1] + row as f64 * h];
                let outside = self.outside.entry(place).or_insert_with(|| outside(solid, x, h));
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
    Some([void(here + seeded::times(Seed::SimulationSurface, SURFACE) * (across * across + up * up)), void(here)])
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::boundary::Opening;
    use crate::constitutive::{AnyLaw, Cone, DruckerPrager, LinearElastic};
    use crate::scaffold::{Brick, points_by_number, scene};
    use crate::simulation::Simulation;
    use nalgebra::Vector2;

    const H: f64 = 0.1;

    /// A block of sand on a plane, all of it open by `opened` and by as much larger; `lifted` of its points moved up by so much.
    fn sand(cells: [usize; 2], opened: f64, lifted: (usize, f64), place: [f64; 2]) -> Vec<crate::body::Particle> {
        let brick = Brick::new(place, cells, H);
        let law = DruckerPrager::new(LinearElastic::new(1e6, 0.3), Cone::PlaneStrain, 0.5, 0.0, 0.0, 0.0, true);
        let mut points = brick.points();
        let moved = points.len() - lifted.0;
        points[moved..].iter_mut().for_each(|p| p.x[1] += lifted.1);
        points.iter_mut().for_each(|p| (p.state.opened, p.volume_ratio) = (opened, libm::exp(opened)));
        let wall = |at: [f64; 2], n: [f64; 2]| Boundary::plane("p", at.into(), n.into(), Friction::Smooth);
        let right = place[0] + cells[0] as f64 * H;
        let boundaries = vec![wall(place, [0.0, 1.0]), wall(place, [1.0, 0.0]), wall([right, 0.0], [-1.0, 0.0])];
        points_by_number(&Simulation::new(scene(&brick, AnyLaw::DruckerPrager(law), 1500.0, points, boundaries)))
    }

    #[test]
    fn dense_sand_has_nothing_to_close_wherever_the_grid_lies() {
        for k in 0..8 {
            let place = [0.0125 * f64::from(k), 0.0125 * f64::from(3 * k % 8)];
            let points = sand([6, 6], 1.0, (0, 0.0), place);
            let inside = |p: &&crate::body::Particle| p.x[1] < place[1] + 4.5 * H;
            // Beside a wall a quarter of a cell before a node, hats see four points a cell as 11 % too few for that node; half of it
            // counts at the nearest points, and twice in a corner.
            let most = points.iter().filter(inside).map(|p| p.state.opened).fold(0.0, f64::max);
            assert!(most < 0.12, "{place:?}: {most} deep in the block");
            for p in points {
                let volume = p.volume_ratio * libm::exp(-p.state.opened);
                assert!((volume - 1.0).abs() < 1e-14, "what is left without its openings: {volume}");
            }
        }
    }

    #[test]
    fn the_surface_of_dense_sand_is_not_opened() {
        let opened = [0, 1, 2, 3, 4, 5, 6, 7].map(|k| {
            let points = sand([6, 6], 1e-6, (0, 0.0), [0.0, 0.0125 * f64::from(k)]);
            points.iter().filter(|p| (p.x[0] - 0.3).abs() < 0.1).map(|p| p.state.opened).fold(0.0, f64::max)
        });
        // The relation of phi and its gradient holds in the mean over all places of the grid; single places are off by a quarter.
        let mean = opened.iter().sum::<f64>() / 8.0;
        assert!(mean < 0.15 && opened.iter().all(|&o| o < 0.3), "{mean}: {opened:?}");
    }

    #[test]
    fn points_that_fly_alone_are_open_whatever_they_felt() {
        // The upper row flies three cells above the others, of which nothing was stretched.
        let points = sand([6, 3], 1e-6, (12, 3.0 * H), [0.0, 0.0]);
        let (low, high) = points.split_at(points.len() - 12);
        let least = high.iter().map(|p| p.state.opened).fold(f64::INFINITY, f64::min);
        // A row of points fills half a row of cells: 0.75 of the nodes at best.
        assert!(least > 0.3, "{least}");
        assert!(low.iter().all(|p| p.state.opened < 0.2), "the others are dense");
        // What never opened is left alone.
        let untouched = sand([6, 3], 0.0, (12, 3.0 * H), [0.0, 0.0]);
        assert!(untouched.iter().all(|p| p.state.opened == 0.0 && p.volume_ratio == 1.0));
    }

    #[test]
    fn the_bound_is_that_of_the_share_and_its_gradient() {
        let column = |k: u32| crate::grid::Column { start: 3 * k, row: 0, rows: 3 };
        let columns = (0..3).map(column).collect();
        let grid = ActiveGrid { spacing: H, inverse_spacing: 1.0 / H, columns, ..ActiveGrid::default() };
        // A share that falls by 0.3 a cell along x and by 0.4 along y: 0.25 is its gradient's square.
        let filled: Vec<f64> = (0..9).map(|n| 0.9 - 0.3 * f64::from(n / 3) - 0.4 * f64::from(n % 3)).collect();
        let [least, most] = limits(&filled, &grid, [0.5 * H, 0.5 * H]).expect("active nodes");
        assert!((libm::exp(-most) - 0.55).abs() < 1e-12, "{most}");
        assert!((libm::exp(-least) - (0.55 + 0.7 * 0.25)).abs() < 1e-12, "{least}");
    }

    #[test]
    fn a_node_on_a_wall_has_half_its_volume_and_a_gate_that_is_gone_takes_none() {
        let plane = |d: f64| Boundary::plane("p", Vector2::new(0.0, d), Vector2::new(0.0, 1.0), Friction::Smooth);
        let share = |b: &[&Boundary]| outside(b, [0.0, 0.0], H);
        assert_eq!(share(&[]), 1.0);
        assert!((share(&[&plane(0.0)]) - 0.5).abs() < 1e-12);
        // The integral of a hat above half a cell: an eighth.
        assert!((share(&[&plane(0.5 * H)]) - 0.125).abs() < 1e-12);
        assert_eq!(share(&[&plane(H)]), SLIVER);
        assert_eq!(share(&[&plane(-3.0 * H)]), 1.0);
        let side = Boundary::plane("s", Vector2::zeros(), Vector2::new(1.0, 0.0), Friction::Smooth);
        assert!((share(&[&plane(0.0), &side]) - 0.25).abs() < 1e-12);
        let wall = Boundary::wall("g", Vector2::new(0.0, -1.0), Vector2::new(0.0, 1.0), 2.0, 1.0, Friction::Smooth);
        let mut gate = wall.gate(Opening::Vanish);
        assert!((share(&[&gate]) - 0.5).abs() < 1e-12);
        gate.release();
        assert!(gate.is_gone());
    }
}

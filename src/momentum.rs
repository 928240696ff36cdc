//! The grid solve: nodal sums, momentum balance, contact with rigid boundaries.
//!
//! Nodes are worked in chunks of fixed size. A chunk adds up what the bands scattered, in the order of the bands, so that the
//! sums do not depend on which thread did what.

use crate::boundary::nodes::{Hold, Tally};
use crate::boundary::{Boundary, nodes};
use crate::grid::ActiveGrid;
use crate::layout::Band;
use rayon::prelude::*;

/// Nodes per chunk.
const CHUNK: usize = 1024;

/// A run of nodes with what holds them and what they tallied in the step.
#[derive(Debug, Clone, Default)]
struct Chunk {
    /// First node.
    first: usize,
    /// Boundaries acting on its nodes, in the order of the nodes.
    holds: Vec<Hold>,
    /// One per boundary.
    tallies: Vec<Tally>,
    damping: Drag,
    side_walls: Drag,
    field: Drag,
    inertia: Vec<[f64; 4]>,
    force: Vec<[f64; 2]>,
    field_force: Vec<[f64; 2]>,
}

/// Impulse and work of a distributed force on the material in one step.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Drag {
    /// N s.
    pub impulse: [f64; 2],
    /// J, negative when it dissipates.
    pub work: f64,
}

impl Drag {
    fn add(&mut self, impulse: [f64; 2], mean: [f64; 2]) {
        self.impulse[0] += impulse[0];
        self.impulse[1] += impulse[1];
        self.work += impulse[0] * mean[0] + impulse[1] * mean[1];
    }

    /// Adds another drag.
    pub fn merge(&mut self, other: &Drag) {
        self.impulse[0] += other.impulse[0];
        self.impulse[1] += other.impulse[1];
        self.work += other.work;
    }
}

/// Impulse and work of everything that acts throughout the material but gravity.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Distributed {
    /// Mass-proportional damping.
    pub damping: Drag,
    /// Side-wall friction.
    pub side_walls: Drag,
    /// A field of accelerations, where one is set.
    pub field: Drag,
}

/// What acts on every node alike.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BodyForces {
    /// Gravity, m/s2.
    pub gravity: [f64; 2],
    /// Mass-proportional damping, 1/s.
    pub damping: f64,
}

/// The chunks of the active grid.
#[derive(Debug, Clone, Default)]
pub struct NodeSolver {
    chunks: Vec<Chunk>,
    holds: Vec<Hold>,
}

impl NodeSolver {
    /// Follows a new layout of the grid.
    pub fn rebuild(&mut self, grid: &ActiveGrid, boundaries: &[Boundary]) {
        nodes::find_holds(boundaries, grid, &mut self.holds);
        self.chunks.resize_with(grid.len().div_ceil(CHUNK), Chunk::default);
        let mut rest: &[Hold] = &self.holds;
        for (index, chunk) in self.chunks.iter_mut().enumerate() {
            chunk.first = index * CHUNK;
            let nodes = CHUNK.min(grid.len() - chunk.first);
            let count = rest.partition_point(|h| (h.node as usize) < chunk.first + nodes);
            let (own, others) = rest.split_at(count);
            chunk.holds.clear();
            chunk.holds.extend_from_slice(own);
            rest = others;
            chunk.tallies.resize(boundaries.len(), Tally::default());
            chunk.inertia.resize(nodes, [0.0; 4]);
            chunk.force.resize(nodes, [0.0; 2]);
        }
    }

    /// Nodal masses and velocities of the step's start, for a stress update before the momentum balance (USF).
    pub fn old_velocities(&mut self, grid: &mut ActiveGrid, bands: &[Band]) {
        self.for_each(grid, |chunk, mass, _, velocity| {
            chunk.sum_inertia(bands);
            for (i, sum) in chunk.inertia.iter().enumerate() {
                mass[i] = sum[0];
                velocity[i] = if sum[0] > 0.0 { [sum[1] / sum[0], sum[2] / sum[0]] } else { [0.0; 2] };
            }
            chunk.project(velocity);
        });
    }

    /// Momentum balance of every node and its contact with the boundaries: new velocities and their change.
    ///
    /// `boundary_tallies` receives what each boundary did in this step.
    pub fn solve(
        &mut self,
        grid: &mut ActiveGrid,
        bands: &[Band],
        boundaries: &[Boundary],
        forces: BodyForces,
        dt: f64,
        boundary_tallies: &mut [Tally],
    ) -> Distributed {
        self.for_each(grid, |chunk, mass, motion, velocity| {
            chunk.sum_inertia(bands);
            chunk.sum_force(bands);
            chunk.sum_field(bands);
            chunk.solve(boundaries, forces, dt, mass, motion, velocity);
        });
        let mut all = Distributed::default();
        for chunk in &self.chunks {
            for (sum, tally) in boundary_tallies.iter_mut().zip(&chunk.tallies) {
                sum.add(tally);
            }
            all.damping.merge(&chunk.damping);
            all.side_walls.merge(&chunk.side_walls);
            all.field.merge(&chunk.field);
        }
        all
    }

    /// Velocities from the momentum that the points carry after their update (MUSL), for the stress update.
    pub fn remapped_velocities(&mut self, grid: &mut ActiveGrid, bands: &[Band]) {
        self.for_each(grid, |chunk, mass, _, velocity| {
            chunk.sum_force(bands);
            for (i, p) in chunk.force.iter().enumerate() {
                velocity[i] = if mass[i] > 0.0 { [p[0] / mass[i], p[1] / mass[i]] } else { [0.0; 2] };
            }
            chunk.project(velocity);
        });
    }

    /// What held nodes in the last step, in the order of the nodes.
    pub fn holds(&self) -> impl Iterator<Item = &Hold> {
        self.chunks.iter().flat_map(|c| &c.holds)
    }

    fn for_each(
        &mut self,
        grid: &mut ActiveGrid,
        work: impl Fn(&mut Chunk, &mut [f64], &mut [[f64; 4]], &mut [[f64; 2]]) + Sync,
    ) {
        let nodes = (
            grid.mass.par_chunks_mut(CHUNK),
            grid.motion.par_chunks_mut(CHUNK),
            grid.strain_velocity.par_chunks_mut(CHUNK),
        );
        (self.chunks.par_iter_mut(), nodes.0, nodes.1, nodes.2)
            .into_par_iter()
            .for_each(|(chunk, mass, motion, velocity)| work(chunk, mass, motion, velocity));
    }
}

impl Chunk {
    fn sum_inertia(&mut self, bands: &[Band]) {
        self.inertia.fill([0.0; 4]);
        for band in bands {
            if let Some((to, from)) = overlap(self.first, self.inertia.len(), band.first_node, band.inertia.len()) {
                for (sum, part) in self.inertia[to].iter_mut().zip(&band.inertia[from]) {
                    for (s, p) in sum.iter_mut().zip(part) {
                        *s += p;
                    }
                }
            }
        }
    }

    fn sum_force(&mut self, bands: &[Band]) {
        self.force.fill([0.0; 2]);
        for band in bands {
            if let Some((to, from)) = overlap(self.first, self.force.len(), band.first_node, band.force.len()) {
                for (sum, part) in self.force[to].iter_mut().zip(&band.force[from]) {
                    sum[0] += part[0];
                    sum[1] += part[1];
                }
            }
        }
    }

    /// Adds a body-force field, if there is one, to the internal force.
    fn sum_field(&mut self, bands: &[Band]) {
        self.field_force.clear();
        for band in bands.iter().filter(|b| !b.field_force.is_empty()) {
            self.field_force.resize(self.force.len(), [0.0; 2]);
            if let Some((to, from)) = overlap(self.first, self.force.len(), band.first_node, band.field_force.len()) {
                for (node, part) in to.zip(&band.field_force[from]) {
                    for (d, f) in part.iter().enumerate() {
                        self.field_force[node][d] += f;
                        self.force[node][d] += f;
                    }
                }
            }
        }
    }

    /// v = v + dt (f/m + g), then drags, then contact.
    fn solve(
        &mut self,
        boundaries: &[Boundary],
        forces: BodyForces,
        dt: f64,
        mass: &mut [f64],
        motion: &mut [[f64; 4]],
        velocity: &mut [[f64; 2]],
    ) {
        self.tallies.fill(Tally::default());
        self.damping = Drag::default();
        self.side_walls = Drag::default();
        self.field = Drag::default();
        let mut next_hold = 0;
        for i in 0..self.inertia.len() {
            let [m, px, py, side_friction] = self.inertia[i];
            mass[i] = m;
            let first_hold = next_hold;
            while self.holds.get(next_hold).is_some_and(|h| h.node as usize == self.first + i) {
                next_hold += 1;
            }
            if m <= 0.0 {
                motion[i] = [0.0; 4];
                velocity[i] = [0.0; 2];
                continue;
            }
            let per_m = 1.0 / m;
            let old = [px * per_m, py * per_m];
            let f = self.force[i];
            let mut v =
                [old[0] + dt * (f[0] * per_m + forces.gravity[0]), old[1] + dt * (f[1] * per_m + forces.gravity[1])];
            let mut damped = [0.0; 2];
            if forces.damping > 0.0 {
                let share = (dt * forces.damping).min(1.0);
                damped = [-share * m * old[0], -share * m * old[1]];
                v = [v[0] + damped[0] * per_m, v[1] + damped[1] * per_m];
            }
            let mut braked = [0.0; 2];
            if side_friction > 0.0 {
                let speed = (v[0] * v[0] + v[1] * v[1]).sqrt();
                let share = if speed > 0.0 { (dt * side_friction / (m * speed)).min(1.0) } else { 0.0 };
                braked = [-share * m * v[0], -share * m * v[1]];
                v = [v[0] * (1.0 - share), v[1] * (1.0 - share)];
            }
            if next_hold > first_hold {
                let holds = &mut self.holds[first_hold..next_hold];
                nodes::solve(holds, boundaries, m, old, &mut v, &mut self.tallies);
            }
            let mean = [0.5 * (old[0] + v[0]), 0.5 * (old[1] + v[1])];
            if forces.damping > 0.0 {
                self.damping.add(damped, mean);
            }
            if side_friction > 0.0 {
                self.side_walls.add(braked, mean);
            }
            if let Some(f) = self.field_force.get(i) {
                self.field.add([f[0] * dt, f[1] * dt], mean);
            }
            motion[i] = [v[0], v[1], v[0] - old[0], v[1] - old[1]];
            velocity[i] = v;
        }
    }

    /// Applies the contact state of each held node to a velocity field.
    fn project(&self, velocity: &mut [[f64; 2]]) {
        for holds in self.holds.chunk_by(|a, b| a.node == b.node) {
            nodes::project(holds, &mut velocity[holds[0].node as usize - self.first]);
        }
    }
}

/// Ranges within two runs of nodes that cover the same nodes.
fn overlap(
    first_a: usize,
    len_a: usize,
    first_b: usize,
    len_b: usize,
) -> Option<(std::ops::Range<usize>, std::ops::Range<usize>)> {
    let low = first_a.max(first_b);
    let high = (first_a + len_a).min(first_b + len_b);
    (low < high).then(|| (low - first_a..high - first_a, low - first_b..high - first_b))
}

//! A stiff body in implicit steps, so that its waves do not shorten the time step of everything else.
//!
//! From sort to sort the body moves by the linear momentum balance of its own grid nodes, by the theta method (Jean
//! 1999):
//!
//! `M (w1 - w0) = dt (M g - f - K (theta d1 + (1 - theta) d0)) + J + R` with `d1 - d0 = dt (theta w1 + (1 - theta) w0)`,
//!
//! where M is the lumped mass, f the force of the stresses at the sort, K the elastic stiffness of the points where
//! they were at the sort, d the displacement since then, J the impulses of contact and R those of clamps. Shape
//! functions and points are those of everything else. A sort follows after half a cell of motion, so turns may be large
//! although every piece between sorts is linear; what is neglected is the stiffness that stress itself gives.
//!
//! A swing of angular frequency w is damped by `(2 theta - 1) w dt/2` of critical, and a wave that is much too fast for the step keeps
//! `(1 - theta)/theta` of its velocity from step to step. With theta = 1 (implicit Euler) a stiff barrier bends 1 to 2 % less. With 1/2
//! nothing dies out, and contact, whose law holds at the end of a step, feeds waves until sand flies off. [`THETA`] lies between: a fifth
//! of Euler's damping, and what cannot be followed is down to a percent after twelve steps. What it takes is measured.
//!
//! Contact and body are solved together by block Gauss-Seidel iteration (Jean 1999). Contact is solved node by node as for any body. It is
//! given the velocity that the node has under the latest impulses at all other nodes, and a mass that is never more than the body shows at
//! this node. That is repeated until impulses no longer change: then body and contact law agree at every node. Where they do not, the
//! ledger counts losses that no body has had, so that the energy does not close.
//!
//! Beyond a face along the grid, uGIMP gives a node a weight w at its points and a gradient of the order of sqrt(w)/h. Mass and stiffness
//! of the node fall as w, but the force of a stress only as sqrt(w). So the node moves at w^(-1/2) times the velocity of others (other
//! functions and corners have other powers). Strains of its points need that motion, and their velocities do not see it. Another body at
//! the node does see it, and would be given energy that no point of this one has lost. Contact therefore leaves nodes out where the body
//! has next to no mass ([`TOUCHABLE`]). The share is no derived number: 1e-4, 1e-3 and 1e-2 gave the same forces and energies within a
//! percent, contact begins a few hundredths of a cell later. Explicit steps start each step from the points and forget such motion.
//!
//! Elsewhere: the free motion is the predictor and contact the corrector; the answers of nodes to impulses are the
//! contact compliance (Delassus operator); the iteration is a partitioned or staggered solution. It has a warm start:
//! nodes that stay in touch begin with their impulses of the last step.

mod assembly;
pub(super) mod banded;
mod motion;

use super::field::VelocityField;
use crate::boundary::Boundary;
use crate::momentum::BodyForces;
use crate::space::{minus, scaled};
use banded::{Banded, Blocks};

/// Most sweeps over the touched nodes in a step, and the change of velocity, as a share of the largest, at which they
/// end.
pub(super) const PASSES: usize = 1000;
pub(super) const SETTLED: f64 = 1e-7;
/// Weight of the end of a step in its forces and velocities.
pub(super) const THETA: f64 = 0.6;
/// Share of the mass of its fullest node from which on contact acts on a node.
const TOUCHABLE: f64 = 1e-3;

/// A point with its place and state at the last sort, and the nodes it reaches.
#[derive(Debug, Clone)]
struct Point {
    base: crate::body::Particle,
    nodes: [u32; 9],
    weight: [f64; 9],
    gradient: [[f64; 2]; 9],
}

/// A node that other fields reach.
#[derive(Debug, Clone)]
struct Shared {
    node: usize,
    band: usize,
    index: usize,
    /// Contact impulse of the step, N s.
    impulse: [f64; 2],
    /// Velocity per impulse that contact is told, 1/kg.
    mobility: f64,
    touched: bool,
    /// Place among the touched nodes.
    rank: usize,
}

/// A body in implicit steps.
#[derive(Debug, Clone, Default)]
pub(super) struct ImplicitBody {
    /// Its velocity field.
    pub field: usize,
    /// That field, while all others are swept.
    pub own: VelocityField,
    points: Vec<Point>,
    /// Band and place in it of each node.
    places: Vec<(usize, usize)>,
    mass: Vec<f64>,
    /// Mass from which on contact acts on a node, kg.
    touchable: f64,
    clamped: Vec<bool>,
    /// Force of the stresses at the sort, N, and stiffness, N/m.
    force: Vec<f64>,
    /// Force of the stresses now, and at the end of the step, N.
    internal: Vec<f64>,
    after: Vec<f64>,
    stiffness: Banded,
    /// The same.
    blocks: Blocks,
    factor: Banded,
    /// Step for which the factor holds, s.
    dt: f64,
    velocity: Vec<f64>,
    /// Time since the sort, s, and displacement since then, m.
    since: f64,
    displacement: Vec<f64>,
    /// Velocity at the sort as the points give it, m/s.
    start: Vec<f64>,
    /// Momentum that the points gave clamped nodes at the sort and that the clamp has still to answer for, N s.
    caught: Vec<f64>,
    /// Velocity at the end of the step without contact, m/s.
    free: Vec<f64>,
    /// Stiffness times velocity, N/s.
    pulled: Vec<f64>,
    damped: Vec<f64>,
    contact: Vec<f64>,
    touched: Vec<usize>,
    /// Velocity of each touched node per impulse at each other: xx, xy, yx, yy in 1/kg, row by row.
    answers: Vec<[f64; 4]>,
    /// Kinetic energy that the nodes had more than the points, J.
    unseen: f64,
    /// Velocities of all nodes per unit impulse along x and y at each node; empty until it is touched, and for a clamped one.
    responses: Vec<[Vec<f64>; 2]>,
    shared: Vec<Shared>,
    /// First of the shared nodes of each band.
    slots: Vec<usize>,
    /// Largest change of a velocity in this sweep and the largest velocity that contact gave, m/s.
    change: [f64; 2],
    /// Largest number of sweeps in a step.
    pub passes: usize,
}

/// What a body in implicit steps does while the others are swept.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Turn {
    /// Finds how it would move without contact.
    Predict,
    /// Moves.
    Finish,
}

/// The bodies in implicit steps among those that have a velocity field of their own.
pub(super) fn bodies(fields: &[VelocityField]) -> Vec<ImplicitBody> {
    let alone = fields
        .iter()
        .enumerate()
        .filter(|(_, f)| f.bodies.len() == 1 && f.bodies[0].implicit && f.bodies[0].mesh.is_none());
    alone.map(|(field, _)| ImplicitBody { field, ..ImplicitBody::default() }).collect()
}

impl ImplicitBody {
    /// Does one or the other on its own field; `common` acts on all fields.
    pub fn take_turn(&mut self, turn: Turn, boundaries: &[Boundary], common: BodyForces, dt: f64) {
        let mut field = std::mem::take(&mut self.own);
        let forces = field.forces(common);
        match turn {
            Turn::Predict => self.predict(&mut field, forces, dt),
            Turn::Finish => self.finish(&mut field, boundaries, forces, dt),
        }
        self.own = field;
    }

    /// Where a shared node is kept.
    pub fn slot(&self, band: usize, index: usize) -> usize {
        self.slots[band] + index
    }

    /// Follows a new list of shared nodes.
    pub fn follow(&mut self, field: &VelocityField) {
        let mut number = vec![usize::MAX; field.grid.len()];
        for (node, &(band, at)) in self.places.iter().enumerate() {
            number[field.bands[band].first_node + at] = node;
        }
        self.shared.clear();
        self.slots.clear();
        for (b, band) in field.bands.iter().enumerate() {
            self.slots.push(self.shared.len());
            for (index, &at) in band.shared.iter().enumerate() {
                let node = number[band.first_node + at as usize];
                let (impulse, mobility, touched, rank) = ([0.0; 2], 0.0, false, 0);
                self.shared.push(Shared { node, band: b, index, impulse, mobility, touched, rank });
            }
        }
        self.touched.clear();
        self.touched.reserve(self.shared.len());
        self.answers.clear();
        self.answers.reserve(self.shared.len() * self.shared.len());
    }

    /// Finds the responses of some shared nodes that are missing.
    fn respond(&mut self, touched: &[usize]) {
        let Self { shared, clamped, responses, factor, .. } = self;
        for node in touched.iter().map(|&k| shared[k].node) {
            if clamped.get(node).is_none_or(|c| *c) || !responses[node][0].is_empty() {
                continue;
            }
            for (d, column) in responses[node].iter_mut().enumerate() {
                column.resize(2 * clamped.len(), 0.0);
                column[2 * node + d] = 1.0;
                factor.solve_from(2 * node + d, column);
            }
        }
    }

    /// Velocities of all nodes per unit impulse along x (0) or y (1) at a node, or nothing.
    fn response(&self, node: usize, d: usize) -> &[f64] {
        self.responses.get(node).map_or(&[], |r| &r[d])
    }

    /// Forgets the responses.
    fn forget(&mut self) {
        self.responses.iter_mut().flatten().for_each(Vec::clear);
        self.responses.resize(self.mass.len(), Default::default());
    }

    /// Makes ready for steps of `dt` (s).
    pub fn set_step(&mut self, dt: f64) {
        if dt == self.dt {
            return;
        }
        self.dt = dt;
        self.factor.scaled_from(&self.stiffness, (THETA * dt) * (THETA * dt));
        for (node, &m) in self.mass.iter().enumerate() {
            for i in [2 * node, 2 * node + 1] {
                if self.clamped[node] {
                    self.factor.isolate(i, 1.0);
                } else {
                    self.factor.add(i, i, m);
                }
            }
        }
        assert!(self.factor.factor(), "mass plus stiffness is positive definite");
        self.forget();
    }

    /// Notes that a shared node, where the body has mass, is touched in this step.
    pub fn touch(&mut self, slot: usize) {
        self.shared[slot].touched = true;
    }

    /// Whether it is.
    pub fn is_touched(&self, slot: usize) -> bool {
        self.shared[slot].touched
    }

    /// Mass of the points at a shared node, kg, not that which answers an impulse there; None where they have none.
    pub fn mass_at(&self, slot: usize) -> Option<f64> {
        self.mass.get(self.shared[slot].node).copied()
    }

    /// Finds how each touched node answers an impulse at each.
    pub fn weigh(&mut self) {
        self.change = [0.0; 2];
        let mut touched = std::mem::take(&mut self.touched);
        touched.clear();
        touched.extend((0..self.shared.len()).filter(|&k| self.shared[k].touched));
        self.respond(&touched);
        self.answers.clear();
        for (rank, &k) in touched.iter().enumerate() {
            let node = self.shared[k].node;
            let first = self.answers.len();
            for &j in &touched {
                let of =
                    |d: usize| self.response(self.shared[j].node, d).get(2 * node..2 * node + 2).unwrap_or(&[0.0; 2]);
                let (x, y) = (of(0), of(1));
                self.answers.push([x[0], y[0], x[1], y[1]]);
            }
            // Frobenius's norm, no less than the largest eigenvalue: no sweep then overshoots.
            let own = self.answers[first + rank];
            self.shared[k].mobility = own.iter().map(|x| x * x).sum::<f64>().sqrt();
            self.shared[k].rank = rank;
        }
        for s in self.shared.iter_mut().filter(|s| !s.touched) {
            s.impulse = [0.0; 2];
        }
        self.touched = touched;
    }

    /// Tells contact how a shared node that is touched moves under the impulses found so far.
    pub fn offer(&self, slot: usize, field: &mut VelocityField) {
        let &Shared { node, band, index, impulse, mobility, rank, .. } = &self.shared[slot];
        let v = self.velocity_at(rank);
        let open = &mut field.bands[band].open[index];
        if self.clamped.get(node).is_none_or(|c| *c) || mobility <= 0.0 {
            open.free = v;
        } else {
            open.mass = 1.0 / mobility;
            open.free = minus(v, scaled(impulse, mobility));
        }
    }

    /// Velocity at the end of the step, under the impulses found so far, of the shared node that is the `i`-th touched
    /// one.
    fn velocity_at(&self, i: usize) -> [f64; 2] {
        let (node, n) = (self.shared[self.touched[i]].node, self.touched.len());
        let mut v = [0, 1].map(|d| self.free.get(2 * node + d).copied().unwrap_or(0.0));
        for (&k, a) in self.touched.iter().zip(&self.answers[i * n..(i + 1) * n]) {
            let p = self.shared[k].impulse;
            v[0] += a[0] * p[0] + a[1] * p[1];
            v[1] += a[2] * p[0] + a[3] * p[1];
        }
        v
    }

    /// Takes over the impulse that contact has found at a shared node, N s.
    pub fn take(&mut self, slot: usize, impulse: [f64; 2]) {
        let s = &mut self.shared[slot];
        for (old, new) in s.impulse.iter().zip(impulse) {
            let [change, largest] = &mut self.change;
            *change = change.max((new - old).abs() * s.mobility);
            *largest = largest.max(new.abs() * s.mobility);
        }
        s.impulse = impulse;
    }

    /// Ends a sweep: the largest change of a velocity in it and the largest velocity that contact gave, m/s.
    pub fn settle(&mut self) -> [f64; 2] {
        std::mem::take(&mut self.change)
    }
}

#[cfg(test)]
mod tests;

//! Contact where a boundary's surface crosses the lines of the grid.
//!
//! A surface that does not pass through nodes is held where it crosses a grid line, at a share of the way between the two nodes
//! beside it: there, the velocity interpolated from both must not press into the boundary. The impulse of the boundary goes to the
//! two nodes by the same shares, so that it does no work but on the velocity at the crossing. Where the crossing is a node, that is
//! contact at the node. Material then stops where the surface is, and not where the nearest nodes are.
//!
//! Elsewhere: an immersed or embedded boundary with Lagrange multipliers at the intersections of surface and grid; a multi-point
//! constraint with its adjoint distribution of forces.

use super::Boundary;
use super::nodes::{HoldState, Tally};
use crate::space::{clockwise, dot, mean, minus, moment, plus, scaled};

/// A crossing of a boundary's surface with a grid line.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Site {
    /// The node behind the surface and the one before it.
    pub nodes: [u32; 2],
    /// Their shares.
    pub weights: [f64; 2],
    /// Index of the boundary.
    pub boundary: u32,
    /// Unit normal, into the material.
    pub normal: [f64; 2],
    /// Position along the face from its foot, m.
    pub along: f64,
    /// Place, m.
    pub x: [f64; 2],
    /// Lever arm from the boundary's foot, m.
    arm: [f64; 2],
    /// Friction coefficient.
    friction: f64,
    /// Whether points decide about contact: how far they are is then set in each step.
    pub plate: bool,
    /// Speed at which material may still approach in this step, m/s; infinite where there is none.
    pub free: f64,
    /// Normal and tangential impulse of the step, N s.
    impulse: [f64; 2],
    state: HoldState,
}

/// The two nodes of a site in a step.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct SiteNode {
    /// Mass, kg.
    pub mass: f64,
    /// Velocity before the step, m/s.
    pub old: [f64; 2],
    /// Velocity, m/s.
    pub v: [f64; 2],
}

impl Site {
    /// A crossing with `face`, between `nodes` with these weights; where it lies on the face (m along it, position).
    pub(super) fn new(
        nodes: [usize; 2],
        weights: [f64; 2],
        boundary: usize,
        face: &Boundary,
        (along, x): (f64, [f64; 2]),
        plate: bool,
    ) -> Self {
        Self {
            nodes: nodes.map(|n| n as u32),
            weights,
            boundary: boundary as u32,
            normal: face.normal.into(),
            along,
            x,
            arm: minus(x, face.foot().into()),
            friction: face.friction.coefficient(),
            plate,
            free: 0.0,
            impulse: [0.0; 2],
            state: HoldState::Apart,
        }
    }

    /// Forgets the impulses of the last step.
    pub fn reset(&mut self) {
        (self.impulse, self.state) = ([0.0; 2], HoldState::Apart);
    }

    /// The vector impulse of the step on the material, N s.
    pub fn vector_impulse(&self) -> [f64; 2] {
        let [n, t] = self.impulse;
        plus(scaled(self.normal, n), scaled(clockwise(self.normal), t))
    }

    /// Velocity at the crossing.
    fn velocity(&self, v: [[f64; 2]; 2]) -> [f64; 2] {
        plus(scaled(v[0], self.weights[0]), scaled(v[1], self.weights[1]))
    }

    /// One over the mass that an impulse at the crossing moves, 1/kg; `None` where there is no material on both sides of it.
    fn mobility(&self, m: [f64; 2]) -> Option<f64> {
        let share = |k: usize| if self.weights[k] == 0.0 { 0.0 } else { self.weights[k] * self.weights[k] / m[k] };
        let sum = share(0) + share(1);
        (sum.is_finite() && sum > 0.0).then_some(sum)
    }

    /// Gives an impulse at the crossing to both nodes.
    fn give(&self, impulse: [f64; 2], nodes: [&mut SiteNode; 2]) {
        for (node, w) in nodes.into_iter().zip(self.weights) {
            if w > 0.0 {
                node.v = plus(node.v, scaled(impulse, w / node.mass));
            }
        }
    }

    /// One Gauss-Seidel visit: brings the impulses up to date with the velocities of the nodes, and these with them.
    pub fn relax(&mut self, boundaries: &[Boundary], nodes: [&mut SiteNode; 2], with_friction: bool) {
        let b = &boundaries[self.boundary as usize];
        let closed = b.free_below <= 0.0 || self.along >= b.free_below;
        let mobility = self.mobility([nodes[0].mass, nodes[1].mass]).filter(|_| closed && self.free.is_finite());
        let Some(mobility) = mobility else {
            self.state = HoldState::Apart;
            return;
        };
        let (n, t) = (self.normal, clockwise(self.normal));
        let rel = self.velocity([nodes[0].v, nodes[1].v]);
        let approach = dot(rel, n) + self.free;
        let normal = (self.impulse[0] - approach / mobility).max(0.0);
        let stick = self.impulse[1] - dot(rel, t) / mobility;
        // 0 x infinity must not arise.
        let limit = if normal > 0.0 && with_friction { self.friction * normal } else { 0.0 };
        let tangential = stick.clamp(-limit, limit);
        self.state = match () {
            () if normal <= 0.0 => HoldState::Apart,
            () if limit > 0.0 && stick.abs() <= limit => HoldState::Sticking,
            () => HoldState::Slipping,
        };
        let change = plus(scaled(n, normal - self.impulse[0]), scaled(t, tangential - self.impulse[1]));
        self.impulse = [normal, tangential];
        self.give(change, nodes);
    }

    /// What the site did, given the nodes after the step.
    pub fn tally(&self, nodes: [&SiteNode; 2]) -> Option<Tally> {
        if self.state == HoldState::Apart {
            return None;
        }
        let [n, t] = self.impulse;
        let mean = self.velocity(nodes.map(|node| mean(node.old, node.v)));
        let impulse = self.vector_impulse();
        Some(Tally {
            impulse,
            moment: moment(self.arm, impulse),
            friction_work: t * dot(mean, clockwise(self.normal)),
            normal_work: n * dot(mean, self.normal),
        })
    }

    /// Applies to velocities that only strain the material what the step decided: what is held does not move along the normal, and
    /// what sticks does not move.
    pub fn project(&self, nodes: [&mut SiteNode; 2]) {
        let Some(mobility) = self.mobility([nodes[0].mass, nodes[1].mass]) else { return };
        let v = self.velocity([nodes[0].v, nodes[1].v]);
        let stop = match self.state {
            HoldState::Apart => return,
            HoldState::Sticking => plus(v, scaled(self.normal, self.free)),
            HoldState::Slipping => scaled(self.normal, dot(v, self.normal) + self.free),
        };
        self.give(scaled(stop, -1.0 / mobility), nodes);
    }
}

//! Contact where a boundary's surface crosses the lines of the grid.
//!
//! A surface that does not pass through nodes is held where it crosses a grid line, at a share of the way between the two nodes
//! beside it: there, the velocity interpolated from both must not press into the boundary. The impulse of the boundary goes to the
//! two nodes by the same shares, so that it does no work but on the velocity at the crossing. Where the crossing is a node, that is
//! contact at the node. Material then stops where the surface is, and not where the nearest nodes are.
//!
//! Elsewhere: an immersed or embedded boundary with Lagrange multipliers at the intersections of surface and grid; a multi-point
//! constraint with its adjoint distribution of forces.

mod sliding;

use super::Boundary;
use super::nodes::{HoldState, Tally, work_along};
use crate::seeded::{self, Seed};
use crate::space::{clockwise, dot, mean, minus, moment, plus, scaled};
use sliding::SiteSlip;

/// A crossing of a boundary's surface with a grid line.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Site {
    /// The node behind the surface and the one before it; then, at the end of a wall, those of the next line beyond it.
    pub nodes: [u32; 4],
    /// Shares of the first two at the crossing, and of the others at theirs.
    shares: [[f64; 2]; 2],
    /// How much of the velocity beyond the end of the wall may pass here, 0 to 1.
    open: f64,
    /// Index of the boundary.
    pub boundary: u32,
    /// Unit normal, into the material.
    pub normal: [f64; 2],
    /// Position along the boundary's face from its foot, m.
    pub along: f64,
    /// Position along the side that is crossed, and the length of that, m.
    place: [f64; 2],
    /// Unit vector along that side.
    tangent: [f64; 2],
    /// Which end of the side is near, and half the distance of the lines along it, m.
    end: Option<(End, f64)>,
    /// Place, m.
    pub x: [f64; 2],
    /// Lever arm from the boundary's foot, m.
    arm: [f64; 2],
    /// Friction coefficient.
    friction: f64,
    /// What of that is mobilised, where friction needs slip.
    slip: Option<SiteSlip>,
    /// Whether points decide about contact: how far they are is then set in each step.
    pub plate: bool,
    /// Speed at which material may still approach in this step, m/s; infinite where there is none.
    pub free: f64,
    /// Normal and tangential impulse of the step, N s.
    impulse: [f64; 2],
    state: HoldState,
}

/// The free end of a side beside a crossing.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum End {
    /// Where it begins: at the lower edge, with an opening below it, or at the face.
    Foot,
    /// Where it ends: at the crest, or at the back.
    Crest,
}

/// A node of a site in a step.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct SiteNode {
    /// Mass, kg.
    pub mass: f64,
    /// Velocity before the step, m/s.
    pub old: [f64; 2],
    /// Velocity, m/s.
    pub v: [f64; 2],
    /// Velocity that the balance of the step found, m/s; set for the velocities that strain the material.
    pub balance: [f64; 2],
    /// Impulse of the internal force in the step, N s; set likewise.
    pub internal: [f64; 2],
}

impl Site {
    /// A crossing with `side`, between `nodes` with these shares; where it lies (m along that side and along the boundary's face,
    /// position), and the foot of the boundary.
    pub(super) fn new(
        nodes: [usize; 2],
        shares: [f64; 2],
        boundary: usize,
        side: &Boundary,
        ([place, along], x, foot): ([f64; 2], [f64; 2], [f64; 2]),
        plate: bool,
    ) -> Self {
        let [a, b] = nodes.map(|n| n as u32);
        Self {
            nodes: [a, b, a, b],
            shares: [shares, [0.0; 2]],
            open: 0.0,
            boundary: boundary as u32,
            normal: side.normal.into(),
            along,
            place: [place, side.height()],
            tangent: side.tangent.into(),
            end: None,
            x,
            arm: minus(x, foot).map(|a| seeded::times(Seed::BoundaryArm, a)),
            friction: seeded::times(Seed::BoundarySurfaceFriction, side.friction.coefficient()),
            slip: side.slip.map(SiteSlip::new),
            plate,
            free: 0.0,
            impulse: [0.0; 2],
            state: HoldState::Apart,
        }
    }

    /// The same beside an end of the wall, with nodes and shares of the crossing with the next line beyond it; `half` (m) is half the
    /// distance of the two.
    pub(super) fn beside(mut self, end: End, (nodes, shares): ([usize; 2], [f64; 2]), half: f64) -> Self {
        let [a, b, ..] = self.nodes;
        self.nodes = [a, b, nodes[0] as u32, nodes[1] as u32];
        self.shares[1] = shares;
        self.end = Some((end, half));
        self
    }

    /// Whether single points are kept from passing the surface here: at plates and ends, where the velocity of the grid may lead them
    /// into it.
    pub fn is_watched(&self) -> bool {
        self.plate || self.end.is_some()
    }

    /// Whether the side that is crossed is there, beside a place: not beyond its ends, nor below the lower edge of a gate.
    pub fn is_beside(&self, x: [f64; 2], b: &Boundary) -> bool {
        let [place, length] = self.place;
        let along = place + dot(minus(x, self.x), self.tangent);
        (b.free_below.max(0.0)..=length).contains(&along)
    }

    /// Forgets the impulses of the last step, and sees how far the wall covers the line: the share of the half lines on either side
    /// that is free.
    pub fn reset(&mut self, boundaries: &[Boundary]) {
        (self.impulse, self.state) = ([0.0; 2], HoldState::Apart);
        let b = &boundaries[self.boundary as usize];
        let [place, length] = self.place;
        let closed = b.free_below <= 0.0 || place >= b.free_below;
        self.open = match self.end {
            None | Some((End::Crest, _)) if !closed => 1.0,
            None => 0.0,
            Some((End::Foot, half)) => (0.5 + (b.free_below - place) / (2.0 * half)).clamp(0.0, 1.0),
            Some((End::Crest, half)) => (0.5 + (place - length) / (2.0 * half)).clamp(0.0, 1.0),
        };
    }

    /// The vector impulse of the step on the material, N s.
    pub fn vector_impulse(&self) -> [f64; 2] {
        let [n, t] = self.impulse;
        plus(scaled(self.normal, n), scaled(clockwise(self.normal), t))
    }

    /// Velocity at the crossing, of these of the nodes.
    fn velocity(&self, of: impl Fn(usize) -> [f64; 2]) -> [f64; 2] {
        let [a, b] = self.shares[0];
        let [i, j, ..] = self.nodes.map(|n| n as usize);
        plus(scaled(of(i), a), scaled(of(j), b))
    }

    /// Speed at which the material passes into the boundary on the next line beyond the end of the wall, m/s, as far as it may pass
    /// here: by the share of the line that is free, and less where there is less than half as much material.
    fn passing(&self, nodes: &[SiteNode]) -> f64 {
        if self.open <= 0.0 {
            return 0.0;
        }
        let [[a, b], [c, d]] = self.shares;
        let [i, j, k, l] = self.nodes.map(|n| n as usize);
        let here = a * nodes[i].mass + b * nodes[j].mass;
        let there = c * nodes[k].mass + d * nodes[l].mass;
        let v = plus(scaled(nodes[k].v, c), scaled(nodes[l].v, d));
        (-dot(v, self.normal)).max(0.0) * self.open * (2.0 * there / here).min(1.0)
    }

    /// One over the mass that an impulse moves, 1/kg; `None` where a node has none.
    fn mobility(&self, nodes: &[SiteNode]) -> Option<f64> {
        let share = |k: usize| {
            let w = self.shares[0][k];
            if w == 0.0 { 0.0 } else { w * w / nodes[self.nodes[k] as usize].mass }
        };
        let sum = share(0) + share(1);
        (sum.is_finite() && sum > 0.0).then_some(sum)
    }

    /// Gives an impulse to the nodes.
    fn give(&self, impulse: [f64; 2], nodes: &mut [SiteNode]) {
        for (&k, w) in self.nodes.iter().zip(self.shares[0]).filter(|(_, w)| *w != 0.0) {
            let node = &mut nodes[k as usize];
            node.v = plus(node.v, scaled(impulse, w / node.mass));
        }
    }

    /// One Gauss-Seidel visit: brings the impulses up to date with the velocities of the nodes of its group, and these with them.
    pub fn relax(&mut self, nodes: &mut [SiteNode], with_friction: bool) {
        let shut = self.open < 1.0 && self.free.is_finite();
        let Some(mobility) = self.mobility(nodes).filter(|_| shut) else {
            self.state = HoldState::Apart;
            return;
        };
        let (n, t) = (self.normal, clockwise(self.normal));
        let rel = self.velocity(|k| nodes[k].v);
        let approach = dot(rel, n) + self.free + self.passing(nodes);
        let normal = (self.impulse[0] - approach / mobility).max(0.0);
        let stick = self.impulse[1] - dot(rel, t) / mobility;
        // 0 x infinity must not arise.
        let limit = if normal > 0.0 && with_friction { self.friction * normal } else { 0.0 };
        let tangential = match &self.slip {
            Some(slip) if with_friction => slip.impulse(normal, stick, mobility),
            _ => stick.clamp(-limit, limit),
        };
        self.state = match () {
            () if normal <= 0.0 => HoldState::Apart,
            // On elastic slip nothing stands still.
            () if self.slip.is_some() => HoldState::Slipping,
            () if limit > 0.0 && stick.abs() <= limit => HoldState::Sticking,
            () => HoldState::Slipping,
        };
        let change = plus(scaled(n, normal - self.impulse[0]), scaled(t, tangential - self.impulse[1]));
        self.impulse = [normal, tangential];
        self.give(change, nodes);
    }

    /// What the site did, given the nodes of its group after the step.
    pub fn tally(&self, nodes: &[SiteNode]) -> Option<Tally> {
        if self.state == HoldState::Apart {
            return None;
        }
        let [n, t] = self.impulse;
        let mean = self.velocity(|k| mean(nodes[k].old, nodes[k].v));
        let impulse = self.vector_impulse();
        Some(Tally {
            impulse,
            moment: moment(self.arm, impulse),
            friction_work: t * dot(mean, clockwise(self.normal)),
            normal_work: n * dot(mean, self.normal),
        })
    }

    /// Applies to velocities that only strain the material what the step decided: what is held does not move along the normal, and
    /// what sticks does not move. Returns what it takes of the velocities of its two nodes, m/s.
    pub fn project(&self, nodes: &mut [SiteNode]) -> [[f64; 2]; 2] {
        let Some(mobility) = self.mobility(nodes) else { return [[0.0; 2]; 2] };
        let v = self.velocity(|k| nodes[k].v);
        let free = self.free + self.passing(nodes);
        let stop = match self.state {
            HoldState::Apart => return [[0.0; 2]; 2],
            HoldState::Sticking => plus(v, scaled(self.normal, free)),
            HoldState::Slipping => scaled(self.normal, dot(v, self.normal) + free),
        };
        self.give(scaled(stop, -1.0 / mobility), nodes);
        [0, 1].map(|k| match self.shares[0][k] {
            0.0 => [0.0; 2],
            w => scaled(stop, w / (mobility * nodes[self.nodes[k] as usize].mass)),
        })
    }

    /// Works that [`Self::tally`] lacks where the points' new momentum, mapped back, gives the nodes of the group the velocities
    /// `remapped` (m/s) instead of those that the balance found; along the normal and along the face, J. See
    /// [`super::nodes::Remapped`].
    pub fn remapped_work(&self, balance: impl Fn(usize) -> [f64; 2], remapped: impl Fn(usize) -> [f64; 2]) -> [f64; 2] {
        if self.state == HoldState::Apart {
            return [0.0; 2];
        }
        let half =
            self.velocity(|k| scaled(minus(remapped(k), balance(k)), seeded::times(Seed::BoundarySurfaceWork, 0.5)));
        work_along(self.normal, self.vector_impulse(), half)
    }

    /// Work along the normal and along the face of the internal forces of its two nodes (impulses, N s) by what [`Self::project`] has
    /// taken, J.
    pub fn taken_work(&self, internal: impl Fn(usize) -> [f64; 2], taken: [[f64; 2]; 2]) -> [f64; 2] {
        let [a, b] = [0, 1].map(|k| work_along(self.normal, internal(self.nodes[k] as usize), taken[k]));
        plus(a, b)
    }
}

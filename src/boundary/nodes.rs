//! The contact law at a node.
//!
//! A boundary answers the motion that a node would have without it. One impulse, along its normal, stops approach and never holds back (but
//! for a clamp). The other, along its face, stops sliding, and is limited by the friction coefficient times the normal impulse. A node held
//! by several boundaries finds all impulses together by projected Gauss-Seidel iteration (Jean 1999), so that a corner is no special case.
//!
//! Elsewhere: unilateral (Signorini) contact with Coulomb friction as a complementarity problem, in impulses. There is
//! no warm start: impulses begin at zero in each step.

use super::{Boundary, Contact, Friction};
use crate::seeded::{self, Seed};
use crate::space::{clockwise, dot, mean, minus, moment, plus, scaled};

/// Most iterations for a node held by more than one boundary; perpendicular faces need two.
const SWEEPS: usize = 24;

/// What a boundary does to one node.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hold {
    /// Index of the node.
    pub node: u32,
    /// Index of the boundary.
    pub boundary: u32,
    /// Unit normal, into the material.
    pub normal: [f64; 2],
    /// Position along the face, m.
    pub along: f64,
    /// Lever arm from the boundary's foot, m.
    pub arm: [f64; 2],
    /// Friction coefficient.
    friction: f64,
    /// Whether the node cannot separate.
    bonded: bool,
    /// Whether velocities that strain the material are held both ways while the boundary presses on the node.
    both_ways: bool,
    /// How far above the lower edge of a gate that opens it must lie to be held, m.
    clear: f64,
    /// Velocity of the boundary, m/s.
    wall: [f64; 2],
    /// Normal and tangential impulse of the step, N s.
    impulse: [f64; 2],
    /// How the node moved in the last step.
    state: HoldState,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum HoldState {
    Apart,
    Slipping,
    Sticking,
}

/// The coefficient of friction at a node.
fn coefficient(friction: Friction) -> f64 {
    seeded::times(Seed::BoundaryNodeFriction, friction.coefficient())
}

impl Hold {
    /// The same at so many metres above the lower edge of a gate and more.
    pub(super) fn clear_of_edge(self, clear: f64) -> Self {
        Self { clear, ..self }
    }

    /// The same with another normal.
    pub(super) fn toward(self, normal: [f64; 2]) -> Self {
        Self { normal, ..self }
    }

    /// The same with another friction.
    pub(super) fn rubbing(self, friction: Friction) -> Self {
        Self { friction: coefficient(friction), ..self }
    }

    /// There is nothing at the node in this step.
    pub fn let_go(&mut self) {
        (self.impulse, self.state) = ([0.0; 2], HoldState::Apart);
    }
}

/// What a boundary received from, or did to, the material in one step.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Tally {
    /// Impulse on the material, N s.
    pub impulse: [f64; 2],
    /// Moment of that impulse about the boundary's foot, counter-clockwise, N m s.
    pub moment: f64,
    /// Work of the friction impulses on the material, J (negative when it dissipates).
    pub friction_work: f64,
    /// Work of the normal impulses on the material, J.
    pub normal_work: f64,
}

impl Tally {
    /// Adds another tally.
    pub fn add(&mut self, other: &Tally) {
        self.impulse = plus(self.impulse, other.impulse);
        self.moment += other.moment;
        self.friction_work += other.friction_work;
        self.normal_work += other.normal_work;
    }
}

impl Hold {
    /// A boundary that holds the node with this index in the grid, at `x` (m).
    pub(super) fn new(
        node: usize,
        x: [f64; 2],
        index: usize,
        boundary: &Boundary,
        contact: Contact,
        both_ways: bool,
    ) -> Self {
        Self {
            node: node as u32,
            boundary: index as u32,
            normal: contact.normal,
            along: contact.along,
            arm: minus(x, boundary.foot().into()),
            friction: coefficient(boundary.friction),
            bonded: boundary.friction == Friction::Bonded,
            both_ways,
            clear: 0.0,
            wall: boundary.velocity.into(),
            impulse: [0.0; 2],
            state: HoldState::Slipping,
        }
    }
}

impl Hold {
    /// The velocity that the boundary prescribes, if it is a clamp that is closed, m/s.
    pub fn clamped(&self, boundaries: &[Boundary]) -> Option<[f64; 2]> {
        (self.bonded && self.is_active(boundaries)).then_some(self.wall)
    }

    /// The vector impulse of the step on the material, N s.
    pub fn vector_impulse(&self) -> [f64; 2] {
        let [n, t] = self.impulse;
        plus(scaled(self.normal, n), scaled(clockwise(self.normal), t))
    }

    /// One Gauss-Seidel visit to the normal impulse alone.
    fn relax_normal(&mut self, m: f64, v: &mut [f64; 2]) {
        let friction = std::mem::replace(&mut self.friction, 0.0);
        self.relax(m, v);
        self.friction = friction;
    }

    /// One Gauss-Seidel visit: brings the accumulated impulses up to date with velocity `v` of a node of mass `m`.
    #[inline]
    fn relax(&mut self, m: f64, v: &mut [f64; 2]) {
        let (n, t) = (self.normal, clockwise(self.normal));
        let rel = minus(*v, self.wall);
        let approach = dot(rel, n);
        let stop = self.impulse[0] - m * approach;
        let normal = if self.bonded { stop } else { stop.max(0.0) };
        let change = (normal - self.impulse[0]) / m;
        self.impulse[0] = normal;
        let sliding = dot(rel, t);
        let stick = self.impulse[1] - m * sliding;
        // Smooth boundaries and open contacts have no friction; 0 x infinity must not arise.
        let limit = match () {
            () if self.bonded => f64::INFINITY,
            () if normal > 0.0 => self.friction * normal,
            () => 0.0,
        };
        let tangential = stick.clamp(-limit, limit);
        self.state = match () {
            () if normal <= 0.0 && !self.bonded => HoldState::Apart,
            () if limit > 0.0 && stick.abs() <= limit => HoldState::Sticking,
            () => HoldState::Slipping,
        };
        let shift = (tangential - self.impulse[1]) / m;
        self.impulse[1] = tangential;
        *v = plus(*v, plus(scaled(n, change), scaled(t, shift)));
    }

    fn tally(&self, mean: [f64; 2]) -> Tally {
        let [n, t] = self.impulse;
        let impulse = self.vector_impulse();
        Tally {
            impulse,
            moment: moment(self.arm, impulse),
            friction_work: seeded::times(Seed::BoundaryNodeWork, t * dot(mean, clockwise(self.normal))),
            normal_work: n * dot(mean, self.normal),
        }
    }
}

/// Solves the contact of one node of mass `m` with all that holds it: `old` is the velocity before the step, `v` the
/// velocity it would have, which is replaced. Adds to the tally of each boundary.
///
/// Work is impulse times the mean of the velocities before and after the step, so that the works of all agents add up
/// to the change of the node's kinetic energy exactly.
pub fn solve(
    holds: &mut [Hold],
    boundaries: &[Boundary],
    m: f64,
    old: [f64; 2],
    v: &mut [f64; 2],
    tallies: &mut [Tally],
) {
    reset(holds);
    if holds.len() > 1 {
        // In a corner, what one boundary takes as normal force another could take as friction. Friction resists sliding only:
        // the normal impulses come first, and friction finds what sliding they leave.
        visit(holds, boundaries, m, v, false);
    }
    visit(holds, boundaries, m, v, true);
    book(holds, mean(old, *v), tallies);
}

/// Forgets the impulses of a node's holds.
pub fn reset(holds: &mut [Hold]) {
    for hold in holds.iter_mut() {
        hold.impulse = [0.0; 2];
    }
}

/// Brings the impulses of all holds of a node of mass `m` up to date with its velocity `v`, and the velocity with them;
/// without friction, or with it.
pub fn visit(holds: &mut [Hold], boundaries: &[Boundary], m: f64, v: &mut [f64; 2], with_friction: bool) {
    for _ in 0..if holds.len() > 1 { SWEEPS } else { 1 } {
        let mut changed = false;
        for hold in holds.iter_mut() {
            let before = [*v, hold.impulse].map(|p| p.map(f64::to_bits));
            match hold.is_active(boundaries) {
                true if with_friction => hold.relax(m, v),
                true => hold.relax_normal(m, v),
                false => hold.state = HoldState::Apart,
            }
            changed |= before != [*v, hold.impulse].map(|p| p.map(f64::to_bits));
        }
        // Further sweeps would not change a bit.
        if !changed {
            break;
        }
    }
}

/// Adds what the holds of a node did in the step to the tallies of their boundaries; `mean` is the mean of the node's
/// velocities before and after.
pub fn book(holds: &[Hold], mean: [f64; 2], tallies: &mut [Tally]) {
    for hold in holds.iter() {
        if hold.state != HoldState::Apart {
            tallies[hold.boundary as usize].add(&hold.tally(mean));
        }
    }
}

/// Applies to a velocity what [`solve`] decided: nothing presses inwards, sticking nodes move with the boundary. For
/// velocity fields that only strain the material, so no impulse is counted; `taken` is told what each boundary takes, m/s.
pub fn project(holds: &[Hold], v: &mut [f64; 2], mut taken: impl FnMut(&Hold, [f64; 2])) {
    let sweeps = if holds.len() > 1 { 4 } else { 1 };
    for _ in 0..sweeps {
        for hold in holds {
            let approach = dot(minus(*v, hold.wall), hold.normal);
            let stop = match hold.state {
                HoldState::Apart => continue,
                HoldState::Sticking => {
                    taken(hold, minus(*v, hold.wall));
                    *v = hold.wall;
                    continue;
                }
                HoldState::Slipping => {
                    if hold.both_ways {
                        approach
                    } else {
                        approach.min(0.0)
                    }
                }
            };
            let stop = scaled(hold.normal, stop);
            taken(hold, stop);
            *v = minus(*v, stop);
        }
    }
}

/// Books what boundaries do to a node between the velocity that the balance found and the one that strains the material (MUSL).
///
/// The kinetic energy of the points changes by impulse times the mean of the node's velocity before the step and that of their new
/// momentum, mapped back, where [`solve`] took the new velocity of the balance. And of what the internal force does by that velocity,
/// the material stores or dissipates only what is left of it after [`project`]: the rest is taken at the boundary.
#[derive(Debug, Clone, Copy)]
pub struct Remapped {
    /// Velocity that the balance found, m/s.
    pub balance: [f64; 2],
    /// Velocity of the points' new momentum, m/s.
    pub v: [f64; 2],
    /// Impulse of the internal force in the step, N s.
    pub internal: [f64; 2],
}

impl Remapped {
    /// Projects the velocity, which is returned, and adds to the tallies of the boundaries that act on their surface.
    pub fn project(self, holds: &[Hold], tallies: &mut [Tally]) -> [f64; 2] {
        let half = scaled(minus(self.v, self.balance), 0.5);
        for hold in holds.iter().filter(|h| h.both_ways && h.state != HoldState::Apart) {
            let more = hold.tally(half);
            let tally = &mut tallies[hold.boundary as usize];
            tally.friction_work += more.friction_work;
            tally.normal_work += more.normal_work;
        }
        let mut v = self.v;
        project(holds, &mut v, |hold, taken| {
            if hold.both_ways {
                let [normal, friction] = work_along(hold.normal, self.internal, taken);
                let tally = &mut tallies[hold.boundary as usize];
                tally.normal_work += normal;
                tally.friction_work += friction;
            }
        });
        v
    }
}

/// Work of an impulse by a velocity, along a normal and along its face, J.
pub(super) fn work_along(normal: [f64; 2], impulse: [f64; 2], v: [f64; 2]) -> [f64; 2] {
    let face = clockwise(normal);
    [dot(impulse, normal) * dot(v, normal), dot(impulse, face) * dot(v, face)]
}

impl Hold {
    /// A gate holds only the nodes above its lower edge.
    #[inline]
    fn is_active(&self, boundaries: &[Boundary]) -> bool {
        let free = boundaries[self.boundary as usize].free_below;
        free <= 0.0 || self.along >= free + self.clear
    }
}

#[cfg(test)]
#[path = "nodes_tests.rs"]
mod tests;

#[cfg(test)]
#[path = "holds_tests.rs"]
mod holds_tests;

//! Two bodies at a node: the impulse between them, by Signorini's and Coulomb's conditions.
//!
//! Elsewhere: complementarity conditions of unilateral contact; stick and slip as a return to the friction cone.

use super::Vector;
use super::side::Side;
use crate::seeded::{self, Seed};
use crate::space::{clockwise, dot, minus, plus, scaled};

/// How two bodies move at a node.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum State {
    /// They part, or do not touch.
    #[default]
    Apart,
    /// They slide on each other.
    Slipping,
    /// They move together.
    Sticking,
}

/// Two bodies that may touch at a node.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Touch {
    /// Which two of the node's sides.
    pub sides: [usize; 2],
    /// Unit normal of the surface between them, out of the first body.
    pub normal: Vector,
    /// Friction coefficient, not negative; infinite where nothing slides.
    pub friction: f64,
    /// Speed of approach that is free because it only closes the gap in this step, m/s; 0 for bodies that touch.
    pub slack: f64,
    /// Impulse on the second body along the normal and along the normal turned clockwise, N s.
    impulse: Vector,
    state: State,
}

/// What two bodies did to each other.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Exchange {
    /// Impulse on the second body, N s; the first has received its opposite.
    pub impulse: Vector,
    /// Work of the friction impulses on both bodies, J; negative when it dissipates.
    pub friction_work: f64,
    /// Work of the normal impulses on both bodies, J; what an inelastic impact takes is negative.
    pub normal_work: f64,
}

impl Exchange {
    /// Adds another exchange.
    pub fn add(&mut self, other: &Exchange) {
        self.impulse = plus(self.impulse, other.impulse);
        self.friction_work += other.friction_work;
        self.normal_work += other.normal_work;
    }
}

impl Touch {
    /// Two bodies whose surfaces touch.
    pub fn new(sides: [usize; 2], normal: Vector, friction: f64) -> Self {
        let friction = seeded::times(Seed::ContactFriction, friction);
        Self { sides, normal, friction, slack: 0.0, impulse: [0.0; 2], state: State::Apart }
    }

    /// The same with a speed of approach (m/s) that is free.
    pub fn with_slack(self, slack: f64) -> Self {
        Self { slack, ..self }
    }

    /// How the bodies moved in the last solution.
    pub fn state(&self) -> State {
        self.state
    }

    /// Impulse on the second body, N s.
    pub fn vector_impulse(&self) -> Vector {
        let [n, t] = self.impulse;
        plus(scaled(self.normal, n), scaled(clockwise(self.normal), t))
    }

    /// Impulse and works of the last solution.
    pub fn exchange(&self, sides: &[Side]) -> Exchange {
        let [a, b] = self.sides;
        let [n, t] = self.impulse;
        let relative = minus(sides[b].mean(), sides[a].mean());
        Exchange {
            impulse: self.vector_impulse(),
            friction_work: seeded::times(Seed::ContactWork, t * dot(relative, clockwise(self.normal))),
            normal_work: n * dot(relative, self.normal),
        }
    }

    /// Forgets the impulses.
    pub(super) fn reset(&mut self) {
        self.impulse = [0.0; 2];
        self.state = State::Apart;
    }

    /// One Gauss-Seidel visit with the given friction coefficient.
    #[inline]
    pub(super) fn relax(&mut self, sides: &mut [Side], friction: f64) {
        let [a, b] = self.sides;
        let (n, t) = (self.normal, clockwise(self.normal));
        let (to_a, to_b) = (sides[a].mobility(), sides[b].mobility());
        let mobility = to_a + to_b;
        if mobility <= 0.0 {
            return;
        }
        let relative = minus(sides[a].velocity, sides[b].velocity);
        let approach = dot(relative, n) - self.slack;
        let normal = (self.impulse[0] + approach / mobility).max(0.0);
        let sliding = dot(relative, t);
        let stick = self.impulse[1] + sliding / mobility;
        // Without pressure there is no friction; 0 x infinity must not arise.
        let limit = if normal > 0.0 { friction * normal } else { 0.0 };
        let tangential = stick.clamp(-limit, limit);
        self.state = match () {
            () if normal <= 0.0 => State::Apart,
            () if limit > 0.0 && stick.abs() <= limit => State::Sticking,
            () => State::Slipping,
        };
        let (dn, dt) = (normal - self.impulse[0], tangential - self.impulse[1]);
        self.impulse = [normal, tangential];
        let change = plus(scaled(n, dn), scaled(t, dt));
        sides[a].velocity = minus(sides[a].velocity, scaled(change, to_a));
        sides[b].velocity = plus(sides[b].velocity, scaled(change, to_b));
    }
}

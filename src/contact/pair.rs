//! Two bodies at a node: the impulse between them, by Signorini's and Coulomb's conditions.

use super::node::Side;
use super::{Vector, minus};

/// Least share of the free response that a pair held by boundaries can have.
const LEAST_RESPONSE: f64 = 1e-9;

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
    /// Relative velocity per impulse, along the normal and along the surface, 1/kg.
    response: Vector,
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
        self.impulse[0] += other.impulse[0];
        self.impulse[1] += other.impulse[1];
        self.friction_work += other.friction_work;
        self.normal_work += other.normal_work;
    }
}

impl Touch {
    /// Two bodies whose surfaces touch.
    pub fn new(sides: [usize; 2], normal: Vector, friction: f64) -> Self {
        Self { sides, normal, friction, slack: 0.0, impulse: [0.0; 2], state: State::Apart, response: [0.0; 2] }
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
        let ([nx, ny], [n, t]) = (self.normal, self.impulse);
        [nx * n + ny * t, ny * n - nx * t]
    }

    /// Impulse and works of the last solution.
    pub fn exchange(&self, sides: &[Side]) -> Exchange {
        let [a, b] = self.sides;
        let ([nx, ny], [n, t]) = (self.normal, self.impulse);
        let relative = minus(sides[b].mean(), sides[a].mean());
        Exchange {
            impulse: self.vector_impulse(),
            friction_work: t * (relative[0] * ny - relative[1] * nx),
            normal_work: n * (relative[0] * nx + relative[1] * ny),
        }
    }

    /// Forgets the impulses and counts the two bodies as free.
    pub(super) fn reset(&mut self, sides: &[Side]) {
        let [a, b] = self.sides;
        self.impulse = [0.0; 2];
        self.state = State::Apart;
        self.response = [sides[a].mobility() + sides[b].mobility(); 2];
    }

    /// Speeds of approach and of sliding, m/s.
    #[inline(always)]
    pub(super) fn motion(&self, sides: &[Side]) -> Vector {
        let [a, b] = self.sides;
        let [nx, ny] = self.normal;
        let relative = minus(sides[a].velocity, sides[b].velocity);
        [relative[0] * nx + relative[1] * ny - self.slack, relative[0] * ny - relative[1] * nx]
    }

    /// One Gauss-Seidel visit with the given friction coefficient: the change of the impulses, N s.
    #[inline]
    pub(super) fn relax(&mut self, sides: &mut [Side], friction: f64) -> Vector {
        let [a, b] = self.sides;
        let [nx, ny] = self.normal;
        let (to_a, to_b) = (sides[a].mobility(), sides[b].mobility());
        if to_a + to_b <= 0.0 {
            return [0.0; 2];
        }
        let [approach, sliding] = self.motion(sides);
        let normal = (self.impulse[0] + approach / self.response[0]).max(0.0);
        let stick = self.impulse[1] + sliding / self.response[1];
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
        let change = [dn * nx + dt * ny, dn * ny - dt * nx];
        for (d, p) in change.into_iter().enumerate() {
            sides[a].velocity[d] -= to_a * p;
            sides[b].velocity[d] += to_b * p;
        }
        [dn, dt]
    }

    /// Learns from what became of a visit how much the bodies give way where boundaries hold them: at most as free bodies.
    pub(super) fn learn(&mut self, sides: &[Side], before: Vector, change: Vector) {
        let [a, b] = self.sides;
        let free = sides[a].mobility() + sides[b].mobility();
        let after = self.motion(sides);
        for d in 0..2 {
            let response = (before[d] - after[d]) / change[d];
            if response.is_finite() {
                self.response[d] = response.clamp(LEAST_RESPONSE * free, free);
            }
        }
    }
}

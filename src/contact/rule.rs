//! What a user chooses about the contact of two bodies.
//!
//! Elsewhere: a contact pair with its interface law. The structure is the master, the other body the slave.

use super::Vector;
use super::pair::Exchange;
use super::separation::TOUCHING;
use super::side::Side;
use crate::seeded::{self, Seed};
use crate::space::moment;

/// How the normal between two bodies is found at a node.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum NormalRule {
    /// From the volume gradient of the body that has more volume at the node.
    LargerBody,
    /// From the difference of both volume gradients.
    Average,
    /// By logistic regression between the points of both.
    Regression,
    /// From the faces of one of the two bodies (0 or 1), a structure, that are nearest to the points of the other.
    NearestFace(usize),
    /// Given: unit normal out of the first body.
    Prescribed(Vector),
}

/// How it is decided whether two bodies touch.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum GapRule {
    /// They touch where both reach a node and approach: up to a cell too early.
    Approach,
    /// From mean positions at the node, which are `offset` cells apart when bodies touch.
    Positions {
        /// Cells, see `TOUCHING`.
        offset: f64,
    },
    /// From mean displacements since the start, for bodies that touch then.
    Displacements,
    /// From the points nearest to the surface and their size; an approach that only closes the gap is free.
    Extents,
}

impl GapRule {
    /// From mean positions with the usual offset.
    pub const POSITIONS: GapRule = GapRule::Positions { offset: TOUCHING };
}

/// The contact of two bodies. Bodies that are named in a rule have a velocity field each; all others share one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ContactRule {
    /// Indices of the two bodies.
    pub bodies: [usize; 2],
    /// Coulomb's friction coefficient; infinite where nothing slides.
    pub friction: f64,
    /// How the normal is found.
    pub normal: NormalRule,
    /// How it is decided whether they touch.
    pub gap: GapRule,
}

impl ContactRule {
    /// A rule with what has verified best where one body is a structure that the other flows against.
    pub fn with_structure(structure: usize, other: usize, friction: f64) -> Self {
        Self { bodies: [structure, other], friction, normal: NormalRule::NearestFace(0), gap: GapRule::Extents }
    }
}

/// What two bodies did to each other in a step.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct ContactTally {
    /// Impulse on the second body, and works.
    pub exchange: Exchange,
    /// Moment of the impulse on the second body about the origin, counter-clockwise, N m s.
    pub moment: f64,
    /// Nodes at which they touch.
    pub nodes: u32,
}

impl ContactTally {
    /// Adds the exchange at a node at `x` (m).
    pub fn add(&mut self, exchange: &Exchange, x: Vector) {
        self.exchange.add(exchange);
        self.moment += seeded::times(Seed::ContactMoment, moment(x, exchange.impulse));
        self.nodes += 1;
    }

    /// Adds another tally.
    pub fn merge(&mut self, other: &ContactTally) {
        self.exchange.add(&other.exchange);
        self.moment += other.moment;
        self.nodes += other.nodes;
    }
}

/// Most bodies that contact can bring together at a node.
pub const MAX_SIDES: usize = 8;

/// Room for the bodies of a node.
pub type Sides = [Side; MAX_SIDES];

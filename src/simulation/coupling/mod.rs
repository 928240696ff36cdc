//! Contact between velocity fields: finds the nodes that several fields reach, the surfaces between their bodies, and lets them
//! exchange impulses after the momentum balance (Ng et al., Appendix B).
//!
//! Nodes are worked one after the other in the order of the first field, so results do not depend on the number of threads.
//!
//! Elsewhere: contact search, and coupling of velocity fields at shared nodes.

mod exchange;
mod faces;
mod scan;
mod surface;

use super::field::VelocityField;
use crate::boundary::nodes::Hold;
use crate::contact::Vector;
use crate::contact::pair::Touch;
use crate::contact::rule::{ContactRule, ContactTally, MAX_SIDES};
use crate::space::{clockwise, dot};
use std::ops::Range;
use surface::Interface;

/// A node that more than one field reaches.
#[derive(Debug, Clone)]
struct SharedNode {
    /// Position, m.
    x: Vector,
    /// Its fields, among all sides.
    sides: Range<usize>,
}

/// A field at a shared node: where to find it there.
#[derive(Debug, Clone)]
struct SharedSide {
    field: usize,
    band: usize,
    /// Counted from the band's first node.
    node: usize,
    /// Place among the band's open nodes.
    index: usize,
    /// Among the band's holds.
    holds: Range<usize>,
}

/// Two sides of a node that touch in this step.
#[derive(Debug, Clone, Copy)]
struct Pending {
    node: u32,
    contact: u32,
    sides: [u8; 2],
    normal: Vector,
    slack: f64,
}

/// A node that was solved with touching bodies, for the velocities that follow.
#[derive(Debug, Clone)]
struct Solved {
    node: usize,
    touches: Range<usize>,
    /// For each side of the node: its mass, 0 where it has none, and whether it is clamped.
    masses: [f64; MAX_SIDES],
    clamped: [bool; MAX_SIDES],
}

/// What one pair of bodies did at one node in the last step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ContactPoint {
    /// Index of the rule.
    pub contact: usize,
    /// Position of the node, m.
    pub x: Vector,
    /// Unit normal out of the first body.
    pub normal: Vector,
    /// Impulse on the second body, N s.
    pub impulse: Vector,
    /// Area of contact that belongs to the node, m2, see `separation::area`: the volumes there
    /// are masses over densities in the reference state.
    pub area: f64,
}

impl ContactPoint {
    /// Mean traction between the bodies over a step of `dt` (s), Pa: pressure, positive where they press on each other, and shear on the
    /// second body along the normal turned clockwise. Zero where no area belongs to the node.
    pub fn traction(&self, dt: f64) -> [f64; 2] {
        let per = if self.area > 0.0 { 1.0 / (self.area * dt) } else { 0.0 };
        [dot(self.impulse, self.normal) * per, dot(self.impulse, clockwise(self.normal)) * per]
    }
}

/// All contacts of a simulation.
#[derive(Debug, Clone, Default)]
pub(super) struct Coupling {
    interfaces: Vec<Interface>,
    nodes: Vec<SharedNode>,
    sides: Vec<SharedSide>,
    pending: Vec<Pending>,
    touches: Vec<Touch>,
    solved: Vec<Solved>,
    holds: Vec<Hold>,
    points: Vec<ContactPoint>,
}

impl Coupling {
    /// Contacts by `rules` between fields that each hold one body.
    pub fn new(rules: &[ContactRule], fields: &[VelocityField]) -> Self {
        let interfaces = rules.iter().enumerate().map(|(k, rule)| Interface::new(k, *rule, fields)).collect();
        Self { interfaces, ..Self::default() }
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.interfaces.is_empty()
    }

    /// The rules.
    pub fn rules(&self) -> impl Iterator<Item = &ContactRule> {
        self.interfaces.iter().map(|i| &i.rule)
    }

    /// What the two bodies of each rule did to each other in the last step.
    pub fn tallies(&self) -> impl Iterator<Item = &ContactTally> {
        self.interfaces.iter().map(|i| &i.tally)
    }

    /// Where bodies touched in the last step.
    pub fn points(&self) -> &[ContactPoint] {
        &self.points
    }

    /// Changes the friction coefficient of a rule.
    pub fn set_friction(&mut self, contact: usize, friction: f64) {
        self.interfaces[contact].set_friction(friction);
    }

    /// Follows a new layout of the fields, and tells their bands which nodes to leave open: those that several fields reach.
    pub fn list(&mut self, fields: &mut [VelocityField]) {
        self.solved.clear();
        self.pending.clear();
        self.touches.clear();
        self.points.clear();
        self.holds.clear();
        self.nodes.clear();
        self.sides.clear();
        if !self.is_empty() {
            self.find_shared(fields);
        }
    }

    /// Finds these nodes among those that the bands leave open, once these are sorted.
    pub fn find(&mut self, fields: &[VelocityField]) {
        for side in &mut self.sides {
            let shared = &fields[side.field].bands[side.band].shared;
            side.index = shared.partition_point(|&n| (n as usize) < side.node);
        }
        for interface in &mut self.interfaces {
            interface.rebuild(fields, &self.nodes, &self.sides);
        }
        let pairs = self.interfaces.iter().map(Interface::len).sum();
        let holds = self.nodes.iter().map(|n| self.sides[n.sides.clone()].iter().map(|s| s.holds.len()).sum());
        self.holds.reserve(holds.max().unwrap_or(0));
        self.pending.reserve(pairs);
        self.touches.reserve(pairs);
        self.points.reserve(pairs);
        self.solved.reserve(self.nodes.len());
    }

    /// Lists the nodes that several fields reach.
    fn find_shared(&mut self, fields: &mut [VelocityField]) {
        for (f, field) in fields.iter().enumerate() {
            for (index, x) in field.grid.nodes() {
                let at = field.grid.place(index);
                if fields[..f].iter().any(|g| g.grid.find(at).is_some()) {
                    continue;
                }
                let first = self.sides.len();
                let others = fields.iter().enumerate().skip(f).filter_map(|(g, o)| Some((g, o.grid.find(at)?)));
                for (g, node) in others.take(MAX_SIDES) {
                    let bands = &fields[g].bands;
                    let band = bands.partition_point(|b| b.first_node <= node) - 1;
                    let held = &bands[band].holds;
                    let holds = held.partition_point(|h| (h.node as usize) < node)
                        ..held.partition_point(|h| h.node as usize <= node);
                    let node = node - bands[band].first_node;
                    self.sides.push(SharedSide { field: g, band, node, index: 0, holds });
                }
                if self.sides.len() - first > 1 {
                    self.nodes.push(SharedNode { x, sides: first..self.sides.len() });
                } else {
                    self.sides.truncate(first);
                }
            }
        }
        for side in &self.sides {
            fields[side.field].bands[side.band].shared.push(side.node as u32);
        }
    }
}

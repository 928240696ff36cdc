//! Bodies that move by themselves while all others are swept, and meet them at shared nodes: in implicit steps, or by the nodes of their mesh.

use super::field::VelocityField;
use super::implicit::{self, ImplicitBody, PASSES, SETTLED, Turn};
use super::lagrangian::{self, Acting, LagrangianBody};
use crate::boundary::Boundary;
use crate::shape::ShapeFunction;

/// One of them.
#[derive(Debug, Clone)]
pub(super) enum Structure {
    /// In implicit steps.
    Implicit(Box<ImplicitBody>),
    /// In total-Lagrangian kinematics.
    Lagrangian(Box<LagrangianBody>),
}

/// The same of either.
macro_rules! either {
    ($structure:expr, $body:ident => $value:expr) => {
        match $structure {
            Structure::Implicit($body) => $value,
            Structure::Lagrangian($body) => $value,
        }
    };
}

/// Those among the bodies of `fields`.
pub(super) fn of(fields: &[VelocityField], boundaries: &[Boundary]) -> Vec<Structure> {
    let implicit = implicit::bodies(fields).into_iter().map(|b| Structure::Implicit(Box::new(b)));
    let lagrangian = lagrangian::bodies(fields, boundaries).into_iter().map(|b| Structure::Lagrangian(Box::new(b)));
    implicit.chain(lagrangian).collect()
}

impl Structure {
    /// Its velocity field.
    pub fn field(&self) -> usize {
        either!(self, b => b.field)
    }

    /// Takes that field out of all, or gives it back.
    pub fn swap(&mut self, fields: &mut [VelocityField]) {
        either!(self, b => std::mem::swap(&mut b.own, &mut fields[b.field]))
    }

    /// Whether its steps are implicit, so that a step of another length costs it a factorisation.
    pub fn is_implicit(&self) -> bool {
        match self {
            Structure::Implicit(_) => true,
            Structure::Lagrangian(body) => body.is_implicit(),
        }
    }

    /// The body, if it is one in total-Lagrangian kinematics.
    pub fn lagrangian(&self) -> Option<&LagrangianBody> {
        match self {
            Structure::Implicit(_) => None,
            Structure::Lagrangian(body) => Some(body),
        }
    }

    /// Does one or the other on its own field.
    pub fn take_turn(&mut self, turn: Turn, acting: &Acting) {
        match (self, turn) {
            (Structure::Implicit(b), turn) => b.take_turn(turn, acting.boundaries, acting.forces, acting.dt),
            (Structure::Lagrangian(b), Turn::Predict) => b.predict(acting),
            (Structure::Lagrangian(b), Turn::Finish) => b.finish(acting),
        }
    }

    /// Follows a sort of its field.
    pub fn rebuild(&mut self, field: &VelocityField, shape: ShapeFunction) {
        match self {
            Structure::Implicit(b) => b.rebuild(b.field, field, shape),
            Structure::Lagrangian(b) => b.rebuild(field),
        }
    }

    /// Follows a new list of shared nodes.
    pub fn follow(&mut self, field: &VelocityField) {
        either!(self, b => b.follow(field))
    }

    /// Where a shared node is kept.
    pub fn slot(&self, band: usize, index: usize) -> usize {
        either!(self, b => b.slot(band, index))
    }

    /// Notes that a shared node, where the body has mass, is touched in this step.
    pub fn touch(&mut self, slot: usize) {
        either!(self, b => b.touch(slot))
    }

    /// Whether it is.
    pub fn is_touched(&self, slot: usize) -> bool {
        either!(self, b => b.is_touched(slot))
    }

    /// Mass of its points at a shared node, kg: another is offered to contact.
    pub fn mass_at(&self, slot: usize) -> Option<f64> {
        match self {
            Structure::Implicit(body) => body.mass_at(slot),
            Structure::Lagrangian(body) => Some(body.mass_at(slot)),
        }
    }

    /// Finds how touched nodes answer impulses.
    pub fn weigh(&mut self) {
        either!(self, b => b.weigh())
    }

    /// Tells contact how a shared node that is touched moves under the impulses found so far.
    pub fn offer(&self, slot: usize, field: &mut VelocityField) {
        either!(self, b => b.offer(slot, field))
    }

    /// Takes over the impulse that contact has found at a shared node, N s.
    pub fn take(&mut self, slot: usize, impulse: [f64; 2]) {
        either!(self, b => b.take(slot, impulse))
    }

    /// Ends sweep number `pass` over the touched nodes: whether it changed next to nothing.
    pub fn settle(&mut self, pass: usize) -> bool {
        either!(self, b => b.passes = b.passes.max(pass));
        match self {
            Structure::Implicit(b) => {
                let [change, largest] = b.settle();
                change <= SETTLED * largest
            }
            Structure::Lagrangian(b) => b.settle(),
        }
    }

    /// Largest number of sweeps in a step, and how many are allowed.
    pub fn passes(&self) -> [usize; 2] {
        [either!(self, b => b.passes), PASSES]
    }
}

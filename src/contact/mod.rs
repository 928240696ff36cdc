//! Contact between bodies that have velocity fields of their own.
//!
//! Where the points of two bodies reach the same node, the node carries the mass and momentum of each. Contact compares the two velocities
//! after the momentum balance. It finds an impulse that keeps the bodies from moving into each other, with Coulomb friction along the
//! surface between them. Both get it, with opposite signs (Bardenhagen, Brackbill and Sulsky 2000; Ng et al., Appendix B).
//!
//! - [`side`] is one body at a node; [`pair`] is the law for two: impulse, stick and slip, work; [`node`] solves it for any number.
//! - `normal`, `regression` and [`outline`] say how the surface lies, `separation` how far apart the bodies are.
//!
//! - [`rule`] is what a user chooses.
//!
//! Everything here is a function of what a node or a few points know; nothing imports the grid.
//!
//! Elsewhere: multi-field, multi-velocity or multi-material contact.

mod boxes;
pub mod node;
pub(crate) mod normal;
pub mod outline;
pub mod pair;
pub(crate) mod regression;
pub mod rule;
pub(crate) mod separation;
pub mod side;

#[cfg(test)]
mod tests;

/// A vector in the plane.
pub type Vector = [f64; 2];

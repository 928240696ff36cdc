//! Gauges: what one would install on the flume. They read the simulation and never touch it.
//!
//! - [`BarrierGauge`]: force, moment and pressure on a boundary from the impulses at the grid nodes, every step.
//! - [`layers`]: the same force from the stress of the nearest material points.
//! - [`ReactionGauge`]: force and moment on a clamp, or between bodies.
//! - [`penetration`]: how deep material lies inside a structure.
//! - [`flow`]: front, depth, velocity, run-up, overtopping.

mod barrier;
pub mod flow;
pub mod layers;
pub mod penetration;
mod reaction;

pub use barrier::{BarrierGauge, ForceSample, Peak};
pub use reaction::{Reaction, ReactionGauge};

//! Gauges: what one would install on the flume. They read the simulation and never touch it.
//!
//! - [`BarrierGauge`]: force, moment and pressure on a boundary, or on a body in contact, from the impulses at the grid nodes,
//!   every step.
//! - [`StructureGauge`]: a barrier that is a body: its clamp, its inertia, how it bends, whether it tears, the material beside it.
//! - [`BaseGauge`]: force of a boundary on what lies on it.
//! - `layers`: the same force from the stress of the nearest material points.
//! - [`ReactionGauge`]: force and moment on a clamp, or between bodies.
//! - [`penetration`]: how deep material lies inside a structure.
//! - [`flow`]: front, depth, velocity, run-up, overtopping.
//!
//! Elsewhere: probes, sensors, load cells, history output, in-situ post-processing.

mod barrier;
mod base;
mod beside;
pub mod flow;
pub(crate) mod layers;
pub mod penetration;
mod reaction;
pub mod structure;

pub use barrier::{BarrierGauge, ForceSample, Peak, contact_impulse};
pub use base::{BaseGauge, BaseSample};
pub use reaction::{Reaction, ReactionGauge};
pub use structure::{StructureGauge, StructureSample};

//! Gauges: what one would install on the flume. They read the simulation and never touch it.
//!
//! - [`BarrierGauge`]: force, moment and pressure on a boundary, or on a body in contact, from the impulses at the grid nodes,
//!   every step.
//! - [`StructureGauge`]: a barrier that is a body: its clamp, its inertia, how it bends, whether it tears, the material beside it.
//! - [`BaseGauge`]: force of a boundary on what lies on it.
//! - `layers`: the same force from the stress of the nearest material points.
//! - [`RunningMean`]: the largest mean of a force over 20 ms.
//! - [`ReactionGauge`]: force and moment on a clamp, or between bodies.
//! - [`penetration`]: how deep material lies inside a structure or a boundary.
//! - [`FrontGauge`]: the front of the flow, its velocity and depth.
//! - [`StationGauge`]: depth and velocity at a place.
//! - [`WindowGauge`]: speed in a rectangle.
//! - [`wall_state`]: run-up, and what is behind.
//! - [`PassageGauge`]: what has passed over, under and through a wall.
//! - [`velocity_field`]: velocity and stress, cell by cell.
//! - [`velocity_beyond`]: how the flow moves beyond the section of an inflow.
//! - `flow`: what of all this flows.
//!
//! Elsewhere: probes, sensors, load cells, history output, in-situ post-processing.

mod barrier;
mod base;
mod beside;
mod field;
pub(crate) mod flow;
mod front;
pub(crate) mod layers;
mod passage;
mod peak;
pub mod penetration;
mod reaction;
mod running;
mod section;
mod station;
pub mod structure;
#[cfg(test)]
#[path = "two_bodies_tests.rs"]
mod two_bodies;
mod wall_state;
mod window;

pub use barrier::{BarrierGauge, ForceSample, contact_impulse};
pub use base::{BaseGauge, BaseSample};
pub use field::{FieldCell, velocity_field};
pub use front::{FRONT_SHARE, Front, FrontGauge};
pub use passage::{Passage, PassageGauge};
pub use peak::Peak;
pub use reaction::{Reaction, ReactionGauge};
pub use running::RunningMean;
pub use section::velocity_beyond;
pub use station::{StationGauge, StationSample};
pub use structure::{StructureGauge, StructureSample};
pub use wall_state::{WallState, wall_state};
pub use window::{WindowGauge, WindowSample};

//! Closed forms: what the solver is held against. Nothing here imports the solver, so that no reference is its own witness.
//!
//! One file per subject. Units are SI, angles radians, stresses positive in tension unless a function says otherwise.
//!
//! Elsewhere: analytical solutions, benchmark problems.

pub mod bar;
pub mod barrier;
pub mod cantilever;
pub mod collapse;
pub mod deposit;
pub mod dispersion;
pub mod drucker_prager;
pub mod earth_pressure;
pub mod elastic;
pub mod hertz;
pub mod impact;
pub mod jaumann;
pub mod jump;
pub mod manufactured;
pub mod mohr_coulomb;
pub mod mu_i;
pub mod neo_hookean;
pub mod order;
pub mod outflow;
pub mod parabola;
pub mod pic;
pub mod self_weight;
pub mod sliding_block;
pub mod slip;
pub mod uniform_flow;
pub mod vortex;

//! checkdam: the force of dry granular flow on barriers, by the material point method, with the checks that say how one knows.
//!
//! ```text
//! case (TOML) -> Case (validated) -> Scene -> Simulation -> step() ... step()
//!                                                 |   gauges and ledgers read
//!                                                 v
//!                                   tables -> CSV / VTK / SVG / checks
//! ```
//!
//! **Scope.** Two dimensions, plane strain with a thickness; stress is always the full tensor. Bodies in contact
//! have a velocity field each; rigid boundaries; Coulomb friction. Linear elasticity, Drucker-Prager, Mohr-Coulomb, von Mises and
//! mu(I) in rate form, and a neo-Hookean law.
//!
//! **Conventions.** SI units. Tension is positive; the mean stress is tr(sigma)/3. Angles are radians, except in case files,
//! where the field's name says degrees. A table's column names end in their units. Forces on a barrier are positive when the
//! material pushes.
//!
//! **Determinism.** The same case gives the same bits on every run, for any number of threads and any vector unit: sums have a
//! fixed order, there is no fused multiply-add, and transcendental functions come from `libm`.
//!
//! **Who may name whom.** [`theory`] imports nothing of the solver; [`constitutive`] knows one point and no grid; [`gauge`] and
//! [`ledger`] read and never touch; the solver ([`simulation`] and what it uses) knows neither files nor pictures. Room by room, and
//! held by a test (`src/directions_tests.rs`). Within a room, no files or folders name each other in a circle; nor do they in the suites
//! and in the command.
//! All but [`theory`] and [`check`] may name [`seeded`], the switch for faults on purpose:
//!
//! ```text
//! space:
//! lanes:
//! vector:
//! shape:        lanes space
//! grid:         space
//! constitutive: lanes space
//! mesh:
//! body:         constitutive lanes mesh space
//! boundary:     grid space
//! contact:      lanes space
//! ledger:       boundary contact space
//! band:         body boundary lanes ledger space
//! momentum:     band boundary ledger space
//! layout:       band body grid shape space
//! transfer:     band body constitutive grid lanes shape space vector
//! timestep:     body
//! simulation:   band body boundary constitutive contact grid lanes layout ledger mesh momentum shape space timestep transfer
//! gauge:        band body boundary constitutive contact grid lanes ledger simulation space
//! theory:
//! check:
//! output:
//! plot:         check output
//! case:         boundary constitutive contact shape simulation
//! run:          body boundary case constitutive contact gauge grid ledger mesh output plot shape simulation space timestep
//! study:        case check output plot run
//! reference:    case run study
//! scaffold:     body boundary constitutive grid mesh shape simulation
//! seeded:
//! ```
//!
//! Start with [`simulation::Simulation::step`], which is the algorithm on one screen, or with [`run::run`].

#![deny(unsafe_code)]
#![warn(missing_docs)]

pub mod band;
pub mod body;
pub mod boundary;
pub mod case;
pub mod check;
pub mod constitutive;
pub mod contact;
#[cfg(test)]
mod directions_tests;
#[cfg(test)]
mod fuzz_tests;
pub mod gauge;
pub mod grid;
pub mod lanes;
pub mod layout;
pub mod ledger;
mod mesh;
mod momentum;
pub mod output;
pub mod plot;
#[cfg(test)]
mod reference;
pub mod run;
pub mod scaffold;
pub mod seeded;
pub mod shape;
pub mod simulation;
#[cfg(test)]
mod solver_tests;
mod space;
pub mod study;
pub mod theory;
mod timestep;
pub mod transfer;
mod vector;

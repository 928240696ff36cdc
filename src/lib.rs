//! checkdam: skeleton.
#![deny(unsafe_code)]
#![warn(missing_docs)]

pub mod body;
pub mod boundary;
pub mod case;
pub mod check;
pub mod constitutive;
pub mod gauge;
pub mod grid;
pub mod lanes;
pub mod layout;
pub mod ledger;
pub mod momentum;
pub mod output;
pub mod plot;
pub mod run;
pub mod shape;
pub mod simulation;
pub mod theory;
pub mod timestep;
pub mod transfer;
#[path = "../verification/mod.rs"]
pub mod verification;

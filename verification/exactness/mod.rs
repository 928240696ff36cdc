//! What must hold to round-off: transfers that reproduce linear fields, motion without strain, momentum that adds up, the same
//! bits for any number of threads and any width of vectors.

mod bits;
mod motion;
mod rotation;
mod transfers;

use super::{Fault, FaultKind, Outcome, Rung};
use crate::RungFailure;

/// The rung.
pub const RUNG: Rung = Rung {
    name: "exactness",
    title: "Linear fields, rigid motion, free fall and momentum to round-off; the same bits for all threads and vectors",
    run,
    covers: &[(FaultKind::Gravity, 1.02), (FaultKind::Modulus, 1.02), (FaultKind::ContactForce, 1.02)],
    under_fault: "all",
};

/// Why checks at the level of round-off have the tolerance they have.
const ROUND_OFF: &str = "exact but for round-off: some hundred operations of 1.1e-16 each, with margin";

fn run(fault: &Fault) -> Result<Outcome, RungFailure> {
    let mut outcome = Outcome::default();
    transfers::run(fault, &mut outcome);
    motion::translation(fault, &mut outcome)?;
    motion::free_fall(fault, &mut outcome)?;
    motion::momentum(fault, &mut outcome)?;
    rotation::run(fault, &mut outcome)?;
    bits::run(fault, &mut outcome)?;
    Ok(outcome)
}

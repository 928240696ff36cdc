//! What must hold to round-off: transfers that reproduce linear fields, motion without strain, momentum that adds up, the same
//! bits for any number of threads and any width of vectors.

mod bits;
mod motion;
mod rotation;
mod transfers;

use super::{Fault, FaultKind, Outcome, Rung};
use crate::RungFailure;
use crate::figure::{Figure, curves, measured};
use crate::of_module;
use checkdam::plot::curves::Curves;

/// The rung.
pub const RUNG: Rung = Rung {
    name: of_module(module_path!()),
    title: "Linear fields, rigid motion, free fall and momentum to round-off; the same bits for all threads and vectors",
    goal: "What the scheme must do exactly holds to round-off, and the bits do not depend on threads or vectors",
    source: "partition of unity and linear completeness of the shape functions; Newton's laws",
    sketch: r"
   +---+---+---+---+      v = a + G x  on the points
   | o o | o o | o |      must come back as v and G
   | o o | o o | o |
   +---+---+---+---+      bricks that fly, fall, turn: no strain,
   |   g             |    no change of momentum but by g
",
    run,
    covers: &[(FaultKind::Gravity, 1.02), (FaultKind::Modulus, 1.02), (FaultKind::ContactForce, 1.02)],
    under_fault: "all",
    figures: FIGURES,
};

/// Its figures.
const FIGURES: &[Figure] = &[curves(
    "exactness_spinning_disk",
    "exactness_spinning_disk_plot",
    Curves {
        x: "cells_per_radius",
        x_title: "cells per radius",
        y_title: "change of angular momentum in 0.35 turns, relative",
        curves: &[measured("angular_momentum_change", "spinning disk")],
        orders: &[2.0],
        ..Curves::LOGARITHMIC
    },
)];

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

//! Tests that other codes of the material point method run, each beside its closed form and, where one is public, the number that they keep.
//!
//! - A block on a slope of 30 degrees, on a grid that is not turned with it. Matter keeps 0.1 % of the distance on 24 degrees with friction
//!   tan 15, cb-geo/mpm the places of its points on an inclined boundary.
//! - A column of cohesive soil between two smooth plates, as in the unconfined compression test of soil mechanics.
//! - A slide without friction down y = x^2 from (-1, 1). Matter keeps the speed of one material point at the bottom, to 0.01 %.
//! - A beam of 8 m by 1 m that hangs under its weight: 0.67433 m in Iaconeta et al. (2017), by finite elements and three other methods.
//!
//! The very flexible cantilever is in the rung `cantilever`.

mod beam;
mod block;
mod bowl;
mod plates;

use super::{Fault, FaultKind, Outcome, Rung, RungFailure};
use crate::figure::{Figure, curves, exact, measured};
use crate::of_module;
use checkdam::plot::curves::Curves;

/// The rung.
pub const RUNG: Rung = Rung {
    name: of_module(module_path!()),
    title: "Tests of other codes: a block at 30 degrees, a column between plates, a slide down a parabola, a beam under its weight",
    goal: "What other codes test comes out as its closed form says, and for the beam as they have it",
    source: "Coulomb 1785; Mohr-Coulomb; energy; elastica with Timoshenko's shear; github.com/larsblatny/matter; Iaconeta et al. 2017",
    sketch: r"
   \o|          | plate |                       ||o o o o o o o
    \ \ 30      |o o o o|   \o o         |      ||       ' ' . . o
     \  \       |o o o o|     \ .      /        clamp            o
      \___\     | plate |        ' . '            8 m x 1 m
",
    run,
    covers: &[
        (FaultKind::Friction, 1.03),
        (FaultKind::Gravity, 1.03),
        (FaultKind::Modulus, 1.03),
        (FaultKind::Density, 1.03),
    ],
    under_fault: "those of the four that the fault concerns; the beam by its mesh",
    figures: &[BOWL, PLATES],
};

const BOWL: Figure = curves(
    "other_codes_bowl",
    "other_codes_bowl_plot",
    Curves {
        x: "x_m",
        x_title: "place of the centre (m)",
        y_title: "speed (m/s)",
        curves: &[measured("speed_m_s", "computed"), exact("speed_exact_m_s", "rigid block")],
        ..Curves::LINEAR
    },
);

const PLATES: Figure = curves(
    "other_codes_plates",
    "other_codes_plates_plot",
    Curves {
        x: "strain_percent",
        x_title: "shortening of the column (%)",
        y_title: "stress on the plate (Pa)",
        curves: &[measured("stress_pa", ""), exact("strength_pa", "closed form")],
        split: &[("column", "")],
        ..Curves::LINEAR
    },
);

type Part = fn(&Fault) -> Result<Outcome, RungFailure>;

/// The tests, with the faults that each of them notices.
const PARTS: [(Part, &[FaultKind]); 4] = [
    (block::run, &[FaultKind::Friction, FaultKind::Gravity]),
    (plates::run, &[FaultKind::Friction]),
    (bowl::run, &[FaultKind::Gravity]),
    (beam::run, &[FaultKind::Gravity, FaultKind::Density, FaultKind::Modulus]),
];

fn run(fault: &Fault) -> Result<Outcome, RungFailure> {
    let mut outcome = Outcome::default();
    // Whether the fault is one of this kind.
    let concerns = |&kind: &FaultKind| [1.03, 0.97, 2.0 - 1.03].iter().any(|&f| *fault == Fault::of(kind, f));
    for (part, kinds) in PARTS {
        if *fault == Fault::NONE || kinds.iter().any(concerns) {
            outcome.merge(part(fault)?);
        }
    }
    Ok(outcome)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Each of the tests notices by itself what is off by 3 %.
    #[test]
    fn each_part_catches_its_own_faults() {
        for (index, (part, kinds)) in PARTS.into_iter().enumerate() {
            for &kind in kinds {
                let outcome = part(&Fault::of(kind, 0.97)).unwrap_or_else(|e| panic!("{index}: {e}"));
                assert!(outcome.checks.iter().any(|c| !c.passes()), "{index} misses {}", kind.name());
            }
        }
    }
}

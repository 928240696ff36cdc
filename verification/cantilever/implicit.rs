//! The meshed beam in implicit steps: the same rest, a swing that is slowed and damped as the theta method says, and the same impact.
//!
//! Steps are 20 cells over the speed of the P-wave, 46 times what explicit ones may be long. What is at rest does not know of the step. A swing
//! of angular frequency w is multiplied in a step dt by (1 + i (1 - theta) z)/(1 - i theta z) with z = w dt and theta = 0.6, from which its
//! frequency and its energy follow. Modes that are too fast for the step are gone at once.

use super::beam::Beam;
use super::plate::{EXPLICIT, Struck, bend, impact, plate};
use super::swing::vibrate;
use super::{NO_LATERAL_STRAIN, TIMOSHENKO};
use crate::{Fault, Outcome, RungFailure};
use checkdam::check::{Check, Kind, Tolerance};
use std::f64::consts::PI;

/// Weight of the end of a step, as docs/theory/implicit.md has it.
const THETA: f64 = 0.6;
/// Length of the steps, in cells over the speed of the P-wave.
const STEP: f64 = 20.0;
const METHOD: &str = "amplification of the theta method";

/// A plate as the explicit one, and one a thousand times as stiff.
const SAME: Struck = Struck {
    names: ["sand on a plate in implicit steps", "the same in implicit steps"],
    young: 1e6,
    implicit: true,
    round_off: (1e-10, "round-off of a linear solve in each of a few thousand steps"),
    energy: EXPLICIT.energy,
};
const STIFF: Struck = Struck {
    names: ["sand on a plate of 1 GPa in implicit steps", "the same of 1 GPa"],
    young: 1e9,
    energy: (
        0.05,
        "the sand's own share, from one length of the steps to another: 1.8 to 3.5 % with cfl from 0.05 to 0.4, 1.3 % in explicit steps",
    ),
    ..SAME
};

/// All of it; `struck` are the impulses of contact and on the clamp in explicit steps, N s.
pub fn run(struck: [f64; 2], fault: &Fault, outcome: &mut Outcome) -> Result<(), RungFailure> {
    let beam = Beam { implicit: Some(STEP), ..plate(2, 2, NO_LATERAL_STRAIN) };
    let error = bend(&beam, fault, &mut Vec::new())?;
    outcome.check(
        Check::value("mesh in implicit steps, L/t = 6, nu = 0, 2 cells: error of the tip's deflection", error, -0.0049, "1")
            .within(
                Tolerance::Absolute(0.001),
                "0.12 % along the beam and 0.37 % of shear, as in explicit steps: what is at rest does not know of the step",
            )
            .from(Kind::Analytic, TIMOSHENKO),
    );
    frequency(&beam, fault, outcome)?;
    let same = impact(&SAME, fault, outcome)?;
    for ((what, found), explicit) in
        ["contact gives the plate", "the plate gives its clamp"].iter().zip(same).zip(struck)
    {
        outcome.check(
            Check::value(format!("the same in implicit steps: impulse that {what}"), found, explicit, "N s")
                .within(
                    Tolerance::Relative(0.03),
                    "contact, sand and plate are of first order in steps of a hundredth of the impact's length",
                )
                .from(Kind::Convergence, "explicit steps"),
        );
    }
    impact(&STIFF, fault, outcome)?;
    Ok(())
}

fn frequency(beam: &Beam, fault: &Fault, outcome: &mut Outcome) -> Result<(), RungFailure> {
    let angular = beam.exact().frequency();
    let dt = STEP * beam.crossing();
    let z = angular * dt;
    let [before, after] = [1.0 - THETA, THETA].map(|t| t * z);
    let seen = (before.atan() + after.atan()) / dt;
    let steps = (2.5 * 2.0 * PI / z).ceil();
    let rest = ((1.0 + before * before) / (1.0 + after * after)).powf(steps);
    let [period, energy] = vibrate(beam, fault)?;
    outcome.check(
        Check::value("mesh in implicit steps: first frequency", 1.0 / period, seen / (2.0 * PI), "Hz")
            .within(Tolerance::Relative(0.005), "as in explicit steps: half of the deflection's, and lumped masses")
            .from(Kind::Analytic, METHOD),
    );
    outcome.check(
        Check::value("mesh in implicit steps: energy after 2.5 periods over that at the start", energy, rest, "1")
            .within(
                Tolerance::Relative(0.02),
                "half a percent of frequency is 0.9 % of what is lost; what begins in faster modes is lost as well",
            )
            .from(Kind::Analytic, METHOD),
    );
    Ok(())
}

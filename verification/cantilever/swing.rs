//! The first frequency of the beam, from its free vibration.

use super::beam::{Beam, DEPTH, released};
use super::{MATERIAL, SHAPE_NAMES, SHAPES};
use crate::report::named_csv;
use crate::{Fault, Outcome, RungFailure};
use checkdam::check::{Check, Expected, Kind, Tolerance};
use checkdam::shape::ShapeFunction;
use checkdam::theory::cantilever::first_mode;
use std::f64::consts::PI;

/// Period (s) as the mean of two, and energy after 2.5 periods over that at the start.
pub(super) fn vibrate(beam: &Beam, fault: &Fault) -> Result<[f64; 2], RungFailure> {
    let e = beam.exact();
    let speed = 1e-3 * DEPTH * e.frequency();
    let mode = |y: f64| first_mode(y / e.length);
    let heights: Vec<f64> = beam.points().iter().map(|p| p.x[1]).collect();
    let mut sim = released(beam, |y| speed * mode(y), fault);
    let weights: Vec<f64> = heights.iter().map(|&y| if y > 0.0 { mode(y) } else { 0.0 }).collect();
    let initial = sim.stock().kinetic;
    let (mut zeros, mut last) = (Vec::new(), [0.0, 1.0]);
    while sim.time() < 2.5 * 2.0 * PI / e.frequency() {
        sim.step()?;
        let modal = sim.particles().map(|(_, p)| p.v[0] * weights[p.id as usize]).sum();
        // Velocities belong to the middle of the step.
        let now = [sim.time() - 0.5 * sim.time_step().dt, modal];
        if now[1] * last[1] < 0.0 {
            zeros.push(now[0] - (now[0] - last[0]) * now[1] / (now[1] - last[1]));
        }
        last = now;
    }
    let stock = sim.stock();
    let period = if zeros.len() >= 5 { 0.5 * (zeros[4] - zeros[0]) } else { f64::NAN };
    Ok([period, (stock.kinetic + stock.elastic) / initial])
}

/// Two grids, two shape functions.
pub fn run(fault: &Fault, outcome: &mut Outcome) -> Result<(), RungFailure> {
    let mut rows = Vec::new();
    for (index, (shape, name)) in SHAPES.into_iter().enumerate() {
        for cells in [4, 8] {
            if *fault != Fault::NONE && (cells < 8 || shape != ShapeFunction::Ugimp) {
                continue;
            }
            let beam =
                Beam { shape, slenderness: 4, cells, material: MATERIAL, per_cell: 2, mesh: false, implicit: None };
            let exact = beam.exact().frequency() / (2.0 * PI);
            let [period, energy] = vibrate(&beam, fault)?;
            rows.push(vec![index as f64, cells as f64, 1.0 / period, exact, energy]);
            if cells < 8 {
                continue;
            }
            outcome.check(
                Check::value(format!("{name}, L/t = 4, 8 cells: first frequency"), 1.0 / period, exact, "Hz")
                    .within(
                        Tolerance::Relative(0.02),
                        "the square root of the stiffness: half of what deflections are allowed, less lumped masses",
                    )
                    .from(Kind::Analytic, "3.51602 with E/(1 - nu^2), shear and rotary inertia (Huang 1961)"),
            );
            outcome.check(
                Check::new(
                    format!("{name}, L/t = 4, 8 cells: energy after 2.5 periods over that at the start"),
                    energy,
                    Expected::Within(0.98, 1.001),
                    "1",
                )
                .because(
                    "no PIC; the mode of the grid is not that of the beam: 2 % may go to motion that nodes do not see",
                )
                .from(Kind::Conservation, "an elastic beam keeps its energy"),
            );
        }
    }
    let header = ["shape", "cells_through_depth", "frequency_hz", "frequency_exact_hz", "energy_over_initial"];
    outcome.tables.push(("cantilever_frequency".into(), named_csv(&header, &[("shape", &SHAPE_NAMES)], rows)));
    Ok(())
}

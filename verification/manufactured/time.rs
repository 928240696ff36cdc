//! The time step at a fixed grid: differences between solutions with successive halves.

use super::field::{Setting, State, distance, fly};
use super::{LARGE, MEDIUM, SHAPE_NAMES, SHAPES, SMALL};
use crate::report::named_csv;
use crate::{Fault, Outcome, RungFailure};
use checkdam::check::{Check, Expected, Kind};
use checkdam::shape::ShapeFunction;
use checkdam::theory::order;

const CELLS: usize = 20;
const COURANTS: [f64; 4] = [0.4, 0.2, 0.1, 0.05];
const END: f64 = 0.3;

/// Three shape functions at three amplitudes.
pub fn run(fault: &Fault, outcome: &mut Outcome) -> Result<(), RungFailure> {
    let mut rows = Vec::new();
    for (index, (shape, name)) in SHAPES.into_iter().enumerate() {
        for amplitude in [SMALL, MEDIUM, LARGE] {
            let states = COURANTS
                .iter()
                .map(|&courant| {
                    let setting = Setting { shape, amplitude, cells: CELLS, courant };
                    fly(&setting, &[END], fault).map(|mut s| s.swap_remove(0))
                })
                .collect::<Result<Vec<_>, _>>()?;
            let steps: Vec<[f64; 2]> = states
                .windows(2)
                .map(|w| [distance(&w[0].displacement, &w[1].displacement), distance(&w[0].stress, &w[1].stress)])
                .collect();
            for (courant, d) in COURANTS[1..].iter().zip(&steps) {
                rows.push(vec![index as f64, amplitude, *courant, d[0], d[1]]);
            }
            // Linear functions jump where a point crosses a cell, at another step each time: no order to be had.
            if shape != ShapeFunction::Linear || amplitude == SMALL {
                // Splines at a wall act through nodes of little mass; at small amplitude, where the first-order term is
                // small, that is what is left of the stress.
                let stress = shape != ShapeFunction::Bspline || amplitude != SMALL;
                judge(&format!("{name}, A = {amplitude}"), &states, &steps, stress, outcome);
            }
        }
    }
    let header = ["shape", "amplitude_over_side", "c_dt_over_h", "displacement_change", "stress_change"];
    outcome.tables.push(("manufactured_time".into(), named_csv(&header, &[("shape", &SHAPE_NAMES)], rows)));
    Ok(())
}

/// `first` says whether the term of first order leads; otherwise only displacements are asked for no less than that order.
fn judge(what: &str, states: &[State], steps: &[[f64; 2]], first: bool, outcome: &mut Outcome) {
    let expected = if first { Expected::Within(0.8, 1.2) } else { Expected::AtLeast(0.8) };
    for (q, quantity) in ["displacement", "stress"].into_iter().enumerate().take(if first { 2 } else { 1 }) {
        for (w, courant) in steps.windows(2).zip(&COURANTS[2..]) {
            outcome.check(
                Check::new(
                    format!("{what}, {quantity}, c dt/h down to {courant}: observed order in time"),
                    order::from_errors(w[0][q], w[1][q], 2.0),
                    expected,
                    "1",
                )
                .because(
                    "first order: strain on the configuration at the start of a step, displacement by nodal velocities",
                )
                .from(Kind::Convergence, "sum of D = ln F + sum of D^2/2"),
            );
        }
    }
    // What is left at c dt/h = 0.2: a geometric series of differences.
    let left = 2.0 * steps[1][0];
    outcome.check(
        Check::at_most(
            format!("{what}: share of the time step in the error of displacement, c dt/h = 0.2"),
            left / states[1].interior.displacement,
            0.5,
            "1",
        )
        .because("orders in space are judged at this step: most of the error has to come from the grid")
        .from(Kind::Convergence, "Roache 1994"),
    );
}

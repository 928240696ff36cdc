//! The time step at a fixed grid: differences between solutions with successive halves.

use super::field::{Setting, distance, fly};
use super::{LARGE, MEDIUM, SMALL};
use crate::check::{Check, Expected, Kind};
use crate::shape::ShapeFunction;
use crate::theory::order;
use crate::verification::report::table_csv;
use crate::verification::{Fault, Outcome, RungFailure};

const CELLS: usize = 20;
const COURANTS: [f64; 4] = [0.4, 0.2, 0.1, 0.05];
const END: f64 = 0.3;

/// uGIMP at three amplitudes.
pub fn run(fault: &Fault, outcome: &mut Outcome) -> Result<(), RungFailure> {
    let mut rows = Vec::new();
    for amplitude in [SMALL, MEDIUM, LARGE] {
        let states = COURANTS
            .iter()
            .map(|&courant| {
                let setting = Setting { shape: ShapeFunction::Ugimp, amplitude, cells: CELLS, courant };
                fly(&setting, &[END], fault).map(|mut s| s.swap_remove(0))
            })
            .collect::<Result<Vec<_>, _>>()?;
        let steps: Vec<[f64; 2]> = states
            .windows(2)
            .map(|w| [distance(&w[0].displacement, &w[1].displacement), distance(&w[0].stress, &w[1].stress)])
            .collect();
        for (courant, d) in COURANTS[1..].iter().zip(&steps) {
            rows.push(vec![amplitude, *courant, d[0], d[1]]);
        }
        for (q, quantity) in ["displacement", "stress"].into_iter().enumerate() {
            for (w, courant) in steps.windows(2).zip(&COURANTS[2..]) {
                outcome.check(
                    Check::new(
                        format!("uGIMP, A = {amplitude}, {quantity}, c dt/h down to {courant}: observed order in time"),
                        order::from_errors(w[0][q], w[1][q], 2.0),
                        Expected::Within(0.8, 1.2),
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
                format!("uGIMP, A = {amplitude}: share of the time step in the error of displacement, c dt/h = 0.2"),
                left / states[1].interior.displacement,
                0.5,
                "1",
            )
            .because("orders in space are judged at this step: most of the error has to come from the grid")
            .from(Kind::Convergence, "Roache 1994"),
        );
    }
    let header = ["amplitude_over_side", "c_dt_over_h", "displacement_change", "stress_change"];
    outcome.tables.push(("manufactured_time".into(), table_csv(&header, rows)));
    Ok(())
}

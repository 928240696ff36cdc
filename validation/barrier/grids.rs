//! Numerical error of the barrier's numbers: cells of 20, 10 and 5 mm, moved grids and other packings. On three grids there are runs with
//! barriers of points and boundaries at nodes; the barriers of the study as they are now have two.

use super::records::{FINE, GRIDS, SCATTER, on_cells, on_study_cells};
use crate::balances::Balances;
use crate::runs::Run;
use crate::scatter::Scatter;
use crate::{Context, Failure, Validation};
use checkdam::plot::PlotError;
use checkdam::plot::curves::{self, Curve, Curves, panel};
use checkdam::theory::order::Study as Order;
use checkdam_verification::Outcome;
use checkdam_verification::report::number;
use std::path::Path;

/// The analysis of the recorded runs.
pub const VALIDATION: Validation = Validation {
    name: "barrier_grids",
    title: "The barrier on grids of 20, 10 and 5 mm: order, grid convergence index, scatter",
    study: "49 runs, about 25 minutes",
    run,
    draw,
    covers: &[],
};

/// Cell sizes, m, coarse to fine.
const CELLS: [f64; 3] = [0.02, 0.01, 0.005];
/// What is compared. The impulse is that of the 0.25 s to the end of these runs.
pub const QUANTITIES: [&str; 7] = [
    "peak_20ms_n",
    "peak_step_n",
    "peak_50hz_n",
    "impulse_half_second_n_s",
    "peak_deflection_m",
    "peak_barrier_velocity_m_per_s",
    "tip_max_m",
];

/// Mean and scatter of a quantity of one barrier on three grids, and what the means say.
#[derive(Debug, Clone, Copy)]
pub struct Numerical {
    /// At 20, 10 and 5 mm.
    pub scatter: [Scatter; 3],
    /// Of the means.
    pub order: Order,
}

impl Numerical {
    /// Of repeated runs on two grids and on the third.
    pub fn of(repeated: &[(f64, Run)], fine: &[(f64, Run)], stiffness: f64, quantity: &str) -> Self {
        let own = || repeated.iter().filter(|(n, _)| *n == stiffness).map(|(_, r)| r);
        let finest = fine.iter().filter(|(n, _)| *n == stiffness).map(|(_, r)| r.get(quantity));
        let scatter = [on_cells(own(), "0.02", quantity), on_study_cells(own(), quantity), Scatter::of(finest)];
        Self { scatter, order: Order::new(scatter.map(|s| s.mean), CELLS) }
    }
}

fn run(context: &mut Context) -> Result<Outcome, Failure> {
    let (repeated, fine) = (GRIDS.by_stiffness(context)?, FINE.by_stiffness(context)?);
    let mut outcome = Outcome::default();
    let blank = |x: f64| if x.is_finite() { number(x) } else { String::new() };
    let mut grids =
        String::from("stiffness_1,quantity,cell_m,mean,deviation,mean_less_deviation,mean_plus_deviation,runs\n");
    let mut orders =
        String::from("stiffness_1,quantity,trend,order,extrapolated,index_10mm_percent,index_5mm_percent\n");
    let mut barriers: Vec<(f64, &str)> = fine.iter().map(|(n, r)| (*n, r.set["stiffness_1"].as_str())).collect();
    barriers.dedup();
    for (stiffness, stiffness_cell) in barriers {
        for quantity in QUANTITIES {
            let n = Numerical::of(&repeated, &fine, stiffness, quantity);
            for (cell, s) in CELLS.iter().zip(n.scatter) {
                let numbers = [s.mean, s.deviation, s.mean - s.deviation, s.mean + s.deviation].map(blank).join(",");
                grids += &format!("{stiffness_cell},{quantity},{cell},{numbers},{}\n", s.count);
            }
            let o = n.order;
            let numbers = [o.order, o.extrapolated, 100.0 * o.index[0], 100.0 * o.index[1]].map(blank).join(",");
            orders += &format!("{stiffness_cell},{quantity},{},{numbers}\n", o.trend.name());
        }
    }
    outcome.tables.push(("barrier_grids_numbers".into(), grids));
    outcome.tables.push(("barrier_grids_order".into(), orders));
    outcome.tables.push(("barrier_grids_meshes".into(), of_meshes(&SCATTER.by_stiffness(context)?)));
    let moved = |r: &Run| r.set["cell_m"].parse().unwrap_or(f64::NAN);
    let of_moved = Balances::over(repeated.iter().map(|(_, r)| r), moved);
    let of_fine = Balances::over(fine.iter().map(|(_, r)| r), |_| CELLS[2]);
    for (name, balances) in [("moved grids: ", of_moved), ("fine cells: ", of_fine)] {
        outcome.checks.extend(balances.checks(name, "ledgers and gauges of all runs"));
    }
    Ok(outcome)
}

/// The barriers of the study as they are now, by meshes of their own, on two grids: too few for an order.
fn of_meshes(runs: &[(f64, Run)]) -> String {
    let mut text = String::from("stiffness_1,quantity,mean_20mm,deviation_20mm,mean_10mm,deviation_10mm,runs\n");
    let mut barriers: Vec<&str> = runs.iter().map(|(_, r)| r.set["stiffness_1"].as_str()).collect();
    barriers.sort_unstable();
    barriers.dedup();
    for stiffness in barriers {
        for quantity in QUANTITIES {
            let own = || runs.iter().map(|(_, r)| r).filter(|r| r.set["stiffness_1"] == stiffness);
            let [coarse, fine] = [on_cells(own(), "0.02", quantity), on_study_cells(own(), quantity)];
            let numbers = [coarse.mean, coarse.deviation, fine.mean, fine.deviation].map(number).join(",");
            text += &format!("{stiffness},{quantity},{numbers},{}\n", fine.count);
        }
    }
    text
}

const PEAKS: Curves = Curves {
    x: "cell_m",
    x_title: "cell size (m)",
    y_title: "",
    curves: &[
        Curve { column: "mean", label: "mean of the runs", exact: false },
        Curve { column: "mean_less_deviation", label: "one standard deviation", exact: true },
        Curve { column: "mean_plus_deviation", label: "one standard deviation", exact: true },
    ],
    panels: &[
        panel("force over 20 ms (N), n = 2.5e-6", &[("stiffness_1", "2.5e-6"), ("quantity", "peak_20ms_n")]),
        panel("force over 20 ms (N), n = 1e-4", &[("stiffness_1", "0.0001"), ("quantity", "peak_20ms_n")]),
        panel("force over 20 ms (N), n = 1", &[("stiffness_1", "1"), ("quantity", "peak_20ms_n")]),
        panel("deflection at peak (m), n = 2.5e-6", &[("stiffness_1", "2.5e-6"), ("quantity", "peak_deflection_m")]),
        panel("deflection at peak (m), n = 1e-4", &[("stiffness_1", "0.0001"), ("quantity", "peak_deflection_m")]),
        panel("impulse (N s), n = 1e-4", &[("stiffness_1", "0.0001"), ("quantity", "impulse_half_second_n_s")]),
    ],
    ..Curves::LINEAR
};

fn draw(folder: &Path) -> Result<Vec<String>, PlotError> {
    let name = "barrier_grids_plot.svg";
    curves::draw(folder.join("barrier_grids_numbers.csv"), &PEAKS, folder.join(name))?;
    Ok(vec![name.into()])
}

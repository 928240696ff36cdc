//! Numerical error of the barrier's numbers: cells of 20, 10 and 5 mm, moved grids and other packings, explicit and implicit steps.

use super::balances::{self, largest};
use super::records::{FINE, INTEGRATION, SCATTER, on_cells, on_study_cells};
use crate::check::{Check, Kind};
use crate::plot::PlotError;
use crate::plot::curves::{self, Curve, Curves, panel};
use crate::theory::order::Study as Order;
use crate::validation::flume::runs::Run;
use crate::validation::flume::scatter::Scatter;
use crate::validation::{Context, Failure, Validation};
use crate::verification::Outcome;
use crate::verification::report::number;
use std::path::Path;

/// The analysis of the recorded runs.
pub const VALIDATION: Validation = Validation {
    name: "barrier_grids",
    title: "The barrier on grids of 20, 10 and 5 mm, in explicit and in implicit steps: order, grid convergence index, scatter",
    study: "97 runs, about 15 minutes",
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

/// Those that explicit and implicit steps must agree on.
const SMOOTH: [&str; 3] = ["peak_20ms_n", "impulse_half_second_n_s", "tip_max_m"];

/// Mean and scatter of a quantity of one barrier on three grids, and what the means say. The fine grid has one run.
#[derive(Debug, Clone, Copy)]
pub struct Numerical {
    /// At 20, 10 and 5 mm.
    pub scatter: [Scatter; 3],
    /// Of the means.
    pub order: Order,
}

impl Numerical {
    /// Of repeated runs on two grids and one on the third.
    pub fn of(repeated: &[(f64, Run)], fine: &[(f64, Run)], stiffness: f64, quantity: &str) -> Self {
        let own = || repeated.iter().filter(|(n, _)| *n == stiffness).map(|(_, r)| r);
        let finest = fine.iter().filter(|(n, _)| *n == stiffness).map(|(_, r)| r.get(quantity));
        let scatter = [on_cells(own(), "0.02", quantity), on_study_cells(own(), quantity), Scatter::of(finest)];
        Self { scatter, order: Order::new(scatter.map(|s| s.mean), CELLS) }
    }
}

fn run(context: &mut Context) -> Result<Outcome, Failure> {
    let (repeated, fine) = (SCATTER.by_stiffness(context)?, FINE.by_stiffness(context)?);
    let mut outcome = Outcome::default();
    let blank = |x: f64| if x.is_finite() { number(x) } else { String::new() };
    let mut grids =
        String::from("stiffness_1,quantity,cell_m,mean,deviation,mean_less_deviation,mean_plus_deviation,runs\n");
    let mut orders =
        String::from("stiffness_1,quantity,trend,order,extrapolated,index_10mm_percent,index_5mm_percent\n");
    for (stiffness, run) in &fine {
        let stiffness_cell = &run.set["stiffness_1"];
        for quantity in QUANTITIES {
            let n = Numerical::of(&repeated, &fine, *stiffness, quantity);
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
    let (text, checks) = integration(context)?;
    outcome.tables.push(("barrier_grids_integration".into(), text));
    outcome.checks.extend(checks);
    for (name, rows) in [("moved grids", &repeated), ("fine cells", &fine)] {
        let worst = largest(rows.iter().map(|(_, r)| r.get("energy_residual_1")));
        let check = balances::energy(&format!("{name}: "), worst);
        outcome.checks.push(check.from(Kind::Conservation, "ledgers of all runs"));
    }
    Ok(outcome)
}

/// What implicit steps of the sand's own length may be off by, percent, where a quantity is smooth on their scale: as their unit test allows
/// for an impact on a stiff wall.
const BIAS: f64 = 8.0;

/// Implicit against explicit steps: means of repeated runs and their difference. Runs come in pairs, on the same grid and with the same
/// packing, so that the error of the difference is that of the pairs. The largest force of a single step and the velocity of a node at
/// that time are not smooth on the scale of a step, and not judged.
fn integration(context: &mut Context) -> Result<(String, Vec<Check>), Failure> {
    let rows = INTEGRATION.by_stiffness(context)?;
    let mut text = String::from(
        "stiffness_1,quantity,explicit,deviation,implicit,deviation_implicit,difference_percent,error_percent,runs\n",
    );
    let mut stiffnesses: Vec<(f64, String)> = Vec::new();
    for (n, run) in &rows {
        if stiffnesses.iter().all(|s| s.0 != *n) {
            stiffnesses.push((*n, run.set["stiffness_1"].clone()));
        }
    }
    let mut checks = Vec::new();
    for (n, cell) in &stiffnesses {
        for quantity in QUANTITIES.into_iter().chain(["energy_residual_1"]) {
            let of = |integration: &str| {
                let own = rows.iter().filter(|(m, r)| m == n && r.set["integration"] == integration);
                Scatter::of(own.map(|(_, r)| r.get(quantity)))
            };
            let (explicit, implicit) = (of("explicit"), of("implicit"));
            let difference = 100.0 * (implicit.mean / explicit.mean - 1.0);
            let pairs = rows.iter().filter(|(m, r)| m == n && r.set["integration"] == "implicit").map(|(_, own)| {
                let same = |r: &Run| r.set["integration"] == "explicit" && r.replicate == own.replicate;
                let other = rows.iter().find(|(m, r)| m == n && same(r));
                own.get(quantity) - other.map_or(f64::NAN, |(_, r)| r.get(quantity))
            });
            let error = 100.0 * Scatter::of(pairs).standard_error() / explicit.mean;
            let numbers = [explicit.mean, explicit.deviation, implicit.mean, implicit.deviation, difference, error];
            text += &format!("{cell},{quantity},{},{}\n", numbers.map(number).join(","), explicit.count);
            if SMOOTH.contains(&quantity) {
                checks.push(
                    Check::at_most(
                        format!("n = {cell}: {quantity}, implicit less explicit"),
                        difference.abs(),
                        BIAS + 2.0 * error,
                        "%",
                    )
                    .because("8 % of implicit Euler in the sand's own steps, and two standard errors of nine pairs")
                    .from(Kind::Golden, "the same barrier in explicit steps"),
                );
            }
        }
    }
    for (n, cell) in &stiffnesses {
        let lost = |integration: &str| {
            let own = rows.iter().filter(|(m, r)| m == n && r.set["integration"] == integration);
            own.filter(|(_, r)| r.get("energy_residual_1").abs() > balances::ENERGY).count() as f64
        };
        let counts = [lost("explicit"), lost("implicit")].map(number);
        text += &format!("{cell},runs that miss more than 2 % of E0,{},,{},,,,9\n", counts[0], counts[1]);
    }
    Ok((text, checks))
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

//! The literal reading of the paper on several grids: numerical error and scatter.
//!
//! Nothing here was chosen with a look at the paper's numbers: the case files stood before. For every quantity there are the mean and
//! scatter of nine runs on moved grids and with other packings, at 20, 10 and 5 mm. Where the means have an order, there are the observed
//! order, the extrapolation and the grid convergence index. From these comes the numerical uncertainty that the verdict uses. One run at
//! 2.5 mm stands beside them.

use super::read_case;
use super::rules::{Energy, judge};
use crate::record::Record;
use crate::runs::{self, Run};
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
    name: "flume_baseline",
    title: "The flume on grids of 20, 10 and 5 mm, moved and repacked: order, grid convergence index, scatter; one run at 2.5 mm",
    study: "54 runs, about 15 minutes, and two on 2.5 mm cells, as long again",
    run,
    draw,
    covers: &[],
};

/// The study and its record.
pub const RECORD: Record = Record {
    name: "flume_baseline",
    study: include_str!("studies/baseline.toml"),
    read: read_case,
    runs: include_str!("runs/baseline.csv"),
};

/// One run at each angle on finer cells still, and its record.
pub const FINEST: Record = Record {
    name: "flume_finest",
    study: include_str!("studies/finest.toml"),
    read: read_case,
    runs: include_str!("runs/finest.csv"),
};

/// Cell sizes, m, coarse to fine, and as they stand in the table.
pub const CELLS: [(f64, &str); 3] = [(0.02, "0.02"), (0.01, "0.01"), (0.005, "0.005")];
/// Those of [`FINEST`], as they stand in its table.
const FINEST_CELLS: &str = "0.0025";
/// The cell size of the case files.
pub const CASE_CELLS: usize = 1;
/// Quantities that are compared or judged elsewhere.
pub const QUANTITIES: [&str; 16] = [
    "static_force_n",
    "static_shear_n",
    "static_moment_n_m",
    "peak_20ms_n",
    "peak_step_n",
    "impulse_half_second_n_s",
    "run_up_m",
    "arrival_s",
    "time_to_static_s",
    "front_velocity_m_per_s",
    "front_depth_m",
    "froude_1",
    "barrier_velocity_m_per_s",
    "mobilised_1",
    "dissipated_1",
    "plastic_1",
];

/// What three grids say of a quantity.
#[derive(Debug, Clone, Copy)]
pub struct Numerical {
    /// Mean and scatter at 20, 10 and 5 mm.
    pub scatter: [Scatter; 3],
    /// What the means say.
    pub order: Order,
}

impl Numerical {
    /// Of the runs of a case.
    pub fn of(runs: &[Run], case: &str, quantity: &dyn Fn(&Run) -> f64) -> Self {
        let scatter = CELLS.map(|(_, cells)| {
            let own = runs.iter().filter(|r| r.case == case && r.set.get("cell_m").is_some_and(|c| c == cells));
            Scatter::of(own.map(quantity))
        });
        Self { scatter, order: Order::new(scatter.map(|s| s.mean), CELLS.map(|c| c.0)) }
    }

    /// Standard uncertainty of one run of the case files: its scatter, and its distance from zero cell size. That is the grid
    /// convergence index at two standard deviations where the means have an order of 0.5 or more, and half of their range,
    /// taken as evenly spread, otherwise.
    pub fn uncertainty(&self) -> f64 {
        let at = self.scatter[CASE_CELLS];
        let means = self.scatter.map(|s| s.mean);
        let range =
            means.iter().fold(f64::NEG_INFINITY, |a, &m| a.max(m)) - means.iter().fold(f64::INFINITY, |a, &m| a.min(m));
        let grid = if self.order.order >= 0.5 {
            0.5 * self.order.index[0] * means[CASE_CELLS].abs()
        } else {
            0.5 * range / 3f64.sqrt()
        };
        grid.hypot(at.deviation)
    }
}

/// The rows of the record.
///
/// # Errors
/// The record is not as it should be, or the study is stopped.
pub fn recorded(context: &mut Context) -> Result<Vec<Run>, Failure> {
    Ok(runs::rows(&RECORD.table(context)?, &["cell_m"])?)
}

fn run(context: &mut Context) -> Result<Outcome, Failure> {
    let rows = recorded(context)?;
    let finest = runs::rows(&FINEST.table(context)?, &["cell_m"])?;
    let all: Vec<Run> = rows.iter().chain(&finest).cloned().collect();
    let mut outcome = Outcome { checks: judge(&all, Energy::Kinetic, &|_| true), ..Outcome::default() };
    let mut scatter = String::from(
        "case,quantity,cell_m,mean,deviation,mean_less_deviation,mean_plus_deviation,least,greatest,runs,one_run\n",
    );
    let mut grids = String::from(
        "case,quantity,trend,order,extrapolated,index_10mm_percent,index_5mm_percent,deviation_10mm,uncertainty_10mm,\
         one_run_2.5mm,less_mean_5mm,over_deviation_5mm\n",
    );
    for case in ["40deg", "23deg"] {
        for quantity in QUANTITIES {
            let n = Numerical::of(&rows, case, &|r| r.get(quantity));
            for ((_, cells), s) in CELLS.iter().zip(n.scatter) {
                let own = rows.iter().filter(|r| r.case == case && r.set["cell_m"] == *cells).map(|r| r.get(quantity));
                let least = own.clone().fold(f64::INFINITY, f64::min);
                let greatest = own.fold(f64::NEG_INFINITY, f64::max);
                let numbers =
                    [s.mean, s.deviation, s.mean - s.deviation, s.mean + s.deviation, least, greatest].map(number);
                scatter += &format!("{case},{quantity},{cells},{},{},\n", numbers.join(","), s.count);
            }
            // What one run scatters on these cells is not known; how far it lies from the mean on the next is told in deviations of those.
            let one = finest.iter().find(|r| r.case == case).map_or(f64::NAN, |r| r.get(quantity));
            let [.., next] = n.scatter;
            scatter += &format!("{case},{quantity},{FINEST_CELLS},,,,,,,1,{}\n", number(one));
            let o = n.order;
            let numbers = [
                o.order,
                o.extrapolated,
                100.0 * o.index[0],
                100.0 * o.index[1],
                n.scatter[CASE_CELLS].deviation,
                n.uncertainty(),
                one,
                one - next.mean,
                (one - next.mean) / next.deviation,
            ];
            let cells = numbers.map(|x| if x.is_nan() { String::new() } else { number(x) });
            grids += &format!("{case},{quantity},{},{}\n", o.trend.name(), cells.join(","));
        }
    }
    outcome.tables.push(("flume_baseline_scatter".into(), scatter));
    outcome.tables.push(("flume_baseline_grids".into(), grids));
    Ok(outcome)
}

const SCATTER: Curves = Curves {
    x: "cell_m",
    x_title: "cell size (m)",
    y_title: "force (N)",
    curves: &[
        Curve { column: "mean", label: "mean of nine runs", exact: false },
        Curve { column: "one_run", label: "one run: its scatter is not known", exact: false },
        Curve { column: "mean_less_deviation", label: "one standard deviation", exact: true },
        Curve { column: "mean_plus_deviation", label: "one standard deviation", exact: true },
    ],
    panels: &[
        panel("static force, 40 degrees", &[("case", "40deg"), ("quantity", "static_force_n")]),
        panel("static force, 23 degrees", &[("case", "23deg"), ("quantity", "static_force_n")]),
        panel("largest force over 20 ms, 40 degrees", &[("case", "40deg"), ("quantity", "peak_20ms_n")]),
        panel("largest force over 20 ms, 23 degrees", &[("case", "23deg"), ("quantity", "peak_20ms_n")]),
    ],
    ..Curves::LINEAR
};

fn draw(folder: &Path) -> Result<Vec<String>, PlotError> {
    let name = "flume_baseline_plot.svg";
    curves::draw(folder.join("flume_baseline_scatter.csv"), &SCATTER, folder.join(name))?;
    Ok(vec![name.into()])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grid(of: impl Fn(f64) -> f64, scatter: f64) -> Vec<Run> {
        let runs = CELLS.iter().flat_map(|&(h, cells)| {
            [-scatter, 0.0, scatter].map(|shift| {
                let mut run = Run::with("40deg", "axis", "", &[("static_force_n", of(h) + shift)]);
                run.set.insert("cell_m".into(), cells.into());
                run
            })
        });
        runs.collect()
    }

    #[test]
    fn uncertainty_is_that_of_the_grid_and_of_the_scatter() {
        let force = |r: &Run| r.get("static_force_n");
        // Second order: 1 % at 10 mm, whose index is 1.25 % at two standard deviations.
        let n = Numerical::of(&grid(|h| 100.0 * (1.0 + 100.0 * h * h), 0.0), "40deg", &force);
        assert!((n.order.order - 2.0).abs() < 1e-6 && (n.order.extrapolated - 100.0).abs() < 1e-9);
        assert!((n.uncertainty() - 0.625).abs() < 1e-6, "{}", n.uncertainty());
        // No order: half of the range, evenly spread, and the scatter.
        let n = Numerical::of(&grid(|h| if h == 0.01 { 106.0 } else { 100.0 }, 2.0), "40deg", &force);
        assert!((n.uncertainty() - (3.0f64 / 3f64.sqrt()).hypot(2.0)).abs() < 1e-9);
        assert_eq!(n.scatter.map(|s| s.count), [3; 3]);
    }
}

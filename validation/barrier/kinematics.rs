//! Barriers that move by their material points and by the nodes of a mesh of their own: does the flow feel the difference?
//!
//! Runs come in pairs, on the same grid and with the same packing. What a stiff barrier holds at rest under the literal release is not a
//! number but a spread: it swings back into the sand that has filled the wedge of 30 degrees between bed and barrier, and a wedge
//! that is narrower than the two angles of friction together, 2 atan 0.4 = 43.6 degrees, holds whatever it was squeezed with. So the
//! force at rest is shown with its least and largest value and judged by nothing. The largest are those of the grid with a line through
//! the barrier's foot, where no sand gets into the barrier.

use super::records::KINEMATICS;
use crate::balances::Balances;
use crate::runs::Run;
use crate::scatter::Scatter;
use crate::{Context, Failure, Validation};
use checkdam::check::{Check, Kind};
use checkdam::plot::PlotError;
use checkdam_verification::Outcome;
use checkdam_verification::report::number;
use std::path::Path;

/// The analysis of the recorded runs.
pub const VALIDATION: Validation = Validation {
    name: "barrier_kinematics",
    title: "Barriers of points and of meshes: the same force, and how far the force at rest scatters",
    study: "48 runs, about 10 minutes",
    run,
    draw: |_: &Path| -> Result<Vec<String>, PlotError> { Ok(Vec::new()) },
    covers: &[],
};

const POINTS: &str = "updated_lagrangian";
const MESH: &str = "total_lagrangian";
/// Cell size of all runs, m.
const CELL: f64 = 0.02;

/// What is compared, and what the two may differ by, as a share, besides the chance of the pairs.
const COMPARED: [(&str, f64, &str); 3] = [
    ("peak_20ms_n", 0.02, "2 %, as for steps of equal length (`barrier_steps`)"),
    // 4 x 0.25 h / L and 0.3 / n^2 with five cells through the depth.
    (
        "tip_max_m",
        0.045,
        "a clamp that is off by a quarter of a cell, and the bending of points of five cells (`barrier_beam`)",
    ),
    ("arrival_s", 0.005, "the barrier cannot be felt before the arrival; steps differ"),
];

/// Runs of a barrier in one way, in the order of their grids.
fn of<'a>(runs: &'a [(f64, Run)], stiffness: f64, way: &'a str) -> impl Iterator<Item = &'a Run> + Clone {
    runs.iter().filter(move |(n, r)| *n == stiffness && r.set["kinematics"] == way).map(|(_, r)| r)
}

/// Mesh over points, run by run.
fn ratios(runs: &[(f64, Run)], stiffness: f64, quantity: &str) -> Scatter {
    let same = |own: &Run| of(runs, stiffness, POINTS).find(|r| r.replicate == own.replicate);
    Scatter::of(of(runs, stiffness, MESH).filter_map(|own| Some(own.get(quantity) / same(own)?.get(quantity))))
}

fn run(context: &mut Context) -> Result<Outcome, Failure> {
    let mut outcome = Outcome::default();
    let runs = KINEMATICS.by_stiffness(context)?;
    let mut stiffnesses: Vec<(f64, &str)> = runs.iter().map(|(n, r)| (*n, r.set["stiffness_1"].as_str())).collect();
    stiffnesses.dedup();
    let mut pairs =
        String::from("stiffness_1,quantity,points,points_deviation,mesh,mesh_deviation,ratio_1,ratio_error_1,pairs\n");
    let mut rest = String::from(
        "stiffness_1,kinematics,static_least_n,static_median_n,static_largest_n,\
         energy_residual_1,penetration_cells,gap_cells,runs\n",
    );
    for &(n, cell) in &stiffnesses {
        for (quantity, allowed, why) in COMPARED {
            let ratio = ratios(&runs, n, quantity);
            let scatter = [POINTS, MESH].map(|way| Scatter::of(of(&runs, n, way).map(|r| r.get(quantity))));
            let numbers =
                scatter.iter().flat_map(|s| [s.mean, s.deviation]).chain([ratio.mean, ratio.standard_error()]);
            let numbers = numbers.map(number).collect::<Vec<_>>().join(",");
            pairs += &format!("{cell},{quantity},{numbers},{}\n", ratio.count);
            outcome.checks.push(
                Check::at_most(
                    format!("n = {cell}: {quantity} of a mesh over that of points, less one"),
                    (ratio.mean - 1.0).abs(),
                    allowed + 2.0 * ratio.standard_error(),
                    "1",
                )
                .because(format!("{why}, and two standard errors of {} pairs", ratio.count))
                .from(Kind::Golden, "the same barrier in other kinematics"),
            );
        }
        for way in [POINTS, MESH] {
            let mut forces: Vec<f64> = of(&runs, n, way).map(|r| r.get("static_force_n")).collect();
            forces.sort_by(f64::total_cmp);
            let median = 0.5 * (forces[(forces.len() - 1) / 2] + forces[forces.len() / 2]);
            let b = Balances::over(of(&runs, n, way), |_| CELL);
            let worst = [b.energy, b.penetration, b.gap.unwrap_or(f64::NAN)];
            let ends = [forces[0], median, forces[forces.len() - 1]].into_iter().chain(worst).map(number);
            let ends = ends.collect::<Vec<_>>().join(",");
            rest += &format!("{cell},{way},{ends},{}\n", forces.len());
        }
    }
    // Barriers of points on these cells tear, and the softest lets sand deeper into it than a cell: the runs say so, and the table does.
    let judged = runs.iter().filter(|(n, r)| r.set["kinematics"] == MESH && *n > stiffnesses[0].0).map(|(_, r)| r);
    let balances = Balances::over(judged, |_| CELL);
    outcome.checks.extend(balances.checks("meshes but the softest: ", "ledgers and gauges of all runs"));
    outcome.tables.push(("barrier_kinematics_pairs".into(), pairs));
    outcome.tables.push(("barrier_kinematics_rest".into(), rest));
    Ok(outcome)
}

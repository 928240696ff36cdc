//! The barrier of the study without the flow: is the body that leans over the grid as stiff, and does it swing as fast, as a beam?
//!
//! A small uniform acceleration square to its face is switched on; the tip then swings between nothing and twice its deflection at rest.
//! The mean over the first period and the period itself are compared with Timoshenko's beam. The clamp holds nodes of a grid that is turned
//! by 60 degrees against it, so where the beam begins is known to a part of a cell. A foot that is deeper by d makes the deflection larger
//! by 4 d/L and the period longer by 2 d/L. A row of nodes is off by up to half a cell; along the clamp the rows take turns, and a quarter
//! of a cell is allowed for what is left. Moved grids show it.

use super::records::{LITERAL, height, read_case};
use crate::{Context, Failure, Validation};
use checkdam::case::parse;
use checkdam::check::{Check, Kind, Tolerance};
use checkdam::plot::PlotError;
use checkdam::plot::curves::{self, Curve, Curves};
use checkdam::run::scene;
use checkdam::simulation::Simulation;
use checkdam::theory::cantilever::Cantilever;
use checkdam::theory::elastic::Elastic;
use checkdam_verification::report::number;
use checkdam_verification::{FaultKind, Outcome};
use std::path::Path;

/// The comparison.
pub const VALIDATION: Validation = Validation {
    name: "barrier_beam",
    title: "The barrier alone, leaning over the grid: stiffness and first frequency of a beam",
    study: "",
    run,
    draw,
    covers: &[(FaultKind::Modulus, 1.04)],
};

/// Deflection of the tip at rest that the acceleration is chosen for, m.
const DEFLECTION: f64 = 5e-4;
/// Cell sizes, m; that of the study, on which faults are looked for, is the last.
const CELLS: [f64; 2] = [0.02, 0.01];
/// Where the nodes of the coarse cells lie, in cells.
const OFFSETS: [[f64; 2]; 5] = [[0.0, 0.0], [0.2, 0.6], [0.4, 0.2], [0.6, 0.8], [0.8, 0.4]];
/// What of a cell the foot may be off on one grid.
const FOOT: f64 = 0.25;

/// What a cell size gives: mean deflection over one period over that at rest, period over the beam's; the swing as (time, deflection).
struct Swing {
    deflection: f64,
    period: f64,
    path: Vec<(f64, f64)>,
    /// Height of the face, m.
    height: f64,
}

fn swing(cell: f64, offset: [f64; 2], modulus: f64, context: &mut Context) -> Result<Swing, Failure> {
    let text = read_case(LITERAL).map_err(|e| Failure::Record(e.to_string()))?;
    let mut case = parse(&text, LITERAL).map_err(|e| Failure::Record(e.to_string()))?.case;
    case.grid.spacing_m = cell;
    case.grid.origin_m = offset.map(|o| o * cell);
    let height = height(&case);
    case.bodies.retain(|b| b.name == "barrier");
    case.boundaries.retain(|b| b.name == "clamp");
    case.contacts.clear();
    case.bodies[0].weightless = false;
    let depth = case.bodies[0].size_m()[0];
    let counts = case.bodies[0].particle_counts(&case.grid);
    // A beam of the true modulus; the fault is in what is simulated.
    let m = &case.materials["barrier"];
    let elastic = Elastic { young: m.young_pa, poisson: m.poisson };
    let beam =
        Cantilever { elastic, density: m.density_kg_per_m3, length: height, depth, width: case.grid.thickness_m };
    let per_acceleration = beam.density * depth * beam.width;
    let top = height - 0.5 * case.bodies[0].particle_spacing_m(&case.grid);
    let acceleration = DEFLECTION / beam.under_load(per_acceleration, top);
    // Gravity against the normal of the face, which is turned from the x axis as the barrier is, points into the barrier.
    let inclination = case.bodies[0].rotation_deg - 90.0;
    (case.gravity.inclination_deg, case.gravity.settle_inclination_deg) = (inclination, Some(inclination));
    case.gravity.magnitude_m_per_s2 = acceleration;
    if let Some(m) = case.materials.get_mut("barrier") {
        m.young_pa *= modulus;
    }
    let mut simulation = Simulation::new(scene::build(&case));
    let rows = counts[1] as usize;
    let tip = |simulation: &Simulation| {
        let top = simulation.points_of(0).filter(|p| p.id as usize % rows == rows - 1);
        let (sum, count) = top.fold(([0.0; 2], 0.0), |(s, n), p| ([s[0] + p.x[0], s[1] + p.x[1]], n + 1.0));
        [sum[0] / count, sum[1] / count]
    };
    let start = tip(&simulation);
    let angle = case.bodies[0].rotation_deg.to_radians();
    let normal = [libm::cos(angle), libm::sin(angle)];
    let expected = 2.0 * std::f64::consts::PI / beam.frequency();
    let mut path = vec![(0.0, 0.0)];
    while simulation.time() < 1.1 * expected {
        simulation.step().map_err(|e| Failure::Step(Box::new(e)))?;
        if simulation.steps().is_multiple_of(10) {
            let now = tip(&simulation);
            path.push((simulation.time(), -(now[0] - start[0]) * normal[0] - (now[1] - start[1]) * normal[1]));
            if !(context.progress)(&format!("cells of {} mm: {:.2} s", 1e3 * cell, simulation.time())) {
                return Err(Failure::Stopped);
            }
        }
    }
    let (period, mean) = first_period(&path, expected);
    Ok(Swing { deflection: mean / DEFLECTION, period: period / expected, path, height })
}

/// Period from the lowest point after half of the expected one, by a parabola through the samples within a tenth of a period of it, and
/// the mean up to there.
fn first_period(path: &[(f64, f64)], expected: f64) -> (f64, f64) {
    let late = path.iter().filter(|p| p.0 > 0.5 * expected);
    let lowest = late.fold((0.0, f64::INFINITY), |a, p| if p.1 < a.1 { *p } else { a });
    let near: Vec<(f64, f64)> =
        path.iter().filter(|p| (p.0 - lowest.0).abs() < 0.1 * expected).map(|p| (p.0 - lowest.0, p.1)).collect();
    // Least squares for a + b t + c t^2.
    let power = |k: i32| near.iter().map(|p| p.0.powi(k)).sum::<f64>();
    let with = |k: i32| near.iter().map(|p| p.0.powi(k) * p.1).sum::<f64>();
    let matrix = nalgebra::Matrix3::from_fn(|i, j| power((i + j) as i32));
    let right = nalgebra::Vector3::from_fn(|i, _| with(i as i32));
    let fit = matrix.lu().solve(&right).unwrap_or_default();
    let period = lowest.0 - 0.5 * fit[1] / fit[2];
    let inside = path.windows(2).filter(|w| w[1].0 <= period);
    let area: f64 = inside.map(|w| 0.5 * (w[0].1 + w[1].1) * (w[1].0 - w[0].0)).sum();
    (period, area / period)
}

fn run(context: &mut Context) -> Result<Outcome, Failure> {
    let mut outcome = Outcome::default();
    let mut table = String::from("cell_m,origin_x_cells,origin_y_cells,deflection_over_beam_1,period_over_beam_1\n");
    let mut path = String::from("cell_m,time_s,deflection_over_rest_1\n");
    let ([coarse, fine], modulus) = (CELLS, context.fault.modulus);
    let (mut moved, mut height) = (Vec::new(), f64::NAN);
    let grids = OFFSETS.map(|o| (coarse, o)).into_iter().chain([(fine, [0.0; 2])]);
    for (cell, offset) in grids.filter(|g| modulus == 1.0 || g.0 == fine) {
        let s = swing(cell, offset, modulus, context)?;
        height = s.height;
        let [x, y] = offset;
        table += &format!("{cell},{x},{y},{},{}\n", number(s.deflection), number(s.period));
        if offset == [0.0; 2] {
            for (t, w) in s.path.iter().step_by(10) {
                path += &format!("{cell},{},{}\n", number(*t), number(w / DEFLECTION));
            }
        }
        if cell == coarse {
            moved.push([s.deflection, s.period]);
            continue;
        }
        let share = FOOT * cell / height;
        outcome.checks.push(check("cells of 10 mm: deflection at rest", s.deflection, 4.0 * share, cell));
        outcome.checks.push(check("cells of 10 mm: first period", s.period, 2.0 * share, cell));
    }
    if !moved.is_empty() {
        let count = moved.len() as f64;
        let mean = |k: usize| moved.iter().map(|m| m[k]).sum::<f64>() / count;
        let share = FOOT * coarse / height / count.sqrt();
        let names = [
            "cells of 20 mm, mean of five grids: deflection at rest",
            "cells of 20 mm, mean of five grids: first period",
        ];
        outcome.checks.push(check(names[0], mean(0), 4.0 * share, coarse));
        outcome.checks.push(check(names[1], mean(1), 2.0 * share, coarse));
    }
    outcome.tables.push(("barrier_beam_grids".into(), table));
    outcome.tables.push(("barrier_beam_swing".into(), path));
    Ok(outcome)
}

/// A quantity over that of the beam; `foot` is what a foot that is off makes of it, to which the bending of `n` cells through the depth
/// of 0.1 m comes (rung `cantilever`).
fn check(what: &str, measured: f64, foot: f64, cell: f64) -> Check {
    let n = 0.1 / cell;
    Check::value(format!("{what} over that of the beam"), measured, 1.0, "1")
        .within(
            Tolerance::Absolute(foot + 0.3 / (n * n)),
            "a foot that is off by a quarter of a cell, on the mean of N grids by that over the root of N, and 0.3/n^2",
        )
        .from(Kind::Analytic, "Timoshenko 1921 with E/(1 - nu^2), shear coefficient of Cowper 1966; Huang 1961")
}

const SWING: Curves = Curves {
    x: "time_s",
    x_title: "time (s)",
    y_title: "deflection of the tip over that at rest",
    curves: &[Curve { column: "deflection_over_rest_1", label: "", exact: false }],
    split: &[("cell_m", "cell size in m: ")],
    ..Curves::LINEAR
};

fn draw(folder: &Path) -> Result<Vec<String>, PlotError> {
    let name = "barrier_beam_plot.svg";
    curves::draw(folder.join("barrier_beam_swing.csv"), &SWING, folder.join(name))?;
    Ok(vec![name.into()])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_swing_gives_its_period_and_its_mean() {
        let path: Vec<(f64, f64)> =
            (0..1100).map(|k| f64::from(k) * 1e-3).map(|t| (t, 0.3 * (1.0 - libm::cos(6.5 * t)))).collect();
        let (period, mean) = first_period(&path, 1.0);
        let exact = 2.0 * std::f64::consts::PI / 6.5;
        assert!((period / exact - 1.0).abs() < 2e-3 && (mean / 0.3 - 1.0).abs() < 2e-3, "{period} {mean}");
    }
}

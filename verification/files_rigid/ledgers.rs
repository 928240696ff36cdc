//! The tables against each other: energy and momentum add up, and what gauges read step by step is what the ledgers booked.

use super::judge::{Judge, WRITTEN, within};
use super::setting::{BoundaryOf, Setting, dot};
use crate::from_file::{Files, count, largest};

/// Sums of numbers with nine digits.
const SUMS: f64 = 1e-7;
const NEWTON: &str = "Newton's second law: impulses are forces over time";
const DIGITS: &str = "both are sums of numbers that are written with nine digits";

pub fn judge(set: &Setting, files: &Files, judge: &mut Judge) {
    energy(set, files, judge);
    times(files, judge);
    momentum(set, files, judge);
    for (k, name) in set.barriers.iter().enumerate() {
        let Some(b) = set.boundary(name) else { continue };
        let file = if k == 0 { "history.csv".to_string() } else { format!("history_{name}.csv") };
        forces(set, b, files, &file, ["force_normal_n", "force_tangential_n"], -1.0, judge);
        if b.height.is_finite() {
            profile(set, files, &file, (k, b), judge);
        }
        let [mean, most] = ["force_normal_n", "force_normal_max_n"].map(|c| files.column(&file, c));
        // Never below the mean of its steps.
        let under: Vec<f64> =
            mean.iter().zip(&most).map(|(a, b)| if *a <= 0.0 { 0.0 } else { a * (1.0 - WRITTEN) - b }).collect();
        let below = count(&under, |x| *x > 0.0);
        judge.at_most("rows whose largest step is below their mean", below, 0.0, "a mean lies below the largest");
    }
    for (k, name) in set.bases.iter().enumerate() {
        let Some(b) = set.boundary(name) else { continue };
        let file = if k == 0 { "history.csv".to_string() } else { format!("base_{name}.csv") };
        let along = if set.way() * b.tangent[0] < -1e-9 { -1.0 } else { 1.0 };
        forces(set, b, files, &file, ["base_normal_n", "base_friction_n"], along, judge);
    }
}

/// What was there at release is there, or was dissipated, or left.
fn energy(set: &Setting, files: &Files, judge: &mut Judge) {
    let column = |name: &str| files.column("energy.csv", name);
    let own = |kind: &'static str| set.boundaries.iter().map(move |b| format!("{kind}_{}_j", b.name));
    let fixed = ["kinetic", "gravitational", "elastic", "plastic", "pic", "damping", "side_walls", "outflow"];
    let names = fixed.iter().map(|n| format!("{n}_j")).chain(own("friction")).chain(own("contact"));
    let columns: Vec<Vec<f64>> = names.map(|n| column(&n)).collect();
    let residual = column("residual_j");
    let sum =
        |k: usize, of: fn(f64) -> f64| columns.iter().map(|c| of(c.get(k).copied().unwrap_or(f64::NAN))).sum::<f64>();
    let left: Vec<f64> = (0..residual.len()).map(|k| sum(0, |x| x) - sum(k, |x| x)).collect();
    let scale = (0..residual.len()).map(|k| sum(k, f64::abs)).fold(0.0, f64::max);
    judge.near(
        "energy.csv: residual against what its columns leave",
        &residual,
        &left,
        scale,
        within(WRITTEN, DIGITS, "conservation of energy"),
    );
    let open = largest(residual.iter().copied()) / scale;
    judge.at_most("energy.csv: residual over all columns", open, 0.005,
        "half a percent: a block of elastic stuff loses it where it strikes, its stress being a rate law at 1.5 % of strain");
}

/// Rows of all tables of samples end together.
fn times(files: &Files, judge: &mut Judge) {
    let own = |name: &&String| {
        ["history_", "base_", "window_"].iter().any(|start| name.starts_with(start)) && name.ends_with(".csv")
    };
    for name in files.names().iter().filter(own) {
        let (found, made) = (files.column(name, "time_s"), files.column("history.csv", "time_s"));
        judge.same(
            "times of further tables against history.csv",
            &found,
            &made,
            within(0.0, "the same numbers", "the same rows"),
        );
    }
}

/// Momentum is what all agents gave.
fn momentum(set: &Setting, files: &Files, judge: &mut Judge) {
    let column = |name: &str| files.column("momentum.csv", name);
    let time = column("time_s");
    let leaves = column("outflow_x_n_s").iter().any(|p| *p != 0.0);
    for (d, axis) in ["x", "y"].into_iter().enumerate() {
        let get = |name: &str| column(&format!("{name}_{axis}_n_s"));
        let [gained, gravity, outflow, residual] = ["gained", "gravity", "outflow", "residual"].map(get);
        let agents = set.boundaries.iter().map(|b| b.name.as_str()).chain(["gravity", "damping", "side_walls"]);
        let agents: Vec<Vec<f64>> = agents.map(get).chain([outflow]).collect();
        let value = |c: &Vec<f64>, k: usize| c.get(k).copied().unwrap_or(f64::NAN);
        let given: Vec<f64> = (0..time.len()).map(|k| agents.iter().map(|c| value(c, k)).sum()).collect();
        let fastest = set.bodies.iter().map(|b| b.v[0].hypot(b.v[1])).fold(0.0, f64::max);
        let scale = set.mass() * (set.gravity * time.last().copied().unwrap_or(f64::NAN) + fastest);
        let what = "momentum.csv: gained against all impulses, over the weight's";
        judge.near(what, &gained, &given, scale, within(SUMS, DIGITS, "conservation of momentum"));
        let open = largest(residual.iter().copied()) / scale;
        judge.at_most(
            "momentum.csv: residual over the weight's impulse",
            open,
            1e-11,
            "round-off of some thousand steps",
        );
        judge.at_most(
            "damping after the release",
            get("damping").iter().map(|p| p.abs()).sum::<f64>(),
            0.0,
            "damping ends with settling",
        );
        if !leaves {
            let weight: Vec<f64> = time.iter().map(|t| set.mass() * set.g()[d] * t).collect();
            judge.same(
                "momentum.csv: gravity against m g t",
                &gravity,
                &weight,
                within(SUMS, "nine digits of the time", NEWTON),
            );
        }
    }
}

/// Forces over time against impulses, at every row of the ledger. A gauge has the force along the tangent `along` times.
fn forces(set: &Setting, b: &BoundaryOf, files: &Files, file: &str, columns: [&str; 2], along: f64, judge: &mut Judge) {
    let time = files.column(file, "time_s");
    let [normal, tangential] = columns.map(|c| impulses(&time, &files.column(file, c)));
    let ledger = |name: &str| files.column("momentum.csv", name);
    let ends = ledger("time_s");
    let [px, py] = ["x", "y"].map(|axis| ledger(&format!("{}_{axis}_n_s", b.name)));
    let booked = |k: usize, way: [f64; 2]| dot([px[k], py[k]], way);
    let rows: Vec<usize> = (0..ends.len().min(px.len()).min(py.len())).filter(|k| ends[*k] > 0.0).collect();
    let at = |sums: &[f64]| -> Vec<f64> {
        let found = |k: &usize| row_at(&time, ends[*k]).and_then(|row| sums.get(row).copied()).unwrap_or(f64::NAN);
        rows.iter().map(found).collect()
    };
    let scale = set.mass() * set.gravity * ends.last().copied().unwrap_or(f64::NAN);
    let what = |of: &str| {
        format!(
            "{} of {} over time against momentum.csv",
            of,
            if columns[0].starts_with("base") { "a base" } else { "a barrier" }
        )
    };
    let expected = |way: [f64; 2], sign: f64| rows.iter().map(|k| sign * booked(*k, way)).collect::<Vec<_>>();
    judge.near(&what("normal force"), &at(&normal), &expected(b.normal, 1.0), scale, within(SUMS, DIGITS, NEWTON));
    judge.near(
        &what("force along"),
        &at(&tangential),
        &expected(b.tangent, along),
        scale,
        within(SUMS, DIGITS, NEWTON),
    );
}

/// Sums of a force over the rows until each of them.
fn impulses(time: &[f64], force: &[f64]) -> Vec<f64> {
    let (mut sum, mut before) = (0.0, 0.0);
    let add = |(t, f): (&f64, &f64)| {
        sum += f * (t - before);
        before = *t;
        sum
    };
    time.iter().zip(force).map(add).collect()
}

/// The row that ends at this time.
pub fn row_at(times: &[f64], time: f64) -> Option<usize> {
    times.iter().position(|t| (t - time).abs() <= WRITTEN * time.abs().max(0.01))
}

/// Force and moment of a pressure profile against their means over its interval.
fn profile(set: &Setting, files: &Files, history: &str, (number, wall): (usize, &BoundaryOf), judge: &mut Judge) {
    let file =
        if number == 0 { "pressure_profile.csv".to_string() } else { format!("pressure_profile_{}.csv", wall.name) };
    let [ends, heights, pressures] = ["time_s", "height_m", "pressure_pa"].map(|c| files.column(&file, c));
    let time = files.column(history, "time_s");
    let [force, moment] =
        ["force_normal_n", "overturning_moment_n_m"].map(|c| impulses(&time, &files.column(history, c)));
    let mut times: Vec<f64> = Vec::new();
    ends.iter().for_each(|t| {
        if times.last() != Some(t) {
            times.push(*t)
        }
    });
    let (mut before, mut found) = ([0.0, 0.0, 0.0], [const { Vec::new() }; 4]);
    for t in times {
        let bins: Vec<usize> = (0..ends.len()).filter(|k| ends[*k] == t).collect();
        let (first, last) = (bins.first().copied(), bins.last().copied());
        let thickness = |k: &usize| if Some(*k) == first || Some(*k) == last { 0.5 * set.h } else { set.h };
        let sum = |arm: &dyn Fn(usize) -> f64| {
            bins.iter().map(|k| pressures[*k] * thickness(k) * set.width * arm(*k)).sum::<f64>()
        };
        let row = row_at(&time, t);
        let now = [t, row.map_or(f64::NAN, |r| force[r]), row.map_or(f64::NAN, |r| moment[r])];
        let mean = |d: usize| (now[d] - before[d]) / (now[0] - before[0]);
        [sum(&|_| 1.0), mean(1), sum(&|k| heights[k]), mean(2)]
            .into_iter()
            .zip(&mut found)
            .for_each(|(x, list)| list.push(x));
        before = now;
    }
    let why = "bins of nine digits; a bin keeps force and moment of what acts in it";
    let weight = set.mass() * set.gravity;
    judge.near(
        "pressure_profile.csv: its force against the mean force",
        &found[0],
        &found[1],
        weight,
        within(SUMS, why, "definition of pressure"),
    );
    judge.near(
        "pressure_profile.csv: its moment against the mean moment",
        &found[2],
        &found[3],
        weight * wall.height,
        within(SUMS, why, "definition of pressure"),
    );
}

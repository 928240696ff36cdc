//! What the summary says of a deposit at rest, made anew from tables and case.

use super::judge::{Judge, within};
use super::rows::{DEFINED, EDGE, FROM_TABLES, ROWS, STATIC, late, pick};
use super::setting::{BoundaryOf, Setting, at, dot};
use crate::from_file::Files;

/// Equilibrium along the base.
pub fn judge(set: &Setting, files: &Files, judge: &mut Judge) {
    let Some(base) = set.bases.first().and_then(|name| set.boundary(name)).filter(|_| files.has("deposit")) else {
        return;
    };
    let time = files.column("history.csv", "time_s");
    let mean = |name: &str| late(&time, &files.column("history.csv", name), 0.0, 1.0);
    let (normal, friction) = (mean("base_normal_n"), mean("base_friction_n"));
    let along = if set.way() * base.tangent[0] < -1e-9 { -1.0 } else { 1.0 };
    let weight = set.mass() * along * dot(set.g(), base.tangent);
    let across = -set.mass() * dot(set.g(), base.normal);
    let rest = find_number(set, base, "static_friction").unwrap_or(base.friction) * normal;
    let ends = files.column("momentum.csv", "time_s");
    let last = ends.len() - 1;
    let start = ends.iter().position(|t| *t >= ends[last] - STATIC * (1.0 + 1e-9)).unwrap_or(0);
    let mean_of = |agent: &str| {
        let get = |axis: &str, row: usize| pick(&files.column("momentum.csv", &format!("{agent}_{axis}_n_s")), row);
        let change = ["x", "y"].map(|axis| get(axis, last) - get(axis, start));
        along * dot(change, base.tangent) / (ends[last] - ends[start])
    };
    let others = set.boundaries.iter().filter(|b| b.name != base.name);
    let held: f64 = -others.map(|b| mean_of(&b.name)).sum::<f64>();
    let sides = mean_of("side_walls");
    let mut same = |name: &str, made: f64, scale: f64, share: f64| {
        judge.near(
            &format!("deposit.{name} against tables and case"),
            &[files.number(&format!("deposit.{name}"))],
            &[made],
            scale.abs(),
            within(share, FROM_TABLES, DEFINED),
        );
    };
    same("weight_along_n", weight, weight, 1e-9);
    same("theoretical_static_force_n", weight - base.friction * across, weight, 1e-9);
    same("base_normal_n", normal, normal, EDGE);
    same("base_friction_n", friction, friction, EDGE);
    same("side_walls_n", sides, sides, ROWS * 10.0);
    same("friction_limit_n", rest, rest, EDGE);
    same("mobilised_1", if rest > 0.0 { friction / rest } else { 0.0 }, 1.0, EDGE);
    same("held_along_flume_n", held, held, ROWS * 10.0);
    same("equilibrium_residual_n", weight + friction + sides - held, weight, EDGE);
    if files.has("deposit.equilibrium_limits_n") {
        same("equilibrium_limits_n.0", weight - rest, weight, EDGE);
        same("equilibrium_limits_n.1", weight + rest, weight, EDGE);
    }
}

fn find_number(set: &Setting, of: &BoundaryOf, key: &str) -> Option<f64> {
    let k = set.boundaries.iter().position(|b| b.name == of.name)?;
    at(&set.case, &format!("boundaries.{k}.{key}"))
}

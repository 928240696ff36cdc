//! The inputs as the summary repeats them, and the outlines of the boundaries.

use super::judge::{Judge, WRITTEN, within};
use super::setting::{Setting, at, find};
use crate::from_file::{Files, leaves};
use toml::Value;

/// What is left out of a case is what its reference says.
const DEFAULTS: &[(&str, f64)] = &[
    ("magnitude_m_per_s2", 9.81),
    ("particles_per_cell", 4.0),
    ("rotation_deg", 0.0),
    ("jitter", 0.0),
    ("jitter_seed", 0.0),
    ("velocity_m_per_s", 0.0),
    ("origin_m", 0.0),
    ("cfl", 0.3),
    ("pic_fraction", 5e-4),
    ("sample_rate_hz", 1000.0),
    ("vtk_interval_s", 0.02),
    ("inclination_deg", 90.0),
    ("cohesion_pa", 0.0),
    ("dilatancy_angle_deg", 0.0),
    ("tension_cutoff_pa", 0.0),
    // Of the side walls: boundaries have to say theirs.
    ("friction", 0.0),
];

/// The case in the summary against its text.
pub fn repeated(set: &Setting, files: &Files, judge: &mut Judge) {
    let Some(Value::Table(case)) = find(files.summary(), "case").cloned() else {
        judge.at_most("summary without its case", 1.0, 0.0, "the summary repeats its inputs");
        return;
    };
    let (mut numbers, mut made, mut wrong) = (Vec::new(), Vec::new(), 0);
    leaves("", &Value::Table(case.clone()), &mut |key, value| {
        if value.is_str() || value.is_bool() {
            let given = find(&set.case, key);
            wrong += usize::from(given.is_some_and(|g| g != value));
            return;
        }
        // Without the place in a list.
        let plain = match key.rsplit_once('.') {
            Some((list, place)) if place.chars().all(|c| c.is_ascii_digit()) => list,
            _ => key,
        };
        let last = plain.rsplit('.').next().unwrap_or_default();
        let otherwise = match last {
            "settle_inclination_deg" => at(&set.case, "gravity.inclination_deg"),
            "thickness_m" => Some(4.0 * set.h),
            _ => DEFAULTS.iter().find(|d| d.0 == last).map(|d| d.1),
        };
        numbers.push(files.number(&format!("case.{key}")));
        made.push(at(&set.case, key).or(otherwise).unwrap_or(f64::NAN));
    });
    // Nothing that was given is missing.
    leaves("", &Value::Table(set.case.clone()), &mut |key, _| wrong += usize::from(find(&case, key).is_none()));
    let off = |(a, b): (&f64, &f64)| if a == b { 0.0 } else { ((a - b) / b.abs().max(1e-300)).abs() };
    let worst = numbers
        .iter()
        .zip(&made)
        .map(off)
        .fold(0.0, |a: f64, b| if b.is_nan() || a.is_nan() { f64::NAN } else { a.max(b) });
    judge.at_most(
        "case: numbers that are not those given, or their defaults",
        worst,
        0.0,
        "the same digits; docs/reference/case.md",
    );
    judge.at_most("case: words that are not those given", wrong as f64, 0.0, "the same letters");
}

/// Corners of a boundary that stays: of a plane those of a strip two cells deep that crosses the domain.
fn corners(set: &Setting, k: usize) -> Vec<[f64; 2]> {
    let b = &set.boundaries[k];
    let at = |s: f64, d: f64| [0, 1].map(|i| b.foot[i] + s * b.tangent[i] - d * b.normal[i]);
    if b.gate {
        return Vec::new();
    }
    if b.height.is_finite() {
        return vec![at(0.0, 0.0), at(b.height, 0.0), at(b.height, b.thickness), at(0.0, b.thickness)];
    }
    let edge =
        |axis: &str, k: usize| super::setting::at(&set.case, &format!("domain.{axis}_m.{k}")).unwrap_or(f64::NAN);
    let places = [[0, 0], [1, 0], [0, 1], [1, 1]].map(|[i, j]| [edge("x", i), edge("y", j)]);
    let along: Vec<f64> = places.iter().map(|p| b.face(*p)).filter(|[d, _]| *d <= 0.0).map(|[_, s]| s).collect();
    let [low, high] =
        [along.iter().copied().fold(f64::INFINITY, f64::min), along.iter().copied().fold(f64::NEG_INFINITY, f64::max)];
    let deep = 2.0 * set.h;
    vec![at(low, 0.0), at(high, 0.0), at(high, deep), at(low, deep)]
}

/// What the run draws of the boundaries.
pub fn geometry(set: &Setting, files: &Files, judge: &mut Judge) {
    let rows: Vec<(usize, [f64; 2])> =
        (0..set.boundaries.len()).flat_map(|k| corners(set, k).into_iter().map(move |c| (k, c))).collect();
    let (numbers, xs, ys) = (
        rows.iter().map(|r| r.0 as f64).collect::<Vec<_>>(),
        rows.iter().map(|r| r.1[0]).collect::<Vec<_>>(),
        rows.iter().map(|r| r.1[1]).collect::<Vec<_>>(),
    );
    let source = "the case file";
    for (name, made) in [("boundary", &numbers), ("x_m", &xs), ("y_m", &ys)] {
        judge.same(
            &format!("geometry.csv: {name} against the case"),
            &files.column("geometry.csv", name),
            made,
            within(WRITTEN, "nine digits", source),
        );
    }
    let values = |name: &str| files.values(&format!("boundaries.vtp/{name}"));
    for (name, made) in [("Points.x", &xs), ("Points.y", &ys)] {
        judge.same(
            &format!("boundaries.vtp: {name} against the case"),
            &values(name),
            made,
            within(1e-12, "round-off", source),
        );
    }
    let closed: Vec<f64> = numbers.iter().step_by(4).copied().collect();
    judge.same(
        "boundaries.vtp: boundary against the case",
        &values("boundary"),
        &closed,
        within(0.0, "a count", source),
    );
    let mut counted: Vec<f64> = (0..rows.len()).map(|k| k as f64).collect();
    let found = values("connectivity");
    judge.same("boundaries.vtp: corners in order", &found, &counted, within(0.0, "they count", "VTK file formats"));
    counted = (1..=closed.len()).map(|k| 4.0 * k as f64).collect();
    judge.same(
        "boundaries.vtp: four corners a boundary",
        &values("offsets"),
        &counted,
        within(0.0, "they count", "VTK file formats"),
    );
}

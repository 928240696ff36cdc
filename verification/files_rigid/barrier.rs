//! What the summary says of a barrier, made anew from its history.

use super::judge::{Judge, within};
use super::rows::{DEFINED, EDGE, FROM_TABLES, ROWS, late, pick};
use super::setting::Setting;
use crate::from_file::Files;

/// Window of the filtered peak, s.
const PEAK: f64 = 0.02;

/// Start, end and mean of each window of 20 ms that ends with a row.
fn windows(time: &[f64], force: &[f64]) -> Vec<[f64; 3]> {
    let mut first = 0;
    let window = |k: usize| {
        while time[k] - time[first] > PEAK * (1.0 - 1e-9) {
            first += 1;
        }
        [time[first], time[k], force[first..=k].iter().sum::<f64>() / (k + 1 - first) as f64]
    };
    (0..time.len().min(force.len())).map(window).collect()
}

/// Of the barrier with this key in the summary and this table.
pub fn judge(set: &Setting, files: &Files, key: &str, file: &str, judge: &mut Judge) {
    let column = |name: &str| files.column(file, name);
    let number = |name: &str| files.number(&format!("{key}.{name}"));
    let [time, normal, tangential, moment] =
        ["time_s", "force_normal_n", "force_tangential_n", "overturning_moment_n_m"].map(column);
    let scale = normal.iter().fold(0.0, |a: f64, f| a.max(f.abs()));
    let mut near = |name: &str, made: f64, scale: f64, share: f64| {
        // Of a time, what stood in the history then is held against the peak.
        let found = if name.contains(':') { scale } else { number(name) };
        judge.near(
            &format!("barrier.{name} against the history"),
            &[found],
            &[made],
            scale.abs(),
            within(share, FROM_TABLES, DEFINED),
        );
    };
    let mean = |values: &[f64]| late(&time, values, 0.0, 1.0);
    let [force, shear, turning] = [mean(&normal), mean(&tangential), mean(&moment)];
    near("static_force_n", force, force, EDGE);
    near("base_shear_n", force, force, EDGE);
    near("static_shear_n", shear, shear, EDGE);
    near("static_moment_n_m", turning, turning, EDGE);
    let arm = if force > 0.0 { turning / force } else { 0.0 };
    near("static_height_of_action_m", arm, arm, EDGE);
    let drift = late(&time, &normal, 2.0 / 3.0, 1.0) - late(&time, &normal, 0.0, 1.0 / 3.0);
    near("static_force_drift_n", drift, drift.abs().max(1e-7 * scale), 2.0 * EDGE);
    for k in 1..=3 {
        let layer = mean(&column(&format!("force_layer{k}_n")));
        near(&format!("static_layer{k}_n"), layer, layer, EDGE);
    }
    // Peaks.
    let largest = column("force_normal_max_n");
    let peak = largest.iter().fold(0.0, |a: f64, f| a.max(*f));
    near("peak_step_n", peak, peak, ROWS);
    // The row that the time lies in has the peak; a steady force has it everywhere.
    let row = time.iter().position(|t| *t >= number("peak_step_time_s") * (1.0 - 1e-8));
    if peak > 0.0 {
        near(
            "peak_step_time_s: the largest step at that time",
            row.map_or(f64::NAN, |k| pick(&largest, k)),
            peak,
            ROWS,
        );
    }
    let best = windows(&time, &normal)
        .into_iter()
        .filter(|w| w[1] >= PEAK)
        .fold([0.0; 3], |a, w| if w[2] > a[2] { w } else { a });
    near("peak_20ms_n", best[2], best[2], ROWS);
    let middle = number("peak_20ms_time_s");
    let there = windows(&time, &normal).into_iter().filter(|w| (0.5 * (w[0] + w[1]) - middle).abs() < 1e-6);
    if best[2] > 0.0 {
        near("peak_20ms_time_s: the mean at that time", there.map(|w| w[2]).fold(f64::NAN, f64::max), best[2], ROWS);
    }
    near("peak_20ms_by_steps_n", best[2], best[2], 0.01);
    let turned = moment.iter().fold(0.0, |a: f64, m| a.max(*m));
    near("peak_moment_n_m", turned, turned, 0.015);
    // Times and impulses.
    let arrived = time.iter().zip(&normal).find(|(_, f)| **f > files.number("scales.arrival_force_n")).map(|(t, _)| *t);
    if let Some(t) = arrived {
        near("arrival_s", t, t, ROWS);
    }
    let off = |w: &&[f64; 3]| (w[2] - force).abs() > 0.05 * force.abs();
    let settled = windows(&time, &normal).iter().rfind(off).map_or(0.0, |w| w[1]);
    near("time_to_static_s", settled, settled, EDGE);
    let over = |values: &[f64], from: f64, to: f64| {
        let rows = (1..time.len()).filter(|k| time[*k] > from && time[*k] <= to);
        rows.map(|k| values[k] * (time[k] - time[k - 1])).sum::<f64>()
    };
    let first = time.first().copied().unwrap_or(f64::NAN);
    let half = arrived.map_or(0.0, |t| over(&normal, t, t + 0.5));
    near("impulse_half_second_n_s", half, half, EDGE);
    let all = |values: &[f64]| over(values, 0.0, f64::INFINITY) + first * pick(values, 0);
    near("impulse_normal_n_s", all(&normal), all(&normal), 1e-4);
    near("impulse_tangential_n_s", all(&tangential), all(&tangential), 1e-4);
    let most = |name: &str| column(name).iter().fold(0.0, |a: f64, x| a.max(*x));
    near("run_up_m", most("run_up_m"), most("run_up_m"), ROWS);
    near("run_up_p95_m", most("run_up_p95_m"), most("run_up_p95_m"), ROWS);
    for name in ["overtopped_kg", "passed_under_kg", "passed_kg"] {
        let last = column(name).last().copied().unwrap_or(f64::NAN);
        near(name, last, last, ROWS);
    }
    // Against the front that arrived: as it was a row before. What is there from the start has none.
    let before = arrived.and_then(|t| time.iter().position(|x| *x == t)).and_then(|k| k.checked_sub(1));
    let front = |name: &str| before.map_or(f64::NAN, |k| pick(&files.column("history.csv", name), k));
    let (v, section) = (front("front_velocity_m_per_s"), front("front_depth_m") * set.width);
    if v * section > 0.0 {
        let density = set.mass() / (set.area() * set.width);
        let wave = set.bodies.iter().map(super::setting::BodyOf::wave_speed).fold(0.0, f64::max);
        let alpha = number("peak_20ms_by_steps_n") / (density * v * v * section);
        near("peak_20ms_alpha_1", alpha, alpha, ROWS);
        near("elastic_impact_n", density * wave * v * section, density * wave * v * section, ROWS);
    }
}

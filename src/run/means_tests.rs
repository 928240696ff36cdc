//! Reductions of histories that are made up, with answers by hand. Steps of 1/1024 s divide no window: 20 ms are 20.48 of them and reach
//! 21 rows, 0.3 s are 307.2 and reach 308; and sums of whole numbers are exact.

use super::super::{Experiment, barrier};
use super::*;
use crate::case;
use crate::gauge::Passage;

const DT: f64 = 1.0 / 1024.0;

fn row(time: f64, normal: f64) -> HistoryRow {
    HistoryRow { time, normal, ..HistoryRow::default() }
}

/// Rows that end at these times (s) with these forces (N).
fn rows(all: &[(f64, f64)]) -> Vec<HistoryRow> {
    all.iter().map(|&(time, normal)| row(time, normal)).collect()
}

/// So many rows of `DT` each, the force by the number of the row, from 1 on.
fn steps(count: u32, force: impl Fn(u32) -> f64) -> Vec<HistoryRow> {
    (1..=count).map(|k| row(f64::from(k) * DT, force(k))).collect()
}

fn constant(_: u32) -> f64 {
    5.0
}

fn pulse(at: u32, force: f64) -> impl Fn(u32) -> f64 {
    move |k| if k == at { force } else { 0.0 }
}

fn late(history: &[HistoryRow], from: f64, to: f64) -> f64 {
    late_mean(history, from, to, |r| r.normal)
}

#[test]
fn a_late_mean_is_that_of_the_rows_in_its_window() {
    assert_eq!(late(&steps(1024, constant), 0.0, 1.0), 5.0);
    // Rows 717 to 1024 of a ramp, their first third, and their last.
    let ramp = steps(1024, f64::from);
    assert_eq!(late(&ramp, 0.0, 1.0), 870.5);
    assert_eq!(late(&ramp, 0.0, 1.0 / 3.0), 768.0);
    assert_eq!(late(&ramp, 2.0 / 3.0, 1.0), 973.0);
    // A pulse counts in the first row of the window and in the last, and before it does not.
    assert_eq!([716, 717, 1024].map(|at| late(&steps(1024, pulse(at, 308.0)), 0.0, 1.0)), [0.0, 1.0, 1.0]);
    // Rows of any length have one weight each.
    assert_eq!(late(&rows(&[(0.1, 100.0), (0.75, 1.0), (0.95, 2.0), (1.0, 6.0)]), 0.0, 1.0), 3.0);
    // A history shorter than the window, one row, a part of the window without a row, and none.
    assert_eq!(late(&steps(3, f64::from), 0.0, 1.0), 2.0);
    assert_eq!(late(&rows(&[(2.0, 7.0)]), 0.0, 1.0), 7.0);
    assert_eq!(late(&rows(&[(0.0, 1.0), (1.0, 9.0)]), 0.0, 1.0 / 3.0), 9.0);
    assert_eq!(late(&[], 0.0, 1.0), 0.0);
}

#[test]
fn a_peak_is_the_largest_mean_of_a_whole_window() {
    // Mean, and rows between which the middle of its window lies.
    let check = |history: &[HistoryRow], mean: f64, from: f64, to: f64| {
        assert_eq!(smoothed_peak(history), (mean, 0.5 * (from + to)));
    };
    check(&steps(100, constant), 5.0, DT, 21.0 * DT);
    check(&steps(100, f64::from), 90.0, 80.0 * DT, 100.0 * DT);
    // A pulse that is shorter than the window, in its midst, at the end, and before a window has passed.
    check(&steps(100, pulse(50, 21.0)), 1.0, 30.0 * DT, 50.0 * DT);
    check(&steps(100, pulse(100, 42.0)), 2.0, 80.0 * DT, 100.0 * DT);
    check(&steps(100, pulse(1, 21.0)), 1.0, DT, 21.0 * DT);
    // Longer steps: two of 15 ms reach into a window, one of 25 ms is one.
    check(&rows(&[(0.015, 2.0), (0.030, 4.0), (0.045, 9.0)]), 6.5, 0.030, 0.045);
    check(&rows(&[(0.025, 2.0), (0.050, 9.0), (0.075, 4.0)]), 9.0, 0.050, 0.050);
    // Unequal ones: 7 ms and 13 ms and one that is a window.
    check(&rows(&[(0.013, 1.0), (0.020, 3.0), (0.033, 8.0), (0.053, 6.0)]), 6.0, 0.053, 0.053);
    // One row, of a window or less; a pull; none.
    check(&rows(&[(0.05, 3.0)]), 3.0, 0.05, 0.05);
    check(&rows(&[(0.01, 3.0)]), 0.0, 0.0, 0.0);
    check(&steps(100, |_| -1.0), 0.0, 0.0, 0.0);
    check(&[], 0.0, 0.0, 0.0);
}

#[test]
fn an_archive_misses_what_lies_between_its_frames() {
    let history: Vec<_> = (0..100).map(|k| row(1e-3 * (f64::from(k) + 0.3), f64::from(k))).collect();
    // Frames at 20, 40, 60 and 80 ms are the samples at 20.3 ms and so on.
    assert_eq!(archived_peak(&history), 80.0);
    assert_eq!(archived_peak(&history[..80]), 60.0);
    assert_eq!(archived_peak(&rows(&[(1e-3, 5.0)])), 0.0);
    assert_eq!(archived_peak(&[]), 0.0);
    // Row 21 is the first after 20 ms, row 41 after 40 ms, row 82 after 80 ms.
    let of_pulse = |at| archived_peak(&steps(82, pulse(at, 7.0)));
    assert_eq!([20, 21, 22, 40, 41, 61, 62, 81, 82].map(of_pulse), [0.0, 7.0, 0.0, 0.0, 7.0, 0.0, 7.0, 0.0, 7.0]);
    assert_eq!(archived_peak(&rows(&[(0.015, 9.0), (0.045, 4.0), (0.055, 8.0), (0.061, 3.0)])), 4.0);
}

#[test]
fn an_impulse_is_force_times_time_after_its_start_until_its_end() {
    // 512 rows are half a second.
    let (from, to) = (100.0 * DT, 612.0 * DT);
    let of = |force: &dyn Fn(u32) -> f64| impulse(&steps(1024, force), from, to);
    assert_eq!(of(&constant), 2.5);
    assert_eq!(of(&f64::from), 178.25);
    assert_eq!([100, 101, 612, 613].map(|at| of(&pulse(at, 1024.0))), [0.0, 1.0, 1.0, 0.0]);
    let unequal = rows(&[(0.0, 0.0), (0.25, 4.0), (0.75, 8.0), (1.0, 2.0)]);
    assert_eq!(impulse(&unequal, 0.0, 1.0), 5.5);
    assert_eq!(impulse(&unequal, 0.25, 0.75), 4.0);
    assert_eq!(impulse(&rows(&[(0.5, 3.0)]), 0.0, 1.0), 0.0);
    assert_eq!(impulse(&[], 0.0, 1.0), 0.0);
}

#[test]
fn arrival_is_the_first_row_above_the_force() {
    let ramp = steps(100, f64::from);
    assert_eq!(arrival(&ramp, 4.5), Some(5.0 * DT));
    assert_eq!(arrival(&ramp, 5.0), Some(6.0 * DT));
    assert_eq!(arrival(&ramp, 100.0), None);
    assert_eq!(arrival(&[], 0.0), None);
}

#[test]
fn a_force_is_static_from_when_its_mean_stays_near() {
    // A force of 100 N from row 41 on: 19 of 21 rows are 90 N, 20 are 95.2 N, which row 60 reaches first.
    let step = steps(400, |k| if k > 40 { 100.0 } else { 0.0 });
    assert_eq!(time_to_static(&step, 100.0), 59.0 * DT);
    assert_eq!(time_to_static(&steps(400, constant), 5.0), 0.0);
    // A pulse of 5.1 % of the window's sum is off until its last window, one of 4.9 % is not.
    let with_pulse = |more: f64| time_to_static(&steps(400, |k| if k == 200 { 100.0 + more } else { 100.0 }), 100.0);
    assert_eq!((with_pulse(2100.0 * 0.051), with_pulse(2100.0 * 0.049)), (220.0 * DT, 0.0));
    // A pulse at the end: it is not there yet.
    assert_eq!(time_to_static(&steps(400, |k| if k == 400 { 300.0 } else { 100.0 }), 100.0), 400.0 * DT);
    assert_eq!(time_to_static(&rows(&[(0.5, 3.0)]), 3.0), 0.0);
    assert_eq!(time_to_static(&[], 3.0), 0.0);
}

/// Sand before a wall, which is never stepped: what is read of it is made up.
const CASE: &str = r#"
title = "wall"
gravity = { inclination_deg = 30 }
grid = { spacing_m = 0.1, thickness_m = 0.2 }
domain = { x_m = [-0.5, 1.0], y_m = [-0.2, 0.8] }
materials.sand = { law = "drucker_prager", density_kg_per_m3 = 1500, young_pa = 1e6, poisson = 0.3, friction_angle_deg = 31, cone = "triaxial_compression" }
bodies = [{ name = "sand", material = "sand", x_m = [-0.3, 0.0], y_m = [0.0, 0.3] }]
boundaries = [
    { name = "base", kind = "plane", point_m = [0.0, 0.0], normal_deg = 90, contact = "coulomb", friction = 0.3 },
    { name = "wall", kind = "wall", foot_m = [0.6, 0.0], height_m = 0.5, contact = "coulomb", friction = 0.3 },
]
stages.run = { end_time_s = 1.2 }
gauges = { barrier = "wall", base = "base", arrival_force_n = 100.5 }
"#;

#[test]
fn every_number_of_a_barrier_is_of_its_own_column() {
    let case = case::parse(CASE, "wall.toml").unwrap_or_else(|e| panic!("{e}")).case;
    let experiment = Experiment::new(&case);
    let gauge = experiment.barrier().expect("a wall");
    assert!(barrier::results(gauge, &[], experiment.scales()).is_none());
    let ramp = |k: u32, per_row: f64| per_row * f64::from(k);
    let history: Vec<_> = (1..=1024)
        .map(|k| HistoryRow {
            tangential: ramp(k, -2.0),
            moment: ramp(k, 4.0),
            layers: [ramp(k, 8.0), ramp(k, 16.0), ramp(k, 32.0)],
            run_up: if k == 500 { 0.5 } else { 0.25 },
            run_up_p95: if k == 300 { 0.4 } else { 0.2 },
            passage: Passage { over: ramp(k, 1.0), under: ramp(k, 2.0), past: ramp(k, 4.0) },
            ..row(f64::from(k) * DT, ramp(k, 1.0))
        })
        .collect();
    let b = barrier::results(gauge, &history, experiment.scales()).expect("a history");
    let mean = 870.5;
    assert_eq!((b.static_force_n, b.base_shear_n, b.static_shear_n), (mean, mean, -2.0 * mean));
    assert_eq!((b.static_moment_n_m, b.static_height_of_action_m), (4.0 * mean, 4.0));
    assert_eq!([b.static_layer1_n, b.static_layer2_n, b.static_layer3_n], [8.0, 16.0, 32.0].map(|x| x * mean));
    assert_eq!(b.static_force_drift_n, 973.0 - 768.0);
    assert_eq!((b.peak_20ms_n, b.peak_20ms_time_s), (1014.0, 1014.0 * DT));
    // It arrives with row 101; rows 102 to 613 are the half second after.
    assert_eq!((b.arrival_s, b.impulse_half_second_n_s), (Some(101.0 * DT), 178.75));
    assert_eq!((b.run_up_m, b.run_up_p95_m), (0.5, 0.4));
    assert_eq!((b.overtopped_kg, b.passed_under_kg, b.passed_kg), (1024.0, 2048.0, 4096.0));
    // The gauge has seen no step.
    assert_eq!((b.peak_step_n, b.peak_20ms_by_steps_n, b.impulse_normal_n_s), (0.0, 0.0, 0.0));
}

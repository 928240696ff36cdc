//! How a barrier is bent, by four files that must agree: samples of its tip, profiles of its face, its outline, its points in the VTK
//! frames. And the pressure on it against the force on it.

use super::barrier::{Barrier, Worst, at, differences, largest, last};
use checkdam::check::{Check, Kind};

/// Share by which numbers of nine digits differ.
const DIGITS: f64 = 1e-6;

/// All of it. `body` is the number of the barrier among the bodies of the case.
pub fn checks(b: &Barrier, body: usize) -> Vec<Check> {
    let mut checks = of_the_tables(b, body);
    checks.push(at_peak(b));
    checks
}

/// Without the profile at the largest force, which is that of rows of 1 ms whatever the tables have.
pub fn of_the_tables(b: &Barrier, body: usize) -> Vec<Check> {
    vec![profiles(b), outline(b), points(b, body), pressure(b)]
}

/// Rows of a table at one time.
fn rows_at(times: &[f64], time: f64) -> Vec<usize> {
    (0..times.len()).filter(|&k| (times[k] - time).abs() < 1e-7).collect()
}

fn picked(values: &[f64], rows: &[usize]) -> Vec<f64> {
    rows.iter().map(|&k| values[k]).collect()
}

/// Times that differ, in order.
fn distinct(times: &[f64]) -> Vec<f64> {
    let mut found = times.to_vec();
    found.dedup();
    found
}

/// Heights of the points of the face as the lattice has them.
fn heights(b: &Barrier) -> Vec<f64> {
    let count = (b.height / b.spacing).round() as usize;
    (0..count).map(|k| (k as f64 + 0.5) * b.spacing).collect()
}

/// Profiles at the frames against the samples of the same moment.
fn profiles(b: &Barrier) -> Check {
    let mut worst = Worst::default();
    let (times, time) = (b.profile("time_s"), b.body("time_s"));
    let (height, bent, speed) = (b.profile("height_m"), b.profile("deflection_m"), b.profile("velocity_m_per_s"));
    let column = |name: &str| b.body(name);
    let frames = b.files.frame_times();
    worst.lists(&distinct(&times), &frames[1..], 1.0);
    let (far, fast) = (largest(&bent).max(1e-12), largest(&speed).max(1e-12));
    for t in distinct(&times) {
        let rows = rows_at(&times, t);
        let (w, z) = (picked(&bent, &rows), picked(&height, &rows));
        worst.lists(&z, &heights(b), b.height);
        worst.number(last(&w), at(&time, &column("tip_deflection_m"), t), far);
        worst.number(last(&picked(&speed, &rows)), at(&time, &column("tip_velocity_m_per_s"), t), fast);
        let most = w.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        worst.number(most, at(&time, &column("largest_deflection_m"), t), far);
        // Of points that are bent alike, any.
        let place = at(&time, &column("largest_deflection_height_m"), t);
        worst.number(at(&z, &w, place), most, far);
        worst.number(at(&z, &z, place), place, b.height);
    }
    worst.check(
        &format!("{}profiles of the face at the frames against the samples", b.label()),
        DIGITS,
        "the same step, nine digits",
        Kind::Conservation,
        "the lattice of the points; rows of the same moment",
    )
}

/// The profile at the largest force against the samples of that moment and the summary.
fn at_peak(b: &Barrier) -> Check {
    let mut worst = Worst::default();
    let (time, force) = (b.body("time_s"), b.body("contact_normal_n"));
    let k = (0..force.len()).fold(0, |a, k| if force[k] > force[a] { k } else { a });
    let (when, z, w, v) =
        (b.at_peak("time_s"), b.at_peak("height_m"), b.at_peak("deflection_m"), b.at_peak("velocity_m_per_s"));
    worst.lists(&when, &vec![time[k]; when.len()], 1.0);
    worst.lists(&z, &heights(b), b.height);
    let (far, fast) = (largest(&w).max(1e-12), largest(&v).max(1e-12));
    worst.number(last(&w), b.body("tip_deflection_m")[k], far);
    worst.number(last(&v), b.body("tip_velocity_m_per_s")[k], fast);
    let most = w.iter().copied().fold(0.0, f64::max);
    if most > 0.0 {
        worst.number(b.number("structure.peak_deflection_m"), most, far);
        let place = b.number("structure.peak_deflection_height_m");
        worst.number(at(&z, &w, place), most, far);
        worst.number(at(&z, &z, place), place, b.height);
    }
    let speed = v.iter().copied().fold(0.0, f64::max);
    worst.number(b.number("structure.peak_barrier_velocity_m_per_s"), speed, fast);
    worst.check(
        &format!("{}profile at the largest force against the samples and the summary", b.label()),
        DIGITS,
        "the same step, nine digits",
        Kind::Conservation,
        "the lattice of the points; rows of the same moment",
    )
}

/// The surface: at the start the rectangle that is drawn, less half a distance of points; at the end the crest of its face is where the tip
/// says.
fn outline(b: &Barrier) -> Check {
    let mut worst = Worst::default();
    let (times, x, y) = (b.outline("time_s"), b.outline("x_m"), b.outline("y_m"));
    let all = distinct(&times);
    worst.number(all[0], 0.0, 1.0);
    worst.number(last(&all), last(&b.body("time_s")), 1.0);
    let bounds = |rows: &[usize], values: &[f64]| {
        let now = picked(values, rows).into_iter();
        now.fold([f64::INFINITY, f64::NEG_INFINITY], |a, v| [a[0].min(v), a[1].max(v)])
    };
    if !b.settled {
        for (d, values) in [&x, &y].into_iter().enumerate() {
            let found = bounds(&rows_at(&times, all[0]), values);
            worst.lists(&found, &b.extent[d], b.h);
        }
    }
    let near = |k: &usize| (x[*k] - b.crest[0]).hypot(y[*k] - b.crest[1]);
    let rows = rows_at(&times, last(&all));
    let crest = rows.iter().min_by(|i, k| near(i).total_cmp(&near(k)));
    let place = crest.map_or(f64::NAN, |&k| b.outward([x[k], y[k]]));
    worst.number(place, b.outward(b.crest) - last(&b.body("tip_deflection_m")), b.h);
    worst.check(
        &format!("{}outline against the rectangle that is drawn and the way of the tip, in cells", b.label()),
        DIGITS,
        "the same step, nine digits",
        Kind::Conservation,
        "the rectangle of the case; rows of the same moment",
    )
}

/// The points of the barrier in the last frame: the face's highest has moved and moves as the tip does.
fn points(b: &Barrier, body: usize) -> Check {
    let mut worst = Worst::default();
    let of = |frame: usize, name: &str| {
        let (bodies, values) = (b.files.array(frame, "body"), b.files.array(frame, name));
        let own = bodies.iter().zip(&values).filter(|(k, _)| **k == body as f64);
        own.map(|(_, v)| *v).collect::<Vec<f64>>()
    };
    let end = b.files.frames().saturating_sub(1);
    let (x, y, vx, vy) =
        (of(end, "Points.x"), of(end, "Points.y"), of(end, "velocity_m_per_s.x"), of(end, "velocity_m_per_s.y"));
    let (t, v) = (last(&b.files.frame_times()), [vx, vy]);
    worst.number(last(&b.files.array(end, "TimeValue")), t, 1.0);
    // By their numbers points go up along the height, column by column, the face's first.
    let ids = of(end, "id");
    if ids.len() < b.points_along || [&x, &y, &v[0], &v[1]].iter().any(|values| values.len() != ids.len()) {
        worst.number(f64::NAN, 0.0, 1.0);
        return worst.check("points of a barrier in the frames: none", 0.0, "none", Kind::Conservation, "the frames");
    }
    worst.lists(&ids, &(0..ids.len()).map(|k| k as f64).collect::<Vec<_>>(), 1.0);
    let all = b.files.array(end, "body").len();
    let numbers = |first: usize| (first..all + first).map(|k| k as f64).collect::<Vec<_>>();
    worst.lists(&b.files.array(end, "connectivity"), &numbers(0), 1.0);
    worst.lists(&b.files.array(end, "offsets"), &numbers(1), 1.0);
    for name in ["Points.z", "velocity_m_per_s.z", "stress_pa.yz", "stress_pa.xz"] {
        worst.number(largest(&b.files.array(end, name)), 0.0, 1.0);
    }
    let crest = b.points_along - 1;
    let time = b.body("time_s");
    let moved = b.outward(b.crest) - b.outward([x[crest], y[crest]]);
    worst.number(moved, at(&time, &b.body("tip_deflection_m"), t), b.h);
    let speed = largest(&b.body("tip_velocity_m_per_s")).max(1e-6);
    worst.number(-b.outward([v[0][crest], v[1][crest]]), at(&time, &b.body("tip_velocity_m_per_s"), t), speed);
    let stress = ["xx", "yy", "zz"].map(|c| of(end, &format!("stress_pa.{c}")));
    let mean: Vec<f64> = (0..x.len()).map(|k| stress.iter().map(|s| s[k]).sum::<f64>() / 3.0).collect();
    worst.lists(&of(end, "mean_stress_pa"), &mean, largest(&mean).max(1e-9));
    let fast: Vec<f64> = (0..x.len()).map(|k| v[0][k].hypot(v[1][k])).collect();
    worst.lists(&of(end, "speed_m_per_s"), &fast, largest(&fast).max(1e-12));
    worst.check(
        &format!("{}points of the last frame against the samples of its moment", b.label()),
        DIGITS,
        "the same step, nine digits",
        Kind::Conservation,
        "rows of the same moment; tr(sigma)/3; |v|",
    )
}

/// Pressure over the height times area against the force of the same interval, and its moment.
fn pressure(b: &Barrier) -> Check {
    let mut worst = Worst::default();
    let (times, z, p) = (b.pressure("time_s"), b.pressure("height_m"), b.pressure("pressure_pa"));
    let (time, force) = (b.body("time_s"), b.body("contact_normal_n"));
    let dt = differences(&time);
    let scale = largest(&force);
    let mut from = 0.0;
    for t in distinct(&times) {
        let rows = rows_at(&times, t);
        let bins = rows.len();
        let high = |k: usize| if k == 0 || k + 1 == bins { 0.5 * b.h } else { b.h };
        let areas: Vec<f64> = (0..bins).map(|k| high(k) * b.width).collect();
        let part = picked(&p, &rows);
        let sum: f64 = part.iter().zip(&areas).map(|(p, a)| p * a).sum();
        let inside = (0..time.len()).filter(|&k| time[k] > from + 1e-7 && time[k] < t + 1e-7);
        let impulse: f64 = inside.map(|k| force[k] * dt[k]).sum();
        worst.number(sum, impulse / (t - from), scale);
        let expected: Vec<f64> = (0..bins).map(|k| k as f64 * b.h).collect();
        worst.lists(&picked(&z, &rows), &expected, b.height);
        from = t;
    }
    worst.lists(&distinct(&times), &b.files.frame_times()[1..], 1.0);
    worst.check(
        &format!("{}pressure over the height against the mean force of the same interval", b.label()),
        3e-6,
        "nine digits of each, intervals of 1 ms from times of nine digits",
        Kind::Conservation,
        "force is the integral of pressure",
    )
}

/// The tip goes as far as its velocity says.
pub fn velocities(b: &Barrier) -> Check {
    let (time, v, w) = (b.body("time_s"), b.body("tip_velocity_m_per_s"), b.body("tip_deflection_m"));
    let dt = differences(&time);
    let way: f64 = (1..time.len()).map(|k| 0.5 * (v[k] + v[k - 1]) * dt[k]).sum();
    let scale = largest(&w).max(1e-3 * b.h);
    let mut worst = Worst::default();
    worst.number(last(&w) - w[0], way, scale);
    worst.check(
        &format!("{}way of the tip against the sum of its velocities, over its largest", b.label()),
        0.05,
        "velocities once a millisecond, with ripples of a few steps: trapezoids",
        Kind::Analytic,
        "kinematics",
    )
}

//! What must hold for every barrier that is a body, whatever strikes it: Newton's laws sample by sample between the tables, and the
//! numbers of the summary as means, sums and largest values of these.
//!
//! Tables carry nine digits, so what agrees, agrees to that; intervals are differences of times of nine digits.

use super::barrier::{Barrier, Worst, differences, dot, largest, last};
use checkdam::check::{Check, Kind};

/// Share by which numbers of nine digits differ, with sums of a few hundred of them.
const DIGITS: f64 = 3e-6;
const STATIC: f64 = 0.3;
const PEAK: f64 = 0.02;

/// All of it. `flow` is the weight along x and y of everything else, N, where nothing but the contacts of this barrier touches it.
pub fn checks(b: &Barrier, flow: Option<[f64; 2]>) -> Vec<Check> {
    let mut checks = vec![newton(b), sums(b), means(b), peaks(b), peak_times(b), energy(b)];
    checks.extend(flow.map(|flow| momentum(b, flow)));
    checks
}

/// Sample by sample: force on the barrier is what its contacts give; with its weight, less its clamp's, the rate of its momentum.
pub fn newton(b: &Barrier) -> Check {
    let mut worst = Worst::default();
    let weight = b.components(b.weight);
    for (k, part) in ["normal", "tangential"].into_iter().enumerate() {
        let of = |what: &str| b.body(&format!("{what}_{part}_n"));
        let (contact, clamp, inertia) = (of("contact"), of("clamp"), of("inertia"));
        let scale = largest(&b.body("contact_normal_n"));
        worst.lists(&b.history(&format!("force_{part}_n")), &contact, scale);
        let left: Vec<f64> = contact.iter().zip(&clamp).map(|(c, k)| c - k).collect();
        worst.lists(&left, &inertia.iter().map(|i| i - weight[k]).collect::<Vec<_>>(), scale);
    }
    worst.lists(&b.history("time_s"), &b.body("time_s"), 1e-3);
    // Of one sample and of the run: round-off, a thousandth of what is allowed here.
    let thousandth = 1e3 * largest(&b.body("imbalance")).max(b.number("structure.imbalance_1"));
    worst.number(if b.settled { thousandth } else { 0.0 }, 0.0, 1.0);
    worst.check(
        &format!("{}contact less clamp and rate of momentum, sample by sample, over the largest force", b.label()),
        DIGITS,
        "nine digits of each",
        Kind::Conservation,
        "Newton's second and third law",
    )
}

/// Impulses: of the samples against the ledger of the clamp, what was gained, and the weight that is drawn.
fn momentum(b: &Barrier, flow: [f64; 2]) -> Check {
    let mut worst = Worst::default();
    let (dt, time) = (b.intervals(), b.body("time_s"));
    let rows = b.files.column("momentum.csv", "time_s");
    let until = |values: &[f64], end: f64| -> f64 {
        let whole = time.iter().zip(values.iter().zip(&dt));
        whole.filter(|(t, _)| **t <= end * (1.0 + 1e-9)).map(|(_, (v, dt))| v * dt).sum()
    };
    let parts = |what: &str| ["normal", "tangential"].map(|part| b.body(&format!("{what}_{part}_n")));
    let (contact, clamp, inertia) = (parts("contact"), parts("clamp"), parts("inertia"));
    let scale = clamp[0].iter().chain(&contact[0]).zip(dt.iter().chain(&dt)).map(|(f, dt)| f.abs() * dt).sum::<f64>();
    for (d, axis) in ["x", "y"].into_iter().enumerate() {
        let along = |of: &[Vec<f64>; 2], end| -b.normal[d] * until(&of[0], end) + b.tangent[d] * until(&of[1], end);
        let column = |name: &str| b.files.column("momentum.csv", &format!("{name}_{axis}_n_s"));
        let expected = |f: &dyn Fn(f64) -> f64| rows.iter().map(|t| f(*t)).collect::<Vec<_>>();
        worst.lists(&column(b.clamp), &expected(&|t| -along(&clamp, t)), scale);
        worst.lists(&column("gravity"), &expected(&|t| (flow[d] + b.weight[d]) * t), scale);
        let gained = |t| along(&inertia, t) - along(&contact, t) + flow[d] * t;
        worst.lists(&column("gained"), &expected(&gained), scale);
    }
    worst.check(
        "impulses of clamp, gravity and contact against momentum, row by row, over all impulses",
        DIGITS,
        "nine digits of each, intervals of 1 ms from times of nine digits",
        Kind::Conservation,
        "Newton's second and third law",
    )
}

/// Row by row all of the energy is accounted for by the columns; what was there when the flow arrived.
pub fn energy(b: &Barrier) -> Check {
    let mut worst = Worst::default();
    let column = |name: &str| b.files.column("energy.csv", name);
    let names = b.files.keys().into_iter().filter_map(|key| Some(key.strip_prefix("energy.csv/")?.to_string()));
    let all: Vec<Vec<f64>> = names.filter(|name| name != "time_s").map(|name| column(&name)).collect();
    let time = column("time_s");
    let initial = b.number_of_run("energy.initial_j");
    let scale = all.iter().map(|c| largest(c)).fold(initial.abs(), f64::max);
    for k in 0..time.len() {
        worst.number(all.iter().map(|c| c[k]).sum(), initial, scale);
    }
    let arrival = b.number("barrier.arrival_s");
    let (kinetic, elastic, fallen) = (column("kinetic_j"), column("elastic_j"), column("gravitational_j"));
    if let Some(row) = time.iter().position(|t| *t >= arrival) {
        // Shares of hundredths have fewer digits: a thousandth of them is seen.
        let share = kinetic[row] / initial;
        worst.number(b.number("structure.arrival_kinetic_1"), share, 1.0);
        let gone = 1.0 - (kinetic[row] + elastic[row] + fallen[row]) / initial;
        worst.number(b.number("structure.arrival_dissipated_1"), gone, 1.0);
    }
    worst.check(
        &format!("{}energy: sum of all columns, row by row, and shares at the arrival, over what was there", b.label()),
        1e-7,
        "nine digits of each",
        Kind::Conservation,
        "every loss has its column",
    )
}

/// Impulses of the whole run and of half a second, arrival.
fn sums(b: &Barrier) -> Check {
    let mut worst = Worst::default();
    let (time, normal, tangential) = (b.body("time_s"), b.body("contact_normal_n"), b.body("contact_tangential_n"));
    let dt = differences(&time);
    let scale = dot(&normal, &dt).abs();
    worst.number(b.number("barrier.impulse_normal_n_s"), dot(&normal, &dt), scale);
    worst.number(b.number("barrier.impulse_tangential_n_s"), dot(&tangential, &dt), scale);
    let threshold = b.files.number("scales.arrival_force_n");
    let first = normal.iter().position(|f| *f > threshold);
    let arrival = first.map_or(f64::NAN, |k| time[k]);
    worst.number(b.number("barrier.arrival_s"), arrival, arrival);
    let struck = (0..time.len()).filter(|&k| time[k] > arrival && time[k] <= arrival + 0.5);
    worst.number(b.number("barrier.impulse_half_second_n_s"), struck.map(|k| normal[k] * dt[k]).sum(), scale);
    // The front as it was a row before the arrival; what is there from the start has none.
    let before = first.and_then(|k| k.checked_sub(1));
    let front = |name: &str| {
        let column = b.files.column("history.csv", name);
        before.and_then(|k| column.get(k).copied()).unwrap_or(f64::NAN)
    };
    let (speed, depth) = (front("front_velocity_m_per_s"), front("front_depth_m"));
    if speed * depth > 0.0 {
        let run = |key: &str| b.number_of_run(key);
        let density = run("scales.flow_density_kg_per_m3");
        let area = depth * b.width;
        let joukowsky = density * run("scales.flow_wave_speed_m_per_s") * speed * area;
        worst.number(b.number("barrier.elastic_impact_n"), joukowsky, joukowsky);
        let alpha = b.number("barrier.peak_20ms_by_steps_n") / (density * speed * speed * area);
        worst.number(b.number("barrier.peak_20ms_alpha_1"), alpha, alpha);
    }
    let over = last(&b.history("overtopped_kg"));
    worst.number(b.number("barrier.overtopped_kg"), over, 1.0);
    worst.number(b.number("barrier.passed_kg"), last(&b.history("passed_kg")), 1.0);
    worst.number(over, last(&b.history("passed_kg")), 1.0);
    worst.number(b.number("barrier.passed_under_kg"), last(&b.history("passed_under_kg")), 1.0);
    worst.check(
        &format!("{}impulses, arrival, rho c v h b and mass that passed against the samples", b.label()),
        DIGITS,
        "nine digits of each, intervals of 1 ms from times of nine digits",
        Kind::Conservation,
        "sums over rows of the tables",
    )
}

/// Means of the last 0.3 s.
fn means(b: &Barrier) -> Check {
    let mut worst = Worst::default();
    let time = b.body("time_s");
    let between = |values: &[f64], from: f64, to: f64| {
        let (low, high) = (last(&time) - STATIC * (1.0 - from), last(&time) - STATIC * (1.0 - to));
        super::barrier::mean_where(&time, values, |t| t > low && t <= high)
    };
    let late = |values: &[f64]| between(values, 0.0, 1.0);
    let normal = b.body("contact_normal_n");
    let force = late(&normal);
    // What is next to nothing beside the largest force has no digits left.
    let least = 1e-5 * largest(&normal);
    let mut compare = |key: &str, expected: f64| worst.number(b.number(key), expected, expected.abs().max(least));
    compare("barrier.static_force_n", force);
    compare("barrier.base_shear_n", force);
    compare("barrier.static_shear_n", late(&b.body("contact_tangential_n")));
    for k in 1..=3 {
        let layer = b.history(&format!("force_layer{k}_n"));
        compare(&format!("barrier.static_layer{k}_n"), late(&layer));
    }
    let moment = late(&b.history("overturning_moment_n_m"));
    compare("barrier.static_moment_n_m", moment);
    if force > least {
        compare("barrier.static_height_of_action_m", moment / force);
    }
    compare("structure.static_clamp_n", late(&b.body("clamp_normal_n")));
    compare("structure.static_clamp_moment_n_m", late(&b.body("clamp_moment_n_m")));
    // A shorter run has no first third.
    if last(&time) > STATIC {
        compare("barrier.static_force_drift_n", between(&normal, 2.0 / 3.0, 1.0) - between(&normal, 0.0, 1.0 / 3.0));
    }
    let tip = late(&b.body("tip_deflection_m"));
    let mut compare = |key: &str, expected: f64| worst.number(b.number(key), expected, expected.abs());
    compare("structure.tip_final_m", tip);
    compare("structure.tip_final_1", tip / b.height);
    compare("structure.height_m", b.height);
    worst.check(
        &format!("{}means of the last 0.3 s against the samples", b.label()),
        1e-4,
        "nine digits; the edges of thirds fall between rows",
        Kind::Conservation,
        "means over rows of the tables",
    )
}

/// Means over 20 ms of the rows that end within it: start, end, mean.
fn running(time: &[f64], force: &[f64]) -> Vec<[f64; 3]> {
    let window = |k: usize| {
        let inside: Vec<usize> = (0..=k).filter(|&i| time[k] - time[i] <= PEAK * (1.0 - 1e-9)).collect();
        let sum: f64 = inside.iter().map(|&i| force[i]).sum();
        [inside.first().map_or(f64::NAN, |&i| time[i]), time[k], sum / inside.len() as f64]
    };
    (0..time.len()).map(window).collect()
}

/// Largest values.
fn peaks(b: &Barrier) -> Check {
    let mut worst = Worst::default();
    let (time, normal) = (b.body("time_s"), b.body("contact_normal_n"));
    let all = running(&time, &normal);
    let best = all.iter().filter(|m| m[1] >= PEAK).fold([0.0; 3], |a, m| if m[2] > a[2] { *m } else { a });
    let mut compare = |key: &str, expected: f64| worst.number(b.number(key), expected, largest(&[expected]));
    if last(&time) >= PEAK {
        compare("barrier.peak_20ms_n", best[2]);
        compare("barrier.peak_20ms_time_s", 0.5 * (best[0] + best[1]));
        let frames: Vec<usize> = (1..time.len()).filter(|&k| frame(time[k]) > frame(time[k - 1])).collect();
        compare("structure.peak_50hz_n", frames.into_iter().map(|k| normal[k]).fold(0.0, f64::max));
    }
    compare("barrier.peak_step_n", largest(&b.history("force_normal_max_n")));
    for (key, of) in
        [("tip_max_m", "tip_deflection_m"), ("penetration_max_m", "penetration_m"), ("gap_cells", "gap_cells")]
    {
        let most = b.body(of).into_iter().fold(0.0, f64::max);
        if most > 0.0 {
            compare(&format!("structure.{key}"), most);
        }
    }
    for name in ["run_up_m", "run_up_p95_m"] {
        let most = largest(&b.history(name));
        if most > 0.0 {
            compare(&format!("barrier.{name}"), most);
        }
    }
    worst.lists(&b.body("run_up_m"), &b.history("run_up_m"), b.height);
    worst.check(
        &format!("{}largest values against the samples", b.label()),
        DIGITS,
        "nine digits of each",
        Kind::Conservation,
        "largest of rows of the tables",
    )
}

fn frame(time: f64) -> f64 {
    (time / PEAK * (1.0 + 1e-9)).floor()
}

/// When, and what is read of steps against what is read of rows.
fn peak_times(b: &Barrier) -> Check {
    let mut worst = Worst::default();
    let (time, normal) = (b.body("time_s"), b.body("contact_normal_n"));
    // At rest many rows have the largest value, to nine digits: the nearest of them.
    let most = |values: &[f64], at: f64| {
        let largest = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let among = (0..values.len()).filter(|&k| values[k] >= largest - 3e-9 * largest.abs());
        let nearest = among.min_by(|a, b| (time[*a] - at).abs().total_cmp(&(time[*b] - at).abs()));
        (nearest.unwrap_or(0), largest)
    };
    let at = b.number("barrier.peak_step_time_s");
    let (k, _) = most(&b.history("force_normal_max_n"), at);
    worst.number(at, time[k], 1e-3);
    let at = b.number("structure.gap_time_s");
    let (k, gap) = most(&b.body("gap_cells"), at);
    if gap > 0.0 {
        worst.number(at, time[k], 1e-5);
        worst.number(b.number("structure.gap_height_m"), b.body("gap_height_m")[k], 1e-6);
    }
    let far = running(&time, &normal).into_iter();
    let force = b.number("barrier.static_force_n");
    let off = far.filter(|m| (m[2] - force).abs() > 0.05 * force.abs()).map(|m| m[1]).fold(0.0, f64::max);
    worst.number(b.number("barrier.time_to_static_s"), off, 1e-5);
    worst.check(
        &format!("{}times of largest values, over a sample", b.label()),
        1.05,
        "a step lies within its row, and a time step of the row before it",
        Kind::Conservation,
        "rows of the tables",
    )
}

/// Where every step is a row: largest values of single steps and their times, and the largest mean over exactly 20 ms.
pub fn steps(b: &Barrier) -> Check {
    let mut worst = Worst::default();
    let (time, dt) = (b.body("time_s"), b.intervals());
    let most = |values: &[f64]| (0..values.len()).fold(0, |a, k| if values[k] > values[a] { k } else { a });
    let mut compare = |key: &str, expected: f64| worst.number(b.number(key), expected, expected.abs());
    let (normal, tangential) = (b.body("clamp_normal_n"), b.body("clamp_tangential_n"));
    let clamp: Vec<f64> = normal.iter().zip(&tangential).map(|(n, t)| n.hypot(*t)).collect();
    compare("structure.peak_clamp_n", clamp[most(&clamp)]);
    compare("structure.peak_clamp_time_s", time[most(&clamp)]);
    let (force, moment) = (b.history("force_normal_n"), b.history("overturning_moment_n_m"));
    compare("barrier.peak_step_n", force[most(&force)]);
    compare("barrier.peak_step_time_s", time[most(&force)]);
    compare("barrier.peak_moment_n_m", moment[most(&moment)]);
    // Impulse until a time, in a straight line within a step.
    let ends: Vec<f64> = std::iter::once(0.0).chain(time.iter().copied()).collect();
    let sums = force.iter().zip(&dt).scan(0.0, |sum, (f, dt)| {
        *sum += f * dt;
        Some(*sum)
    });
    let until: Vec<f64> = std::iter::once(0.0).chain(sums).collect();
    let means = (0..ends.len()).filter(|&k| ends[k] >= PEAK);
    let means = means.map(|k| (until[k] - super::barrier::between(&ends, &until, ends[k] - PEAK)) / PEAK);
    compare("barrier.peak_20ms_by_steps_n", means.fold(0.0, f64::max));
    worst.number(b.files.rows("barrier.csv") as f64, b.files.number("stepping.run_steps"), 1.0);
    worst.check(
        &format!("{}largest values of single steps and over exactly 20 ms, where every step is a row", b.label()),
        1e-5,
        "nine digits of each, steps from times of nine digits",
        Kind::Conservation,
        "rows of the tables",
    )
}

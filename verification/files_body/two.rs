//! Two barriers, without gravity: one block strikes the first, another flies over it and strikes the second. What a block loses of its
//! momentum, its barrier has got; what has flown over the first is behind it when its columns of points have passed.

use super::barrier::{Barrier, Worst, dot, last, mean_where};
use super::{balance, shape};
use crate::Fault;
use crate::from_file::Files;
use checkdam::check::{Check, Kind, Tolerance};

const H: f64 = 0.04;
const SPACING: f64 = 0.02;
/// Distance of the points of the block that flies.
const FINE: f64 = 0.01;
const WIDTH: f64 = 0.2;
const LOW: f64 = 1000.0 * 0.2 * 0.08 * WIDTH;
const FAST: f64 = 2.0;
const SLOW: f64 = 1.0;

/// Which barrier is the first, and how often it is read.
pub struct Setting {
    /// Whether the one behind is named first.
    swapped: bool,
    rate_hz: f64,
}

/// In the order in which they stand, and the other way round with a row for every step.
pub const SETTINGS: [Setting; 2] =
    [Setting { swapped: false, rate_hz: 1000.0 }, Setting { swapped: true, rate_hz: 1e5 }];

/// The case.
pub fn text(s: &Setting, fault: &Fault) -> String {
    let order = if s.swapped { "\"second\", \"first\"" } else { "\"first\", \"second\"" };
    let rate = s.rate_hz;
    let (density, young, friction) = (1000.0 * fault.density, 1e6 * fault.modulus, 0.4 * fault.friction);
    let pairs = [
        ("first", "low"),
        ("first", "high"),
        ("second", "low"),
        ("second", "high"),
        ("first", "second"),
        ("low", "high"),
    ];
    let contacts = pairs.map(|(a, b)| format!("{{ bodies = [\"{a}\", \"{b}\"], friction = {friction} }}")).join(", ");
    format!(
        r#"title = "One block strikes, one flies over"
gravity = {{ magnitude_m_per_s2 = 0, inclination_deg = 0 }}
grid = {{ spacing_m = {H}, thickness_m = {WIDTH} }}
domain = {{ x_m = [-0.8, 1.2], y_m = [-0.2, 0.6] }}
materials.stuff = {{ law = "linear_elastic", density_kg_per_m3 = {density}, young_pa = {young}, poisson = 0 }}
bodies = [{{ name = "low", material = "stuff", x_m = [-0.24, -0.04], y_m = [0.0, 0.08], velocity_m_per_s = [{SLOW}, 0] }},
          {{ name = "first", material = "stuff", x_m = [0.0, 0.2], y_m = [0.0, 0.08] }},
          {{ name = "high", material = "stuff", x_m = [-0.24, -0.04], y_m = [0.24, 0.32], velocity_m_per_s = [{FAST}, 0], particles_per_cell = 16 }},
          {{ name = "second", material = "stuff", x_m = [0.64, 0.84], y_m = [0.0, 0.36] }}]
boundaries = [{{ name = "clamp", kind = "plane", point_m = [0.16, 0], normal_deg = 180, contact = "bonded", bodies = ["first"] }},
              {{ name = "other", kind = "plane", point_m = [0.8, 0], normal_deg = 180, contact = "bonded", bodies = ["second"] }}]
contacts = [{contacts}]
stages.run = {{ end_time_s = 0.38, stop_at_rest = false }}
gauges = {{ barriers = [{order}], sample_rate_hz = {rate}, field_times_s = [0.0, 0.345, 0.38] }}
output.vtk_interval_s = 0.095
numerics.pic_rate_per_s = 5
"#
    )
}

fn barriers<'a>(s: &Setting, files: &'a Files) -> [Barrier<'a>; 2] {
    let near = 0.5 * SPACING;
    let drawn = |x: f64, height: f64, suffix, root, clamp| Barrier {
        files,
        suffix,
        root,
        clamp,
        normal: [-1.0, 0.0],
        tangent: [0.0, 1.0],
        weight: [0.0; 2],
        height,
        h: H,
        spacing: SPACING,
        extent: [[x + near, x + 0.2 - near], [near, height - near]],
        crest: [x + near, height - near],
        points_along: (height / SPACING).round() as usize,
        settled: false,
        width: WIDTH,
    };
    let further = "further_barriers.0.";
    if s.swapped {
        return [drawn(0.0, 0.08, "_first", further, "clamp"), drawn(0.64, 0.36, "", "", "other")];
    }
    [drawn(0.0, 0.08, "", "", "clamp"), drawn(0.64, 0.36, "_second", further, "other")]
}

/// What must hold.
pub fn judge(s: &Setting, files: &Files) -> Vec<Check> {
    let both = barriers(s, files);
    let mut checks = Vec::new();
    for (b, body) in both.iter().zip([1, 3]) {
        if s.swapped {
            checks.extend([balance::newton(b), balance::energy(b), balance::steps(b)]);
            checks.extend(shape::of_the_tables(b, body));
        } else {
            checks.extend(balance::checks(b, None));
            checks.extend(shape::checks(b, body));
        }
    }
    let end = files.frames().saturating_sub(1);
    let speed = |body: f64, axis: &str| {
        mean_where(&files.array(end, "body"), &files.array(end, &format!("velocity_m_per_s.{axis}")), |b| b == body)
    };
    let mut worst = Worst::default();
    for (b, body, before) in [(&both[0], 0.0, SLOW), (&both[1], 2.0, FAST)] {
        let dt = b.intervals();
        let lost = [LOW * (before - speed(body, "x")), -LOW * speed(body, "y")];
        for (part, lost) in ["normal", "tangential"].into_iter().zip(lost) {
            worst.number(dot(&b.body(&format!("contact_{part}_n")), &dt), lost, LOW * before);
        }
    }
    let rest = |axis: &str| last(&files.column("momentum.csv", &format!("gained_{axis}_n_s")));
    let ends = last(&files.column("momentum.csv", "time_s"));
    for (d, axis) in ["x", "y"].into_iter().enumerate() {
        // What clamps gave until the last row of the ledger is what everything has gained.
        let given: f64 = both
            .iter()
            .map(|b| {
                let (dt, time) = (b.intervals(), b.body("time_s"));
                let until = |name: &str| {
                    let f = b.body(name);
                    (0..f.len()).filter(|&k| time[k] <= ends + 1e-7).map(|k| f[k] * dt[k]).sum::<f64>()
                };
                b.normal[d] * until("clamp_normal_n") - b.tangent[d] * until("clamp_tangential_n")
            })
            .sum();
        worst.number(rest(axis), given, LOW * FAST);
    }
    checks.push(worst.check(
        "impulse on each against what its block lost, over the momentum of a block",
        3e-6,
        "nine digits of each, intervals of 1 ms from times of nine digits",
        Kind::Conservation,
        "Newton's second and third law",
    ));
    let mut value = |what: &str, measured: f64, expected: f64, unit, allowed: f64, why: &str, source: &str| {
        checks.push(
            Check::value(what, measured, expected, unit)
                .within(Tolerance::Relative(allowed), why)
                .from(Kind::Analytic, source),
        );
    };
    let first = &both[0];
    let step = "one row of 1 ms";
    for (b, gap, v, name) in [(first, 0.04, SLOW, "first"), (&both[1], 0.68, FAST, "second")] {
        // A row is 1 ms, and a step of 0.37 ms may lie over its end.
        let arrival = b.number("barrier.arrival_s") - 7e-4;
        value(&format!("arrival at the {name}"), arrival, gap / v, "s", 1.1e-3 * v / gap, step, "gap over speed");
    }
    // The second barrier stands behind the first, and has not passed it.
    value("mass behind the first", last(&first.body("behind_kg")), LOW, "kg", 1e-6, "all of it", "the case");
    value("mass over the first", last(&first.history("overtopped_kg")), LOW, "kg", 1e-6, "all of it", "the case");
    // Behind is what lies three cells behind the last points of the barrier.
    let columns = (0..20).map(|k| (0.2 - 0.5 * SPACING + 3.0 * H + 0.24 - (f64::from(k) + 0.5) * FINE) / FAST);
    let stays: f64 = columns.map(|t| LOW / 20.0 * (0.38 - t)).sum();
    let spent = dot(&first.body("behind_kg"), &first.intervals());
    value("mass behind the first, summed over time", spent, stays, "kg s", 0.01, step, "its columns at their speed");
    if s.swapped {
        let key = |name: &str| first.number(&format!("barrier.{name}"));
        value("mass over the first, of the summary", key("overtopped_kg"), LOW, "kg", 1e-6, "all of it", "the case");
        value("mass that passed the first, of the summary", key("passed_kg"), LOW, "kg", 1e-6, "all of it", "the case");
    }
    let passed = dot(&first.history("passed_kg"), &first.intervals());
    value(
        "mass that passed the first, summed over time",
        passed,
        stays,
        "kg s",
        0.01,
        step,
        "its columns at their speed",
    );
    let row = "the lattice of the points, before they touch";
    let highest = |name: &str| both[1].history(name).into_iter().find(|s| *s > 0.0).unwrap_or(f64::NAN);
    let share = "of 24 points or more the top row has an eighth";
    value("95 % of the points at the second", highest("run_up_p95_m"), 0.32 - 0.5 * FINE, "m", 1e-6, share, "the case");
    value("highest point at the second", highest("run_up_m"), 0.32 - 0.5 * FINE, "m", 1e-6, row, "the case");
    let mass = (2.0 * 0.2 * 0.08 + 0.2 * 0.08 + 0.2 * 0.36) * WIDTH * 1000.0;
    value(
        "mass of everything",
        files.number("stepping.mass_kg"),
        mass,
        "kg",
        1e-6,
        "the lattices fill all",
        "the case",
    );
    let (t, number) = (files.column("contact.csv", "time_s"), files.column("contact.csv", "contact"));
    let fourth = mean_where(&t, &number, |t| (t - 0.345).abs() < 1e-3);
    value("contact that touches at 0.345 s", fourth, 3.0, "1", 1e-9, "a whole number", "the case: the fourth from 0");
    let name = files.text("further_barriers.0.name") == if s.swapped { "first" } else { "second" };
    value("name of the further one", f64::from(u8::from(name)), 1.0, "1", 1e-9, "yes or no", "the case");
    checks
}

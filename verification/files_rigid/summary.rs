//! What the summary says, made anew from the tables and from the case.

use super::barrier;
use super::deposit;
use super::judge::{Judge, within};
use super::rows::{DEFINED, EDGE, FROM_TABLES, ROWS, late, pick};
use super::setting::{Setting, at};
use crate::from_file::Files;

pub fn judge(set: &Setting, files: &Files, judge: &mut Judge) {
    stepping(set, files, judge);
    scales(set, files, judge);
    balances(set, files, judge);
    front(set, files, judge);
    // Else the rows of the tables are not those that the summary comes from.
    if at(&set.case, "gauges.sample_rate_hz").is_none() {
        for (k, name) in set.barriers.iter().enumerate() {
            let (key, file) = match k {
                0 => ("barrier".to_string(), "history.csv".to_string()),
                _ => (format!("further_barriers.{}.barrier", k - 1), format!("history_{name}.csv")),
            };
            barrier::judge(set, files, &key, &file, judge);
        }
        for (k, name) in set.bases.iter().enumerate().skip(1) {
            for c in ["base_normal_n", "base_friction_n"] {
                let file = format!("base_{name}.csv");
                let made = late(&files.column(&file, "time_s"), &files.column(&file, c), 0.0, 1.0);
                let found = files.number(&format!("further_bases.{}.{c}", k - 1));
                judge.same(
                    &format!("further_bases.{c} against its table"),
                    &[found],
                    &[made],
                    within(EDGE, FROM_TABLES, DEFINED),
                );
            }
        }
        deposit::judge(set, files, judge);
    }
}

fn stepping(set: &Setting, files: &Files, judge: &mut Judge) {
    let number = |name: &str| files.number(&format!("stepping.{name}"));
    let counted = files.array(0, "id").len() as f64;
    let filled: f64 = set.bodies.iter().map(|b| b.area() * b.per_cell / (set.h * set.h)).sum();
    judge.same(
        "stepping.particles against the frame at release and the area",
        &[number("particles"); 2],
        &[counted, filled.round()],
        within(0.0, "a count", DEFINED),
    );
    judge.closed(
        "stepping.mass_kg",
        number("mass_kg"),
        set.mass(),
        "kg",
        within(1e-12, "round-off of a sum over the points", "density times area times width"),
    );
    let steps = files.column("history.csv", "time_step_s");
    let [least, most] =
        [steps.iter().fold(f64::INFINITY, |a: f64, t| a.min(*t)), steps.iter().fold(0.0, |a: f64, t| a.max(*t))];
    let why = "samples look at a step in two or more, between which it changes by the speed of the fastest point over that of the waves";
    judge.same(
        "stepping.time_step_min_s and _max_s against the history",
        &[number("time_step_min_s"), number("time_step_max_s")],
        &[least, most],
        within(5e-3, why, DEFINED),
    );
    // The wave that is fastest sets the step, points at rest make it the longest.
    let fastest = set.bodies.iter().map(|b| b.wave_speed()).fold(0.0, f64::max);
    let speeds = (0..files.frames()).flat_map(|k| set.points(files, k)).map(|p| p.v[0].abs().max(p.v[1].abs()));
    // Between two frames gravity adds to it.
    let between = at(&set.case, "output.vtk_interval_s").unwrap_or(f64::NAN) * set.gravity;
    let speed = speeds.fold(0.0, f64::max) + between;
    let longest = 0.3 * set.h / fastest;
    let why = "between a step at rest and one of the fastest point that a frame can have missed";
    let low = longest / (1.0 + speed / fastest);
    for name in ["time_step_min_s", "time_step_max_s"] {
        let off = (low - number(name)).max(number(name) - longest * 1.0001) / longest;
        judge.at_most(
            &format!("stepping.{name} outside of cfl h / (c + v)"),
            if off.is_nan() { off } else { off.max(0.0) },
            0.0,
            why,
        );
    }
    let last = files.column("history.csv", "time_s").last().copied().unwrap_or(f64::NAN);
    let end = number("end_s");
    judge.near(
        "stepping.end_s against the last row",
        &[end],
        &[last],
        1.0,
        within(3e-3, "the last row ends within two milliseconds and a step of the end", DEFINED),
    );
    if files.text("status").contains("end time") {
        let wanted = at(&set.case, "stages.run.end_time_s").unwrap_or(f64::NAN);
        judge.near(
            "stepping.end_s against the case",
            &[end],
            &[wanted],
            1.0,
            within(2e-3, "the first step at or after it", "the case file"),
        );
    }
    let [early, late] = [number("run_steps") * most - end, number("run_steps") * least - end];
    let steps = if early.is_nan() || late.is_nan() { f64::NAN } else { early.min(0.0) + late.max(0.0) };
    judge.at_most(
        "stepping.run_steps: time that steps of their lengths cannot have made",
        (steps / end).abs(),
        4e-3,
        "steps between the shortest and the longest of the history",
    );
    if files.has("case.stages.settle") {
        let mean = number("settle_time_s") / number("settle_steps");
        judge.closed(
            "stepping.settle_time_s over settle_steps",
            mean,
            longest,
            "s",
            within(
                2e-3,
                "a step of material that barely moves; the last of a stage is as long",
                "Courant, Friedrichs and Lewy 1928",
            ),
        );
        // It is looked at every 25 steps; where the last of them was a look, the frame at release has what it saw.
        let points = set.points(files, 0);
        let total: f64 = points.iter().map(|p| p.mass).sum();
        let square: f64 = points.iter().map(|p| p.mass * p.speed().powi(2)).sum::<f64>() / total;
        let residual = (square / (set.gravity * set.tall())).sqrt();
        if number("settle_steps") % 25.0 == 0.0 {
            judge.closed(
                "stepping.settle_residual against the frame at release",
                number("settle_residual"),
                residual,
                "1",
                within(1e-9, "round-off", DEFINED),
            );
        }
    } else {
        judge.same(
            "stepping: settling where there is none",
            &[number("settle_time_s"), number("settle_steps"), number("settle_residual")],
            &[0.0; 3],
            within(0.0, "there is none", DEFINED),
        );
    }
}

fn scales(set: &Setting, files: &Files, judge: &mut Judge) {
    let given = |key: &str, otherwise: f64| at(&set.case, &format!("gauges.{key}")).unwrap_or(otherwise);
    let mut same = |name: &str, made: f64, why: &str| {
        judge.same(
            &format!("scales.{name} against the case"),
            &[files.number(&format!("scales.{name}"))],
            &[made],
            within(1e-9, why, DEFINED),
        );
    };
    same("flow_direction_1", set.way(), "a sign");
    same("front_length_m", given("front_length_m", 0.158 * set.area().sqrt()), "round-off");
    same("arrival_force_n", given("arrival_force_n", set.mass() * set.gravity / 600.0), "round-off");
    same("flow_density_kg_per_m3", set.mass() / (set.area() * set.width), "round-off");
    same("flow_wave_speed_m_per_s", set.bodies.iter().map(|b| b.wave_speed()).fold(0.0, f64::max), "round-off");
    same("resolution_s", 1e-3, "a thousand rows a second");
}

fn balances(set: &Setting, files: &Files, judge: &mut Judge) {
    let column = |name: &str| files.column("energy.csv", name);
    let rows = files.rows("energy.csv");
    let own = |kind: &str| -> Vec<f64> {
        let columns: Vec<Vec<f64>> = set.boundaries.iter().map(|b| column(&format!("{kind}_{}_j", b.name))).collect();
        (0..rows).map(|k| columns.iter().map(|c| pick(c, k)).sum()).collect()
    };
    let fixed = |name: &str| column(&format!("{name}_j"));
    let [kinetic, height, elastic, plastic, pic, sides, out, residual] =
        ["kinetic", "gravitational", "elastic", "plastic", "pic", "side_walls", "outflow", "residual"].map(fixed);
    let initial = pick(&kinetic, 0) + pick(&height, 0) + pick(&elastic, 0);
    let last = rows.saturating_sub(1);
    let most = |values: &[f64]| values.iter().fold(0.0, |a: f64, x| a.max(x.abs()));
    let released = (0..rows).map(|k| initial - pick(&height, k) - pick(&out, k)).fold(0.0, f64::max);
    let mut same = |name: &str, made: f64, scale: f64| {
        let found = files.number(&format!("energy.{name}"));
        judge.near(
            &format!("energy.{name} against energy.csv"),
            &[found],
            &[made],
            scale.abs(),
            within(1e-6, FROM_TABLES, DEFINED),
        );
    };
    same("initial_j", initial, initial);
    // A difference of two large numbers with nine digits.
    same("released_j", released, released.max(0.02 * initial));
    for (name, values) in [
        ("kinetic", &kinetic),
        ("gravitational", &height),
        ("elastic", &elastic),
        ("plastic", &plastic),
        ("pic", &pic),
        ("side_walls", &sides),
        ("outflow", &out),
        ("friction", &own("friction")),
        ("impact", &own("contact")),
        ("residual_end", &residual),
    ] {
        let share = pick(values, last) / initial;
        same(&format!("{name}_1"), share, share);
    }
    same("energy_residual_1", most(&residual) / initial, most(&residual) / initial);
    same(
        "residual_of_released_1",
        most(&residual) / released,
        (most(&residual) / released).max(1e-9 * initial / released),
    );
    same("kinetic_max_1", most(&kinetic) / initial, most(&kinetic) / initial);
    let deepest = files.column("history.csv", "penetration_m").iter().fold(0.0, |a: f64, d| a.max(*d));
    judge.same(
        "momentum.penetration_m against the history",
        &[files.number("momentum.penetration_m")],
        &[deepest],
        within(ROWS, FROM_TABLES, DEFINED),
    );
    // What left is missing among the points at the end.
    let here: f64 = set.points(files, files.frames().saturating_sub(1)).iter().map(|p| p.mass).sum();
    let gone = files.number("momentum.outflow_kg");
    judge.near(
        "momentum.outflow_kg against the last frame",
        &[gone],
        &[set.mass() - here],
        set.mass(),
        within(1e-9, "nothing leaves after the last frame", "conservation of mass"),
    );
    // At least what each agent gave in all, at most what all gave without ever turning round.
    let momentum = |name: String| files.column("momentum.csv", &name).last().copied().unwrap_or(f64::NAN).abs();
    let agents = set.boundaries.iter().map(|b| b.name.as_str()).chain(["gravity"]);
    let least: f64 = agents.flat_map(|a| ["x", "y"].map(|axis| momentum(format!("{a}_{axis}_n_s")))).sum();
    let found = files.number("momentum.impulse_scale_n_s");
    judge.at_most(
        "momentum.impulse_scale_n_s: below the impulses of gravity and boundaries",
        if found > 0.0 { ((least - found) / found).max(0.0) } else { f64::NAN },
        1e-7,
        "a sum of magnitudes is no less than the magnitude of the sum",
    );
    let closure = files.number("momentum.momentum_closure_1");
    judge.at_most("momentum.momentum_closure_1", closure, 1e-11, "round-off of some thousand steps");
}

fn front(set: &Setting, files: &Files, judge: &mut Judge) {
    if at(&set.case, "gauges.sample_rate_hz").is_some() {
        return;
    }
    let column = |name: &str| files.column("history.csv", name);
    let [time, x, edge, velocity, depth] =
        ["time_s", "front_x_m", "front_edge_x_m", "front_velocity_m_per_s", "front_depth_m"].map(column);
    let way = set.way();
    let first = |values: &[f64], place: f64| values.iter().position(|x| way * x >= way * place);
    let stations = (0..).map_while(|k| at(&set.case, &format!("gauges.stations_m.{k}")));
    let mut wanted: Vec<(f64, usize)> = stations.filter_map(|place| Some((place, first(&x, place)?))).collect();
    let arrival =
        files.column("history.csv", "force_normal_n").iter().position(|f| *f > files.number("scales.arrival_force_n"));
    if let Some(k) = arrival.filter(|k| *k > 0 && !set.barriers.is_empty()) {
        wanted.push((pick(&x, k - 1), k - 1));
    }
    let listed = (0..).take_while(|k| files.has(&format!("front.{k}"))).count();
    judge.same("front: how many", &[listed as f64], &[wanted.len() as f64], within(0.0, "a count", DEFINED));
    for (k, (place, row)) in wanted.into_iter().enumerate() {
        let passed = first(&edge, place).unwrap_or(row);
        let froude = pick(&velocity, row) / (set.gravity * libm::cos(set.slope) * pick(&depth, row)).sqrt();
        let made = [
            ("x_m", place),
            ("time_s", pick(&time, row)),
            ("edge_time_s", pick(&time, passed)),
            ("velocity_m_per_s", pick(&velocity, row)),
            ("depth_m", pick(&depth, row)),
            ("froude_1", froude),
        ];
        for (name, made) in made {
            judge.same(
                &format!("front.{name} against the history"),
                &[files.number(&format!("front.{k}.{name}"))],
                &[made],
                within(ROWS, FROM_TABLES, DEFINED),
            );
        }
    }
}

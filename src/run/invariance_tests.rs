//! What a run reports is a property of the flow: not of how it is sampled, where its origin lies, on which side it runs, or in how many
//! bodies it is written.

use super::{Records, Summary, files, run_in_memory};
use crate::case::{self, Case};
use crate::output::Table;

/// Sand that falls apart on a bed of 30 degrees against a wall.
const SAND: &str = r#"
title = "sand"
gravity = { inclination_deg = 30 }
grid = { spacing_m = 0.05, thickness_m = 0.2, particles_per_cell = 9 }
domain = { x_m = [-0.5, 1.0], y_m = [-0.2, 0.8] }
materials.sand = { law = "drucker_prager", density_kg_per_m3 = 1500, young_pa = 1e6, poisson = 0.3, friction_angle_deg = 31 }
bodies = [{ name = "sand", material = "sand", x_m = [-0.3, 0.0], y_m = [0.0, 0.3] }]
boundaries = [
    { name = "base", kind = "plane", point_m = [0.0, 0.0], normal_deg = 90, contact = "coulomb", friction = 0.3 },
    { name = "back", kind = "wall", foot_m = [-0.3, 0.0], height_m = 0.5, material_side = "right", contact = "smooth" },
    { name = "gate", kind = "gate", foot_m = [0.0, 0.0], height_m = 0.4, contact = "smooth" },
    { name = "wall", kind = "wall", foot_m = [0.6, 0.0], height_m = 0.5, contact = "coulomb", friction = 0.3 },
]
stages.settle = { damping_per_s = 60, residual = 1e-2, max_time_s = 5 }
stages.run = { end_time_s = 1.2, stop_at_rest = false }
gauges = { barrier = "wall", base = "base", stations_m = [0.1, 0.3] }
output = { vtk_interval_s = 0 }
"#;

fn parse(text: &str) -> Case {
    case::parse(text, "sand.toml").unwrap_or_else(|e| panic!("{e}")).case
}

fn changed(changes: &[(&str, &str)]) -> Case {
    parse(&changes.iter().fold(SAND.to_owned(), |text, (from, to)| {
        assert!(text.contains(from), "{from}");
        text.replace(from, to)
    }))
}

fn run(case: &Case) -> (Records, Summary) {
    let (_, records, summary) = run_in_memory(case, &mut |_| true).unwrap_or_else(|e| panic!("{e}"));
    (records, summary)
}

/// The summary without its case, as text: every bit of it.
fn told(summary: &Summary) -> String {
    summary.to_toml().split("[case]").next().unwrap_or_default().to_owned()
}

fn close(a: f64, b: f64, share: f64, what: &str) {
    assert!((a - b).abs() <= share * a.abs().max(b.abs()), "{what}: {a} {b}");
}

#[test]
fn what_is_told_does_not_depend_on_the_rate_of_the_tables() {
    let folder = tempfile::tempdir().expect("a folder");
    let runs = ["20", "50", "100", "1000", "1e5"].map(|rate| {
        let at = folder.path().join(rate);
        std::fs::create_dir(&at).expect("a folder");
        let gauges = format!("stations_m = [0.1, 0.3], sample_rate_hz = {rate} }}");
        let case = changed(&[("stations_m = [0.1, 0.3] }", &gauges)]);
        let (_, _, summary) = files::run_into(&case, &at, &mut |_| true).unwrap_or_else(|e| panic!("{e}"));
        let table = Table::load(at.join("history.csv")).expect("a table");
        let column = |name: &str| table.column(name).expect("a column").to_vec();
        let (time, force) = (column("time_s"), column("force_normal_n"));
        let starts = std::iter::once(0.0).chain(time.iter().copied());
        let impulse: f64 = force.iter().zip(&time).zip(starts).map(|((f, t), start)| f * (t - start)).sum();
        (told(&summary), summary, table.rows(), impulse)
    });
    for (text, summary, _, impulse) in &runs {
        assert!(*text == runs[3].0, "{text}\n{}", runs[3].0);
        // The tables add up to the same, but for what comes after their last row.
        let all = summary.barrier.as_ref().expect("a barrier").impulse_normal_n_s;
        close(*impulse, all, 0.07, "impulse of a table");
    }
    assert_eq!([0, 1, 2, 3].map(|k| runs[k].2), [24, 60, 120, 1200]);
    assert!(runs[4].2 as u64 == runs[0].1.stepping.run_steps, "a row is a step at the least");
    let peak = runs[3].1.barrier.as_ref().expect("a barrier");
    assert!(peak.peak_20ms_n > 50.0 && peak.arrival_s.is_some(), "{peak:?}");
    close(peak.peak_20ms_n, peak.peak_20ms_by_steps_n, 0.05, "peaks over 20 ms");
    assert!(peak.run_up_p95_m > 0.05 && peak.run_up_p95_m < peak.run_up_m, "{peak:?}");
}

#[test]
fn a_rate_that_leaves_tables_empty_is_refused() {
    let text = SAND.replace("barrier = \"wall\",", "barrier = \"wall\", sample_rate_hz = 1,");
    let error = case::parse(&text, "sand.toml").expect_err("no row").to_string();
    assert!(error.contains("sample_rate_hz") && error.contains("at least 10 rows"), "{error}");
}

/// The case moved by whole cells: everything that says where.
fn moved(by: f64, without_barrier: bool) -> Case {
    let mut case = changed(&[]);
    if without_barrier {
        case.gauges.barrier = None;
    }
    let shift = |x: &mut f64| *x += by;
    let pair = |x: &mut [f64; 2]| x.iter_mut().for_each(shift);
    [&mut case.domain.x_m, &mut case.domain.y_m].into_iter().for_each(pair);
    case.bodies.iter_mut().flat_map(|b| [&mut b.x_m, &mut b.y_m]).for_each(pair);
    for b in &mut case.boundaries {
        b.point_m.iter_mut().chain(&mut b.foot_m).for_each(pair);
    }
    case.gauges.stations_m.iter_mut().for_each(shift);
    case
}

#[test]
fn shares_of_energy_know_no_origin() {
    for without_barrier in [false, true] {
        let (_, here) = run(&moved(0.0, without_barrier));
        assert!(here.energy.initial_j > 1.0 && here.energy.released_j > 1.0, "{:?}", here.energy);
        assert!(here.energy.residual_of_released_1 < 0.05, "{:?}", here.energy);
        for by in [-1.0, 100.0] {
            let (_, there) = run(&moved(by, without_barrier));
            let pairs = |s: &Summary| {
                let e = &s.energy;
                [e.initial_j, e.released_j, e.gravitational_1, e.plastic_1, e.friction_1, e.kinetic_max_1]
            };
            // Round-off of places of 100 m, on cells of 5 cm, over the impact of a few hundred points.
            let largest = pairs(&here).into_iter().fold(0.0, f64::max);
            for (a, b) in pairs(&here).into_iter().zip(pairs(&there)) {
                assert!((a - b).abs() < 1e-3 * a.abs() + 1e-12 * largest, "{by} {without_barrier}: {a} {b}");
            }
            // Before the impact, to round-off.
            let front = |s: &Summary| s.front[0].velocity_m_per_s;
            close(front(&here), front(&there), 1e-8, "front");
        }
    }
}

#[test]
fn a_flow_to_the_left_is_told_as_the_one_to_the_right() {
    let (_, right) = run(&changed(&[]));
    let (_, left) = run(&changed(&[
        ("inclination_deg = 30", "inclination_deg = -30"),
        ("x_m = [-0.5, 1.0]", "x_m = [-1.0, 0.5]"),
        ("x_m = [-0.3, 0.0]", "x_m = [0.0, 0.3]"),
        ("foot_m = [-0.3, 0.0], height_m = 0.5, material_side = \"right\"", "foot_m = [0.3, 0.0], height_m = 0.5"),
        ("foot_m = [0.0, 0.0], height_m = 0.4", "foot_m = [0.0, 0.0], height_m = 0.4, material_side = \"right\""),
        ("foot_m = [0.6, 0.0]", "foot_m = [-0.6, 0.0], material_side = \"right\""),
        ("[0.1, 0.3] }", "[-0.1, -0.3] }"),
    ]));
    assert_eq!((right.scales.flow_direction_1, left.scales.flow_direction_1), (1.0, -1.0));
    assert_eq!((right.front.len(), left.front.len()), (3, 3));
    for (a, b) in right.front.iter().zip(&left.front) {
        close(a.x_m, -b.x_m, 1e-6, "place");
        close(a.time_s, b.time_s, 1e-6, "time");
        close(a.edge_time_s, b.edge_time_s, 1e-6, "time of the edge");
        close(a.velocity_m_per_s, b.velocity_m_per_s, 1e-6, "velocity");
        close(a.froude_1, b.froude_1, 1e-6, "Froude number");
    }
    let [a, b] = [&right, &left].map(|s| s.deposit.as_ref().expect("a deposit"));
    assert!(a.weight_along_n > 0.0 && a.equilibrium_residual_n.abs() < 0.05 * a.weight_along_n, "{a:?}");
    close(a.weight_along_n, b.weight_along_n, 1e-9, "weight");
    // After the impact round-off has grown: what scatters by it is told in the same sense, far from the other sign.
    close(a.theoretical_static_force_n, b.theoretical_static_force_n, 1e-9, "static force");
    close(a.base_friction_n, b.base_friction_n, 0.1, "friction");
    let limits = |d: &super::summary::DepositResults| d.equilibrium_limits_n.expect("base and barrier hold all");
    close(limits(a)[0], limits(b)[0], 0.1, "least force");
    close(limits(a)[1], limits(b)[1], 0.1, "largest force");
    let barriers = [&right, &left].map(|s| s.barrier.as_ref().expect("a barrier"));
    close(barriers[0].peak_20ms_n, barriers[1].peak_20ms_n, 0.02, "peak");
}

#[test]
fn sand_in_two_bodies_is_the_same_sand() {
    let one = changed(&[]);
    let two = "bodies = [{ name = \"upper\", material = \"sand\", x_m = [-0.3, 0.0], y_m = [0.1, 0.3] }, \
               { name = \"lower\", material = \"sand\", x_m = [-0.3, 0.0], y_m = [0.0, 0.1] }]";
    let two = changed(&[(SAND.lines().find(|l| l.starts_with("bodies")).expect("bodies"), two)]);
    let [one, two] = [one, two].map(|case| run(&case).1);
    assert_eq!(one.stepping.settle_steps, two.stepping.settle_steps);
    close(one.stepping.settle_residual, two.stepping.settle_residual, 1e-6, "residual");
    close(one.scales.front_length_m, two.scales.front_length_m, 1e-12, "front length");
    close(one.front[1].time_s, two.front[1].time_s, 1e-6, "front");
    let peaks = [&one, &two].map(|s| s.barrier.as_ref().expect("a barrier").peak_20ms_n);
    close(peaks[0], peaks[1], 0.02, "peak");
}

#[test]
fn a_layer_of_one_cell_settles_too() {
    let case = changed(&[
        ("inclination_deg = 30", "inclination_deg = 0"),
        ("y_m = [0.0, 0.3] }]", "y_m = [0.0, 0.05] }]"),
        ("residual = 1e-2", "residual = 1e-3"),
    ]);
    let (_, summary) = run(&case);
    // Four looks, 25 steps apart, or more.
    assert!(summary.stepping.settle_residual <= 1e-3 && summary.stepping.settle_steps >= 100, "{:?}", summary.stepping);
    let folder = tempfile::tempdir().expect("a folder");
    let mut hasty = case;
    if let Some(settle) = &mut hasty.stages.settle {
        (settle.max_time_s, settle.residual) = (1e-3, 1e-9);
    }
    let error = files::run_into(&hasty, folder.path(), &mut |_| true).map(|_| ()).expect_err("it cannot settle");
    assert!(error.to_string().contains("did not settle"), "{error}");
    assert!(folder.path().join("flow_snapshots.svg").exists(), "there is a picture of what did not settle");
}

#[test]
fn who_else_holds_a_deposit_takes_its_limits_away() {
    let limits = |case: &Case| {
        let deposit = run(case).1.deposit.expect("a deposit");
        assert!(deposit.equilibrium_residual_n.abs() < 0.05 * deposit.weight_along_n.abs().max(20.0), "{deposit:?}");
        deposit.equilibrium_limits_n
    };
    assert!(limits(&changed(&[])).is_some());
    let mut rubbed = changed(&[]);
    rubbed.side_walls.friction = 0.4;
    assert_eq!(limits(&rubbed), None, "side walls hold a part");
    // A second plane of the bed, below which the wall stands.
    let bent = changed(&[(
        "boundaries = [",
        "boundaries = [{ name = \"rise\", kind = \"plane\", point_m = [0.2, 0.0], normal_deg = 100, contact = \"coulomb\", friction = 0.3 },",
    )]);
    assert_eq!(limits(&bent), None, "two planes are the bed");
    // A base without a barrier holds what it holds.
    let mut alone = changed(&[]);
    alone.gauges.barrier = None;
    assert_eq!(limits(&alone), None, "the wall holds a part and is no barrier");
}

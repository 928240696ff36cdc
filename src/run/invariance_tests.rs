//! What a run reports is a property of the flow. The rung `verification/invariance` transforms the flume and a barrier; here is what it
//! leaves out: rows of files, energies without a barrier, thin layers, who else holds a deposit.

use super::{Records, Summary, files, run_in_memory};
use crate::case::{self, Case};
use crate::output::Table;

/// Sand that falls apart on a bed of 30 degrees against a wall.
const SAND: &str = r#"
title = "sand"
gravity = { inclination_deg = 30 }
grid = { spacing_m = 0.05, thickness_m = 0.2, particles_per_cell = 9 }
domain = { x_m = [-0.5, 1.0], y_m = [-0.2, 0.8] }
materials.sand = { law = "drucker_prager", density_kg_per_m3 = 1500, young_pa = 1e6, poisson = 0.3, friction_angle_deg = 31, cone = "triaxial_compression" }
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
    let runs = ["20", "1000", "1e5"].map(|rate| {
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
        assert!(*text == runs[1].0, "{text}\n{}", runs[1].0);
        // The tables add up to the same, but for what comes after their last row.
        let all = summary.barrier.as_ref().expect("a barrier").impulse_normal_n_s;
        close(*impulse, all, 0.07, "impulse of a table");
    }
    assert_eq!([0, 1].map(|k| runs[k].2), [24, 1200]);
    assert!(runs[2].2 as u64 == runs[0].1.stepping.run_steps, "a row is a step at the least");
    let peak = runs[1].1.barrier.as_ref().expect("a barrier");
    assert!(peak.peak_20ms_n > 50.0 && peak.arrival_s.is_some(), "{peak:?}");
    close(peak.peak_20ms_n, peak.peak_20ms_by_steps_n, 0.05, "peaks over 20 ms");
    assert!(peak.run_up_p95_m > 0.05 && peak.run_up_p95_m < peak.run_up_m, "{peak:?}");
}

#[test]
fn what_rest_is_judged_by_does_not_depend_on_the_rate_of_the_tables() {
    let released = ["1000", "1e4"].map(|rate| {
        let folder = tempfile::tempdir().expect("a folder");
        let gauges = format!("stations_m = [0.1, 0.3], sample_rate_hz = {rate} }}");
        let case = changed(&[("stations_m = [0.1, 0.3] }", &gauges), ("end_time_s = 1.2", "end_time_s = 0.155")]);
        let run = files::run_into(&case, folder.path(), &mut |_| true).unwrap_or_else(|e| panic!("{e}"));
        run.0.released.to_bits()
    });
    assert_eq!(released[0], released[1]);
}

#[test]
fn material_that_lies_at_a_barrier_from_the_start_has_no_front_there() {
    // The wall stands where the gate stood: the first row finds it under load. The flow passed a station, which is no arrival.
    let at_once = [
        ("foot_m = [0.6, 0.0], height_m = 0.5,", "foot_m = [0.0, 0.0], height_m = 0.5,"),
        ("stations_m = [0.1, 0.3]", "stations_m = [-0.2]"),
    ];
    let (records, summary) = run(&changed(&at_once));
    let b = summary.barrier.as_ref().expect("a wall");
    assert_eq!(b.arrival_s, Some(records.history[0].time));
    assert_eq!((summary.front.len(), summary.arriving, b.peak_20ms_alpha_1, b.elastic_impact_n), (1, None, None, None));
    let (_, summary) = run(&changed(&[]));
    assert_eq!((summary.front.len(), summary.arriving), (3, Some(2)));
    assert!(summary.barrier.is_some_and(|b| b.peak_20ms_alpha_1.is_some()));
}

#[test]
fn a_rate_that_leaves_tables_empty_is_refused() {
    let text = SAND.replace("barrier = \"wall\",", "barrier = \"wall\", sample_rate_hz = 1,");
    let error = case::parse(&text, "sand.toml").expect_err("no row").to_string();
    assert!(error.contains("sample_rate_hz") && error.contains("at least 10 rows"), "{error}");
}

#[test]
fn shares_of_energy_know_no_origin_without_a_barrier() {
    let [here, there] = [0.0, 100.0].map(|by| {
        let mut case = changed(&[]);
        case.gauges.barrier = None;
        let shift = |x: &mut f64| *x += by;
        let pair = |x: &mut [f64; 2]| x.iter_mut().for_each(shift);
        [&mut case.domain.x_m, &mut case.domain.y_m].into_iter().for_each(pair);
        case.bodies.iter_mut().flat_map(|b| [&mut b.x_m, &mut b.y_m]).flatten().for_each(pair);
        for b in &mut case.boundaries {
            b.point_m.iter_mut().chain(&mut b.foot_m).for_each(pair);
        }
        case.gauges.stations_m.iter_mut().for_each(shift);
        run(&case).1.energy
    });
    assert!(here.initial_j > 1.0 && here.released_j > 1.0 && here.residual_of_released_1 < 0.05, "{here:?}");
    let of = |e: &super::summary::EnergyResults| {
        [e.initial_j, e.released_j, e.gravitational_1, e.plastic_1, e.friction_1, e.kinetic_max_1]
    };
    // Round-off of places of 100 m, on cells of 5 cm, over the impact of a few hundred points.
    for (a, b) in of(&here).into_iter().zip(of(&there)) {
        assert!((a - b).abs() < 1e-3 * a.abs() + 1e-12 * here.initial_j, "{a} {b}");
    }
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

use super::super::{Experiment, Records, files, run_in_memory};
use super::*;
use crate::case;
use crate::gauge::{BaseSample, WindowSample};
use crate::output::Table;
use std::path::Path;

/// A block of rubber on a rough floor that falls towards a wall, or rests.
const BLOCK: &str = r#"
title = "block"
[gravity]
inclination_deg = 20
[grid]
spacing_m = 0.05
thickness_m = 0.1
[domain]
x_m = [-0.5, 0.5]
y_m = [-0.2, 0.6]
[materials.rubber]
law = "linear_elastic"
density_kg_per_m3 = 1000
young_pa = 1.0e5
poisson = 0.2
[[bodies]]
name = "block"
material = "rubber"
x_m = [-0.1, 0.1]
y_m = [0.0, 0.2]
[[boundaries]]
name = "floor"
kind = "plane"
point_m = [0.0, 0.0]
normal_deg = 90
contact = "rough"
[[boundaries]]
name = "The wall"
kind = "wall"
foot_m = [0.2, 0.0]
height_m = 0.4
contact = "smooth"
[stages.run]
end_time_s = 0.3
stop_at_rest = false
[output]
vtk_interval_s = 0.1
"#;

const SETTLE: &str =
    "[stages.settle]\ndamping_per_s = 20\nresidual = 1.0e-3\nmax_time_s = 5.0\n[numerics]\npic_rate_per_s = 20\n";
const THROWN: &str = "name = \"block\"\nvelocity_m_per_s = [1.5, -1.0]\n";

fn block(gauges: &str, more: &str, thrown: bool) -> Case {
    let text = if thrown { BLOCK.replacen("name = \"block\"\n", THROWN, 1) } else { BLOCK.into() };
    case::parse(&format!("{text}{more}[gauges]\n{gauges}\n"), "block.toml").unwrap_or_else(|e| panic!("{e}")).case
}

/// The block that is thrown at floor and wall, both of which rub on it.
fn struck(gauges: &str) -> Case {
    let case = block(gauges, "", true);
    let mut text: toml::Table = case.to_toml().expect("TOML").parse().expect("TOML");
    for boundary in text["boundaries"].as_array_mut().expect("a list") {
        let boundary = boundary.as_table_mut().expect("a table");
        boundary.extend([("contact".into(), "coulomb".into()), ("friction".into(), 0.3.into())]);
    }
    case::parse(&text.to_string(), "struck.toml").unwrap_or_else(|e| panic!("{e}")).case
}

fn run(case: &Case) -> (Experiment, Records) {
    let (experiment, records, _) = run_in_memory(case, &mut |_| true).unwrap_or_else(|e| panic!("{e}"));
    (experiment, records)
}

/// Names of what is in a folder.
fn names(at: &Path) -> Vec<String> {
    let entries = std::fs::read_dir(at).expect("files");
    let mut names: Vec<_> = entries.map(|e| e.expect("a file").file_name().into_string().expect("text")).collect();
    names.sort_unstable();
    names
}

#[test]
fn a_base_without_a_barrier_carries_what_rests_on_it() {
    let (experiment, records) = run(&block("base = \"floor\"", SETTLE, false));
    assert!(experiment.barriers().is_empty());
    // 0.2 m x 0.2 m x 0.1 m of 1000 kg/m3. What still swings when the stage of settling ends is far below the tolerance, and 3 % of
    // the force ten times above it.
    let (weight, angle) = (4.0 * 9.81, 20.0f64.to_radians());
    let mean =
        |value: fn(&HistoryRow) -> f64| records.history.iter().map(value).sum::<f64>() / records.history.len() as f64;
    let (normal, friction) = (mean(|r| r.base.normal), mean(|r| r.base.friction));
    assert!((normal / (weight * angle.cos()) - 1.0).abs() < 3e-3, "{normal} of {}", weight * angle.cos());
    // Up the flume, against the weight.
    assert!((friction / (-weight * angle.sin()) - 1.0).abs() < 3e-3, "{friction} of {}", -weight * angle.sin());
    // Beside a barrier it reads the same.
    let (_, beside) = run(&block("barrier = \"The wall\"\nbase = \"floor\"", SETTLE, false));
    assert!(records.history.iter().zip(&beside.history).all(|(a, b)| a.base == b.base));
}

#[test]
fn a_further_barrier_changes_nothing_of_the_first_and_both_take_what_the_ledger_says() {
    let (_, alone) = run(&block("barrier = \"floor\"", "", true));
    let (_, other) = run(&block("barrier = \"The wall\"", "", true));
    let (experiment, both) = run(&block("barriers = [\"floor\", \"The wall\"]", "", true));
    assert!(alone.history == both.history && alone.energy == both.energy && alone.momentum == both.momentum);
    assert_eq!(both.further.len(), 1);
    let forces =
        |r: &HistoryRow| (r.time, r.normal, r.tangential, r.moment, r.normal_max, r.layers, r.run_up, r.passage);
    let own: Vec<_> = both.further[0].history.iter().map(forces).collect();
    assert!(own == other.history.iter().map(forces).collect::<Vec<_>>());
    assert!(own.iter().any(|f| f.1 > 10.0) && both.history.iter().any(|r| r.normal > 10.0), "both are struck");

    // Impulses from the samples: the first ends one interval after the release.
    let last = both.momentum.last().expect("a row");
    let given = |history: &[HistoryRow], value: fn(&HistoryRow) -> f64| {
        let starts = std::iter::once(0.0).chain(history.iter().map(|r| r.time));
        let until = history.iter().zip(starts).filter(|(r, _)| r.time <= last.time);
        until.map(|(r, start)| value(r) * (r.time - start)).sum::<f64>()
    };
    let histories = [&both.history, &both.further[0].history];
    let normal = histories.map(|h| given(h, |r| r.normal));
    let tangential = histories.map(|h| given(h, |r| r.tangential));
    // The floor's normal is y and its tangent x; the wall's normal is -x and its tangent y.
    let on_block = [-tangential[0] - normal[1], normal[0] - tangential[1]];
    for (d, given) in on_block.into_iter().enumerate() {
        let left = last.gained[d] - last.ledger.gravity[d] - given;
        assert!(left.abs() < 1e-9 * last.ledger.impulse_scale, "{d}: {left} of {}", last.ledger.impulse_scale);
    }
    assert_eq!(experiment.barriers().iter().map(Barrier::name).collect::<Vec<_>>(), ["floor", "The wall"]);
}

#[test]
fn a_further_barrier_has_files_of_its_own() {
    let folder = tempfile::tempdir().expect("a folder");
    let (one, two) = (folder.path().join("one"), folder.path().join("two"));
    for (at, gauges) in [(&one, "barrier = \"floor\""), (&two, "barriers = [\"floor\", \"The wall\"]")] {
        std::fs::create_dir(at).expect("a folder");
        files::run_into(&block(gauges, "", true), at, &mut |_| true).unwrap_or_else(|e| panic!("{e}"));
    }
    let first = names(&one);
    for name in first.iter().filter(|n| *n != "summary.toml" && *n != "vtk") {
        assert!(std::fs::read(one.join(name)).ok() == std::fs::read(two.join(name)).ok(), "{name}");
    }
    let more: Vec<_> = names(&two).into_iter().filter(|n| !first.contains(n)).collect();
    let expected = ["history", "pressure_profile"].map(|n| format!("{n}_the_wall.csv"));
    assert!(expected.iter().all(|n| more.contains(n)), "{more:?}");
    let summary: toml::Table = std::fs::read_to_string(two.join("summary.toml")).expect("text").parse().expect("TOML");
    let further = &summary["further_barriers"][0];
    assert_eq!(further["name"].as_str(), Some("The wall"));
    assert!(further["barrier"]["peak_step_n"].as_float() > Some(10.0), "{further}");
    assert_eq!(summary["case"]["gauges"]["barriers"].as_array().map(Vec::len), Some(2));
}

/// Two bases, and a window without a name.
const TWO_BASES: &str =
    "bases = [\"floor\", \"The wall\"]\nwindow_x_m = [0.0, 0.15]\nwindow_y_m = [0.02, 0.1]\nfield_times_s = [0.3]";

/// A row without its forces on the base and its speeds in the window.
fn rest_of(row: &HistoryRow) -> HistoryRow {
    HistoryRow { base: BaseSample::default(), window: WindowSample::default(), ..*row }
}

#[test]
fn each_of_two_bases_carries_what_the_ledger_says() {
    let (experiment, records) = run(&struck(TWO_BASES));
    assert_eq!(records.further_bases.len(), 1);
    let last = records.momentum.last().expect("a row");
    for (base, samples) in experiment.bases().iter().zip([&records.history, &records.further_bases[0]]) {
        let index = experiment.simulation().boundary_index(&base.name).expect("a boundary");
        let b = &experiment.simulation().boundaries()[index];
        let starts = std::iter::once(0.0).chain(samples.iter().map(|r| r.time));
        let until = samples.iter().zip(starts).filter(|(r, _)| r.time <= last.time);
        let (normal, friction) = until.fold((0.0, 0.0), |(normal, friction), (r, start)| {
            (normal + r.base.normal * (r.time - start), friction + r.base.friction * (r.time - start))
        });
        // What the boundary gave to the block since the release, as momentum.csv has it.
        let [x, y] = last.ledger.boundaries[index].impulse;
        let scale = x.hypot(y);
        assert!(normal > 0.1 && friction.abs() > 0.01 * normal, "{} is struck: {normal} {friction} N s", base.name);
        // Sums of a few hundred means times their intervals: round-off, far below 3 % of the force.
        for (found, along) in [(normal, b.normal), (friction, b.tangent)] {
            let given = x * along.x + y * along.y;
            assert!((found - given).abs() < 1e-11 * scale, "{}: {found} of {given} N s", base.name);
        }
    }
}

#[test]
fn a_base_reads_the_same_bits_whether_it_is_the_first_or_not() {
    let (_, one) = run(&struck(TWO_BASES));
    let (_, other) = run(&struck(&TWO_BASES.replace("\"floor\", \"The wall\"", "\"The wall\", \"floor\"")));
    let forces = |rows: &[HistoryRow]| rows.iter().map(|r| (r.time, r.base)).collect::<Vec<_>>();
    assert!(forces(&one.history) == forces(&other.further_bases[0]));
    assert!(forces(&other.history) == forces(&one.further_bases[0]));
    let both = [&one.history, &other.history].map(|rows| rows.iter().map(|r| r.base.normal).fold(0.0, f64::max));
    assert!(both.iter().all(|n| *n > 10.0) && both[0] != both[1], "{both:?}");
    // And nothing else changes.
    let rest = |records: &Records| records.history.iter().map(rest_of).collect::<Vec<_>>();
    assert!(rest(&one) == rest(&other) && one.momentum == other.momentum && one.energy == other.energy);
}

#[test]
fn a_window_with_a_name_reads_the_same_bits_as_the_one_without() {
    let left = "{ name = \"left\", x_m = [-0.2, 0.0], y_m = [0.0, 0.1] }";
    let right = "{ name = \"Right\", x_m = [0.0, 0.15], y_m = [0.02, 0.1] }";
    let (_, unnamed) = run(&struck(TWO_BASES));
    let (_, named) = run(&struck(&format!("{TWO_BASES}\nwindows = [{left}, {right}]")));
    let speeds = |rows: &[HistoryRow]| rows.iter().map(|r| (r.time, r.window)).collect::<Vec<_>>();
    assert_eq!((unnamed.windows.len(), named.windows.len()), (0, 2));
    assert!(speeds(&named.windows[1]) == speeds(&unnamed.history));
    assert!(speeds(&named.windows[0]) != speeds(&unnamed.history));
    assert!(unnamed.history == named.history && unnamed.further_bases == named.further_bases);
    // The block flies in at 1.8 m/s.
    let fastest = named.windows[1].iter().map(|r| r.window.mean).fold(0.0, f64::max);
    assert!(fastest > 1.0 && fastest < 2.0, "{fastest} m/s");
}

#[test]
fn further_bases_and_windows_have_files_of_their_own() {
    let folder = tempfile::tempdir().expect("a folder");
    let (one, two) = (folder.path().join("one"), folder.path().join("two"));
    let window = "window_x_m = [0.0, 0.15]\nwindow_y_m = [0.02, 0.1]\nfield_times_s = [0.3]";
    let again = "windows = [{ name = \"To the right\", x_m = [0.0, 0.15], y_m = [0.02, 0.1] }]";
    for (at, gauges) in [(&one, format!("base = \"floor\"\n{window}")), (&two, format!("{TWO_BASES}\n{again}"))] {
        std::fs::create_dir(at).expect("a folder");
        files::run_into(&struck(&gauges), at, &mut |_| true).unwrap_or_else(|e| panic!("{e}"));
    }
    let (first, all) = (names(&one), names(&two));
    for name in first.iter().filter(|n| *n != "summary.toml" && *n != "vtk") {
        assert!(std::fs::read(one.join(name)).ok() == std::fs::read(two.join(name)).ok(), "{name}");
    }
    let more: Vec<_> = all.into_iter().filter(|n| !first.contains(n)).collect();
    assert_eq!(more, ["base_the_wall.csv", "window_to_the_right.csv"]);

    let table = |name: &str| Table::load(two.join(name)).expect("a table");
    let column = |table: &Table, name: &str| table.column(name).unwrap_or_else(|e| panic!("{e}")).to_vec();
    let (history, base, window) = (table("history.csv"), table(&more[0]), table(&more[1]));
    for name in ["time_s", "window_speed_mean_m_per_s", "window_speed_p95_m_per_s"] {
        assert!(column(&window, name) == column(&history, name), "{name}");
    }
    let summary = |at: &Path| -> toml::Table {
        std::fs::read_to_string(at.join("summary.toml")).expect("text").parse().expect("TOML")
    };
    let (before, after) = (summary(&one), summary(&two));
    // The run is over after 0.3 s: its means over that time are those of all samples.
    let time = column(&base, "time_s");
    let end = time[time.len() - 1];
    for name in ["base_normal_n", "base_friction_n"] {
        let values = column(&base, name);
        let late: Vec<f64> = time.iter().zip(values).filter(|(t, _)| **t > end - 0.3).map(|(_, v)| v).collect();
        let mean = late.iter().sum::<f64>() / late.len() as f64;
        let told = after["further_bases"][0][name].as_float().expect("a number");
        assert!((told - mean).abs() < 1e-6 * mean.abs(), "{name}: {told} of {mean}");
    }
    assert!(after["further_bases"][0]["base_normal_n"].as_float() > Some(1.0));
    assert_eq!(after["further_bases"][0]["name"].as_str(), Some("The wall"));
    assert!(!before.contains_key("further_bases") && !before["case"]["gauges"].to_string().contains("bases"));
}

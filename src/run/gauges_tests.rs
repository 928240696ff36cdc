use super::super::{Experiment, Records, files, run_in_memory};
use super::*;
use crate::case;

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

fn run(case: &Case) -> (Experiment, Records) {
    let (experiment, records, _) = run_in_memory(case, &mut |_| true).unwrap_or_else(|e| panic!("{e}"));
    (experiment, records)
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
        |r: &HistoryRow| (r.time, r.normal, r.tangential, r.moment, r.normal_max, r.layers, r.run_up, r.overtopped);
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
    let names = |at: &std::path::Path| {
        let mut names: Vec<_> = std::fs::read_dir(at)
            .expect("files")
            .map(|e| e.expect("a file").file_name().into_string().expect("text"))
            .collect();
        names.sort_unstable();
        names
    };
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

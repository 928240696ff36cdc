//! Which numbers of the files are closed.
//!
//! A number is closed if 3 % more of it and 3 % less of it, in its file, both make a check of a scene fail. It is tried, scene by scene;
//! [`CLOSED`] is what came out, and the rung fails if anything else does. What is left has its reason in [`NOT_CLOSED`].

use super::SCENES;
use super::closed::CLOSED;
use crate::Outcome;
use crate::from_file::{Files, Wrong};
use crate::report::quoted;
use checkdam::check::{Check, Kind};
use std::collections::BTreeMap;

/// Key of a file and why 3 % of it go unseen.
pub const NOT_CLOSED: &[(&str, &str)] = &[
    ("barrier.csv/imbalance", "round-off, which is small and has no size: a bound is checked"),
    ("barrier_NAME.csv/imbalance", "round-off, which is small and has no size: a bound is checked"),
    ("flow.vtp/Points.z", "zero in a plane, which is checked"),
    ("flow.vtp/stress_pa.xz", "zero in a plane, which is checked"),
    ("flow.vtp/stress_pa.yz", "zero in a plane, which is checked"),
    ("flow.vtp/velocity_m_per_s.z", "zero in a plane, which is checked"),
    ("history.csv/passed_under_kg", "zero: what passes a body is said to have gone over it"),
    ("history_NAME.csv/passed_under_kg", "zero: what passes a body is said to have gone over it"),
    ("summary.toml/barrier.passed_under_kg", "zero: what passes a body is said to have gone over it"),
    (
        "summary.toml/further_barriers.N.barrier.passed_under_kg",
        "zero: what passes a body is said to have gone over it",
    ),
    (
        "summary.toml/further_barriers.N.structure.imbalance_1",
        "round-off, which is small and has no size: a bound is checked",
    ),
    ("summary.toml/structure.imbalance_1", "round-off, which is small and has no size: a bound is checked"),
];

/// Numbers that a mistake may exchange.
const EXCHANGED: &[(&str, &str)] = &[
    ("flow.vtp/stress_pa.xx", "flow.vtp/stress_pa.yy"),
    ("flow.vtp/stress_pa.yy", "flow.vtp/stress_pa.zz"),
    ("flow.vtp/stress_pa.yy", "flow.vtp/stress_pa.xy"),
    ("flow.vtp/velocity_m_per_s.x", "flow.vtp/velocity_m_per_s.y"),
    ("flow.vtp/Points.x", "flow.vtp/Points.y"),
    ("history.csv/force_normal_n", "history.csv/force_tangential_n"),
    ("history.csv/force_normal_n", "history.csv/force_normal_max_n"),
    ("history.csv/force_layer1_n", "history.csv/force_layer3_n"),
    ("history.csv/force_layer2_n", "history.csv/force_layer3_n"),
    ("history.csv/run_up_m", "history.csv/run_up_p95_m"),
    ("barrier.csv/contact_normal_n", "barrier.csv/clamp_normal_n"),
    ("barrier.csv/contact_tangential_n", "barrier.csv/clamp_tangential_n"),
    ("barrier.csv/contact_normal_n", "barrier.csv/contact_tangential_n"),
    ("barrier.csv/clamp_normal_n", "barrier.csv/clamp_moment_n_m"),
    ("barrier.csv/inertia_normal_n", "barrier.csv/inertia_tangential_n"),
    ("barrier.csv/tip_deflection_m", "barrier.csv/tip_velocity_m_per_s"),
    ("barrier.csv/tip_deflection_m", "barrier.csv/largest_deflection_m"),
    ("barrier_profile.csv/deflection_m", "barrier_profile.csv/velocity_m_per_s"),
    ("barrier_outline.csv/x_m", "barrier_outline.csv/y_m"),
    ("contact.csv/pressure_pa", "contact.csv/shear_pa"),
    ("contact.csv/x_m", "contact.csv/y_m"),
    ("contact.csv/normal_x_1", "contact.csv/normal_y_1"),
    ("summary.toml/barrier.static_force_n", "summary.toml/barrier.static_shear_n"),
    ("summary.toml/barrier.static_layer1_n", "summary.toml/barrier.static_layer3_n"),
    ("summary.toml/structure.static_clamp_n", "summary.toml/barrier.static_force_n"),
    ("summary.toml/barrier.peak_step_n", "summary.toml/barrier.peak_20ms_n"),
];

/// What of `history.csv` is read at a barrier.
const AT_A_BARRIER: &[&str] =
    &["force_", "overturning_moment_n_m", "run_up_", "overtopped_kg", "passed_under_kg", "passed_kg"];

/// The key for whatever barrier, or nothing if it does not belong to one that is a body.
fn general(key: &str) -> Option<String> {
    let (file, name) = key.split_once('/')?;
    let second = file.contains("_second.csv") || file.contains("_first.csv");
    let general = key.replace("_second.csv", "_NAME.csv").replace("_first.csv", "_NAME.csv");
    let general = general.replace("further_barriers.0.", "further_barriers.N.");
    let pair = |kind: &str| (file == "energy.csv" && name.starts_with(kind)).then(|| format!("{file}/{kind}PAIR_j"));
    let general = pair("friction_").or_else(|| pair("contact_")).unwrap_or(general);
    let tables = ["barrier", "contact", "pressure_profile"];
    let own = match file {
        "summary.toml" => ["barrier.", "structure.", "further_barriers."].iter().any(|start| name.starts_with(start)),
        "history.csv" => name == "time_s" || AT_A_BARRIER.iter().any(|start| name.starts_with(start)),
        "momentum.csv" => name.starts_with("clamp_") || name.starts_with("gained_"),
        "energy.csv" => name.contains("_on_"),
        // Those of sand.
        "flow.vtp" => !matches!(name, "opened_strain" | "plastic_shear_strain"),
        _ => second || tables.iter().any(|table| file.starts_with(table)),
    };
    own.then_some(general)
}

/// Whether a check fails when this is wrong in the last run of a scene.
fn notices(scene: usize, files: &[Files], wrong: Wrong) -> bool {
    let mut files = files.to_vec();
    if let Some(last) = files.last_mut() {
        *last = last.made_wrong(wrong);
    }
    (SCENES[scene].judge)(&files).iter().any(|check| !check.passes())
}

/// By key: the first scene that notices both 3 % more and 3 % less.
pub fn found(runs: &[Vec<Files>]) -> BTreeMap<String, Option<usize>> {
    let mut found: BTreeMap<String, Option<usize>> = BTreeMap::new();
    for (scene, files) in runs.iter().enumerate() {
        for key in files.last().map(Files::keys).unwrap_or_default() {
            let Some(name) = general(&key) else { continue };
            let closed = found.entry(name).or_default();
            if closed.is_none()
                && [1.03, 0.97].into_iter().all(|f| notices(scene, files, Wrong::Scaled(key.clone(), f)))
            {
                *closed = Some(scene);
            }
        }
    }
    found
}

/// Pairs that no scene notices when they are exchanged.
pub fn unnoticed(runs: &[Vec<Files>]) -> Vec<&'static (&'static str, &'static str)> {
    let noticed = |(a, b): &(&str, &str)| {
        let exchanged = || Wrong::Exchanged((*a).into(), (*b).into());
        runs.iter().enumerate().any(|(scene, files)| notices(scene, files, exchanged()))
    };
    EXCHANGED.iter().filter(|pair| !noticed(pair)).collect()
}

/// Finds out, and judges the lists.
pub fn run(runs: &[Vec<Files>], outcome: &mut Outcome) {
    let found = found(runs);
    let listed = |key: &str| NOT_CLOSED.iter().any(|(k, _)| *k == key);
    let open = found.iter().filter(|(key, scene)| scene.is_none() != listed(key)).count();
    let closed: Vec<&str> = found.iter().filter(|(_, scene)| scene.is_some()).map(|(key, _)| key.as_str()).collect();
    let strays = CLOSED.iter().filter(|key| !closed.contains(key)).count()
        + closed.iter().filter(|key| !CLOSED.contains(key)).count();
    let mut count = |what: &str, number: usize| {
        outcome.check(
            Check::at_most(what, number as f64, 0.0, "1")
                .because("a whole number")
                .from(Kind::Conservation, "every number in its file, 3 % more and 3 % less"),
        );
    };
    count("numbers of barriers that are bodies, not closed and without a reason", open);
    count("numbers that the list of closed ones has wrongly or lacks", strays);
    count("pairs of numbers whose exchange goes unseen", unnoticed(runs).len());
    let mut table = String::from("key,closed_by,why_not\n");
    for (key, scene) in &found {
        let why = NOT_CLOSED.iter().find(|(k, _)| k == key).map_or("", |k| k.1);
        let by = scene.map_or("", |scene| SCENES[scene].name);
        table.push_str(&format!("{},{},{}\n", quoted(key), quoted(by), quoted(why)));
    }
    outcome.tables.push(("files_body_keys".into(), table));
}

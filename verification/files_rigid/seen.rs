//! Which numbers of the files these checks close: each is read 3 % too large, alone, or in place of its neighbour, and judged once more.

use super::setting::Setting;
use super::{Outcome, Scene};
use crate::from_file::{Files, Wrong};
use checkdam::check::{Check, Kind};
use checkdam::run::columns;
use rayon::prelude::*;
use std::collections::BTreeMap;

/// Columns that only cases with inflows write.
const OF_INFLOWS: [&str; 4] = ["entered_kg", "inflow_j", "inflow_x_n_s", "inflow_y_n_s"];

/// How much too large.
const FACTOR: f64 = 1.03;

/// Tables of barriers that are bodies, and what the summary says of them.
pub const BODIES: &[&str] =
    &["barrier.csv", "barrier_profile.csv", "barrier_profile_at_peak.csv", "barrier_outline.csv", "contact.csv"];

/// What no check closes, and why. Of the first kind are numbers that are zero in every run, or round-off.
pub const NOT_CLOSED: &[(&str, &str)] = &[
    ("boundaries.vtp/Points.z", PLANE),
    ("flow.vtp/Points.z", PLANE),
    ("flow.vtp/velocity_m_per_s.z", PLANE),
    ("flow.vtp/stress_pa.xz", PLANE),
    ("flow.vtp/stress_pa.yz", PLANE),
    ("energy.csv/damping_j", DAMPING),
    ("momentum.csv/damping_x_n_s", DAMPING),
    ("momentum.csv/damping_y_n_s", DAMPING),
    ("history.csv/penetration_m", INSIDE),
    ("summary.toml/momentum.penetration_m", INSIDE),
    ("momentum.csv/residual_x_n_s", ROUND_OFF),
    ("momentum.csv/residual_y_n_s", ROUND_OFF),
    ("summary.toml/momentum.momentum_closure_1", ROUND_OFF),
];

const PLANE: &str = "zero in the plane of the simulation";
const DAMPING: &str = "zero: damping ends at release; another number is seen";
const INSIDE: &str = "zero: no point lies inside a boundary in these cases; another number is seen";
const ROUND_OFF: &str = "round-off; more than that is seen";

/// What is known of a kind of number.
#[derive(Debug, Clone, Default)]
struct Seen {
    scene: &'static str,
    failing: usize,
    first: String,
    live: bool,
}

pub fn judge(read: &[(&Scene, Setting, Files)], outcome: &mut Outcome) {
    let mut known: BTreeMap<String, Seen> = BTreeMap::new();
    let mut exchanged: BTreeMap<String, bool> = BTreeMap::new();
    for (scene, set, files) in read {
        let keys = files.keys();
        let fresh: Vec<(&String, String)> = keys
            .iter()
            .map(|k| (k, kind(set, k)))
            .filter(|(_, kind)| known.get(kind).is_none_or(|s| s.failing == 0))
            .collect();
        let found: Vec<(String, Seen)> = fresh
            .par_iter()
            .map(|(key, kind)| {
                let live = files.values(key).iter().any(|v| *v != 0.0 && !v.is_nan());
                let (failing, first) = if live {
                    failing(scene, set, &files.made_wrong(Wrong::Scaled((*key).clone(), FACTOR)))
                } else {
                    (0, String::new())
                };
                (kind.clone(), Seen { scene: scene.name, failing, first, live })
            })
            .collect();
        for (kind, seen) in found {
            let before = known.entry(kind).or_default();
            if before.failing == 0 && (seen.live || !before.live) {
                *before = seen;
            }
        }
        let pair = |a: &String, b: &String| format!("{} and {}", kind(set, a), kind(set, b));
        let pairs = keys.iter().zip(keys.iter().skip(1)).filter(|(a, b)| differ(files, a, b));
        let pairs: Vec<(&String, &String)> = pairs.filter(|(a, b)| exchanged.get(&pair(a, b)) != Some(&true)).collect();
        let found: Vec<(String, bool)> = pairs
            .par_iter()
            .map(|(a, b)| {
                let wrong = Wrong::Exchanged((*a).clone(), (*b).clone());
                (pair(a, b), failing(scene, set, &files.made_wrong(wrong)).0 > 0)
            })
            .collect();
        for (pair, noticed) in found {
            *exchanged.entry(pair).or_default() |= noticed;
        }
    }
    report(&known, &exchanged, outcome);
}

/// Checks that fail, and the first of them.
fn failing(scene: &Scene, set: &Setting, files: &Files) -> (usize, String) {
    let judge = scene.judge(set, files);
    let failing: Vec<&Check> = judge.checks.iter().filter(|c| !c.passes()).collect();
    (failing.len(), failing.first().map_or_else(String::new, |c| c.what.clone()))
}

/// Whether two neighbours of one file could be taken for each other, and are not the same.
fn differ(files: &Files, a: &str, b: &str) -> bool {
    let folder = |key: &str| key.split_once('/').map_or("", |k| k.0).to_string();
    let (one, other) = (files.values(a), files.values(b));
    folder(a) == folder(b) && folder(a) != "summary.toml" && one.len() == other.len() && one != other
}

/// A key without the names that a case gave and without the numbers of a list.
fn kind(set: &Setting, key: &str) -> String {
    let (file, name) = key.split_once('/').unwrap_or((key, ""));
    let named = ["history", "pressure_profile", "base", "window"]
        .into_iter()
        .find(|f| file.starts_with(&format!("{f}_")) && file != "pressure_profile.csv");
    let file = match named {
        Some("pressure_profile") => "pressure_profile.csv".to_string(),
        Some(start) => format!("{start}_NAME.csv"),
        None => file.to_string(),
    };
    let names = set.boundaries.iter().map(|b| b.name.as_str());
    let name = match file.as_str() {
        "energy.csv" => names.fold(name.to_string(), |n, b| {
            let own = ["friction", "contact"].iter().any(|k| n == format!("{k}_{b}_j"));
            if own { n.replace(b, "{surface}") } else { n }
        }),
        "momentum.csv" => names.fold(name.to_string(), |n, b| {
            n.strip_prefix(&format!("{b}_")).map_or(n.clone(), |rest| format!("{{boundary}}_{rest}"))
        }),
        "summary.toml" => {
            let parts: Vec<&str> = name.split('.').collect();
            let material = |k: usize| k == 2 && parts[1] == "materials";
            let number = |p: &str| p.chars().all(|c| c.is_ascii_digit());
            let kept = |k: usize| !material(k) && (!number(parts[k]) || k + 1 == parts.len());
            (0..parts.len()).filter(|k| kept(*k)).map(|k| parts[k]).collect::<Vec<_>>().join(".")
        }
        _ => name.to_string(),
    };
    format!("{file}/{name}")
}

fn report(known: &BTreeMap<String, Seen>, exchanged: &BTreeMap<String, bool>, outcome: &mut Outcome) {
    let listed = |kind: &str| NOT_CLOSED.iter().find(|n| n.0 == kind);
    let mut text = String::from("number,in_the_case,checks_that_fail,the_first\n");
    for (kind, seen) in known {
        let why = match (seen.failing, listed(kind), seen.live) {
            (0, Some((_, why)), _) => format!("none: {why}"),
            (0, None, false) => "none: it is zero everywhere".into(),
            (0, None, true) => "none".into(),
            _ => seen.first.clone(),
        };
        text += &format!("{kind},{},{},\"{why}\"\n", seen.scene, seen.failing);
    }
    outcome.tables.push(("files_rigid_seen".into(), text));
    let unseen = |pair: &str| pair.split(" and ").all(|kind| listed(kind).is_some());
    let lost: Vec<&String> =
        exchanged.iter().filter(|(pair, noticed)| !**noticed && !unseen(pair)).map(|(pair, _)| pair).collect();
    let open: Vec<&String> =
        known.iter().filter(|(k, s)| s.failing == 0 && listed(k).is_none()).map(|(k, _)| k).collect();
    let stale = NOT_CLOSED.iter().filter(|n| known.get(n.0).is_none_or(|s| s.failing > 0)).count();
    let tables = columns().into_iter().filter(|t| !BODIES.contains(&t.file));
    let missing = tables.flat_map(|t| t.columns.into_iter().map(move |c| format!("{}/{}", t.file, c.name)));
    let of_inflow = |key: &String| OF_INFLOWS.iter().any(|column| key.ends_with(&format!("/{column}")));
    let missing: Vec<String> = missing.filter(|key| !known.contains_key(key) && !of_inflow(key)).collect();
    let mut none = |what: &str, count: usize, reason: &str| {
        let check = Check::at_most(what, count as f64, 0.0, "1")
            .because(reason)
            .from(Kind::Conservation, "the program's list of columns; the files");
        outcome.check(check);
    };
    none(
        "numbers of the files that are 3 % too large unnoticed, and not on the list of those",
        open.len(),
        "each is closed, or has its reason",
    );
    none("numbers on that list that are noticed, or not there", stale, "the list is as short as can be");
    none("neighbours in a file that can be exchanged unnoticed", lost.len(), "each column is what its name says");
    none(
        "columns of the program's list that no case writes",
        missing.len(),
        "all but those of barriers that are bodies, and of inflows, which the rung `inflow` holds against what enters",
    );
}

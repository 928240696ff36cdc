//! Faults that are seeded in the program itself (`src/seeded`): what the ladder makes of them, and the table of who sees which.
//!
//! A fault counts as seen by a rung if a check of its fails that measured a number: no comparison of bytes, no run that breaks down.

#[path = "../src/seeded/ask.rs"]
mod ask;

use super::{root, rung};
use checkdam::seeded::{ALL, COMPILED};
use checkdam_verification::report::{Caught, quoted};
use checkdam_verification::{Fault, FaultKind, part};
use std::collections::BTreeMap;

/// Says which rung is asked; set for the child alone.
const RUNG: &str = "CHECKDAM_SEEDED_RUNG";
/// What the child says before the name of the check that fails.
const SEEN: &str = "seen by the check: ";
/// Rungs that are asked for the table, or after a colon a part of one, the quick ones first. The others take longer than all of these.
const QUICK: &[&str] = &[
    "drucker_prager_point",
    "law_points",
    "files_rigid:rest",
    "files_rigid:slide",
    "files_rigid:column",
    "files_rigid:flight",
    "files_rigid:gate",
    "files_rigid:hang",
    "files_rigid:slip",
    "files_body:a block at rest",
    "files_body:a block that slides",
    "files_body:a bar strikes a bar",
    "files_body:a bar by its mesh",
    "files_body:an implicit bar",
    "files_body:a turned bar",
    "files_body:a weight on a plate by its mesh",
    "files_body:a weight on an implicit plate",
    "files_body:two barriers",
    "files_body:a wall twice",
    "files_body:PIC by time and by steps",
    "self_weight",
    "celerity",
    "energy",
];

/// The check of a rung that fails most clearly under a fault, and how long it took (s).
fn asked(fault: &str, rung: &str) -> (Option<String>, f64) {
    let arguments = ["--ignored", "--exact", "seeded::one_rung", "--nocapture", "--test-threads=1"];
    let answer = ask::under(fault, &[(RUNG, rung)], &arguments, ask::LIMIT);
    let seen = answer.text.lines().find_map(|l| l.split_once(SEEN).map(|(_, check)| check.to_string()));
    (seen, answer.seconds)
}

#[test]
#[ignore = "a child of the tests below: judges a rung under a fault"]
fn one_rung() {
    let name = std::env::var(RUNG).expect("a parent that says which");
    let (name, part) = name.split_once(':').map_or((&name[..], None), |(name, part)| (name, Some(part)));
    part.into_iter().for_each(part::ask);
    let rung = rung(name);
    let (kind, factor) = (FaultKind::Friction, 1.0);
    let outcome = (rung.run)(&Fault::NONE).map_err(|e| e.to_string());
    let caught = Caught::from(rung.name, kind, factor, outcome);
    if caught.failing > 0 {
        println!("{SEEN}{}", caught.sharpest);
    }
}

#[test]
fn rungs_notice_what_the_table_says() {
    const { assert!(COMPILED, "tests have the switch") };
    let rows: Vec<_> = ask::table(root()).into_iter().filter(|r| r.judge == "rung").collect();
    let missed = ask::two_at_a_time(&rows, |row| {
        let seen = asked(&row.fault, &row.by).0;
        seen.is_none().then(|| format!("{} does not notice {}", row.by, row.fault))
    });
    let missed: Vec<String> = missed.into_iter().flatten().collect();
    assert!(missed.is_empty(), "{}", missed.join("\n"));
}

#[test]
fn every_fault_is_in_the_table_and_physics_sees_most() {
    let rows = ask::table(root());
    assert_eq!(rows.iter().map(|r| &r.fault[..]).collect::<Vec<_>>(), ALL.iter().map(|e| e.name).collect::<Vec<_>>());
    let unseen: Vec<&str> = rows.iter().filter(|r| r.judge == "nobody").map(|r| &r.fault[..]).collect();
    assert!(unseen.is_empty(), "nobody sees {unseen:?}");
    let physics = rows.iter().filter(|r| r.judge == "rung" || r.judge == "exact").count();
    assert!(100 * physics >= 95 * rows.len(), "physics sees {physics} of {}", rows.len());
}

#[test]
#[ignore = "asks the quick rungs about all faults, for the table; CONTRIBUTING.md says how"]
fn ask_the_rungs() {
    let names = ask::chosen("CHECKDAM_SEEDED_ONLY", ALL.iter().map(|e| e.name));
    let rungs = ask::chosen("CHECKDAM_SEEDED_RUNGS", QUICK.iter().copied());
    let pairs: Vec<_> = rungs.iter().flat_map(|r| names.iter().map(move |n| (*n, *r))).collect();
    ask::two_at_a_time(&pairs, |(name, rung)| {
        let (seen, seconds) = asked(name, rung);
        let line =
            if seen.is_some() { format!("{name},rung,{rung},{seconds:.2}\n") } else { format!("{name},not,{rung},\n") };
        ask::note(root(), &line);
    });
}

/// Makes the table of what was collected: the quickest is asked in `cargo test`, and physics before other tests. Under `also` stand all others
/// of those asked that time that see it; who was not asked is not there.
#[test]
#[ignore = "writes the table; CONTRIBUTING.md says how"]
fn written_down() {
    let notes = std::fs::read_to_string(ask::notes(root())).expect("answers");
    let mut answers: BTreeMap<(&str, &str), (&str, f64)> = BTreeMap::new();
    for line in notes.lines() {
        let cells: Vec<&str> = line.split(',').collect();
        let [fault, judge, by, seconds] = cells[..] else { continue };
        match judge {
            // Of all unit tests at once.
            "anew" => answers.retain(|at, a| at.0 != fault || a.0 == "rung"),
            "not" => {
                answers.remove(&(fault, by));
            }
            _ => {
                answers.insert((fault, by), (judge, seconds.parse().expect("seconds")));
            }
        }
    }
    // What nobody was asked about stays as it was.
    let before = std::fs::read_to_string(root().join(ask::TABLE)).expect("the table as it was");
    let kept: BTreeMap<&str, Vec<&str>> =
        before.lines().map(|l| (l.split(',').next().unwrap_or(l), l.split(',').collect())).collect();
    let mut text = String::from("fault,judge,by,also,kind,what\n");
    for entry in ALL {
        let asked = notes.lines().any(|line| line.split(',').next() == Some(entry.name));
        if let Some([_, judge, by, also, ..]) = kept.get(entry.name).filter(|_| !asked).map(|cells| &cells[..]) {
            text += &format!("{},{judge},{by},{also},{},{}\n", entry.name, entry.kind, quoted(entry.what));
            continue;
        }
        let mut seers: Vec<_> = answers.iter().filter(|(at, _)| at.0 == entry.name).map(|(at, a)| (at.1, *a)).collect();
        seers.sort_by(|a, b| (a.1.0 == "unit", a.1.1).partial_cmp(&(b.1.0 == "unit", b.1.1)).expect("seconds"));
        let (judge, by) = seers.first().map_or(("nobody", ""), |s| (s.1.0, s.0));
        let also = seers.iter().skip(1).map(|s| s.0).collect::<Vec<_>>().join("; ");
        text += &format!("{},{judge},{by},{also},{},{}\n", entry.name, entry.kind, quoted(entry.what));
    }
    std::fs::write(root().join(ask::TABLE), text).expect("the table");
}

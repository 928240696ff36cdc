//! Runs the ladder. Physics is judged first, then the reports are compared with those in `reports/verification`; after a
//! change of the physics that is meant, run with `CHECKDAM_BLESS=1` to write them anew.

use checkdam::verification::report::{faults_csv, files, ladder_csv};
use checkdam::verification::{Fault, FaultKind, Outcome, RUNGS, Rung};
use std::path::PathBuf;

fn rung(name: &str) -> &'static Rung {
    RUNGS.iter().find(|r| r.name == name).unwrap_or_else(|| panic!("no rung `{name}`"))
}

fn run(rung: &Rung, fault: &Fault) -> Outcome {
    (rung.run)(fault).unwrap_or_else(|e| panic!("{}: {e}", rung.name))
}

/// Compares a report with the committed one, or writes it where asked.
fn compare(stem: &str, text: &str) {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("reports/verification").join(format!("{stem}.csv"));
    if std::env::var("CHECKDAM_BLESS").is_ok_and(|v| v == "1") {
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(&path, text).unwrap();
        return;
    }
    let committed = std::fs::read_to_string(&path).unwrap_or_default();
    if committed != text {
        let line = committed.lines().zip(text.lines()).position(|(a, b)| a != b);
        let n = line.unwrap_or_else(|| committed.lines().count().min(text.lines().count()));
        let at = |s: &str| s.lines().nth(n).unwrap_or("(nothing)").to_string();
        panic!("{} changed, line {}:\n  was {}\n  is  {}", path.display(), n + 1, at(&committed), at(text));
    }
}

fn climb(name: &str) {
    let outcome = run(rung(name), &Fault::NONE);
    let verdict = outcome.verdict(name);
    println!("{verdict}");
    // For looking at, also when it fails.
    let seen = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("verification");
    std::fs::create_dir_all(&seen).unwrap();
    let files = files(name, &outcome);
    for (stem, text) in &files {
        std::fs::write(seen.join(format!("{stem}.csv")), text).unwrap();
    }
    assert!(verdict.passes(), "{verdict}");
    for (stem, text) in &files {
        compare(stem, text);
    }
}

/// One test per rung, and a test that none was forgotten.
macro_rules! ladder {
    ($($name:ident),* $(,)?) => {
        $(#[test] fn $name() { climb(stringify!($name)); })*

        #[test]
        fn every_rung_is_tested() {
            assert_eq!(RUNGS.iter().map(|r| r.name).collect::<Vec<_>>(), [$(stringify!($name)),*]);
            compare("ladder", &ladder_csv());
        }
    };
}

ladder!(
    exactness,
    self_weight,
    sliding_block,
    drucker_prager_point,
    celerity,
    energy,
    earth_pressure,
    wall_pressure,
    collapse,
    convergence
);

/// Each rung fails under each fault that it claims to catch, in either direction, and each fault is caught by some rung.
#[test]
fn every_fault_is_caught() {
    let mut rows = Vec::new();
    let mut missed = Vec::new();
    for rung in RUNGS {
        for (kind, factor) in rung.covers.iter().flat_map(|&(kind, factor)| [(kind, factor), (kind, 2.0 - factor)]) {
            let outcome = (rung.run)(&Fault::of(kind, factor));
            let (count, first) = match &outcome {
                // A run that breaks down is noticed, too.
                Err(failure) => (1, failure.to_string()),
                Ok(outcome) => {
                    let failing: Vec<_> = outcome.checks.iter().filter(|c| !c.passes()).collect();
                    (failing.len(), failing.first().map_or_else(String::new, |c| c.what.clone()))
                }
            };
            if count == 0 {
                missed.push(format!("{} does not notice {} x {factor}", rung.name, kind.name()));
            }
            rows.push((rung.name, kind.name(), factor, count, first));
        }
    }
    for kind in FaultKind::ALL {
        if !rows.iter().any(|r| r.1 == kind.name() && r.3 > 0) {
            missed.push(format!("no rung notices wrong {}", kind.name()));
        }
    }
    assert!(missed.is_empty(), "{}", missed.join("\n"));
    compare("faults", &faults_csv(&rows));
}

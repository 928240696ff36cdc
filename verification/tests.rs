//! Runs the ladder. Physics is judged first, then the reports are compared with those in `reports/verification`; after a
//! change of the physics that is meant, run with `INSTA_UPDATE=always` to write them anew.

use checkdam::verification::report::{faults_csv, ladder_csv, write};
use checkdam::verification::{Fault, FaultKind, Outcome, RUNGS, Rung};
use std::path::PathBuf;

fn rung(name: &str) -> &'static Rung {
    RUNGS.iter().find(|r| r.name == name).unwrap_or_else(|| panic!("no rung `{name}`"))
}

fn run(rung: &Rung, fault: &Fault) -> Outcome {
    (rung.run)(fault).unwrap_or_else(|e| panic!("{}: {e}", rung.name))
}

/// Compares a report with the one in `reports/verification`.
fn compare(file: &str, content: &str) {
    let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("reports/verification");
    insta::with_settings!({ snapshot_path => folder, prepend_module_to_snapshot => false }, {
        insta::assert_binary_snapshot!(file, content.as_bytes().to_vec());
    });
}

fn climb(name: &str) {
    let outcome = run(rung(name), &Fault::NONE);
    let verdict = outcome.verdict(name);
    println!("{verdict}");
    // For looking at, also when it fails.
    let seen = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("verification");
    let written = write(name, &outcome, &seen).unwrap_or_else(|e| panic!("{name}: {e}"));
    println!("tables and figures: {}", seen.display());
    assert!(verdict.passes(), "{verdict}\ntables and figures: {}", seen.display());
    for file in written {
        compare(&file, &std::fs::read_to_string(seen.join(&file)).expect("what was just written"));
    }
}

/// One test per rung, and a test that none was forgotten.
macro_rules! ladder {
    ($($name:ident),* $(,)?) => {
        $(#[test] fn $name() { climb(stringify!($name)); })*

        #[test]
        fn every_rung_is_tested() {
            assert_eq!(RUNGS.iter().map(|r| r.name).collect::<Vec<_>>(), [$(stringify!($name)),*]);
            compare("ladder.csv", &ladder_csv());
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
    manufactured,
    cantilever,
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
    compare("faults.csv", &faults_csv(&rows));
}

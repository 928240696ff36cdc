//! Runs the validations. What must hold whatever the sources say is judged first, then tables and figures are compared with those
//! in `reports/validation`; after a change that is meant, `cargo reports` writes them anew.

use checkdam::validation::{Context, Failure, VALIDATIONS, Validation, write};
use checkdam::verification::report::{Caught, faults_csv};
use checkdam::verification::{Fault, Outcome};
use std::path::{Path, PathBuf};

fn validation(name: &str) -> &'static Validation {
    VALIDATIONS.iter().find(|v| v.name == name).unwrap_or_else(|| panic!("no validation `{name}`"))
}

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn folder(name: &str) -> PathBuf {
    PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(name)
}

fn run(validation: &Validation, fault: Fault, studies: bool, folder: &Path) -> Result<Outcome, Failure> {
    (validation.run)(&mut Context { fault, folder, studies, progress: &mut |_| true })
}

/// Compares a file with the one kept in `reports/validation`. The physics has been judged by now.
fn compare(file: &str, bytes: Vec<u8>) {
    insta::with_settings!({ snapshot_path => root().join("reports/validation"), prepend_module_to_snapshot => false }, {
        insta::assert_binary_snapshot!(file, bytes);
    });
}

/// Physics first: nothing is compared, and nothing can be written to the reports, unless every check passes.
fn validate(name: &str) {
    let (validation, folder) = (validation(name), folder("validation"));
    let outcome = run(validation, Fault::NONE, false, &folder).unwrap_or_else(|e| panic!("{name}: {e}"));
    let written = write(validation, &outcome, &folder).unwrap_or_else(|e| panic!("{name}: {e}"));
    let verdict = outcome.verdict(name, &folder);
    assert!(verdict.passes(), "\n{}", verdict.failing());
    for file in written {
        compare(&file, std::fs::read(folder.join(&file)).expect("what was just written"));
    }
}

/// One test per validation, and a test that none was forgotten.
macro_rules! validations {
    ($($name:ident),* $(,)?) => {
        $(#[test] fn $name() { validate(stringify!($name)); })*

        #[test]
        fn every_validation_is_tested() {
            assert_eq!(VALIDATIONS.iter().map(|v| v.name).collect::<Vec<_>>(), [$(stringify!($name)),*]);
        }
    };
}

validations!(
    flume,
    flume_noise,
    flume_baseline,
    flume_sensitivity,
    flume_calibration,
    flume_verdict,
    barrier_beam,
    barrier_rigid,
    barrier_impact,
    barrier_rigidity,
    barrier_grids,
    barrier_density,
    barrier_close_up,
    barrier_claims,
    column_level,
    column_slope
);

/// A force that is 3 % wrong, and other faults of a few percent, fail.
#[test]
fn every_fault_is_caught() {
    let mut rows = Vec::new();
    for validation in VALIDATIONS {
        for (kind, factor) in validation.covers.iter().flat_map(|&(kind, f)| [(kind, f), (kind, 2.0 - f)]) {
            let run = || run(validation, Fault::of(kind, factor), false, &folder("validation_faults"));
            rows.push(Caught::from(validation.name, kind, factor, run().map_err(|e| e.to_string())));
        }
    }
    let missed: Vec<&Caught> = rows.iter().filter(|c| c.failing == 0).collect();
    assert!(missed.is_empty(), "{missed:#?}");
    compare("faults.csv", faults_csv(&rows).into_bytes());
}

/// Every study that is on record, run again: the same rows. Takes about an hour.
#[test]
#[ignore = "an hour: cargo test --release --test validation -- --ignored"]
fn the_record_is_what_the_studies_give() {
    let folder = folder("studies");
    for validation in VALIDATIONS.iter().filter(|v| !v.study.is_empty()) {
        let [recorded, anew] = [false, true].map(|studies| {
            run(validation, Fault::NONE, studies, &folder).unwrap_or_else(|e| panic!("{}: {e}", validation.name))
        });
        assert_eq!(recorded, anew, "{}: make its record anew", validation.name);
    }
}

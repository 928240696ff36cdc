//! Runs the ladder. Physics is judged first, then the reports are compared with those in `reports/verification`; after a
//! change of the physics that is meant, `cargo reports` writes them anew.

// Without debug assertions (`cargo test --release`) no fault can be switched on.
#[cfg(debug_assertions)]
mod seeded;

use checkdam_verification::report::{self, Caught, faults_csv, ladder_csv, write};
use checkdam_verification::{Fault, FaultKind, RUNGS, Rung};
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

fn rung(name: &str) -> &'static Rung {
    RUNGS.iter().find(|r| r.name == name).unwrap_or_else(|| panic!("no rung `{name}`"))
}

fn root() -> &'static Path {
    Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/.."))
}

/// Compares a report with the one in `reports/verification`.
fn compare(file: &str, content: &[u8]) {
    report::compare(&root().join("reports/verification").join(file), content).unwrap_or_else(|e| panic!("\n{e}"));
}

/// Runs a rung, leaves its tables and figures in a folder below the build's, and judges its physics: the files, or the table
/// of what fails.
fn judge(rung: &Rung, fault: &Fault, folder: &str) -> Result<(PathBuf, Vec<String>), String> {
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(folder);
    let outcome = (rung.run)(fault).map_err(|e| format!("{}: FAILS, it did not run to its end: {e}", rung.name))?;
    let written = write(rung.name, &outcome, &folder).map_err(|e| format!("{}: {e}", rung.name))?;
    let verdict = outcome.verdict(rung.name, &folder);
    if verdict.passes() { Ok((folder, written)) } else { Err(verdict.failing().to_string()) }
}

/// Physics first: nothing is compared, and nothing can be written to the reports, unless every check passes.
fn climb(name: &str) {
    let (folder, written) = judge(rung(name), &Fault::NONE, "verification").unwrap_or_else(|table| panic!("\n{table}"));
    let read = |file: String| (file.clone(), std::fs::read(folder.join(&file)).expect("what was just written"));
    let files: Vec<(String, Vec<u8>)> = written.into_iter().map(read).collect();
    files.iter().for_each(|(file, bytes)| compare(file, bytes));
    insta::with_settings!({ prepend_module_to_snapshot => false, omit_expression => true }, {
        insta::assert_snapshot!(name, report::contents(&files));
    });
}

/// What a rung makes of the faults that it claims to catch, in either direction; run once, whoever asks first.
fn caught_by(rung: &'static Rung) -> &'static [Caught] {
    static CAUGHT: [OnceLock<Vec<Caught>>; RUNGS.len()] = [const { OnceLock::new() }; RUNGS.len()];
    let index = RUNGS.iter().position(|r| r.name == rung.name).expect("a rung of the ladder");
    CAUGHT[index].get_or_init(|| {
        let both = rung.covers.iter().flat_map(|&(kind, factor)| [(kind, factor), (kind, 2.0 - factor)]);
        both.map(|(kind, factor)| Caught::by(rung, kind, factor)).collect()
    })
}

fn notices(name: &str) {
    let rows = caught_by(rung(name));
    assert!(!rows.is_empty(), "{name} claims no fault");
    let missed: Vec<String> = rows
        .iter()
        .filter(|c| c.failing == 0)
        .map(|c| format!("{name} does not notice {} x {}: {}", c.fault.name(), c.factor, c.sharpest))
        .collect();
    assert!(missed.is_empty(), "{}", missed.join("\n"));
}

/// One test per rung, one per rung and its faults, and a test that none was forgotten.
macro_rules! ladder {
    ($($name:ident),* $(,)?) => {
        $(#[test] fn $name() { climb(stringify!($name)); })*

        /// Each rung fails on its physics under each fault that it claims to catch.
        mod every_fault_is_caught {
            $(#[test] fn $name() { super::notices(stringify!($name)); })*

            /// The last of them by name, so that the others have done the work.
            #[test]
            fn written_down() {
                super::faults_are_written_down();
            }
        }

        #[test]
        fn every_rung_is_tested() {
            assert_eq!(RUNGS.iter().map(|r| r.name).collect::<Vec<_>>(), [$(stringify!($name)),*]);
            compare("ladder.csv", ladder_csv().as_bytes());
        }

    };
}

checkdam_verification::each_rung!(ladder);

/// Every kind of fault, by a few percent, is caught by some rung; the table says how clearly.
fn faults_are_written_down() {
    let rows: Vec<Caught> = RUNGS.iter().flat_map(caught_by).cloned().collect();
    for kind in FaultKind::ALL {
        assert!(rows.iter().any(|c| c.fault == kind && c.failing > 0), "no rung notices wrong {}", kind.name());
    }
    let far = |c: &&Caught| !(0.019..0.051).contains(&(c.factor - 1.0).abs());
    assert!(rows.iter().find(far).is_none(), "faults are of 2 to 5 %: {:?}", rows.iter().find(far));
    compare("faults.csv", faults_csv(&rows).as_bytes());
}

#[test]
fn a_failing_rung_prints_one_table_with_the_path_of_its_figure() {
    let text =
        judge(rung("sliding_block"), &Fault::of(FaultKind::Friction, 1.03), "wrong").expect_err("wrong friction");
    let mut lines = text.lines();
    assert!(lines.next().is_some_and(|l| l.starts_with("sliding_block: FAILS, ")), "{text}");
    let head: Vec<&str> = lines.next().unwrap_or_default().split_whitespace().collect();
    assert_eq!(head, ["quantity", "measured", "expected", "error", "tolerance", "unit", "kind", "source"]);
    let row = lines.next().unwrap_or_default();
    assert!(row.trim_start().starts_with("FAIL") && row.contains("acceleration") && row.contains("Coulomb"), "{row}");
    assert!(!text.lines().any(|l| l.trim_start().starts_with("ok ")), "{text}");
    let figure = text.split([' ', ',', '\n']).find(|w| w.ends_with(".svg")).expect("the path of a figure");
    assert!(std::fs::read_to_string(figure).is_ok_and(|svg| svg.starts_with("<svg")), "{figure}");
}

#[test]
fn comparisons_are_not_forced() {
    for variable in ["INSTA_FORCE_PASS", "INSTA_FORCE_UPDATE", "INSTA_FORCE_UPDATE_SNAPSHOTS"] {
        assert!(
            std::env::var_os(variable).is_none(),
            "{variable} is set: unset it, it makes comparisons pass that should not"
        );
    }
    // `cargo reports` writes what physics has passed; anything else that writes without a look does not count as a test.
    let update = std::env::var("INSTA_UPDATE").unwrap_or_else(|_| "no".into());
    let writes = std::env::var_os("CHECKDAM_REPORTS").is_some();
    assert!(
        matches!(update.as_str(), "no" | "new" | "auto") || (update == "always" && writes),
        "INSTA_UPDATE={update}: unset it, or write the reports anew with `cargo reports`"
    );
}

#[test]
fn no_snapshot_waits_for_a_decision() {
    let mut folders = ["reports", "verification", "validation", "src"].map(|f| root().join(f)).to_vec();
    let mut seen = 0;
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(&folder).unwrap_or_else(|e| panic!("{}: {e}", folder.display())) {
            let path = entry.expect("an entry").path();
            let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
            seen += 1;
            let waits = name.contains(".snap.new") || name.ends_with(".pending-snap");
            assert!(!waits, "{} waits: accept or delete it", path.display());
            if path.is_dir() {
                folders.push(path);
            }
        }
    }
    assert!(seen > 100, "only {seen} files");
}

#[test]
fn every_rung_has_a_figure_and_every_report_a_rung() {
    for rung in RUNGS {
        assert!(!rung.figures.is_empty(), "{} has no figure", rung.name);
        let (goal, source, lines) = (rung.goal, rung.source, rung.sketch.trim().lines().count());
        assert!(!goal.is_empty() && !source.is_empty() && (3..=6).contains(&lines), "{} lacks a head", rung.name);
    }
    // A report that no rung writes any more is stale.
    let known = |name: &str| {
        ["faults", "ladder", "seeded", "README"].contains(&name)
            || RUNGS.iter().flat_map(|r| r.figures).any(|f| f.name == name || f.table == name)
            || RUNGS.iter().any(|r| name.starts_with(r.name))
    };
    for entry in std::fs::read_dir(root().join("reports/verification")).expect("the reports") {
        let name = entry.expect("an entry").file_name().to_string_lossy().into_owned();
        let stem = name.split('.').next().unwrap_or_default().to_string();
        assert!(known(&stem), "{name} belongs to no rung: delete it");
    }
}

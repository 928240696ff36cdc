//! Runs the validations. What must hold whatever the sources say is judged first, then tables and figures are compared with those
//! in `reports/validation`; after a change that is meant, `cargo reports` writes them anew.

#[cfg(debug_assertions)]
#[path = "../src/seeded/child.rs"]
mod child;

use checkdam::case;
use checkdam::study::{Study, plan};
use checkdam_validation::experiment::Experiment;
use checkdam_validation::record::{RecordedRun, processors, spread_out};
use checkdam_validation::{Context, Failure, STUDIES, VALIDATIONS, Validation, write};
use checkdam_verification::report;
use checkdam_verification::{Fault, Outcome};
#[cfg(debug_assertions)]
use checkdam_verification::{
    FaultKind,
    report::{Caught, faults_csv},
};
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

fn validation(name: &str) -> &'static Validation {
    VALIDATIONS.iter().find(|v| v.name == name).unwrap_or_else(|| panic!("no validation `{name}`"))
}

fn root() -> &'static Path {
    Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/.."))
}

fn folder(name: &str) -> PathBuf {
    PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(name)
}

fn run(validation: &Validation, fault: Fault, studies: bool, folder: &Path) -> Result<Outcome, Failure> {
    (validation.run)(&mut Context { fault, folder, studies, progress: &mut |_| true })
}

/// Compares a file with the one kept in `reports/validation`. The physics has been judged by now.
fn compare(file: &str, bytes: &[u8]) {
    report::compare(&root().join("reports/validation").join(file), bytes).unwrap_or_else(|e| panic!("\n{e}"));
}

/// Physics first: nothing is compared, and nothing can be written to the reports, unless every check passes.
fn validate(name: &str) {
    let (validation, folder) = (validation(name), folder("validation"));
    let outcome = run(validation, Fault::NONE, false, &folder).unwrap_or_else(|e| panic!("{name}: {e}"));
    let written = write(validation, &outcome, &folder).unwrap_or_else(|e| panic!("{name}: {e}"));
    judge_and_compare(name, &outcome, written, &folder);
}

fn judge_and_compare(name: &str, outcome: &Outcome, written: Vec<String>, folder: &Path) {
    let verdict = outcome.verdict(name, folder);
    assert!(verdict.passes(), "\n{}", verdict.failing());
    let read = |file: String| (file.clone(), std::fs::read(folder.join(&file)).expect("what was just written"));
    let files: Vec<(String, Vec<u8>)> = written.into_iter().map(read).collect();
    files.iter().for_each(|(file, bytes)| compare(file, bytes));
    insta::with_settings!({ prepend_module_to_snapshot => false, omit_expression => true }, {
        insta::assert_snapshot!(name, report::contents(&files));
    });
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
    flume_at_rest,
    flume_shaken,
    flume_step_length,
    flume_calibration,
    flume_verdict,
    barrier_beam,
    barrier_rigid,
    barrier_impact,
    barrier_rigidity,
    barrier_grids,
    barrier_steps,
    barrier_kinematics,
    barrier_density,
    barrier_weight,
    barrier_close_up,
    barrier_claims,
    column_level,
    column_slope
);

/// `reports/README.md` and the pages of the two suites. Written anew, they take their verdicts from the tables as they were before.
#[test]
fn the_pages_list_every_rung_and_validation() {
    let reports = root().join("reports");
    for (file, text) in checkdam_validation::index::pages(&reports).unwrap_or_else(|e| panic!("{e}")) {
        report::compare(&reports.join(file), text.as_bytes()).unwrap_or_else(|e| panic!("\n{e}"));
    }
}

/// Every experiment that is data alone: a folder in `validation/experiments`.
#[test]
fn experiments() {
    let out = folder("experiments");
    let folders = std::fs::read_dir(root().join("validation/experiments")).expect("the experiments");
    let mut folders: Vec<PathBuf> = folders.filter_map(Result::ok).map(|f| f.path()).filter(|f| f.is_dir()).collect();
    folders.sort();
    assert!(!folders.is_empty());
    for folder in folders {
        let experiment = Experiment::load(&folder).unwrap_or_else(|e| panic!("{e}"));
        let outcome = experiment.run(&out, &mut |_| true).unwrap_or_else(|e| panic!("{}: {e}", experiment.name));
        let written = experiment.write(&outcome, &out).unwrap_or_else(|e| panic!("{}: {e}", experiment.name));
        judge_and_compare(&experiment.name, &outcome, written, &out);
    }
}

/// Does something with each of a list, with a thread each and as many side by side as there are processors: that uses them better than many
/// threads on one. Results in the order of the list.
fn side_by_side<T: Sync, R: Send>(list: &[T], each: impl Fn(&T) -> R + Sync) -> Vec<R> {
    let next = AtomicUsize::new(0);
    let done = Mutex::new(Vec::new());
    std::thread::scope(|scope| {
        for _ in 0..processors().get() {
            scope.spawn(|| {
                let alone = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a thread");
                loop {
                    let k = next.fetch_add(1, Ordering::Relaxed);
                    let Some(item) = list.get(k) else { return };
                    let result = alone.install(|| each(item));
                    done.lock().expect("none has panicked").push((k, result));
                }
            });
        }
    });
    let mut done = done.into_inner().expect("none has panicked");
    done.sort_by_key(|d| d.0);
    done.into_iter().map(|d| d.1).collect()
}

/// Faults of the program itself (`checkdam::seeded`) that a validation catches: what its gauges report, wrong where it arises. Each to both
/// sides, in a process of its own.
#[cfg(debug_assertions)]
const AT_THE_SOURCE: &[(&str, &str)] =
    &[("flume", "gauge.normal"), ("flume_noise", "gauge.normal"), ("barrier_impact", "gauge.body")];

/// What [`AT_THE_SOURCE`] is asked by: the validation, and which way the fault goes.
#[cfg(debug_assertions)]
const ASKED: [&str; 2] = ["CHECKDAM_SEEDED_VALIDATION", "CHECKDAM_SEEDED_OTHER_SIDE"];
/// What the child says before its row.
#[cfg(debug_assertions)]
const ROW: &str = "row of the table: ";

#[cfg(debug_assertions)]
#[test]
#[ignore = "a child of the test below: judges a validation under a fault of the program"]
fn one_validation() {
    let name = std::env::var(ASKED[0]).expect("a parent that says which");
    let other = std::env::var_os(ASKED[1]).is_some();
    let fault = checkdam::seeded::active().expect("a fault");
    let checkdam::seeded::Kind::Times(factor) = fault.kind else { panic!("{} is no factor", fault.name) };
    let factor = if other { 2.0 - factor } else { factor };
    let validation = validation(&name);
    let folder = folder(&format!("validation_faults/{name}_{}_{factor}", fault.name));
    let outcome = run(validation, Fault::NONE, false, &folder).map_err(|e| e.to_string());
    let kind = FaultKind::ContactForce;
    let row = faults_csv(&[Caught::from(validation.name, kind, factor, outcome)]);
    let row = row.lines().nth(1).expect("a row");
    println!("{ROW}{}", row.replacen(kind.name(), fault.name, 1));
}

/// Who asks for a row of the table: a fault that the validation is given, or one of the program.
#[cfg(debug_assertions)]
enum Asked {
    Given(&'static Validation, FaultKind, f64),
    AtTheSource(&'static str, &'static str, bool),
}

/// A force that is 3 % wrong, and other faults of a few percent, fail.
#[cfg(debug_assertions)]
#[test]
fn every_fault_is_caught() {
    let mut all = Vec::new();
    for validation in VALIDATIONS {
        for (kind, factor) in validation.covers.iter().flat_map(|&(kind, f)| [(kind, f), (kind, 2.0 - f)]) {
            all.push(Asked::Given(validation, kind, factor));
        }
        for (name, fault) in AT_THE_SOURCE.iter().filter(|a| a.0 == validation.name) {
            all.extend([false, true].map(|other| Asked::AtTheSource(name, fault, other)));
        }
    }
    let rows = side_by_side(&all, |asked| match *asked {
        Asked::Given(validation, kind, factor) => {
            let folder = folder(&format!("validation_faults/{}_{}_{factor}", validation.name, kind.name()));
            let outcome = run(validation, Fault::of(kind, factor), false, &folder).map_err(|e| e.to_string());
            let text = faults_csv(&[Caught::from(validation.name, kind, factor, outcome)]);
            text.lines().nth(1).map(String::from)
        }
        Asked::AtTheSource(name, fault, other) => {
            let variables = [(ASKED[0], name), (ASKED[1], "1")];
            let variables = if other { &variables[..] } else { &variables[..1] };
            let arguments = ["--ignored", "--exact", "one_validation", "--nocapture", "--test-threads=1"];
            let answer = child::under(fault, variables, &arguments, child::LIMIT);
            answer.lines().find_map(|l| l.split_once(ROW)).map(|(_, row)| row.to_string())
        }
    });
    let mut text = faults_csv(&[]);
    for (k, row) in rows.into_iter().enumerate() {
        let row = row.unwrap_or_else(|| panic!("number {k} of those asked has not answered"));
        let failing = row.split(',').nth(3);
        assert!(failing.is_some_and(|n| n != "0"), "not caught: {row}");
        text += &row;
        text.push('\n');
    }
    compare("faults.csv", text.as_bytes());
}

/// What the samples of all studies may cost together, in particle-steps: some eight minutes of one processor.
const SAMPLES: f64 = 1e10;

/// A fixed, spread-out sample of every study that is on record, run again: the same lines, byte for byte. A few minutes.
#[test]
#[ignore = "minutes: cargo test --profile bench --test validation -- --ignored a_sample_of_the_record"]
fn a_sample_of_the_record_is_what_the_studies_give() {
    let (mut chosen, mut wrong) = (Vec::new(), Vec::new());
    for (name, rows) in STUDIES {
        let rows = rows().unwrap_or_else(|e| panic!("{name}: {e}"));
        let costs: Vec<f64> = rows.iter().map(|r| r.cost).collect();
        let sample = spread_out(&costs, SAMPLES / STUDIES.len() as f64);
        println!("{name}: {} of {} runs", sample.len(), rows.len());
        let mut rows: Vec<Option<RecordedRun>> = rows.into_iter().map(Some).collect();
        chosen.extend(sample.into_iter().filter_map(|k| Some((*name, rows[k].take()?))));
    }
    // The dearest first: none of them is left for one processor at the end.
    chosen.sort_by(|a, b| b.1.cost.total_cmp(&a.1.cost));
    let lines =
        side_by_side(&chosen, |(name, run)| (run.anew)().unwrap_or_else(|e| panic!("{name}, {}: {e}", run.what)));
    for ((name, run), line) in chosen.iter().zip(&lines) {
        if *line != run.recorded {
            wrong.push(format!("{name}, {}:\n  recorded {}\n  anew     {line}", run.what, run.recorded));
        }
    }
    assert!(wrong.is_empty(), "{} of {} runs are not on record so:\n{}", wrong.len(), lines.len(), wrong.join("\n"));
}

/// No record is forgotten. `noise.csv` holds means that every `cargo test` compares with runs, and `shaken.csv` forces that no study reads.
#[test]
fn every_record_is_among_the_studies() {
    for folder in std::fs::read_dir(root().join("validation")).expect("the validations").filter_map(Result::ok) {
        let Ok(files) = std::fs::read_dir(folder.path().join("runs")) else { continue };
        for file in files
            .filter_map(Result::ok)
            .filter(|f| !["noise.csv", "shaken.csv"].contains(&&*f.file_name().to_string_lossy()))
        {
            let name = format!("{}/runs/{}", folder.file_name().to_string_lossy(), file.file_name().to_string_lossy());
            assert!(STUDIES.iter().any(|s| s.0 == name), "{name} is not in STUDIES");
        }
    }
}

/// Every study that is on record, run again: the same rows. Takes two hours or more.
#[test]
#[ignore = "hours: cargo test --profile bench --test validation -- --ignored the_record_is_what"]
fn the_record_is_what_the_studies_give() {
    let folder = folder("studies");
    for validation in VALIDATIONS.iter().filter(|v| !v.study.is_empty()) {
        let [recorded, anew] = [false, true].map(|studies| {
            run(validation, Fault::NONE, studies, &folder).unwrap_or_else(|e| panic!("{}: {e}", validation.name))
        });
        assert_eq!(recorded, anew, "{}: make its record anew", validation.name);
    }
}

/// Case files and study files of a folder and below it.
fn toml_files(folder: &Path, found: &mut Vec<PathBuf>) {
    for path in std::fs::read_dir(folder).expect("a folder").map(|e| e.expect("an entry").path()) {
        if path.is_dir() {
            toml_files(&path, found);
        } else if path.extension().is_some_and(|e| e == "toml") && !path.ends_with("Cargo.toml") {
            found.push(path);
        }
    }
}

#[test]
fn every_case_loads_without_warnings_and_every_study_can_be_run() {
    let mut files = Vec::new();
    toml_files(Path::new(env!("CARGO_MANIFEST_DIR")), &mut files);
    let (mut cases, mut studies) = (0, 0);
    for file in &files {
        let text = std::fs::read_to_string(file).expect("a file");
        if text.lines().any(|line| line.starts_with("cases = ")) {
            let study = Study::load(file).unwrap_or_else(|e| panic!("{e}"));
            let folder = file.parent().expect("a folder");
            let read = |name: &str| std::fs::read_to_string(folder.join(name));
            let runs = plan(&study, &file.display().to_string(), &read).unwrap_or_else(|e| panic!("{e}"));
            assert!(runs.len() > 1, "{}: {} runs", file.display(), runs.len());
            studies += 1;
        } else {
            let loaded = case::load(file).unwrap_or_else(|e| panic!("{e}"));
            assert_eq!(loaded.warnings, Vec::<String>::new(), "{}", file.display());
            cases += 1;
        }
    }
    assert!(cases >= 8 && studies >= 15, "{cases} cases, {studies} studies");
}

#[test]
fn the_cases_of_the_flume_differ_in_title_and_inclination() {
    let of = |name: &str| {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("flume").join(name);
        case::load(&path).unwrap_or_else(|e| panic!("{e}")).case
    };
    let (mut steep, flat) = (of("40deg.toml"), of("23deg.toml"));
    assert_eq!(steep.bodies[0].particle_spacing_m(&steep.grid), 0.005);
    steep.title.clone_from(&flat.title);
    steep.gravity.inclination_deg = 23.0;
    assert_eq!(steep, flat);
}

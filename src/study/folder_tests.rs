use super::result::{build, read, text};
use super::table::has_lost;
use super::tests::{STUDY, planned};
use super::*;
use std::collections::BTreeMap;
use std::fs;
use std::num::NonZero;
use std::path::{Path, PathBuf};

const ONE: NonZero<usize> = NonZero::<usize>::MIN;

/// Works off a study in a folder; what was made anew, and what deserved a word.
fn work(study: &str, at: &Path, go_on: fn(&Progress) -> bool) -> (Finished, Vec<String>, Vec<String>) {
    let (parsed, plan) = planned(study).expect("a study");
    let (mut made, mut notes) = (Vec::new(), Vec::new());
    let (_, finished) = work_off(
        &plan,
        (&parsed, study),
        at,
        ONE,
        &mut |p| {
            made.extend(p.ended.map(|_| p.run.what.clone()));
            go_on(p)
        },
        &mut notes,
    )
    .expect("a folder");
    (finished, made, notes)
}

fn table(at: &Path) -> String {
    fs::read_to_string(at.join("runs.csv")).expect("a table")
}

fn status(at: &Path) -> String {
    let status: toml::Table = fs::read_to_string(at.join("status.toml")).expect("a file").parse().expect("TOML");
    status["status"].as_str().expect("a word").to_string()
}

fn result_of(at: &Path, run: &PlannedRun) -> PathBuf {
    at.join("results").join(build()).join(format!("{}.toml", run.key))
}

#[test]
fn a_study_goes_on_where_it_stopped() {
    let folder = tempfile::tempdir().expect("a folder");
    let [at, at_once] = ["a", "b"].map(|name| folder.path().join(name));
    // Stopped after the first run has ended: the base and the axis' first value.
    let (first, made, _) = work(STUDY, &at, |p| p.ended.is_none());
    assert_eq!((first.rows, first.total, first.is_complete(), made.len()), (2, 4, false, 1));
    assert_eq!(status(&at), "incomplete");
    // Stopped in the middle of a run: nothing of it is kept.
    assert_eq!(work(STUDY, &at, |_| false).0.rows, 2);
    let (last, mut made, notes) = work(STUDY, &at, |_| true);
    assert!(last.is_complete() && notes.is_empty(), "{notes:?}");
    made.sort();
    assert_eq!(made, ["drop, axis, young_pa 200000", "drop, floor, rough"]);
    assert_eq!(status(&at), "complete");
    // As if it had never been interrupted.
    work(STUDY, &at_once, |_| true);
    assert_eq!(table(&at), table(&at_once));
    assert_eq!(table(&at).lines().count(), 5);
}

#[test]
fn whoever_makes_the_runs_the_table_is_the_same() {
    let folder = tempfile::tempdir().expect("a folder");
    let [at, pool] = ["a", "b"].map(|name| folder.path().join(name));
    work(STUDY, &pool, |_| true);
    let (study, plan) = planned(STUDY).expect("a study");
    let shared = Folder::shared(&at).expect("a folder");
    for run in plan.iter().rev() {
        let other = Folder::shared(&at).expect("two share it");
        assert!(attempt(run, Some(&other), &mut |_| true).expect("a result").is_some_and(|row| row.is_complete()));
    }
    // What is there is not made again.
    assert!(attempt(&plan[1], Some(&shared), &mut |_| panic!("it runs")).expect("a result").is_some());
    // Nobody has the folder alone meanwhile, and nobody shares one that somebody has alone.
    assert!(matches!(Folder::alone(&at), Err(crate::output::OutputError::InUse { .. })));
    let claim = shared.claim(&plan[1]).expect("a run");
    assert!(matches!(attempt(&plan[1], Some(&shared), &mut |_| true), Err(crate::output::OutputError::InUse { .. })));
    drop(claim);
    let mut notes = Vec::new();
    let runs = shared.results(&plan, &study.columns(), &mut notes);
    shared.begin(&plan, &runs, STUDY, Status::Ended, &mut notes).expect("a table");
    assert!(notes.is_empty() && table(&at) == table(&pool), "{notes:?}");
    drop(shared);
    let manifest = |at: &Path| fs::read_to_string(at.join("manifest.csv")).expect("a table");
    assert_eq!(manifest(&at), manifest(&pool));
    assert!(manifest(&at).lines().nth(4).is_some_and(|l| l.starts_with(&format!("4,{},drop,axis", plan[3].key))));
    let alone = Folder::alone(&at).expect("a folder");
    assert!(Folder::shared(&at).is_err());
    assert_eq!(alone.listed(2).as_ref(), Some(&plan[1].key));
    assert_eq!(alone.listed(5).as_deref(), Some(""));
}

#[test]
fn rows_of_a_study_that_was_changed_are_kept_and_found_again() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = folder.path().join("a");
    work(STUDY, &at, |_| true);
    let whole = table(&at);
    let fewer = STUDY.replace("[1.0e5, 2.0e5]", "[1.0e5]");
    let (_, made, notes) = work(&fewer, &at, |_| true);
    assert!(made.is_empty(), "{made:?}");
    assert!(notes.len() == 1 && notes[0].contains("kept as runs_before_1.csv, study_before_1.toml"), "{notes:?}");
    assert_eq!(fs::read_to_string(at.join("runs_before_1.csv")).expect("a table"), whole);
    assert_eq!(fs::read_to_string(at.join("study_before_1.toml")).expect("a study"), STUDY);
    let (_, made, _) = work(STUDY, &at, |_| true);
    assert!(made.is_empty() && table(&at) == whole, "{made:?}");
    // Another build has made other results, and its table.
    fs::rename(at.join("results").join(build()), at.join("results/another")).expect("a folder");
    fs::write(at.join("runs.program"), "another").expect("a file");
    let (_, made, notes) = work(STUDY, &at, |p| p.ended.is_none());
    assert!(made.len() == 1 && notes.len() == 1, "{made:?} {notes:?}");
    assert_eq!(fs::read_to_string(at.join("runs_before_3.csv")).expect("a table"), whole);
    assert_eq!(fs::read_dir(at.join("results/another")).expect("a folder").count(), 3);
}

#[test]
fn what_is_no_table_of_the_study_is_kept() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = folder.path().join("a");
    work(STUDY, &at, |_| true);
    let whole = table(&at);
    let digit = whole.rfind(|c: char| c.is_ascii_digit()).expect("a digit");
    let flipped = format!("{}abc{}", &whole[..digit], &whole[digit + 1..]);
    for (k, wrong) in [&flipped, "mine\n", &whole[..whole.len() - 40], "\u{0}\u{1}"].into_iter().enumerate() {
        fs::write(at.join("runs.csv"), wrong).expect("a file");
        let (finished, made, notes) = work(STUDY, &at, |_| true);
        assert!(finished.is_complete() && made.is_empty() && table(&at) == whole, "{wrong:?}");
        assert_eq!(notes.len(), 1, "{wrong:?}: {notes:?}");
        let kept = fs::read_to_string(at.join(format!("runs_before_{}.csv", k + 1))).expect("what stood there");
        assert_eq!(kept, wrong);
    }
    // An empty one, or none, holds nothing.
    fs::write(at.join("runs.csv"), "").expect("a file");
    let (_, _, notes) = work(STUDY, &at, |_| true);
    assert!(notes.is_empty() && table(&at) == whole, "{notes:?}");
    // A table that only grew has lost nothing, also where it has more columns; runs that failed are tried again.
    let head = "case,factor,label,replicate,key,ended,trusted";
    let before = format!("{head}\nc,base,,0,k1,at rest,true\nc,base,,0,k2,failed: x,\n");
    let now = format!("{head},a\nc,base,,0,k1,at rest,true,\nc,base,,0,k3,at rest,true,1\n");
    assert!(!has_lost(before.as_bytes(), &now) && has_lost(now.as_bytes(), &before));
}

#[test]
fn a_folder_of_others_is_not_touched() {
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("runs.csv"), "mine").expect("a file");
    let told = Folder::alone(folder.path()).expect_err("it is foreign").to_string();
    assert!(told.contains("holds no study"), "{told}");
    assert_eq!(fs::read_dir(folder.path()).expect("a folder").count(), 1);
}

#[test]
fn a_result_says_whether_it_is_whole() {
    let (_, plan) = planned(STUDY).expect("a study");
    let numbers: Vec<f64> = (0..quantities::QUANTITIES.len()).map(|k| 1.0 / (k as f64 + 3.0)).collect();
    let row = Row::new("at \"rest\"", true, &numbers);
    let whole = text(&plan[0], &row);
    assert_eq!(read(&plan[0], &whole), Ok(row));
    assert!(read(&plan[1], &whole).is_err(), "of another run");
    // Cut anywhere, or with any byte changed, it is none.
    for k in 0..whole.len() {
        assert!(read(&plan[0], &whole[..k]).is_err(), "cut at {k}");
        let mut bytes = whole.clone().into_bytes();
        bytes[k] ^= 1;
        let changed = String::from_utf8_lossy(&bytes);
        assert!(read(&plan[0], &changed).is_err(), "byte {k}");
    }
}

#[test]
fn a_result_that_is_damaged_is_made_again() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = folder.path().join("a");
    work(STUDY, &at, |_| true);
    let whole = table(&at);
    let (_, plan) = planned(STUDY).expect("a study");
    let path = result_of(&at, &plan[1]);
    let text = fs::read_to_string(&path).expect("a result");
    for wrong in ["", &text[..text.len() / 2], &text.replacen('e', "f", 1)] {
        fs::write(&path, wrong).expect("a file");
        let (_, made, notes) = work(STUDY, &at, |_| true);
        assert_eq!(made, ["drop, floor, rough"]);
        assert!(notes.iter().any(|n| n.contains("is not taken") && n.contains(&plan[1].key)), "{notes:?}");
        assert!(table(&at) == whole && fs::read_to_string(&path).expect("a result") == text);
    }
}

#[test]
fn a_run_that_breaks_the_program_is_a_row_with_its_reason() {
    let (study, mut plan) = planned(STUDY).expect("a study");
    plan[1].case.materials = BTreeMap::new();
    let mut runs = Runs::new(&study.columns());
    let finished = run(&plan, &mut runs, None, ONE, &mut |_| true).expect("a table");
    assert_eq!((finished.rows, finished.failed), (4, 1));
    let row = runs.get(&plan[1]).expect("a row");
    assert!(row.ended.starts_with("failed: the program broke down: ") && row.ended.len() > 40, "{row:?}");
    assert!(runs.csv(&plan).lines().nth(2).is_some_and(|line| line.contains("broke down")));
    // In a folder it is tried again by the next command.
    let folder = tempfile::tempdir().expect("a folder");
    let at = Folder::alone(&folder.path().join("a")).expect("a folder");
    assert!(attempt(&plan[1], Some(&at), &mut |_| true).expect("a result").is_some_and(|row| !row.is_complete()));
    let mut runs = at.results(&plan, &study.columns(), &mut Vec::new());
    assert!(runs.get(&plan[1]).is_some());
    runs.forget_failed();
    assert!(runs.get(&plan[1]).is_none());
}

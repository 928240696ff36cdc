//! What a machine does to a run and to a study: processes killed at any moment, two in one folder, disks that fill up, folders that
//! cannot be written or are taken away, damaged files. Accepted is the right result, or a clear error with what was there intact.
//! `docs/cluster.md` has the table.
#![cfg(unix)]

use crate::interrupted::{end, start, wait_until};
use crate::lab::{Lab, Outcome, TINY, long};
use std::fs;
use std::path::Path;
use std::process::{Child, Command, Output, Stdio};
use std::time::Duration;

/// Ten short runs.
const STUDY: &str = r#"title = "Friction of the base"
cases = ["case.toml"]

[[axis]]
name = "base_friction_1"
fields = ["boundaries.base.friction"]
values = [0.20, 0.22, 0.24, 0.26, 0.28, 0.30, 0.32, 0.34, 0.36, 0.38]
"#;
/// The study and its folder.
const WORK: [&str; 6] = ["study", "friction.toml", "--out", "results", "--threads", "2"];

fn study_lab() -> Lab {
    let lab = Lab::new(TINY);
    fs::write(lab.path("friction.toml"), STUDY).unwrap();
    lab
}

/// The table of the study, made without disturbance.
fn undisturbed() -> String {
    let lab = study_lab();
    let outcome = lab.run(&WORK);
    assert_eq!(outcome.code, Some(0), "{outcome:?}");
    lab.read("results/runs.csv")
}

fn kill(mut child: Child) {
    child.kill().unwrap();
    child.wait().unwrap();
}

fn ended(child: Child) -> Outcome {
    Outcome::of(&child.wait_with_output().unwrap())
}

#[test]
fn a_study_that_is_killed_at_any_moment_loses_no_run() {
    let lab = study_lab();
    let mut before = 0;
    // Moments from before the folder is there to after several runs; drawn once.
    for milliseconds in [3, 90, 17, 41, 150, 8, 63, 110, 29, 75] {
        let child = start(&lab, &WORK);
        std::thread::sleep(Duration::from_millis(milliseconds));
        kill(child);
        // What is there is whole, and grows.
        let text = fs::read_to_string(lab.path("results/runs.csv")).unwrap_or_default();
        assert!(text.is_empty() || text.ends_with('\n'), "{text}");
        let rows = text.lines().count();
        assert!(rows >= before, "{before} lines before, now {rows}");
        before = rows;
        let status = fs::read_to_string(lab.path("results/status.toml")).unwrap_or_default();
        assert!(status.is_empty() || status.starts_with("status = \"running\"") || rows == 11, "{status}");
    }
    let outcome = lab.run(&WORK);
    assert_eq!(outcome.code, Some(0), "{outcome:?}");
    assert_eq!(lab.read("results/runs.csv"), undisturbed());
    let names = lab.contents("results");
    assert!(names.keys().all(|name| !name.contains("_before_")), "{:?}", names.keys());
    assert!(lab.read("results/status.toml").starts_with("status = \"complete\""));
}

#[test]
fn a_run_that_is_killed_says_so_and_can_be_replaced() {
    let lab = Lab::new(&long());
    for milliseconds in [0, 20, 80] {
        let arguments = ["run", "case.toml", "--out", "results", "--force"];
        let child = start(&lab, &arguments);
        wait_until("the first sample", || lab.path("results/history.csv").exists());
        std::thread::sleep(Duration::from_millis(milliseconds));
        // While it runs nobody else may.
        let other = lab.run(&arguments);
        assert_eq!(other.code, Some(2), "{other:?}");
        assert!(other.err.contains(&format!("in use by process {} on ", child.id())), "{}", other.err);
        kill(child);
        assert_eq!(lab.status("results"), "running");
        assert!(
            lab.read("results/summary.toml").starts_with("trusted = false\nreasons = [\"the run is not at its end")
        );
        lab.rows("results");
    }
    let refused = lab.run(&["run", "case.toml", "--out", "results"]);
    assert!(refused.code == Some(2) && refused.err.contains("--force"), "{refused:?}");
    fs::write(lab.path("case.toml"), TINY).unwrap();
    let replaced = lab.run(&["run", "case.toml", "--out", "results", "--force"]);
    assert_eq!(replaced.code, Some(4), "{replaced:?}");
    assert_eq!(lab.run(&["run", "case.toml", "--out", "fresh"]).code, Some(4));
    assert!(lab.contents("results") == lab.contents("fresh"), "{:?}", lab.contents("results").keys());
}

#[test]
fn of_two_runs_into_one_folder_one_is_refused() {
    let lab = Lab::new(TINY);
    assert_eq!(lab.run(&["run", "case.toml", "--out", "alone"]).code, Some(4));
    let alone = lab.contents("alone");
    for k in 0..10 {
        let out = format!("both{k}");
        let both = [0, 1].map(|_| start(&lab, &["run", "case.toml", "--out", &out]));
        let outcomes = both.map(ended);
        let mut codes = outcomes.each_ref().map(|o| o.code);
        codes.sort_unstable();
        // The second may come when the first has ended: then the folder is not empty.
        assert_eq!(codes, [Some(2), Some(4)], "{outcomes:?}");
        let refused = outcomes.iter().find(|o| o.code == Some(2)).unwrap();
        assert!(refused.err.contains("in use by process") || refused.err.contains("not empty"), "{}", refused.err);
        assert!(lab.contents(&out) == alone, "attempt {k}: the tables are mixed");
    }
}

#[test]
fn of_two_studies_in_one_folder_one_is_refused() {
    let lab = Lab::new(&long());
    fs::write(lab.path("friction.toml"), STUDY).unwrap();
    let first = start(&lab, &WORK);
    wait_until("the first study", || lab.path("results/runs.csv").exists());
    let before = lab.read("results/runs.csv");
    for task in [&WORK[..], &["study", "friction.toml", "--out", "results", "--run", "1"]] {
        let second = lab.run(task);
        assert_eq!(second.code, Some(2), "{second:?}");
        let words = format!("error: results is in use by process {} on ", first.id());
        assert!(second.err.contains(&words), "{}", second.err);
    }
    assert_eq!(lab.read("results/runs.csv"), before);
    assert_eq!(end(first, "-INT").code, Some(3));
    assert!(lab.read("results/status.toml").starts_with("status = \"incomplete\""));
}

#[test]
fn damaged_files_of_a_study_are_noticed() {
    let lab = study_lab();
    let whole = undisturbed();
    assert_eq!(lab.run(&WORK).code, Some(0));
    let flipped = whole.replacen("end time", "abc", 1);
    for (k, wrong) in [&whole[..whole.len() / 2], &flipped, "mine\n"].into_iter().enumerate() {
        fs::write(lab.path("results/runs.csv"), wrong).unwrap();
        let outcome = lab.run(&WORK);
        let kept = format!("runs_before_{}.csv", k + 1);
        assert!(outcome.code == Some(0) && outcome.out.contains(&kept), "{outcome:?}");
        assert_eq!(lab.read("results/runs.csv"), whole);
        assert_eq!(lab.read(&format!("results/{kept}")), wrong);
    }
    fs::write(lab.path("results/runs.csv"), "").unwrap();
    let outcome = lab.run(&WORK);
    assert!(outcome.code == Some(0) && !outcome.out.contains("_before_"), "{outcome:?}");
    let result =
        lab.contents("results").into_keys().find(|name| name.ends_with(".toml") && name.contains('/')).unwrap();
    fs::write(lab.path(&format!("results/{result}")), "key = \"cut").unwrap();
    let collected = lab.run(&["study", "friction.toml", "--out", "results", "--collect"]);
    assert_eq!(collected.code, Some(3), "{collected:?}");
    for text in ["a result is not taken", "9 of 10 runs", "INCOMPLETE"] {
        assert!(collected.out.contains(text), "no {text:?} in\n{}", collected.out);
    }
    assert_eq!(lab.run(&WORK).code, Some(0));
    assert_eq!(lab.read("results/runs.csv"), whole);
}

#[test]
fn a_folder_that_is_taken_away_ends_the_run() {
    let lab = Lab::new(&long());
    let child = start(&lab, &["run", "case.toml", "--out", "results"]);
    wait_until("the first sample", || lab.path("results/history.csv").exists());
    fs::remove_dir_all(lab.path("results")).unwrap();
    // Another has it by now.
    fs::create_dir(lab.path("results")).unwrap();
    fs::write(lab.path("results/summary.toml"), "mine").unwrap();
    let outcome = ended(child);
    assert_eq!(outcome.code, Some(3), "{outcome:?}");
    assert!(outcome.err.contains("error: results was deleted or moved"), "{}", outcome.err);
    assert!(lab.contents("results").len() == 1 && lab.read("results/summary.toml") == "mine");
}

#[test]
fn a_folder_that_is_taken_away_ends_the_study() {
    // The first run takes minutes; beside it one short run follows the other.
    let ends: Vec<String> = (0..12).map(|k| format!("0.4{k:02}")).collect();
    let study = |first: &str| {
        let axis = format!(
            "name = \"end_s\"\nfields = [\"stages.run.end_time_s\"]\nvalues = [{first}, {}]\n",
            ends.join(", ")
        );
        format!("title = \"Ends\"\ncases = [\"case.toml\"]\n[[axis]]\n{axis}")
    };
    let lab = Lab::new(TINY);
    fs::write(lab.path("friction.toml"), study("400.0")).unwrap();
    let child = start(&lab, &WORK);
    let rows = || fs::read_to_string(lab.path("results/runs.csv")).map_or(0, |text| text.lines().count());
    wait_until("the first rows", || rows() >= 2);
    fs::rename(lab.path("results"), lab.path("moved")).unwrap();
    let outcome = ended(child);
    assert_eq!(outcome.code, Some(3), "{outcome:?}");
    assert!(outcome.err.contains("error: results was deleted or moved"), "{}", outcome.err);
    assert!(!lab.path("results").exists());
    // What was moved goes on where it was.
    fs::write(lab.path("friction.toml"), study("0.3")).unwrap();
    for out in ["moved", "undisturbed"] {
        let outcome = lab.run(&["study", "friction.toml", "--out", out]);
        assert_eq!(outcome.code, Some(0), "{outcome:?}");
    }
    assert_eq!(lab.read("moved/runs.csv"), lab.read("undisturbed/runs.csv"));
}

#[test]
fn a_reader_who_leaves_does_not_end_the_study() {
    let lab = study_lab();
    let mut child = start(&lab, &WORK);
    drop((child.stdout.take(), child.stderr.take()));
    assert_eq!(child.wait().unwrap().code(), Some(0));
    assert_eq!(lab.read("results/runs.csv"), undisturbed());
}

/// Runs a script in which small disks can be mounted; none where the system does not let us.
fn with_own_mounts(lab: &Lab, script: &str) -> Option<Output> {
    let namespace = |script: &str| {
        let mut command = Command::new("unshare");
        command.args(["--map-root-user", "--mount", "sh", "-ec", script, env!("CARGO_BIN_EXE_checkdam")]);
        command.current_dir(lab.directory.path()).stdin(Stdio::null()).output()
    };
    fs::create_dir(lab.path("disk")).unwrap();
    if !namespace("mount -t tmpfs -o size=64k none disk").is_ok_and(|probe| probe.status.success()) {
        eprintln!("NOT RUN: no disk can be mounted here (unshare --map-root-user --mount)");
        return None;
    }
    Some(namespace(script).unwrap())
}

fn said(lab: &Lab, name: &str) -> String {
    fs::read_to_string(lab.path(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
}

#[test]
fn a_full_disk_ends_in_order_and_the_study_goes_on() {
    let lab = study_lab();
    let script = "
        mount -t tmpfs -o size=64k none disk
        code=0; \"$0\" study friction.toml --out disk/s > out1 2> err1 || code=$?; echo $code > code1
        cp disk/s/runs.csv table1
        mount -o remount,size=8m disk
        code=0; \"$0\" study friction.toml --out disk/s > out2 2> err2 || code=$?; echo $code > code2
        cp disk/s/runs.csv table2
        rm -r disk/s
        mount -o remount,size=200k disk
        code=0; \"$0\" run case.toml --out disk/r > out3 2> err3 || code=$?; echo $code > code3
        cp disk/r/summary.toml disk/r/history.csv .";
    let Some(output) = with_own_mounts(&lab, script) else { return };
    assert!(output.status.success(), "{output:?}");
    assert_eq!(said(&lab, "code1"), "3\n", "{}", said(&lab, "out1"));
    assert!(said(&lab, "err1").contains("error: cannot") && said(&lab, "err1").contains("the disk is full"));
    let first = said(&lab, "table1");
    assert!(first.ends_with('\n') && (1..11).contains(&first.lines().count()), "{first}");
    assert_eq!(said(&lab, "code2"), "0\n", "{}", said(&lab, "err2"));
    assert_eq!(said(&lab, "table2"), undisturbed());
    assert_eq!(said(&lab, "code3"), "3\n", "{}", said(&lab, "out3"));
    assert!(said(&lab, "err3").contains("the disk is full"), "{}", said(&lab, "err3"));
    let summary = said(&lab, "summary.toml");
    assert!(summary.starts_with("trusted = false"), "{summary}");
    assert!(summary.contains("status = \"running\"") || summary.contains("status = \"failed: "), "{summary}");
    assert!(said(&lab, "history.csv").ends_with('\n'));
}

#[test]
fn a_folder_that_cannot_be_written_is_refused() {
    let lab = study_lab();
    let script = "
        mount -t tmpfs -o size=1m none disk
        \"$0\" study friction.toml --out disk/s > /dev/null 2>&1
        cp disk/s/runs.csv table1
        mount -o remount,ro disk
        code=0; \"$0\" study friction.toml --out disk/s > out1 2> err1 || code=$?; echo $code > code1
        code=0; \"$0\" study friction.toml --out disk/new > out2 2> err2 || code=$?; echo $code > code2
        code=0; \"$0\" run case.toml --out disk/new > out3 2> err3 || code=$?; echo $code > code3
        cp disk/s/runs.csv table2";
    let Some(output) = with_own_mounts(&lab, script) else { return };
    assert!(output.status.success(), "{output:?}");
    for (code, err, expected) in [("code1", "err1", "3\n"), ("code2", "err2", "3\n"), ("code3", "err3", "2\n")] {
        assert_eq!(said(&lab, code), expected, "{}", said(&lab, err));
        assert!(said(&lab, err).contains("error: cannot") && said(&lab, err).contains("disk/"), "{}", said(&lab, err));
    }
    assert_eq!(said(&lab, "table1"), said(&lab, "table2"));
}

/// A folder of somebody else is left alone by all of them.
#[test]
fn a_folder_of_others_is_refused() {
    let lab = study_lab();
    fs::create_dir(lab.path("mine")).unwrap();
    fs::write(lab.path("mine/runs.csv"), "mine").unwrap();
    let study = ["study", "friction.toml", "--out", "mine"];
    for task in [&[][..], &["--list"], &["--run", "1"], &["--collect"]] {
        let outcome = lab.run(&[&study[..], task].concat());
        assert!(outcome.code == Some(2) && outcome.err.contains("holds no study"), "{task:?}: {outcome:?}");
    }
    assert!(lab.contents("mine").len() == 1 && Path::new(&lab.path("mine/runs.csv")).exists());
}

//! Ctrl-C, a reader who leaves, a full disk.
#![cfg(unix)]

use crate::lab::{Lab, Outcome, TINY, changed, long};
use std::fs;
use std::io::{BufRead, BufReader};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

/// The run that is interrupted.
const RUN: [&str; 4] = ["run", "case.toml", "--out", "results"];
/// Longest wait for anything here.
const PATIENCE: Duration = Duration::from_secs(30);

pub fn start(lab: &Lab, arguments: &[&str]) -> Child {
    let mut command = lab.command(arguments);
    command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap()
}

pub fn wait_until(what: &str, done: impl Fn() -> bool) {
    let start = Instant::now();
    while !done() {
        assert!(start.elapsed() < PATIENCE, "{what} takes too long");
        std::thread::sleep(Duration::from_millis(10));
    }
}

/// Sends a signal and waits for the end.
pub fn end(child: Child, signal: &str) -> Outcome {
    let sent = Command::new("kill").args([signal, &child.id().to_string()]).status().unwrap();
    assert!(sent.success());
    Outcome::of(&child.wait_with_output().unwrap())
}

#[test]
fn a_run_that_is_interrupted_keeps_what_it_computed() {
    for signal in ["-INT", "-TERM"] {
        let lab = Lab::new(&long());
        let child = start(&lab, &RUN);
        wait_until("the first sample", || {
            fs::read_to_string(lab.path("results/history.csv")).is_ok_and(|text| text.lines().count() > 300)
        });
        let outcome = end(child, signal);
        assert_eq!(outcome.code, Some(3), "{outcome:?}");
        assert!(outcome.err.contains("stopping: writing what was computed"), "{}", outcome.err);
        assert!(outcome.out.contains("stopped by the user"), "{}", outcome.out);
        assert!(lab.status("results").starts_with("stopped by the user"));
        let rows = lab.rows("results");
        assert!(rows["history.csv"] >= 300 && rows["energy.csv"] >= 30, "{rows:?}");
        for name in ["force_time.svg", "energy_shares.svg", "flow_snapshots.svg"] {
            assert!(lab.path(&format!("results/{name}")).exists(), "{name} was not drawn");
        }
        assert!(lab.contents("results").keys().all(|name| !name.ends_with(".tmp")));
    }
}

/// `timeout -s INT` sends two signals within milliseconds, to the process and to its group.
#[test]
fn two_signals_close_together_are_one() {
    let lab = Lab::new(&long());
    let child = start(&lab, &RUN);
    wait_until("the first sample", || lab.path("results/history.csv").exists());
    let id = child.id();
    let script = format!("kill -INT {id}; sleep 0.003; kill -INT {id}");
    let sent = Command::new("sh").args(["-c", &script]).status().unwrap();
    assert!(sent.success());
    let outcome = Outcome::of(&child.wait_with_output().unwrap());
    assert_eq!(outcome.code, Some(3), "{outcome:?}");
    assert_eq!(outcome.err.matches("stopping").count(), 1, "{}", outcome.err);
    assert!(lab.status("results").starts_with("stopped by the user"));
}

#[test]
fn a_run_that_is_interrupted_before_the_release_ends_in_order() {
    let settle = "[stages.settle]\ndamping_per_s = 1\nresidual = 1.0e-12\nmax_time_s = 400\n\n[stages.run]";
    let lab = Lab::new(&changed("[stages.run]", settle));
    let child = start(&lab, &RUN);
    wait_until("the folder", || lab.path("results/history.csv").exists());
    let outcome = end(child, "-INT");
    assert_eq!(outcome.code, Some(3), "{outcome:?}");
    assert!(lab.status("results").starts_with("stopped by the user"));
    assert_eq!(lab.rows("results")["history.csv"], 0);
}

#[test]
fn a_reader_who_leaves_does_not_end_the_run() {
    let lab = Lab::new(TINY);
    let mut child = start(&lab, &RUN);
    let mut first = String::new();
    // Both streams are closed at the other end after a line at most.
    drop(child.stdout.take());
    BufReader::new(child.stderr.take().unwrap()).read_line(&mut first).unwrap();
    assert!(first.contains("run: t "), "{first}");
    // It completes, and not at rest.
    assert_eq!(child.wait().unwrap().code(), Some(4));
    assert!(lab.status("results").starts_with("completed"));

    let lab = Lab::new(&changed("young_pa = 1.0e6", "young_pa = -1"));
    let mut child = start(&lab, &RUN);
    drop((child.stdout.take(), child.stderr.take()));
    assert_eq!(child.wait().unwrap().code(), Some(2));
}

#[test]
fn a_disk_that_fills_up_leaves_whole_rows() {
    let lab = Lab::new(TINY);
    // Stands in for a full disk: no file may grow beyond 60 blocks of 512 bytes, less than the history needs.
    let script = "trap '' XFSZ; ulimit -f 60; exec \"$0\" run case.toml --out results";
    let mut shell = Command::new("sh");
    shell.args(["-c", script, env!("CARGO_BIN_EXE_checkdam")]).current_dir(lab.directory.path());
    let outcome = Outcome::of(&shell.output().unwrap());
    assert_eq!(outcome.code, Some(3), "{outcome:?}");
    for text in ["error: cannot add to results/history.csv", "complete rows are in the file and readable", "ulimit"] {
        assert!(outcome.err.contains(text), "no {text:?} in\n{}", outcome.err);
    }
    let rows = lab.rows("results");
    assert!(rows["history.csv"] > 100 && rows["energy.csv"] > 10, "{rows:?}");
    assert!(outcome.err.contains(&format!("{} complete rows", rows["history.csv"])), "{}", outcome.err);
    let status = lab.status("results");
    assert!(status.starts_with("failed: cannot add to"), "{status}");
    assert!(lab.path("results/energy_shares.svg").exists(), "what can be drawn is drawn");
}

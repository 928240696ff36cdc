//! `checkdam study`.

use crate::lab::{Lab, TINY};
use std::fs;

const STUDY: &str = r#"title = "Friction of base and barrier"
cases = ["case.toml"]

[[axis]]
name = "base_friction_1"
fields = ["boundaries.base.friction"]
values = [0.2, 0.4]

[[axis]]
name = "barrier_friction_1"
fields = ["boundaries.barrier.friction"]
values = [0.0, 0.2]

[figure]
x = "base_friction_1"
y = "arrival_s"
"#;

fn lab(study: &str) -> Lab {
    let lab = Lab::new(TINY);
    fs::write(lab.path("friction.toml"), study).unwrap();
    lab
}

#[test]
fn a_study_ends_in_one_table_and_a_figure() {
    let lab = lab(STUDY);
    let outcome = lab.run(&["study", "friction.toml"]);
    assert_eq!(outcome.code, Some(0), "{outcome:?}");
    assert!(outcome.err.contains("4 of 4 runs"), "{}", outcome.err);
    let text = lab.read("out/friction/runs.csv");
    let rows: Vec<Vec<&str>> = text.lines().map(|l| l.split(',').collect()).collect();
    assert_eq!(rows[0][..6], ["case", "factor", "label", "replicate", "base_friction_1", "barrier_friction_1"]);
    // They end before the sand is at rest.
    assert_eq!(rows[0][6..9], ["key", "ended", "trusted"]);
    assert!(rows[1..].iter().all(|row| row[8] == "false"), "{text}");
    assert!(outcome.out.contains("4 of them are not to be trusted"), "{}", outcome.out);
    let varied: Vec<&[&str]> = rows[1..].iter().map(|r| &r[4..6]).collect();
    assert_eq!(varied, [["0.2", "0"], ["0.2", "0.2"], ["0.4", "0"], ["0.4", "0.2"]]);
    // A rougher base is slower.
    let arrival = rows[0].iter().position(|c| *c == "arrival_s").unwrap();
    let at = |row: usize| rows[row][arrival].parse::<f64>().unwrap();
    assert!(at(1) < at(3), "{} {}", at(1), at(3));
    assert!(lab.read("out/friction/figure.svg").starts_with("<svg"));
    // Given again, nothing is left to do, and nothing changes.
    let before = lab.contents("out");
    let again = lab.run(&["study", "friction.toml", "--threads", "1"]);
    assert_eq!(again.code, Some(0), "{again:?}");
    assert!(before == lab.contents("out"));
}

#[test]
fn a_study_is_checked_without_running_it() {
    let lab = lab(STUDY);
    let outcome = lab.run(&["study", "friction.toml", "--check"]);
    assert_eq!(outcome.code, Some(0), "{outcome:?}");
    for text in ["is valid: 4 runs", "case, axis, base_friction_1 0.4, barrier_friction_1 0.2", "particle-steps"] {
        assert!(outcome.out.contains(text), "no {text:?} in\n{}", outcome.out);
    }
    assert!(!lab.path("out").exists(), "a check writes nothing");
    fs::write(lab.path("friction.toml"), STUDY.replace("[0.2, 0.4]", "[0.2, -0.4]")).unwrap();
    let outcome = lab.run(&["study", "friction.toml", "--check"]);
    assert!(outcome.code == Some(2) && outcome.err.contains("friction = -0.4"), "{outcome:?}");
}

#[test]
fn a_study_that_makes_no_sense_is_refused() {
    for (from, to, words) in [
        ("boundaries.base.friction", "boundaries.bse.friction", "no element of boundaries is named `bse`"),
        ("[0.2, 0.4]", "[0.2, -0.4]", "friction = -0.4"),
        ("case.toml", "cas.toml", "cas.toml cannot be read"),
        ("fields", "field", "field"),
    ] {
        let lab = lab(&STUDY.replacen(from, to, 1));
        let outcome = lab.run(&["study", "friction.toml"]);
        assert_eq!(outcome.code, Some(2), "{to}: {outcome:?}");
        assert!(outcome.err.contains("error") && outcome.err.contains(words), "{to}: {}", outcome.err);
        assert!(!lab.path("out").exists(), "{to}: something was written");
    }
}

#[cfg(unix)]
#[test]
fn a_study_that_is_interrupted_goes_on() {
    use crate::interrupted::{end, start, wait_until};
    // The last two runs take minutes, and are cut short before the second attempt.
    let long = STUDY.replace("[0.2, 0.4]", "[0.4]").replace(
        "[[axis]]\nname = \"base",
        "[base.set]\n\"stages.run.stop_at_rest\" = false\n\n[[axis]]\nname = \"base",
    );
    let slow =
        format!("{long}\n[[axis]]\nname = \"end_s\"\nfields = [\"stages.run.end_time_s\"]\nvalues = [0.2, 400.0]\n");
    let slow = slow.replace("[figure]\nx = \"base_friction_1\"\ny = \"arrival_s\"\n", "");
    let lab = lab(&slow);
    let child = start(&lab, &["study", "friction.toml", "--threads", "2"]);
    let rows = || fs::read_to_string(lab.path("out/friction/runs.csv")).map_or(0, |t| t.lines().count());
    wait_until("the two short runs", || rows() == 3);
    let outcome = end(child, "-INT");
    assert_eq!(outcome.code, Some(3), "{outcome:?}");
    assert!(outcome.err.contains("stopping: runs that have ended are kept"), "{}", outcome.err);
    assert!(outcome.out.contains("goes on where it stopped"), "{}", outcome.out);
    assert_eq!(rows(), 3);
    fs::write(lab.path("friction.toml"), slow.replace("400.0", "0.25")).unwrap();
    let outcome = lab.run(&["study", "friction.toml"]);
    assert_eq!((outcome.code, rows()), (Some(0), 5), "{outcome:?}");
    // Only the runs that were not there yet are told.
    assert!(outcome.err.contains("4 of 4 runs") && !outcome.err.contains("2 of 4 runs"), "{}", outcome.err);
}

/// One command a line, each makes a run; whoever gives them, in whatever order, the table is that of the local pool.
#[cfg(unix)]
#[test]
fn runs_that_are_made_one_by_one_make_the_same_table() {
    use std::process::Command;
    let lab = lab(STUDY);
    assert_eq!(lab.run(&["study", "friction.toml", "--out", "pool"]).code, Some(0));
    let task = |task: &[&str]| lab.run(&[&["study", "friction.toml", "--out", "each one"], task].concat());
    let list = task(&["--list"]);
    assert_eq!(list.code, Some(0), "{list:?}");
    let commands: Vec<&str> = list.out.lines().collect();
    assert!(
        commands.len() == 4 && commands[0].contains(" study friction.toml --out 'each one' --run "),
        "{}",
        list.out
    );
    let status = || lab.read("each one/status.toml").lines().next().unwrap().to_string();
    assert_eq!(status(), "status = \"listed\"");
    let manifest = lab.read("each one/manifest.csv");
    let keys: Vec<&str> = manifest.lines().skip(1).map(|line| line.split(',').nth(1).unwrap()).collect();
    assert!(commands.iter().zip(&keys).all(|(command, key)| command.ends_with(key)), "{manifest}");
    // Nothing is there yet, and that is said.
    let none = task(&["--collect"]);
    assert!(none.code == Some(3) && none.out.contains("0 of 4 runs") && none.out.contains("INCOMPLETE"), "{none:?}");
    let shell = |command: &str| {
        let mut shell = Command::new("sh");
        shell.args(["-c", command]).current_dir(lab.directory.path());
        shell
    };
    // The last two at the same time, and one of them twice.
    let both = [commands[3], commands[2], commands[3]].map(|command| shell(command).spawn().unwrap());
    both.into_iter().for_each(|mut child| assert_eq!(child.wait().unwrap().code(), Some(0)));
    let part = task(&["--collect"]);
    assert!(part.code == Some(3) && part.out.contains("2 of 4 runs are in each one/runs.csv"), "{part:?}");
    for (number, key) in (1..3).zip(&keys) {
        assert!(part.out.contains(&format!("  {number} (--run {key}): case, axis, base")), "{}", part.out);
    }
    assert_eq!(status(), "status = \"incomplete\"");
    assert!(shell(commands[0]).status().unwrap().success());
    // By its number; and again, when nothing is left to do.
    for _ in 0..2 {
        let second = task(&["--run", "2"]);
        assert!(second.code == Some(0) && second.out.contains("run 2 of 4, case, axis"), "{second:?}");
    }
    let all = task(&["--collect"]);
    assert_eq!(all.code, Some(0), "{all:?}");
    assert_eq!(status(), "status = \"complete\"");
    for name in ["runs.csv", "manifest.csv", "status.toml", "study.toml", "figure.svg"] {
        assert!(lab.read(&format!("each one/{name}")) == lab.read(&format!("pool/{name}")), "{name}");
    }
    // The pool finds the same results.
    let pool = lab.run(&["study", "friction.toml", "--out", "each one"]);
    assert!(pool.code == Some(0) && !pool.err.contains("of 4 runs, about"), "{pool:?}");
}

#[test]
fn a_run_that_the_study_has_not_is_refused() {
    let lab = lab(STUDY);
    let one = |which: &str| lab.run(&["study", "friction.toml", "--run", which]);
    for which in ["0", "5", "-1", "first", "0123456789abcdef"] {
        let outcome = one(which);
        assert_eq!(outcome.code, Some(2), "{which}: {outcome:?}");
    }
    assert!(one("5").err.contains("there are runs 1 to 4"), "{}", one("5").err);
    assert!(one("0123456789abcdef").err.contains("no run of this key"));
    // A number stands for what it stood for when the runs were listed.
    assert_eq!(lab.run(&["study", "friction.toml", "--list"]).code, Some(0));
    fs::write(lab.path("friction.toml"), STUDY.replace("[0.2, 0.4]", "[0.3, 0.4]")).unwrap();
    let changed = one("1");
    assert!(changed.code == Some(2) && changed.err.contains("list them again with --list"), "{changed:?}");
    assert_eq!(one("3").code, Some(0));
    for both in [&["--list", "--collect"][..], &["--run", "1", "--threads", "2"], &["--check", "--run", "1"]] {
        let outcome = lab.run(&[&["study", "friction.toml"], both].concat());
        assert_eq!(outcome.code, Some(2), "{both:?}");
    }
}

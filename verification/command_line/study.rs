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

//! `checkdam verify` and `checkdam validate`.

use crate::lab::{Lab, TINY};
use std::fs;
use std::path::Path;

/// The command and the tests write the same reports, again and again.
#[test]
fn verify_writes_the_reports_byte_for_byte() {
    let lab = Lab::new(TINY);
    let rungs = ["exactness", "drucker_prager_point", "self_weight"];
    for out in ["once", "again"] {
        let outcome = lab.run(&[&["verify"], &rungs[..], &["--out", out]].concat());
        assert_eq!(outcome.code, Some(0), "{outcome:?}");
        assert!(outcome.out.ends_with("all 3 rungs pass\n"), "{}", outcome.out);
        for rung in rungs {
            assert!(outcome.out.contains(&format!("{rung}: ")), "{}", outcome.out);
        }
        for text in
            ["quantity", "measured", "expected", "error", "tolerance", "source", "again/self_weight_profile_plot.svg"]
        {
            let text = text.replace("again", out);
            assert!(outcome.out.contains(&text), "no {text:?} in\n{}", outcome.out);
        }
    }
    let once = lab.contents("once");
    assert!(once == lab.contents("again"), "a second run differs");
    let reports = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../..")).join("reports/verification");
    assert!(once.keys().any(|name| name.ends_with(".svg")) && once.len() > 12, "{:?}", once.keys());
    for (name, bytes) in &once {
        let (stem, kind) = name.split_once('.').unwrap();
        let stored = reports.join(format!("{stem}.{kind}"));
        let stored = fs::read(&stored).unwrap_or_else(|error| panic!("{}: {error}", stored.display()));
        assert!(stored == *bytes, "{name} is not what stands in the reports");
    }
}

#[test]
fn a_rung_that_does_not_exist_is_refused() {
    let lab = Lab::new(TINY);
    let outcome = lab.run(&["verify", "hovercraft", "--out", "results"]);
    assert_eq!(outcome.code, Some(2), "{outcome:?}");
    assert!(
        outcome.err.contains("there is no rung `hovercraft`") && outcome.err.contains("self_weight"),
        "{}",
        outcome.err
    );
    assert!(!lab.path("results").exists());
}

#[test]
fn validate_writes_the_reports_byte_for_byte() {
    let lab = Lab::new(TINY);
    let names = ["flume_baseline", "flume_verdict"];
    let outcome = lab.run(&[&["validate"], &names[..], &["--out", "results"]].concat());
    assert_eq!(outcome.code, Some(0), "{outcome:?}");
    assert!(outcome.out.ends_with("all 2 validations pass\n"), "{}", outcome.out);
    assert!(outcome.err.contains("read from the record"), "{}", outcome.err);
    let results = lab.contents("results");
    assert!(results.len() >= 6, "{:?}", results.keys());
    for (name, bytes) in &results {
        let (stem, kind) = name.split_once('.').unwrap();
        let stored =
            Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../..")).join(format!("reports/validation/{stem}.{kind}"));
        let stored = fs::read(&stored).unwrap_or_else(|error| panic!("{}: {error}", stored.display()));
        assert!(stored == *bytes, "{name} is not what stands in the reports");
    }
}

#[test]
fn a_validation_that_does_not_exist_is_refused() {
    let lab = Lab::new(TINY);
    let outcome = lab.run(&["validate", "hovercraft", "--out", "results"]);
    assert_eq!(outcome.code, Some(2), "{outcome:?}");
    assert!(
        outcome.err.contains("there is no validation `hovercraft`") && outcome.err.contains("flume_noise"),
        "{}",
        outcome.err
    );
    assert!(!lab.path("results").exists());
}

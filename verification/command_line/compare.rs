//! `checkdam compare`: what differs is found and counted, and what cannot be compared is never passed over.

use crate::lab::{Lab, Outcome, TINY, changed};
use std::fs;

/// A lab with a run of [`TINY`] in `a`, and the same files in `b`.
fn twins() -> Lab {
    let lab = Lab::new(TINY);
    assert_eq!(lab.run(&["run", "case.toml", "--out", "a"]).code, Some(4));
    copy(&lab, "a", "b");
    lab
}

fn copy(lab: &Lab, from: &str, to: &str) {
    fs::create_dir(lab.path(to)).unwrap();
    for (name, bytes) in lab.contents(from).into_iter().filter(|(name, _)| !name.contains('/')) {
        fs::write(lab.path(&format!("{to}/{name}")), bytes).unwrap();
    }
}

/// Replaces a text that stands once in a file.
fn spoil(lab: &Lab, file: &str, replace: &str, by: &str) {
    let text = lab.read(file);
    assert_eq!(text.matches(replace).count(), 1, "{file}: {replace:?}");
    fs::write(lab.path(file), text.replace(replace, by)).unwrap();
}

/// The line of `key` in a summary.
fn line(lab: &Lab, file: &str, key: &str) -> String {
    let text = lab.read(file);
    text.lines().find(|line| line.starts_with(&format!("{key} = "))).unwrap_or_else(|| panic!("no {key}")).to_owned()
}

/// The line of the comparison that begins with `quantity`.
fn told(outcome: &Outcome, quantity: &str) -> String {
    let found = outcome.out.lines().find(|line| line.split_whitespace().next() == Some(quantity));
    found.unwrap_or_else(|| panic!("no {quantity} in\n{}", outcome.out)).to_owned()
}

/// Column `name` of a history multiplied by a factor.
fn scale_column(lab: &Lab, file: &str, name: &str, factor: f64) {
    let text = lab.read(file);
    let at = text.lines().next().unwrap().split(',').position(|column| column == name).unwrap();
    let row = |(k, line): (usize, &str)| {
        let cell = |(column, cell): (usize, &str)| match cell.parse::<f64>() {
            Ok(value) if k > 0 && column == at => (factor * value).to_string(),
            _ => cell.to_owned(),
        };
        line.split(',').enumerate().map(cell).collect::<Vec<_>>().join(",") + "\n"
    };
    fs::write(lab.path(file), text.lines().enumerate().map(row).collect::<String>()).unwrap();
}

#[test]
fn differences_between_runs_are_found_and_counted() {
    let lab = twins();
    let same = lab.run(&["compare", "a", "b"]);
    assert_eq!(same.code, Some(0), "{same:?}");
    assert!(same.out.contains("inputs: the same") && same.out.contains("\n0 of "), "{}", same.out);
    assert!(told(&same, "barrier.static_force_n").contains(" 0 "), "{}", same.out);
    assert_eq!(same.out, lab.run(&["compare", "a", "b"]).out, "the order is not the same each time");

    // One force is 3 % off, in the table and in the summary.
    scale_column(&lab, "b/history.csv", "force_normal_n", 1.03);
    let peak = line(&lab, "b/summary.toml", "peak_20ms_n");
    let value: f64 = peak.rsplit(' ').next().unwrap().parse().unwrap();
    spoil(&lab, "b/summary.toml", &peak, &format!("peak_20ms_n = {}", 1.03 * value));
    for (tolerance, code) in [("0", 1), ("0.02", 1), ("0.031", 0)] {
        let outcome = lab.run(&["compare", "a", "b", "--tolerance", tolerance]);
        assert_eq!(outcome.code, Some(code), "{tolerance}: {}", outcome.out);
    }
    let outcome = lab.run(&["compare", "a", "b", "--tolerance", "0.02"]);
    assert!(outcome.out.contains("\n2 of "), "{}", outcome.out);
    for quantity in ["barrier.peak_20ms_n", "history.csv:force_normal_n"] {
        assert!(told(&outcome, quantity).contains("DIFFERS"), "{}", outcome.out);
    }
    assert!(told(&outcome, "barrier.peak_20ms_n").contains("+3.000e-2"), "{}", outcome.out);
    // Only what is asked for.
    let asked = |names: &str| lab.run(&["compare", "a", "b", "--tolerance", "0.02", "--quantities", names]).code;
    assert_eq!(asked("static_force_n,history.csv:run_up_m"), Some(0));
    assert_eq!(asked("static_force_n,peak_20ms_n"), Some(1));
    assert_eq!(asked("static_force_n,force_normal"), Some(2), "an unknown name is passed over");

    let figure = lab.run(&["compare", "a", "b", "--figure", "forces.svg", "--tolerance", "0.1"]);
    assert_eq!(figure.code, Some(0), "{figure:?}");
    let svg = lab.read("forces.svg");
    assert!(svg.starts_with("<svg ") && svg.contains("A: a") && svg.contains("B: b"), "no curves of both");
    assert!(!lab.contents("").keys().any(|name| name.contains("overlay")), "something is left behind");
}

#[test]
fn what_is_missing_or_no_number_differs_within_any_tolerance() {
    let lab = twins();
    let static_force = line(&lab, "a/summary.toml", "static_force_n");
    let over = line(&lab, "a/summary.toml", "overtopped_kg");
    let changes: [(&str, &str, String, &str); 5] = [
        ("summary.toml", "barrier.static_force_n", static_force.clone(), "static_force_n = nan"),
        ("summary.toml", "barrier.static_force_n", format!("{static_force}\n"), ""),
        ("summary.toml", "barrier.overtopped_kg", over, "overtopped_kg = 1e-12"),
        ("summary.toml", "trusted", "trusted = false".into(), "trusted = true"),
        ("history.csv", "history.csv:force_normal_n", "time_s,force_normal_n,".into(), "time_s,force_n,"),
    ];
    for (file, quantity, replace, by) in changes {
        let kept = lab.read(&format!("b/{file}"));
        spoil(&lab, &format!("b/{file}"), &replace, by);
        for pair in [["a", "b"], ["b", "a"]] {
            let outcome = lab.run(&["compare", pair[0], pair[1], "--tolerance", "0.99"]);
            assert_eq!(outcome.code, Some(1), "{quantity}: {}", outcome.out);
            assert!(told(&outcome, quantity).contains("DIFFERS"), "{}", outcome.out);
        }
        fs::write(lab.path(&format!("b/{file}")), kept).unwrap();
    }
    // Not a number on both sides is not the same number.
    for side in ["a", "b"] {
        spoil(&lab, &format!("{side}/summary.toml"), &static_force, "static_force_n = nan");
    }
    let outcome = lab.run(&["compare", "a", "b", "--tolerance", "0.99"]);
    assert!(outcome.code == Some(1) && told(&outcome, "barrier.static_force_n").contains("no number"), "{outcome:?}");
    // A table on one side.
    copy(&lab, "b", "c");
    fs::remove_file(lab.path("c/momentum.csv")).unwrap();
    let outcome = lab.run(&["compare", "b", "c", "--quantities", "run_up_m"]);
    assert_eq!(outcome.code, Some(0), "{}", outcome.out);
    let outcome = lab.run(&["compare", "b", "c", "--tolerance", "0.99"]);
    assert!(outcome.code == Some(1) && told(&outcome, "momentum.csv").contains("missing in B"), "{outcome:?}");
}

#[test]
fn inputs_that_differ_are_named() {
    let lab = twins();
    fs::write(lab.path("case.toml"), changed("foot_m = [0.3, 0.0]", "foot_m = [0.31, 0.0]")).unwrap();
    assert_eq!(lab.run(&["run", "case.toml", "--out", "c"]).code, Some(4));
    let outcome = lab.run(&["compare", "a", "c", "--tolerance", "0.5"]);
    assert!(outcome.out.contains("inputs differ"), "{}", outcome.out);
    assert!(outcome.out.contains("boundaries.barrier.foot_m[0]: 0.3, 0.31"), "{}", outcome.out);
    assert_eq!(lab.run(&["compare", "a", "c"]).code, Some(1));
}

#[test]
fn folders_that_are_no_runs_are_refused() {
    let lab = twins();
    fs::create_dir(lab.path("empty")).unwrap();
    copy(&lab, "a", "torn");
    fs::write(lab.path("torn/summary.toml"), "trusted = tr").unwrap();
    copy(&lab, "a", "other");
    fs::write(lab.path("other/summary.toml"), "title = 'notes'").unwrap();
    fs::create_dir(lab.path("study")).unwrap();
    fs::write(lab.path("study/runs.csv"), "case,key,ended,trusted,run_up_m\nc,1,at rest,true,0.5\n").unwrap();
    for (folder, words) in [
        ("empty", "neither summary.toml nor runs.csv"),
        ("nothing", "does not exist"),
        ("case.toml", "is no folder"),
        ("torn", "cannot be read"),
        ("other", "no summary of a run"),
        ("study", "that of a study"),
    ] {
        for pair in [["a", folder], [folder, "a"]] {
            let outcome = lab.run(&["compare", pair[0], pair[1]]);
            assert_eq!(outcome.code, Some(2), "{folder}: {outcome:?}");
            assert!(outcome.err.contains("error: ") && outcome.err.contains(words), "{folder}: {}", outcome.err);
        }
    }
    for tolerance in ["1", "-0.1", "nan", "x"] {
        assert_eq!(lab.run(&["compare", "a", "b", "--tolerance", tolerance]).code, Some(2), "{tolerance}");
    }
    let outcome = lab.run(&["compare", "study", "study", "--figure", "f.svg"]);
    assert_eq!(outcome.code, Some(2), "{outcome:?}");
}

#[test]
fn studies_are_compared_run_by_run() {
    let lab = Lab::new(TINY);
    let head = "case,factor,label,replicate,friction_1,key,ended,trusted,peak_20ms_n,run_up_m,tip_max_m\n";
    let write = |name: &str, rows: &str| {
        fs::create_dir_all(lab.path(name)).unwrap();
        fs::write(lab.path(&format!("{name}/runs.csv")), format!("{head}{rows}")).unwrap();
    };
    let first = "c,axis,,0,0.2,k1,at rest,true,100,0.5,\n";
    write("a", &format!("{first}c,axis,,0,0.4,k2,at rest,true,80,0.4,\n"));
    // The order of rows does not matter.
    write("b", &format!("c,axis,,0,0.4,k2,at rest,true,80,0.4,\n{first}"));
    let outcome = lab.run(&["compare", "a", "b"]);
    assert_eq!(outcome.code, Some(0), "{outcome:?}");
    assert!(told(&outcome, "tip_max_m").contains("empty on both sides"), "{}", outcome.out);
    let cases: [(&str, &str, &str); 6] = [
        ("c,axis,,0,0.4,k2,at rest,true,82.4,0.4,\n", "peak_20ms_n", "friction_1 0.4"),
        ("c,axis,,0,0.4,k2,at rest,true,,0.4,\n", "peak_20ms_n", "missing in B"),
        ("c,axis,,0,0.4,k2,at rest,true,80,0.4,0.1\n", "tip_max_m", "missing in A"),
        ("c,axis,,0,0.4,k2,at rest,false,80,0.4,\n", "trusted", "friction_1 0.4"),
        ("c,axis,,0,0.6,k2,at rest,true,80,0.4,\n", "case", "missing in"),
        ("", "case", "missing in B"),
    ];
    for (row, quantity, words) in cases {
        write("b", &format!("{first}{row}"));
        let outcome = lab.run(&["compare", "a", "b", "--tolerance", "0.02"]);
        assert_eq!(outcome.code, Some(1), "{row}: {}", outcome.out);
        let found = outcome.out.lines().any(|line| line.starts_with(quantity) && line.contains(words));
        assert!(found, "{row}: no {quantity:?} with {words:?} in\n{}", outcome.out);
    }
    write("b", &format!("{first}c,axis,,0,0.4,k3,at rest,true,82.4,0.4,\n"));
    let outcome = lab.run(&["compare", "a", "b", "--tolerance", "0.031"]);
    assert!(outcome.code == Some(0) && outcome.out.contains("inputs of 1 of 2 runs"), "{outcome:?}");
    write("b", &format!("{first}{first}"));
    assert_eq!(lab.run(&["compare", "a", "b"]).code, Some(2));
}

//! `checkdam check` and `checkdam run`.

use crate::lab::{FIGURES, Lab, TABLES, TINY, changed, wide};
use std::fs;
use std::path::Path;

#[test]
fn bad_values_are_refused_with_their_line_and_a_fix() {
    let cases: [(&str, &str, &[&str]); 16] = [
        ("_m3 = 1500", "_m3 = -1500", &["density_kg_per_m3 = -1500", "use a positive value"]),
        ("young_pa = 1.0e6", "young_pa = 0", &["young_pa = 0"]),
        ("mass_kg = 24", "mass_kg = -24", &["mass_kg = -24"]),
        ("mass_kg = 24", "mass_kg = 30", &["mass_kg = 30", "24"]),
        ("spacing_m = 0.05", "spacing_m = 0", &["spacing_m = 0"]),
        ("poisson = 0.3", "poisson = 0.5", &["poisson = 0.5"]),
        ("angle_deg = 31", "angle_deg = 95", &["friction_angle_deg = 95"]),
        ("young_pa = 1.0e6", "young_pa = nan", &["young_pa = nan", "finite"]),
        ("end_time_s = 0.4", "end_time_s = inf", &["end_time_s = inf", "finite"]),
        ("young_pa = 1.0e6", "yuong_pa = 1.0e6", &["yuong_pa", "young_pa"]),
        ("poisson = 0.3", "poisson = \"soft\"", &["poisson", "soft"]),
        ("foot_m = [0.3, 0.0]", "foot_m = [-0.1, 0.0]", &["body `sand` overlaps boundary `barrier`"]),
        ("stations_m = [0.1, 0.2]", "stations_m = [0.1, 2.0]", &["stations_m[1] = 2", "inside the domain"]),
        ("spacing_m = 0.05", "spacing_m = 1.75e-5", &["1.0e9 particles", "use spacing_m = "]),
        ("end_time_s = 0.4", "end_time_s = 4.0e9", &["time steps"]),
        ("[grid]", "[grid", &["grid"]),
    ];
    for (replace, by, expected) in cases {
        let text = changed(replace, by);
        let lab = Lab::new(&text);
        lab.refuses("case.toml", "results", expected);
        let err = lab.run(&["check", "case.toml"]).err;
        let line = 1 + text[..text.find(by).unwrap()].matches('\n').count();
        // What follows from the change may be told where it shows.
        let followed = by.starts_with("foot_m");
        assert!(followed || err.contains(&format!("--> case.toml:{line}:")), "not line {line} in\n{err}");
        assert!(err.contains(" = fix: "), "no fix in\n{err}");
    }
}

#[test]
fn what_is_no_case_file_is_refused() {
    let lab = Lab::new(TINY);
    fs::create_dir(lab.path("folder")).unwrap();
    fs::write(lab.path("garbage.toml"), [0x7f, b'E', b'L', b'F', 0, 1, 0xff, 0xfe, 0x80]).unwrap();
    fs::write(lab.path("empty.toml"), "").unwrap();
    lab.refuses("nothing.toml", "results", &["nothing.toml does not exist", "check the spelling"]);
    lab.refuses("folder", "results", &["folder is a directory", "fix: "]);
    lab.refuses("garbage.toml", "results", &["garbage.toml", "not text", "fix: "]);
    lab.refuses("empty.toml", "results", &["empty.toml", "fix: "]);
}

#[test]
fn folders_that_cannot_take_the_results_are_refused() {
    let lab = Lab::new(TINY);
    fs::create_dir(lab.path("full")).unwrap();
    fs::write(lab.path("full/notes.txt"), "mine").unwrap();
    lab.refuses("case.toml", "full", &["full exists and is not empty", "--out"]);
    lab.refuses("case.toml", "case.toml", &["case.toml is a file", "--out"]);
    lab.refuses("case.toml", "case.toml/results", &["cannot create case.toml/results", "--out"]);
    if cfg!(target_os = "linux") {
        lab.refuses("case.toml", "/proc/results", &["cannot create /proc/results", "--out"]);
    }
}

#[test]
fn a_check_tells_what_would_run() {
    let lab = Lab::new(TINY);
    for name in ["40deg", "23deg"] {
        let path =
            Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../..")).join(format!("validation/flume/{name}.toml"));
        let outcome = lab.run(&["check", path.to_str().unwrap()]);
        assert_eq!(outcome.code, Some(0), "{outcome:?}");
        let expected = [
            "is valid",
            "material points of",
            "time step ",
            "limited by",
            "at most ",
            " steps for",
            "memory ",
            "expected time",
        ];
        for text in expected {
            assert!(outcome.out.contains(text), "no {text:?} in\n{}", outcome.out);
        }
    }
    assert_eq!(lab.contents("").len(), 1, "a check writes nothing");
}

#[test]
fn a_run_leaves_everything_it_promises() {
    let lab = Lab::new(TINY);
    let outcome = lab.run(&["run", "case.toml"]);
    // It ends before it is at rest: the numbers are not to be trusted, and that is said first.
    assert_eq!(outcome.code, Some(4), "{outcome:?}");
    assert!(outcome.out.starts_with("NOT TO BE TRUSTED:\n  "), "{}", outcome.out);
    assert!(lab.read("out/case/summary.toml").starts_with("trusted = false\nreasons = ["));
    for text in ["Tiny flume: completed", "peak force", "energy:", "momentum closes", "results in out/case"] {
        assert!(outcome.out.contains(text), "no {text:?} in\n{}", outcome.out);
    }
    let folder = lab.contents("out/case");
    let frames: Vec<String> = (0..9).map(|k| format!("vtk/flow_{k:05}.vtp")).collect();
    let others = ["summary.toml", "flow.pvd", "vtk/", "vtk/boundaries.vtp"];
    let mut expected: Vec<&str> = TABLES.into_iter().chain(FIGURES).chain(others).collect();
    expected.extend(frames.iter().map(String::as_str));
    expected.sort_unstable();
    assert_eq!(folder.keys().map(String::as_str).collect::<Vec<_>>(), expected);

    let rows = lab.rows("out/case");
    // Samples every millisecond, ledgers every tenth of them and at the start.
    assert!((395..=400).contains(&rows["history.csv"]), "{rows:?}");
    assert!((40..=41).contains(&rows["energy.csv"]) && rows["momentum.csv"] == rows["energy.csv"], "{rows:?}");
    assert!(rows.values().all(|count| *count > 0), "{rows:?}");
    for name in FIGURES {
        let figure = lab.read(&format!("out/case/{name}"));
        assert!(figure.starts_with("<svg ") && figure.trim_end().ends_with("</svg>"), "{name}");
    }
    let collection = lab.read("out/case/flow.pvd");
    assert!(frames.iter().all(|frame| collection.contains(&format!("file=\"{frame}\""))), "{collection}");
    assert!(lab.status("out/case").starts_with("completed"));

    // A second run does not touch the results of the first.
    let again = lab.run(&["run", "case.toml"]);
    assert!(again.code == Some(2) && again.err.contains("replace that run with --force"), "{again:?}");
    assert!(folder == lab.contents("out/case"));
}

/// Of the earlier run, which had a frame and a table more, nothing is left; what is not of it stays.
#[test]
fn an_earlier_run_is_replaced_if_that_is_asked_for() {
    let lab = Lab::new(TINY);
    assert_eq!(lab.run(&["run", "case.toml", "--out", "results"]).code, Some(4));
    fs::write(lab.path("results/notes.txt"), "mine").unwrap();
    let other = changed("vtk_interval_s = 0.05", "vtk_interval_s = 0.1").replace("stations_m = [0.1, 0.2]\n", "");
    fs::write(lab.path("case.toml"), other).unwrap();
    assert_eq!(lab.run(&["run", "case.toml", "--out", "fresh"]).code, Some(4));
    let outcome = lab.run(&["run", "case.toml", "--out", "results", "--force"]);
    assert_eq!(outcome.code, Some(4), "{outcome:?}");
    let mut replaced = lab.contents("results");
    assert_eq!(replaced.remove("notes.txt").as_deref(), Some(&b"mine"[..]));
    assert!(replaced == lab.contents("fresh"), "{:?}", replaced.keys());
    // Nothing else is replaced, nor is anything if the case is at fault.
    fs::create_dir(lab.path("mine")).unwrap();
    fs::write(lab.path("mine/summary.toml"), "title = \"mine\"").unwrap();
    let outcome = lab.run(&["run", "case.toml", "--out", "mine", "--force"]);
    assert!(outcome.code == Some(2) && outcome.err.contains("holds no run of checkdam"), "{outcome:?}");
    fs::write(lab.path("case.toml"), "title = 1").unwrap();
    assert_eq!(lab.run(&["run", "case.toml", "--out", "fresh", "--force"]).code, Some(2));
    assert!(replaced == lab.contents("fresh") && lab.contents("mine").len() == 1);
}

#[test]
fn the_number_of_threads_changes_no_byte() {
    let wide = wide();
    let lab = Lab::new(&wide);
    let case = checkdam::case::load(&lab.path("case.toml")).expect("the case is valid").case;
    let experiment = checkdam::run::Experiment::new(&case);
    for (threads, parts) in [("1", 1), ("2", 2), ("3", 3), ("8", 3)] {
        let divided = experiment.simulation().parts(threads.parse().expect("a number"));
        assert_eq!(divided, parts, "parts for {threads} threads: one division compared with itself proves nothing");
        let outcome = lab.run(&["run", "case.toml", "--out", threads, "--threads", threads]);
        assert_eq!(outcome.code, Some(4), "{outcome:?}");
    }
    let reference = lab.contents("1");
    for threads in ["2", "3", "8"] {
        for (name, bytes) in lab.contents(threads) {
            assert!(reference.get(&name) == Some(&bytes), "{name} differs between 1 and {threads} threads");
        }
        assert_eq!(lab.contents(threads).len(), reference.len());
    }
}

#[test]
fn a_run_that_blows_up_says_where_and_why() {
    let lab = Lab::new(&changed("velocity_m_per_s = [0.0, 0.0]", "velocity_m_per_s = [3000.0, 0.0]"));
    let outcome = lab.run(&["run", "case.toml", "--out", "results"]);
    assert_eq!(outcome.code, Some(3), "{outcome:?}");
    let texts =
        ["error: the simulation failed", "at t = ", "particle ", "of body `sand`", "at x = ", "was limited by", "cfl"];
    for text in texts.into_iter().chain(["what was computed is in results"]) {
        assert!(outcome.err.contains(text), "no {text:?} in\n{}", outcome.err);
    }
    let status = lab.status("results");
    assert!(status.starts_with("failed: ") && status.contains("of body `sand`"), "{status}");
    let rows = lab.rows("results");
    assert!(rows["energy.csv"] > 0 && rows["field.csv"] > 0, "{rows:?}");
    assert!(lab.path("results/flow_snapshots.svg").exists(), "what can be drawn is drawn");
    let check = lab.run(&["check", "case.toml"]);
    assert!(check.code == Some(3) && check.err.contains("error: a run would fail"), "{check:?}");
}

#[test]
fn a_body_that_does_not_settle_is_an_error() {
    let settle = "[stages.settle]\ndamping_per_s = 1\nresidual = 1.0e-12\nmax_time_s = 0.05\n\n[stages.run]";
    let lab = Lab::new(&changed("[stages.run]", settle));
    let outcome = lab.run(&["run", "case.toml", "--out", "results"]);
    assert_eq!(outcome.code, Some(3), "{outcome:?}");
    for text in ["did not settle", "stages.settle.max_time_s"] {
        assert!(outcome.err.contains(text), "no {text:?} in\n{}", outcome.err);
    }
    assert!(lab.status("results").starts_with("failed: "));
}

#[test]
fn a_run_that_is_to_be_trusted_says_so_by_its_exit_code() {
    let lab = Lab::new(
        &changed("end_time_s = 0.4\nstop_at_rest = false", "end_time_s = 4")
            .replace("spacing_m = 0.05", "spacing_m = 0.01")
            .replace("vtk_interval_s = 0.05", "vtk_interval_s = 0"),
    );
    let outcome = lab.run(&["run", "case.toml"]);
    assert_eq!(outcome.code, Some(0), "{outcome:?}");
    assert!(!outcome.out.contains("TRUSTED"), "{}", outcome.out);
    assert!(lab.read("out/case/summary.toml").starts_with("trusted = true\nreasons = []\n"));
}

#[cfg(target_os = "linux")]
#[test]
fn an_output_that_cannot_be_written_is_an_error() {
    let lab = Lab::new(TINY);
    let full = fs::OpenOptions::new().write(true).open("/dev/full").unwrap();
    let output = lab.command(&["check", "case.toml"]).stdout(full).output().unwrap();
    assert_eq!(output.status.code(), Some(3), "{output:?}");
    assert!(String::from_utf8_lossy(&output.stderr).contains("the output could not be written"));
}

#[cfg(unix)]
#[test]
fn no_escape_code_reaches_the_terminal() {
    let lab = Lab::new(TINY);
    let name = "\u{1b}[31mred.toml";
    fs::write(lab.path(name), TINY).unwrap();
    fs::write(lab.path("title.toml"), changed("Tiny flume", "\\u001b[31mred")).unwrap();
    for file in [name, "title.toml"] {
        let outcome = lab.run(&["check", file]);
        assert!(!outcome.out.contains('\u{1b}') && !outcome.err.contains('\u{1b}'), "{outcome:?}");
    }
}

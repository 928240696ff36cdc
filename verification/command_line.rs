//! The command as a user meets it: exit codes, messages, what is in the folder afterwards and what is not.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use tempfile::TempDir;

/// 128 points that run down half a metre and hit a barrier: 800 steps.
const TINY: &str = r#"title = "Tiny flume"

[gravity]
inclination_deg = 40

[grid]
spacing_m = 0.05
thickness_m = 0.2

[domain]
x_m = [-0.4, 0.8]
y_m = [-0.2, 0.8]

[materials.sand]
law = "drucker_prager"
density_kg_per_m3 = 1500
young_pa = 1.0e6
poisson = 0.3
friction_angle_deg = 31

[[bodies]]
name = "sand"
material = "sand"
x_m = [-0.2, 0.0]
y_m = [0.0, 0.4]
velocity_m_per_s = [0.0, 0.0]
mass_kg = 24

[[boundaries]]
name = "base"
kind = "plane"
point_m = [0.0, 0.0]
normal_deg = 90
contact = "coulomb"
friction = 0.4

[[boundaries]]
name = "barrier"
kind = "wall"
foot_m = [0.3, 0.0]
height_m = 0.4
thickness_m = 0.1
contact = "coulomb"
friction = 0.4

[stages.run]
end_time_s = 0.4
stop_at_rest = false

[gauges]
barrier = "barrier"
base = "base"
stations_m = [0.1, 0.2]
window_x_m = [0.0, 0.3]
window_y_m = [0.0, 0.3]
field_times_s = [0.0, 0.1, 0.2]

[output]
vtk_interval_s = 0.05
"#;

/// What a run of [`TINY`] leaves, besides the frames.
const TABLES: [&str; 7] =
    ["energy.csv", "field.csv", "geometry.csv", "history.csv", "momentum.csv", "pressure_profile.csv", "stations.csv"];
const FIGURES: [&str; 4] = ["energy_shares.svg", "flow_snapshots.svg", "force_time.svg", "pressure_profile.svg"];

/// [`TINY`] with one text replaced.
fn changed(replace: &str, by: &str) -> String {
    assert_eq!(TINY.matches(replace).count(), 1, "{replace:?} does not stand in the case once");
    TINY.replace(replace, by)
}

/// [`TINY`] that would run for minutes.
fn long() -> String {
    changed("end_time_s = 0.4", "end_time_s = 400").replace("vtk_interval_s = 0.05", "vtk_interval_s = 0")
}

/// A directory in which the command is run.
struct Lab {
    directory: TempDir,
}

impl Lab {
    fn new(case: &str) -> Self {
        let lab = Self { directory: tempfile::tempdir().unwrap() };
        fs::write(lab.path("case.toml"), case).unwrap();
        lab
    }

    fn path(&self, name: &str) -> PathBuf {
        self.directory.path().join(name)
    }

    fn read(&self, name: &str) -> String {
        fs::read_to_string(self.path(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
    }

    fn command(&self, arguments: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_checkdam"));
        command.args(arguments).current_dir(self.directory.path()).stdin(Stdio::null());
        command
    }

    fn run(&self, arguments: &[&str]) -> Outcome {
        Outcome::of(&self.command(arguments).output().unwrap())
    }

    /// Every file below `folder` with its bytes, by its path; folders end in a slash.
    fn contents(&self, folder: &str) -> BTreeMap<String, Vec<u8>> {
        fn collect(root: &Path, at: &Path, found: &mut BTreeMap<String, Vec<u8>>) {
            for entry in fs::read_dir(at).unwrap() {
                let path = entry.unwrap().path();
                let name = path.strip_prefix(root).unwrap().display().to_string();
                if path.is_dir() {
                    found.insert(name + "/", Vec::new());
                    collect(root, &path, found);
                } else {
                    found.insert(name, fs::read(&path).unwrap());
                }
            }
        }
        let (root, mut found) = (self.path(folder), BTreeMap::new());
        collect(&root, &root, &mut found);
        found
    }

    /// Both commands refuse these arguments: exit code 2, a message with all of `expected`, and nothing written.
    fn refuses(&self, case: &str, out: &str, expected: &[&str]) {
        let before = self.contents("");
        let mut outcomes = vec![self.run(&["run", case, "--out", out])];
        if out == "results" {
            outcomes.push(self.run(&["run", case]));
            outcomes.push(self.run(&["check", case]));
        }
        for outcome in outcomes {
            assert_eq!(outcome.code, Some(2), "{outcome:?}");
            assert_eq!(outcome.out, "", "an error belongs on the error stream");
            for text in expected.iter().chain(&["error: "]) {
                assert!(outcome.err.contains(text), "no {text:?} in\n{}", outcome.err);
            }
        }
        assert!(before == self.contents(""), "something was written: {:?}", self.contents("").keys());
    }

    /// The tables in `folder` can be read to their last row, which is whole; their numbers of rows.
    fn rows(&self, folder: &str) -> BTreeMap<&'static str, usize> {
        let rows = |name| {
            let text = self.read(&format!("{folder}/{name}"));
            assert!(text.ends_with('\n'), "the last row of {name} is cut");
            let cells = text.lines().next().unwrap().split(',').count();
            for line in text.lines().skip(1) {
                assert_eq!(line.split(',').count(), cells, "{name}: {line}");
                assert!(line.split(',').all(|cell| cell.is_empty() || cell.parse::<f64>().is_ok()), "{name}: {line}");
            }
            (name, text.lines().count() - 1)
        };
        TABLES.into_iter().map(rows).collect()
    }

    /// What the summary in `folder` says about the end of the run.
    fn status(&self, folder: &str) -> String {
        let summary: toml::Table = self.read(&format!("{folder}/summary.toml")).parse().unwrap();
        assert_eq!(summary["case"]["title"].as_str(), Some("Tiny flume"));
        summary["status"].as_str().unwrap().to_owned()
    }
}

/// How the command ended.
#[derive(Debug)]
struct Outcome {
    code: Option<i32>,
    out: String,
    err: String,
}

impl Outcome {
    fn of(output: &Output) -> Self {
        let text = |bytes: &[u8]| String::from_utf8(bytes.to_vec()).unwrap();
        let outcome = Self { code: output.status.code(), out: text(&output.stdout), err: text(&output.stderr) };
        assert!(!outcome.err.contains("panicked"), "{}", outcome.err);
        outcome
    }
}

#[test]
fn help_names_the_commands_and_the_exit_codes() {
    let lab = Lab::new(TINY);
    let help = lab.run(&["--help"]);
    assert_eq!(help.code, Some(0));
    for text in
        ["run ", "check ", "Exit codes:", "0  done", "2  the input", "3  the run", "validation/flume/40deg.toml"]
    {
        assert!(help.out.contains(text), "no {text:?} in\n{}", help.out);
    }
    assert!(lab.run(&["run", "--help"]).out.contains("--out <DIR>"));
    assert!(lab.run(&["--version"]).out.contains(env!("CARGO_PKG_VERSION")));
    for arguments in
        [&[][..], &["go"], &["run"], &["run", "case.toml", "--threads", "0"], &["run", "case.toml", "--ot", "x"]]
    {
        assert_eq!(lab.run(arguments).code, Some(2), "{arguments:?}");
    }
    assert_eq!(lab.contents("").len(), 1);
}

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
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("validation/flume/{name}.toml"));
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
    assert_eq!(outcome.code, Some(0), "{outcome:?}");
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
    assert_eq!(lab.run(&["run", "case.toml"]).code, Some(2));
    assert!(folder == lab.contents("out/case"));
}

#[test]
fn the_number_of_threads_changes_no_byte() {
    let lab = Lab::new(TINY);
    for threads in ["1", "2", "3", "8"] {
        let outcome = lab.run(&["run", "case.toml", "--out", threads, "--threads", threads]);
        assert_eq!(outcome.code, Some(0), "{outcome:?}");
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
    assert!(lab.run(&["check", "case.toml"]).err.contains("a run would fail"));
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

/// What only a system with signals, pipes and a shell can show.
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
    let reports = Path::new(env!("CARGO_MANIFEST_DIR")).join("reports/verification");
    assert!(once.keys().any(|name| name.ends_with(".svg")) && once.len() > 12, "{:?}", once.keys());
    for (name, bytes) in &once {
        let (stem, kind) = name.split_once('.').unwrap();
        let stored = reports.join(format!("{stem}.snap.{kind}"));
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

#[cfg(unix)]
mod unix {
    use super::*;
    use std::io::{BufRead, BufReader};
    use std::process::Child;
    use std::time::{Duration, Instant};

    /// Longest wait for anything here.
    const PATIENCE: Duration = Duration::from_secs(30);

    fn start(lab: &Lab) -> Child {
        let mut command = lab.command(&["run", "case.toml", "--out", "results"]);
        command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap()
    }

    fn wait_until(what: &str, done: impl Fn() -> bool) {
        let start = Instant::now();
        while !done() {
            assert!(start.elapsed() < PATIENCE, "{what} takes too long");
            std::thread::sleep(Duration::from_millis(10));
        }
    }

    /// Sends a signal and waits for the end.
    fn end(child: Child, signal: &str) -> Outcome {
        let sent = Command::new("kill").args([signal, &child.id().to_string()]).status().unwrap();
        assert!(sent.success());
        Outcome::of(&child.wait_with_output().unwrap())
    }

    #[test]
    fn a_run_that_is_interrupted_keeps_what_it_computed() {
        for signal in ["-INT", "-TERM"] {
            let lab = Lab::new(&long());
            let child = start(&lab);
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

    #[test]
    fn a_run_that_is_interrupted_before_the_release_ends_in_order() {
        let settle = "[stages.settle]\ndamping_per_s = 1\nresidual = 1.0e-12\nmax_time_s = 400\n\n[stages.run]";
        let lab = Lab::new(&changed("[stages.run]", settle));
        let child = start(&lab);
        wait_until("the folder", || lab.path("results/history.csv").exists());
        let outcome = end(child, "-INT");
        assert_eq!(outcome.code, Some(3), "{outcome:?}");
        assert!(lab.status("results").starts_with("stopped by the user"));
        assert_eq!(lab.rows("results")["history.csv"], 0);
    }

    #[test]
    fn a_reader_who_leaves_does_not_end_the_run() {
        let lab = Lab::new(TINY);
        let mut child = start(&lab);
        let mut first = String::new();
        // Both streams are closed at the other end after a line at most.
        drop(child.stdout.take());
        BufReader::new(child.stderr.take().unwrap()).read_line(&mut first).unwrap();
        assert!(first.contains("run: t "), "{first}");
        assert_eq!(child.wait().unwrap().code(), Some(0));
        assert!(lab.status("results").starts_with("completed"));

        let lab = Lab::new(&changed("young_pa = 1.0e6", "young_pa = -1"));
        let mut child = start(&lab);
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
        for text in ["error: cannot add to results/history.csv", "complete rows are in the file and readable", "ulimit"]
        {
            assert!(outcome.err.contains(text), "no {text:?} in\n{}", outcome.err);
        }
        let rows = lab.rows("results");
        assert!(rows["history.csv"] > 100 && rows["energy.csv"] > 10, "{rows:?}");
        assert!(outcome.err.contains(&format!("{} complete rows", rows["history.csv"])), "{}", outcome.err);
        let status = lab.status("results");
        assert!(status.starts_with("failed: cannot add to"), "{status}");
        assert!(lab.path("results/energy_shares.svg").exists(), "what can be drawn is drawn");
    }
}

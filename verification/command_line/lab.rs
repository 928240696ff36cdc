//! A directory in which the command is run, and a small case.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use tempfile::TempDir;

/// 128 points that run down half a metre and hit a barrier: 800 steps.
pub const TINY: &str = r#"title = "Tiny flume"

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
cone = "triaxial_compression"
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
pub const TABLES: [&str; 7] =
    ["energy.csv", "field.csv", "geometry.csv", "history.csv", "momentum.csv", "pressure_profile.csv", "stations.csv"];
pub const FIGURES: [&str; 4] = ["energy_shares.svg", "flow_snapshots.svg", "force_time.svg", "pressure_profile.svg"];

/// [`TINY`] with cells of a centimetre and sand of 60 columns, which make twelve bands: 4,800 points that several threads divide.
pub fn wide() -> String {
    let changes = [
        ("spacing_m = 0.05", "spacing_m = 0.01"),
        ("x_m = [-0.2, 0.0]", "x_m = [-0.35, 0.25]"),
        ("y_m = [0.0, 0.4]", "y_m = [0.0, 0.2]"),
        ("mass_kg = 24", "mass_kg = 36"),
        ("end_time_s = 0.4", "end_time_s = 0.05"),
        ("field_times_s = [0.0, 0.1, 0.2]", "field_times_s = [0.0, 0.02]"),
        ("vtk_interval_s = 0.05", "vtk_interval_s = 0.02"),
    ];
    changes.into_iter().fold(TINY.to_string(), |case, (replace, by)| {
        assert_eq!(case.matches(replace).count(), 1, "{replace:?}");
        case.replace(replace, by)
    })
}

/// [`TINY`] with one text replaced.
pub fn changed(replace: &str, by: &str) -> String {
    assert_eq!(TINY.matches(replace).count(), 1, "{replace:?} does not stand in the case once");
    TINY.replace(replace, by)
}

/// [`TINY`] that would run for minutes.
pub fn long() -> String {
    changed("end_time_s = 0.4", "end_time_s = 400").replace("vtk_interval_s = 0.05", "vtk_interval_s = 0")
}

/// A directory in which the command is run.
pub struct Lab {
    pub directory: TempDir,
}

impl Lab {
    pub fn new(case: &str) -> Self {
        let lab = Self { directory: tempfile::tempdir().unwrap() };
        fs::write(lab.path("case.toml"), case).unwrap();
        lab
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.directory.path().join(name)
    }

    pub fn read(&self, name: &str) -> String {
        fs::read_to_string(self.path(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
    }

    pub fn command(&self, arguments: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_checkdam"));
        command.args(arguments).current_dir(self.directory.path()).stdin(Stdio::null());
        command
    }

    pub fn run(&self, arguments: &[&str]) -> Outcome {
        Outcome::of(&self.command(arguments).output().unwrap())
    }

    /// Every file below `folder` with its bytes, by its path; folders end in a slash.
    pub fn contents(&self, folder: &str) -> BTreeMap<String, Vec<u8>> {
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
    pub fn refuses(&self, case: &str, out: &str, expected: &[&str]) {
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
    pub fn rows(&self, folder: &str) -> BTreeMap<&'static str, usize> {
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
    pub fn status(&self, folder: &str) -> String {
        let summary: toml::Table = self.read(&format!("{folder}/summary.toml")).parse().unwrap();
        assert_eq!(summary["case"]["title"].as_str(), Some("Tiny flume"));
        summary["status"].as_str().unwrap().to_owned()
    }
}

/// How the command ended.
#[derive(Debug)]
pub struct Outcome {
    pub code: Option<i32>,
    pub out: String,
    pub err: String,
}

impl Outcome {
    pub fn of(output: &Output) -> Self {
        let text = |bytes: &[u8]| String::from_utf8(bytes.to_vec()).unwrap();
        let outcome = Self { code: output.status.code(), out: text(&output.stdout), err: text(&output.stderr) };
        assert!(!outcome.err.contains("panicked"), "{}", outcome.err);
        outcome
    }
}

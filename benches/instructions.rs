//! Instructions per particle-step, counted by callgrind, against the committed `benches/instructions.csv`.
//!
//!     cargo bench --bench instructions              # compare, as continuous integration does
//!     cargo bench --bench instructions -- --write   # write the table anew
//!
//! Counts do not depend on what else the machine does, so a kernel that became slower is caught where a clock would not tell.
//! Callgrind knows AVX2 and not AVX-512, so it is the AVX2 code that is counted. Needs valgrind.

mod scenes;

use checkdam::shape::ShapeFunction;
use checkdam::simulation::{Scheme, Simulation};
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};

// What is counted has no switch for faults on purpose.
#[cfg(not(debug_assertions))]
const _: () = assert!(!checkdam::seeded::COMPILED);

/// Relative change that is let pass: the C library and the linker decide a little of the count.
const TOLERANCE: f64 = 0.02;
const POINTS: usize = 4000;
const STEPS: u64 = 20;
/// With bodies in implicit steps, which repeat the contact as often as the moment asks for: twenty steps may take half or double.
const MANY_STEPS: u64 = 800;

/// What is counted: name, scene and steps.
type Case = (&'static str, fn() -> Simulation, u64);

const CASES: &[Case] = &[
    ("column uGIMP MUSL", || scenes::column(POINTS, ShapeFunction::Ugimp, Scheme::Musl), STEPS),
    ("column uGIMP USL", || scenes::column(POINTS, ShapeFunction::Ugimp, Scheme::Usl), STEPS),
    ("column uGIMP USF", || scenes::column(POINTS, ShapeFunction::Ugimp, Scheme::Usf), STEPS),
    ("column B-spline MUSL", || scenes::column(POINTS, ShapeFunction::Bspline, Scheme::Musl), STEPS),
    ("column linear MUSL", || scenes::column(POINTS, ShapeFunction::Linear, Scheme::Musl), STEPS),
    ("sand meets barrier", || scenes::barrier(0.01, false), STEPS),
    ("sand meets implicit barrier", || scenes::barrier(0.02, true), MANY_STEPS),
];

#[derive(Debug, serde::Serialize, serde::Deserialize)]
struct Row {
    case: String,
    instructions_per_particle_step: f64,
}

/// What callgrind counts.
#[inline(never)]
fn measured(simulation: &mut Simulation, steps: u64) {
    scenes::run(simulation, steps);
}

/// In the child process, under callgrind.
fn count_me(name: &str) {
    let &(_, scene, steps) = CASES.iter().find(|c| c.0 == name).expect("a case of the table");
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a thread pool");
    pool.install(|| {
        let mut simulation = scene();
        scenes::run(&mut simulation, 3);
        measured(&mut simulation, steps);
        println!("points {}", simulation.particle_count());
    });
}

/// Runs this program on one case under callgrind.
fn count(name: &str, steps: u64, folder: &Path) -> Result<f64, String> {
    let out = folder.join("callgrind.out");
    let run = Command::new("valgrind")
        .args(["--tool=callgrind", "--collect-atstart=no", "--toggle-collect=instructions::measured"])
        .arg(format!("--callgrind-out-file={}", out.display()))
        .arg(std::env::current_exe().map_err(|e| e.to_string())?)
        .args(["--count-me", name])
        .output()
        .map_err(|e| format!("valgrind does not start ({e}); on Debian: apt-get install valgrind"))?;
    let text = String::from_utf8_lossy(&run.stdout);
    if !run.status.success() {
        return Err(format!("{name}: {}", String::from_utf8_lossy(&run.stderr)));
    }
    let points: f64 =
        text.trim().strip_prefix("points ").and_then(|p| p.parse().ok()).ok_or(format!("{name}: says `{text}`"))?;
    let profile = std::fs::read_to_string(&out).map_err(|e| format!("{}: {e}", out.display()))?;
    let total: f64 = profile
        .lines()
        .find_map(|l| l.strip_prefix("totals: ").or(l.strip_prefix("summary: ")))
        .and_then(|n| n.trim().parse().ok())
        .ok_or(format!("{}: no total", out.display()))?;
    if total == 0.0 {
        return Err(format!("{name}: callgrind counted nothing; has `measured` been inlined?"));
    }
    Ok(total / (points * steps as f64))
}

fn table() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("benches/instructions.csv")
}

fn compare(write: bool) -> Result<bool, String> {
    let folder = tempfile::tempdir().map_err(|e| e.to_string())?;
    let mut rows = Vec::new();
    for &(name, _, steps) in CASES {
        let counted = count(name, steps, folder.path())?;
        rows.push(Row { case: name.into(), instructions_per_particle_step: (10.0 * counted).round() / 10.0 });
    }
    if write {
        let mut writer = csv::Writer::from_path(table()).map_err(|e| e.to_string())?;
        for row in &rows {
            writer.serialize(row).map_err(|e| e.to_string())?;
            println!("{:28} {:8.1}", row.case, row.instructions_per_particle_step);
        }
        writer.flush().map_err(|e| e.to_string())?;
        return Ok(true);
    }
    let mut reader = csv::Reader::from_path(table()).map_err(|e| format!("{}: {e}", table().display()))?;
    let committed: Vec<Row> = reader.deserialize().collect::<Result<_, _>>().map_err(|e| e.to_string())?;
    let mut fine = committed.len() == rows.len();
    println!("{:28} {:>10} {:>10} {:>8}", "instructions per", "committed", "now", "change");
    for (old, new) in committed.iter().zip(&rows) {
        let change = new.instructions_per_particle_step / old.instructions_per_particle_step - 1.0;
        let within = old.case == new.case && change.abs() <= TOLERANCE;
        fine &= within;
        println!(
            "{:28} {:10.1} {:10.1} {:+7.2} %{}",
            new.case,
            old.instructions_per_particle_step,
            new.instructions_per_particle_step,
            100.0 * change,
            if within { "" } else { "  <- moved" }
        );
    }
    if !fine {
        println!(
            "more than {} % off; if that is meant: cargo bench --bench instructions -- --write",
            100.0 * TOLERANCE
        );
    }
    Ok(fine)
}

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    if let Some(at) = arguments.iter().position(|a| a == "--count-me") {
        count_me(&arguments[at + 1]);
        return ExitCode::SUCCESS;
    }
    match compare(arguments.iter().any(|a| a == "--write")) {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::FAILURE,
        Err(message) => {
            eprintln!("{message}");
            ExitCode::FAILURE
        }
    }
}

//! The command line: thin.

mod check;
mod compare;
mod console;
mod folder;
mod help;
mod memory;
mod new;
mod progress;
mod report;
mod run;
mod study;
mod suite;
mod validate;
mod verify;

use clap::{Parser, Subcommand};
use console::{say, tell};
use std::path::PathBuf;
use std::process::ExitCode;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

// What is shipped has no switch for faults on purpose.
#[cfg(not(debug_assertions))]
const _: () = assert!(!checkdam::seeded::COMPILED);

/// Exit code when a check failed, or a comparison found a difference above its tolerance.
const CHECK_FAILED: u8 = 1;
/// Exit code when the input is at fault, and nothing was computed.
const BAD_INPUT: u8 = 2;
/// Exit code when a run failed or was stopped (what was computed is in its folder), when a check finds that it would fail, or when the
/// output could not be written.
const ENDED_EARLY: u8 = 3;
/// Exit code when a run is done and its numbers are not to be trusted.
const NOT_TRUSTED: u8 = 4;

/// Force of dry granular flow on barriers, by the material point method.
///
/// A case file (TOML) says what to run; a run leaves tables (CSV), ParaView files (VTK) and figures (SVG) in a folder.
#[derive(Debug, Parser)]
#[command(
    version,
    max_term_width = 110,
    after_help = "\
Start here:
  checkdam new   sand.toml                       a case with comments, to change
  checkdam check validation/flume/40deg.toml     what would run, and how long it would take
  checkdam run   validation/flume/40deg.toml     run it into out/40deg
  checkdam verify                                are the equations solved right? every rung against its closed form
  checkdam validate                              are they the right equations? the experiments beside our numbers
  checkdam study validation/flume/studies/baseline.toml   the same case with other cells, one table
The comments in validation/flume/40deg.toml explain every field of a case file.

Exit codes:
  0  done
  1  a check of the verification ladder or of a validation failed, or a comparison found a difference
  2  the input is at fault; nothing was written
  3  the run failed, was stopped or, on check, would fail; or the output could not be written
  4  the run is done and not to be trusted: summary.toml begins with the reasons"
)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Run a case and write its results.
    ///
    /// The folder holds summary.toml (start there), history.csv, energy.csv, momentum.csv, pressure_profile.csv and more,
    /// flow.pvd for ParaView, and figures. Ctrl-C ends the run in order: everything computed until then is kept.
    Run {
        /// The case file.
        #[arg(value_name = "CASE.toml")]
        case: PathBuf,
        /// Folder for the results; must be new or empty [default: out/<name of the case file>]
        #[arg(long, value_name = "DIR")]
        out: Option<PathBuf>,
        /// Replace what an earlier run left in the folder, if it is not running any more; other files there stay as they are
        #[arg(long)]
        force: bool,
        /// Threads; any number gives the same results to the last bit [default: all processors]
        #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
        threads: Option<u16>,
    },
    /// Validate a case and say what would run, without running it.
    Check {
        /// The case file.
        #[arg(value_name = "CASE.toml")]
        case: PathBuf,
        /// Threads to estimate the time for [default: all processors]
        #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
        threads: Option<u16>,
    },
    /// Run a study: many runs of the same cases with other values, ending in one table.
    ///
    /// The study file (TOML) names the cases and what varies: every combination of some values, one change at a time, or a
    /// sample of ranges. The folder holds runs.csv, a row per run, and the figure if one is asked for. A study that was
    /// stopped goes on where it was when the command is given again. Studies of the project are known by the names of their
    /// validations, such as barrier-rigidity: runs, tables and figures come with one command.
    Study {
        /// The study file, or the name of a study of the project.
        #[arg(value_name = "STUDY.toml")]
        study: PathBuf,
        /// Folder for the results [default: out/<name of the study file>]
        #[arg(long, value_name = "DIR")]
        out: Option<PathBuf>,
        /// Check the study and the case of every run, and say what would run, without running it
        #[arg(long, group = "task")]
        check: bool,
        /// Print a command for each run, one a line, for whatever makes them; the folder gets the manifest of the runs
        #[arg(long, group = "task")]
        list: bool,
        /// Make one run, by its number from 1 or by its key, and keep its result in the folder; others may make others meanwhile
        #[arg(long, value_name = "K", group = "task")]
        run: Option<String>,
        /// Make table and figure of the results that are there, and name those that are missing
        #[arg(long, group = "task")]
        collect: bool,
        /// Runs at a time; any number gives the same table [default: all processors]
        #[arg(long, value_name = "N", conflicts_with_all = ["list", "run", "collect"], value_parser = clap::value_parser!(u16).range(1..=1024))]
        threads: Option<u16>,
    },
    /// Write a case to begin with: sand in a flume against a wall, with a comment for every field.
    New {
        /// The file to write; it must not exist.
        #[arg(value_name = "FILE.toml", default_value = "case.toml")]
        file: PathBuf,
    },
    /// Make one page (HTML) of a run or a study, that opens in any browser without a network.
    ///
    /// It has the verdict, a design sheet for each barrier with the file and the name of every number, histories to zoom and read, the
    /// flow to play and scrub, ledgers, figures, all inputs and the digests of the files. It prints to a clean PDF.
    Report {
        /// Folder of a run or of a study.
        #[arg(value_name = "DIR")]
        folder: PathBuf,
        /// The file to write; an earlier report of that name is replaced [default: report.html in the folder]
        #[arg(long, value_name = "FILE")]
        out: Option<PathBuf>,
    },
    /// Compare two runs, or two studies: relative differences side by side.
    ///
    /// Reads summary.toml and the tables over time of two runs, or runs.csv of two studies, row by row. Numbers of a run are compared
    /// relative to A, columns by their largest difference over the range of the column, on the times that both have. What
    /// only one side has, and what is no number, counts as different; so does zero against anything else. Residuals are
    /// relative to what they are left of. VTK frames are not compared. Exit code 1 says that something is above the tolerance.
    Compare {
        /// Folder of a run or of a study; differences are relative to it.
        #[arg(value_name = "A")]
        a: PathBuf,
        /// The other folder.
        #[arg(value_name = "B")]
        b: PathBuf,
        /// Relative difference that is allowed, from 0 to below 1; the same case gives the same bits
        #[arg(long, value_name = "R", default_value = "0", value_parser = compare::tolerance)]
        tolerance: f64,
        /// Quantities to compare [default: all], by the names that are printed or their last parts
        #[arg(long, value_name = "NAMES", value_delimiter = ',')]
        quantities: Vec<String>,
        /// Draw the force on the first barrier of both over time (SVG)
        #[arg(long, value_name = "FILE")]
        figure: Option<PathBuf>,
    },
    /// Run the verification ladder: print what was measured beside what should come out, write tables and figures.
    Verify {
        /// Rungs to run [default: all]
        #[arg(value_name = "RUNG")]
        rungs: Vec<String>,
        /// Folder for tables and figures; files of the same name are replaced
        #[arg(long, value_name = "DIR", default_value = "out/verification")]
        out: PathBuf,
    },
    /// Run the validations: the experiments beside our numbers, with both uncertainties; write tables and figures.
    Validate {
        /// Validations to run [default: all], or the folder of one experiment: study.toml, case files, published.csv
        #[arg(value_name = "NAME")]
        names: Vec<String>,
        /// Make the runs of studies anew instead of reading their record; goes on where it was stopped
        #[arg(long)]
        studies: bool,
        /// Folder for tables and figures; files of the same name are replaced
        #[arg(long, value_name = "DIR", default_value = "out/validation")]
        out: PathBuf,
    },
    /// Print what a shell reads to complete commands: `checkdam completions bash > ~/.local/share/bash-completion/completions/checkdam`
    Completions {
        /// The shell.
        #[arg(value_name = "SHELL")]
        shell: clap_complete::Shell,
    },
    /// Print the manual page: `checkdam man | man -l -`
    Man {
        /// The command to print the page of [default: the program]
        #[arg(value_name = "COMMAND")]
        command: Option<String>,
    },
}

/// Parses the command line and does what it says.
pub fn main() -> ExitCode {
    let code = match Cli::parse().command {
        Command::Run { case, out, force, threads } => run::run(&case, out, threads, force),
        Command::Check { case, threads } => check::check(&case, threads),
        Command::New { file } => new::new(&file),
        Command::Report { folder, out } => report::report(&folder, out),
        Command::Completions { shell } => help::completions(shell),
        Command::Man { command } => help::man(command.as_deref()),
        Command::Compare { a, b, tolerance, quantities, figure } => {
            compare::compare([&a, &b], tolerance, &quantities, figure.as_deref())
        }
        Command::Study { study, out, check, list, run, collect, threads } => {
            let task = match (run, check, list, collect) {
                (Some(which), ..) => study::Task::One(which),
                (None, true, ..) => study::Task::Check,
                (None, _, true, _) => study::Task::List,
                (None, _, _, true) => study::Task::Collect,
                _ => study::Task::All(threads),
            };
            study::study(&study, out, &task)
        }
        Command::Verify { rungs, out } => verify::verify(&rungs, &out),
        Command::Validate { names, studies, out } => validate::validate(&names, studies, &out),
    };
    match console::failure() {
        Some(error) if code == ExitCode::SUCCESS => {
            tell!("error: the output could not be written: {error}");
            ExitCode::from(ENDED_EARLY)
        }
        _ => code,
    }
}

/// Loads a case; prints warnings, or the error.
fn load(path: &std::path::Path) -> Result<checkdam::case::Case, ExitCode> {
    match checkdam::case::load(path) {
        Ok(loaded) => {
            for warning in &loaded.warnings {
                tell!("{}\n", warning.trim_end());
            }
            if let Some(missing) = memory::missing(&loaded.case) {
                tell!("error: {missing}");
                return Err(ExitCode::from(BAD_INPUT));
            }
            Ok(loaded.case)
        }
        Err(error) => {
            tell!("{}", error.to_string().trim_end());
            Err(ExitCode::from(BAD_INPUT))
        }
    }
}

/// Signals that come closer together are one: `timeout -s INT` sends two within milliseconds, to the process and to its group.
const TOGETHER: Duration = Duration::from_millis(500);

/// A flag that Ctrl-C sets, with these words; a second Ctrl-C, half a second later or more, ends the process at once.
fn stop_on_ctrl_c(words: &'static str) -> Arc<AtomicBool> {
    let stop = Arc::new(AtomicBool::new(false));
    let flag = Arc::clone(&stop);
    let mut first = None;
    let handler = ctrlc::set_handler(move || match first {
        None => {
            first = Some(Instant::now());
            flag.store(true, Ordering::SeqCst);
            tell!("\n{words}");
        }
        Some(first) if first.elapsed() < TOGETHER => {}
        Some(_) => std::process::exit(130),
    });
    if let Err(error) = handler {
        tell!("warning: Ctrl-C will not end this in order ({error})");
    }
    stop
}

/// Sets the number of threads for everything that follows.
fn use_threads(threads: Option<u16>) {
    if let Some(n) = threads {
        // Fails only if a pool was made before, which nothing does.
        let _ = rayon::ThreadPoolBuilder::new().num_threads(usize::from(n)).build_global();
    }
}

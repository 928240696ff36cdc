//! `checkdam verify`.

use super::console::{say, tell};
use super::{BAD_INPUT, CHECK_FAILED};
use checkdam::verification::{Fault, RUNGS, Rung, report};
use std::path::Path;
use std::process::ExitCode;
use std::time::Instant;

pub fn verify(names: &[String], out: &Path) -> ExitCode {
    let mut rungs: Vec<&Rung> = Vec::new();
    for name in names {
        match RUNGS.iter().find(|r| r.name == name) {
            Some(rung) => rungs.push(rung),
            None => {
                let known: Vec<_> = RUNGS.iter().map(|r| r.name).collect();
                tell!("error: there is no rung `{name}`; the rungs are: {}", known.join(", "));
                return ExitCode::from(BAD_INPUT);
            }
        }
    }
    if names.is_empty() {
        rungs.extend(RUNGS);
    }
    let mut failed = Vec::new();
    for (k, rung) in rungs.iter().enumerate() {
        tell!("[{}/{}] {}: {}", k + 1, rungs.len(), rung.name, rung.title);
        let start = Instant::now();
        let outcome = match (rung.run)(&Fault::NONE) {
            Ok(outcome) => outcome,
            Err(error) => {
                say!("{}: FAILS, it did not run to its end: {error}\n", rung.name);
                failed.push(rung.name);
                continue;
            }
        };
        let verdict = outcome.verdict(rung.name, out);
        say!("{verdict}");
        if !verdict.passes() {
            failed.push(rung.name);
        }
        match report::write(rung.name, &outcome, out) {
            Ok(files) => {
                tell!("      {:.1} s; {} files in {}", start.elapsed().as_secs_f64(), files.len(), out.display())
            }
            Err(error) => {
                tell!("error: {error}");
                return ExitCode::from(BAD_INPUT);
            }
        }
    }
    if failed.is_empty() {
        say!("all {} rungs pass", rungs.len());
        ExitCode::SUCCESS
    } else {
        say!("{} of {} rungs fail: {}", failed.len(), rungs.len(), failed.join(", "));
        ExitCode::from(CHECK_FAILED)
    }
}

//! What `verify` and `validate` share: run by name, print what was measured beside what should come out, write, count failures.

use super::console::{say, tell};
use super::{BAD_INPUT, CHECK_FAILED, ENDED_EARLY};
use checkdam::output::{LOCK, Lock};
use checkdam::plot::PlotError;
use checkdam_verification::Outcome;
use std::path::Path;
use std::process::ExitCode;
use std::time::Instant;

/// A list of things to run.
pub struct Suite<T: 'static> {
    /// What one of them is called, and several.
    pub called: [&'static str; 2],
    /// All of them.
    pub all: &'static [T],
    /// Name and title of one.
    pub head: fn(&T) -> [&'static str; 2],
    /// Writes tables and figures of one; the names of the files.
    pub write: fn(&T, &Outcome, &Path) -> Result<Vec<String>, PlotError>,
}

/// Why one has no outcome.
pub enum Ended {
    /// The user stopped it; with these words.
    Stopped(String),
    /// It did not run to its end.
    Failed(String),
}

impl<T> Suite<T> {
    /// Runs those of these names, or all; what they leave goes to `out`.
    pub fn run(&self, names: &[String], out: &Path, one: &mut dyn FnMut(&T) -> Result<Outcome, Ended>) -> ExitCode {
        let ([called, several], head) = (self.called, self.head);
        let mut chosen: Vec<&T> = Vec::new();
        for name in names {
            match self.all.iter().find(|t| head(t)[0] == name) {
                Some(found) => chosen.push(found),
                None => {
                    let known: Vec<_> = self.all.iter().map(|t| head(t)[0]).collect();
                    tell!("error: there is no {called} `{name}`; there are: {}", known.join(", "));
                    return ExitCode::from(BAD_INPUT);
                }
            }
        }
        if names.is_empty() {
            chosen.extend(self.all);
        }
        // Hours of runs must not end at a folder that is missing.
        if let Err(error) = std::fs::create_dir_all(out) {
            tell!("error: cannot create {}: {error}; choose another --out", out.display());
            return ExitCode::from(BAD_INPUT);
        }
        let _lock = match Lock::alone(out.join(LOCK)) {
            Ok(lock) => lock,
            Err(error) => {
                tell!("error: {error}");
                return ExitCode::from(BAD_INPUT);
            }
        };
        let mut failed = Vec::new();
        for (k, item) in chosen.iter().enumerate() {
            let [name, title] = head(item);
            tell!("[{}/{}] {name}: {title}", k + 1, chosen.len());
            let start = Instant::now();
            let outcome = match one(item) {
                Ok(outcome) => outcome,
                Err(Ended::Stopped(words)) => {
                    tell!("{words}");
                    return ExitCode::from(ENDED_EARLY);
                }
                Err(Ended::Failed(error)) => {
                    say!("{name}: FAILS, it did not run to its end: {error}\n");
                    failed.push(name);
                    continue;
                }
            };
            let verdict = outcome.verdict(name, out);
            say!("{verdict}");
            if !verdict.passes() {
                failed.push(name);
            }
            match (self.write)(item, &outcome, out) {
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
            say!("all {} {several} pass", chosen.len());
            ExitCode::SUCCESS
        } else {
            say!("{} of {} {several} fail: {}", failed.len(), chosen.len(), failed.join(", "));
            ExitCode::from(CHECK_FAILED)
        }
    }
}

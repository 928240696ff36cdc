//! `checkdam validate`.

use super::progress::Words;
use super::{BAD_INPUT, CHECK_FAILED, ENDED_EARLY, say, stop_on_ctrl_c, tell};
use checkdam::validation::{Context, Failure, VALIDATIONS, Validation, write};
use checkdam::verification::Fault;
use std::path::Path;
use std::process::ExitCode;
use std::sync::atomic::Ordering;
use std::time::Instant;

pub fn validate(names: &[String], studies: bool, out: &Path) -> ExitCode {
    let mut chosen: Vec<&Validation> = Vec::new();
    for name in names {
        match VALIDATIONS.iter().find(|v| v.name == name) {
            Some(validation) => chosen.push(validation),
            None => {
                let known: Vec<_> = VALIDATIONS.iter().map(|v| v.name).collect();
                tell!("error: there is no validation `{name}`; there are: {}", known.join(", "));
                return ExitCode::from(BAD_INPUT);
            }
        }
    }
    if names.is_empty() {
        chosen.extend(VALIDATIONS);
    }
    let stop = stop_on_ctrl_c("stopping: studies keep the runs that have ended (Ctrl-C again to quit at once)");
    let mut failed = Vec::new();
    for (k, validation) in chosen.iter().enumerate() {
        tell!("[{}/{}] {}: {}", k + 1, chosen.len(), validation.name, validation.title);
        if !validation.study.is_empty() {
            let how = if studies { "made anew" } else { "read from the record; --studies makes them anew" };
            tell!("      {}: {how}", validation.study);
        }
        let start = Instant::now();
        let mut words = Words::new();
        let mut progress = |text: &str| {
            words.show(text);
            !stop.load(Ordering::SeqCst)
        };
        let mut context = Context { fault: Fault::NONE, folder: out, studies, progress: &mut progress };
        let outcome = (validation.run)(&mut context);
        words.clear();
        let outcome = match outcome {
            Ok(outcome) => outcome,
            Err(Failure::Stopped) => {
                tell!("{}", Failure::Stopped);
                return ExitCode::from(ENDED_EARLY);
            }
            Err(error) => {
                say!("{}: FAILS, it did not run to its end: {error}\n", validation.name);
                failed.push(validation.name);
                continue;
            }
        };
        let verdict = outcome.verdict(validation.name, out);
        say!("{verdict}");
        if !verdict.passes() {
            failed.push(validation.name);
        }
        match write(validation, &outcome, out) {
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
        say!("all {} validations pass", chosen.len());
        ExitCode::SUCCESS
    } else {
        say!("{} of {} validations fail: {}", failed.len(), chosen.len(), failed.join(", "));
        ExitCode::from(CHECK_FAILED)
    }
}

//! `checkdam validate`: validations by their names, or an experiment by its folder.

use super::console::{say, tell};
use super::progress::Words;
use super::suite::{Ended, Suite};
use super::{BAD_INPUT, CHECK_FAILED, ENDED_EARLY, stop_on_ctrl_c};
use checkdam_validation::experiment::Experiment;
use checkdam_validation::{Context, Failure, VALIDATIONS, Validation, write};
use checkdam_verification::Fault;
use std::path::Path;
use std::process::ExitCode;
use std::sync::atomic::Ordering;

const SUITE: Suite<Validation> = Suite {
    called: ["validation", "validations"],
    all: VALIDATIONS,
    head: |validation| [validation.name, validation.title],
    write,
};

pub fn validate(names: &[String], studies: bool, out: &Path) -> ExitCode {
    if let [folder] = names
        && Path::new(folder).is_dir()
    {
        return experiment(Path::new(folder), out);
    }
    let stop = stop_on_ctrl_c("stopping: studies keep the runs that have ended (Ctrl-C again to quit at once)");
    SUITE.run(names, out, &mut |validation| {
        if !validation.study.is_empty() {
            let how = if studies { "made anew" } else { "read from the record; --studies makes them anew" };
            tell!("      {}: {how}", validation.study);
        }
        let mut words = Words::new();
        let mut progress = |text: &str| {
            words.show(text);
            !stop.load(Ordering::SeqCst)
        };
        let mut context = Context { fault: Fault::NONE, folder: out, studies, progress: &mut progress };
        let outcome = (validation.run)(&mut context);
        words.clear();
        outcome.map_err(|error| match error {
            Failure::Stopped => Ended::Stopped(Failure::Stopped.to_string()),
            error => Ended::Failed(error.to_string()),
        })
    })
}

/// An experiment that is a folder of data.
fn experiment(folder: &Path, out: &Path) -> ExitCode {
    let experiment = match Experiment::load(folder) {
        Ok(experiment) => experiment,
        Err(error) => {
            tell!("{}", error.to_string().trim_end());
            return ExitCode::from(BAD_INPUT);
        }
    };
    tell!("{}: {}; {} runs", experiment.name, experiment.title, experiment.runs());
    let stop = stop_on_ctrl_c("stopping (Ctrl-C again to quit at once)");
    let mut words = Words::new();
    let outcome = experiment.run(out, &mut |text| {
        words.show(text);
        !stop.load(Ordering::SeqCst)
    });
    words.clear();
    let outcome = match outcome {
        Ok(outcome) => outcome,
        Err(error) => {
            tell!("error: {error}");
            return ExitCode::from(ENDED_EARLY);
        }
    };
    let verdict = outcome.verdict(&experiment.name, out);
    say!("{verdict}");
    match experiment.write(&outcome, out) {
        Ok(files) => tell!("      {} files in {}; start with {}_page.md", files.len(), out.display(), experiment.name),
        Err(error) => {
            tell!("error: {error}");
            return ExitCode::from(BAD_INPUT);
        }
    }
    if verdict.passes() { ExitCode::SUCCESS } else { ExitCode::from(CHECK_FAILED) }
}

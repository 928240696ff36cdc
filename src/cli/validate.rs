//! `checkdam validate`.

use super::console::tell;
use super::progress::Words;
use super::stop_on_ctrl_c;
use super::suite::{Ended, Suite};
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

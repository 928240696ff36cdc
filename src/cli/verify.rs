//! `checkdam verify`.

use super::suite::{Ended, Suite};
use checkdam_verification::{Fault, RUNGS, Rung, report};
use std::path::Path;
use std::process::ExitCode;

const LADDER: Suite<Rung> = Suite {
    called: ["rung", "rungs"],
    all: RUNGS,
    head: |rung| [rung.name, rung.title],
    write: |rung, outcome, out| report::write(rung.name, outcome, out),
};

pub fn verify(names: &[String], out: &Path) -> ExitCode {
    LADDER.run(names, out, &mut |rung| (rung.run)(&Fault::NONE).map_err(|e| Ended::Failed(e.to_string())))
}

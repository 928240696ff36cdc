//! `checkdam new`: a case to begin with.

use super::console::{say, tell};
use super::{BAD_INPUT, ENDED_EARLY};
use std::fs::OpenOptions;
use std::io::{ErrorKind, Write};
use std::path::Path;
use std::process::ExitCode;

/// The case: `check` accepts it, and it runs in seconds.
const CASE: &str = include_str!("new_case.toml");

/// Writes the case to a file that does not exist yet.
pub fn new(path: &Path) -> ExitCode {
    let shown = path.display();
    let mut file = match OpenOptions::new().write(true).create_new(true).open(path) {
        Ok(file) => file,
        Err(error) if error.kind() == ErrorKind::AlreadyExists => {
            tell!(
                "error: {shown} exists, and nothing is overwritten\n  = fix: give another name: checkdam new NAME.toml"
            );
            return ExitCode::from(BAD_INPUT);
        }
        Err(error) => {
            tell!("error: cannot create {shown}: {error}\n  = fix: name a file in a folder that exists");
            return ExitCode::from(BAD_INPUT);
        }
    };
    let text = CASE.replace("FILE", &shown.to_string());
    if let Err(error) = file.write_all(text.as_bytes()).and_then(|()| file.sync_all()) {
        tell!("error: cannot write {shown}: {error}");
        let _ = std::fs::remove_file(path);
        return ExitCode::from(ENDED_EARLY);
    }
    say!("{shown}: a case with comments; checkdam check {shown} says what would run");
    ExitCode::SUCCESS
}

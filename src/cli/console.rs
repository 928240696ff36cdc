//! Text for the terminal. Whoever reads it may leave before the run ends (`checkdam run ... | head`); that is no reason to
//! lose the run, so a message that nobody takes is dropped. What could not be written for another reason is remembered, for the
//! exit code. Names of files and of what is in them reach the terminal without control characters.

use std::fmt::Arguments;
use std::io::{ErrorKind, Write, stderr, stdout};
use std::sync::{Mutex, PoisonError};

/// Why a line of results could not be written.
static FAILURE: Mutex<Option<String>> = Mutex::new(None);

/// Writes a line to the standard output; see [`say!`](crate::say).
pub fn out(line: Arguments) {
    raw(format!("{}\n", plain(line)).as_bytes());
}

/// Writes bytes to the standard output as they are: what another program reads.
pub fn raw(bytes: &[u8]) {
    let mut out = stdout();
    if let Err(error) = out.write_all(bytes).and_then(|()| out.flush())
        && error.kind() != ErrorKind::BrokenPipe
    {
        FAILURE.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert(error.to_string());
    }
}

/// Writes a line to the standard error stream; see [`tell!`](crate::tell).
pub fn err(line: Arguments) {
    let _ = writeln!(stderr(), "{}", plain(line));
}

/// Why the first line of results that is lost was lost, other than that nobody read on.
pub fn failure() -> Option<String> {
    FAILURE.lock().unwrap_or_else(PoisonError::into_inner).clone()
}

/// Text without control characters but ends of lines: they could do anything to a terminal.
pub fn plain(line: Arguments) -> String {
    line.to_string().chars().map(|c| if c.is_control() && c != '\n' { ' ' } else { c }).collect()
}

/// A line of results, formatted as by `println!`.
macro_rules! say {
    ($($argument:tt)*) => { $crate::console::out(format_args!($($argument)*)) };
}

/// A line about what goes on or wrong, formatted as by `eprintln!`.
macro_rules! tell {
    ($($argument:tt)*) => { $crate::console::err(format_args!($($argument)*)) };
}

pub(crate) use {say, tell};

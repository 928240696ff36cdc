//! Text for the terminal. Whoever reads it may leave before the run ends (`checkdam run ... | head`); that is no reason to
//! lose the run, so a message that nobody takes is dropped.

use std::fmt::Arguments;
use std::io::{Write, stderr, stdout};

/// Writes a line to the standard output; see [`say!`](crate::say).
pub fn out(line: Arguments) {
    let _ = writeln!(stdout(), "{line}");
}

/// Writes a line to the standard error stream; see [`tell!`](crate::tell).
pub fn err(line: Arguments) {
    let _ = writeln!(stderr(), "{line}");
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

//! The one error type of the file writers and the table reader.

use std::io;
use std::path::PathBuf;

use thiserror::Error;

/// What went wrong with an output file. Every message names the file and says what to do.
#[derive(Debug, Error)]
pub enum OutputError {
    /// The file could not be created.
    #[error("cannot create {path}: {source}; {}", advice(source))]
    Create {
        /// The file wanted.
        path: PathBuf,
        /// What the operating system said.
        source: io::Error,
    },
    /// Writing a file that appears only when complete failed; an earlier version of it, if any, is untouched.
    #[error("cannot write {path}: {source}; {}; an earlier version of the file is unchanged", advice(source))]
    Write {
        /// The file wanted.
        path: PathBuf,
        /// What the operating system said.
        source: io::Error,
    },
    /// Another process works there.
    #[error("{} is in use by {holder}; wait until that ends, or choose another folder with --out", folder(path).display())]
    InUse {
        /// The lock file.
        path: PathBuf,
        /// Who has it.
        holder: String,
    },
    /// A folder is not empty, and not one of a study.
    #[error(
        "{path} is not empty and holds no study; nothing of others is mixed with or overwritten: choose another folder with --out"
    )]
    Foreign {
        /// The folder.
        path: PathBuf,
    },
    /// A folder is no longer where it was.
    #[error("{path} was deleted or moved while results were written into it; nothing is written any more")]
    Gone {
        /// The folder.
        path: PathBuf,
    },
    /// Adding rows to a table failed part of the way.
    #[error(
        "cannot add to {path}: {source}; {rows} complete rows are in the file and readable, {pending} more are held back; {}",
        advice(source)
    )]
    Append {
        /// The table.
        path: PathBuf,
        /// Complete rows in the file.
        rows: u64,
        /// Rows accepted earlier that are not in the file.
        pending: u64,
        /// What the operating system said.
        source: io::Error,
    },
    /// A row does not have one value per column.
    #[error("{path}: a row of {found} values was given to a table of {expected} columns")]
    RowLength {
        /// The table.
        path: PathBuf,
        /// Number of columns.
        expected: usize,
        /// Number of values given.
        found: usize,
    },
    /// A name that cannot stand in the file.
    #[error("{path}: {name:?} cannot be used as a name: {reason}")]
    Name {
        /// The file.
        path: PathBuf,
        /// The name refused.
        name: String,
        /// Why.
        reason: &'static str,
    },
    /// A file could not be opened for reading.
    #[error("cannot read {path}: {source}; {}", advice(source))]
    Open {
        /// The file wanted.
        path: PathBuf,
        /// What the operating system said.
        source: io::Error,
    },
    /// A table is not well-formed CSV.
    #[error("{path}, line {line}: {reason}; repair or delete that line")]
    Malformed {
        /// The table.
        path: PathBuf,
        /// Line in the file, the header being line 1.
        line: u64,
        /// What is wrong with it.
        reason: String,
    },
    /// A column that is not there was asked for.
    #[error("{path} has no column {column:?}; it has: {available}")]
    MissingColumn {
        /// The table.
        path: PathBuf,
        /// The column wanted.
        column: String,
        /// The columns there, comma-separated.
        available: String,
    },
    /// A cell of a column asked for is not a number.
    #[error("{path}, line {line}, column {column:?}: {text:?} is not a number")]
    NotANumber {
        /// The table.
        path: PathBuf,
        /// The column asked for.
        column: String,
        /// Line in the file, the header being line 1.
        line: u64,
        /// What the cell holds.
        text: String,
    },
}

/// The folder that a lock file locks.
fn folder(lock: &std::path::Path) -> &std::path::Path {
    lock.parent().unwrap_or(lock)
}

/// What a user can do about an input/output failure.
fn advice(source: &io::Error) -> &'static str {
    match source.kind() {
        io::ErrorKind::StorageFull | io::ErrorKind::QuotaExceeded => {
            "the disk is full: free some space or choose another output directory"
        }
        io::ErrorKind::FileTooLarge => "the file reached the largest size allowed: raise the limit (ulimit -f)",
        io::ErrorKind::NotFound => "check that the path exists",
        io::ErrorKind::PermissionDenied | io::ErrorKind::ReadOnlyFilesystem => {
            "check the permissions of the file and its directory"
        }
        _ => "check the path and the disk",
    }
}

//! Asks the tests of a binary about faults: runs that binary once more, with a fault at work, and reads what it says. For the unit tests
//! of the library and for the ladder, which are binaries of their own; so it imports nothing of either.

#[path = "child.rs"]
mod child;

pub use child::LIMIT;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::{Duration, Instant};

/// Who is asked in `cargo test` about each fault, and who else sees it. Written by `seeded::written_down` of the ladder.
pub const TABLE: &str = "reports/verification/seeded.csv";

/// A line of the table.
#[derive(Debug, Clone, PartialEq)]
pub struct Row {
    /// Name of the fault.
    pub fault: String,
    /// `rung`, `exact` or `unit`; `nobody` where nothing sees it.
    pub judge: String,
    /// The rung or the test that is asked: the quickest of those that saw it when the row was last written.
    pub by: String,
}

/// The table of this checkout, whose root is `root`.
pub fn table(root: &Path) -> Vec<Row> {
    let text = std::fs::read_to_string(root.join(TABLE)).expect("the table of seeded faults");
    let row = |line: &str| {
        let mut cells = line.split(',').map(String::from);
        let mut next = || cells.next().expect("a cell");
        Row { fault: next(), judge: next(), by: next() }
    };
    text.lines().skip(1).map(row).collect()
}

/// What a binary said, and how long it took (s).
#[derive(Debug, Clone)]
pub struct Answer {
    pub text: String,
    pub seconds: f64,
}

/// Runs this binary with a fault at work, see `child`.
pub fn under(fault: &str, variables: &[(&str, &str)], arguments: &[&str], limit: Duration) -> Answer {
    let start = Instant::now();
    let text = child::under(fault, variables, arguments, limit);
    Answer { text, seconds: start.elapsed().as_secs_f64() }
}

/// Does something with each of a list, two at a time; results in the order of the list.
pub fn two_at_a_time<T: Sync, R: Send>(list: &[T], each: impl Fn(&T) -> R + Sync) -> Vec<R> {
    let next = AtomicUsize::new(0);
    let work = || {
        let mut done = Vec::new();
        while let Some((k, item)) = Some(next.fetch_add(1, Ordering::Relaxed)).and_then(|k| Some((k, list.get(k)?))) {
            done.push((k, each(item)));
        }
        done
    };
    let mut done = std::thread::scope(|scope| {
        let other = scope.spawn(work);
        let mut own = work();
        own.extend(other.join().expect("the other half"));
        own
    });
    done.sort_by_key(|d| d.0);
    done.into_iter().map(|d| d.1).collect()
}

/// Where answers are collected for the table, one a line: `fault,judge,by,seconds`; `fault,not,by,` of who does not see it; `fault,anew,,`
/// before all unit tests that do. Later lines replace earlier ones.
pub fn notes(root: &Path) -> PathBuf {
    root.join("target/seeded.csv")
}

/// Adds answers.
pub fn note(root: &Path, lines: &str) {
    let mut file = std::fs::OpenOptions::new().create(true).append(true).open(notes(root)).expect("a file of notes");
    file.write_all(lines.as_bytes()).expect("a line");
}

/// Those of a list that an environment variable names, by a part of their names and commas between them; without it, all.
pub fn chosen<'a>(variable: &str, all: impl Iterator<Item = &'a str>) -> Vec<&'a str> {
    let only = std::env::var(variable).unwrap_or_default();
    all.filter(|name| only.is_empty() || only.split(',').any(|part| name.contains(part))).collect()
}

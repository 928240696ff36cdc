//! The case file: its format, its checks, and reports that point at the line at fault.
//!
//! [`load`] reads a file, [`parse`] a text. Both return a [`LoadedCase`] whose defaults are filled in, or a [`CaseError`]
//! whose `Display` is the complete report for the user.
//!
//! **Words and rules.** A choice that is a word alone (cone, shape function, scheme) is the solver's enum, read as it is. One that needs
//! numbers is spelt twice: as a word here, as [`ContactKind`], and as a variant with its numbers in the solver, as
//! [`Friction`](crate::boundary::Friction). For in the file a number stands beside the word, under a key of its own that ends in its unit.
//! So a number that is missing, out of range or beside the wrong word is refused by that key, with its line and a way out, and a study varies it as
//! `boundaries.base.friction`. Read straight from the file, the solver's enum would be a table, `contact = { coulomb = 0.4 }`, and a mistake in it "no
//! variant". The two meet in one place each: [`Boundary::contact_law`], `opening_law`, [`BodyContact::normal_rule`] and
//! [`BodyContact::gap_rule`].
//!
//! Elsewhere: the input file (input deck).

mod angle;
mod boundary;
mod contact;
mod drawing;
mod entering;
mod gauges;
mod geometry;
mod grid;
mod inflow;
mod material;
mod parse;
mod path;
mod points;
mod polygon;
mod report;
mod schema;
mod structure;
mod suggest;
#[cfg(test)]
mod tests;
mod validate;

use std::fs::File;
use std::io::{self, Read};
use std::path::Path;

use serde::de::DeserializeOwned;
use thiserror::Error;

pub use angle::direction;
pub use boundary::{Boundary, BoundaryKind, ContactKind, MaterialSide, OpeningKind, Shape, Wall};
pub use contact::{BodyContact, GapKind, NormalKind};
pub use drawing::{Drawing, Rectangle, Ring};
pub use gauges::{Gauges, Window};
pub use grid::{Domain, Filling, Grid};
pub use inflow::{Inflow, Profile, Towards};
pub use material::{Frictional, Law, Material};
pub use path::{KeyPath, PathSegment};
pub use schema::{
    Body, Case, Gravity, Integration, Kinematics, Lattice, MAX_GRID_CELLS, MAX_PARTICLES, MAX_TIME_STEPS, Numerics,
    Output, Run, Settle, SettleScale, SideWalls, Stages, Tilt, nearest_whole,
};
#[cfg(test)]
pub(crate) use validate::AGENTS;
pub use validate::{Findings, Problem, too_few_cells, validate};

use parse::Format;
use report::{Diagnostic, Level, Source, printable};
pub(crate) use suggest::did_you_mean;

/// So many problems are told of one file, each with its line.
const MOST_REPORTS: usize = 50;
/// Longer files are not case files, bytes.
const LONGEST_FILE: u64 = 4 << 20;

/// A case that passed all checks, with its defaults filled in.
#[derive(Clone, Debug, PartialEq)]
pub struct LoadedCase {
    /// The case.
    pub case: Case,
    /// Reports, ready to print, of values that are allowed and look like mistakes.
    pub warnings: Vec<String>,
}

/// Why a case cannot be run. `Display` gives the report for the user, several lines long.
#[derive(Debug, Error)]
pub enum CaseError {
    /// The file cannot be read.
    #[error("{0}")]
    Unreadable(String),
    /// The text is not TOML, or its keys or types are not those of a case.
    #[error("{0}")]
    Malformed(String),
    /// The values fail the checks.
    #[error("{report}")]
    Invalid {
        /// The report for the user.
        report: String,
        /// The same, problem by problem.
        problems: Vec<Problem>,
    },
}

/// A name as part of the name of a file or a column: in lower case, with `_` for what is neither letter nor digit.
pub fn file_name(name: &str) -> String {
    name.chars().map(|c| if c.is_alphanumeric() { c.to_ascii_lowercase() } else { '_' }).collect()
}

/// Reads and checks a case file.
pub fn load(path: &Path) -> Result<LoadedCase, CaseError> {
    parse_in(&read_as(&CASE, path)?, &path.display().to_string(), Some(path.parent().unwrap_or(Path::new(""))))
}

/// The text of a file that should be of this format.
pub(crate) fn read_as(format: &Format, path: &Path) -> Result<String, CaseError> {
    read(format, path).map_err(|(what, fix)| {
        let allowed = format!("the path of a {}, NAME.toml", format.kind);
        let name = path.display().to_string();
        let diagnostic = Diagnostic { what, span: None, allowed, fix };
        CaseError::Unreadable(Source { name: &name, text: "" }.render(Level::Error, &diagnostic))
    })
}

/// The text of a file, or what is wrong and what to do.
fn read(format: &Format, path: &Path) -> Result<String, (String, String)> {
    let name = path.display();
    let failed = |error: io::Error| match error.kind() {
        io::ErrorKind::NotFound => {
            let fix = "check the spelling and the directory from which the command is run".to_owned();
            (format!("{name} does not exist"), fix)
        }
        io::ErrorKind::PermissionDenied => {
            (format!("{name} may not be read"), "change the permissions of the file".to_owned())
        }
        _ => (format!("{name} cannot be read: {error}"), "give the path of a file that can be read".to_owned()),
    };
    if path.is_dir() {
        return Err((format!("{name} is a directory"), "give one of the .toml files in it".to_owned()));
    }
    let mut bytes = Vec::new();
    File::open(path).and_then(|file| file.take(LONGEST_FILE + 1).read_to_end(&mut bytes)).map_err(failed)?;
    let kind = format.kind;
    let not_a_case = format!("give a {kind}; results, meshes and images are not input");
    if bytes.len() as u64 > LONGEST_FILE {
        return Err((format!("{name} is longer than {} MiB and no {kind}", LONGEST_FILE >> 20), not_a_case));
    }
    String::from_utf8(bytes).map_err(|error| {
        let byte = error.utf8_error().valid_up_to();
        (format!("{name} is not text in UTF-8: byte {byte} is not part of a character"), not_a_case)
    })
}

/// The case file, before its keys are read.
const CASE: Format = Format {
    kind: "case file",
    page: "docs/reference/case.md",
    required: &["title", "gravity", "grid", "domain", "materials", "stages"],
    misplaced: structure::misplaced,
};
/// The study file.
pub(crate) const STUDY: Format = Format {
    kind: "study file",
    page: "docs/reference/study.md",
    required: &["title", "cases"],
    misplaced: structure::misplaced_in_study,
};

/// Checks the text of a case file; `name` stands for the file in reports. It may not name files of points: it has no folder.
pub fn parse(text: &str, name: &str) -> Result<LoadedCase, CaseError> {
    parse_in(text, name, None)
}

/// Checks the text of a case file that lies in a folder, in which the files that it names are looked for.
///
/// # Errors
/// As [`load`].
pub fn parse_beside(text: &str, name: &str, folder: &Path) -> Result<LoadedCase, CaseError> {
    parse_in(text, name, Some(folder))
}

/// The same of a file in a folder, in which the files that it names lie.
fn parse_in(text: &str, name: &str, folder: Option<&Path>) -> Result<LoadedCase, CaseError> {
    let mut filled = None;
    let check = |case: &Case| {
        let mut case = case.clone();
        let problems = points::fill(&mut case, folder);
        let findings = if problems.is_empty() { validate(&case) } else { Findings { problems, warnings: Vec::new() } };
        filled = Some(case);
        findings
    };
    let (case, warnings) = parse_as(&CASE, text, name, check)?;
    let mut case = filled.unwrap_or(case);
    case.resolve();
    Ok(LoadedCase { case, warnings })
}

/// Reads a text as `T` and checks it; with reports of what looks like a mistake.
pub(crate) fn parse_as<T: DeserializeOwned>(
    format: &Format,
    text: &str,
    name: &str,
    check: impl FnOnce(&T) -> Findings,
) -> Result<(T, Vec<String>), CaseError> {
    let source = Source { name, text };
    let (value, document) = parse::document(format, &source)
        .map_err(|diagnostics| CaseError::Malformed(joined(&source, diagnostics, Vec::new())))?;
    let findings = check(&value);
    let place = |problems: &[Problem]| -> Vec<Diagnostic> {
        problems.iter().map(|problem| source.diagnose(&document, problem)).collect()
    };
    let warnings = place(&findings.warnings);
    if !findings.problems.is_empty() {
        let report = joined(&source, place(&findings.problems), warnings);
        return Err(CaseError::Invalid { report, problems: findings.problems });
    }
    Ok((value, warnings.iter().take(MOST_REPORTS).map(|d| source.render(Level::Warning, d)).collect()))
}

/// The reports in the order of the text, as one; warnings last.
fn joined(source: &Source, mut errors: Vec<Diagnostic>, warnings: Vec<Diagnostic>) -> String {
    errors.sort_by_key(|diagnostic| diagnostic.span.as_ref().map_or(0, |span| span.start));
    let shown = errors.iter().take(MOST_REPORTS).map(|d| source.render(Level::Error, d));
    let warned = warnings.iter().take(MOST_REPORTS).map(|d| source.render(Level::Warning, d));
    let mut report = shown.chain(warned).collect::<Vec<_>>().join("\n");
    let count = errors.len();
    if count > 1 {
        let first = if count > MOST_REPORTS { format!("; the first {MOST_REPORTS} are above") } else { String::new() };
        report += &format!("\nerror: {count} problems in {}{first}\n", printable(source.name));
    }
    report
}

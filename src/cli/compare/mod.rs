//! `checkdam compare`: two runs or two studies side by side.

mod figure;
mod judge;
mod runs;
mod series;
mod studies;

use super::console::{say, tell};
use super::folder::Folder;
use super::{BAD_INPUT, CHECK_FAILED, ENDED_EARLY};
use judge::Line;
use std::cell::RefCell;
use std::collections::BTreeSet;
use std::path::Path;
use std::process::ExitCode;

/// What a comparison found.
#[derive(Debug, Default)]
struct Comparison {
    /// A line per quantity.
    lines: Vec<Line>,
    /// Inputs that differ.
    inputs: Vec<String>,
    /// What is said and does not count.
    told: Vec<String>,
}

/// The quantities that are asked for; none for all.
struct Wanted {
    names: BTreeSet<String>,
    /// Those of them that were met.
    met: RefCell<BTreeSet<String>>,
}

impl Wanted {
    /// Whether nothing is left out.
    fn everything(&self) -> bool {
        self.names.is_empty()
    }

    /// Whether what goes by one of these names is asked for.
    fn has(&self, called: &[&str]) -> bool {
        let found: Vec<_> = called.iter().filter(|name| self.names.contains(**name)).map(ToString::to_string).collect();
        let asked = self.everything() || !found.is_empty();
        self.met.borrow_mut().extend(found);
        asked
    }
}

pub fn compare(folders: [&Path; 2], tolerance: f64, quantities: &[String], figure: Option<&Path>) -> ExitCode {
    let wanted = Wanted { names: quantities.iter().cloned().collect(), met: RefCell::default() };
    let found = match look(folders, tolerance, &wanted, figure) {
        Ok(found) => found,
        Err((code, error)) => {
            tell!("error: {error}");
            return ExitCode::from(code);
        }
    };
    let different = found.lines.iter().filter(|line| line.differs(tolerance)).count();
    show(&found, tolerance);
    say!("{different} of {} quantities differ by more than {tolerance}", found.lines.len());
    if different > 0 { ExitCode::from(CHECK_FAILED) } else { ExitCode::SUCCESS }
}

fn look(
    folders: [&Path; 2],
    tolerance: f64,
    wanted: &Wanted,
    figure: Option<&Path>,
) -> Result<Comparison, (u8, String)> {
    let bad = |error| (BAD_INPUT, error);
    let opened = [Folder::open(folders[0]).map_err(bad)?, Folder::open(folders[1]).map_err(bad)?];
    let found = match &opened {
        [Folder::Run(a), Folder::Run(b)] => {
            say!("A: {}", runs::described(a));
            say!("B: {}", runs::described(b));
            let found = runs::compare([a, b], wanted, tolerance).map_err(bad)?;
            if let Some(figure) = figure {
                figure::draw([a, b], figure).map_err(|error| (ENDED_EARLY, error))?;
            }
            found
        }
        [Folder::Study(a), Folder::Study(b)] => {
            if figure.is_some() {
                return Err((BAD_INPUT, "--figure draws the force over time of runs, and these are studies".into()));
            }
            say!("A: {} ({} runs)", folders[0].display(), a.rows());
            say!("B: {} ({} runs)", folders[1].display(), b.rows());
            studies::compare([a, b], wanted).map_err(bad)?
        }
        _ => {
            let error = "one is the folder of a run, the other that of a study\n  = fix: compare runs with runs, studies with studies";
            return Err((BAD_INPUT, error.into()));
        }
    };
    let unknown: Vec<_> = wanted.names.difference(&wanted.met.borrow()).cloned().collect();
    if !unknown.is_empty() {
        let error = format!(
            "neither has {}\n  = fix: without --quantities all are listed; columns go by history.csv:force_normal_n or force_normal_n",
            unknown.join(", ")
        );
        return Err((BAD_INPUT, error));
    }
    if found.lines.is_empty() {
        return Err((BAD_INPUT, "there is nothing to compare".into()));
    }
    Ok(found)
}

/// Prints what was found.
fn show(found: &Comparison, tolerance: f64) {
    if found.inputs.is_empty() {
        say!("inputs: the same");
    } else {
        say!("inputs differ (A, B):");
        found.inputs.iter().for_each(|input| say!("  {input}"));
    }
    let allowed = tolerance.to_string();
    let mut rows = vec![["quantity", "A", "B", "difference", "allowed", ""].map(str::to_owned)];
    for line in &found.lines {
        let [a, b] = line.values.clone();
        let mark = if line.differs(tolerance) { "DIFFERS " } else { "" };
        rows.push([line.quantity.clone(), a, b, line.difference(), allowed.clone(), format!("{mark}{}", line.note)]);
    }
    let width = |k: usize| rows.iter().map(|row| row[k].chars().count()).max().unwrap_or(0);
    let widths = [0, 1, 2, 3, 4].map(width);
    for [quantity, a, b, difference, allowed, rest] in &rows {
        let line = format!(
            "{quantity:<0$}  {a:>1$}  {b:>2$}  {difference:>3$}  {allowed:>4$}  {rest}",
            widths[0], widths[1], widths[2], widths[3], widths[4]
        );
        say!("{}", line.trim_end());
    }
    found.told.iter().for_each(|note| say!("note: {note}"));
}

/// Reads a tolerance: a share from 0 to below 1, so that nothing against something is always above it.
///
/// # Errors
/// It is no such number.
pub fn tolerance(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if (0.0..1.0).contains(&value) => Ok(value),
        _ => Err("a tolerance is a share, from 0 to below 1: 0.01 for a percent".into()),
    }
}

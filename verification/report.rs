//! Reports as CSV text: the same bytes for the same bits.

use super::{Fault, FaultKind, Outcome, RUNGS, Rung};
use checkdam::check::{Check, Expected, significant};
use checkdam::output::{OutputError, write_text};
use checkdam::plot::PlotError;
use std::path::Path;

/// Significant digits in reports.
pub const DIGITS: usize = 9;
/// The same of how many times its tolerance an error is.
const RATIO_DIGITS: usize = 2;

/// Everything that a rung leaves behind, as (name without extension, CSV text): its checks, then its tables.
pub fn files(name: &str, outcome: &Outcome) -> Vec<(String, String)> {
    let mut names: Vec<&str> = outcome.tables.iter().map(|t| t.0.as_str()).chain([name]).collect();
    names.sort_unstable();
    assert!(names.windows(2).all(|w| w[0] != w[1]), "{name}: two tables of one name, one of which would be lost");
    std::iter::once((name.to_string(), checks_csv(outcome))).chain(outcome.tables.iter().cloned()).collect()
}

/// Writes tables and figures of an outcome into `folder`, which is created; returns their names.
///
/// # Errors
/// The first file that could not be written.
pub fn write(name: &str, outcome: &Outcome, folder: &Path) -> Result<Vec<String>, PlotError> {
    std::fs::create_dir_all(folder).map_err(|source| OutputError::Create { path: folder.to_path_buf(), source })?;
    let mut written = Vec::new();
    for (stem, text) in files(name, outcome) {
        written.push(format!("{stem}.csv"));
        write_text(folder.join(format!("{stem}.csv")), &text)?;
    }
    for figure in RUNGS.iter().filter(|r| r.name == name).flat_map(|r| r.figures) {
        written.push(figure.draw(folder)?);
    }
    Ok(written)
}

/// Whether reports are written anew instead of compared: `cargo reports` says so in the environment.
pub fn written_anew() -> bool {
    std::env::var_os("CHECKDAM_REPORTS").is_some()
}

/// Compares a report with the one that is kept, byte for byte; or writes it, if reports are [`written_anew`]. Its physics has to
/// be judged by now.
///
/// # Errors
/// The first lines that differ, or why the kept one cannot be read or written.
pub fn compare(kept: &Path, now: &[u8]) -> Result<(), String> {
    if written_anew() {
        return std::fs::write(kept, now).map_err(|e| format!("{}: {e}", kept.display()));
    }
    let before = std::fs::read(kept).map_err(|e| format!("{}: {e}; `cargo reports` writes it", kept.display()))?;
    if before == now {
        return Ok(());
    }
    let [before, now] = [&before[..], now].map(|b| String::from_utf8_lossy(b).into_owned());
    let (mut old, mut new) = (before.lines(), now.lines());
    let mut shown = vec![format!("{} is not what comes out now:", kept.display())];
    for line in 1.. {
        match (old.next(), new.next()) {
            (None, None) => break,
            (a, b) if a == b => {}
            _ if shown.len() > 3 * LINES_SHOWN => {
                shown.push("...".into());
                break;
            }
            (a, b) => {
                shown.push(format!("line {line}"));
                shown.push(format!("  kept {}", a.unwrap_or("(no such line)")));
                shown.push(format!("  now  {}", b.unwrap_or("(no such line)")));
            }
        }
    }
    Err(shown.join("\n"))
}

/// How many lines that differ are shown.
const LINES_SHOWN: usize = 8;

/// What a rung or a validation leaves behind: every file with its lines and, of a table, its columns.
pub fn contents(files: &[(String, Vec<u8>)]) -> String {
    let line = |(name, bytes): &(String, Vec<u8>)| {
        let text = String::from_utf8_lossy(bytes);
        let columns = text.lines().next().filter(|_| name.ends_with(".csv")).unwrap_or_default();
        format!("{name}: {} lines {columns}\n", text.lines().count()).replace(" \n", "\n")
    };
    files.iter().map(line).collect()
}

/// The checks of an outcome as CSV, one a line.
pub fn checks_csv(outcome: &Outcome) -> String {
    let mut text =
        String::from("quantity,unit,measured,expected_low,expected_high,error,tolerance,passes,kind,source,reason\n");
    for c in &outcome.checks {
        let (low, high) = match c.expected {
            Expected::Value(v) => (v, v),
            Expected::AtMost(v) => (f64::NEG_INFINITY, v),
            Expected::AtLeast(v) => (v, f64::INFINITY),
            Expected::Within(low, high) => (low, high),
        };
        let cells = [
            quoted(&c.what),
            c.unit.into(),
            measured(c, c.measured),
            number(low),
            number(high),
            measured(c, c.error()),
            number(c.allowed()),
            c.passes().to_string(),
            c.kind.to_string(),
            quoted(&c.source),
            quoted(&c.reason),
        ];
        text.push_str(&cells.join(","));
        text.push('\n');
    }
    text
}

/// A table as CSV: header names with units, then rows. Every number is rounded to the ninth digit of the largest in its column:
/// what is smaller is round-off of the others.
pub fn table_csv(header: &[&str], rows: impl IntoIterator<Item = Vec<f64>>) -> String {
    let rows: Vec<Vec<f64>> = rows.into_iter().collect();
    let largest = |column: usize| rows.iter().map(|r| r[column].abs()).filter(|x| x.is_finite()).fold(0.0, f64::max);
    let quanta: Vec<f64> = (0..header.len()).map(|c| power_of_ten(1e-8 * largest(c))).collect();
    let mut text = header.join(",") + "\n";
    for row in &rows {
        let cells: Vec<String> = row.iter().zip(&quanta).map(|(&x, &q)| number(rounded(x, q))).collect();
        text.push_str(&cells.join(","));
        text.push('\n');
    }
    text
}

/// Like [`table_csv`], for rows some of whose columns hold the index of a name: `codes` has those columns and their names.
pub fn named_csv(header: &[&str], codes: &[(&str, &[&str])], rows: impl IntoIterator<Item = Vec<f64>>) -> String {
    let numbers = table_csv(header, rows);
    let names = |column: &str| codes.iter().find(|c| c.0 == column).map(|c| c.1);
    let replaced = |line: &str| {
        let cells = line.split(',').zip(header).map(|(cell, column)| {
            let name = names(column).and_then(|n| n.get(cell.parse::<usize>().ok()?));
            name.map_or_else(|| cell.to_string(), |n| quoted(n))
        });
        cells.collect::<Vec<_>>().join(",") + "\n"
    };
    numbers.lines().enumerate().map(|(k, line)| if k == 0 { format!("{line}\n") } else { replaced(line) }).collect()
}

/// What a rung made of a fault.
#[derive(Debug, Clone, PartialEq)]
pub struct Caught {
    /// Rung.
    pub rung: &'static str,
    /// Fault.
    pub fault: FaultKind,
    /// Its factor.
    pub factor: f64,
    /// Checks that measured something and fail, of how many there are; none if the run broke down.
    pub failing: usize,
    /// All checks.
    pub checks: usize,
    /// Largest [`Check::share_used`] among the failing checks: how many times the tolerance the error is.
    pub ratio: f64,
    /// That check, or why the run broke down.
    pub sharpest: String,
}

impl Caught {
    /// Runs a rung under a fault.
    pub fn by(rung: &Rung, fault: FaultKind, factor: f64) -> Self {
        let outcome = (rung.run)(&Fault::of(fault, factor)).map_err(|failure| failure.to_string());
        Self::from(rung.name, fault, factor, outcome)
    }

    /// What a run of `rung` under a fault says. One that breaks down or measures no number has caught nothing: that is no
    /// physics.
    pub fn from(rung: &'static str, fault: FaultKind, factor: f64, outcome: Result<Outcome, String>) -> Self {
        let nothing = Self { rung, fault, factor, failing: 0, checks: 0, ratio: 0.0, sharpest: String::new() };
        let outcome = match outcome {
            Ok(outcome) => outcome,
            Err(failure) => return Self { sharpest: format!("the run breaks down: {failure}"), ..nothing },
        };
        let failing: Vec<&Check> =
            outcome.checks.iter().filter(|c| c.measured.is_finite() && c.share_used() > 1.0).collect();
        // The first of those that share the largest ratio, as far as it is written down.
        let largest = failing.iter().map(|c| c.share_used()).fold(0.0, f64::max);
        let written = |x: f64| significant(x, RATIO_DIGITS);
        let sharpest = failing.iter().find(|c| written(c.share_used()) == written(largest));
        Self {
            failing: failing.len(),
            checks: outcome.checks.len(),
            ratio: largest,
            sharpest: sharpest.map_or_else(String::new, |c| c.what.clone()),
            ..nothing
        }
    }
}

/// Which rung caught which fault and how clearly, as CSV.
pub fn faults_csv(rows: &[Caught]) -> String {
    let mut text = String::from("rung,fault,factor,failing_checks,checks,detection_ratio,sharpest_check\n");
    for c in rows {
        let ratio = significant(c.ratio, RATIO_DIGITS);
        let (factor, sharpest) = (number(c.factor), quoted(&c.sharpest));
        let cells = [c.rung, c.fault.name(), &factor, &c.failing.to_string(), &c.checks.to_string(), &ratio, &sharpest];
        text.push_str(&cells.join(","));
        text.push('\n');
    }
    text
}

/// The ladder as CSV.
pub fn ladder_csv() -> String {
    let rows = RUNGS.iter().map(|r| format!("{},{},{}\n", r.name, quoted(r.title), quoted(r.under_fault)));
    std::iter::once("rung,title,what_runs_under_a_fault\n".to_string()).chain(rows).collect()
}

/// Nine significant digits, shortest form; an infinite bound is an empty cell.
pub fn number(x: f64) -> String {
    if x.is_infinite() { String::new() } else { significant(x, DIGITS) }
}

/// What a check measured or its error: to nine digits of the larger of measured and expected, and to a ten-thousandth of what
/// is allowed; to a tenth of it where that is at the level of round-off. Finer digits say nothing, and would change with every
/// reordering of a sum.
fn measured(c: &Check, x: f64) -> String {
    let bounds = match c.expected {
        Expected::Value(v) => [v, v],
        Expected::AtMost(v) => [0.0, v],
        Expected::AtLeast(v) => [v, v],
        Expected::Within(low, high) => [low, high],
    };
    let size = c.measured.abs().max(bounds[0].abs()).max(bounds[1].abs());
    let allowed = if c.allowed() > 0.0 { c.allowed() } else { bounds[1] - bounds[0] };
    let share = if allowed < 1e-8 * size.max(1.0) { 0.1 } else { 1e-4 };
    number(rounded(x, power_of_ten((1e-9 * size).max(share * allowed))))
}

/// The largest power of ten that is at most `x`; 0 for 0.
fn power_of_ten(x: f64) -> f64 {
    let exponent = format!("{x:e}");
    let exponent = exponent.split('e').nth(1).and_then(|e| e.parse::<i32>().ok());
    exponent.filter(|_| x > 0.0).map_or(0.0, |e| format!("1e{e}").parse().unwrap_or(0.0))
}

/// `x` to a multiple of `quantum`, as far as there is one.
fn rounded(x: f64, quantum: f64) -> f64 {
    if quantum > 0.0 && (x / quantum).abs() < 1e15 { (x / quantum).round() * quantum } else { x }
}

/// A cell of CSV, in quotes where it needs them.
pub fn quoted(s: &str) -> String {
    if s.contains([',', '"', '\n']) { format!("\"{}\"", s.replace('"', "\"\"")) } else { s.into() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::RungFailure;
    use checkdam::check::{Kind, Tolerance};

    /// A rung whose checks fail, but only one of them on a number that was measured against physics.
    fn failing(fault: &Fault) -> Result<Outcome, RungFailure> {
        let check = |what: &str, measured: f64, kind| {
            let reason = "a tenth";
            Check::value(what, measured, 1.0, "1").within(Tolerance::Absolute(0.1), reason).from(kind, "s")
        };
        let mut outcome = Outcome::default();
        outcome.check(check("broken", f64::NAN, Kind::Analytic));
        outcome.check(check("diverged", f64::INFINITY, Kind::Analytic));
        outcome.check(Check { source: String::new(), ..check("unsourced", 1.0, Kind::Analytic) });
        outcome.check(check("friction", fault.friction, Kind::Analytic));
        Ok(outcome)
    }

    #[test]
    fn only_numbers_that_miss_physics_catch_a_fault() {
        let rung = Rung {
            name: "r",
            title: "t",
            goal: "g",
            source: "s",
            sketch: "",
            run: failing,
            covers: &[],
            under_fault: "all",
            figures: &[],
        };
        let caught = Caught::by(&rung, FaultKind::Friction, 1.25);
        assert_eq!((caught.failing, caught.checks, caught.sharpest.as_str()), (1, 4, "friction"));
        assert!((caught.ratio - 2.5).abs() < 1e-9);
        let missed = Caught::by(&rung, FaultKind::Gravity, 1.25);
        assert_eq!((missed.failing, missed.ratio, missed.sharpest.as_str()), (0, 0.0, ""));
        let table = faults_csv(&[caught, missed]);
        assert!(table.ends_with("r,friction,1.25,1,4,2.5,friction\nr,gravity,1.25,0,4,0,\n"), "{table}");
    }

    #[test]
    fn a_report_that_changed_is_shown_line_by_line() {
        let kept = std::env::temp_dir().join(format!("checkdam_report_{}.csv", std::process::id()));
        std::fs::write(&kept, "a_m\n1\n2\n").expect("a file");
        assert_eq!(compare(&kept, b"a_m\n1\n2\n"), Ok(()));
        let told = compare(&kept, b"a_m\n1\n3\n4\n").expect_err("it differs");
        assert!(told.contains("line 3\n  kept 2\n  now  3\nline 4\n  kept (no such line)\n  now  4"), "{told}");
        std::fs::remove_file(&kept).expect("a file");
        assert!(compare(&kept, b"").expect_err("it is gone").contains("cargo reports"));
        let files = [("a.csv".to_string(), b"a_m,b_1\n1,2\n".to_vec()), ("b.svg".to_string(), b"<svg/>\n".to_vec())];
        assert_eq!(contents(&files), "a.csv: 2 lines a_m,b_1\nb.svg: 1 lines\n");
    }

    #[test]
    fn digits_of_round_off_are_dropped() {
        assert_eq!(power_of_ten(3.7e-9), 1e-9);
        assert_eq!(power_of_ten(1e3), 1e3);
        assert_eq!(power_of_ten(0.0), 0.0);
        let table = table_csv(&["a_m", "b_1"], [vec![20.123_456_789_1, 1.0], vec![1.1e-31, f64::INFINITY]]);
        assert_eq!(table, "a_m,b_1\n20.1234568,1\n0,\n");
        let named = named_csv(&["shape", "a_m"], &[("shape", &["linear", "uGIMP"])], [vec![1.0, 0.5], vec![0.0, 1.0]]);
        assert_eq!(named, "shape,a_m\nuGIMP,0.5\nlinear,1\n");
        let check = Check::at_most("noise", 2.2e-16, 1e-14, "1").because("r").from(Kind::Analytic, "s");
        assert_eq!(measured(&check, check.measured), "0");
        let check = Check::value("speed", 1.234_567_891_23, 1.234, "m/s")
            .within(Tolerance::Relative(0.01), "r")
            .from(Kind::Analytic, "s");
        assert_eq!(measured(&check, check.measured), "1.234568");
        assert_eq!(measured(&check, f64::NAN), "NaN");
    }
}

//! Reports as CSV text: the same bytes for the same bits.

use super::{Outcome, RUNGS};
use crate::check::{Check, Expected, significant};

/// Significant digits in reports.
pub const DIGITS: usize = 9;

/// Everything that a rung leaves behind, as (name without extension, CSV text): its checks, then its tables.
pub fn files(name: &str, outcome: &Outcome) -> Vec<(String, String)> {
    std::iter::once((name.to_string(), checks_csv(outcome))).chain(outcome.tables.iter().cloned()).collect()
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

/// A table as CSV: header names with units, then rows.
pub fn table_csv(header: &[&str], rows: impl IntoIterator<Item = Vec<f64>>) -> String {
    let mut text = header.join(",") + "\n";
    for row in rows {
        text.push_str(&row.into_iter().map(number).collect::<Vec<_>>().join(","));
        text.push('\n');
    }
    text
}

/// Which rung claims to catch which fault, as CSV.
pub fn faults_csv(rows: &[(&str, &str, f64, usize, String)]) -> String {
    let mut text = String::from("rung,fault,factor,failing_checks,first_failing_check\n");
    for (rung, fault, factor, failing, first) in rows {
        text.push_str(&format!("{rung},{fault},{},{failing},{}\n", number(*factor), quoted(first)));
    }
    text
}

/// The ladder as CSV.
pub fn ladder_csv() -> String {
    let rows = RUNGS.iter().map(|r| format!("{},{}\n", r.name, quoted(r.title)));
    std::iter::once("rung,title\n".to_string()).chain(rows).collect()
}

/// Nine significant digits, shortest form; an infinite bound is an empty cell.
pub fn number(x: f64) -> String {
    if x.is_infinite() { String::new() } else { significant(x, DIGITS) }
}

/// What a check measured. Where it is judged at the level of round-off, digits below a hundredth of the tolerance say nothing
/// and are dropped, lest every reordering of a sum change the reports.
fn measured(c: &Check, x: f64) -> String {
    let bound = match c.expected {
        Expected::AtMost(v) if c.allowed() == 0.0 => v,
        _ => c.allowed(),
    };
    let round_off = bound > 0.0 && bound < 1e-8;
    let quantum = 0.01 * bound;
    number(if round_off && (x / quantum).abs() < 1e12 { (x / quantum).round() * quantum } else { x })
}

fn quoted(s: &str) -> String {
    if s.contains([',', '"', '\n']) { format!("\"{}\"", s.replace('"', "\"\"")) } else { s.into() }
}

//! Numbers of a run by the names of their files: where each stands, in which unit a person reads it, how it is printed.
//!
//! A place is `summary.toml:barrier.static_force_n`, or `history.csv:overturning_moment_n_m[max force_normal_n]`: the value of a column
//! in the first row in which another is largest (`max`) or least (`min`).

use super::escape;
use crate::folder::{Leaf, Run};
use checkdam::check::significant;
use checkdam::output::Table;
use std::collections::BTreeMap;

/// Digits that are printed.
const DIGITS: usize = 4;

/// What a number measures; its unit follows its size.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Kind {
    /// Force, N.
    Force,
    /// Force per metre of width, N/m.
    ForcePerWidth,
    /// Moment, N m.
    Moment,
    /// Moment per metre of width, N m/m.
    MomentPerWidth,
    /// Impulse, N s.
    Impulse,
    /// Energy, J.
    Energy,
    /// Mass, kg.
    Mass,
    /// Length, m.
    Length,
    /// Time, s.
    Time,
    /// Velocity, m/s.
    Velocity,
    /// A ratio.
    Ratio,
    /// A share, in percent.
    Share,
    /// A number that counts.
    Count,
}

impl Kind {
    /// The unit in which a number of this size (SI) is read, and its size in SI units.
    pub fn unit(self, size: f64) -> (&'static str, f64) {
        let by_size = |units: [&'static str; 3]| match size.abs() {
            size if size >= 1e6 => (units[2], 1e6),
            size if size >= 1e3 => (units[1], 1e3),
            _ => (units[0], 1.0),
        };
        match self {
            Kind::Force => by_size(["N", "kN", "MN"]),
            Kind::ForcePerWidth => by_size(["N/m", "kN/m", "MN/m"]),
            Kind::Moment => by_size(["N m", "kN m", "MN m"]),
            Kind::MomentPerWidth => by_size(["N m/m", "kN m/m", "MN m/m"]),
            Kind::Impulse => by_size(["N s", "kN s", "MN s"]),
            Kind::Energy => by_size(["J", "kJ", "MJ"]),
            Kind::Mass if size.abs() >= 1e4 => ("t", 1e3),
            Kind::Mass => ("kg", 1.0),
            Kind::Length => ("m", 1.0),
            Kind::Time => ("s", 1.0),
            Kind::Velocity => ("m/s", 1.0),
            Kind::Share => ("%", 0.01),
            Kind::Ratio | Kind::Count => ("", 1.0),
        }
    }
}

/// The numbers of a run by their places.
pub struct Numbers<'a> {
    run: &'a Run,
    summary: BTreeMap<String, Leaf>,
    tables: BTreeMap<String, Table>,
}

impl<'a> Numbers<'a> {
    /// Of a run whose tables are read already.
    pub fn new(run: &'a Run, tables: BTreeMap<String, Table>) -> Self {
        let mut summary: BTreeMap<_, _> = run.results().into_iter().collect();
        summary.extend(run.case().into_iter().map(|(path, leaf)| (format!("case.{path}"), leaf)));
        Self { run, summary, tables }
    }

    /// The run.
    pub fn run(&self) -> &Run {
        self.run
    }

    /// Its tables by their names.
    pub fn tables(&self) -> &BTreeMap<String, Table> {
        &self.tables
    }

    /// A text of the summary.
    pub fn text(&self, path: &str) -> Option<String> {
        self.summary.get(path).map(ToString::to_string)
    }

    /// The number at a place; none if it is not there, or is no number.
    pub fn at(&self, place: &str) -> Option<f64> {
        let (file, key) = place.split_once(':')?;
        if file == "summary.toml" {
            return match self.summary.get(key)? {
                Leaf::Number(number) => Some(*number).filter(|number| number.is_finite()),
                Leaf::Text(_) => None,
            };
        }
        let table = self.tables.get(file)?;
        let (column, rule) = key.strip_suffix(']')?.split_once('[')?;
        let (which, of) = rule.split_once(' ')?;
        let values = table.column(of).ok()?;
        let sign = if which == "max" { 1.0 } else { -1.0 };
        let mut best: Option<usize> = None;
        for (row, value) in values.iter().enumerate().filter(|(_, value)| value.is_finite()) {
            if best.is_none_or(|best| sign * value > sign * values[best]) {
                best = Some(row);
            }
        }
        Some(table.column(column).ok()?[best?]).filter(|number| number.is_finite())
    }

    /// A cell of a table of the page: the number at a place, over that at another if one is named. None if one is not there.
    pub fn cell(&self, kind: Kind, place: &str, over: Option<&str>) -> Option<String> {
        let divisor = match over {
            Some(over) => self.at(over).filter(|divisor| *divisor != 0.0)?,
            None => 1.0,
        };
        let value = self.at(place)? / divisor;
        let (unit, size) = kind.unit(value);
        let over = over.map_or_else(String::new, |over| format!(" data-over=\"{}\"", escape(over)));
        let shown = if kind == Kind::Count { format!("{value}") } else { significant(value / size, DIGITS) };
        Some(format!(
            "<td class=\"number\"><span data-from=\"{}\"{over} data-unit=\"{unit}\">{}</span>{}</td>",
            escape(place),
            shown.replace('-', "\u{2212}"),
            if unit.is_empty() { String::new() } else { format!("\u{a0}{unit}") }
        ))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_are_those_a_person_reads() {
        assert_eq!(Kind::Force.unit(457.0), ("N", 1.0));
        assert_eq!(Kind::Force.unit(-2500.0), ("kN", 1e3));
        assert_eq!(Kind::Force.unit(4e7), ("MN", 1e6));
        assert_eq!(Kind::ForcePerWidth.unit(1312.0), ("kN/m", 1e3));
        assert_eq!(Kind::Mass.unit(2.5e6), ("t", 1e3));
        assert_eq!(Kind::Share.unit(0.1), ("%", 0.01));
    }
}

//! Checks: a measured number against an expected one, with where the expectation comes from and why the tolerance is what it is.
//!
//! A check passes when its error is at most its tolerance, so a NaN never passes. A check without a source or without a
//! reason for its tolerance fails whatever was measured, and so does an empty list of checks.

use std::fmt;

/// What kind of evidence an expectation is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Kind {
    /// A closed form.
    Analytic,
    /// An exact field that was chosen.
    Manufactured,
    /// Something that must be kept.
    Conservation,
    /// An observed order of accuracy.
    Convergence,
    /// An experiment.
    Measured,
    /// Another author's computation.
    Published,
    /// Our own earlier result: proves only that nothing changed.
    Golden,
}

impl fmt::Display for Kind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            Kind::Analytic => "analytic",
            Kind::Manufactured => "manufactured",
            Kind::Conservation => "conservation",
            Kind::Convergence => "convergence",
            Kind::Measured => "measured",
            Kind::Published => "published",
            Kind::Golden => "golden",
        })
    }
}

/// What a number should be.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Expected {
    /// This value.
    Value(f64),
    /// This value or less.
    AtMost(f64),
    /// This value or more.
    AtLeast(f64),
    /// Between these two.
    Within(f64, f64),
}

impl Expected {
    /// Distance of `measured` from what is expected; NaN if any number is.
    pub fn error(&self, measured: f64) -> f64 {
        // Each bound is tested in the direction in which NaN falls through to the difference.
        let above = |low: f64| if measured >= low { 0.0 } else { low - measured };
        let below = |high: f64| if measured <= high { 0.0 } else { measured - high };
        match *self {
            Expected::Value(v) => (measured - v).abs(),
            Expected::AtMost(v) => below(v),
            Expected::AtLeast(v) => above(v),
            Expected::Within(low, high) => above(low) + below(high),
        }
    }

    fn magnitude(&self) -> f64 {
        match *self {
            Expected::Value(v) | Expected::AtMost(v) | Expected::AtLeast(v) => v.abs(),
            Expected::Within(low, high) => low.abs().max(high.abs()),
        }
    }
}

impl fmt::Display for Expected {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Expected::Value(v) => write!(f, "{}", brief(v)),
            Expected::AtMost(v) => write!(f, "<= {}", brief(v)),
            Expected::AtLeast(v) => write!(f, ">= {}", brief(v)),
            Expected::Within(low, high) => write!(f, "{} .. {}", brief(low), brief(high)),
        }
    }
}

/// How far off is still right.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Tolerance {
    /// In the unit of the check.
    Absolute(f64),
    /// As a share of the expected value (of the larger bound).
    Relative(f64),
}

/// One number that is judged.
#[derive(Debug, Clone, PartialEq)]
pub struct Check {
    /// What was measured.
    pub what: String,
    /// The number.
    pub measured: f64,
    /// Unit of the number, "1" for none.
    pub unit: &'static str,
    /// What it should be.
    pub expected: Expected,
    /// How far off is still right.
    pub tolerance: Tolerance,
    /// Why this tolerance: from the order of the scheme, the error of the reference, the spread of the measurement.
    pub reason: String,
    /// Kind of evidence.
    pub kind: Kind,
    /// Where the expectation comes from: an author and year, a law, a formula.
    pub source: String,
}

impl Check {
    /// A check of `measured` against `expected`. Until [`Check::within`] and [`Check::from`] are called it cannot pass.
    pub fn new(what: impl Into<String>, measured: f64, expected: Expected, unit: &'static str) -> Self {
        Self {
            what: what.into(),
            measured,
            unit,
            expected,
            tolerance: Tolerance::Absolute(0.0),
            reason: String::new(),
            kind: Kind::Analytic,
            source: String::new(),
        }
    }

    /// A check against one value.
    pub fn value(what: impl Into<String>, measured: f64, expected: f64, unit: &'static str) -> Self {
        Self::new(what, measured, Expected::Value(expected), unit)
    }

    /// A check that a size that should vanish is at most `bound`.
    pub fn at_most(what: impl Into<String>, measured: f64, bound: f64, unit: &'static str) -> Self {
        Self::new(what, measured, Expected::AtMost(bound), unit)
    }

    /// Sets the tolerance and says why it is what it is.
    pub fn within(mut self, tolerance: Tolerance, reason: impl Into<String>) -> Self {
        self.tolerance = tolerance;
        self.reason = reason.into();
        self
    }

    /// For a bound that is itself the tolerance: says why the bound is what it is.
    pub fn because(self, reason: impl Into<String>) -> Self {
        self.within(Tolerance::Absolute(0.0), reason)
    }

    /// Sets kind and source.
    pub fn from(mut self, kind: Kind, source: impl Into<String>) -> Self {
        self.kind = kind;
        self.source = source.into();
        self
    }

    /// Distance from what is expected, in the unit of the check.
    pub fn error(&self) -> f64 {
        self.expected.error(self.measured)
    }

    /// The tolerance in the unit of the check.
    pub fn allowed(&self) -> f64 {
        match self.tolerance {
            Tolerance::Absolute(t) => t,
            Tolerance::Relative(t) => t * self.expected.magnitude(),
        }
    }

    /// How much of what is allowed is used up: the distance from what is expected, or from the middle of a span, over the
    /// farthest that still passes; for an upper bound the value over it, for a lower one 1 and the share by which it is missed. At
    /// most 1 where the check passes, NaN for NaN.
    pub fn share_used(&self) -> f64 {
        let (measured, allowed) = (self.measured, self.allowed());
        let over = |x: f64, y: f64| if x == 0.0 { 0.0 } else { x / y };
        if measured.is_nan() {
            return f64::NAN;
        }
        match self.expected {
            Expected::Value(v) => over((measured - v).abs(), allowed),
            Expected::Within(low, high) => over((measured - 0.5 * (low + high)).abs(), 0.5 * (high - low) + allowed),
            Expected::AtMost(high) if high + allowed > 0.0 => over(measured.max(0.0), high + allowed),
            Expected::AtLeast(low) if low - allowed > 0.0 => (2.0 - measured / (low - allowed)).max(0.0),
            // A bound at zero or beyond has no scale of its own.
            _ => over(self.error(), allowed),
        }
    }

    /// Why the check fails, or nothing if it passes.
    pub fn objection(&self) -> Option<String> {
        let (error, allowed) = (self.error(), self.allowed());
        if self.source.trim().is_empty() {
            Some("has no source".into())
        } else if self.reason.trim().is_empty() {
            Some("gives no reason for its tolerance".into())
        } else if !allowed.is_finite() {
            Some("has a tolerance that is not a number".into())
        } else if error <= allowed {
            None
        } else {
            Some(format!("is off by {} {}, allowed {}", brief(error), self.unit, brief(allowed)))
        }
    }

    /// Whether the check passes.
    pub fn passes(&self) -> bool {
        self.objection().is_none()
    }
}

/// The checks of one rung or case, and the files that show them.
#[derive(Debug, Clone, PartialEq)]
pub struct Verdict {
    /// Name of the rung or case.
    pub name: String,
    /// Its checks.
    pub checks: Vec<Check>,
    /// Paths of tables and figures.
    pub artefacts: Vec<String>,
}

impl Verdict {
    /// Whether there are checks and all pass.
    pub fn passes(&self) -> bool {
        !self.checks.is_empty() && self.checks.iter().all(Check::passes)
    }

    /// Checks that fail.
    pub fn failures(&self) -> impl Iterator<Item = &Check> {
        self.checks.iter().filter(|c| !c.passes())
    }

    /// The verdict without the checks that pass: what one needs to see when it fails.
    pub fn failing(&self) -> Failing<'_> {
        Failing(self)
    }

    /// One line: passed of total.
    pub fn summary(&self) -> String {
        let passed = self.checks.len() - self.failures().count();
        match self.checks.len() {
            0 => format!("{}: FAILS, it has no checks", self.name),
            n if passed == n => format!("{}: {n} of {n} checks pass", self.name),
            n => format!("{}: FAILS, {passed} of {n} checks pass", self.name),
        }
    }
}

/// A verdict of which only the failing checks are shown.
#[derive(Debug, Clone, Copy)]
pub struct Failing<'a>(&'a Verdict);

impl fmt::Display for Failing<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.table(f, |c| !c.passes())
    }
}

impl fmt::Display for Verdict {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.table(f, |_| true)
    }
}

impl Verdict {
    /// The summary, the checks that are `shown` as a table, why they fail, and where to look.
    fn table(&self, f: &mut fmt::Formatter<'_>, shown: fn(&Check) -> bool) -> fmt::Result {
        writeln!(f, "{}", self.summary())?;
        let head = ["", "quantity", "measured", "expected", "error", "tolerance", "unit", "kind", "source"];
        let mut rows = vec![head.map(String::from)];
        rows.extend(self.checks.iter().filter(|c| shown(c)).map(|c| {
            [
                if c.passes() { "ok" } else { "FAIL" }.to_string(),
                c.what.clone(),
                brief(c.measured),
                c.expected.to_string(),
                brief(c.error()),
                brief(c.allowed()),
                c.unit.to_string(),
                c.kind.to_string(),
                c.source.clone(),
            ]
        }));
        let mut width = [0; 9];
        for row in &rows {
            for (w, cell) in width.iter_mut().zip(row) {
                *w = (*w).max(cell.chars().count());
            }
        }
        for row in &rows {
            let mut line = String::from(" ");
            for (i, (cell, w)) in row.iter().zip(width).enumerate() {
                // Numbers to the right, words to the left.
                let cell = if (2..6).contains(&i) { format!(" {cell:>w$} ") } else { format!(" {cell:<w$} ") };
                line.push_str(&cell);
            }
            writeln!(f, "{}", line.trim_end())?;
        }
        for c in self.failures() {
            writeln!(f, "  {} {} (tolerance: {})", c.what, c.objection().unwrap_or_default(), c.reason)?;
        }
        if !self.artefacts.is_empty() {
            writeln!(f, "  see {}", self.artefacts.join(", "))?;
        }
        Ok(())
    }
}

/// A number in at most six significant digits, for people.
pub fn brief(x: f64) -> String {
    significant(x, 6)
}

/// A number rounded to `digits` significant digits, in the shortest form that reads back as the rounded number; `digits` > 0.
pub fn significant(x: f64, digits: usize) -> String {
    if x == 0.0 || !x.is_finite() {
        return if x.is_nan() { "NaN".into() } else { format!("{}", x + 0.0) };
    }
    let rounded: f64 = format!("{x:.*e}", digits - 1).parse().unwrap_or(x);
    if (1e-4..1e9).contains(&rounded.abs()) { format!("{rounded}") } else { format!("{rounded:e}") }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sound(measured: f64, expected: Expected, tolerance: Tolerance) -> Check {
        Check::new("speed", measured, expected, "m/s")
            .within(tolerance, "first order")
            .from(Kind::Analytic, "Newton 1687")
    }

    #[test]
    fn judges_by_error_and_tolerance() {
        let t = Tolerance::Relative(0.01);
        assert!(sound(100.9, Expected::Value(100.0), t).passes());
        assert!(!sound(101.1, Expected::Value(100.0), t).passes());
        assert!(sound(-100.9, Expected::Value(-100.0), t).passes());
        let none = Tolerance::Absolute(0.0);
        assert!(sound(1.0, Expected::AtMost(1.0), none).passes());
        assert!(!sound(1.1, Expected::AtMost(1.0), none).passes());
        assert!(!sound(0.9, Expected::AtLeast(1.0), none).passes());
        assert!(sound(1.5, Expected::Within(1.0, 2.0), none).passes());
        assert!(!sound(2.5, Expected::Within(1.0, 2.0), none).passes());
        assert_eq!(sound(2.5, Expected::Within(1.0, 2.0), none).error(), 0.5);
    }

    #[test]
    fn the_share_used_is_one_where_checks_begin_to_fail() {
        let none = Tolerance::Absolute(0.0);
        for (measured, expected, tolerance, share) in [
            (100.5, Expected::Value(100.0), Tolerance::Relative(0.01), 0.5),
            (97.0, Expected::Value(100.0), Tolerance::Relative(0.01), 3.0),
            (0.5, Expected::AtMost(2.0), none, 0.25),
            (-3.0, Expected::AtMost(2.0), none, 0.0),
            (6.0, Expected::AtMost(2.0), Tolerance::Absolute(1.0), 2.0),
            (0.75, Expected::AtLeast(1.5), none, 1.5),
            (-1.5, Expected::AtLeast(1.5), none, 3.0),
            (2.5, Expected::Within(1.0, 3.0), none, 0.5),
            (5.0, Expected::Within(1.0, 3.0), Tolerance::Absolute(1.0), 1.5),
            (-1.0, Expected::AtLeast(0.0), none, f64::INFINITY),
            (1.0, Expected::AtLeast(0.0), none, 0.0),
            (3.0, Expected::Value(3.0), none, 0.0),
        ] {
            let check = sound(measured, expected, tolerance);
            assert_eq!(check.share_used(), share, "{measured} against {expected}");
            assert_eq!(check.passes(), share <= 1.0, "{measured} against {expected}");
        }
        for expected in [Expected::Value(1.0), Expected::AtMost(1.0), Expected::AtLeast(1.0), Expected::AtLeast(0.0)] {
            assert!(sound(f64::NAN, expected, none).share_used().is_nan(), "{expected}");
        }
    }

    #[test]
    fn the_table_of_failures_leaves_out_what_passes() {
        let checks = vec![
            sound(1.0, Expected::Value(1.0), Tolerance::Absolute(0.1)),
            Check { what: "height".into(), ..sound(12.5, Expected::Value(1.0), Tolerance::Absolute(0.1)) },
        ];
        let verdict = Verdict { name: "fall".into(), checks, artefacts: vec!["out/fall.svg".into()] };
        let text = verdict.failing().to_string();
        assert!(text.starts_with("fall: FAILS, 1 of 2 checks pass"));
        assert!(text.contains("height") && !text.contains("speed") && text.contains("see out/fall.svg"), "{text}");
    }

    #[test]
    fn nan_never_passes() {
        let wide = Tolerance::Absolute(1e300);
        for expected in [
            Expected::Value(1.0),
            Expected::Value(f64::NAN),
            Expected::Value(f64::INFINITY),
            Expected::AtMost(1.0),
            Expected::AtLeast(1.0),
            Expected::Within(0.0, 2.0),
        ] {
            assert!(!sound(f64::NAN, expected, wide).passes(), "{expected}");
        }
        for bound in [Expected::AtMost(f64::NAN), Expected::AtLeast(f64::NAN), Expected::Within(f64::NAN, 2.0)] {
            assert!(!sound(1.0, bound, wide).passes(), "{bound}");
        }
        assert!(!sound(f64::INFINITY, Expected::Value(f64::INFINITY), wide).passes());
        for tolerance in [f64::NAN, f64::INFINITY, -1.0] {
            assert!(!sound(1.0, Expected::Value(1.0), Tolerance::Absolute(tolerance)).passes());
        }
    }

    #[test]
    fn without_source_or_reason_it_fails() {
        let good = sound(1.0, Expected::Value(1.0), Tolerance::Absolute(0.1));
        assert!(good.passes());
        assert!(!Check { source: "  ".into(), ..good.clone() }.passes());
        assert!(!Check { reason: String::new(), ..good }.passes());
        assert!(!Check::value("speed", 1.0, 1.0, "m/s").passes());
    }

    #[test]
    fn an_empty_list_fails() {
        let empty = Verdict { name: "nothing".into(), checks: vec![], artefacts: vec![] };
        assert!(!empty.passes());
        assert!(empty.to_string().contains("FAILS, it has no checks"));
    }

    #[test]
    fn the_table_lines_up_and_names_the_failure() {
        let checks = vec![
            sound(1.0, Expected::Value(1.0), Tolerance::Absolute(0.1)),
            sound(12.5, Expected::Value(1.0), Tolerance::Absolute(0.1)),
        ];
        let text = Verdict { name: "fall".into(), checks, artefacts: vec!["fall.csv".into()] }.to_string();
        let lines: Vec<&str> = text.lines().collect();
        assert_eq!(lines[0], "fall: FAILS, 1 of 2 checks pass");
        assert_eq!(lines[2].find("Newton"), lines[3].find("Newton"));
        assert!(lines[3].trim_start().starts_with("FAIL"));
        assert!(lines[4].contains("is off by 11.5 m/s, allowed 0.1 (tolerance: first order)"));
        assert!(lines[5].contains("fall.csv"));
    }

    #[test]
    fn rounds_to_significant_digits() {
        assert_eq!(significant(0.1 + 0.2, 9), "0.3");
        assert_eq!(significant(123_456.789_123, 9), "123456.789");
        assert_eq!(significant(-1.234_567_89e-13, 3), "-1.23e-13");
        assert_eq!(significant(-0.0, 9), "0");
        assert_eq!(significant(f64::NAN, 9), "NaN");
    }
}

//! Collects what was compared: the farthest that two of a kind are apart, over all scenes.

use checkdam::check::{Check, Kind, Tolerance};

/// Nine digits are written of every number in a table.
pub const WRITTEN: f64 = 2e-8;

/// How far apart two may be, as a share; why so far; and what says that they are the same.
#[derive(Debug, Clone, Copy)]
pub struct Within<'a> {
    share: f64,
    reason: &'a str,
    source: &'a str,
}

/// Within this `share`, for this `reason`, by this `source`.
pub fn within<'a>(share: f64, reason: &'a str, source: &'a str) -> Within<'a> {
    Within { share, reason, source }
}

/// Checks of one scene or of several.
#[derive(Debug, Clone, Default)]
pub struct Judge {
    pub checks: Vec<Check>,
}

impl Judge {
    /// `measured` against `expected`, number by number: the largest difference, over the largest of what is expected. Lists of different
    /// lengths are no match.
    pub fn same(&mut self, what: &str, measured: &[f64], expected: &[f64], within: Within) {
        let scale = expected.iter().fold(0.0, |a: f64, b| a.max(b.abs()));
        self.near(what, measured, expected, scale, within);
    }

    /// The same, over a `scale` of its own: what is near zero is measured by what makes it up.
    pub fn near(&mut self, what: &str, measured: &[f64], expected: &[f64], scale: f64, within: Within) {
        let worst = |worst: f64, (a, b): (&f64, &f64)| {
            let off = (a - b).abs();
            if off.is_nan() {
                f64::NAN
            } else if worst.is_nan() || off < worst {
                worst
            } else {
                off
            }
        };
        let off = if measured.len() == expected.len() && !expected.is_empty() {
            measured.iter().zip(expected).fold(0.0, worst)
        } else {
            f64::NAN
        };
        let off = if off == 0.0 { 0.0 } else { off / scale };
        self.check(
            Check::at_most(format!("{what}: farthest apart, over the largest"), off, within.share, "1")
                .because(within.reason)
                .from(Kind::Conservation, within.source),
        );
    }

    /// A closed form, within a share of it.
    pub fn closed(&mut self, what: &str, measured: f64, expected: f64, unit: &'static str, within: Within) {
        self.check(
            Check::value(what, measured, expected, unit)
                .within(Tolerance::Relative(within.share), within.reason)
                .from(Kind::Analytic, within.source),
        );
    }

    pub fn check(&mut self, check: Check) {
        self.checks.push(check);
    }

    /// Of checks of one name the worst, so that a kind of comparison is one check whatever the scene.
    pub fn merge(&mut self, other: Judge) {
        for check in other.checks {
            match self.checks.iter_mut().find(|c| c.what == check.what) {
                Some(known) if known.measured.is_nan() || known.share_used() >= check.share_used() => {}
                Some(known) => *known = check,
                None => self.checks.push(check),
            }
        }
    }

    /// Something that should vanish, or nearly.
    pub fn at_most(&mut self, what: &str, measured: f64, bound: f64, reason: &str) {
        self.check(
            Check::at_most(what, measured, bound, "1").because(reason).from(Kind::Conservation, "what must be kept"),
        );
    }
}

//! Checks of a study, with the value at fault, what is allowed and what to do.

use super::file::{Sample, Study};
use super::quantities::QUANTITIES;
use super::sampling::MOST_DIMENSIONS;
use crate::case::{Findings, KeyPath, Problem, did_you_mean};
use std::fmt::Display;

/// Most runs of a study: each is checked before the first begins.
pub const MOST_RUNS: f64 = 1.0e5;

/// Everything that is wrong with a study by itself; its cases are looked at with its plan.
pub fn check(study: &Study) -> Findings {
    let mut checker = Checker { study, problems: Vec::new() };
    checker.texts();
    checker.what_varies();
    checker.columns();
    checker.figure();
    if let Some(sample) = &study.sample {
        checker.sample(sample);
    }
    checker.replicates();
    checker.runs();
    Findings { problems: checker.problems, warnings: Vec::new() }
}

struct Checker<'a> {
    study: &'a Study,
    problems: Vec<Problem>,
}

impl Checker<'_> {
    fn problem(&mut self, path: KeyPath, what: String, allowed: &str, fix: &str) {
        self.problems.push(Problem { path, what, value: String::new(), allowed: allowed.into(), fix: fix.into() });
    }

    fn value(&mut self, path: KeyPath, value: impl Display, allowed: &str, fix: &str) {
        let what = format!("{path} = {value} is not allowed");
        self.problem(path, what, allowed, fix);
    }

    /// Text that goes to terminals, tables and pictures as it is.
    fn texts(&mut self) {
        let study = self.study;
        let variants = study.variants.iter().enumerate().flat_map(|(k, v)| {
            let at = KeyPath::top("variant").index(k);
            [(at.key("factor"), &v.factor), (at.key("label"), &v.label)]
        });
        let axes = study.axes.iter().enumerate().map(|(k, a)| (KeyPath::top("axis").index(k).key("name"), &a.name));
        let cases = study.cases.iter().enumerate().map(|(k, c)| (KeyPath::top("cases").index(k), c));
        let all = std::iter::once((KeyPath::top("title"), &study.title)).chain(variants).chain(axes).chain(cases);
        for (path, text) in all.filter(|(_, text)| text.contains(char::is_control)) {
            let plain: String = text.chars().filter(|c| !c.is_control()).collect();
            let allowed = "one line without control characters: it goes to terminals and tables as it is";
            self.value(path, format!("{text:?}"), allowed, &format!("write {plain:?}"));
        }
    }

    fn what_varies(&mut self) {
        let study = self.study;
        if study.cases.is_empty() {
            let what = "it has no case".to_owned();
            let fix = "write cases = [\"NAME.toml\"], relative to the study file";
            self.problem(KeyPath::top("cases"), what, "at least one path of a case file", fix);
        }
        for (k, axis) in study.axes.iter().enumerate() {
            if axis.is_empty() || axis.fields.is_empty() != axis.values.is_empty() {
                let what = format!("axis `{}` has no value or no field", axis.name);
                let fix = "add values = [...] and fields = [\"grid.spacing_m\"]";
                self.problem(
                    KeyPath::top("axis").index(k),
                    what,
                    "values with the fields that take them, or levels",
                    fix,
                );
            }
        }
    }

    fn columns(&mut self) {
        let study = self.study;
        let axes = study.axes.iter().enumerate().map(|(k, a)| (KeyPath::top("axis").index(k), &a.name));
        let sample = KeyPath::top("sample");
        let ranges = study.sample.iter().flat_map(|s| s.ranges.iter().enumerate());
        let ranges = ranges.map(|(k, r)| (sample.key("range").index(k), &r.name));
        let choices = study.sample.iter().flat_map(|s| s.choices.iter().enumerate());
        let choices = choices.map(|(k, c)| (sample.key("choice").index(k), &c.name));
        let all: Vec<_> = axes.chain(ranges).chain(choices).collect();
        for (k, (path, name)) in all.iter().enumerate() {
            if all[..k].iter().any(|(_, other)| other == name) {
                let what = format!("`{name}` is the name of two things that vary");
                self.problem(path.key("name"), what, "names that differ", &format!("write \"{name} {k}\""));
            }
        }
    }

    fn figure(&mut self) {
        let study = self.study;
        let Some(figure) = &study.figure else { return };
        // Every other column of the table is text.
        let names = study.columns();
        let numbers = || names.iter().copied().chain(QUANTITIES.iter().map(|q| q.name));
        for (key, column) in [("x", &figure.x), ("y", &figure.y)] {
            if !numbers().any(|name| name == column) {
                let what = format!("figure.{key} = \"{column}\" is neither an axis of the study nor a quantity");
                let fix = did_you_mean(column, numbers().collect::<Vec<_>>());
                self.problem(KeyPath::top("figure").key(key), what, "a column of numbers of the study's table", &fix);
            }
        }
    }

    fn sample(&mut self, sample: &Sample) {
        let at = KeyPath::top("sample");
        let dimensions = sample.ranges.len() + sample.choices.len();
        if sample.points == 0 {
            self.value(at.key("points"), 0, "points > 0", "use a number such as 64");
        }
        if dimensions == 0 || dimensions > MOST_DIMENSIONS {
            let what = format!("the sample has {dimensions} dimensions");
            let allowed = format!("1 to {MOST_DIMENSIONS} of [[sample.range]] and [[sample.choice]]");
            self.problem(at.clone(), what, &allowed, "add a range, or leave some out");
        }
        for (k, r) in sample.ranges.iter().enumerate() {
            let (path, low) = (at.key("range").index(k), if r.logarithmic { 0.0 } else { f64::NEG_INFINITY });
            if !(r.low > low && r.low < r.high && r.high.is_finite()) {
                let what = format!("range `{}` from {} to {} is empty", r.name, r.low, r.high);
                let allowed = "low < high, both finite, and above 0 on a logarithmic range";
                let swapped = r.low > r.high && r.high > low;
                let fix = if swapped {
                    format!("write low = {}, high = {}", r.high, r.low)
                } else {
                    "give the range a length".into()
                };
                self.problem(path.key("low"), what, allowed, &fix);
            }
            if r.fields.is_empty() {
                let what = format!("range `{}` has no field", r.name);
                self.problem(
                    path.key("fields"),
                    what,
                    "at least one path in the case",
                    "add fields = [\"grid.spacing_m\"]",
                );
            }
        }
        for (k, c) in sample.choices.iter().enumerate().filter(|(_, c)| c.options.is_empty()) {
            let what = format!("choice `{}` has no option", c.name);
            self.problem(at.key("choice").index(k), what, "at least one option", "add [[sample.choice.option]]");
        }
    }

    fn replicates(&mut self) {
        let Some(r) = &self.study.replicates else { return };
        let at = KeyPath::top("replicates");
        for (key, value, most) in [("grid_offset_cells", r.grid_offset_cells, 1.0), ("jitter", r.jitter, 0.5)] {
            if !(0.0..=most).contains(&value) {
                self.value(at.key(key), value, &format!("0 to {most}"), &format!("use {}", 0.5 * most));
            }
        }
    }

    fn runs(&mut self) {
        let count = self.study.run_count();
        if count > MOST_RUNS {
            let replicates = self.study.replicates.as_ref().map_or(0.0, |r| r.count as f64);
            let points = self.study.sample.as_ref().map_or(0.0, |s| s.points as f64);
            let path = match () {
                () if replicates >= points && replicates > 1.0 => KeyPath::top("replicates").key("count"),
                () if points > 1.0 => KeyPath::top("sample").key("points"),
                () => KeyPath::top("axis"),
            };
            let what = format!("the study asks for {count:.1e} runs");
            self.problem(path, what, &format!("at most {MOST_RUNS:e} runs"), "ask for fewer");
        }
    }
}
